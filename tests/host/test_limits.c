/* test_limits.c: how long a step may be: measured on the program's own runs, by bisection, against what the rows of the
 * methods have, on the imaginary and on the real axis; what a step takes of an oscillation within that; and the
 * eigenvalues by which a run's motions are judged, against matrices whose eigenvalues are known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/run/limits.h"
#include "motion.h"

#include "unity.h"

void suite_limits(void);

/* --- how long a step may be ----------------------------------------------------------------------------------*/

#define STEPS 40000
#define BEYOND 30.0

static const char spring[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [N/m]*x^2/2\n"
                             "scene s { start x = 1 [m]\nstep 1 [ms]\nuntil 1e6 [s] }\n";
static const char decay[] = "mechanism m\nstate x [m]\nequation x' = -1 [1/s]*x\n"
                            "scene s { start x = 1 [m]\nstep 1 [ms]\nuntil 1e6 [s] }\n";
static const char system_swing[] =
    "mechanism m\nstate x [m]\nstate v [m/s]\nequation x' = v\nequation v' = -1 [1/s^2]*x\n"
    "scene s { start x = 1 [m]\nstep 1 [ms]\nuntil 1e6 [s] }\n";

/* In a system of the first order a step's matrix is as normal as the system's, so that the least growth shows. */
static bool stays(const char *text, wh_method method, double step_s) {
    motion m;
    bool bounded = true;
    motion_open_text(&m, text,
                     (stepping){.kind = &engine_double, .method = method, .step_s = step_s});
    const bool first = m.image->form == WH_FIRST_ORDER;
    double size = 1.0;
    for (int k = 0; k < STEPS && bounded; k++) {
        bounded = motion_step(&m, 1) == WH_OK;
        size = text == system_swing ? hypot(motion_value(&m, "x"), motion_value(&m, "v"))
                                    : fabs(motion_value(&m, "x"));
        bounded = bounded && size < BEYOND;
    }
    motion_close(&m);
    return bounded && (!first || size < 1.0 + 1e-9);
}

static double measured(const char *text, wh_method method) {
    double low = 0.5;
    double high = 5.0;
    TEST_ASSERT_TRUE_MESSAGE(stays(text, method, low), wh_methods[method].word);
    TEST_ASSERT_FALSE_MESSAGE(stays(text, method, high), wh_methods[method].word);
    while (high - low > 1e-3) {
        const double middle = 0.5 * (low + high);
        if (stays(text, method, middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static void test_measured_limits_are_those_of_the_rows(void) {
    const limits_motion swing = limits_plain((complex_number){0.0, 1.0});
    const limits_motion falls = limits_plain((complex_number){-1.0, 0.0});
    double worst = 0.0;
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_method method = (wh_method)m;
        const double by_row = limits_interval(method, WH_SECOND_ORDER, swing);
        if (by_row == 0.0) { /* none: it grows at a quarter of a step as well */
            TEST_ASSERT_TRUE(limits_growth(method, WH_SECOND_ORDER, swing, 0.01) > 1.0);
            TEST_ASSERT_FALSE_MESSAGE(stays(spring, method, 0.5), wh_methods[m].word);
            printf("  %-20s swings: none", wh_methods[m].word);
        } else {
            const double h = measured(spring, method);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.01 * by_row, by_row, h, wh_methods[m].word);
            worst = fmax(worst, fabs(h / by_row - 1.0));
            printf("  %-20s swings: %.4f, by the row %.4f", wh_methods[m].word, h, by_row);
        }
        if (wh_methods[m].takes == WH_ANY_SYSTEM) {
            const double decays = limits_interval(method, WH_FIRST_ORDER, falls);
            const double h = measured(decay, method);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.01 * decays, decays, h, wh_methods[m].word);
            worst = fmax(worst, fabs(h / decays - 1.0));
            printf("; decays: %.4f, by the row %.4f", h, decays);
            const double first = limits_interval(method, WH_FIRST_ORDER, swing);
            if (first > 0.0) {
                const double system = measured(system_swing, method);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.01 * first, first, system, wh_methods[m].word);
                printf("; systems swing: %.4f, by the row %.4f", system, first);
            } else {
                printf("; systems swing: none");
            }
        }
        printf("\n");
    }
    printf("  off by at most %.2g\n", worst);
}

/* Those that books tell (Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.2). */
static void test_known_limits(void) {
    const limits_motion swing = limits_plain((complex_number){0.0, 1.0});
    const limits_motion falls = limits_plain((complex_number){-1.0, 0.0});
    static const struct {
        wh_method method;
        double swing;
        double falls; /* 0: takes none */
    } known[] = {{WH_EULER, 0.0, 2.0},
                 {WH_SEMI_IMPLICIT_EULER, 2.0, 0.0},
                 {WH_HEUN, 0.0, 2.0},
                 {WH_RK4, 2.8284271, 2.7852936},
                 {WH_RK38, 2.8284271, 2.7852936},
                 {WH_LEAPFROG, 2.0, 0.0}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, known[i].swing,
                                  limits_interval(known[i].method, WH_SECOND_ORDER, swing));
        if (known[i].falls > 0.0) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, known[i].falls,
                                      limits_interval(known[i].method, WH_FIRST_ORDER, falls));
        }
    }
}

