/* linkage_lagrange.c: the accelerations of a linkage from numeric derivatives of its energies, in long double and
 * without algebra. The variables are q0, q0', q1, q1', ...; the equations are
 *
 *   sum_j L_q'i_q'j q''_j = Q_i - F_q'i + L_qi - sum_j L_q'i_qj q'_j. */
#include "linkage.h"

#include "test.h"
#include <math.h>

/* --- numbers with derivatives ------------------------------------------------------------------------*/

/* A jet is a number with its first and second derivatives by all variables. With jets, the derivatives of a
 * Lagrangian are computed in numbers, without algebra. */

enum { JET_VARIABLES = 8, JET_PAIRS = JET_VARIABLES * (JET_VARIABLES + 1) / 2 };

typedef struct jet {
    int variables; /* derivatives by variables with this number or a higher one are zero */
    long double value;
    long double slope[JET_VARIABLES];
    /* second derivatives, by pairs of variables: 00, 10, 11, 20, ... */
    long double curve[JET_PAIRS];
} jet;

static int most(int a, int b) { return a > b ? a : b; }

static int pairs(int variables) { return variables * (variables + 1) / 2; }

static long double jet_curve(const jet *a, int i, int j) {
    return i >= j ? a->curve[i * (i + 1) / 2 + j] : a->curve[j * (j + 1) / 2 + i];
}

static jet jet_number(long double value) { return (jet){.value = value}; }

static jet jet_variable(int which, long double value) {
    jet made = {.variables = which + 1, .value = value};
    made.slope[which] = 1.0L;
    return made;
}

static void jet_add(jet *sum, long double factor, const jet *a) {
    sum->variables = most(sum->variables, a->variables);
    sum->value += factor * a->value;
    for (int i = 0; i < a->variables; i++) {
        sum->slope[i] += factor * a->slope[i];
    }
    for (int k = 0; k < pairs(a->variables); k++) {
        sum->curve[k] += factor * a->curve[k];
    }
}

static jet jet_sum(jet a, jet b) {
    jet_add(&a, 1.0L, &b);
    return a;
}

/* Returns f(a) by the chain rule. `f`, `first` and `second` are the value and derivatives of f at a's value. */
static jet chained(const jet *a, long double f, long double first, long double second) {
    jet made = {.variables = a->variables, .value = f};
    for (int i = 0, k = 0; i < a->variables; i++) {
        made.slope[i] = first * a->slope[i];
        for (int j = 0; j <= i; j++, k++) {
            made.curve[k] = first * a->curve[k] + second * a->slope[i] * a->slope[j];
        }
    }
    return made;
}

static jet jet_times(long double factor, jet a) {
    return chained(&a, factor * a.value, factor, 0.0L);
}

static jet jet_product(jet a, jet b) {
    jet made = {.variables = most(a.variables, b.variables), .value = a.value * b.value};
    for (int i = 0, k = 0; i < made.variables; i++) {
        made.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
        for (int j = 0; j <= i; j++, k++) {
            made.curve[k] = a.curve[k] * b.value + a.value * b.curve[k] + a.slope[i] * b.slope[j] +
                            a.slope[j] * b.slope[i];
        }
    }
    return made;
}

static jet jet_square(jet a) { return chained(&a, a.value * a.value, 2.0L * a.value, 2.0L); }

static jet jet_sine(jet a) { return chained(&a, sinl(a.value), cosl(a.value), -sinl(a.value)); }

static jet jet_cosine(jet a) { return chained(&a, cosl(a.value), -sinl(a.value), -cosl(a.value)); }

/* The square root. The value of `a` must be positive. */
static jet jet_root(jet a) {
    const long double root = sqrtl(a.value);
    return chained(&a, root, 0.5L / root, -0.25L / (root * a.value));
}

_Static_assert(2 * LINKAGE_BODIES <= JET_VARIABLES, "a variable for each value and rate");

/* The numbers of a body's variables. A body's place depends only on variables of this body and earlier ones. */
static int value_of(int body) { return 2 * body; }
static int rate_of(int body) { return 2 * body + 1; }

typedef struct moving {
    jet x, y, u, v;
} moving;

