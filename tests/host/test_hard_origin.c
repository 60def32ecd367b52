/* test_hard_origin.c: r -> 0: straight flights past the origin of polar and of spherical coordinates (docs/hard/polar.whirl,
 * docs/hard_cases.md). Where a flight ends off its line `whirl run` says so, and what it says would do is done; where
 * it is right nothing is said. */
#include "command.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "horizons.h"
#include "host/cli/commands.h"
#include "motion.h"

#include "unity.h"

void suite_hard_origin(void);

#define HARD "docs/hard/"

/* What `whirl run` says of it; `set` may be NULL. */
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

/* Words a warning or a refusal has; or none. */
static bool tells(const said *what) { return what->status != 0 || what->err[0] != '\0'; }

/* --- r -> 0 ---------------------------------------------------------------------------------------------------- */

/* A straight flight past the origin at a distance: how far off it ends, m. */
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

static void test_past_the_origin_of_polar_coordinates(void) {
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
            TEST_ASSERT_TRUE_MESSAGE(tells(&what) && strstr(what.err, "singular") != NULL, about);
            const double step_s = said_named_step_s(what.err);
            if (step_s > 0.0 && step_s < 1e-3) { /* what it says would do, done */
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

/* The method that a hint names, or the run's own. */
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

/* Crude methods miss it by more, and would take steps that are no steps any more: what is named can be done, and is
 * done. (It used to be `--step 0ns`.) */
static void test_past_the_origin_by_crude_methods(void) {
    static const wh_method crude[] = {WH_EULER, WH_SEMI_IMPLICIT_EULER, WH_HEUN, WH_NYSTROEM3};
    dice d = dice_of("crude", 15006);
    const unsigned cases = dice_cases(few_or_all(12, 120));
    unsigned cures = 0;
    unsigned others = 0;
    double cured_m = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const wh_method own = crude[i % 4];
        const double d_m = pow(10.0, dice_between(&d, -4.0, -2.6)); /* beyond, Nystroem 3 has it */
        char set[40];
        char about[SAID_SIZE + 100];
        said what;
        snprintf(set, sizeof set, "d=%.17g m", d_m);
        static const char target[] = HARD "polar.whirl";
        const char *words[] = {target,  "--quiet", "--method", wh_methods[own].word,
                               "--set", set,       NULL};
        command_say(command_run, words, &what);
        snprintf(about, sizeof about, "%s past %.3g m: %s", wh_methods[own].word, d_m, what.err);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "singular"), about);
        const char *resolves = strstr(what.err, " would do (tried)");
        TEST_ASSERT_NOT_NULL_MESSAGE(resolves, about);
        const char *hint = resolves;
        while (strncmp(hint, "hint: ", 6) != 0) {
            hint--;
        }
        const double step_s = strstr(hint, "--step ") != NULL ? said_named_step_s(hint) : 1e-3;
        const wh_method method = method_named(hint, own);
        /* at 1 m/s the turn takes d/u: a hundredth of that and less is more than it needs */
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

/* Straight through: with nothing that turns it, r changes its sign and nothing else happens, unless a stage meets the
 * origin itself, where theta'' is no number: then the run ends and says so. */
static void test_through_the_origin(void) {
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

/* A flight without forces past the origin: away is the nearest point, of the length d, and way the direction. */
typedef struct flight {
    double at[3], rate[3]; /* at its start; 1 m/s */
    char text[400];        /* its scene */
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

static void test_past_the_origin_of_spherical_coordinates(void) {
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
            TEST_ASSERT_TRUE_MESSAGE(tells(&what) && strstr(what.err, "singular") != NULL, about);
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

void suite_hard_origin(void) {
    RUN_TEST(test_past_the_origin_of_polar_coordinates);
    RUN_TEST(test_past_the_origin_by_crude_methods);
    RUN_TEST(test_through_the_origin);
    RUN_TEST(test_past_the_origin_of_spherical_coordinates);
}
