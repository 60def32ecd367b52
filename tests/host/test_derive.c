/* test_derive.c: the derived equations: against the dissertation's, against the energy balance, and the
 * operation list against the equations it was made from; their cost; and what cannot be derived. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "derived.h"
#include "host/run/engine.h"
#include "unity.h"

void suite_derive(void);

enum { STATES = 50, UNKNOWNS = 16 };

static void random_state(state_values *s, const derived *d, uint64_t *seed) {
    s->instance = d->instance;
    TEST_ASSERT_TRUE(d->equations->count <= UNKNOWNS);
    for (int i = 0; i < d->equations->count; i++) {
        for (int primes = 0; primes < ORDERS_MAX; primes++) {
            /* lengths stay positive and angles off the poles: singular points are not the matter here */
            s->value[i][primes] =
                primes == 0 ? random_between(seed, 0.2, 1.1) : random_between(seed, -2.0, 2.0);
        }
    }
}

static void expect_derived(const derived *d, const char *what) {
    if (d->program == NULL) {
        printf("  %s: %s\n", what, d->errors);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(d->program, what);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", d->errors, what);
}

/* --- the dissertation's equations ----------------------------------------------------------------*/

/* Left side minus right side of equation i, and the size of its parts. */
static double residual(const equations *e, state_values *s, int i, double *size) {
    const double parts[] = {poly_evaluate(e->velocity[i], state_value, s),
                            poly_evaluate(e->potential[i], state_value, s),
                            -poly_evaluate(e->applied[i], state_value, s)};
    double sum = 0.0;
    *size = 0.0;
    for (int k = 0; k < 3; k++) {
        sum += parts[k];
        *size += fabs(parts[k]);
    }
    for (int j = 0; j < e->count; j++) {
        const double part =
            poly_evaluate(e->mass[i * e->count + j], state_value, s) * s->value[j][2];
        sum += part;
        *size += fabs(part);
    }
    return sum;
}

/* The printed equations, left minus right side; v[coordinate][primes]. */
typedef void printed(const double v[][ORDERS_MAX], const double *p, double *rest);

/* (3), (4), (5): r, theta, phi; m, g */
static void spherical(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m = p[0], g = p[1];
    const double r = v[0][0], dr = v[0][1], ddr = v[0][2];
    const double s = sin(v[1][0]), c = cos(v[1][0]), w = v[1][1], dw = v[1][2];
    const double f = v[2][1], df = v[2][2];
    rest[0] = -m * r * w * w + m * ddr - m * r * s * s * f * f + m * g * c;
    rest[1] = 2 * m * r * w * dr + m * r * r * dw - m * r * r * s * f * f * c - m * g * r * s;
    rest[2] = 2 * m * r * s * s * f * dr + 2 * m * r * r * s * f * c * w + m * r * r * s * s * df;
}

/* (6), (7): X, Y; m1, m2, K1, K2, A, B */
static void two_masses(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m1 = p[0], m2 = p[1], K1 = p[2], K2 = p[3], A = p[4], B = p[5];
    rest[0] = (m1 + m2) * v[0][2] + m2 * v[1][2] + K1 * v[0][0] + A * (v[1][1] + v[0][1]);
    rest[1] = v[0][2] * m2 + m2 * v[1][2] + K2 * v[1][0] + A * v[1][1] + A * v[0][1] + B * v[1][1];
}

/* Appendix B, the two accelerations of the absolute set; m1, m2, K1, K2, A, B, L1, L2 */
static void two_masses_absolute(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m1 = p[0], m2 = p[1], K1 = p[2], K2 = p[3], A = p[4], B = p[5], L1 = p[6],
                 L2 = p[7];
    const double X = v[0][0], Y = v[1][0], vX = v[0][1], vY = v[1][1];
    rest[0] = m1 * v[0][2] + (-B * vY + B * vX + K1 * X - K1 * L1 - K2 * Y + K2 * X + K2 * L2);
    rest[1] = m2 * v[1][2] - (-B * vY - vY * A + B * vX - K2 * Y + K2 * X + K2 * L2);
}

/* (11), (10): theta, X; m, r, I and the input M */
static void epicyclic(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m = p[0], r = p[1], I = p[2], M = 2.0;
    const double s = sin(v[0][0]), c = cos(v[0][0]), w = v[0][1], dw = v[0][2];
    rest[0] = -2 * m * v[1][2] * r * s + (4 * m * r * r + 4 * I) * dw - M;
    rest[1] = 2 * m * v[1][2] - 2 * m * r * dw * s - 2 * m * r * w * w * c;
}

/* EQ1, EQ2 of section III.3 */
static void driven_hinge(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double k = p[0] * p[1] * p[1], I = p[2], M = -2.0;
    const double s1 = sin(v[0][0]), c1 = cos(v[0][0]), s2 = sin(v[1][0]), c2 = cos(v[1][0]);
    const double w1 = v[0][1], w2 = v[1][1];
    rest[0] =
        -k * (-c2 * s1 + s2 * c1) * w2 * w2 - k * (-c2 * c1 - s2 * s1) * v[1][2] + k * v[0][2] - M;
    rest[1] = (I + k) * v[1][2] + (k * c2 * c1 + k * s2 * s1) * v[0][2] - k * c2 * s1 * w1 * w1 +
              k * s2 * c1 * w1 * w1;
}

/* EQ1, EQ2 of section III.4; EQ3 is the rate of the momentum along the slider (its print is damaged). */
static void thomson(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m = p[0], r = p[1], I = p[2], M = -2.0, k = m * r * r;
    const double s1 = sin(v[0][0]), c1 = cos(v[0][0]), s2 = sin(v[1][0]), c2 = cos(v[1][0]);
    const double w1 = v[0][1], a1 = v[0][2], w2 = v[1][1], a2 = v[1][2], aX = v[2][2];
    rest[0] = (-4 * m * r * s1 * c1 - 4 * m * r * s1) * aX +
              (4 * k * s1 * c1 * s2 - 2 * k * c2 + 2 * k * s1 * s2 + 2 * k * c1 * c2 +
               4 * k * c1 * c1 * c2) *
                  a2 +
              (8 * k * c1 + 4 * I + 12 * k) * a1 - 4 * k * s1 * w1 * w1 +
              (2 * k * s2 + 2 * k * s1 * c2 - 2 * k * c1 * s2 - 4 * k * c1 * c1 * s2 +
               4 * k * c1 * c2 * s1) *
                  w2 * w2 -
              M;
    rest[1] = -m * r * s2 * aX + k * a2 +
              m * r *
                  (4 * r * c1 * c1 * c2 + 2 * r * c1 * c2 + 4 * r * s1 * c1 * s2 - 2 * r * c2 +
                   2 * r * s1 * s2) *
                  a1 +
              m * r * w1 * w1 *
                  (-2 * r * s1 * c2 + 8 * r * c1 * c1 * s2 - 4 * r * s2 + 2 * r * c1 * s2 -
                   8 * r * c1 * c2 * s1);
    rest[2] = 3 * m * aX - 4 * m * r * (a1 * s1 + w1 * w1 * c1) -
              2 * m * r * (a1 * sin(2 * v[0][0]) + 2 * w1 * w1 * cos(2 * v[0][0])) -
              m * r * (a2 * s2 + w2 * w2 * c2);
}

static void check_printed(const char *name, printed *as_printed) {
    derived d = derived_builtin(name);
    expect_derived(&d, name);
    uint64_t seed = 1088;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, &d, &seed);
        double rest[UNKNOWNS] = {0.0};
        as_printed((const double(*)[ORDERS_MAX])s.value, d.instance->parameter, rest);
        for (int i = 0; i < d.equations->count; i++) {
            double size;
            const double ours = residual(d.equations, &s, i, &size);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-13 * size, rest[i], ours, name);
        }
    }
    derived_free(&d);
}

