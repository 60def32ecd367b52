/* program.h: an instance as operation lists, with every parameter folded in. */
#ifndef DERIVE_PROGRAM_H
#define DERIVE_PROGRAM_H

#include "host/derive/layout.h"
#include "host/derive/solve.h"

/* === a scene's contacts as operation lists and a table for core/contact.h ===================== */

typedef struct contact_row {
    const contact_statement *from;
    int kind; /* wh_contact_kind */
    int pin;  /* the only scene coordinate with an entry in the row, or -1 */
    int direction;
    int first_set;
    int sets;
} contact_row;

typedef struct contact_lists {
    int count;
    int forced;
    int held; /* number of holds without a pin */
    int set_count;
    contact_row *row; /* [count] */
    int *target;      /* [set_count] component of the state, angles first */
    op_list *signals;
    op_list *forces;
    op_list *sets; /* NULL without sets */
} contact_lists;

/* === the ledger =============================================================================== */
/* The ledger of a scene as operation lists for core/ledger.h, and the meaning of its entries.
 *
 * By Lagrange's equations, the momentum p_i = dL/dq_i' changes by dL/dq_i (gravity, springs, the other coordinates'
 * motion), each generalized force, each damper and each contact. The energy changes by the work of each generalized
 * force, each damper's loss, each contact, and each change of an input in the energies. If the energy integral is not T
 * + V, it takes the place of the energy (equations.h). */

typedef struct ledger_entry {
    ledger_kind kind;
    /* place of the term or input that causes the entry; NULL for LEDGER_ENERGIES */
    const place *at;
    int account;
} ledger_entry;

typedef struct ledger_lists {
    ledger_entry *entry; /* [smooth] */
    int smooth;
    /* number of entries: the smooth ones, then those of contacts, then those of inputs */
    int entries;
    int accounts; /* number of accounts, 1 + unknowns: the energy, then the momenta */
    int *unknown; /* [accounts] the unknown of a momentum; -1 for the energy */
    int *input;   /* [inputs] inputs of the program that occur in the energies */
    int inputs;
    bool turned; /* the rate of an entry has a turn angle outside sines and cosines */
    op_list *powers;
    op_list *levels;
} ledger_lists;

typedef struct program {
    layout layout;
    int count; /* number of unknowns */
    /* number: outputs of the mechanism, then value and rate of each conserved coordinate */
    int outputs;
    conservation *conserved;
    /* Second order: result[i] is the acceleration of scene coordinate i. First order: the derivative of component i,
     * angles first. */
    op_list *step;
    op_list
        /* list that computes the tables' functions exactly; NULL without tables (program_look_up()) */
        *tables;
    op_list *observe;
    contact_lists *contacts; /* NULL without contacts */
    ledger_lists *ledger;    /* NULL without a ledger */
    bool
        ledger_asked; /* requested by `with ledger` or --stabilized; else the ledger only balances the run */
    const poly *integral; /* the energy integral if it is not T + V, else NULL: see equations.h */
    /* Results for the host's balance: the highest derivatives (by unknown). If the mechanism has energies, also T, V,
     * input power, loss power, the momenta (by unknown), and the integral if it is not T + V. */
    op_list *books;
} program;

/* Makes the lists of an instance. `conserve` [count] names the coordinates to recover from their momentum, or is
 * NULL. Returns NULL after an error, which is reported to `errors`, such as too many components, a momentum that is
 * not conserved, or a constant that is not finite. */
program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors);
/* Replaces the step's functions of one angle by table look-ups (tables.h). If that is impossible, returns false and
 * reports the place. */
bool program_look_up(program *p, const equations *e, image_settings *settings, diags *errors);
void program_free(program *p);

uint64_t program_hash(const program *p);

#endif
