/* test_hard.c: hard cases (docs/hard, docs/hard_cases.md), compared with closed forms: redundant supports, frictions
 * that break away, friction under a load that vanishes, Newton's cradle, resonance, origins of coordinates, and
 * borderline cases. */
#include "host/cli/commands.h"

#include "command.h"
#include "contacts.h"
#include "horizons.h"
#include "linkage.h"
#include "motion.h"

/* === suite hard_contacts ====================================================================== */

#define HARD "docs/hard/"

static void open_hard(motion *m, const char *file, const char *name, const engine_kind *kind,
                      double step_s) {
    motion_open_file(m, file, "", name,
                     (stepping){.kind = kind, .method = WH_RK4, .step_s = step_s});
}

#define P0 15.0
#define LIFTS_N 10.0 /* half the beam's weight, and the static friction of both blocks */

/* The motion that begins when P0 sin(rate t) reaches LIFTS_N. Its acceleration is factor (P0 sin(rate t) - warned). */
static double moved_m(double rate, double t, double factor, double warned) {
    const double t0 = asin(LIFTS_N / P0) / rate;
    const double s = t - t0;
    const double pushed =
        P0 / rate * cos(rate * t0) * s - P0 / (rate * rate) * (sin(rate * t) - sin(rate * t0));
    return s > 0.0 ? factor * (pushed - warned * s * s / 2.0) : 0.0;
}

typedef struct breaking {
    double off_m;
    double at_rest_m; /* largest motion before P0 sin(rate t) reaches LIFTS_N */
} breaking;

