/* test_hard.c: hard cases with contacts, and undamped resonance (docs/hard, docs/hard_cases.md), against closed forms.
 * Redundant supports and frictions that break away, friction under a vanishing load, Newton's cradle. */
#include "host/cli/commands.h"

#include "command.h"
#include "contacts.h"
#include "horizons.h"
#include "motion.h"

/* === hard contacts ============================================================================ */

#define HARD "docs/hard/"

static void open_hard(motion *m, const char *file, const char *name, const engine_kind *kind,
                      double step_s) {
    motion_open_file(m, file, "", name,
                     (stepping){.kind = kind, .method = WH_RK4, .step_s = step_s});
}

/* --- redundant contacts --------------------------------------------------------------------------------------- */

#define P0 15.0
#define LIFTS_N 10.0 /* half the beam's weight; both blocks' static friction */

/* Motion since the moment at which P0 sin(rate t) is LIFTS_N. The force has the factor `factor`, less the constant `against`. */
static double moved_m(double rate, double t, double factor, double against) {
    const double t0 = asin(LIFTS_N / P0) / rate;
    const double s = t - t0;
    const double pushed =
        P0 / rate * cos(rate * t0) * s - P0 / (rate * rate) * (sin(rate * t) - sin(rate * t0));
    return s > 0.0 ? factor * (pushed - against * s * s / 2.0) : 0.0;
}

typedef struct breaking {
    double off_m;
    double at_rest_m; /* largest motion before that */
} breaking;

/* Runs until 0.3 s after that moment, while both coordinates move together. The force's phase advances by `rate`, rad/s. */
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
        TEST_ASSERT_TRUE(most[0].at_rest_m <= (real == 0 ? 1e-12 : 1e-9)); /* no creep */
        TEST_ASSERT_TRUE(most[0].off_m < (real == 0 ? 1e-8 : 1e-4));
        TEST_ASSERT_TRUE(most[1].off_m <= most[0].off_m + (real == 0 ? 1e-12 : 1e-5));
    }
}

/* About the left support the inertia is 4/3 m: 4/3 m y'' = 2 P - m g. */
TEST(hard_contacts, a_beam_lifts_off_two_of_three_supports) {
    check_breaking("beam_lifts", "s", 3.0 / (4.0 * 2.0) * 2.0, 10.0);
}

/* 2 m x'' = P - 2 mu_k m g. */
TEST(hard_contacts, two_blocks_break_loose_together) {
    check_breaking("blocks_slide", "y", 1.0 / 2.0, 8.0);
}

/* --- a pulsating load that vanishes -------------------------------------------------------------- */

#define PULL_N 2.0
#define LOAD_N 30.0
#define STATIC 0.5
#define KINETIC 0.4
#define PHASE_RATE 10.0

/* Velocity and place `s` seconds after phase p of forward sliding, with or without the pressing force. */
static void slide(double p, double s, int pressed, double *v, double *x) {
    const double w = PHASE_RATE;
    const double k = pressed ? KINETIC * LOAD_N : 0.0;
    *x += *v * s + PULL_N * s * s / 2.0 + k / (w * w) * (cos(p + w * s) - cos(p)) +
          k / w * sin(p) * s;
    *v += PULL_N * s - k / w * (sin(p + w * s) - sin(p));
}

/* The first moment within `span` at which a pressed slide comes to rest, or -1. v has its minimum when the friction equals
 * the pull again. */
