/* test_octave.c: files for Octave: where their values may be complex, and the form with names, read back line by line, whose
 * slopes are the accelerations of the operation lists. (Function files of lists: test_octave_drawn.c.) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formula.h"
#include "mechanism.h"
#include "printed.h"
#include "unity.h"

void suite_octave(void);

enum { STATES = 10, RESULTS_MAX = 128 };

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
        char *file = printed(&d, FOLDED);
        TEST_ASSERT_EQUAL_MESSAGE(calls[i].leaves, strstr(file, "~isreal(dy)") != NULL,
                                  calls[i].call);
        free(file);
        derived_free(&d);
    }
}

/* --- the form with names ------------------------------------------------------------------------------------------*/

/* A variable of the file; an element of A or b is one, too. */
typedef struct named_value {
    char name[80];
    double value;
} named_value;

enum { NAMED_MAX = 400, OWN_SEED = 45 };

typedef struct named_file {
    named_value row[NAMED_MAX];
    int count;
    const double *y;
} named_file;

static double named_lookup(void *context, const char *name, int length) {
    const named_file *f = context;
    if (*name == 'y' && name[1] == '(') {
        return f->y[(int)strtol(name + 2, NULL, 10) - 1];
    }
    for (int i = f->count - 1; i >= 0; i--) {
        if ((int)strlen(f->row[i].name) == length &&
            strncmp(f->row[i].name, name, (size_t)length) == 0) {
            return f->row[i].value;
        }
    }
    return (double)NAN;
}

static void name_value(named_file *f, const char *name, double value) {
    TEST_ASSERT_TRUE(f->count < NAMED_MAX && strlen(name) < sizeof f->row->name);
    strcpy(f->row[f->count].name, name);
    f->row[f->count++].value = value;
}

/* x = A \ b, by elimination with the largest pivot of a column; elements without a line are 0. */
static void solve_named(named_file *f, const char *x, const char *A, const char *b, int n) {
    double m[UNKNOWNS][UNKNOWNS + 1];
    char name[80];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= n; j++) {
            if (j < n) {
                snprintf(name, sizeof name, "%s(%d, %d)", A, i + 1, j + 1);
            } else {
                snprintf(name, sizeof name, "%s(%d)", b, i + 1);
            }
            m[i][j] = named_lookup(f, name, (int)strlen(name));
            m[i][j] = isnan(m[i][j]) ? 0.0 : m[i][j];
        }
    }
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = fabs(m[i][k]) > fabs(m[best][k]) ? i : best;
        }
        for (int j = 0; j <= n; j++) {
            const double swap = m[k][j];
            m[k][j] = m[best][j];
            m[best][j] = swap;
        }
        for (int i = 0; i < n; i++) {
            const double factor = i == k ? 0.0 : m[i][k] / m[k][k];
            for (int j = k; j <= n; j++) {
                m[i][j] -= factor * m[k][j];
            }
        }
    }
    for (int k = 0; k < n; k++) {
        snprintf(name, sizeof name, "%s(%d)", x, k + 1);
        name_value(f, name, m[k][n] / m[k][k]);
    }
}

/* Runs the file's lines; slope[]: its dy. */
static void run_named(const char *what, const char *text, named_file *f, int n, double *slope) {
    for (const char *line = strstr(text, "\n  ") + 1; strncmp(line, "  ", 2) == 0;
         line = strchr(line, '\n') + 1) {
        char target[80];
        char A[80];
        char b[80];
        const char *from = strstr(line, " = ");
        if (strncmp(line, "  if ", 5) == 0) {
            continue;
        }
        TEST_ASSERT_TRUE_MESSAGE(from != NULL && from - line < 80, what);
        snprintf(target, sizeof target, "%.*s", (int)(from - line - 2), line + 2);
        from += 3;
        const char *end;
        if (strcmp(target, "dy") == 0) {
            for (int i = 0; *from != ']'; i++, from = end) {
                from += strspn(from, "[; ");
                slope[i] = formula_value(from, &end, named_lookup, f);
                TEST_ASSERT_TRUE_MESSAGE(strchr(";]", *end) != NULL, what);
            }
        } else if (sscanf(from, "%79[A-Za-z_] \\ %79[A-Za-z_];", A, b) == 2) {
            solve_named(f, target, A, b, n);
        } else if (strncmp(from, "zeros(", 6) != 0) {
            const bool element = strchr(from, '(') != NULL && strchr(from, '*') == NULL;
            char whole[80];
            snprintf(whole, sizeof whole, "%.*s", (int)strcspn(from, ";"), from);
            const double known = element ? named_lookup(f, whole, (int)strlen(whole)) : (double)NAN;
            if (isnan(known)) {
                const double value = formula_value(from, &end, named_lookup, f);
                if (strncmp(end, ";", 1) != 0) {
                    printf("  %s: %.120s\n", what, line);
                }
                TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(";", end, 1, what);
                name_value(f, target, value);
            } else {
                name_value(f, target, known);
            }
        }
    }
}

/* "  I_r = 0.01125; % [kg*m^2] = M_r*R^2/2: ...": the text behind the unit, given with --set, is that value. Returns
 * how many there are. */