/* Runs until 0.3 s after P0 sin(rate t) reaches LIFTS_N; `rate` in rad/s. Both coordinates must move together. */
static void run_breaking(const char *name, const char *second, stepping how, double rate,
                         double factor, double warned, breaking *most) {
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
        const double wanted = moved_m(rate, t, factor, warned);
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

static void check_breaking(const char *name, const char *second, double factor, double warned) {
    for (int real = 0; real < 2; real++) {
        const engine_kind *kind = real == 0 ? &engine_double : &engine_float;
        static const double steps[] = {1e-3, 0.25e-3};
        breaking most[2] = {{0.0, 0.0}, {0.0, 0.0}};
        for (int k = 0; k < 2; k++) {
            for (int i = 0; i < 10; i++) {
                const double rate = 0.7 * pow(1.27, i);
                run_breaking(name, second,
                             (stepping){.kind = kind, .method = WH_RK4, .step_s = steps[k]}, rate,
                             factor, warned, &most[k]);
            }
        }
        printf("  %s, %s: at rest to %.1e m; off by %.1e m at 1 ms, %.1e m at 0.25 ms\n", name,
               kind->name, most[0].at_rest_m, most[0].off_m, most[1].off_m);
        /* the bodies must not creep before they break away */
        TEST_ASSERT_TRUE(most[0].at_rest_m <= (real == 0 ? 1e-12 : 1e-9));
        TEST_ASSERT_TRUE(most[0].off_m < (real == 0 ? 1e-8 : 1e-4));
        TEST_ASSERT_TRUE(most[1].off_m <= most[0].off_m + (real == 0 ? 1e-12 : 1e-5));
    }
}

/* The beam of mass m turns about its left support with the inertia of 4/3 m: 4/3 m y'' = 2 P - m g. */
TEST(hard_contacts, beam_lifts_off_two_supports) {
    check_breaking("beam_lifts", "s", 3.0 / (4.0 * 2.0) * 2.0, 10.0);
}

/* 2 m x'' = P - 2 mu_k m g. */
TEST(hard_contacts, two_blocks_break_loose_together) {
    check_breaking("blocks_slide", "y", 1.0 / 2.0, 8.0);
}

#define PULL_N 2.0
#define LOAD_N 30.0
#define STATIC 0.5
#define KINETIC 0.4
#define PHASE_RATE 10.0

/* Advances velocity and position by `s` seconds of forward sliding, which begin at phase p. If `pressed`, the load
 * acts. */
static void slide(double p, double s, int pressed, double *v, double *x) {
    const double w = PHASE_RATE;
    const double k = pressed ? KINETIC * LOAD_N : 0.0;
    *x += *v * s + PULL_N * s * s / 2.0 + k / (w * w) * (cos(p + w * s) - cos(p)) +
          k / w * sin(p) * s;
    *v += PULL_N * s - k / w * (sin(p + w * s) - sin(p));
}

/* The first moment within `span` at which a slide under load comes to rest; -1 if there is none. */
static double stops_after(double p, double span, double v) {
    double low = 0.0;
    double high = -1.0;
    for (int i = 1; i <= 20000 && high < 0.0; i++) { /* finds the first negative speed */
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

/* Position and speed at time t, from rest at phase 0. */
static double pulled_m(double t, double *speed) {
    const double w = PHASE_RATE;
    const double quarter = acos(-1.0) / 2.0;
    /* the phase at which the mass breaks loose */
    const double loose = acos(PULL_N / (STATIC * LOAD_N));
    double now = 0.0; /* phase reached so far */
    double v = 0.0;
    double x = 0.0;
    const double end = w * t;
    for (int turn = 0; now < end; turn++) {
        const double base = 4.0 * quarter * turn;
        double next = fmin(end, base + loose); /* sticks until then */
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
    for (int i = 1; i <= 30; i++) { /* compares the same moments for each step */
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

TEST(hard_contacts, a_load_that_pulsates_and_vanishes) {
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
    TEST_ASSERT_TRUE(events[0] >= 16); /* more than four turns with four events each */
    TEST_ASSERT_TRUE(off[2] > 1e-13 && off[0] < 1e-5);
    TEST_ASSERT_TRUE(log2(off[0] / off[2]) / 2.0 > 3.5);
    TEST_ASSERT_TRUE(in_float < 1e-4);
}

TEST(hard_contacts, the_cradle_swings) {
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
            /* in the first half of the period the first ball swings */
            const double part = fmod(t + period / 4.0, period) / period;
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
        TEST_ASSERT_TRUE(contacts_events(&m) >= 8 * 4); /* eight passages with four impacts each */
        TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
        motion_close(&m);
    }
}

/* Error relative to the amplitude at the end, F0/(2 k) w t. */
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

TEST(hard_contacts, undamped_resonance) {
    const double coarse = resonance_off(2e-3, &engine_double);
    const double fine = resonance_off(1e-3, &engine_double);
    const double in_float = resonance_off(1e-3, &engine_float);
    printf("  off by %.2e of the amplitude at 2 ms, %.2e at 1 ms: order %.2f; in float %.1e\n",
           coarse, fine, log2(coarse / fine), in_float);
    TEST_ASSERT_TRUE(fine > 1e-10 && fine < 1e-6);
    TEST_ASSERT_TRUE(log2(coarse / fine) > 3.5 && log2(coarse / fine) < 5.5);
    TEST_ASSERT_TRUE(in_float < 1e-4);
}

/* === suite hard_origin ======================================================================== */
/* Straight flights past the origin of polar and spherical coordinates (docs/hard/polar.whirl, docs/hard_cases.md).
 * `whirl run` must warn if a flight ends far from its line, and be silent if the flight is accurate. The proposed
 * remedy must work. */

static void run_with(const char *target, const char *set, bool is_float, const char *step,
                     said *what) {
    COMMAND_SAY(command_run, what, target, "--quiet", "--number", is_float ? "float" : "double",
                "--step", step, set != NULL ? "--set" : NULL, set);
}

static bool tells(const said *what) { return what->status != 0 || what->err[0] != '\0'; }

/* Final error in m of a straight flight that passes the origin at the distance d_m. */
static double passage_by(wh_method method, double d_m, double step_s, const engine_kind *kind,
                         bool compensated) {
    char set[40];
    motion m;
    snprintf(set, sizeof set, "d=%.17g m", d_m);
    motion_open_file(&m, HARD "polar.whirl", "", "polar_passes",
                     (stepping){.kind = kind,
                                .method = method,
                                .compensated = compensated,
                                .step_s = step_s,
                                .set = set});
    const bool went = motion_step(&m, (uint64_t)(1.0 / step_s + 0.5)) == WH_OK;
    const double off = hypot(motion_value(&m, "x") - 0.5, motion_value(&m, "y") - d_m);
    motion_close(&m);
    return went ? off : (double)INFINITY;
}

static double passage_off_m(double d_m, double step_s, const engine_kind *kind, bool compensated) {
    return passage_by(WH_RK4, d_m, step_s, kind, compensated);
}

/* The method that a hint names; `own` if the hint names none. */
static wh_method method_named(const char *hint, wh_method own) {
    const char *at = strstr(hint, "--method ");
    for (int m = 0; at != NULL && m < WH_METHODS; m++) {
        const size_t size = strlen(wh_methods[m].word);
        if (strncmp(at + 9, wh_methods[m].word, size) == 0 && strchr(" ;,", at[9 + size]) != NULL) {
            return (wh_method)m;
        }
    }
    return own;
}

/* Methods of low order have larger errors here and would need extremely short steps. The proposed remedy must be a
 * possible one, and must work. */
TEST(hard_origin, past_the_origin_by_crude_methods) {
    static const wh_method crude[] = {WH_EULER, WH_SEMI_IMPLICIT_EULER, WH_HEUN, WH_NYSTROEM3};
    dice d = dice_of("crude", 15006);
    const unsigned cases = dice_cases(few_or_all(12, 120));
    unsigned cures = 0;
    unsigned others = 0;
    double cured_m = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const wh_method own = crude[i % 4];
        /* distances up to the limit for nystroem3 */
        const double d_m = pow(10.0, dice_between(&d, -4.0, -2.6));
        char set[40];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "d=%.17g m", d_m);
        static const char target[] = HARD "polar.whirl";
        COMMAND_SAY(command_run, &what, target, "--quiet", "--method", wh_methods[own].word,
                    "--set", set);
        snprintf(about, sizeof about, "%s past %.3g m: %s", wh_methods[own].word, d_m, what.err);
        const char *resolves = strstr(what.err, " cures this (tried)");
        TEST_ASSERT_NOT_NULL_MESSAGE(resolves, about);
        const char *hint = resolves;
        while (strncmp(hint, "hint: ", 6) != 0) {
            hint--;
        }
        const double step_s = strstr(hint, "--step ") != NULL ? said_named_step_s(hint) : 1e-3;
        const wh_method method = method_named(hint, own);
        /* at 1 m/s the passage takes about d_m seconds; the proposed step must not be below a 200th of this time */
        TEST_ASSERT_TRUE_MESSAGE(step_s >= d_m / 200.0 && step_s <= 1e-3, about);
        const double now_m = passage_by(method, d_m, step_s, &engine_double, false);
        snprintf(about + strlen(about), 40, " -> %.3g m", now_m);
        TEST_ASSERT_TRUE_MESSAGE(now_m < 2e-3, about);
        cured_m = fmax(cured_m, now_m);
        cures++;
        others += method != own ? 1U : 0U;
    }
    printf("  %u passages by crude methods: %u by another, cured to %.1e m\n", cures, others,
           cured_m);
    TEST_ASSERT_TRUE(others > 0 && cures > 0);
}

/* A flight without rotation goes through the origin, where r changes its sign. If a stage is at the origin itself,
 * theta'' is not a number, and the run must end with a message. */
TEST(hard_origin, through_the_origin) {
    static const char *const steps[] = {"1ms", "0.7ms", "0.3ms", "2ms"};
    unsigned through = 0;
    for (unsigned i = 0; i < 8; i++) {
        said what;
        run_with(HARD "polar.whirl", "d=0", i % 2 == 1, steps[i / 2], &what);
        const double off_m =
            passage_off_m(0.0, i / 2 == 0 ? 1e-3 : 1e-3 / (double)i, &engine_double, false);
        TEST_ASSERT_TRUE(off_m < 1e-9 || isinf(off_m));
        TEST_ASSERT_TRUE_MESSAGE(what.status == 0 || what.status == 1, what.err);
        TEST_ASSERT_TRUE_MESSAGE(
            what.status == said_owes(what.err) || strstr(what.err, "t = 0.") != NULL, what.err);
        through += what.status == said_owes(what.err) ? 1U : 0U;
    }
    printf("  %u of 8 go through, the others say when they end\n", through);
}

/* A flight without forces in a straight line past the origin. */
typedef struct flight {
    double at[3], rate[3]; /* position and rate at the start; the speed is 1 m/s */
    char text[400];        /* text of its scene */
} flight;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static flight flight_drawn(dice *d, double d_m) {
    flight f = {{0.0}, {0.0}, ""};
    double away[3] = {0.0};
    double size = 0.0;
    while (size < 0.2) { /* two directions at a right angle, neither along the axis */
        for (int i = 0; i < 3; i++) {
            f.rate[i] = dice_between(d, -1.0, 1.0);
            away[i] = dice_between(d, -1.0, 1.0);
        }
        const double length = sqrt(dot(f.rate, f.rate));
        for (int i = 0; i < 3; i++) {
            f.rate[i] /= length;
        }
        const double along = dot(away, f.rate);
        for (int i = 0; i < 3; i++) {
            away[i] -= along * f.rate[i];
        }
        size = fmin(sqrt(dot(away, away)), hypot(f.rate[0], f.rate[1]));
    }
    const double length = sqrt(dot(away, away));
    for (int i = 0; i < 3; i++) {
        f.at[i] = d_m * away[i] / length - 0.5 * f.rate[i];
    }
    const double rho2 = f.at[0] * f.at[0] + f.at[1] * f.at[1];
    const double r = sqrt(dot(f.at, f.at));
    const double r_rate = dot(f.at, f.rate) / r;
    snprintf(
        f.text, sizeof f.text,
        "scene drawn {\nset g = 0 [m/s^2]\nstart r = %.17g [m], theta = %.17g, phi = %.17g\n"
        "start r' = %.17g [m/s], theta' = %.17g [rad/s], phi' = %.17g [rad/s]\nuntil 1 [s]\n}\n",
        r, atan2(sqrt(rho2), f.at[2]), atan2(f.at[1], f.at[0]), r_rate,
        (f.at[2] / r * r_rate - f.rate[2]) / sqrt(rho2),
        (f.at[0] * f.rate[1] - f.at[1] * f.rate[0]) / rho2);
    return f;
}

static double flight_off_m(const flight *f, double step_s, const engine_kind *kind,
                           bool compensated) {
    static const char *const names[] = {"x", "y", "z"};
    double sum = 0.0;
    motion m;
    motion_open_more(
        &m, "spherical_particle.whirl", f->text,
        (stepping){.kind = kind, .method = WH_RK4, .compensated = compensated, .step_s = step_s});
    const bool went = motion_step(&m, (uint64_t)(1.0 / step_s + 0.5)) == WH_OK;
    for (int i = 0; i < 3; i++) {
        const double off = motion_value(&m, names[i]) - (f->at[i] + f->rate[i]);
        sum += off * off;
    }
    motion_close(&m);
    return went ? sqrt(sum) : (double)INFINITY;
}

/* Flights past the origin of polar coordinates if `plane`, else of spherical ones. */
static void check_passages(bool plane) {
    dice d = plane ? dice_of("origin", 15001) : dice_of("space", 15004);
    const unsigned cases = dice_cases(few_or_all(8, 60));
    unsigned off_course = 0;
    unsigned sound = 0;
    double cured_m = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const double d_m = pow(10.0, dice_between(&d, -4.5, plane ? -0.5 : -0.3));
        const flight f = plane ? (flight){{0.0}, {0.0}, ""} : flight_drawn(&d, d_m);
        const bool is_float = i % 2 == 1;
        const engine_kind *kind = is_float ? &engine_float : &engine_double;
        const double off_m =
            plane ? passage_off_m(d_m, 1e-3, kind, false) : flight_off_m(&f, 1e-3, kind, false);
        char target[80] = HARD "polar.whirl";
        char set[40];
        char about[SAID_SIZE + 500];
        said what;
        snprintf(set, sizeof set, "d=%.17g m", d_m);
        if (!plane) {
            char *text = horizons_builtin("spherical_particle.whirl", f.text);
            snprintf(target, sizeof target, "%s:drawn", model_keep(text));
            free(text);
        }
        run_with(target, plane ? set : NULL, is_float, "1ms", &what);
        snprintf(about, sizeof about, "past %.3g m, off by %.3g m: %s%s", d_m, off_m, f.text,
                 what.err);
        if (off_m > 0.02) {
            off_course++;
            TEST_ASSERT_TRUE_MESSAGE(tells(&what), about);
            const double step_s = said_named_step_s(what.err);
            if (step_s > 0.0 && step_s < 1e-3) { /* tries the proposed remedy */
                const bool compensated = strstr(what.err, "--compensated") != NULL;
                const double now_m = plane ? passage_off_m(d_m, step_s, kind, compensated)
                                           : flight_off_m(&f, step_s, kind, compensated);
                TEST_ASSERT_TRUE_MESSAGE(now_m < 2e-3, about);
                cured_m = fmax(cured_m, now_m);
            }
        } else if (off_m < 1e-4) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
    }
    model_drop();
    printf("  %u passages: %u end more than 2 cm off, all told, cured to %.1e m; %u sound\n", cases,
           off_course, cured_m, sound);
    TEST_ASSERT_TRUE(off_course > cases / 10 && sound > cases / 10);
}

TEST(hard_origin, past_the_origin_of_polar_coordinates) { check_passages(true); }
TEST(hard_origin, past_the_origin_of_spherical_coordinates) { check_passages(false); }

/* === suite hard_cases ========================================================================= */
/* A motor that is too weak to pass a resonance (Sommerfeld), a very small inertia, decaying hops on a moving floor,
 * a table that falls away, fast rotation. Compared with closed forms, or with the same energies in numbers
 * (linkage.h). */

/* A carriage of 10 kg between springs, with a natural frequency of 20 rad/s. It carries a rotor with an eccentric
 * mass. Without the carriage, the motor's torque would take the rotor to 60 rad/s. */
static linkage shaker(double torque_Nm) {
    linkage of = {.bodies = 2};
    of.body[0] = (linkage_body){.parent = -1,
                                .slides = true,
                                .mass_kg = 9.5,
                                .inertia_kgm2 = 1.0,
                                .stiffness = 4000.0,
                                .damping = 4.0,
                                .wave = 1.0};
    of.body[1] = (linkage_body){.parent = 0,
                                .mass_kg = 0.5,
                                .centre_m = 0.125,
                                .inertia_kgm2 = 0.0625,
                                .damping = torque_Nm / 60.0,
                                .drive = torque_Nm};
    return of;
}

/* The rotor's speed after 12 s in the reference. */
static double reference_after(double torque_Nm) {
    const linkage of = shaker(torque_Nm);
    linkage_motion wanted;
    linkage_integrate(&of, 1e-3, 12000, &wanted);
    return (double)wanted.state[LINKAGE_BODIES + 1];
}

static double speed_after(double torque_Nm, stepping how) {
    char stall[40];
    motion m;
    snprintf(stall, sizeof stall, "stall=%.17g", torque_Nm);
    how.set = stall;
    motion_open_file(&m, HARD "sommerfeld.whirl", "", "shaker_stays", how);
    motion_to(&m, 12.0);
    const double speed = motion_value(&m, "a'");
    motion_close(&m);
    return speed;
}

TEST(hard_cases, a_motor_at_a_resonance) {
    const double weak_reference = reference_after(0.25);
    const double strong_reference = reference_after(1.5);
    const double weak = speed_after(0.25, IN_DOUBLE);
    const double strong = speed_after(1.5, IN_DOUBLE);
    const double in_float = speed_after(0.25, IN_FLOAT_COMPENSATED);
    printf("  0.25 N m: %.4f rad/s, off by %.1e, in float by %.1e; 1.5 N m: %.4f, off by %.1e\n",
           weak, weak - weak_reference, in_float - weak_reference, strong,
           strong - strong_reference);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, weak_reference, weak);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, strong_reference, strong);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, weak_reference, in_float);
    TEST_ASSERT_TRUE(weak > 17.0 && weak < 21.0); /* stays below the resonance at 20 rad/s */
    TEST_ASSERT_TRUE(strong > 40.0);
}

