/* names.h: the symbols of one mechanism, found by name. */
#ifndef LANG_NAMES_H
#define LANG_NAMES_H

#include "host/base/arena.h"
#include "host/base/nearest.h"
#include "model.h"

typedef struct named {
    symbol symbol;       /* first: a `const symbol *` of a mechanism is the address of a `named` */
    bool is_placeholder; /* used but not declared; reported */
    bool is_open;        /* the parser is reading its declaration */
    int mark;            /* number of the last visit, for walks and duplicates */
    place mark_at;
    struct named *rate; /* let: its time derivative, if an expression has named it */
    struct named *next; /* in its slot */
} named;

typedef struct names names;

names *names_new(struct arena *arena);
named *names_find(const names *all, const char *text, size_t length);
/* Add an entry; the name must be new. */
named *names_add(names *all, const char *text, size_t length);
/* Offer the declared names of the allowed effects (`effect_index` -1: no effect's, -2: every effect's). */
void names_offer(const names *all, int effect_index, nearest *search);

#endif
