/* test_hard_contacts.c: hard cases with contacts, and the resonance that nothing damps (docs/hard, docs/hard_cases.md), each
 * against a closed form: supports and frictions that repeat each other and break away, friction under a load that
 * vanishes, Newton's cradle. */
#include <math.h>
#include <stdio.h>

#include "contacts.h"
#include "motion.h"

#include "unity.h"

void suite_hard_contacts(void);

#define HARD "docs/hard/"

static void open_hard(motion *m, const char *file, const char *name, const engine_kind *kind,
                      double step_s) {
    motion_open_file(m, file, "", name,
                     (stepping){.kind = kind, .method = WH_RK4, .step_s = step_s});
}

/* --- contacts that repeat each other ------------------------------------------------------------------------------ */

#define P0 15.0
#define LIFTS_N 10.0 /* half the beam's weight; both blocks' static friction */

/* From the moment at which P0 sin(rate t) is LIFTS_N on, under `factor` times the force less `against`. */
static double moved_m(double rate, double t, double factor, double against) {
    const double t0 = asin(LIFTS_N / P0) / rate;
    const double s = t - t0;
    const double pushed =
        P0 / rate * cos(rate * t0) * s - P0 / (rate * rate) * (sin(rate * t) - sin(rate * t0));
    return s > 0.0 ? factor * (pushed - against * s * s / 2.0) : 0.0;
}

typedef struct breaking {
    double off_m;
    double at_rest_m; /* the most that anything moved before */
} breaking;

/* Until 0.3 s behind that moment; both coordinates move as one. The force's phase goes on by `rate`, rad/s. */
static void run_breaking(const char *name, const char *second, stepping how, double rate,
                         double factor, double against, breaking *most) {
    const char *first = second[0] == 's' ? "y" : "x";
    char start[40];
    motion m;
    snprintf(start, sizeof start, "p'=%.17g", rate);
    how.start = start;
    motion_open_file(&m, HARD "redundant.whirl", "", name, how);
    const double t0 = asin(LIFTS_N / P0) / rate;
    const int steps = (int)((t0 + 0.3) / how.step_s);
    for (int i = 1; i <= steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double t = i * how.step_s;
        const double wanted = moved_m(rate, t, factor, against);
        const double off =
            fmax(fabs(motion_value(&m, first) - wanted), fabs(motion_value(&m, second) - wanted));
        most->off_m = fmax(most->off_m, off);
        if (t < t0 - how.step_s) {
            most->at_rest_m = fmax(most->at_rest_m, off);
        }
    }
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    motion_close(&m);
}

static void check_breaking(const char *name, const char *second, double factor, double against) {
    for (int real = 0; real < 2; real++) {
        const engine_kind *kind = real == 0 ? &engine_double : &engine_float;
        static const double steps[] = {1e-3, 0.25e-3};
        breaking most[2] = {{0.0, 0.0}, {0.0, 0.0}};
        for (int k = 0; k < 2; k++) {
            for (int i = 0; i < 10; i++) {
                const double rate = 0.7 * pow(1.27, i);
                run_breaking(name, second,
                             (stepping){.kind = kind, .method = WH_RK4, .step_s = steps[k]}, rate,
                             factor, against, &most[k]);
            }
        }
        printf("  %s, %s: at rest to %.1e m; off by %.1e m at 1 ms, %.1e m at 0.25 ms\n", name,
               kind->name, most[0].at_rest_m, most[0].off_m, most[1].off_m);
        TEST_ASSERT_TRUE(most[0].at_rest_m <= (real == 0 ? 1e-12 : 1e-9)); /* not a creep */
        TEST_ASSERT_TRUE(most[0].off_m < (real == 0 ? 1e-8 : 1e-4));
        TEST_ASSERT_TRUE(most[1].off_m <= most[0].off_m + (real == 0 ? 1e-12 : 1e-5));
    }
}

/* About the left support the inertia is 4/3 m: 4/3 m y'' = 2 P - m g. */
static void test_a_beam_lifts_off_two_of_three_supports(void) {
    check_breaking("beam_lifts", "s", 3.0 / (4.0 * 2.0) * 2.0, 10.0);
}