/* A disc on a pivot without friction, at the end of a pendulum, must keep its rotation, although its angle is
 * relative to the pendulum. The disc's inertia may be tiny compared with that of the pendulum. */
TEST(hard_cases, a_disc_of_hardly_any_inertia) {
    double worst[2] = {0.0, 0.0};
    for (int k = 0; k <= 12; k += 3) {
        for (int real = 0; real < 2; real++) {
            linkage of = {.bodies = 2, .gravity_mps2 = {0.0, -9.875}};
            linkage_motion wanted;
            motion m;
            of.body[0] = (linkage_body){
                .parent = -1, .mass_kg = 2.0, .centre_m = 0.5, .inertia_kgm2 = 0.125, .wave = 1.0};
            of.body[1] = (linkage_body){.parent = 0,
                                        .relative = true,
                                        .at_m = 1.0,
                                        .mass_kg = 1.0,
                                        .inertia_kgm2 = pow(10.0, -k),
                                        .wave = 1.0};
            of.start_rate[1] = 5.0;
            char inertia[40];
            snprintf(inertia, sizeof inertia, "I=%.17g", of.body[1].inertia_kgm2);
            motion_open_file(&m, HARD "disc.whirl", "", "disc_swings",
                             (stepping){.kind = real == 0 ? &engine_double : &engine_float,
                                        .method = WH_RK4,
                                        .set = inertia});
            motion_to(&m, 2.0);
            linkage_integrate(&of, 1e-3, 2000, &wanted);
            const double spin = motion_value(&m, "q'") + motion_value(&m, "s'");
            const double swing = motion_value(&m, "q");
            worst[real] =
                fmax(worst[real], fmax(fabs(spin - 5.0), fabs(swing - (double)wanted.state[0])));
            motion_close(&m);
        }
    }
    printf("  inertia 1 to 1e-12 kg m^2: off by at most %.1e in double, %.1e in float\n", worst[0],
           worst[1]);
    TEST_ASSERT_TRUE(worst[0] < 1e-11);
    TEST_ASSERT_TRUE(worst[1] < 2e-3);
}