static void test_the_dissertations_equations(void) {
    check_printed("spherical_particle", spherical);
    check_printed("masses_relative", two_masses);
    check_printed("masses_absolute", two_masses_absolute);
    check_printed("epicyclic", epicyclic);
    check_printed("driven_hinge", driven_hinge);
    check_printed("thomson", thomson);
}

/* --- every mechanism -----------------------------------------------------------------------------*/

static const char *const lagrangian[] = {"bead_on_hoop",
                                         "bead_on_wire",
                                         "cart_pole",
                                         "charged_particle",
                                         "contact",
                                         "double_pendulum",
                                         "elastic_pendulum",
                                         "furuta",
                                         "kepler",
                                         "leaking_mass",
                                         "mass_chain",
                                         "morse",
                                         "planar_arm",
                                         "quadratic_drag",
                                         "simple_pendulum",
                                         "slider_crank",
                                         "spherical_pendulum",
                                         "swinging_atwood",
                                         "symmetric_top",
                                         "tan_well",
                                         "triple_pendulum",
                                         "vortex"};
static const char *const systems[] = {"dc_motor", "implicit_pair", "jerk",
                                      "lorenz",   "mixed_order",   "van_der_pol"};

static derived mechanism_file(const char *name) {
    char path[128];
    snprintf(path, sizeof path, "tests/mechanisms/%s.whirl", name);
    derived d = derived_file(path);
    expect_derived(&d, name);
    return d;
}