/* Runge-Kutta's (h w)^6/72 of the energy a step, and the ripple of the two that keep it on the average: h w/2 and, of
 * leapfrog, what its own invariant has: 1 - (h w)^2/4 of the one energy for the other. */
static void test_what_a_step_takes(void) {
    for (int k = 1; k < 20; k++) {
        const double hw = 0.02 * k;
        const limits_motion swing = limits_plain((complex_number){0.0, 1.0});
        const double growth = limits_growth(WH_RK4, WH_SECOND_ORDER, swing, hw);
        TEST_ASSERT_DOUBLE_WITHIN(0.03 * pow(hw, 6.0) / 72.0 + 1e-15, pow(hw, 6.0) / 72.0,
                                  1.0 - growth * growth);
        TEST_ASSERT_DOUBLE_WITHIN(
            1e-9, hw / 2.0, limits_ripple(WH_SEMI_IMPLICIT_EULER, WH_SECOND_ORDER, swing, hw));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, limits_ripple(WH_RK4, WH_SECOND_ORDER, swing, hw));
        const double part = hw * hw / 4.0;
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, part / (2.0 - part),
                                  limits_ripple(WH_LEAPFROG, WH_SECOND_ORDER, swing, hw));
    }
}

/* 1 + z + z^2/2 + ..., so far. */
static complex_number taylor(complex_number z, int order) {
    complex_number sum = {1.0, 0.0};
    for (int k = order; k > 0; k--) { /* Horner's */
        const complex_number part = {z.re / k, z.im / k};
        sum = complex_plus_times((complex_number){1.0, 0.0}, part, sum);
    }
    return sum;
}

/* q'' = (l + m) q' - l m q has the motions l and m: of what Runge-Kutta's own polynomial makes of each, that of the one that is
 * asked for; and what is lost of it over a time. */
static void test_motions_that_turn(void) {
    static const struct {
        wh_method method;
        int order;
    } by[] = {{WH_RK4, 4}, {WH_RK38, 4}, {WH_HEUN, 2}, {WH_EULER, 1}};
    uint64_t seed = 77;
    for (int c = 0; c < 400; c++) {
        const complex_number l = {random_between(&seed, -0.5, 0.1),
                                  random_between(&seed, 0.3, 2.0)};
        const complex_number m = {random_between(&seed, -0.5, 0.1),
                                  random_between(&seed, -2.0, l.im - 0.2)};
        const limits_motion asked = {l, {l.re + m.re, l.im + m.im}};
        const double h = random_between(&seed, 0.01, 0.6);
        const double span = h * random_between(&seed, 1.0, 30.0);
        const complex_number wanted = taylor((complex_number){h * l.re, h * l.im}, by[c % 4].order);
        const double size = sqrt(wanted.re * wanted.re + wanted.im * wanted.im);
        const double exact = exp(l.re * h);
        const double growth = limits_growth(by[c % 4].method, WH_SECOND_ORDER, asked, h);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, size, growth);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, size,
                                  limits_growth(by[c % 4].method, WH_FIRST_ORDER, asked, h));
        double off = 0.0;
        if (size > 1.0 && size > exact) {
            off = pow(size / fmax(exact, 1.0), span / h) - 1.0;
        } else if (exact >= 1.0) {
            off = fmax(1.0 - pow(size / exact, span / h), 0.0);
        } else { /* where that is most, on the way down */
            const double lasts = fmax(fmin(span / h, -1.0 / (l.re * h)), 1.0);
            off = fmin(1.0, lasts * pow(exact, lasts - 1.0) * fabs(size - exact));
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * off + 1e-7, off,
                                  limits_off(by[c % 4].method, WH_SECOND_ORDER, asked, h, span));
    }
}