static void open_table(motion *m, double A_m, double w_radps, double height_m, double restitution,
                       double step_s) {
    char more[400];
    snprintf(more, sizeof more,
             "scene drawn {\nset A = %.17g [m], w = %.17g [rad/s], h0 = %.17g [m], e = %.17g\n"
             "start f = -A, b = h0 - A\nuntil 5 [s]\n}\n",
             A_m, w_radps, height_m, restitution);
    motion_open_file(m, HARD "moving_floor.whirl", more, "drawn", IN_DOUBLE_STEP(step_s));
}

TEST(hard_cases, hops_on_a_moving_floor_end) {
    motion m;
    open_table(&m, 0.05, 10.0, 0.3, 0.5, 1e-3); /* at most 5 m/s^2: bodies rest on the table */
    motion_to(&m, 2.0);
    for (int k = 0; k < 3000; k++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, motion_value(&m, "b") - motion_value(&m, "f"));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, motion_value(&m, "b'") - motion_value(&m, "f'"));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.05 * cos(50.0), motion_value(&m, "b"));
    motion_close(&m);
}

/* The table leaves a ball behind when its downward acceleration exceeds g: cos(w t) = -g/(A w^2). */
TEST(hard_cases, a_table_falls_away) {
    for (int k = 0; k < 5; k++) {
        const double A = 0.02 + 0.01 * k;
        const double w = 30.0;
        const double leaves = acos(-9.81 / (A * w * w)) / w;
        const double t = 0.02; /* seconds of flight */
        const double at = leaves + t;
        const double wanted =
            -A * cos(w * leaves) + A * w * sin(w * leaves) * t - 9.81 * t * t / 2.0;
        motion m;
        const double step = at / 128.0; /* the last step ends at the compared moment */
        open_table(&m, A, w, 0.0, 0.0, step);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 128));
        TEST_ASSERT_TRUE(motion_value(&m, "b") > motion_value(&m, "f"));
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, wanted, motion_value(&m, "b"));
        motion_close(&m);
    }
}

