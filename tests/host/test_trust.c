/* test_trust.c: the horizon that `whirl trust` estimates, compared with independent references in long double, for
 * four chaotic systems in float, compensated float and double. Also built-in scenes. */
#include "command.h"
#include "horizons.h"

/* === suite trust ============================================================================== */

typedef struct arithmetic {
    const char *name;
    const char *step;
    horizons_setting how;
} arithmetic;

static const arithmetic arithmetics[] = {
    {"float, 1 ms", "1 [ms]", {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_NONE}},
    {"float compensated, 1 ms", "1 [ms]", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_NONE}},
    {"double, 1 ms", "1 [ms]", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE}},
    {"double, 0.1 ms", "0.1 [ms]", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE}},
};
enum { ARITHMETICS = sizeof arithmetics / sizeof arithmetics[0] };

/* At the true horizon of a run, the references may differ by this part of the tolerance. */
#define KNOWN 0.05

static void say(const char *what, const horizons *h) {
    const step_doubling *t = h->doubling;
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < t->columns; k++) {
        least = fmin(least, horizons_column_ratio(h, k));
        most = fmax(most, horizons_column_ratio(h, k));
    }
    printf("  %-44s %.6g s, true %.6g s: %.3f; columns %.3f ... %.3f; known to %.1e\n", what,
           h->estimate.until_s, h->true_until_s, horizons_ratio(h), least, most, h->known);
}

static void expect_near(const char *what, const horizons *h, double least, double most) {
    say(what, h);
    TEST_ASSERT_TRUE_MESSAGE(h->known < KNOWN, what);
    TEST_ASSERT_FALSE_MESSAGE(h->estimate.to_the_end, what);
    TEST_ASSERT_TRUE_MESSAGE(isfinite(h->true_until_s) && h->true_until_s < h->doubling->end_s,
                             what);
    TEST_ASSERT_TRUE_MESSAGE(horizons_ratio(h) >= least && horizons_ratio(h) <= most, what);
    for (int k = 1; k < h->doubling->columns; k++) {
        const double ratio = horizons_column_ratio(h, k);
        TEST_ASSERT_TRUE_MESSAGE(ratio >= least && ratio <= most, what);
    }
}

/* Runs a scene of `file` with this start and end, with each number type. */
static void chaotic(const char *name, bool builtin, const char *file, const char *starts,
                    const double *until_s) {
    const int count = (int)few_or_all(3, ARITHMETICS);
    for (int i = 0; i < count; i++) {
        const arithmetic *a = &arithmetics[i];
        char more[600];
        char what[100];
        snprintf(more, sizeof more,
                 "\nscene trusted {\n  use %s\n  start %s\n  step %s\n  until %g [s]\n}\n", name,
                 starts, a->step, until_s[i]);
        char *text = builtin ? horizons_builtin(file, more) : horizons_file(file, more);
        snprintf(what, sizeof what, "%s, %s", name, a->name);
        horizons h = horizons_of(text, "trusted", a->how, HORIZON_TOLERANCE);
        expect_near(what, &h, 0.9, 1.1);
        horizons_free(&h);
        free(text);
    }
}

TEST(trust, thomson_a) {
    chaotic("thomson", true, "thomson.whirl",
            "theta1 = 0, theta2 = 0, X = 0, theta1' = 0, theta2' = 0, X' = 0",
            (const double[]){12.0, 12.0, 12.0, 14.0});
}

TEST(trust, double_pendulum) {
    chaotic("double_pendulum", false, "tests/mechanisms/double_pendulum.whirl",
            "a = 2.5 [rad], b = 2 [rad]", (const double[]){60.0, 60.0, 60.0, 60.0});
}

TEST(trust, triple_pendulum) {
    chaotic("triple_pendulum", false, "tests/mechanisms/triple_pendulum.whirl",
            "q1 = 2.2 [rad], q2 = 2.8 [rad], q3 = 1.7 [rad]\n  set c = 0.0002 [N*m*s]",
            (const double[]){20.0, 20.0, 20.0, 20.0});
}

TEST(trust, lorenz) {
    chaotic("lorenz", false, "tests/mechanisms/lorenz.whirl", "x = 1, y = 0.5, z = 2",
            (const double[]){40.0, 40.0, 45.0, 60.0});
}

