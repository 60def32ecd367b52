/* test_linearised.c: the motions of a run about its records (host/run/linearised.h), of made-up sequences of states of two
 * oscillators, apart or coupled, damped or not: eigenvalues, parts, and who carries them, to closed forms; which is chosen, what
 * the method leaves of all, and the step that leaves little, by trying all of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "host/run/linearised.h"
#include "host/run/step_text.h"
#include "made_run.h"
#include "unity.h"

void suite_linearised(void);

static dice die;

/* x'' = -k x - b x' - h (x - y), and y likewise. */
static struct {
    double k[2];
    double b[2];
    double h;
    double step_s;
} world;

static derived draw_world(bool coupled) {
    char text[700];
    for (int i = 0; i < 2; i++) {
        world.k[i] = coupled && i > 0 ? world.k[0] : exp(dice_between(&die, -2.0, 3.0));
        world.b[i] = coupled ? 0.0 : dice_between(&die, 0.0, 0.8) * sqrt(world.k[i]);
    }
    world.h = coupled ? exp(dice_between(&die, -1.0, 2.0)) : 0.0;
    world.step_s = exp(dice_between(&die, -3.0, 0.3));
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
             "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*y^2/2 + %.17g [N/m]*(x - y)^2/2\n"
             "F = %.17g [N*s/m]*x'^2/2 + %.17g [N*s/m]*y'^2/2\n"
             "scene s { step %.17g [s]; until 99 [s] }\n",
             world.k[0], world.k[1], world.h, world.b[0], world.b[1], world.step_s);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    made_run.image = d.image;
    return d;
}

static watch *watch_states(uint64_t end) {
    watch *w = watch_open(made_run.image, &made_run_kind);
    for (made_run.at = 0; made_run.at <= end; made_run.at++) {
        for (int i = 0; i < N; i++) {
            made_run.state[made_run.at][i] = dice_between(&die, -2.0, 2.0);
        }
        watch_enter(w, &made_run_kind, NULL, NULL);
    }
    return w;
}

/* --- closed forms ------------------------------------------------------------------------------------------------*/

/* In its own coordinates: x and y, or their sum and difference by the root of two. */
static double along(const double *s, int mode, int rate) {
    const double *at = s + (rate > 0 ? 2 : 0);
    return world.h > 0.0 ? (at[0] + (mode == 0 ? at[1] : -at[1])) / sqrt(2.0) : at[mode];
}

static double stiffness_of(int mode) {
    return world.k[mode] + (world.h > 0.0 && mode == 1 ? 2.0 * world.h : 0.0);
}

static complex_number value_of(int mode) {
    const double half = 0.5 * world.b[mode];
    return (complex_number){-half, sqrt(stiffness_of(mode) - half * half)};
}

/* (A - conj(value)) of the slope (v, a), by value - conj(value): its part in v. */
static double part_of(const double *s, int mode) {
    const complex_number value = value_of(mode);
    const double v = along(s, mode, 1);
    const double a = -stiffness_of(mode) * along(s, mode, 0) - world.b[mode] * v;
    return hypot(a - value.re * v, value.im * v) / (2.0 * value.im);
}

/* Of a component's slopes over the records, the largest part, squared; at most all of it. */
static double share_of(const watch *w, int record, int mode) {
    double most = 0.0;
    for (int i = 0; i < 2; i++) {
        double sum = 0.0;
        for (int k = 0; k < w->records; k++) {
            const double v = w->record[k * N + made_run_place(VX + i)];
            sum += 2.0 * v * v / w->records;
        }
        double s[N];
        for (int c = 0; c < N; c++) {
            s[c] = w->record[record * N + made_run_place(c)];
        }
        const bool takes_part = world.h > 0.0 || i == mode;
        const double part =
            takes_part ? 2.0 * part_of(s, mode) / (world.h > 0.0 ? sqrt(2.0) : 1.0) : 0.0;
        most = fmax(most, part * part / sum);
    }
    return fmin(most, 1.0);
}

static void expect_near(double wanted, double is, double size) {
    TEST_ASSERT_TRUE(fabs(wanted - is) <= 2e-5 * (fabs(wanted) + size));
}

static int mode_of(const linear_motion *m) {
    const complex_number a = value_of(0);
    const complex_number b = value_of(1);
    return hypot(m->value.re - a.re, m->value.im - a.im) <
                   hypot(m->value.re - b.re, m->value.im - b.im)
               ? 0
               : 1;
}

static void expect_motion(const watch *w, const linearised *l, const linear_motion *m) {
    const int mode = mode_of(m);
    const complex_number value = value_of(mode);
    const double size = hypot(value.re, value.im);
    int record = 0;
    while (record < w->records && w->record_s[record] != m->time_s) {
        record++;
    }
    TEST_ASSERT_TRUE(record < w->records);
    expect_near(value.re, m->value.re, size);
    expect_near(value.im, m->value.im, size);
    expect_near(-world.b[mode], m->rates.re, size);
    expect_near(0.0, m->rates.im, size);
    expect_near(share_of(w, record, mode), m->share, 1.0);
    if (world.h > 0.0) {
        TEST_ASSERT_TRUE(m->unknown[0] + m->unknown[1] == 1 && m->unknown[0] >= 0);
    } else {
        TEST_ASSERT_TRUE(m->unknown[0] == mode && m->unknown[1] == -1);
    }
    const limits_motion as = linearised_as(m);
    const double lost =
        limits_off(l->method, WH_SECOND_ORDER, as, world.step_s, (double)w->steps * world.step_s);
    const double ripple = limits_ripple(l->method, WH_SECOND_ORDER, as, world.step_s);
    TEST_ASSERT_TRUE(m->off == fmax(lost, ripple));
    TEST_ASSERT_TRUE(m->ripple == (ripple >= lost ? ripple : 0.0));
}

