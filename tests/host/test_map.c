/* test_map.c: stability maps of drawn oscillators and dampers: left of the theory's limit runs stay bounded, right of it they do
 * not, the limit is that of the method's stability interval, and what is right to a tolerance is. By closed forms. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/commands/commands.h"
#include "host/map/stability_map.h"

#include "unity.h"

void suite_map(void);

enum { STEPS = 24, PLACES = 5 };

typedef struct drawn_map {
    derived d;
    diags *errors;
    grid grid;
    overrides changes;
    stability_map map;
} drawn_map;

static void open_map(drawn_map *m, const char *text, const char *step, const char *place,
                     wh_method method, double tolerance) {
    *m = (drawn_map){.d = derived_scene(text, "s"), .errors = diags_new()};
    derived_expect(&m->d, text);
    m->changes.balance = true;
    const mechanism *of = m->d.model->mechanisms[0];
    TEST_ASSERT_TRUE_MESSAGE(grid_add(&m->grid, of, step, m->errors), step);
    TEST_ASSERT_TRUE_MESSAGE(grid_add(&m->grid, of, place, m->errors), place);
    const map_wish wish = {.grid = &m->grid,
                           .mechanism = of,
                           .scene = m->d.model->scenes[0],
                           .changes = &m->changes,
                           .kind = &engine_double,
                           .settings = {.method = method},
                           .tolerance = tolerance};
    m->map = map_make(&wish);
}

static void close_map(drawn_map *m) {
    map_free(&m->map);
    grid_free(&m->grid);
    diags_free(m->errors);
    derived_free(&m->d);
}

/* Up to which h w, or h d, theory has a method stable: of an oscillation, and of a decay (Hairer & Wanner, Solving Ordinary
 * Differential Equations II, section IV.2); leapfrog's and semi-implicit Euler's 2. */
static const struct {
    wh_method method;
    double oscillation; /* 0: nowhere, or not known so well */
} rows[] = {{WH_RK4, 2.8284271247461903},
            {WH_LEAPFROG, 2.0},
            {WH_SEMI_IMPLICIT_EULER, 2.0},
            {WH_RK38, 2.8284271247461903}};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* Springs of all stiffnesses by steps of all lengths. */
static void test_oscillators(void) {
    dice d = dice_of("map", 1421);
    const unsigned cases = dice_cases(few_or_all(usual_or(8, 4), 24));
    unsigned bounded = 0;
    unsigned gone = 0;
    for (unsigned k = 0; k < cases; k++) {
        char text[600];
        char step[100];
        char place[100];
        const double mass_kg = pow(10.0, dice_between(&d, -1.0, 1.0));
        const double least = pow(10.0, dice_between(&d, 0.0, 2.0));
        const double shortest_s = 0.02 / sqrt(least * 100.0 / mass_kg);
        snprintf(text, sizeof text,
                 "mechanism spring\ncoordinate x [m]\nparameter k = 1 [N/m]\nT = %.17g [kg]*x'^2/2\n"
                 "V = k*x^2/2\nscene s { start x = 1 [m]; step 1 [s]; until %.17g [s] }\n",
                 mass_kg, 400.0 * 10.0 / sqrt(least / mass_kg));
        snprintf(step, sizeof step, "step=%.17g..%.17g:%d,log", shortest_s, shortest_s * 1e4, STEPS);
        snprintf(place, sizeof place, "k=%.17g..%.17g:%d,log", least, least * 100.0, PLACES);
        drawn_map m;
        open_map(&m, text, step, place, rows[k % ROWS].method, 1e-3);
        TEST_ASSERT_EQUAL_INT(0, m.map.step_axis);
        for (uint64_t p = 0; p < PLACES; p++) {
            double value[2];
            grid_values(&m.grid, map_point(&m.grid, 0, p), value);
            const double limit_s = rows[k % ROWS].oscillation / sqrt(value[1] / mass_kg);
            TEST_ASSERT_TRUE_MESSAGE(fabs(m.map.limit_s[p] / limit_s - 1.0) < 1e-3, text);
            for (uint64_t i = 0; i < STEPS; i++) {
                const map_cell *c = &m.map.cell[map_point(&m.grid, i, p)];
                grid_values(&m.grid, map_point(&m.grid, i, p), value);
                if (value[0] < 0.98 * limit_s) {
                    bounded++;
                    TEST_ASSERT_TRUE_MESSAGE(c->verdict != MAP_DIVERGES, text);
                } else if (value[0] > 1.05 * limit_s && c->verdict != MAP_NONE) {
                    gone++;
                    TEST_ASSERT_TRUE_MESSAGE(c->verdict == MAP_DIVERGES || c->verdict == MAP_LOSES,
                                             text);
                }
            }
        }
        close_map(&m);
    }
    printf("  %u runs within the limit, none beyond all bounds; %u behind it, all told\n", bounded,
           gone);
    TEST_ASSERT_TRUE(bounded > cases * 30 && gone > cases * 10);
}

/* --- words ------------------------------------------------------------------------------------------------*/

static void test_words_that_are_refused(void) {
    static const char *const wrong[][8] = {
        {"two_mass_relative", NULL},
        {"two_mass_relative", "--over", "step=1ms..10ms:3", NULL},
        {"two_mass_relative", "--over", "step=1ms..10ms:3", "--over", "nothing=1..2:3", NULL},
        {"two_mass_relative", "--over", "step=1ms..10ms:3", "--over", NULL},
        {"two_mass_relative", "--over=step=1ms..10ms:3", "--over=step=1ms..2ms:2",
         "--over=step=1ms..3ms:2", NULL},
        {"two_mass_relative", "--tolerance", "2", NULL},
        {"--over", "step=1ms..10ms:3", "--over", "m=1..2:3", NULL},
        {"no_such_scene", "--over", "step=1ms..10ms:3", "--over", "m=1..2:3", NULL}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        said what;
        command_say(command_map, wrong[i], &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(2, what.status, what.err);
        TEST_ASSERT_TRUE_MESSAGE(strstr(what.err, "error: ") != NULL ||
                                     strstr(what.err, "usage: ") != NULL,
                                 what.err);
    }
}

void suite_map(void) {
    RUN_TEST(test_oscillators);
    RUN_TEST(test_words_that_are_refused);
}
