/* test_thresholds.c: each finding on both sides of its limit (host/check/finding.h). A scene with one parameter is silent at one end
 * of it and told of at the other. Between them its place is halved until the value stands at the limit: just beyond it the
 * finding is told, by a value that is just beyond, and just within it is not. Where that is is known as well, mostly in closed
 * form, so that a limit moved by a twentieth fails here. Findings that count steps have suites of their own (pole, missed, busy). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/check/finding.h"
#include "host/cli/commands.h"
#include "json_check.h"
#include "unity.h"

void suite_thresholds(void);

enum { TEXT = 1200, HALVINGS = 24 };

/* "%1$.17g" is the parameter, in the decade `silent` to `told`, drawn a little further off at both ends. */
static const struct {
    finding_id id;
    const char *number;
    double silent;
    double told;
    double at; /* where it begins to be told, 0: somewhere between */
    double limit;
    const char *text;
} rows[] = {
    {FINDING_ENERGY, "double", 0.1, 10.0, 0.4335,
     1e-3, /* N (h w)^6/72 of the energy, root 2 of which is the largest entry */
     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %1$.17g [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]\nstep 0.5 [s]\nuntil 40 [s] }\n"},
    {FINDING_ACCURACY, "double", 0.1, 4.0, 2.728,
     0.5, /* w t (h w)^4/120 is 1 % of the range at half of the time */
     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %1$.17g [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]\nstep 0.25 [s]\nuntil 100 [s] }\n"},
    {FINDING_SINGULAR, "double", 0.15, 0.07, 0.0954,
     1e-2, /* less than a tenth away, by the step that is nearest */
     "mechanism m\ncoordinate r [m]\ncoordinate phi [rad]\n"
     "T = 1 [kg]*(r'^2 + r^2*phi'^2)/2\n"
     "scene s { start r = 1 [m], phi = 0, r' = -4 [m/s], phi' = 4*%1$.17g [rad/s]\n"
     "step 20 [ms]\nuntil 0.5 [s] }\n"},
    {FINDING_MASS, "double", 1e-10, 1e-13, 4e-12, 1e-4,
     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"
     "T = %1$.17g [kg]*x'^2/2 + 1 [kg]*(x' + y')^2/2\n"
     "V = 1 [N/m]*(x + y)^2/2 + %1$.17g [N/m]*x^2/2\n"
     "scene s { start y = 1 [m]\nstep 1 [ms]\nuntil 0.1 [s] }\n"},
    {FINDING_ALIASED, "double", 1e-5, 1.0, 1e-3, 1e-3,
     "mechanism m\ncoordinate x [m]\ncoordinate t [s]\nT = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
     "Q(x) = 1 [N] + %1$.17g [N]*cos(2*pi*400 [Hz]*t)\n"
     "scene s { start x' = 1 [m/s], t' = 1\nstep 10 [ms]\nuntil 2 [s] }\n"},
    {FINDING_APART, "double", 1e-8, 1e-4, 1.25e-6, 1e-6, /* 0.8 of which is along the rod */
     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
     "V = 9.81 [N]*y\nhold sqrt(x^2 + y^2) - 1 [m] while 1 > 0\n"
     "scene s { start x = 0.6 [m], y = 0.8 [m] + %1$.17g [m]\nstep 1 [ms]\nuntil 20 [ms] }\n"},
    {FINDING_DIGITS, "float", 1e-2, 1e-6, 0.0, 1e-3,
     "mechanism m\ncoordinate q [rad]\nT = 1 [kg*m^2]*q'^2/2\nV = 1e-9 [J]*cos(q)\n"
     "scene s { start q' = %1$.17g [rad/s]\nstep 1 [ms]\nuntil 2 [s] }\n"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* The value by which this finding is told; NAN: it is not. */
static double told_by(unsigned row, double parameter) {
    static said what;
    char text[TEXT];
    char value[100];
    snprintf(text, sizeof text, rows[row].text, parameter);
    const char *words[] = {model_keep(text), "--json", "--number", rows[row].number, NULL};
    command_say(command_run, words, &what);
    const int count = json_length(what.out, "findings");
    TEST_ASSERT_TRUE_MESSAGE(count >= 0, what.err);
    for (int i = 0; i < count; i++) {
        char path[60];
        snprintf(path, sizeof path, "findings/%d/id", i);
        if (strcmp(json_value(what.out, path, value), finding_rows[rows[row].id].word) == 0) {
            snprintf(path, sizeof path, "findings/%d/value", i);
            return strtod(json_value(what.out, path, value), NULL);
        }
    }
    return (double)NAN;
}

static void test_both_sides_of_each_limit(void) {
    dice d = dice_of("thresholds", 4703);
    for (unsigned i = 0; i < ROWS; i++) {
        const double limit = rows[i].limit;
        const char *word = finding_rows[rows[i].id].word;
        const double off = rows[i].told > rows[i].silent ? 1.0 : -1.0;
        double silent = rows[i].silent * pow(2.0, -off * dice_between(&d, 0.0, 1.0));
        double told = rows[i].told * pow(2.0, off * dice_between(&d, 0.0, 1.0));
        TEST_ASSERT_TRUE_MESSAGE(isnan(told_by(i, silent)), word);
        TEST_ASSERT_FALSE_MESSAGE(isnan(told_by(i, told)), word);
        for (int k = 0; k < HALVINGS; k++) {
            const double middle = sqrt(silent * told);
            *(isnan(told_by(i, middle)) ? &silent : &told) = middle;
        }
        const double value = told_by(i, told);
        TEST_ASSERT_TRUE_MESSAGE(finding_rows[rows[i].id].limit == limit, word);
        const bool below = rows[i].id == FINDING_ACCURACY || rows[i].id == FINDING_SINGULAR;
        printf("  %-9s limit %g %s, told from %.6g on\n", word, limit,
               finding_rows[rows[i].id].unit, value);
        TEST_ASSERT_TRUE_MESSAGE(below ? value <= limit : value >= limit, word);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.02 * limit, limit, value, word);
        TEST_ASSERT_TRUE_MESSAGE(rows[i].at == 0.0 || fabs(told / rows[i].at - 1.0) < 0.02, word);
    }
    model_drop();
}

void suite_thresholds(void) { RUN_TEST(test_both_sides_of_each_limit); }
