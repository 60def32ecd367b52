/* ledger_lists.h: the ledger of a scene as operation lists for core/ledger.h, and the meaning of its entries.
 *
 * By Lagrange's equations, the momentum p_i = dL/dq_i' changes by dL/dq_i (gravity, springs, the other coordinates'
 * motion), each generalized force, each damper and each contact. The energy changes by the work of each generalized
 * force, each damper's loss, each contact, and each change of an input in the energies. If the energy integral is not T
 * + V, it takes the place of the energy (equations.h). */
#ifndef DERIVE_LEDGER_LISTS_H
#define DERIVE_LEDGER_LISTS_H

#include "layout.h"

typedef struct ledger_entry {
    ledger_kind kind;
    const place *at; /* of the term or input that causes it; NULL for LEDGER_ENERGIES */
    int account;
} ledger_entry;

typedef struct ledger_lists {
    ledger_entry *entry; /* [smooth] */
    int smooth;
    int entries; /* smooth ones, then each contact's energy and impulses by coordinate, then inputs */
    int accounts; /* 1 + unknowns: the energy, then the momenta */
    int *unknown; /* [accounts] the unknown of a momentum; -1 for the energy */
    int *input;   /* [inputs] inputs of the program in the energies */
    int inputs;
    bool turned; /* a power has a turn angle outside sines and cosines */
    op_list *powers;
    op_list *levels;
} ledger_lists;

/* Enter the lists of a scene with so many contacts and the energy integral `integral` (NULL: T + V, see equations.h).
 * NULL after an error, reported. */
ledger_lists *ledger_lists_make(layout *map, const poly *integral, int contacts, diags *errors);
void ledger_lists_free(ledger_lists *l);

#endif
