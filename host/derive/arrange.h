/* arrange.h: the equations M x = f brought into one of several forms before they are entered into a list. For
 * host/derive only. */
#ifndef DERIVE_ARRANGE_H
#define DERIVE_ARRANGE_H

#include "linear_system.h"

/* Which form. */
typedef struct arrangement {
    bool scaled;
    bool rescaled; /* what is left after symbolic elimination */
    bool hinged;   /* what hangs on hinges goes first, in the order: hinge.h */
    int lead;      /* the sine that is evaluated first: lower.h */
    int first;     /* unknown eliminated symbolically; -1 none; -2 every constant diagonal */
    int order[COORDINATES_MAX]; /* of elimination */
} arrangement;

/* The equations as an arrangement leaves them: all polys in one piece, for lower_plan(). */
typedef struct arranged {
    int n;
    int polys;
    const poly **mass;  /* [n * n] */
    const poly **force; /* [n] */
    int hinges;
    const poly **across; /* [hinges * (n + 1)] of hinge.h */
    double *inverse;     /* [hinges] what products of them are multiplied by */
    double *scale;       /* [n] of rows and columns */
    bool *gone;          /* [n] eliminated in symbols */
    int *order;          /* [n] those first */
    int eliminated;
} arranged;

/* False: they cannot be arranged so. To be freed either way. */
bool arrange(algebra *a, const linear_system *s, const arrangement *how, arranged *w);
void arranged_free(arranged *w);

#endif