TEST(hard_cases, fast_rotation) {
    for (int k = 0; k < 5; k++) {
        const double rate = 600.0 * (k + 1) + 17.0 * k; /* up to 3068 rad/s: 0.49 turns in a step */
        char start[60];
        motion m;
        snprintf(start, sizeof start, "th'=%.17g", rate);
        motion_open_file(&m, HARD "rotor.whirl", "", "rotor_fast",
                         (stepping){.kind = &engine_float, .method = WH_RK4, .start = start});
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 100000));
        /* the rotation of a step is rounded to 2^-32 turns; rate and step are floats */
        const double turned = rate * 100.0;
        TEST_ASSERT_DOUBLE_WITHIN(turned * 1.3e-7 + 1e-4, turned, motion_value(&m, "th"));
        motion_close(&m);
    }
}

/* === suite hard_edges ========================================================================= */
/* Borderline cases (docs/hard, docs/hard_cases.md), compared with closed forms on both sides: `whirl run` must warn
 * of wrong runs and not of accurate ones. A floor too stiff for the step, inputs that jump, amplitudes from
 * subnormal numbers to the end of the range, unequal masses. */

/* Relative change of the energy of a ball after 2 s on a floor of springs. */
static double floor_off(double hw, const engine_kind *kind) {
    char set[40];
    motion m;
    snprintf(set, sizeof set, "hw=%.17g", hw);
    motion_open_file(&m, HARD "stiff_stop.whirl", "", "floor_of_spring",
                     (stepping){.kind = kind, .method = WH_RK4, .set = set});
    double most = 0.0;
    for (int i = 0; i < 2000 && isfinite(most); i++) {
        const bool stepped = motion_step(&m, 1) == WH_OK;
        const double in = fmin(0.0, motion_value(&m, "z"));
        const double E = motion_value(&m, "energy") + hw * hw * 1e6 * in * in / 2.0;
        most = stepped ? fmax(most, fabs(E / (9.81 * 0.1) - 1.0)) : (double)INFINITY;
    }
    motion_close(&m);
    return most;
}

