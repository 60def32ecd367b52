/* bind.h: assignment of a firmware's signals to a scene's quantities, by name and unit. */
#ifndef PIL_BIND_H
#define PIL_BIND_H

#include "core/exchange.h"
#include "host/image/image.h"

typedef enum bound_place { BOUND_INPUT, BOUND_OUTPUT, BOUND_COMPONENT, BOUND_NOWHERE } bound_place;

typedef struct bound {
    wh_signal signal; /* its texts belong to the hello */
    unsigned channel;
    bound_place place;
    int index;  /* index of the input, the output or the state component (angles first) */
    int rate;   /* the component of its rate, or -1 */
    bool turns; /* an angle: its reading repeats every turn */
} bound;

typedef struct binding {
    unsigned count;
    bound bound[WH_SIGNALS_MAX]; /* as in the hello */
    unsigned outputs;            /* of the firmware */
    unsigned edges;
    unsigned samples;
    unsigned notes; /* notes are not bound */
} binding;

/* A readable quantity of that name, an output, coordinate or rate: sets place, index, rate and turns. Returns its unit,
 * or NULL if there is none. */
const char *bind_read(bound *b, const image *im, const char *name);

/* `renames` are words NAME=OTHER between commas, or NULL: the firmware's NAME is the scene's OTHER. False, reported. */
bool bind_signals(binding *b, const wh_hello *hello, const image *im, const char *renames);

#endif
