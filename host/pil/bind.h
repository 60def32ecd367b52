/* bind.h: which of a scene's quantities each of a firmware's signals is: by name, with their units compared. */
#ifndef PIL_BIND_H
#define PIL_BIND_H

#include "core/exchange.h"
#include "host/image/image.h"

typedef enum bound_place { BOUND_INPUT, BOUND_OUTPUT, BOUND_COMPONENT, BOUND_NOWHERE } bound_place;

typedef struct bound {
    wh_signal signal; /* its words belong to the hello */
    unsigned channel;
    bound_place place;
    int index;  /* of the input, the output or the component of the state (angles first) */
    int rate;   /* the component that is its rate; -1: none */
    bool turns; /* an angle: what it reads comes again each turn */
} bound;

typedef struct binding {
    unsigned count;
    bound bound[WH_SIGNALS_MAX]; /* as in the hello */
    unsigned outputs;            /* of the firmware */
    unsigned edges;
    unsigned samples;
    unsigned notes; /* which are bound to nothing */
} binding;

/* What a firmware may read: an output, a coordinate or a rate of that name, to place, index, rate and turns. Returns its
 * unit; NULL: there is none. */
const char *bind_read(bound *b, const image *im, const char *name);

/* `renames` are words NAME=OTHER between commas, or NULL: the firmware's NAME is the scene's OTHER. False, reported. */
bool bind_signals(binding *b, const wh_hello *hello, const image *im, const char *renames);

#endif