/* 2 m x'' = P - 2 mu_k m g. */
static void test_two_blocks_break_loose_together(void) {
    check_breaking("blocks_slide", "y", 1.0 / 2.0, 8.0);
}

/* --- a load that pulsates and vanishes ----------------------------------------------------------------------------- */

#define PULL_N 2.0
#define LOAD_N 30.0
#define STATIC 0.5
#define KINETIC 0.4
#define PHASE_RATE 10.0

/* Velocity and place after `s` more seconds from phase p, sliding forward on, pressed or not. */
static void slide(double p, double s, int pressed, double *v, double *x) {
    const double w = PHASE_RATE;
    const double k = pressed ? KINETIC * LOAD_N : 0.0;
    *x += *v * s + PULL_N * s * s / 2.0 + k / (w * w) * (cos(p + w * s) - cos(p)) +
          k / w * sin(p) * s;
    *v += PULL_N * s - k / w * (sin(p + w * s) - sin(p));
}

/* The first moment within `span` at which a pressed slide comes to rest, or -1: v falls to its least where the friction
 * is the pull again. */
static double stops_after(double p, double span, double v) {
    double low = 0.0;
    double high = -1.0;
    for (int i = 1; i <= 20000 && high < 0.0; i++) { /* where it first is below zero */
        double at = v;
        double x = 0.0;
        slide(p, span * i / 20000.0, 1, &at, &x);
        if (at < 0.0) {
            high = span * i / 20000.0;
            low = span * (i - 1) / 20000.0;
        }
    }
    for (int i = 0; i < 80 && high >= 0.0; i++) {
        double at = v;
        double x = 0.0;
        const double middle = (low + high) / 2.0;
        slide(p, middle, 1, &at, &x);
        *(at < 0.0 ? &high : &low) = middle;
    }
    return high;
}

/* From rest at phase 0 to t. */
static double pulled_m(double t, double *speed) {
    const double w = PHASE_RATE;
    const double quarter = acos(-1.0) / 2.0;
    const double loose = acos(PULL_N / (STATIC * LOAD_N)); /* where it breaks loose */
    double now = 0.0;                                      /* phase */
    double v = 0.0;
    double x = 0.0;
    const double end = w * t;
    for (int turn = 0; now < end; turn++) {
        const double base = 4.0 * quarter * turn;
        double next = fmin(end, base + loose); /* sticks until there, if it rests */
        if (v <= 0.0) {
            now = fmax(now, next);
        }
        next = fmin(end, base + quarter);
        slide(now, fmax(0.0, next - now) / w, 1, &v, &x);
        now = fmax(now, next);
        next = fmin(end, base + 3.0 * quarter);
        slide(now, fmax(0.0, next - now) / w, 0, &v, &x);
        now = fmax(now, next);
        next = fmin(end, base + 4.0 * quarter);
        if (now < next) {
            const double s = stops_after(now, (next - now) / w, v);
            slide(now, s >= 0.0 ? s : (next - now) / w, 1, &v, &x);
            v = s >= 0.0 ? 0.0 : v;
            now = next;
        }
    }
    *speed = v;
    return x;
}

static double pulled_off_m(double step_s, const engine_kind *kind, uint64_t *events) {
    double off = 0.0;
    motion m;
    open_hard(&m, HARD "pulsating_load.whirl", "load_pulsates", kind, step_s);
    for (int i = 1; i <= 30; i++) { /* at the same moments, whatever the step */
        double v;
        motion_to(&m, 0.1 * i);
        const double x = pulled_m(0.1 * i, &v);
        off = fmax(off, fabs(motion_value(&m, "x") - x));
        off = fmax(off, fabs(motion_value(&m, "x'") - v));
    }
    *events = contacts_events(&m);
    motion_close(&m);
    return off;
}

