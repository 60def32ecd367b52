/* test_missed.c: contacts and forces thinner than the way of a step. Round posts are met, as closed forms have it
 * (core/contact_step.h); of latches, flat walls and hills of potential energy none is passed without a word (host/run/missed.h);
 * and of right runs none is told. WHIRL_CASES=2000 WHIRL_SEED=...: so many, others. */
#include <math.h>
#include <stdio.h>
#include <string.h>

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

/* Two places on straight lines at constant speed, the second one perhaps on a turning disk: the least distance of both, by
 * looking often. */
typedef struct pass {
    double aside_m;    /* of the first body, which flies along x */
    double u_m, w_m_s; /* the second body: where it starts on x, and its rate */
    double disk_m;     /* radius at which it stands on a disk, or 0: it moves along x, at y = 0 */
    double turn_rad, turn_rad_s;
} pass;

static double pass_least_m(const flight *f, const pass *p) {
    double least_m = 1e9;
    for (int i = 0; i <= 200000; i++) {
        const double t = f->until_s * i / 200000.0;
        const double x = f->start_m + f->v_m_s * t;
        const double angle = p->turn_rad + p->turn_rad_s * t;
        const double u = p->disk_m > 0.0 ? p->disk_m * cos(angle) : p->u_m + p->w_m_s * t;
        const double v = p->disk_m > 0.0 ? p->disk_m * sin(angle) : 0.0;
        least_m = fmin(least_m, hypot(x - u, p->aside_m - v));
    }
    return least_m;
}

/* Posts that move: the other body's, or on a disk that turns; pairs of them; and latches between two circles. Each is met where
 * the straight lines meet, or told. */
static void test_moving_ones(void) {
    dice d = dice_of("missed", 4);
    const unsigned cases = dice_cases(few_or_all(40, 120));
    unsigned hits = 0;
    unsigned thin = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char head[TEXT];
        const flight f = flight_draw(&d);
        const double r_m = 0.5 * thickness_m(&d);
        const double meets_s = -f.start_m / f.v_m_s;
        pass p = {.aside_m = r_m * dice_between(&d, -1.3, 1.3)};
        const char *body = "";
        const char *energy = "";
        char stops[400];
        if (k % 4 == 0) { /* the other body comes along x */
            p.w_m_s = dice_between(&d, -16.0, 0.5 * f.v_m_s);
            p.u_m = -p.w_m_s * meets_s;
            body = "coordinate u [m]\n";
            energy = " + 2 [kg]*u'^2/2";
            snprintf(stops, sizeof stops, "stop sqrt((x - u)^2 + y^2) >= %.17g [m] restitution 0.5",
                     r_m);
        } else if (k % 4 == 1) { /* on a heavy disk */
            p.disk_m = dice_between(&d, 0.05, 0.5);
            p.turn_rad_s = dice_between(&d, -40.0, 40.0);
            p.turn_rad = dice_between(&d, -3.0, 3.0);
            p.aside_m += p.disk_m * sin(p.turn_rad + p.turn_rad_s * meets_s);
            body = "coordinate u [rad]\n";
            energy = " + 2 [kg*m^2]*u'^2/2";
            snprintf(stops, sizeof stops,
                     "stop sqrt((x - %.17g [m]*cos(u))^2 + (y - %.17g [m]*sin(u))^2) >= %.17g [m] "
                     "restitution 0.5",
                     p.disk_m, p.disk_m, r_m);
        } else if (k % 4 == 2) { /* a pair, the second one far aside */
            snprintf(stops, sizeof stops,
                     "stop sqrt((x - 0.1 [m])^2 + (y - 1 [m])^2) >= %.17g [m] restitution 0.5\n"
                     "stop sqrt(x^2 + y^2) >= %.17g [m] restitution 0.5",
                     r_m, r_m);
        } else {
            snprintf(stops, sizeof stops,
                     "hold x - y while sqrt(x^2 + y^2) > %.17g [m] and sqrt(x^2 + y^2) < %.17g [m]",
                     0.1, 0.1 + r_m);
        }
        snprintf(
            head, sizeof head,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n%sT = 1 [kg]*(x'^2 + y'^2)/2%s\n%s\n"
            "scene s {\nstart x = %.17g [m], x' = %.17g [m/s], y = %.17g [m]",
            body, energy, stops, f.start_m, f.v_m_s, p.aside_m);
        const size_t used = strlen(head);
        const bool turns = p.disk_m > 0.0;
        if (k % 4 < 2) {
            snprintf(head + used, sizeof head - used, ", u = %.17g [%s], u' = %.17g [%s/s]",
                     turns ? p.turn_rad : p.u_m, turns ? "rad" : "m",
                     turns ? p.turn_rad_s : p.w_m_s, turns ? "rad" : "m");
        }
        snprintf(text, sizeof text, "%s\nstep %.17g [s]\nuntil %.17g [s]\n}\n", head, f.step_s,
                 f.until_s);
        motion_open_text(&m, text, IN_DOUBLE);
        const bool is_told = jumps_some(&m);
        const bool must = k % 4 == 3 || pass_least_m(&f, &p) < 0.98 * r_m;
        TEST_ASSERT_TRUE_MESSAGE(!must || is_told || contacts_events(&m) > 0, text);
        hits += must;
        thin += must && r_m < f.v_m_s * f.step_s;
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(hits * 2 > cases && thin * 3 > cases);
}