static double stops_after(double p, double span, double v) {
    double low = 0.0;
    double high = -1.0;
    for (int i = 1; i <= 20000 && high < 0.0; i++) { /* the first negative value */
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
    /* the angle at which the mass breaks loose */
    const double loose = acos(PULL_N / (STATIC * LOAD_N));
    double now = 0.0; /* phase */
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
    TEST_ASSERT_TRUE(events[0] >= 16); /* four turns and more of four each */
    TEST_ASSERT_TRUE(off[2] > 1e-13 && off[0] < 1e-5);
    TEST_ASSERT_TRUE(log2(off[0] / off[2]) / 2.0 > 3.5);
    TEST_ASSERT_TRUE(in_float < 1e-4);
}

/* --- Newton's cradle ------------------------------------------------------------------------------------------------ */

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

TEST(hard_contacts, a_resonance_that_nothing_damps) {
    const double coarse = resonance_off(2e-3, &engine_double);
    const double fine = resonance_off(1e-3, &engine_double);
    const double in_float = resonance_off(1e-3, &engine_float);
    printf("  off by %.2e of the amplitude at 2 ms, %.2e at 1 ms: order %.2f; in float %.1e\n",
           coarse, fine, log2(coarse / fine), in_float);
    TEST_ASSERT_TRUE(fine > 1e-10 && fine < 1e-6);
    TEST_ASSERT_TRUE(log2(coarse / fine) > 3.5 && log2(coarse / fine) < 5.5);
    TEST_ASSERT_TRUE(in_float < 1e-4);
}

/* === hard origin ============================================================================== */
/* R -> 0: straight flights past the origin of polar and spherical coordinates (docs/hard/polar.whirl,
 * docs/hard_cases.md). `whirl run` must warn exactly if a flight ends off its line, and its proposed remedy is
 * applied. */

static void run_with(const char *target, const char *set, bool is_float, const char *step,
                     said *what) {
    const char *words[] = {target,
                           "--quiet",
                           "--number",
                           is_float ? "float" : "double",
                           "--step",
                           step,
                           set != NULL ? "--set" : NULL,
                           set,
                           NULL};
    command_say(command_run, words, what);
}

static bool tells(const said *what) { return what->status != 0 || what->err[0] != '\0'; }

/* --- r -> 0 ---------------------------------------------------------------------------------------------------- */

/* A straight flight past the origin at a distance: its final error, m. */
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

TEST(hard_origin, past_the_origin_of_polar_coordinates) {
    dice d = dice_of("origin", 15001);
    const unsigned cases = dice_cases(few_or_all(8, 60));
    unsigned off_course = 0;
    unsigned sound = 0;
    double cured_m = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const double d_m = pow(10.0, dice_between(&d, -4.5, -0.5));
        const bool is_float = i % 2 == 1;
        const engine_kind *kind = is_float ? &engine_float : &engine_double;
        const double off_m = passage_off_m(d_m, 1e-3, kind, false);
        char set[40];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "d=%.17g m", d_m);
        run_with(HARD "polar.whirl", set, is_float, "1ms", &what);
        snprintf(about, sizeof about, "past %.3g m, off by %.3g m: %s", d_m, off_m, what.err);
        if (off_m > 0.02) {
            off_course++;
            TEST_ASSERT_TRUE_MESSAGE(tells(&what), about);
            const double step_s = said_named_step_s(what.err);
            if (step_s > 0.0 && step_s < 1e-3) { /* applies the proposed remedy */
                const bool compensated = strstr(what.err, "--compensated") != NULL;
                const double now_m = passage_off_m(d_m, step_s, kind, compensated);
                TEST_ASSERT_TRUE_MESSAGE(now_m < 2e-3, about);
                cured_m = fmax(cured_m, now_m);
            }
        } else if (off_m < 1e-4) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
    }
    printf("  %u passages: %u end more than 2 cm off, all told, cured to %.1e m; %u sound\n", cases,
           off_course, cured_m, sound);
    TEST_ASSERT_TRUE(off_course > cases / 10 && sound > cases / 10);
}

/* The method that a hint names, or else the run's own. */
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

/* Crude methods have larger errors and would need extremely small steps. The proposed remedy must be a possible one; the test
 * applies it. (A former version proposed `--step 0ns`.) */