/* Solve the n by n equations for the highest derivatives by elimination with pivots. */
static void dense_solution(const equations *e, state_values *s, double x[UNKNOWNS]) {
    const int n = e->count;
    double a[UNKNOWNS][UNKNOWNS + 1];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            a[i][j] = poly_evaluate(e->mass[i * n + j], state_value, s);
        }
        a[i][n] = poly_evaluate(equations_force(e, i), state_value, s);
    }
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++) {
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        }
        for (int j = 0; j <= n; j++) {
            const double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        for (int i = 0; i < n; i++) {
            const double part = i == k ? 0.0 : a[i][k] / a[k][k];
            for (int j = k; j <= n; j++) {
                a[i][j] -= part * a[k][j];
            }
        }
    }
    for (int k = 0; k < n; k++) {
        x[k] = a[k][n] / a[k][k];
    }
}

/* What a list gives at a state. */
static void run_list(const tape *t, const derived *d, const state_values *s, double *result) {
    const program *p = d->program;
    double angle_rad[UNKNOWNS] = {0};
    double real[4 * UNKNOWNS] = {0};
    for (int i = 0; i < p->angles; i++) {
        angle_rad[i] = s->value[p->angle[i].unknown][p->angle[i].primes];
    }
    for (int i = 0; i < p->reals; i++) {
        real[i] = s->value[p->real[i].unknown][p->real[i].primes];
    }
    evaluator *ev = evaluator_new(t);
    evaluator_run(ev, 0.0, angle_rad, real, real + (p->coordinates - p->angles), d->instance->input,
                  result);
    evaluator_free(ev);
}

static void check_list(const derived *d, const char *name, double *worst) {
    const program *p = d->program;
    uint64_t seed = 5;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        double wanted[UNKNOWNS];
        double got[4 * UNKNOWNS];
        dense_solution(d->equations, &s, wanted);
        run_list(p->step, d, &s, got);
        double largest = 0.0;
        for (int i = 0; i < d->equations->count; i++) {
            largest = fmax(largest, fabs(wanted[i]));
        }
        for (int c = 0; c < p->step->results; c++) {
            component of = {c, 1};
            if (p->form == WH_FIRST_ORDER) {
                of = c < p->angles ? p->angle[c] : p->real[c - p->angles];
            } else {
                while (p->place[of.unknown = (of.unknown + 1) % d->equations->count] != c) {
                }
            }
            const bool highest = of.primes + 1 == d->equations->unknowns[of.unknown].order;
            const double want = highest ? wanted[of.unknown] : s.value[of.unknown][of.primes + 1];
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-10 * largest, want, got[c], name);
            *worst = fmax(*worst, fabs(want - got[c]) / fmax(largest, 1e-300));
        }
    }
}

static void test_operation_lists_solve_the_equations(void) {
    double worst = 0.0;
    for (size_t i = 0; i < sizeof lagrangian / sizeof lagrangian[0]; i++) {
        derived d = mechanism_file(lagrangian[i]);
        check_list(&d, lagrangian[i], &worst);
        derived_free(&d);
    }
    for (size_t i = 0; i < sizeof systems / sizeof systems[0]; i++) {
        derived d = mechanism_file(systems[i]);
        check_list(&d, systems[i], &worst);
        derived_free(&d);
    }
    printf("  largest deviation %.1e of the largest derivative\n", worst);
}

/* h = sum q' dL/dq' - L changes by the power of the inputs less the losses: dh/dt with the accelerations
 * of the operation list, by central difference along the motion. */
static void check_balance(const derived *d, const char *name) {
    const equations *e = d->equations;
    uint64_t seed = 17;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        double books[UNKNOWNS * 3 + 8];
        run_list(d->program->books, d, &s, books);
        double size = 1e-3;
        double rate = 0.0;
        for (int side = -1; side <= 1; side += 2) { /* state moved along itself by a little time */
            const double dt = 1e-5 * side;
            state_values near = s;
            for (int i = 0; i < e->count; i++) {
                near.value[i][0] += dt * s.value[i][1];
                near.value[i][1] += dt * books[i];
            }
            double h = poly_evaluate(e->stored, state_value, &near) -
                       poly_evaluate(e->kinetic, state_value, &near);
            for (int i = 0; i < e->count; i++) {
                const double part =
                    near.value[i][1] * poly_evaluate(e->momentum[i], state_value, &near);
                h += part;
                size = fmax(size, fabs(part));
            }
            rate += h / (2.0 * dt);
            size = fmax(size, fabs(h));
        }
        for (int i = 0; i < e->count; i++) {
            size = fmax(size, fabs(books[i] * s.value[i][1]));
        }
        const double *entry = books + e->count;
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-7 * (size + size * size), 0.0,
                                          rate - entry[BOOK_INPUT_POWER] + entry[BOOK_LOSS_POWER],
                                          name);
    }
}