/* --- right runs ---------------------------------------------------------------------------------------*/

enum { RIGHT_KINDS = 7 };

/* Statements of a mechanism of x and y whose contacts and forces are wide beside the way of a step. */
static void right_draw(dice *d, unsigned kind, flight *f, double *aside_m, char *more) {
    f->v_m_s = dice_between(d, 0.5, 4.0);
    f->step_s = 1e-3;
    f->until_s = 1.0;
    f->start_m = -dice_between(d, 0.5, 1.0);
    const double way_m = f->v_m_s * f->step_s;
    const double w_m = way_m * exp(dice_between(d, log(8.0), log(100.0)));
    const double stiff = dice_between(d, 5.0, 200.0);
    *aside_m = w_m * dice_between(d, -2.0, 2.0);
    switch (kind) {
    case 0: /* a post, met or passed by */
        snprintf(more, TEXT, "stop sqrt(x^2 + y^2) >= %.17g [m] restitution %.17g", 0.5 * w_m,
                 dice_between(d, 0.0, 1.0));
        break;
    case 1: /* a box with a floor, and weight */
        snprintf(more, TEXT,
                 "V = 9.81 [N]*y + %.17g [N/m]*x^2/2\nstop y >= -0.3 [m] restitution %.17g\n"
                 "stop abs(x) <= 1.2 [m] restitution 0.5",
                 stiff, dice_between(d, 0.2, 0.9));
        break;
    case 2: /* a latch */
        snprintf(more, TEXT, "V = %.17g [N/m]*y^2/2\nhold x while x > 0 and x < %.17g [m]", stiff,
                 w_m);
        break;
    case 3: /* a hill, over it or not */
        snprintf(more, TEXT, "V = %.17g [J]*exp(-(x/%.17g [m])^2) + %.17g [N/m]*y^2/2",
                 0.5 * f->v_m_s * f->v_m_s * dice_between(d, 0.2, 3.0), w_m, stiff);
        break;
    case 4: /* a wavy floor */
        snprintf(more, TEXT,
                 "V = 9.81 [N]*y + %.17g [N/m]*x^2/2\n"
                 "stop y + 0.4 [m] >= %.17g [m]*sin(x/%.17g [m]) restitution %.17g",
                 stiff, 0.1 * w_m, w_m, dice_between(d, 0.2, 0.8));
        break;
    case 5: /* friction, and a spring */
        snprintf(more, TEXT,
                 "V = %.17g [N/m]*(x^2 + y^2)/2\nfriction x static 1 kinetic 0.8 normal %.17g [N]",
                 stiff, dice_between(d, 0.2, 5.0));
        break;
    default: /* a ring that lets go inside */
        snprintf(more, TEXT,
                 "V = %.17g [N/m]*(x^2 + y^2)/2\nstop sqrt(x^2 + y^2) <= 1.1 [m] restitution %.17g",
                 stiff, dice_between(d, 0.2, 1.0));
        break;
    }
}

/* Is the run that told something right, as a step an eighth as long has it? */
static bool is_right(const motion *m, const char *of, stepping how) {
    motion fine;
    how.step_s = m->image->step_s / 8.0;
    motion_open_text(&fine, of, how);
    fine.image->steps = 8 * m->image->steps;
    const bool done = motion_step(&fine, fine.image->steps) == WH_OK;
    double off = 0.0;
    for (int i = 0; i < m->image->count; i++) {
        const char *name = m->image->unknown[i].name;
        const double value = motion_value(&fine, name);
        off = fmax(off, fabs(motion_value(m, name) - value) / fmax(fabs(value), 1.0));
    }
    motion_close(&fine);
    return done && off < 1e-3;
}

/* Random linkages with stops and frictions, and bodies before what is wide: nothing is told of a run that is right. */
static void test_right_runs(void) {
    dice d = dice_of("missed", 3);
    const unsigned cases = dice_cases(few_or_all(30, 120));
    uint64_t seed = d.state;
    unsigned told = 0;
    for (unsigned k = 0; k < cases; k++) {
        motion m;
        char linked[LINKAGE_TEXT];
        stepping how = IN_DOUBLE;
        const char *of = text;
        bool some;
        if (k % 2 == 0) {
            char statements[HYBRID_TEXT];
            const hybrid h = hybrid_draw(&seed);
            hybrid_statements(&h, statements);
            linkage_write(&h.of, "hybrid", (linkage_writing){LINKAGE_INSIDE, .more = statements},
                          linked);
            how.step_s = 0.25e-3;
            of = linked;
            motion_open_text(&m, linked, how);
            m.image->steps = 1000;
            some = jumps_some(&m);
        } else {
            flight f;
            double aside_m;
            char more[TEXT];
            right_draw(&d, k / 2 % RIGHT_KINDS, &f, &aside_m, more);
            some = fly(&m, &f, more, aside_m);
        }
        told += some;
        TEST_ASSERT_FALSE_MESSAGE(some && is_right(&m, of, how), of);
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(told * 20 <= cases);
}

void suite_missed(void) {
    RUN_TEST(test_posts);
    RUN_TEST(test_flat_ones);
    RUN_TEST(test_moving_ones);
    RUN_TEST(test_right_runs);
}