/* Of leapfrog, of what is not damped by a tenth; of the first order none. */
static void test_ripples_of_what_decays(void) {
    uint64_t seed = 79;
    for (int c = 0; c < 200; c++) {
        const double w = random_between(&seed, 0.2, 4.0);
        const double damping = random_between(&seed, -0.2, 0.2);
        const limits_motion m = limits_plain((complex_number){damping * w, w});
        const double h = random_between(&seed, 0.05, 0.3);
        const double part = w * w * (1.0 + damping * damping) * h * h / 4.0;
        const double wanted = fabs(damping) > 0.1 ? 0.0 : part / (2.0 - part);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted, limits_ripple(WH_LEAPFROG, WH_SECOND_ORDER, m, h));
        TEST_ASSERT_TRUE(limits_ripple(WH_LEAPFROG, WH_FIRST_ORDER, m, h) == 0.0);
    }
}

/* Up to there nothing grows, and just behind it does: of what turns by a millionth, else by more than rounding. What grows from
 * the slowest on has no such step. */
static void test_intervals_end_where_it_grows(void) {
    uint64_t seed = 78;
    unsigned none = 0;
    unsigned some = 0;
    for (int c = 0; c < 240; c++) {
        const wh_method method = (wh_method)(c % WH_METHODS);
        const bool turning = c / WH_METHODS % 2 == 0;
        const double w = random_between(&seed, 0.3, 3.0);
        const double damping = c % 3 == 0 ? 0.0 : -w * random_between(&seed, 0.0, 0.5);
        const complex_number value = {damping, w};
        const complex_number rates = {2.0 * damping, random_between(&seed, 0.2, 2.0) * w};
        const limits_motion m = turning ? (limits_motion){value, rates} : limits_plain(value);
        const double size = sqrt(value.re * value.re + value.im * value.im);
        const bool by_turning = turning && wh_methods[method].takes != WH_NO_RATES;
        const double most = 1.0 + (turning ? 1e-6 : 1e-13);
        if (turning && !by_turning) {
            continue;
        }
        const double limit = limits_interval(method, WH_SECOND_ORDER, m);
        if (limit > 0.0) {
            TEST_ASSERT_TRUE(limits_growth(method, WH_SECOND_ORDER, m, 0.99 * limit / size) <=
                             most);
            TEST_ASSERT_TRUE(limit >= 7.99 || limits_growth(method, WH_SECOND_ORDER, m,
                                                            1.001 * limit / size) > most);
            some++;
        } else {
            TEST_ASSERT_TRUE(
                limits_growth(method, WH_SECOND_ORDER, m, (turning ? 0.101 : 0.01) / size) > most);
            none++;
        }
    }
    TEST_ASSERT_TRUE(some > 50 && none > 10);
}

/* --- eigenvalues -------------------------------------------------------------------------------------------------*/

enum { LARGEST = 40 };

/* A matrix with eigenvalues drawn, in pairs and alone: blocks, turned by random similar transformations that are well
 * conditioned (reflections), then scaled as units scale. Also a slope. */
static int made_matrix(uint64_t *seed, double *a, complex_number *value) {
    const int n = 1 + (int)(random_bits(seed) % LARGEST);
    memset(a, 0, (size_t)n * (size_t)n * sizeof *a);
    for (int i = 0; i < n;) {
        const double size = pow(10.0, random_between(seed, 0.0, 3.0));
        if (i + 1 < n && random_bits(seed) % 2 == 0) {
            const double angle = random_between(seed, 0.3, 2.8);
            value[i] = (complex_number){size * cos(angle), size * sin(angle)};
            value[i + 1] = (complex_number){value[i].re, -value[i].im};
            a[i * n + i] = a[(i + 1) * n + i + 1] = value[i].re;
            a[i * n + i + 1] = value[i].im;
            a[(i + 1) * n + i] = -value[i].im;
            i += 2;
        } else {
            value[i] = (complex_number){random_bits(seed) % 2 == 0 ? size : -size, 0.0};
            a[i * n + i] = value[i].re;
            i++;
        }
    }
    for (int turn = 0; turn < 3; turn++) {
        double v[LARGEST];
        double norm = 0.0;
        for (int i = 0; i < n; i++) {
            v[i] = random_between(seed, -1.0, 1.0);
            norm += v[i] * v[i];
        }
        for (int side = 0; side < 2; side++) {
            for (int i = 0; i < n; i++) {
                double sum = 0.0;
                for (int k = 0; k < n; k++) {
                    sum += v[k] * (side == 0 ? a[k * n + i] : a[i * n + k]);
                }
                for (int k = 0; k < n; k++) {
                    *(side == 0 ? &a[k * n + i] : &a[i * n + k]) -= 2.0 * v[k] * sum / norm;
                }
            }
        }
    }
    for (int i = 0; i < n; i++) {
        const double scale = ldexp(1.0, (int)(random_bits(seed) % 21) - 10);
        for (int k = 0; k < n; k++) {
            a[i * n + k] *= scale;
            a[k * n + i] /= scale;
        }
    }
    return n;
}

