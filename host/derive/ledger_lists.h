/* ledger_lists.h: the books of a scene as numbers: the lists that core/ledger.h takes, and what their entries
 * mean.
 *
 * What changes the momentum p_i = dL/dq_i' is, by Lagrange's equations, dL/dq_i (gravity, springs, and
 * what the other coordinates' motion does), each generalized force, each damper and each contact. What
 * changes the energy, or the energy integral where that is not T + V (equations.h), is the work of each
 * generalized force, each damper's loss, each contact, and each change of an input that the energies name. */
#ifndef DERIVE_LEDGER_LISTS_H
#define DERIVE_LEDGER_LISTS_H

#include "layout.h"

typedef struct ledger_entry {
    ledger_kind kind;
    const place *at; /* of the term, or of the input that does it; NULL for LEDGER_ENERGIES */
    int account;
} ledger_entry;

typedef struct ledger_lists {
    ledger_entry *entry; /* [smooth] */
    int smooth;
    int entries; /* smooth, then for each contact its energy and its impulse by coordinate, then inputs */
    int accounts; /* 1 + unknowns: the energy, then the momenta */
    int *unknown; /* [accounts] whose momentum an account is; -1 for the energy */
    int *input;   /* [inputs] of the program: those that the energies name */
    int inputs;
    bool turned; /* a power names a turn angle outside sines and cosines */
    tape *powers;
    tape *levels;
} ledger_lists;

/* Enter the lists of a scene with so many contacts, whose energy integral is `integral` (NULL: T + V, see equations.h).
 * NULL on error, reported. */
ledger_lists *ledger_lists_make(layout *map, const poly *integral, int contacts, diags *errors);
void ledger_lists_free(ledger_lists *l);

#endif
