/* equations.h: the equations of motion of one instance, in symbols.
 *
 * For a mechanism given by energies these are Lagrange's equations (dissertation eq. (1)):
 *
 *     d/dt(dL/dq') - dL/dq = -dF/dq' + Q,        L = T - V
 *
 * kept in the parts that a reader wants to see apart: sum_j mass[i][j] q_j'' + velocity[i] +
 * potential[i] = applied[i]. For a system given outright, mass[e][s] is the coefficient of the
 * highest derivative of unknown s in equation e.
 */
#ifndef DERIVE_EQUATIONS_H
#define DERIVE_EQUATIONS_H

#include "contacts.h"
#include "forces.h"
#include "host/algebra/poly.h"
#include "host/number/folding.h"

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

#endif
