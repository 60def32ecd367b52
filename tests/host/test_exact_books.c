/* test_exact_books.c: steps of --matrix exact are believed however long they are: what the books integrate between them is too
 * coarse there, and the motion is not. */
#include <math.h>
#include <stdlib.h>

#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "host/check/energy_residual.h"
#include "motion.h"

#include "unity.h"

void suite_exact_books(void);

/* Two masses between springs, driven and damped. */
static char *made_up(uint64_t *seed) {
    double r[8];
    for (int i = 0; i < 8; i++) {
        r[i] = random_between(seed, 0.5, 2.0);
    }
    return alloc_words(
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput u = %.6f [N]\n"
        "T = %.6f [kg]*x'^2/2 + %.6f [kg]*y'^2/2\nV = %.6f [N/m]*x^2/2 + %.6f [N/m]*(x - y)^2/2\n"
        "F = %.6f [N*s/m]*(x' - y')^2/2\nQ(y) = u\n"
        "scene s { start x = %.6f [m], y' = %.6f [m/s]; until 10 [s] }\n",
        r[0], r[1], r[2], 90 * r[3], 60 * r[4], 0.3 * r[5], 0.02 * r[6], 0.3 * r[7]);
}

/* Largest distance of its places from the closed form, which is the run's own in double at a fine step that ends there too. */
static double try_one(const char *text, const engine_kind *kind, image_matrix_of matrix,
                      double step_s, bool *lost) {
    motion m;
    motion fine;
    bool diverged = false;
    motion_open_text(
        &m, text, (stepping){.kind = kind, .method = WH_RK4, .step_s = step_s, .matrix = matrix});
    motion_open_text(&fine, text,
                     (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = 1e-4});
    books *b = books_open(m.image);
    books_enter(b, kind, m.run);
    for (uint64_t k = 0; k < m.image->steps; k++) {
        diverged = diverged || motion_step(&m, 1) != WH_OK;
        if (!diverged) {
            books_enter(b, kind, m.run);
        }
    }
    motion_to(&fine, 10.0);
    const double off = fmax(fabs(motion_value(&m, "x") - motion_value(&fine, "x")),
                            fabs(motion_value(&m, "y") - motion_value(&fine, "y")));
    const energy_residual balance = energy_residual_of(b, kind, m.run);
    *lost = diverged || energy_residual_lost(&balance, ENERGY_RESIDUAL_LIMIT);
    books_close(b);
    motion_close(&m);
    motion_close(&fine);
    return off;
}

static void test_long_exact_steps_are_believed(void) {
    static const double step_s[] = {0.5, 0.2, 0.05, 0.01};
    uint64_t seed = 5;
    int coarse = 0;
    for (unsigned i = 0; i < usual_or(8, 4); i++) {
        char *text = made_up(&seed);
        for (size_t n = 0; n < sizeof step_s / sizeof step_s[0]; n++) {
            bool lost;
            for (int is_float = 0; is_float < 2; is_float++) {
                const double off = try_one(text, is_float ? &engine_float : &engine_double,
                                           MATRIX_EXACT, step_s[n], &lost);
                TEST_ASSERT_TRUE_MESSAGE(off < 1e-5, text);
                TEST_ASSERT_FALSE_MESSAGE(lost, text);
            }
            /* the same by stages at steps that are too long for them is not believed */
            const double off = try_one(text, &engine_double, MATRIX_NONE, step_s[n], &lost);
            coarse += lost;
            TEST_ASSERT_TRUE_MESSAGE(lost || off < 0.05, text);
        }
        free(text);
    }
    TEST_ASSERT_GREATER_THAN_INT((int)usual_or(8, 4), coarse);
}

void suite_exact_books(void) { RUN_TEST(test_long_exact_steps_are_believed); }