static void expect_chosen(const linearised *l) {
    const linear_motion *worst = NULL;
    const linear_motion *fastest = NULL;
    double most = 0.0;
    for (int i = 0; i < l->motions; i++) {
        const linear_motion *m = &l->motion[i];
        const double swings = m->value.im > 0.1 * hypot(m->value.re, m->value.im) ? 3.0 : 1.0;
        const double interest = swings * m->share * fmin(m->off, 1.0);
        if (m->share >= 1e-6) {
            worst = worst == NULL || interest > most ? m : worst;
            most = fmax(most, interest);
            fastest = fastest == NULL || hypot(m->value.re, m->value.im) >
                                             hypot(fastest->value.re, fastest->value.im)
                          ? m
                          : fastest;
        }
    }
    TEST_ASSERT_EQUAL_PTR(worst, l->worst);
    if (fastest != NULL) {
        TEST_ASSERT_TRUE(
            fabs(complex_size(l->fastest->value) / complex_size(fastest->value) - 1.0) < 1e-6);
    }
}

static void test_motions(void) {
    static const wh_method methods[] = {WH_RK4, WH_HEUN, WH_LEAPFROG};
    const long before = blocks_in_use();
    for (unsigned c = 0; c < dice_cases(usual_or(60, 15)); c++) {
        const bool coupled = c % 3U == 0;
        derived d = draw_world(coupled);
        watch *w = watch_states(3 + dice_one_of(&die, 37));
        const wh_method method = methods[dice_one_of(&die, coupled ? 3 : 2)];
        linearised *l = linearised_of(w, method);
        int seen[WATCH_RECORDS][2] = {{0}};
        int wanted = 0;
        TEST_ASSERT_TRUE(l->method == method && l->step_s == world.step_s);
        TEST_ASSERT_TRUE(l->span_s == (double)w->steps * world.step_s);
        for (int mode = 0; mode < 2; mode++) {
            const complex_number v = value_of(mode);
            wanted += hypot(v.re, v.im) * l->span_s > 1e-2 ? w->records : 0;
        }
        for (int i = 0; i < l->motions; i++) {
            const linear_motion *m = &l->motion[i];
            expect_motion(w, l, m);
            for (int k = 0; k < w->records; k++) {
                seen[k][mode_of(m)] += w->record_s[k] == m->time_s ? 1 : 0;
            }
        }
        for (int k = 0; k < w->records; k++) {
            TEST_ASSERT_TRUE(seen[k][0] <= 1 && seen[k][1] <= 1);
        }
        TEST_ASSERT_EQUAL_INT(wanted, l->motions);
        expect_chosen(l);
        linearised_free(l);
        watch_close(w);
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(blocks_in_use() == before);
}

/* 1, 2 and 5 times powers of ten, from 5000 down to 16 decades lower: none is nearer below. */
static void test_nice_steps(void) {
    for (unsigned c = 0; c < dice_cases(2000); c++) {
        const double most_s = exp(dice_between(&die, log(1e-12), log(1e4)));
        const double nice_s = step_nice_s(most_s);
        const double leading = nice_s / pow(10.0, floor(log10(nice_s) + 1e-9));
        const bool one = fabs(leading - 1.0) < 1e-9;
        const bool two = fabs(leading - 2.0) < 1e-9;
        TEST_ASSERT_TRUE(one || two || fabs(leading - 5.0) < 1e-9);
        const double next_s = nice_s * (two ? 2.5 : 2.0);
        TEST_ASSERT_TRUE(nice_s <= most_s * (1.0 + 2e-9));
        TEST_ASSERT_TRUE(next_s > most_s || next_s > 5001.0);
        /* its own and its next are what they are, though not to the last digit */
        TEST_ASSERT_TRUE(fabs(step_nice_s(nice_s * (1.0 - 1e-13)) / nice_s - 1.0) < 1e-12);
        TEST_ASSERT_TRUE(step_nice_s(nice_s * (1.0 - 1e-7)) < 0.6 * nice_s);
    }
    TEST_ASSERT_TRUE(fabs(step_nice_s(1.001e-12) - 1e-12) < 1e-24);
    TEST_ASSERT_TRUE(step_nice_s(0.999e-12) == 0.0);
    TEST_ASSERT_TRUE(step_nice_s(0.0) == 0.0);
}

void suite_linearised(void) {
    die = dice_of("linearised", 68);
    RUN_TEST(test_motions);
    RUN_TEST(test_nice_steps);
}
