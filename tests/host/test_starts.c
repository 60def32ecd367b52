/* test_starts.c: checks of a start. Random scenes have stops, which the start may be beyond, and losses, which
 * kick-drift methods cannot compute. The report must name each stop that the start is beyond, with its place and
 * depth, and no other stop. With losses, the report must name the first coordinate. */
#include "command.h"
#include "derived.h"
#include "host/engine/engine.h"
#include "host/engine/start.h"

enum { MOST = 5, TEXT = 4000 };

static char *told_of(diags *errors) {
    static char told[TEXT];
    FILE *out = fmemopen(told, sizeof told, "w");
    TEST_ASSERT_NOT_NULL(out);
    told[0] = '\0';
    diags_flush(errors, out);
    fclose(out);
    return told;
}

static unsigned times(const char *text, const char *what) {
    unsigned count = 0;
    for (const char *at = strstr(text, what); at != NULL; at = strstr(at + 1, what)) {
        count++;
    }
    return count;
}

/* Coordinate i is declared in line 2 + i; its stop, at 0 m or 1 m, is in line 10 + i. */
TEST(starts, stops_that_are_passed) {
    dice d = dice_of("starts", 2316);
    unsigned refused = 0;
    for (unsigned n = few_or_all(60, 600); n > 0; n--) {
        char text[TEXT] = "mechanism m\n";
        char starts[TEXT] = "";
        double beyond[MOST] = {0.0};
        size_t at = strlen(text);
        const int count = 1 + (int)dice_one_of(&d, MOST);
        unsigned wanted = 0;
        for (int i = 0; i < 8; i++) {
            at += (size_t)snprintf(text + at, sizeof text - at,
                                   i < count ? "coordinate q%d [m]\n" : "\n", i);
        }
        at += (size_t)snprintf(text + at, sizeof text - at, "T = 1 [kg]*(q0'^2");
        for (int i = 1; i < count; i++) {
            at += (size_t)snprintf(text + at, sizeof text - at, " + q%d'^2", i);
        }
        at += (size_t)snprintf(text + at, sizeof text - at, ")/2\n");
        for (int i = 0; i < count; i++) {
            const bool upper = dice_one_of(&d, 2) == 0;
            const bool passed = dice_one_of(&d, 3) == 0;
            const bool on_it = !passed && dice_one_of(&d, 3) == 0;
            const double gap = on_it ? 0.0 : dice_between(&d, 1e-6, 0.9) * (passed ? -1.0 : 1.0);
            beyond[i] = passed ? -gap : 0.0;
            wanted += passed;
            at += (size_t)snprintf(text + at, sizeof text - at,
                                   upper ? "stop q%d <= 1 [m] restitution 0.5\n"
                                         : "stop q%d >= 0 [m] restitution 0.5\n",
                                   i);
            snprintf(starts + strlen(starts), sizeof starts - strlen(starts), "%s q%d = %.17g [m]",
                     i > 0 ? "," : "", i, upper ? 1.0 - gap : gap);
        }
        snprintf(text + at, sizeof text - at, "scene s { start%s; step 1 [ms]; until 1 [s] }\n",
                 starts);
        derived made = derived_surely(derived_scene(text, "s"), text);
        diags *errors = diags_new();
        TEST_ASSERT_EQUAL_INT_MESSAGE(wanted == 0,
                                      start_is_possible(made.image, &engine_double, errors), text);
        const char *told = told_of(errors);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted, times(told, "error: "), told);
        for (int i = 0; i < count; i++) {
            char what[80];
            snprintf(what, sizeof what, "t.whirl:%d:", 11 + i);
            const char *line = strstr(told, what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(beyond[i] > 0.0, line != NULL, told);
            if (line != NULL) {
                const char *by = strstr(line, "starts beyond this stop, by ");
                TEST_ASSERT_NOT_NULL(by);
                char *unit;
                TEST_ASSERT_DOUBLE_WITHIN(1e-5 * beyond[i], beyond[i], strtod(by + 28, &unit));
                TEST_ASSERT_EQUAL_STRING_LEN(" m\n", unit, 3);
            }
        }
        refused += wanted > 0;
        diags_free(errors);
        derived_free(&made);
    }
    TEST_ASSERT_TRUE(refused > 20);
}