static void test_eigenvalues_are_the_known_ones(void) {
    uint64_t seed = 17;
    double worst = 0.0;
    for (int k = 0; k < 300; k++) {
        double a[LARGEST * LARGEST];
        complex_number known[LARGEST];
        complex_number found[LARGEST];
        const int n = made_matrix(&seed, a, known);
        TEST_ASSERT_TRUE(modes_values(n, a, found));
        for (int i = 0; i < n; i++) {
            double nearest = (double)INFINITY;
            for (int j = 0; j < n; j++) {
                nearest =
                    fmin(nearest, hypot(found[j].re - known[i].re, found[j].im - known[i].im));
            }
            worst = fmax(worst, nearest / 1e3);
        }
    }
    printf("  300 matrices up to %d: eigenvalues off by %.1e of the largest there may be\n",
           LARGEST, worst);
    TEST_ASSERT_TRUE(worst < 1e-11);
}

/* What all eigenvalues contribute to a slope is the slope; what one does is an eigenvector. */
static void test_parts_are_the_whole(void) {
    uint64_t seed = 18;
    for (int k = 0; k < 100; k++) {
        double a[LARGEST * LARGEST];
        complex_number value[LARGEST];
        complex_number part[LARGEST];
        complex_number left[LARGEST];
        double slope[LARGEST];
        double share[LARGEST];
        double sum[LARGEST] = {0};
        double size[LARGEST] = {0};
        const int n = made_matrix(&seed, a, value);
        for (int i = 0; i < n; i++) {
            slope[i] = random_between(&seed, -1.0, 1.0);
        }
        for (int j = 0; j < n; j++) {
            if (value[j].im < 0.0) {
                continue;
            }
            TEST_ASSERT_TRUE(modes_part(n, a, value[j], slope, part, left, share));
            double shares = 0.0;
            for (int i = 0; i < n; i++) {
                sum[i] += (value[j].im > 0.0 ? 2.0 : 1.0) * part[i].re;
                size[i] += complex_size(part[i]);
                shares += share[i];
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, shares);
        }
        for (int i = 0; i < n; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-6 * (size[i] + 1e-9), slope[i], sum[i]);
        }
    }
}

static void test_matrices_without_an_answer(void) {
    const double none[4] = {1.0, (double)NAN, 0.0, 1.0};
    const double jordan[4] = {0.0, 1.0, 0.0, 0.0};                        /* a free mass */
    const double turn[9] = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0}; /* no shift moves it */
    complex_number value[3];
    TEST_ASSERT_FALSE(modes_values(2, none, value));
    TEST_ASSERT_TRUE(modes_values(2, jordan, value));
    TEST_ASSERT_TRUE(complex_size(value[0]) < 1e-7 && complex_size(value[1]) < 1e-7);
    TEST_ASSERT_TRUE(modes_values(3, turn, value));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, complex_size(value[i]));
    }
}

void suite_limits(void) {
    RUN_TEST(test_measured_limits_are_those_of_the_rows);
    RUN_TEST(test_known_limits);
    RUN_TEST(test_what_a_step_takes);
    RUN_TEST(test_motions_that_turn);
    RUN_TEST(test_ripples_of_what_decays);
    RUN_TEST(test_intervals_end_where_it_grows);
    RUN_TEST(test_eigenvalues_are_the_known_ones);
    RUN_TEST(test_parts_are_the_whole);
    RUN_TEST(test_matrices_without_an_answer);
}
