/* program.h: an instance as numbers: operation lists with every parameter folded in. */
#ifndef DERIVE_PROGRAM_H
#define DERIVE_PROGRAM_H

#include "contact_lists.h"
#include "layout.h"
#include "ledger_lists.h"

typedef struct program {
    layout layout;
    int count;   /* unknowns */
    int outputs; /* the mechanism's, then value and rate of each conserved coordinate */
    conservation *conserved;
    /* Second order: result[i] is the acceleration of scene coordinate i. First order: the slope of
     * component i, angles first. */
    tape *step;
    tape *tables; /* what its tables hold, exactly; NULL without any (program_look_up()) */
    /* The outputs. */
    tape *observe;
    contact_lists *contacts; /* NULL without any */
    ledger_lists *ledger;    /* NULL when no books are kept */
    bool ledger_asked;       /* by `with ledger`, --stabilized: else they only balance the run */
    const poly
        *integral; /* the energy integral where it is not T + V, else NULL: see equations.h */
    /* For the host's books: highest derivatives (by unknown), then for a mechanism T, V, input
     * power, loss power, the momenta (by unknown) and, if there is one, the integral. */
    tape *books;
} program;

/* `conserve` [count] names the coordinates to recover from their momentum, or is NULL. NULL on error
 * (too many components, a momentum that is not conserved, a constant that is not finite), reported to
 * `errors`. */
program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors);
/* The step looks up in tables what it owes to an angle (tables.h). False where it cannot, reported with its place. */
bool program_look_up(program *p, const equations *e, image_settings *settings, diags *errors);
void program_free(program *p);

uint64_t program_hash(const program *p);

#endif
