/* equations.h: the symbolic equations of motion of one instance.
 *
 * For a mechanism given by energies these are Lagrange's equations (dissertation eq. (1)):
 *
 *     d/dt(dL/dq') - dL/dq = -dF/dq' + Q,        L = T - V
 *
 * The parts stay separate for readers: sum_j mass[i][j] q_j'' + velocity[i] + potential[i] = applied[i]. For a system
 * given by equations, mass[e][s] is the coefficient of the highest derivative of unknown s in equation e. */
#ifndef DERIVE_EQUATIONS_H
#define DERIVE_EQUATIONS_H

#include "host/algebra/poly.h"
#include "host/number/folding.h"

/* === the symbolic contacts of an instance, in the order of core/contact.h ===================== */

typedef struct contact_law {
    const contact_statement *from;
    const poly *value; /* stop: gap; hold: condition; friction: rate; crossing: left - right */
    const poly *speed; /* J q': rate of the gap or of the hold's expression; else zero */
    /* stop: restitution; friction: mu_static * max(N, 0); hold with `straight` false: its expression; else zero */
    const poly *first;
    const poly *second; /* friction: mu_kinetic * max(N, 0) */
    const poly *bias;   /* J' q' */
    const poly **row;   /* [coordinates] J; NULL for a crossing */
    const poly **set;   /* [from->set_count] values that a crossing sets */
    bool straight;      /* J is constant, and the hold's expression contains no input */
    bool driven;        /* the contact follows an input with a rate */
} contact_law;

typedef struct contact_laws {
    int count;
    int forced;       /* number of contacts that are not crossings; crossings come last */
    contact_law *law; /* [count] */
    int set_count;    /* number of values that crossings set */
} contact_laws;

/* True for the crossing at which a friction's varying normal force reaches or leaves zero. The crossing sets no value.
 * A step of fourth order must not span the crossing, because the force has a kink there. */
bool contact_loosens(const contact_statement *h);

/* The active contacts of the instance, in the memory of the algebra, or NULL. */
contact_laws *contact_laws_make(algebra *a, const instance *inst);

/* Can this contact, or any of these contacts, change the momentum of coordinate i? */
bool contact_law_pushes(const contact_law *law, int i);
bool contact_laws_push(const contact_laws *laws, int i);

/* === forces =================================================================================== */

/* Forces of one statement: force[i] is Q_i or -dF/dq_i'. Their power is sum_i force[i] q_i'. If it is positive, the
 * mechanism gains energy. */
typedef struct statement_force {
    const term *from;
    const poly **force; /* [coordinates] of the mechanism */
    const poly *power;
} statement_force;

/* Returns the forces of the *count active statements Q and F, in the order of the file. A system has none. */
statement_force *forces_derive(algebra *a, const instance *inst, int *count);

const poly *forces_on(algebra *a, const statement_force *forces, int count, int i);
/* The power of all statements of a kind, TERM_Q or TERM_F. */
const poly *forces_power(algebra *a, const statement_force *forces, int count, term_kind kind);

typedef struct unknown {
    const symbol *symbol;
    int order; /* order of the highest derivative; 2 for a coordinate */
} unknown;

typedef struct equations {
    algebra *algebra; /* owner of all memory of the equations */
    const instance *instance;
    int count;         /* number of unknowns, and of equations */
    unknown *unknowns; /* [count] */
    const poly **mass; /* [count * count] row by row */
    /* relative error of the accelerations by round-off in mass[]: the smallest error of all tried states */
    double mass_blur;
    folding folding;       /* losses of digits in constant folding (folding.h) */
    const poly **velocity; /* [count] centrifugal and Coriolis terms; zero for a system */
    /* [count] dV/dq. For a system: left minus right side of each equation, without the highest derivatives */
    const poly **potential;
    /* [count] Q - dF/dq'. For a driven coordinate: its acceleration. For a system: zero */
    const poly **applied;
    /* Energies and results derived from them; NULL for a system. */
    const poly *kinetic;
    const poly *stored;
    statement_force *force; /* [forces] one for each active statement Q or F */
    int forces;
    const poly **momentum;  /* [count] dL/dq' */
    bool *conserved;        /* [count] true if momentum[i] is constant */
    const poly **output;    /* [mechanism->output_count] */
    contact_laws *contacts; /* stops, holds, frictions, crossings; NULL without contacts */
} equations;

void equations_free(equations *e); /* `e` may be NULL */

/* Returns expression i of contact k, or NULL if i is too large. The first LAW_POLYS are value, speed, first, second and
 * bias. The next are those of row[], or of set[] for a crossing. */
enum { LAW_POLYS = 5 };
const poly *contact_law_poly(const equations *e, int k, int i);

/* A poly_value. Returns a hash of *seed (a uint64_t), s and primes. It is between 0.1 and 1.8 if *seed is even, and
 * between -0.9 and 0.8 if *seed is odd. */
double equations_generic(void *seed, const symbol *s, int primes);

void equations_report_growth(const equations *e, diags *errors);

/* Returns the right-hand side f_i of M q'' = f: all terms without the highest derivatives. */
const poly *equations_force(const equations *e, int i);

/* Returns p with the parameters replaced by the instance's values. */
const poly *equations_fold(const equations *e, const poly *p);

/* === the energy in the balance ================================================================ */
/* The balance uses the energy integral h (Jacobi's), with inputs u_k:
 *
 *     h = sum_i q_i' dL/dq_i' - L,      dh/dt = sum_i q_i' (Q_i - dF/dq_i') - sum_k u_k' dL/du_k.
 *
 * Only the forces Q, the dissipation function F and the inputs change h (Goldstein, Classical Mechanics, section 2.7).
 * If T is a homogeneous quadratic form of the rates and V contains no rate, h equals T + V. Otherwise T + V can also
 * change by work that the file does not mention, such as the work of a turntable's drive. */

/* Returns h, with folded constants. Returns NULL for a system, or if h equals T + V. */
const poly *energy_integral(const equations *e);

/* Returns the power of the drive of unknown i, a driven coordinate. The forces of contacts are not included. */
const poly *energy_drive(const equations *e, int i);

/* Is p_i = sum_j m_ij q_j'? */
bool energy_momentum_is_linear(const equations *e, int i);

/* Does any mass depend on a rate? Then an impulse is not mass times the change of the rates. */
bool energy_mass_has_rates(const equations *e);

#endif