/* === suite trust_scenes ======================================================================= */
/* Horizons of built-in scenes. Without divergence, they must reach the end. With coarse steps, simple methods or
 * small tables, they must agree with the reference. With contacts, the reference has 1/32 of the step and finds
 * events by itself. */

/* A built-in scene with its own step, or with another step and end. */
static horizons built_in(const char *file, const char *name, horizons_setting how,
                         double tolerance) {
    char *text = horizons_builtin(file, "");
    horizons h = horizons_of(text, name, how, tolerance);
    free(text);
    return h;
}

static const horizons_setting in_double = {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE};
static const horizons_setting in_float = {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_NONE};
static const horizons_setting compensated = {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_NONE};
static const horizons_setting in_tables = {&engine_float, false, WH_RK4, TABLES_CUBIC, MATRIX_NONE};

static void expect_the_end(const char *file, const char *name, horizons_setting how) {
    horizons h = built_in(file, name, how, HORIZON_TOLERANCE);
    say(name, &h);
    TEST_ASSERT_TRUE_MESSAGE(h.true_until_s >= h.doubling->end_s, name);
    TEST_ASSERT_TRUE_MESSAGE(h.estimate.to_the_end, name);
    TEST_ASSERT_EQUAL_DOUBLE(h.doubling->end_s, h.estimate.until_s);
    horizons_free(&h);
}

TEST(trust_scenes, scenes_trusted_to_the_end) {
    expect_the_end("epicyclic.whirl", "epicyclic_from_rest", in_double);
    expect_the_end("epicyclic.whirl", "epicyclic_from_rest", in_float);
    expect_the_end("epicyclic.whirl", "epicyclic_conserved", in_float);
    expect_the_end("epicyclic.whirl", "epicyclic_conserved", in_tables);
    expect_the_end("eccentric.whirl", "rig_fixed", in_double);
    expect_the_end("eccentric.whirl", "rig_fixed", in_float);
    expect_the_end("eccentric.whirl", "rig_fixed", compensated);
    expect_the_end("spherical_particle.whirl", "spherical_flight", in_float);
    expect_the_end("cuff.whirl", "cuff_equal", in_float); /* X and Y are only round-off */
}

static const char swing[] = "mechanism swing \"two pendulums that exchange their swing\"\n"
                            "coordinate a [rad]\ncoordinate b [rad]\n"
                            "T = 1 [kg*m^2]*(a'^2 + b'^2)/2\n"
                            "V = -40 [J]*cos(a) - 40 [J]*cos(b) + 3 [J]*(a - b)^2/2\n"
                            "scene s {\n  start a = 1.1 [rad]\n  step %g [ms]\n  until 60 [s]\n}\n";

static void expect_ratio(const char *what, const horizons *h, double least, double most) {
    say(what, h);
    TEST_ASSERT_TRUE_MESSAGE(h->known < KNOWN, what);
    TEST_ASSERT_FALSE_MESSAGE(h->estimate.to_the_end, what);
    TEST_ASSERT_TRUE_MESSAGE(isfinite(h->true_until_s), what);
    TEST_ASSERT_TRUE_MESSAGE(horizons_ratio(h) >= least && horizons_ratio(h) <= most, what);
}

/* In these runs the error grows in proportion to time. An estimate that omits a part of the error would be too late
 * by the same part. */
TEST(trust_scenes, steps_and_methods_that_are_too_coarse) {
    static const struct {
        wh_method method;
        double step_ms;
        double tolerance;
    } cases[] = {
        {WH_RK4, 60.0, 1e-3},      {WH_RK4, 40.0, 3e-4},     {WH_RK4, 10.0, 1e-6},
        {WH_RK4, 5.0, 3e-8},       {WH_RK38, 20.0, 1e-4},    {WH_NYSTROEM5, 20.0, 1e-5},
        {WH_NYSTROEM3, 5.0, 1e-4}, {WH_HEUN, 1.0, 1e-5},     {WH_LEAPFROG, 5.0, 1e-3},
        {WH_EULER, 0.1, 1e-2},     {WH_LEAPFROG, 5.0, 3e-4}, {WH_SEMI_IMPLICIT_EULER, 0.5, 1e-4}};
    const size_t apart = few_or_all(1, 0) == 1 ? 2 : 1; /* takes all methods, or every second one */
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i += apart) {
        char text[500];
        char what[100];
        const horizons_setting how = {&engine_double, false, cases[i].method, TABLES_NONE,
                                      MATRIX_NONE};
        snprintf(text, sizeof text, swing, cases[i].step_ms);
        snprintf(what, sizeof what, "swing by %s, %g ms, to %g", wh_methods[cases[i].method].word,
                 cases[i].step_ms, cases[i].tolerance);
        horizons h = horizons_of(text, "s", how, cases[i].tolerance);
        expect_ratio(what, &h, 0.9, 1.1);
        horizons_free(&h);
    }
}