/* A body: its origin, direction and angular velocity. `metre` is the point one metre along the body, relative to the
 * origin. */
typedef struct placed {
    moving origin;
    jet direction;
    jet turning;
    moving metre;
} placed;

static moving along(const placed *b, double out_m) {
    const long double out = (long double)out_m;
    moving end = b->origin;
    jet_add(&end.x, out, &b->metre.x);
    jet_add(&end.y, out, &b->metre.y);
    jet_add(&end.u, out, &b->metre.u);
    jet_add(&end.v, out, &b->metre.v);
    return end;
}

/* Moves a point by the distance `q` along the direction `metre`, at the speed `rate`. */
static void slide(moving *point, const moving *metre, jet q, jet rate) {
    point->x = jet_sum(point->x, jet_product(q, metre->x));
    point->y = jet_sum(point->y, jet_product(q, metre->y));
    point->u = jet_sum(point->u, jet_product(rate, metre->x));
    point->u = jet_sum(point->u, jet_product(q, metre->u));
    point->v = jet_sum(point->v, jet_product(rate, metre->y));
    point->v = jet_sum(point->v, jet_product(q, metre->v));
}

static placed place_body(const linkage_body *b, const placed *parent, jet q, jet rate) {
    placed made = {.origin = along(parent, b->at_m), .turning = parent->turning};
    if (b->slides) {
        made.direction = jet_sum(parent->direction, jet_number((long double)b->rail_rad));
    } else {
        made.direction = b->relative ? jet_sum(parent->direction, q) : q;
        made.turning = b->relative ? jet_sum(parent->turning, rate) : rate;
    }
    made.metre.x = jet_cosine(made.direction);
    made.metre.y = jet_sine(made.direction);
    made.metre.u = jet_times(-1.0L, jet_product(made.turning, made.metre.y));
    made.metre.v = jet_product(made.turning, made.metre.x);
    if (b->slides) {
        slide(&made.origin, &made.metre, q, rate);
    }
    return made;
}

typedef struct sums {
    jet lagrangian;
    jet dissipation;
} sums;

static void into(jet *sum, long double factor, jet a) { jet_add(sum, factor, &a); }

static jet squares(jet a, jet b) { return jet_sum(jet_square(a), jet_square(b)); }

static void add_body(const linkage *of, const linkage_body *b, const placed *at, jet q, jet rate,
                     sums *s) {
    const moving centre = along(at, b->centre_m);
    const moving end = along(at, 2.0 * b->centre_m);
    const long double mass = (long double)b->mass_kg;
    const jet stretch = jet_sum(q, jet_number(-(long double)b->rest));
    into(&s->lagrangian, mass / 2.0L, squares(centre.u, centre.v));
    into(&s->lagrangian, (long double)b->inertia_kgm2 / 2.0L, jet_square(at->turning));
    into(&s->lagrangian, mass * (long double)of->gravity_mps2[0], centre.x);
    into(&s->lagrangian, mass * (long double)of->gravity_mps2[1], centre.y);
    into(&s->lagrangian, -(long double)b->stiffness / 2.0L, jet_square(stretch));
    into(&s->dissipation, (long double)b->damping / 2.0L, jet_square(rate));
    into(&s->dissipation, (long double)b->drag_Nspm / 2.0L, squares(end.u, end.v));
}

static void add_spring(const linkage *of, const linkage_spring *spring, const placed *at, sums *s) {
    const moving end = along(&at[spring->body], 2.0 * of->body[spring->body].centre_m);
    const jet x = jet_sum(end.x, jet_number(-(long double)spring->x_m));
    const jet y = jet_sum(end.y, jet_number(-(long double)spring->y_m));
    jet energy = squares(x, y);
    if (spring->length_m != 0.0) {
        const jet length = jet_number(-(long double)spring->length_m);
        energy = jet_square(jet_sum(jet_root(energy), length));
    }
    into(&s->lagrangian, -(long double)spring->stiffness_Npm / 2.0L, energy);
}