TEST(starts, kick_methods_refuse_damping) {
    for (int count = 1; count <= MOST; count++) {
        for (int lossy = -1; lossy < count; lossy++) {
            char text[TEXT] = "mechanism m\n";
            size_t at = strlen(text);
            for (int i = 0; i < count; i++) {
                at += (size_t)snprintf(text + at, sizeof text - at, "coordinate q%d [m]\n", i);
            }
            at += (size_t)snprintf(text + at, sizeof text - at, "T = 1 [kg]*(q0'^2");
            for (int i = 1; i < count; i++) {
                at += (size_t)snprintf(text + at, sizeof text - at, " + q%d'^2", i);
            }
            at += (size_t)snprintf(text + at, sizeof text - at, ")/2\nV = 3 [N/m]*q0^2\n");
            if (lossy >= 0) {
                at += (size_t)snprintf(text + at, sizeof text - at, "F = 1 [N*s/m]*q%d'^2/2\n",
                                       lossy);
            }
            snprintf(text + at, sizeof text - at, "scene s { step 1 [ms]; until 1 [s] }\n");
            derived made = derived_surely(derived_scene(text, "s"), text);
            for (int method = 0; method < WH_METHODS; method++) {
                char what[120];
                diags *errors = diags_new();
                const bool kicks = wh_methods[method].takes == WH_NO_RATES;
                TEST_ASSERT_EQUAL_INT(!kicks || lossy < 0,
                                      start_has_method(made.image, (wh_method)method, errors));
                const char *told = told_of(errors);
                snprintf(
                    what, sizeof what,
                    "t.whirl:%d:12: error: %s is not defined here: the accelerations depend on the "
                    "rate of 'q%d'",
                    2 + lossy, wh_methods[method].title, lossy);
                TEST_ASSERT_EQUAL_INT_MESSAGE(kicks && lossy >= 0, strstr(told, what) != NULL,
                                              told);
                diags_free(errors);
            }
            derived_free(&made);
        }
    }
}

/* Some angles inside a cosine start at more turns than float can represent. The report must name each of these
 * angles, at its declaration or its start, and no other. */
TEST(starts, angles_that_start_too_far) {
    dice d = dice_of("starts", 2317);
    for (unsigned n = few_or_all(60, 600); n > 0; n--) {
        char text[TEXT] = "mechanism m\n";
        char kinetic[300] = "";
        char stored[300] = "";
        char starts[300] = "";
        double far_rad[MOST] = {0.0};
        const int count = 1 + (int)dice_one_of(&d, MOST);
        unsigned wanted = 0;
        for (int i = 0; i < count; i++) {
            const char *between = i > 0 ? " + " : "";
            far_rad[i] = dice_one_of(&d, 3) == 0 ? dice_between(&d, 6.29e9, 9e12) : 0.0;
            wanted += far_rad[i] > 0.0;
            snprintf(text + strlen(text), sizeof text - strlen(text), "coordinate q%d [rad]\n", i);
            snprintf(kinetic + strlen(kinetic), sizeof kinetic - strlen(kinetic), "%sq%d'^2",
                     between, i);
            snprintf(stored + strlen(stored), sizeof stored - strlen(stored), "%scos(q%d)", between,
                     i);
            snprintf(starts + strlen(starts), sizeof starts - strlen(starts),
                     "%s q%d = %.17g [rad]", i > 0 ? "," : "", i,
                     far_rad[i] > 0.0 ? far_rad[i] : dice_between(&d, -9.0, 9.0));
        }
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "T = 1 [kg*m^2]*(%s)/2\nV = 1 [J]*(%s)\n"
                 "scene s { start%s; step 1 [ms]; until 1 [s] }\n",
                 kinetic, stored, starts);
        derived made = derived_surely(derived_scene(text, "s"), text);
        TEST_ASSERT_EQUAL_INT(count, made.image->angles);
        diags *errors = diags_new();
        TEST_ASSERT_TRUE(start_is_possible(made.image, &engine_double, errors));
        TEST_ASSERT_EQUAL_INT_MESSAGE(wanted == 0,
                                      start_is_possible(made.image, &engine_float, errors), text);
        const char *told = told_of(errors);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted, times(told, "error: "), told);
        for (int i = 0; i < count; i++) {
            char what[120];
            snprintf(what, sizeof what,
                     "error: 'q%d' starts at %.9g rad, but float represents angles only up to", i,
                     far_rad[i]);
            TEST_ASSERT_EQUAL_INT_MESSAGE(far_rad[i] > 0.0, strstr(told, what) != NULL, told);
        }
        diags_free(errors);
        derived_free(&made);
    }
}

TEST(starts, momenta_are_no_kicks) {
    for (int first = 0; first < 3; first++) {
        char text[TEXT];
        char what[120];
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate q0 [m]\ncoordinate q1 [m]\ncoordinate q2 [m]\n"
            "coordinate x [m]\nT = 1 [kg]*(q0'^2 + q1'^2 + q2'^2 + x'^2)/2\nV = 3 [N/m]*x^2\nQ(x) = 1 [N]*sin((q0 + q1 + q2)/(1 [m]))\n"
            "scene s { conserve %sq2; step 1 [ms]; until 1 [s] }\n",
            first == 0   ? "q0, q1, "
            : first == 1 ? "q1, "
                         : "");
        derived made = derived_surely(derived_scene(text, "s"), text);
        diags *errors = diags_new();
        TEST_ASSERT_FALSE(start_has_method(made.image, WH_LEAPFROG, errors));
        const char *told = told_of(errors);
        snprintf(what, sizeof what,
                 "%s is not defined here: the rate of 'q%d' follows from its conserved momentum",
                 wh_methods[WH_LEAPFROG].title, first);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, what), told);
        diags_free(errors);
        derived_free(&made);
    }
}