TEST(hard_edges, stiff_floor_is_right_or_warned) {
    dice d = dice_of("floors", 15002);
    const unsigned cases = dice_cases(few_or_all(10, 80));
    unsigned gone = 0;
    unsigned sound = 0;
    for (unsigned i = 0; i < cases; i++) {
        const double hw = pow(10.0, dice_between(&d, -2.0, 2.0));
        const bool is_float = i % 2 == 1;
        const double off = floor_off(hw, is_float ? &engine_float : &engine_double);
        char set[40];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "hw=%.17g", hw);
        run_with(HARD "stiff_stop.whirl:floor_of_spring", set, is_float, "1ms", &what);
        snprintf(about, sizeof about, "h w = %.3g, off by %.3g: %s", hw, off, what.err);
        if (off > 0.02) {
            gone++;
            TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, "energy balance fails") != NULL ||
                                         strstr(what.err, "diverged") != NULL,
                                     about);
        } else if (off < 3e-4) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
    }
    printf(
        "  %u floors, h w from 0.01 to 100: %u change the energy by more than 2 %%, all told; %u "
        "sound\n",
        cases, gone, sound);
    TEST_ASSERT_TRUE(gone > cases / 10 && sound > cases / 10);
}

/* With a `stop` in place of a stiff spring, the height after 2 s of bounces must be right for any step. */
TEST(hard_edges, a_stop_has_no_stiffness) {
    static const double steps[] = {1e-2, 5e-3, 1e-3, 1e-4};
    const double G = 9.81;
    const double fall = sqrt(0.2 / G);
    const double phase = fmod(2.0 + fall, 2.0 * fall) - fall;
    const double wanted = 0.1 - G * phase * phase / 2.0;
    for (unsigned i = 0; i < 8; i++) {
        const bool is_float = i % 2 == 1;
        motion m;
        motion_open_file(&m, HARD "stiff_stop.whirl", "", "floor_of_stop",
                         (stepping){.kind = is_float ? &engine_float : &engine_double,
                                    .method = WH_RK4,
                                    .step_s = steps[i / 2]});
        motion_to(&m, 2.0);
        const double off_m = motion_value(&m, "z") - wanted;
        printf("  step %g s, %s: off by %.1e m\n", steps[i / 2], m.kind->name, off_m);
        motion_close(&m);
        TEST_ASSERT_DOUBLE_WITHIN(is_float ? 2e-4 : 1e-9, 0.0, off_m);
    }
}

/* Advances position and velocity of x'' + w^2 x = u by the time t, for constant u. */
static void exactly(double w, double u, double t, double *x, double *v) {
    const double y = *x - u / (w * w);
    const double x1 = y * cos(w * t) + *v / w * sin(w * t);
    *v = -y * w * sin(w * t) + *v * cos(w * t);
    *x = x1 + u / (w * w);
}

/* Final error in m after ten jumps of the input between steps. */
static double jumps_off_m(dice *d, double step_s, image_matrix_of matrix) {
    motion m;
    double x = 0.0;
    double v = 0.0;
    motion_open_file(
        &m, HARD "jump.whirl", "scene drawn { start t' = 1 }\n", "drawn",
        (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s, .matrix = matrix});
    for (int i = 0; i < 10; i++) {
        const double u = dice_between(d, -10.0, 10.0);
        const int steps = 8 * (10 + (int)dice_one_of(d, 40));
        m.kind->set_input(m.run, 0, u);
        TEST_ASSERT_EQUAL_INT(WH_OK,
                              motion_step(&m, (uint64_t)(steps * (1e-3 / step_s) / 8.0 + 0.5)));
        exactly(20.0, u, steps * 1e-3 / 8.0, &x, &v);
    }
    const double off = fabs(motion_value(&m, "x") - x);
    motion_close(&m);
    return off;
}

