/* test_waves.c: sines of angles that have sines inside: each is found, whichever angles are made from which. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "derived.h"
#include "unity.h"

void suite_waves(void);

enum { MECHANISMS = 300, STATES = 3 };

static unsigned draw(uint64_t *seed, unsigned bound) {
    return (unsigned)(random_bits(seed) % bound);
}

/* Sums, differences and multiples of a few angles, with and without a sine inside. */
static void angle(FILE *to, int depth, uint64_t *seed) {
    static const char *const simple[] = {"q", "x", "(q + n)", "(q - x)", "(2*q)", "(x + n)"};
    static const char *const before[] = {"(", "(", "sin(", "exp(sin("};
    static const char *const after[] = {")", ")", ")", "))"};
    const unsigned which = depth > 0 ? draw(seed, 6) : 4;
    if (which >= 4) {
        fputs(simple[draw(seed, sizeof simple / sizeof simple[0])], to);
        return;
    }
    fputs(before[which], to);
    angle(to, depth - 1, seed);
    if (which < 2) {
        fputs(which == 0 ? " + " : " - ", to);
        angle(to, depth - 1, seed);
    }
    fputs(after[which], to);
}

/* The accelerations of the operation list solve the equations. Returns how many states had some. */
static int check(const derived *d, uint64_t *seed) {
    const equations *e = d->equations;
    int checked = 0;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, d, seed);
        TEST_ASSERT_TRUE(d->image->list[IMAGE_BOOKS]->results <= UNKNOWNS);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        for (int i = 0; i < e->count; i++) {
            double size;
            const double rest = derived_rest(d, &s, result, i, &size);
            TEST_ASSERT_TRUE(fabs(rest) <= 1e-9 * size);
        }
        checked++;
    }
    return checked;
}

static void test_sines_inside_sines(void) {
    uint64_t seed = 7;
    int checked = 0;
    for (int i = 0; i < MECHANISMS; i++) {
        char *text = NULL;
        size_t size = 0;
        FILE *to = open_memstream(&text, &size);
        TEST_ASSERT_NOT_NULL(to);
        fputs("mechanism m\ncoordinate q\ncoordinate x\nparameter n = 2.5\n"
              "T = 1 [kg*m^2]*(2*q'^2 + cos(",
              to);
        angle(to, 1 + i % 3, &seed);
        fputs(")*q'*x' + (3 + cos(", to);
        angle(to, 1 + i % 3, &seed);
        fputs("))*x'^2)\nV = 1 [J]*cos(", to);
        angle(to, 1 + i % 3, &seed);
        fputs(")\n", to);
        fclose(to);
        derived d = derived_text(text);
        derived_expect(&d, text);
        checked += check(&d, &seed);
        derived_free(&d);
        free(text);
    }
    printf("  seed 7: %d states of %d mechanisms\n", checked, MECHANISMS);
    TEST_ASSERT_EQUAL_INT(MECHANISMS * STATES, checked);
}

void suite_waves(void) { RUN_TEST(test_sines_inside_sines); }