static int check_written(const derived *d, const char *text) {
    int checked = 0;
    const mechanism *m = d->instance->mechanism;
    for (const char *at = strstr(text, "\n  "); (at = strstr(at, "] = ")) != NULL; at++) {
        const char *line = at;
        while (line[-1] != '\n') {
            line--;
        }
        char name[80];
        char set[300];
        const char *equals = strstr(line, " = ");
        snprintf(name, sizeof name, "%.*s", (int)(equals - line - 2), line + 2);
        const double value = strtod(equals + 3, NULL);
        const size_t length = strcspn(at + 4, ":\n");
        snprintf(set, sizeof set, "%s=%.*s", name, (int)length, at + 4);
        const char *sets[] = {set};
        const overrides changes = {.sets = sets, .set_count = 1};
        diags *errors = diags_new();
        instance *again = instance_make(m, d->instance->scene, &changes, errors);
        diags_flush(errors, stdout);
        TEST_ASSERT_NOT_NULL_MESSAGE(again, set);
        bool found = false;
        for (int i = 0; i < m->parameter_count; i++) {
            found = found || (strcmp(m->parameters[i]->name, name) == 0 &&
                              fabs(again->parameter[i] - value) <= 1e-15 * fabs(value));
        }
        for (int i = 0; i < m->input_count; i++) {
            found = found || (strcmp(m->inputs[i]->name, name) == 0 &&
                              fabs(again->input[i] - value) <= 1e-15 * fabs(value));
        }
        TEST_ASSERT_TRUE_MESSAGE(found, set);
        checked++;
        instance_free(again);
        diags_free(errors);
    }
    return checked;
}

static int written; /* values with a text */

/* dy(y) of the file with names against the lists of the image at random states. Returns whether states were compared. */
static bool compare_named(const char *name, derived *d) {
    const equations *e = d->equations;
    if (d->image->recovered > 0) {
        return false; /* as above */
    }
    char *text = printed(d, OCTAVE);
    bool compared = false;
    uint64_t seed = OWN_SEED;
    written += check_written(d, text);
    for (int k = 0; k < 3; k++) {
        static named_file f;
        state_values s;
        double y[4 * UNKNOWNS];
        double slope[4 * UNKNOWNS] = {0};
        double result[RESULTS_MAX];
        int number = 0;
        TEST_ASSERT_TRUE_MESSAGE(d->image->list[IMAGE_BOOKS]->results <= RESULTS_MAX, name);
        random_state(&s, d, &seed);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        double largest = 0.0;
        for (int i = 0; i < e->count; i++) {
            largest = fmax(largest, isfinite(result[i]) ? fabs(result[i]) : (double)INFINITY);
        }
        if (!(largest < 1e12)) {
            continue; /* singular there */
        }
        for (int level = 0; level < 8; level++) {
            for (int i = 0; i < e->count; i++) {
                y[number] = s.value[i][level];
                number += e->unknowns[i].order > level;
            }
        }
        f.count = 0;
        f.y = y;
        run_named(name, text, &f, e->count, slope);
        compared = true;
        number = 0;
        for (int level = 0; level < 8; level++) {
            for (int i = 0; i < e->count; i++) {
                const bool highest = level + 1 == e->unknowns[i].order;
                if (e->unknowns[i].order > level) {
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(highest ? 1e-7 * largest : 0.0,
                                                      highest ? result[i] : s.value[i][level + 1],
                                                      slope[number++], name);
                }
            }
        }
    }
    free(text);
    return compared;
}

/* The first scene of each mechanism. */
static int named_scene(const scene *s) {
    static char last[80];
    if (strcmp(last, s->mechanism->name) == 0) {
        return 0;
    }
    snprintf(last, sizeof last, "%s", s->mechanism->name);
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    const bool compared = compare_named(s->name, &d);
    derived_free(&d);
    return compared;
}

static int named_files;
static void named_mechanism(const char *name, derived *d) { named_files += compare_named(name, d); }

static void test_files_with_names_compute_the_same(void) {
    enum { MECHANISMS = 30 };
    int compared = 0;
    written = 0;
    const int scenes = each_builtin_scene(named_scene);
    each_mechanism(named_mechanism);
    printf("  %d scenes, %d files, %d values with their text\n", scenes, named_files, written);
    TEST_ASSERT_TRUE(scenes > 20 && named_files > 25 && written > 50);
    for (int i = 0; i < MECHANISMS; i++) {
        char text[MECHANISM_SIZE];
        mechanism_write((unsigned)i, (uint64_t)(OWN_SEED + i), text);
        derived d = derived_text(text);
        compared += d.image != NULL && compare_named(text, &d);
        derived_free(&d);
    }
    printf("  seed %d on: %d of %d mechanisms compared\n", OWN_SEED, compared, MECHANISMS);
    TEST_ASSERT_TRUE(10 * compared > 7 * MECHANISMS);
}

void suite_octave(void) {
    RUN_TEST(test_files_with_names_compute_the_same);
    RUN_TEST(test_files_stay_real);
}