TEST(hard_edges, inputs_that_jump_between_steps) {
    double least = 9.0;
    double most = 0.0;
    double exact = 0.0;
    dice d = dice_of("jumps", 15003);
    for (int k = 0; k < 6; k++) {
        dice same[2] = {d, d};
        const double coarse = jumps_off_m(&d, 1e-3, MATRIX_NONE);
        const double fine = jumps_off_m(&same[0], 0.5e-3, MATRIX_NONE);
        exact = fmax(exact, jumps_off_m(&same[1], 1e-3, MATRIX_EXACT));
        least = fmin(least, log2(coarse / fine));
        most = fmax(most, coarse);
    }
    printf("  off by at most %.1e m at 1 ms, order %.2f; --matrix exact %.1e m\n", most, least,
           exact);
    TEST_ASSERT_TRUE(most > 1e-12 && most < 1e-7);
    TEST_ASSERT_TRUE(least > 3.5 && least < 4.5);
    TEST_ASSERT_TRUE(exact < 1e-13);
}

static double jump_inside_off_m(double step_s, const engine_kind *kind) {
    motion m;
    double x = 0.0;
    double v = 0.0;
    motion_open_file(&m, HARD "jump.whirl", "", "jump_inside",
                     (stepping){.kind = kind, .method = WH_RK4, .step_s = step_s});
    motion_to(&m, 2.0);
    exactly(20.0, 8.0, 2.0 - 2.0 / 3.0, &x, &v);
    const double off = fabs(motion_value(&m, "x") - x);
    motion_close(&m);
    return off;
}

TEST(hard_edges, a_jump_inside_a_step) {
    const double coarse = jump_inside_off_m(1e-3, &engine_double);
    const double fine = jump_inside_off_m(0.5e-3, &engine_double);
    const double in_float = jump_inside_off_m(1e-3, &engine_float);
    printf("  off by %.1e m at 1 ms, %.1e m at 0.5 ms: order %.2f; in float %.1e m\n", coarse, fine,
           log2(coarse / fine), in_float);
    TEST_ASSERT_TRUE(coarse > 1e-12 && coarse < 1e-7);
    TEST_ASSERT_TRUE(log2(coarse / fine) > 3.5);
    TEST_ASSERT_TRUE(in_float < 1e-3 * 0.04);
}

/* Largest relative error of a swing of amplitude A; infinite if the run ends early. */
static double swing_off(double A_m, const engine_kind *kind, bool compensated) {
    char set[60];
    motion m;
    double most = 0.0;
    snprintf(set, sizeof set, "A=%.17g m", A_m);
    motion_open_file(
        &m, HARD "scales.whirl", "", "scales_usual",
        (stepping){.kind = kind, .method = WH_RK4, .compensated = compensated, .set = set});
    for (int i = 1; i <= 1000 && isfinite(most); i++) {
        const bool stepped = motion_step(&m, 1) == WH_OK;
        const double off = fabs(motion_value(&m, "x") / A_m - cos(1e-2 * i));
        most = stepped && !isnan(off) ? fmax(most, off) : (double)INFINITY;
    }
    motion_close(&m);
    return most;
}

static void scales(bool is_float, double least, double last) {
    unsigned told = 0;
    unsigned right = 0;
    const double apart = is_float ? 0.5 : 2.5;
    for (int i = 0; least + apart * i <= last; i++) {
        const double decade = least + apart * i;
        const double A_m = pow(10.0, decade);
        const double off = swing_off(A_m, is_float ? &engine_float : &engine_double, false);
        char set[60];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "A=%.17g m", A_m);
        run_with(HARD "scales.whirl:scales_usual", set, is_float, "1ms", &what);
        snprintf(about, sizeof about, "amplitude %.3g m, off by %.3g: %s", A_m, off, what.err);
        if (off > 0.03) {
            TEST_ASSERT_TRUE_MESSAGE(tells(&what), about);
        }
        if (off < 1e-4 && decade > (is_float ? -18.0 : -100.0) && decade < 13.0) {
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
        told += tells(&what) ? 1U : 0U;
        right += off < 1e-4 ? 1U : 0U;
    }
    printf("  %s: right at %u amplitudes, told of %u\n", is_float ? "float" : "double", right,
           told);
    TEST_ASSERT_TRUE(right > 20 && told > 2);
}

TEST(hard_edges, amplitudes_to_the_ends_of_float) { scales(true, -45.0, 38.5); }
TEST(hard_edges, amplitudes_to_the_ends_of_double) { scales(false, -305.0, 307.5); }

/* x/A at ten moments of a swing under a cubic force. The scene scales the force with A so that the frequency does
 * not depend on A. Returns false if the run ends early. */
static bool cubic(double A_m, const engine_kind *kind, double x[10]) {
    char set[60];
    motion m;
    bool went = true;
    snprintf(set, sizeof set, "A=%.17g m", A_m);
    motion_open_file(&m, HARD "scales.whirl", "", "cubic_small",
                     (stepping){.kind = kind, .method = WH_RK4, .set = set});
    for (int i = 0; i < 10; i++) {
        went = went && motion_step(&m, 100) == WH_OK;
        x[i] = motion_value(&m, "x") / A_m;
    }
    motion_close(&m);
    return went;
}

