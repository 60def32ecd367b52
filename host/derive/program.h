/* program.h: an instance as operation lists, with every parameter folded in. */
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
    /* Second order: result[i] is the acceleration of scene coordinate i. First order: the derivative of component i,
     * angles first. */
    op_list *step;
    op_list
        *tables; /* exact list of the tables' functions; NULL without tables (program_look_up()) */
    /* The outputs. */
    op_list *observe;
    contact_lists *contacts; /* NULL without contacts */
    ledger_lists *ledger;    /* NULL without a ledger */
    bool ledger_asked;       /* by `with ledger`, --stabilized: else it only balances the run */
    const poly *integral; /* the energy integral if it is not T + V, else NULL: see equations.h */
    /* For the host's balance: the highest derivatives (by unknown). For a mechanism then T, V, input power, loss power,
     * the momenta (by unknown) and the integral, if any. */
    op_list *books;
} program;

/* `conserve` [count] names the coordinates to recover from their momentum, or is NULL. NULL after an error, reported to
 * `errors`: too many components, a momentum that is not conserved, or a constant that is not finite. */
program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors);
/* Replace the step's functions of one angle by table look-ups (tables.h). False if that is impossible, reported with
 * its place. */
bool program_look_up(program *p, const equations *e, image_settings *settings, diags *errors);
void program_free(program *p);

uint64_t program_hash(const program *p);

#endif