long double linkage_solve(const linkage *of, const linkage_numbers *at, const long double *y,
                          long double *x) {
    const int n = of->bodies;
    long double least = 1.0L;
    long double a[LINKAGE_BODIES][LINKAGE_BODIES + 1];
    for (int i = 0; i < n; i++) {
        memcpy(a[i], at->mass[i], sizeof at->mass[i]);
        a[i][n] = y[i];
    }
    for (int c = 0; c < n; c++) { /* a positive definite matrix needs no pivoting */
        least = fminl(least, a[c][c] / at->mass[c][c]);
        for (int i = 0; i < n; i++) {
            const long double share = i == c ? 0.0L : a[i][c] / a[c][c];
            for (int j = c; j <= n && i != c; j++) {
                a[i][j] -= share * a[c][j];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        x[i] = a[i][n] / a[i][i];
    }
    return least;
}

void linkage_evaluate(const linkage *of, const long double *q, const long double *rate,
                      linkage_numbers *out) {
    const int n = of->bodies;
    placed at[LINKAGE_BODIES];
    const placed ground = {.metre = {.x = jet_number(1.0L)}};
    sums s = {.lagrangian = jet_number(0.0L), .dissipation = jet_number(0.0L)};
    for (int k = 0; k < n; k++) {
        const linkage_body *b = &of->body[k];
        const jet value = jet_variable(value_of(k), q[k]);
        const jet speed = jet_variable(rate_of(k), rate[k]);
        at[k] = place_body(b, b->parent < 0 ? &ground : &at[b->parent], value, speed);
        add_body(of, b, &at[k], value, speed, &s);
        const moving end = along(&at[k], 2.0 * b->centre_m);
        out->end[k].y_m = end.y.value;
        out->end[k].bend_mps2 = 0.0L;
        for (int i = 0; i < n; i++) {
            out->end[k].row[i] = end.y.slope[value_of(i)];
            out->end[k].bend_mps2 += end.v.slope[value_of(i)] * rate[i];
        }
    }
    for (int k = 0; k < of->springs; k++) {
        add_spring(of, &of->spring[k], at, &s);
    }
    for (int i = 0; i < n; i++) {
        const linkage_body *b = &of->body[i];
        out->force[i] = (long double)b->drive * cosl((long double)b->wave * q[i]);
        out->force[i] += s.lagrangian.slope[value_of(i)] - s.dissipation.slope[rate_of(i)];
        for (int j = 0; j < n; j++) {
            out->mass[i][j] = jet_curve(&s.lagrangian, rate_of(i), rate_of(j));
            out->force[i] -= jet_curve(&s.lagrangian, rate_of(i), value_of(j)) * rate[j];
        }
    }
}

enum { STATE = 2 * LINKAGE_BODIES };

static long double slopes(const linkage *of, const long double *state, long double *slope) {
    linkage_numbers at;
    linkage_evaluate(of, state, state + LINKAGE_BODIES, &at);
    memcpy(slope, state + LINKAGE_BODIES, LINKAGE_BODIES * sizeof *slope);
    return linkage_solve(of, &at, at.force, slope + LINKAGE_BODIES);
}

void linkage_integrate(const linkage *of, double step_s, int steps, linkage_motion *end) {
    static const long double node[4] = {0.0L, 0.5L, 0.5L, 1.0L};
    static const long double weight[4] = {1.0L / 6.0L, 1.0L / 3.0L, 1.0L / 3.0L, 1.0L / 6.0L};
    const long double h = (long double)step_s;
    *end = (linkage_motion){.least = 1.0L};
    for (int k = 0; k < of->bodies; k++) {
        end->state[k] = (long double)of->start[k];
        end->state[LINKAGE_BODIES + k] = (long double)of->start_rate[k];
    }
    for (int step = 0; step < steps; step++) {
        long double slope[STATE] = {0.0L};
        linkage_motion next = *end;
        for (int stage = 0; stage < 4; stage++) {
            long double at[STATE];
            for (int i = 0; i < STATE; i++) {
                at[i] = end->state[i] + node[stage] * h * slope[i];
            }
            next.least = fminl(next.least, slopes(of, at, slope));
            for (int i = 0; i < STATE; i++) {
                next.state[i] += weight[stage] * h * slope[i];
            }
        }
        *end = next;
    }
}