static void test_a_load_that_pulsates_and_vanishes(void) {
    static const double steps[] = {5e-3, 2.5e-3, 1.25e-3};
    double off[3];
    uint64_t events[4];
    for (int i = 0; i < 3; i++) {
        off[i] = pulled_off_m(steps[i], &engine_double, &events[i]);
        printf("  step %g ms: off by %.2e, %u events\n", 1e3 * steps[i], off[i],
               (unsigned)events[i]);
        TEST_ASSERT_EQUAL_UINT64(events[0], events[i]);
    }
    const double in_float = pulled_off_m(1.25e-3, &engine_float, &events[3]);
    printf("  orders %.2f, %.2f; in float %.1e\n", log2(off[0] / off[1]), log2(off[1] / off[2]),
           in_float);
    TEST_ASSERT_TRUE(events[0] >= 16); /* four turns and more of four each */
    TEST_ASSERT_TRUE(off[2] > 1e-13 && off[0] < 1e-5);
    TEST_ASSERT_TRUE(log2(off[0] / off[2]) / 2.0 > 3.5);
    TEST_ASSERT_TRUE(in_float < 1e-4);
}

/* --- Newton's cradle ------------------------------------------------------------------------------------------------ */

static void test_the_cradle_swings(void) {
    for (int real = 0; real < 2; real++) {
        const double w = 5.0;
        const double period = 2.0 * acos(-1.0) / w;
        double off = 0.0;
        double between = 0.0;
        motion m;
        open_hard(&m, HARD "cradle.whirl", "cradle_swings",
                  real == 0 ? &engine_double : &engine_float, 1e-3);
        for (int i = 1; i <= 5000; i++) {
            const double t = i * 1e-3;
            const double part = fmod(t + period / 4.0, period) / period; /* 0 to 1/2: the first */
            const double swing = -0.1 * cos(w * t);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            off = fmax(off, fabs(motion_value(&m, "x1") - (part < 0.5 ? swing : 0.0)));
            off = fmax(off, fabs(motion_value(&m, "x5") - (part < 0.5 ? 0.0 : swing)));
            for (int k = 2; k <= 4; k++) {
                char name[4] = {'x', (char)('0' + k), '\0'};
                between = fmax(between, fabs(motion_value(&m, name)));
            }
        }
        printf("  %s: off by at most %.1e m in 5 s; those between moved %.1e m; %u events, %u "
               "overruns\n",
               m.kind->name, off, between, (unsigned)contacts_events(&m),
               (unsigned)contacts_overruns(&m));
        TEST_ASSERT_TRUE(off < (real == 0 ? 1e-8 : 1e-4));
        TEST_ASSERT_TRUE(between < (real == 0 ? 1e-8 : 1e-4));
        TEST_ASSERT_TRUE(contacts_events(&m) >= 8 * 4); /* eight passages of four stops */
        TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
        motion_close(&m);
    }
}

/* --- resonance --------------------------------------------------------------------------------------------------------- */

/* Off by, of the amplitude at the end, F0/(2 k) w t. */
static double resonance_off(double step_s, const engine_kind *kind) {
    motion m;
    open_hard(&m, HARD "resonance.whirl", "resonance_grows", kind, step_s);
    motion_to(&m, 10.0);
    const double a = 20.0 * 10.0;
    const double wanted = 2.0 / 800.0 * (sin(a) - a * cos(a));
    const double off = fabs(motion_value(&m, "x") - wanted) / (2.0 / 800.0 * a);
    motion_close(&m);
    return off;
}

static void test_a_resonance_that_nothing_damps(void) {
    const double coarse = resonance_off(2e-3, &engine_double);
    const double fine = resonance_off(1e-3, &engine_double);
    const double in_float = resonance_off(1e-3, &engine_float);
    printf("  off by %.2e of the amplitude at 2 ms, %.2e at 1 ms: order %.2f; in float %.1e\n",
           coarse, fine, log2(coarse / fine), in_float);
    TEST_ASSERT_TRUE(fine > 1e-10 && fine < 1e-6);
    TEST_ASSERT_TRUE(log2(coarse / fine) > 3.5 && log2(coarse / fine) < 5.5);
    TEST_ASSERT_TRUE(in_float < 1e-4);
}

void suite_hard_contacts(void) {
    RUN_TEST(test_a_beam_lifts_off_two_of_three_supports);
    RUN_TEST(test_two_blocks_break_loose_together);
    RUN_TEST(test_a_load_that_pulsates_and_vanishes);
    RUN_TEST(test_the_cradle_swings);
    RUN_TEST(test_a_resonance_that_nothing_damps);
}
