/* forces.h: what acts on the coordinates besides the energies, by the statement that it comes from. The equations of
 * motion, the powers of the host's books and the entries of the ledger are all made of these. */
#ifndef DERIVE_FORCES_H
#define DERIVE_FORCES_H

#include "host/algebra/poly.h"

/* Of one statement Q or F: the generalized forces Q_i, or -dF/dq_i', and their power, the sum of force times rate:
 * positive where energy comes in. */
typedef struct statement_force {
    const term *from;
    const poly **force; /* [coordinates] of the mechanism */
    const poly *power;
} statement_force;

/* Those of the statements that take part, in the order of the file; *count of them. Empty for a system. The algebra
 * may overflow. Free with forces_free(). */
statement_force *forces_derive(algebra *a, const instance *inst, int *count);
void forces_free(statement_force *forces, int count);

/* What all of them do to coordinate i. */
const poly *forces_on(algebra *a, const statement_force *forces, int count, int i);
/* The power of all statements of a kind, TERM_Q or TERM_F. */
const poly *forces_power(algebra *a, const statement_force *forces, int count, term_kind kind);

#endif