/* Horizons that the round-off of float or the error of tables limits, for any tolerance. */
TEST(trust_scenes, rounding_and_tables) {
    static const double tolerances[] = {1e-4, 3e-6, 3e-7};
    static const horizons_setting settings[] = {
        {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_NONE},
        {&engine_float, false, WH_RK4, TABLES_LINEAR, MATRIX_NONE},
        {&engine_double, false, WH_RK4, TABLES_CUBIC, MATRIX_NONE},
    };
    int ended = 0;
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        for (size_t k = 0; k < sizeof tolerances / sizeof tolerances[0]; k++) {
            horizons h =
                built_in("epicyclic.whirl", "epicyclic_conserved", settings[i], tolerances[k]);
            char what[100];
            snprintf(what, sizeof what, "epicyclic_conserved, %s, tables %s, to %g",
                     settings[i].kind->name, image_tables_words[settings[i].tables], tolerances[k]);
            say(what, &h);
            TEST_ASSERT_TRUE_MESSAGE(horizons_ratio(&h) >= 0.9 && horizons_ratio(&h) <= 1.1, what);
            TEST_ASSERT_TRUE_MESSAGE(h.known < KNOWN, what);
            ended += !h.estimate.to_the_end;
            horizons_free(&h);
        }
    }
    TEST_ASSERT_TRUE(ended >= 4);
}

/* The estimate must be near the true time, or earlier if the tolerance is near float's resolution. Returns 1 if the
 * estimate is before the end of the run, else 0. */
static unsigned expect_contacts(const char *name, horizons_setting how, double tolerance) {
    horizons h = built_in(strncmp(name, "thomson", 7) == 0    ? "thomson.whirl"
                          : strncmp(name, "carriage", 8) == 0 ? "eccentric.whirl"
                          : strncmp(name, "plank", 5) == 0    ? "contacts_together.whirl"
                                                              : "contacts.whirl",
                          name, how, tolerance);
    char what[100];
    snprintf(what, sizeof what, "%s, %s, to %g", name, how.kind->name, tolerance);
    say(what, &h);
    const unsigned ended = !h.estimate.to_the_end;
    const double late_s = h.estimate.until_s - h.true_until_s;
    const double early = tolerance < HORIZON_TOLERANCE ? 0.6 : 0.9;
    const bool near = horizons_ratio(&h) >= early && horizons_ratio(&h) <= 1.1;
    TEST_ASSERT_TRUE_MESSAGE(near || fabs(late_s) <= 4.0 * h.look_s, what);
    horizons_free(&h);
    return ended;
}

TEST(trust_scenes, contacts) {
    static const char *const names[] = {"crash_cart",     "belt_stick_slip", "plank_shaken",
                                        "table_drifts",   "hopper_hops",     "shuttle_buffers",
                                        "thomson_magnet", "carriage_stop",   "crash_both",
                                        "ball_in_air",    "belt_stiffening", "escapement_ticks"};
    static const double tolerances[] = {1e-3, 1e-5, 1e-7};
    const unsigned count = few_or_all(1, sizeof names / sizeof names[0]);
    unsigned ended = 0;
    for (unsigned i = 0; i < count; i++) {
        for (size_t k = 0; k < sizeof tolerances / sizeof tolerances[0]; k++) {
            ended += expect_contacts(names[i], in_float, tolerances[k]);
            ended += expect_contacts(names[i], in_double, tolerances[k]);
        }
    }
    TEST_ASSERT_TRUE(ended >= count);
}

/* In both runs, the first step has too many events, and the ball comes to rest. The runs agree, but must be trusted
 * until 0 s only. */
TEST(trust_scenes, steps_with_too_many_events) {
    horizons h = built_in("contacts.whirl", "ball_between", in_double, HORIZON_TOLERANCE);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, h.doubling->overrun_s);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, h.estimate.until_s);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, h.true_until_s);
    horizons_free(&h);
}
