/* test_octave.c: the Octave file, read back line by line, computes what the operation lists do. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expressions.h"
#include "formula.h"
#include "printed.h"
#include "unity.h"

void suite_octave(void);

enum { STATES = 10, VALUES_MAX = 4096, RESULTS_MAX = 128 };

typedef struct workspace {
    double x[VALUES_MAX];
    double y[4 * UNKNOWNS];
    double dy[4 * UNKNOWNS];
    const instance *instance;
} workspace;

static double octave_value(void *context, const char *name, int length) {
    const workspace *w = context;
    const mechanism *m = w->instance->mechanism;
    for (int i = 0; i < m->input_count; i++) { /* u_M: no clash with what else has a name */
        if (strncmp(name, "u_", 2) == 0 && (int)strlen(m->inputs[i]->name) == length - 2 &&
            strncmp(m->inputs[i]->name, name + 2, (size_t)(length - 2)) == 0) {
            return w->instance->input[i];
        }
    }
    if (*name == 'y' && name[1] == '(') {
        return w->y[(int)strtol(name + 2, NULL, 10) - 1];
    }
    return *name == 'x' ? w->x[(int)strtol(name + 1, NULL, 10)] : (double)NAN;
}

/* Run the assignments of the function file. */
static void run_octave(const char *name, const char *text, workspace *w) {
    for (const char *line = text; line != NULL && *line != '\0';
         line = strchr(line, '\n') == NULL ? NULL : strchr(line, '\n') + 1) {
        double *target = NULL;
        if (strncmp(line, "  x", 3) == 0) {
            const int number = (int)strtol(line + 3, NULL, 10);
            TEST_ASSERT_TRUE_MESSAGE(number >= 0 && number < VALUES_MAX, name);
            target = &w->x[number];
        } else if (strncmp(line, "  dy(", 5) == 0) {
            target = &w->dy[(int)strtol(line + 5, NULL, 10) - 1];
        }
        if (target != NULL) {
            const char *end;
            *target = formula_value(strchr(line, '=') + 1, &end, octave_value, w);
            if (strncmp(end, ";\n", 2) != 0) {
                printf("  %s: %.80s\n", name, line);
            }
            TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(";\n", end, 2, name);
        }
    }
}

/* dy(y) against the step list at random states; y = values, then rates, and so on. */
static void check_octave(const char *name, derived *d) {
    const image *p = d->image;
    const equations *e = d->equations;
    if (p->recovered > 0) {
        return; /* recovered coordinates have no slopes */
    }
    char *text = printed(d, OCTAVE);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("function dy = ", text, 14, name);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("end\n", text + strlen(text) - 4, name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "OP_"), name);
    uint64_t seed = 3;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        workspace w = {.instance = d->instance};
        int number = 0;
        int rows = 0;
        for (int level = 0; level < 8; level++) {
            for (int i = 0; i < e->count; i++) {
                if (e->unknowns[i].order > level) {
                    w.y[number++] = s.value[i][level];
                }
            }
        }
        run_octave(name, text, &w);
        double result[RESULTS_MAX]; /* the highest derivatives come first */
        TEST_ASSERT_TRUE_MESSAGE(p->list[IMAGE_BOOKS]->results <= RESULTS_MAX, name);
        derived_run(p->list[IMAGE_BOOKS], d, &s, result);
        double largest = 0.0;
        for (int i = 0; i < e->count; i++) {
            largest = fmax(largest, fabs(result[i]));
        }
        for (int level = 0; level < 8; level++) {
            for (int i = 0; i < e->count; i++) {
                if (e->unknowns[i].order > level) {
                    const bool highest = level + 1 == e->unknowns[i].order;
                    const double want = highest ? result[i] : s.value[i][level + 1];
                    /* The books may divide in another order: a few units in the last place */
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12 * (highest ? largest : fabs(want)),
                                                      want, w.dy[rows], name);
                    rows++;
                }
            }
        }
    }
    free(text);
}

static void test_octave_files_compute_the_same(void) { each_mechanism(check_octave); }

/* Are all values of the step list numbers, whatever they come from? */
static bool is_smooth(const derived *d) {
    bool good = true;
    uint64_t seed = 3; /* as above */
    for (int k = 0; k < STATES && good; k++) {
        state_values s;
        double result[RESULTS_MAX];
        random_state(&s, d, &seed);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        for (int i = 0; i < d->image->list[IMAGE_BOOKS]->results; i++) {
            good = good && fabs(result[i]) < 1e12;
        }
    }
    return good;
}

/* Powers with exponents of all kinds among them. Where they may leave the real numbers, the file says that it
 * gives NaN there, as the interpreter does, and not a complex number. */
static void test_octave_files_of_random_mechanisms(void) {
    enum { MECHANISMS = 40 };
    uint64_t seed = 22;
    int compared = 0;
    int powers = 0;
    for (int i = 0; i < MECHANISMS; i++) {
        char text[1 << 14];
        expression_mechanism(1 + i % 3, &seed, text, sizeof text);
        derived d = derived_text(text);
        if (d.image != NULL && is_smooth(&d)) {
            char *file = printed(&d, OCTAVE);
            check_octave(text, &d);
            compared++;
            if (strstr(file, " ^ ") != NULL) {
                powers++;
                TEST_ASSERT_NOT_NULL(strstr(file, "  if ~isreal(dy), dy(:) = NaN; end"));
            }
            free(file);
        }
        derived_free(&d);
    }
    printf("  seed 22: %d of %d mechanisms compared, %d with powers\n", compared, MECHANISMS,
           powers);
    TEST_ASSERT_TRUE(2 * compared > MECHANISMS && powers > 5);
}

/* Where a value may be none for real arguments, by analysis: Octave would go on with a complex one. */
static void test_files_stay_real(void) {
    static const struct {
        const char *call;
        bool leaves;
    } calls[] = {{"sqrt(q/u)", true},      {"log(q/u)", true},     {"asin(q/u)", true},
                 {"acos(q/u)", true},      {"(q/u)^0.3", true},    {"sin(q/u)", false},
                 {"cos(q/u)", false},      {"tan(q/u)", false},    {"atan(q/u)", false},
                 {"atan2(q/u, 2)", false}, {"exp(q/u)", false},    {"sinh(q/u)", false},
                 {"cosh(q/u)", false},     {"tanh(q/u)", false},   {"abs(q/u)", false},
                 {"sign(q/u)", false},     {"min(q/u, 2)", false}, {"(q/u)^3", false}};
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
        char text[300];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate q [m]\nparameter u = 1 [m]\nT = 1 [kg]*q'^2/2\n"
                 "Q(q) = 1 [N]*%s\n",
                 calls[i].call);
        derived d = derived_text(text);
        derived_expect(&d, text);
        char *file = printed(&d, OCTAVE);
        TEST_ASSERT_EQUAL_MESSAGE(calls[i].leaves, strstr(file, "~isreal(dy)") != NULL,
                                  calls[i].call);
        free(file);
        derived_free(&d);
    }
}

void suite_octave(void) {
    RUN_TEST(test_files_stay_real);
    RUN_TEST(test_octave_files_compute_the_same);
    RUN_TEST(test_octave_files_of_random_mechanisms);
}
