/* names.h: the symbols of one mechanism, found by name. */
#ifndef LANG_NAMES_H
#define LANG_NAMES_H

#include "host/base/arena.h"
#include "host/base/nearest.h"
#include "model.h"

typedef struct named {
    symbol symbol;       /* first: a `const symbol *` of a mechanism is the address of a `named` */
    bool is_placeholder; /* used but not declared; reported */
    bool is_open;        /* its own declaration is being read */
    int mark;            /* who saw it last, for walks and duplicates */
    place mark_at;
    struct named *rate; /* of a let: its time derivative, where it was asked for */
    struct named *next; /* in its slot */
} named;

typedef struct names names;

names *names_new(struct arena *arena);
named *names_find(const names *all, const char *text, size_t length);
/* A new entry; the name must not be in yet. */
named *names_add(names *all, const char *text, size_t length);
/* Offer all declared names of the effects allowed (`effect_index` -1: of none, -2: of any). */
void names_offer(const names *all, int effect_index, nearest *search);

#endif
