/* equations.h: the equations of motion of one instance, in symbols.
 *
 * For a mechanism given by energies these are Lagrange's equations (dissertation eq. (1)):
 *
 *     d/dt(dL/dq') - dL/dq = -dF/dq' + Q,        L = T - V
 *
 * kept in the parts that a reader wants to see apart: sum_j mass[i][j] q_j'' + velocity[i] +
 * potential[i] = applied[i]. For a system given outright, mass[e][s] is the coefficient of the
 * highest derivative of unknown s in equation e. */
#ifndef DERIVE_EQUATIONS_H
#define DERIVE_EQUATIONS_H

#include "host/algebra/poly.h"
#include "host/derive/contacts.h"
#include "host/number/folding.h"

/* === forces =================================================================================== */
/* What acts on the coordinates besides the energies, by the statement that it comes from. The equations of
 * motion, the powers of the host's books and the entries of the ledger are all made of these. */

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

typedef struct unknown {
    const symbol *symbol;
    int order; /* of its highest derivative; 2 for a coordinate */
} unknown;

typedef struct equations {
    algebra *algebra;
    const instance *instance;
    int count;         /* unknowns, and equations */
    unknown *unknowns; /* [count] */
    const poly **mass; /* [count * count] row by row */
    double
        mass_blur; /* by such a part rounding of mass[] puts accelerations off, at the best of the states tried */
    folding_notes folding;  /* of the file's numbers */
    const poly **velocity;  /* [count] centrifugal and Coriolis terms; zero for a system */
    const poly **potential; /* [count] dV/dq; for a system all else, moved to the left */
    const poly **applied;   /* [count] Q - dF/dq'; zero for a system */
    /* Energies and what follows from them; NULL for a system. */
    const poly *kinetic;
    const poly *stored;
    statement_force *force; /* [forces] by statement: applied[], and what they give to the energy */
    int forces;
    const poly **momentum;  /* [count] dL/dq' */
    bool *conserved;        /* [count] momentum[i] is constant: no force, no potential, no loss */
    const poly **output;    /* [mechanism->output_count] */
    contact_laws *contacts; /* stops, holds, frictions, crossings; NULL when there are none */
} equations;

void equations_free(equations *e);

/* Where the first kinetic energy stands. */
place equations_kinetic_place(const instance *inst);

/* Report that the equations grew beyond what can be handled. */
void equations_report_growth(const equations *e, diags *errors);

/* mass * highest = force: everything but the highest derivatives, on the right. */
const poly *equations_force(const equations *e, int i);

/* p with the instance's values put in for its parameters. */
const poly *equations_fold(const equations *e, const poly *p);

/* === the energy that the book keeps =========================================================== */
/* Which quantity the energy book keeps.
 *
 * Lagrange's equations with forces Q and a dissipation function F change the energy integral (Jacobi's)
 *
 *     h = sum_i q_i' dL/dq_i' - L,      dh/dt = sum_i q_i' (Q_i - dF/dq_i') - (dL/dt of the inputs),
 *
 * and no other sum of energies (Goldstein, Classical Mechanics, section 2.7). With T a homogeneous
 * quadratic form of the rates and V free of them, h is T + V. On a turntable, in a magnetic potential or
 * at relativistic speeds it is not: there T + V also changes by what keeps the turntable turning, which
 * no statement of the file mentions. */

/* h, folded, where it is not T + V; NULL where it is, or for a system. Where it is, nothing enters the
 * algebra: the order of its terms, and with it the generated code, stays as it was. */
const poly *energy_integral(const equations *e);

/* The power of what drives unknown i, an input with a rate: what it must do beyond the forces, losses and contacts. */
const poly *energy_drive(const equations *e, int i);

/* Does any mass depend on a rate? Then an impulse is not mass times the change of the rates. */
bool energy_mass_has_rates(const equations *e);

#endif