/* In float, the cube of the distance underflows long before the distance does. The hint must be to use double. */
TEST(hard_edges, products_that_fall_below_float) {
    double wanted[10];
    unsigned off_course = 0;
    unsigned sound = 0;
    TEST_ASSERT_TRUE(cubic(1.0, &engine_double, wanted));
    for (int k = 0; k <= 32; k++) {
        const double A_m = pow(10.0, -8.0 - 0.25 * k);
        double x[10];
        double off = cubic(A_m, &engine_float, x) ? 0.0 : (double)INFINITY;
        for (int i = 0; i < 10; i++) {
            off = fmax(off, fabs(x[i] - wanted[i]));
        }
        char set[60];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "A=%.17g m", A_m);
        run_with(HARD "scales.whirl:cubic_small", set, true, "1ms", &what);
        snprintf(about, sizeof about, "%.3g m, off by %.3g: %s", A_m, off, what.err);
        if (off > 0.03) {
            off_course++;
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "--number double cures this"), about);
        } else if (off < 1e-4) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
    }
    printf("  cubes of 1e-24 to 1e-48 m^3: %u amplitudes off by a hundredth, all told; %u sound\n",
           off_course, sound);
    TEST_ASSERT_TRUE(off_course >= 3 && sound >= 20);
}

/* Beyond 1e15 no step is accepted. In float, no start of an angle beyond 6.28e9 rad is accepted. */
TEST(hard_edges, starts_that_are_too_large) {
    static const struct {
        const char *file, *start;
        bool is_float;
        int status;
    } starts[] = {
        {HARD "scales.whirl:scales_usual", "x=1e14", false, 1}, /* the rate of x reaches 1e15 */
        {HARD "scales.whirl:scales_usual", "x=9e13", false, 0},
        {HARD "scales.whirl:scales_usual", "x=1e14", true, 1},
        {HARD "scales.whirl:scales_usual", "x=9e13", true, 0},
        {HARD "rotor.whirl:rotor_far", "th=6.281e9", true, 2},
        {HARD "rotor.whirl:rotor_far", "th=-6.281e9", true, 2},
        {HARD "rotor.whirl:rotor_far", "th=6.279e9", true, 0},
        {HARD "rotor.whirl:rotor_fast", "th'=3142", true, 1}, /* half a turn in a step */
        {HARD "rotor.whirl:rotor_fast", "th'=3141", true, 0},
        {HARD "rotor.whirl:rotor_fast", "th'=3142", false, 1},
    };
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        said what;
        COMMAND_SAY(command_run, &what, starts[i].file, "--quiet", "--number",
                    starts[i].is_float ? "float" : "double", "--start", starts[i].start, "--until",
                    "1s");
        TEST_ASSERT_EQUAL_INT_MESSAGE(starts[i].status, what.status, starts[i].start);
        TEST_ASSERT_EQUAL_INT_MESSAGE(starts[i].status != 0, what.err[0] != '\0', what.err);
    }
}

/* Error in m of both bodies after 5 s, with an amplitude of 0.1 m. */
static double unequal_off_m(double mass, const engine_kind *kind) {
    char more[200];
    motion m;
    /* for any masses, this stiffness gives 10 rad/s */
    snprintf(more, sizeof more,
             "scene drawn {\nset m = %.17g [kg], k = %.17g [N/m]\nstart s = 0.1 [m]\n}\n", mass,
             100.0 * mass / (1.0 + mass));
    motion_open_file(&m, HARD "masses.whirl", more, "drawn",
                     (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, 5.0);
    const double s = 0.1 * cos(50.0);
    const double x = mass / (1.0 + mass) * (0.1 - s);
    const double off = fmax(fabs(motion_value(&m, "s") - s), fabs(motion_value(&m, "x") - x));
    motion_close(&m);
    return off;
}

/* Up to a mass ratio of 1e8, round-off has no visible effect. Up to 1e13, it changes the frequency: M + m is rounded by
 * 2^-53 of the larger mass. The test allows the phase error that this gives after 50 rad. Above 1e13, the mass matrix
 * is refused. */
TEST(hard_edges, two_bodies_of_very_different_mass) {
    double worst[2] = {0.0, 0.0};
    double beyond = 0.0;
    for (int decade = -12; decade <= 13; decade++) {
        const double mass = pow(10.0, decade);
        for (int real = 0; real < 2; real++) {
            const double off_m = unequal_off_m(mass, real == 0 ? &engine_double : &engine_float);
            if (decade <= 8) {
                worst[real] = fmax(worst[real], off_m);
            } else {
                beyond = fmax(beyond, off_m);
                TEST_ASSERT_TRUE(off_m < 0.1 * 50.0 * mass * 0x1p-53 + 1e-5 * real + 1e-9);
            }
        }
    }
    for (int decade = 14; decade <= 20; decade++) {
        char set[40];
        said what;
        snprintf(set, sizeof set, "m=1e%d", decade);
        run_with(HARD "masses.whirl", set, decade % 2 == 0, "1ms", &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, what.status, set);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "singular mass matrix"), what.err);
    }
    printf(
        "  masses 1e-12 to 1e8 beside 1 kg: off by at most %.1e m in double, %.1e m in float; to "
        "1e13: %.1e m\n",
        worst[0], worst[1], beyond);
    TEST_ASSERT_TRUE(worst[0] > 1e-12 && worst[0] < 1e-8);
    TEST_ASSERT_TRUE(worst[1] > 1e-9 && worst[1] < 1e-5);
}