static void test_power_balances_in_every_mechanism(void) {
    for (size_t i = 0; i < sizeof lagrangian / sizeof lagrangian[0]; i++) {
        derived d = mechanism_file(lagrangian[i]);
        check_balance(&d, lagrangian[i]);
        derived_free(&d);
    }
    static const char *const own[] = {"spherical_particle", "masses_relative", "masses_absolute",
                                      "epicyclic",          "driven_hinge",    "thomson_a_spin"};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        derived d = derived_builtin(own[i]);
        expect_derived(&d, own[i]);
        check_balance(&d, own[i]);
        derived_free(&d);
    }
}

/* --- cost ----------------------------------------------------------------------------------------*/

/* Two-sided: fewer is good news that wants a new bound, and a look at what was lost. */
static void expect_cost(const char *name, int at_least, int at_most, int waves) {
    derived d = derived_builtin(name);
    expect_derived(&d, name);
    const int operations = tape_operations(d.program->step);
    printf("  %s: %d operations, %d sine pairs\n", name, operations,
           tape_count(d.program->step).waves);
    TEST_ASSERT_TRUE_MESSAGE(operations >= at_least && operations <= at_most, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(waves, tape_count(d.program->step).waves, name);
    derived_free(&d);
}

static void test_right_hand_sides_stay_small(void) {
    expect_cost("thomson_a", 60, 85, 2);
    expect_cost("epicyclic_from_rest", 8, 14, 1);
    expect_cost("driven_hinge_from_rest", 10, 20, 1);
    expect_cost("spherical_flight", 25, 40, 1);
    expect_cost("two_mass_relative", 8, 20, 0);
}

static void test_large_but_tame_expressions_are_derived(void) {
    derived d = derived_text("mechanism m\ncoordinate a\ncoordinate b\ncoordinate c\ncoordinate d\n"
                             "coordinate e\nT = 1 [kg*m^2]*(a'^2 + b'^2 + c'^2 + d'^2 + e'^2)/2\n"
                             "V = 1 [J]*(a + b + c + d + e)^60\n");
    expect_derived(&d, "(a+b+c+d+e)^60");
    state_values s = {.instance = d.instance,
                      .value = {{0.1, 0, 0}, {0.25, 0, 0}, {0.3, 0, 0}, {0.2, 0, 0}, {0.05, 0, 0}}};
    double result[5];
    run_list(d.program->step, &d, &s, result);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, -60.0 * pow(0.9, 59.0), result[3]);
    derived_free(&d);

    char *front = repeated("mechanism m\n", "coordinate x# [m]\n", 64,
                           "let x0 = 0 [m]\nT = 1 [kg]*(0 [m^2/s^2]");
    char *energy = repeated(front, " + x#'^2", 64, ")/2\nV = 3 [N/m]/2*(0 [m^2]");
    char *whole = repeated(energy, " + (x# - x@)^2", 64, ")\n");
    const clock_t began = clock();
    d = derived_text(whole);
    expect_derived(&d, "64 masses");
    TEST_ASSERT_TRUE((double)(clock() - began) / CLOCKS_PER_SEC < 20.0);
    TEST_ASSERT_EQUAL_INT(64, d.program->coordinates);
    /* 3 (x_{i+1} - 2 x_i + x_{i-1}) needs some four operations a mass */
    TEST_ASSERT_TRUE(tape_operations(d.program->step) <= 64 * 5);
    derived_free(&d);
    free(front);
    free(energy);
    free(whole);
}

void suite_derive(void) {
    UnitySetTestFile(__FILE__);
    RUN_TEST(test_the_dissertations_equations);
    RUN_TEST(test_operation_lists_solve_the_equations);
    RUN_TEST(test_power_balances_in_every_mechanism);
    RUN_TEST(test_right_hand_sides_stay_small);
    RUN_TEST(test_large_but_tame_expressions_are_derived);
}
