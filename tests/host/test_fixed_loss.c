/* test_fixed_loss.c: what rounding takes of runs in fixed point is told, and what it does not take is not: generated
 * motions with closed forms, in ranges and steps of many sizes; and the books believe what is right. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/base/alloc.h"
#include "host/check/energy_residual.h"
#include "host/check/slow.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"

#include "unity.h"

void suite_fixed_loss(void);

typedef struct outcome {
    double angle[4];
    double real[4];
    int told;
    bool held;
    energy_residual belief;
} outcome;

static outcome run_of(derived *d, const char *text) {
    outcome end = {.told = 0};
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(d->image, false, errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(p, text);
    d->image->fixed = p;
    void *run = engine_fixed.start(d->image);
    books *b = books_open(d->image);
    for (uint64_t k = 0; k <= d->image->steps; k++) {
        if (b != NULL) {
            books_enter(b, &engine_fixed, run);
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, k < d->image->steps ? engine_fixed.step(run) : WH_OK);
    }
    end.told = slow_count(&engine_fixed, d->image, run);
    end.held = engine_fixed.saturated(run) > 0;
    end.belief = energy_residual_of(b, &engine_fixed, run);
    TEST_ASSERT_EQUAL_INT(end.held, end.belief.saturated);
    engine_fixed.state(run, end.angle, end.real);
    books_close(b);
    engine_fixed.stop(run);
    d->image->fixed = NULL;
    fixed_plan_free(p);
    diags_free(errors);
    return end;
}

/* Pushed evenly, turning evenly, and filling evenly, for 2 s. */
static void try_even_motion(int kind, double value, double times, int step_us, int *told,
                            int *quiet) {
    static const char *const texts[] = {
        ("coordinate x [m]\ninput u = %.9g [N]\nT = 1 [kg]*x'^2/2\nQ(x) = u\n"
         "scene s { until 2 [s]; step %d [us]\n"
         "range x = -%.9g .. %.9g [m], x' = -%.9g .. %.9g [m/s], u = -%.9g .. %.9g [N] }\n"),
        ("coordinate b [rad]\ninput M = 0 [N*m]\nT = 1 [kg*m^2]*b'^2/2\nQ(b) = M\n"
         "scene s { start b' = %.9g [rad/s]; until 2 [s]; step %d [us]\n"
         "range b' = -%.9g .. %.9g [rad/s], M = -%.9g .. %.9g [N*m] }\n"),
        ("state c [m]\ninput v = %.9g [m/s]\nequation c' = v\nscene s { until 2 [s]; step %d [us]\n"
         "range c = -%.9g .. %.9g [m], v = -%.9g .. %.9g [m/s] }\n")};
    const double size = 3.0 * value * times;
    char *with = alloc_words(texts[kind], value, step_us, size, size, size, size, size, size);
    char *text = alloc_words("mechanism m\n%s", with);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    const outcome end = run_of(&d, text);
    const double span = 2.0 * value;
    const double where = kind == 1 ? end.angle[0] : end.real[0];
    /* a start and an input are rounded, too, once */
    double worst = fabs(where - span) / span;
    worst = kind == 0 ? fmax(worst, fabs(end.real[1] - span) / span) : worst;
    TEST_ASSERT_FALSE_MESSAGE(end.held, text);
    if (worst > 4e-3) {
        TEST_ASSERT_GREATER_THAN_INT_MESSAGE(0, end.told, text);
        ++*told;
    } else if (worst < 2e-4) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, end.told, text);
        ++*quiet;
    }
    derived_free(&d);
    free(text);
    free(with);
}

static void test_lost_steps_are_told(void) {
    static const int step_us[] = {20, 100, 1000, 10000};
    uint64_t seed = 77;
    int told = 0;
    int quiet = 0;
    for (int kind = 0; kind < 3; kind++) {
        for (int power = 0; power <= 6; power++) {
            for (int n = 0; n < 4; n++) {
                /* a rotor's angle has units of its own: slow ones */
                const double value = kind == 1 ? pow(10.0, -power) : 1.0;
                try_even_motion(kind, value * random_between(&seed, 0.5, 2.0),
                                kind == 1 ? 1.0 : pow(10.0, power), step_us[n], &told, &quiet);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(15, told);
    TEST_ASSERT_GREATER_THAN_INT(25, quiet);
}

/* Oscillators of all masses and springs, some so slow that they hardly begin: believed wherever they are right. */
static void test_books_believe_what_is_right(void) {
    int right = 0;
    for (int mass = -6; mass <= 6; mass += 2) {
        for (int spring = -6; spring <= 6; spring += 2) {
            const double w = pow(10.0, 0.5 * (spring - mass));
            if (w > 100.0) { /* too coarse a step */
                continue;
            }
            char *text = alloc_words(
                "mechanism m\ncoordinate x [m]\nT = 1e%d [kg]*x'^2/2\nV = 1e%d [N/m]*x^2/2\n"
                "scene s { start x = 1 [m]; step 1 [ms]; until 5 [s] }\n",
                mass, spring);
            derived d = derived_scene(text, "s");
            derived_expect(&d, text);
            const outcome end = run_of(&d, text);
            if (fabs(end.real[0] - cos(5.0 * w)) < 1e-5) {
                TEST_ASSERT_FALSE_MESSAGE(energy_residual_lost(&end.belief, ENERGY_RESIDUAL_LIMIT),
                                          text);
                right++;
            }
            derived_free(&d);
            free(text);
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(30, right);
}

void suite_fixed_loss(void) {
    RUN_TEST(test_lost_steps_are_told);
    RUN_TEST(test_books_believe_what_is_right);
}