TEST(hard_origin, past_the_origin_by_crude_methods) {
    static const wh_method crude[] = {WH_EULER, WH_SEMI_IMPLICIT_EULER, WH_HEUN, WH_NYSTROEM3};
    dice d = dice_of("crude", 15006);
    const unsigned cases = dice_cases(few_or_all(12, 120));
    unsigned cures = 0;
    unsigned others = 0;
    double cured_m = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const wh_method own = crude[i % 4];
        /* d is drawn up to the limit for nystroem3 */
        const double d_m = pow(10.0, dice_between(&d, -4.0, -2.6));
        char set[40];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "d=%.17g m", d_m);
        static const char target[] = HARD "polar.whirl";
        const char *words[] = {target,  "--quiet", "--method", wh_methods[own].word,
                               "--set", set,       NULL};
        command_say(command_run, words, &what);
        snprintf(about, sizeof about, "%s past %.3g m: %s", wh_methods[own].word, d_m, what.err);
        const char *resolves = strstr(what.err, " would do (tried)");
        TEST_ASSERT_NOT_NULL_MESSAGE(resolves, about);
        const char *hint = resolves;
        while (strncmp(hint, "hint: ", 6) != 0) {
            hint--;
        }
        const double step_s = strstr(hint, "--step ") != NULL ? said_named_step_s(hint) : 1e-3;
        const wh_method method = method_named(hint, own);
        /* at 1 m/s the turn takes d/u; the proposed step must not be much shorter than this requires */
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

/* Without rotation the flight goes straight through the origin: r changes its sign undisturbed. If a stage meets the origin
 * itself, theta'' is not a number, and the run ends with a message. */
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

/* --- in space ------------------------------------------------------------------------------------------------- */

/* A flight without forces past the origin: `away` is the nearest point, at distance d, and `way` the direction of flight. */
typedef struct flight {
    double at[3], rate[3]; /* position and rate at its start; 1 m/s */
    char text[400];        /* text of its scene */
} flight;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static flight flight_drawn(dice *d, double d_m) {
    flight f = {{0.0}, {0.0}, ""};
    double away[3] = {0.0};
    double size = 0.0;
    while (size < 0.2) { /* a direction, and one across it, neither along the axis */
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

TEST(hard_origin, past_the_origin_of_spherical_coordinates) {
    dice d = dice_of("space", 15004);
    const unsigned cases = dice_cases(few_or_all(8, 60));
    unsigned off_course = 0;
    unsigned sound = 0;
    double cured_m = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const flight f = flight_drawn(&d, pow(10.0, dice_between(&d, -4.5, -0.3)));
        const bool is_float = i % 2 == 1;
        const engine_kind *kind = is_float ? &engine_float : &engine_double;
        const double off_m = flight_off_m(&f, 1e-3, kind, false);
        char *text = horizons_builtin("spherical_particle.whirl", f.text);
        char target[80];
        char about[SAID_SIZE + 500];
        said what;
        snprintf(target, sizeof target, "%s:drawn", model_keep(text));
        free(text);
        run_with(target, NULL, is_float, "1ms", &what);
        snprintf(about, sizeof about, "off by %.3g m: %s%s", off_m, f.text, what.err);
        if (off_m > 0.02) {
            off_course++;
            TEST_ASSERT_TRUE_MESSAGE(tells(&what), about);
            const double step_s = said_named_step_s(what.err);
            if (step_s > 0.0 && step_s < 1e-3) {
                const bool compensated = strstr(what.err, "--compensated") != NULL;
                const double now_m = flight_off_m(&f, step_s, kind, compensated);
                TEST_ASSERT_TRUE_MESSAGE(now_m < 2e-3, about);
                cured_m = fmax(cured_m, now_m);
            }
        } else if (off_m < 1e-4) {
            sound++;
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
        }
    }
    model_drop();
    printf("  %u flights: %u end more than 2 cm off, all told, cured to %.1e m; %u sound\n", cases,
           off_course, cured_m, sound);
    TEST_ASSERT_TRUE(off_course > cases / 10 && sound > cases / 10);
}
