/* test_price_control.c: the steps of the extrapolation (host/study/extrapolation.h): of one equation, by rules and steps of its
 * own, extrapolated by Lagrange's weights and not by a tableau; as many tries, and the same end. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "host/study/extrapolation.h"
#include "unity.h"

void suite_price_control(void);

/* y' = linear y + square y^2 */
typedef struct equation_of {
    long double linear, square;
} equation_of;

static long double slope(equation_of e, long double y) { return (e.linear + e.square * y) * y; }

/* How far the modified midpoint rule moves y: two leapfrogging sequences, told apart by their parity. */
static long double rule(equation_of e, long double y, long double span, int substeps) {
    const long double h = span / (long double)substeps;
    long double at[2] = {0.0L, h * slope(e, y)};
    for (int k = 1; k < substeps; k++) {
        at[(k + 1) % 2] += 2.0L * h * slope(e, y + at[k % 2]);
    }
    return at[substeps % 2];
}

/* The polynomial in the square of the step through rules first to last, at zero. */
static long double extrapolated(const long double *rules, int first, int last) {
    long double sum = 0.0L;
    for (int j = first; j <= last; j++) {
        long double weight = 1.0L;
        for (int i = first; i <= last; i++) {
            weight *= i == j ? 1.0L : (long double)(j * j) / (long double)(j * j - i * i);
        }
        sum += weight * rules[j];
    }
    return sum;
}

typedef struct motion_of {
    equation_of e;
    int columns;
    double tolerance;
    long double y, largest, step;
    int tries;
    extrapolation_status status;
    evaluator *rough; /* of the list: units that its rounding leaves of the slope */
} motion_of;

/* What rounding may make of the slope counts as much as a value of that size. */
static long double rounded_within(const motion_of *m, long double span) {
    const double y = (double)m->y;
    double result;
    double units;
    evaluator_run(m->rough, 0.0, NULL, &y, NULL, NULL, &result);
    evaluator_rounding(m->rough, NULL, 0.0, &units);
    return isfinite(units) ? span * (long double)units : 0.0L;
}

static void try_once(motion_of *m, long double span, long double *move, double *error) {
    long double rules[EXTRAPOLATION_COLUMNS + 1] = {0.0L};
    for (int j = 1; j <= m->columns; j++) {
        rules[j] = rule(m->e, m->y, span, 2 * j);
    }
    *move = extrapolated(rules, 1, m->columns);
    const long double off = fabsl(*move - extrapolated(rules, 2, m->columns));
    const long double allowed =
        fmaxl(fmaxl(fabsl(m->y + *move), m->largest), rounded_within(m, span));
    *error = isfinite(off) ? (double)(off / allowed) / m->tolerance : (double)INFINITY;
    m->tries++;
}

/* On by a span: steps grow to three times at most and fall to a fifth, aim a tenth below what is allowed, and do not leave a
 * rest that is shorter than half of them. */
static void go(motion_of *m, long double span) {
    long double left = span;
    m->step = m->step > 0.0L ? m->step : span;
    m->status = EXTRAPOLATION_OK;
    while (left > 0.0L && m->status == EXTRAPOLATION_OK) {
        const bool last = m->step >= left;
        const bool halves = !last && m->step >= left / 2.0L;
        const long double taken = last ? left : halves ? left / 2.0L : m->step;
        long double move;
        double error;
        try_once(m, taken, &move, &error);
        const double power = -1.0 / (2.0 * m->columns - 1.0);
        const double factor = error > 0.0 ? fmin(3.0, fmax(0.2, 0.9 * pow(error, power))) : 3.0;
        const long double next = taken * (long double)factor;
        if (error <= 1.0) {
            m->y += move;
            m->largest = fmaxl(m->largest, fabsl(m->y));
            left = last ? 0.0L : left - taken;
            m->step = last ? fmaxl(m->step, next) : next;
        } else {
            m->step = fminl(next, 0.7L * taken);
        }
        m->status = m->step > 1e-9L * span ? EXTRAPOLATION_OK : EXTRAPOLATION_SMALL;
    }
}

static void test_steps_are_those_of_one_equation_by_hand(void) {
    dice d = dice_of("price_control", 441);
    int failed = 0;
    int tries = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(150, 5000)); n++) {
        char text[300];
        const double linear = dice_between(&d, -6.0, 3.0);
        const double square = n % 3 == 0 ? dice_between(&d, 0.1, 2.0) : 0.0; /* a pole, somewhere */
        const double start = dice_between(&d, 0.2, 2.0);
        snprintf(text, sizeof text,
                 "mechanism m\nstate y\nequation y' = %.17g [1/s]*y%s%.17g [1/s]*y^2\n"
                 "scene s { start y = %.17g; step 1 [ms]; until 1 [s] }\n",
                 linear, square > 0.0 ? " + " : " + 0*", square > 0.0 ? square : 1.0, start);
        derived of = derived_scene(text, "s");
        derived_expect(&of, text);
        motion_of m = {.e = {(long double)linear, (long double)square},
                       .columns = 2 + (int)dice_one_of(&d, 5),
                       .tolerance = pow(10.0, dice_between(&d, -10.0, -3.0)),
                       .y = (long double)start,
                       .largest = (long double)start,
                       .rough = evaluator_new(of.image->list[IMAGE_STEP])};
        const long before = blocks_in_use();
        extrapolation *e =
            extrapolation_new(of.image, (extrapolation_setting){m.columns, m.tolerance}, 1e9);
        const double each = of.image->list[IMAGE_STEP]->count * (1.0 + m.columns * m.columns);
        for (int i = 0; i < 4 && m.status == EXTRAPOLATION_OK; i++) {
            const long double span = (long double)dice_between(&d, 0.01, 2.0);
            go(&m, span);
            TEST_ASSERT_EQUAL_INT_MESSAGE(m.status, extrapolation_go(e, span), text);
            const long double off = fabsl(extrapolation_state(e)[0] - m.y);
            TEST_ASSERT_TRUE_MESSAGE(off <= 1e-9L * m.largest || m.status != EXTRAPOLATION_OK,
                                     text);
            /* a rule that is broken off behind a number that is none evaluates less */
            TEST_ASSERT_TRUE_MESSAGE(extrapolation_operations(e) <= each * m.tries * 1.0000001,
                                     text);
            TEST_ASSERT_TRUE_MESSAGE(
                square > 0.0 || fabs(extrapolation_operations(e) / each - m.tries) < 1e-6, text);
        }
        failed += m.status != EXTRAPOLATION_OK;
        tries += m.tries;
        extrapolation_free(e);
        TEST_ASSERT_EQUAL_INT_MESSAGE(before, blocks_in_use(), text);
        evaluator_free(m.rough);
        derived_free(&of);
    }
    printf("  %d tries, %d ended at a pole\n", tries, failed);
    TEST_ASSERT_TRUE(failed > 5 && tries > 2000);
}

void suite_price_control(void) { RUN_TEST(test_steps_are_those_of_one_equation_by_hand); }
