/* test_missed.c: contacts and forces thinner than the way of a step. Round posts are met, as closed forms have it
 * (core/contact_step.h); of latches, flat walls and hills of potential energy none is passed without a word (host/run/missed.h);
 * and of right runs none is told. WHIRL_CASES=2000 WHIRL_SEED=...: so many, others. */
#include <math.h>
#include <stdio.h>

#include "command.h"
#include "contacts.h"
#include "hybrid.h"
#include "jumps.h"
#include "unity.h"

void suite_missed(void);

enum { TEXT = 1500 };

static char text[TEXT]; /* of the last flight */

/* A body of 1 kg that starts 1 m in front of x = 0 and a drawn part of a step on top. */
typedef struct flight {
    double start_m;
    double v_m_s;
    double step_s;
    double until_s;
} flight;

static flight flight_draw(dice *d) {
    static const double steps_s[] = {1e-3, 2e-3, 5e-3};
    flight f = {.v_m_s = dice_between(d, 1.0, 32.0), .step_s = steps_s[dice_one_of(d, 3)]};
    f.start_m = -1.0 - dice_between(d, 0.0, f.v_m_s * f.step_s);
    f.until_s = f.step_s * floor((1.5 / f.v_m_s + 0.1) / f.step_s);
    return f;
}

/* Its run to the end: `more` are statements, y starts at `aside_m`. Returns whether something was told. */
static bool fly(motion *m, const flight *f, const char *more, double aside_m) {
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n%s\n"
             "scene s {\nstart x = %.17g [m], x' = %.17g [m/s], y = %.17g [m]\nstep %.17g [s]\n"
             "until %.17g [s]\n}\n",
             more, f->start_m, f->v_m_s, aside_m, f->step_s, f->until_s);
    motion_open_text(m, text, IN_DOUBLE);
    return jumps_some(m);
}

static double thickness_m(dice *d) { return 0.1e-3 * exp(dice_between(d, 0.0, log(320.0))); }

/* Posts of 0.1 to 32 mm, met in the middle, off it, or not at all; restitution 1. */
static void test_posts(void) {
    dice d = dice_of("missed", 1);
    const unsigned cases = dice_cases(few_or_all(60, 120));
    unsigned thin = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        const flight f = flight_draw(&d);
        const double r_m = 0.5 * thickness_m(&d);
        const double aside_m = k % 3 == 0 ? 0.0 : r_m * dice_between(&d, -1.3, 1.3);
        snprintf(more, sizeof more, "stop sqrt(x^2 + y^2) >= %.17g [m] restitution 1", r_m);
        TEST_ASSERT_FALSE_MESSAGE(fly(&m, &f, more, aside_m), text);
        const bool hits = fabs(aside_m) < r_m;
        const double at_m = hits ? -sqrt(r_m * r_m - aside_m * aside_m) : 0.0;
        const double hit_s = (at_m - f.start_m) / f.v_m_s;
        const double nx = at_m / r_m; /* outwards */
        const double ny = aside_m / r_m;
        const double turn = hits ? 2.0 * f.v_m_s * nx : 0.0;
        const double left_s = f.until_s - hit_s;
        const double x_m = at_m + left_s * (f.v_m_s - turn * nx);
        const double y_m = aside_m - left_s * turn * ny;
        const double off_m = hypot(motion_value(&m, "x") - x_m, motion_value(&m, "y") - y_m);
        const double edge = fabs(fabs(ny) - 1.0);
        if (edge > 1e-3) { /* where it is grazed, a rounding of the place turns the way */
            TEST_ASSERT_TRUE_MESSAGE(off_m < 1e-7, text);
        }
        thin += hits && 2.0 * r_m < f.v_m_s * f.step_s;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(thin * 3 > cases);
}

/* Does the energy tell, which every run's balance asks (host/run/belief.h)? Of a hill that is far from both ends. */
static bool is_unbalanced(const motion *m, const flight *f) {
    const double vx = motion_value(m, "x'");
    const double vy = motion_value(m, "y'");
    const double y_m = motion_value(m, "y");
    const double from_J = 0.5 * f->v_m_s * f->v_m_s + 50.0 * 9e-6;
    return fabs(0.5 * (vx * vx + vy * vy) + 50.0 * y_m * y_m - from_J) > 0.01 * from_J;
}

/* Latches between two places or about a point, a wall of a Gaussian's shape, and a hill of more energy than the body has:
 * met, or told. */
static void test_flat_ones(void) {
    dice d = dice_of("missed", 2);
    const unsigned cases = dice_cases(few_or_all(80, 160));
    unsigned told = 0;
    unsigned met = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char more[TEXT];
        const flight f = flight_draw(&d);
        const double w_m = thickness_m(&d);
        const double hill_J = 0.5 * f.v_m_s * f.v_m_s * dice_between(&d, 1.2, 5.0);
        const char *sway = "V = 100 [N/m]*y^2/2";
        switch (k % 4) {
        case 0:
            snprintf(more, sizeof more, "%s\nhold x while x > 0 and x < %.17g [m]", sway, w_m);
            break;
        case 1:
            snprintf(more, sizeof more, "%s\nhold x - y while abs(x) < %.17g [m]", sway, w_m / 2);
            break;
        case 2:
            snprintf(more, sizeof more,
                     "%s\nstop y + 4 [mm] >= 1 [m]*exp(-(x/%.17g [m])^2) restitution 0.5", sway,
                     w_m);
            break;
        default:
            snprintf(more, sizeof more, "%s + %.17g [J]*exp(-(x/%.17g [m])^2)", sway, hill_J, w_m);
            break;
        }
        const bool is_told = fly(&m, &f, more, 3e-3);
        const bool is_met = k % 4 == 3 ? motion_value(&m, "x") < 0.0 : contacts_events(&m) > 0;
        TEST_ASSERT_TRUE_MESSAGE(is_told || is_met || (k % 4 == 3 && is_unbalanced(&m, &f)), text);
        told += is_told;
        met += is_met;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(told * 4 > cases && met * 10 > cases);
}

/* Random linkages with stops and frictions in steps that follow them: nothing is told of those that are right. */
static void test_right_runs(void) {
    dice d = dice_of("missed", 3);
    const unsigned cases = dice_cases(few_or_all(15, 60));
    const double step_s = 0.25e-3;
    uint64_t seed = d.state;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char statements[HYBRID_TEXT];
        char linked[LINKAGE_TEXT];
        const hybrid h = hybrid_draw(&seed);
        hybrid_statements(&h, statements);
        linkage_write(&h.of, "hybrid", (linkage_writing){LINKAGE_INSIDE, .more = statements},
                      linked);
        motion_open_text(&m, linked,
                         (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s});
        m.image->steps = 1000;
        TEST_ASSERT_FALSE_MESSAGE(jumps_some(&m), linked);
        motion_close(&m);
    }
}

void suite_missed(void) {
    RUN_TEST(test_posts);
    RUN_TEST(test_flat_ones);
    RUN_TEST(test_right_runs);
}
