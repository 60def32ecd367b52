/* test_swept.c: what `whirl sweep` measures of whole runs, of motions whose measures are known in closed form: of coordinates,
 * outputs and expressions, from the start or from later on, of runs of few steps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "unity.h"

void suite_swept(void);

/* What moves by itself at v from a: x = a + v t, at each of n + 1 ends of steps. */
static void write_free(char *text, size_t size, double a, unsigned steps) {
    snprintf(text, size,
             "mechanism free\ncoordinate x [m]\nparameter u = 1 [m]\nT = 1 [kg]*x'^2/2\n"
             "output twice [m] = 2*x\nscene s { start x = %.17g [m]\nstep 0.125 [s]\n"
             "until %.17g [s] }\n",
             a, 0.125 * steps);
}

static const char *const measures[] = {"x",           "mean(x)",      "max(x)",      "min(twice)",
                                       "mean(twice)", "amplitude(x)", "mean(x^2/u)", "max(-twice)"};
enum { MEASURES = sizeof measures / sizeof measures[0] };

static double wanted(int measure, double a, double v, double from_s, double end_s) {
    const double first = a + v * from_s;
    const double last = a + v * end_s;
    const double n = (end_s - from_s) / 0.125;
    switch (measure) {
    case 0: return last;
    case 1: return 0.5 * (first + last);
    case 2: return fmax(first, last);
    case 3: return 2.0 * fmin(first, last);
    case 4: return first + last;
    case 5: return 0.5 * fabs(last - first);
    /* the chords' mean of a parabola: a step's is v^2 h^2/6 above the curve's */
    case 6:
        return (first * first + first * last + last * last) / 3.0 +
               (n > 0.0 ? v * v * 0.125 * 0.125 / 6.0 : 0.0);
    default: return -2.0 * fmin(first, last);
    }
}

static void test_measures_of_whole_runs(void) {
    dice d = dice_of("swept", 41);
    for (unsigned k = 0; k < 12U; k++) {
        char text[400];
        char from[30];
        said what;
        const unsigned steps = 1U + (k < 4U ? k : dice_one_of(&d, 40));
        const unsigned left_out = k % 3U == 0 ? 0 : dice_one_of(&d, steps + 1U);
        const double a = dice_between(&d, -2.0, 2.0);
        const char *words[2 * MEASURES + 8] = {0};
        unsigned count = 0;
        write_free(text, sizeof text, a, steps);
        snprintf(from, sizeof from, "%.17g", 0.125 * left_out);
        words[count++] = model_keep(text);
        words[count++] = "--over";
        words[count++] = "x'=-3..3:3";
        words[count++] = "--from";
        words[count++] = from;
        words[count++] = "--quiet";
        for (int i = 0; i < MEASURES; i++) {
            words[count++] = "--measure";
            words[count++] = measures[i];
        }
        command_say(command_sweep, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const char *row = strchr(what.out, '\n');
        for (int point = 0; point < 3; point++) {
            TEST_ASSERT_NOT_NULL(row);
            const double v = 3.0 * (point - 1);
            char rest[400];
            snprintf(rest, sizeof rest, "%s", row + 1);
            char *at = rest;
            TEST_ASSERT_EQUAL_DOUBLE(v, strtod(rest, &at));
            for (int i = 0; i < MEASURES; i++) {
                const double got = strtod(at + 1, &at);
                const double is = wanted(i, a, v, 0.125 * left_out, 0.125 * steps);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-11 * (1.0 + fabs(is)), is, got, measures[i]);
            }
            row = strchr(row + 1, '\n');
        }
    }
    model_drop();
}

void suite_swept(void) { RUN_TEST(test_measures_of_whole_runs); }
