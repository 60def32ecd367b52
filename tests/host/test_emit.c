/* test_emit.c: what is printed says what was derived: the text's equations and the Octave file are
 * read back and evaluated; the short equations look as a textbook has them; LaTeX is well formed. */
#define _POSIX_C_SOURCE 200809L

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "formula.h"
#include "host/emit/emit.h"
#include "unity.h"

void suite_emit(void);

enum { STATES = 10, UNKNOWNS = 16, VALUES_MAX = 4096 };

/* --- all mechanisms there are --------------------------------------------------------------------*/

typedef void checker(const char *name, derived *d);

static void each_mechanism(checker *check) {
    static const char *const own[] = {"spherical_particle",  "masses_relative", "masses_absolute",
                                      "epicyclic_rail_drag", "driven_hinge",    "thomson",
                                      "thomson_a_spin",      "rig_fixed",       "carriage_free"};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        derived d = derived_builtin(own[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(d.program, own[i]);
        check(own[i], &d);
        derived_free(&d);
    }
    DIR *folder = opendir("tests/mechanisms");
    TEST_ASSERT_NOT_NULL_MESSAGE(folder, "run from the project's root");
    int files = 0;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char path[512];
        snprintf(path, sizeof path, "tests/mechanisms/%s", entry->d_name);
        if (strstr(path, ".whirl") != NULL) {
            derived d = derived_file(path);
            TEST_ASSERT_NOT_NULL_MESSAGE(d.program, path);
            check(path, &d);
            derived_free(&d);
            files++;
        }
    }
    closedir(folder);
    TEST_ASSERT_GREATER_THAN_INT(25, files);
}

typedef enum language { TEXT, LATEX, OCTAVE } language;

/* What one writer prints; free() it. */
static char *printed(const derived *d, language as) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    switch (as) {
    case TEXT: emit_text(out, d->equations); break;
    case LATEX: emit_latex(out, d->equations); break;
    case OCTAVE: emit_octave(out, d->equations, d->program, "x.whirl"); break;
    }
    fclose(out);
    char *copy = malloc(size + 1); /* gcc takes the stream's own for an address of this frame */
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, text, size + 1);
    free(text);
    return copy;
}

/* --- reading back --------------------------------------------------------------------------------*/

static double value_of_name(void *context, const char *name, int length) {
    const state_values *s = context;
    const mechanism *m = s->instance->mechanism;
    int primes = 0;
    while (length > 0 && name[length - 1] == '\'') {
        primes++;
        length--;
    }
    const size_t size = (size_t)length;
    for (int i = 0; i < m->coordinate_count; i++) {
        const char *known = m->coordinates[i]->name;
        if (strlen(known) == size && strncmp(known, name, size) == 0 && primes < ORDERS_MAX) {
            return s->value[i][primes];
        }
    }
    for (int i = 0; i < m->parameter_count && primes == 0; i++) {
        const char *known = m->parameters[i]->name;
        if (strlen(known) == size && strncmp(known, name, size) == 0) {
            return s->instance->parameter[i];
        }
    }
    for (int i = 0; i < m->input_count && primes == 0; i++) {
        const char *known = m->inputs[i]->name;
        if (strlen(known) == size && strncmp(known, name, size) == 0) {
            return s->instance->input[i];
        }
    }
    return (double)NAN;
}

static void random_state(state_values *s, const derived *d, uint64_t *seed) {
    s->instance = d->instance;
    for (int i = 0; i < d->equations->count; i++) {
        for (int primes = 0; primes < ORDERS_MAX; primes++) {
            s->value[i][primes] =
                random_between(seed, primes == 0 ? 0.2 : -2.0, primes == 0 ? 1.1 : 2.0);
        }
    }
}

/* `formula = formula` (with what stands in front of it): both sides' values. */
static void both_sides(const char *name, const char *text, state_values *s, double *left,
                       double *right) {
    const char *end;
    *left = formula_value(text, &end, value_of_name, s);
    if (strncmp(end, "= ", 2) != 0) {
        printf("  %s: cannot be read from here: %.60s\n", name, end);
    }
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("= ", end, 2, name);
    *right = formula_value(end + 2, &end, value_of_name, s);
    if (*end != '\n') {
        printf("  %s: cannot be read from here: %.60s\n", name, end);
    }
    TEST_ASSERT_TRUE_MESSAGE(*end == '\n', name);
}

/* Each printed equation against its polys, at random states. */
static void check_text(const char *name, derived *d) {
    const equations *e = d->equations;
    char *text = printed(d, TEXT);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "pow"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "+ -"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "- -"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, " 1*"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "(1*"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "nan"), name);
    const char *line = strstr(text, "\nequations");
    TEST_ASSERT_NOT_NULL_MESSAGE(line, name);
    line = strstr(line, "\n\n") + 2;
    uint64_t seed = 99;
    for (int i = 0; i < e->count; i++) {
        const char *formula = line;
        if (!d->instance->mechanism->is_system) {
            char label[80];
            snprintf(label, sizeof label, "  %s:  ", e->unknowns[i].symbol->name);
            TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(label, line, strlen(label), name);
            formula += strlen(label);
        }
        for (int k = 0; k < STATES; k++) {
            state_values s;
            random_state(&s, d, &seed);
            double size = 1e-30;
            double rest = 0.0;
            for (int j = 0; j < e->count; j++) {
                const double part = poly_evaluate(e->mass[i * e->count + j], state_value, &s) *
                                    s.value[j][e->unknowns[j].order];
                rest += part;
                size += fabs(part);
            }
            const double force = poly_evaluate(equations_force(e, i), state_value, &s);
            double left;
            double right;
            both_sides(name, formula, &s, &left, &right);
            size += fabs(force) + fabs(left) + fabs(right);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-11 * size, rest - force, left - right, name);
        }
        line = strchr(line, '\n') + 1;
    }
    TEST_ASSERT_TRUE_MESSAGE(*line == '\n', name); /* one line a coordinate, then a gap */
    free(text);
}

static void test_printed_equations_say_what_was_derived(void) { each_mechanism(check_text); }

/* The value of what stands behind `label` at a line's beginning; NaN if it is not there. */
static double labelled(const char *text, const char *label, state_values *s) {
    const char *at = strstr(text, label);
    const char *end;
    return at == NULL ? (double)NAN : formula_value(at + strlen(label), &end, value_of_name, s);
}

/* The first-order form: closed formulas put into the equations, or the printed A and b. */
static void check_first_order(const char *name, derived *d) {
    const equations *e = d->equations;
    char *text = printed(d, TEXT);
    uint64_t seed = 31;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, d, &seed);
        double highest[UNKNOWNS];
        const bool closed = strstr(text, "A x = b") == NULL;
        for (int i = 0; i < e->count && closed; i++) {
            char label[100];
            int at = snprintf(label, sizeof label, "' = %s", e->unknowns[i].symbol->name);
            for (int p = 0; p < e->unknowns[i].order; p++) {
                label[at++] = '\'';
            }
            snprintf(label + at, sizeof label - (size_t)at, " = ");
            highest[i] = labelled(text, label, &s);
            TEST_ASSERT_TRUE_MESSAGE(isfinite(highest[i]), label);
        }
        for (int i = 0; i < e->count; i++) {
            char label[64];
            const double force = poly_evaluate(equations_force(e, i), state_value, &s);
            double sum = 0.0;
            double size = fabs(force) + 1e-30;
            for (int j = 0; j < e->count; j++) {
                const double entry = poly_evaluate(e->mass[i * e->count + j], state_value, &s);
                if (closed) {
                    sum += entry * highest[j];
                    size += fabs(entry * highest[j]);
                    continue;
                }
                const int low = i < j || d->instance->mechanism->is_system ? i : j;
                const int high = low == i ? j : i;
                const char *comma = e->count > 9 ? "," : "";
                const bool twice = low != high && !d->instance->mechanism->is_system;
                int used = snprintf(label, sizeof label, "  A%d%s%d = ", low + 1, comma, high + 1);
                if (twice) {
                    snprintf(label + used, sizeof label - (size_t)used, "A%d%s%d = ", high + 1,
                             comma, low + 1);
                }
                const double shown = labelled(text, label, &s);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12 * (1.0 + fabs(entry)), entry, shown, name);
            }
            if (closed) {
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-9 * size, force, sum, name);
            } else {
                snprintf(label, sizeof label, "  b%d = ", i + 1);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-11 * (1.0 + size), force,
                                                  labelled(text, label, &s), name);
            }
        }
    }
    free(text);
}

static void test_first_order_form_solves_the_equations(void) { each_mechanism(check_first_order); }

/* --- how it looks --------------------------------------------------------------------------------*/

static void expect_lines(const char *name, const char *const *lines) {
    derived d = derived_builtin(name);
    char *text = printed(&d, TEXT);
    for (int i = 0; lines[i] != NULL; i++) {
        if (strstr(text, lines[i]) == NULL) {
            printf("%s\n", text);
        }
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, lines[i]), lines[i]);
    }
    free(text);
    derived_free(&d);
}

static void test_short_equations_look_as_in_the_dissertation(void) {
    expect_lines("spherical_particle",
                 (const char *const[]){
                     "  r:  m*r'' - m*r*sin(theta)^2*phi'^2 - m*r*theta'^2 + m*g*cos(theta) = 0\n",
                     "  theta:  m*r^2*theta'' - m*r^2*sin(2*theta)*phi'^2/2 + 2*m*r*r'*theta' - "
                     "m*g*r*sin(theta) = 0\n",
                     "  phi:  m*r^2*sin(theta)^2*phi'' + 2*m*r*sin(theta)^2*r'*phi' + "
                     "m*r^2*sin(2*theta)*theta'*phi' = 0\n",
                     NULL});
    expect_lines("masses_relative",
                 (const char *const[]){"  X:  (m1 + m2)*X'' + m2*Y'' + K1*X = -A*X' - A*Y'\n",
                                       "  Y:  m2*X'' + m2*Y'' + K2*Y = -A*X' - (A + B)*Y'\n",
                                       NULL});
    expect_lines("epicyclic", (const char *const[]){
                                  "  theta:  4*(I + m*r^2)*theta'' - 2*m*r*sin(theta)*X'' = M\n",
                                  "  X:  -2*m*r*sin(theta)*theta'' + 2*m*X'' - "
                                  "2*m*r*cos(theta)*theta'^2 = 0\n",
                                  NULL});
    expect_lines("driven_hinge",
                 (const char *const[]){
                     "  theta1:  m*r^2*theta1'' + m*r^2*cos(theta1 - theta2)*theta2'' + "
                     "m*r^2*sin(theta1 - theta2)*theta2'^2 = M\n",
                     "  theta2:  m*r^2*cos(theta1 - theta2)*theta1'' + (I + m*r^2)*theta2'' - "
                     "m*r^2*sin(theta1 - theta2)*theta1'^2 = 0\n",
                     NULL});
}

/* Braces, \left( \right) and environments close what they open, in turn. */
static void check_latex(const char *name, derived *d) {
    char *text = printed(d, LATEX);
    char open[256];
    int depth = 0;
    int lines = 0;
    for (const char *at = text; *at != '\0'; at++) {
        const bool left = strncmp(at, "\\left(", 6) == 0;
        const bool right = strncmp(at, "\\right)", 7) == 0;
        if (*at == '{' || left) {
            TEST_ASSERT_TRUE_MESSAGE(depth < 255, name);
            open[depth++] = left ? '(' : '{';
        } else if (*at == '}' || right) {
            TEST_ASSERT_TRUE_MESSAGE(depth > 0 && open[depth - 1] == (right ? '(' : '{'), name);
            depth--;
        }
        lines += strncmp(at, " &= ", 4) == 0;
        at += left ? 5 : right ? 6 : 0;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, depth, name);
    TEST_ASSERT_TRUE_MESSAGE(lines == d->equations->count || lines == 2 * d->equations->count,
                             name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "*"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "+ -"), name);
    TEST_ASSERT_NULL_MESSAGE(strstr(text, "\\mathrm{_"), name);
    free(text);
}

static void test_latex_is_balanced(void) {
    each_mechanism(check_latex);
    derived d =
        derived_text("mechanism m\ncoordinate phi_1_a [m]\ncoordinate _odd [m]\n"
                     "parameter mass_of_it = 2 [kg]\n"
                     "T = mass_of_it*(phi_1_a'^2 + _odd'^2)/2\nV = 1.5e-7 [N/m]*phi_1_a^2/2\n");
    TEST_ASSERT_NOT_NULL(d.program);
    {
        check_latex("names", &d);
        char *text = printed(&d, LATEX);
        TEST_ASSERT_NOT_NULL(strstr(text, "\\mathrm{mass}_{of\\_it} \\, \\ddot{\\phi}_{1\\_a}"));
        TEST_ASSERT_NOT_NULL(strstr(text, "\\mathrm{mass}_{of\\_it} \\, \\ddot{\\mathrm{\\_odd}}"));
        TEST_ASSERT_NOT_NULL(strstr(text, "1.5 \\cdot 10^{-7}"));
        free(text);
    }
    derived_free(&d);
}

/* --- Octave --------------------------------------------------------------------------------------*/

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
    const program *p = d->program;
    const equations *e = d->equations;
    if (p->conserved->count > 0) {
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
        double angle_rad[UNKNOWNS] = {0};
        double real[4 * UNKNOWNS] = {0};
        double result[4 * UNKNOWNS];
        for (int i = 0; i < p->angles; i++) {
            angle_rad[i] = s.value[p->angle[i].unknown][p->angle[i].primes];
        }
        for (int i = 0; i < p->reals; i++) {
            real[i] = s.value[p->real[i].unknown][p->real[i].primes];
        }
        evaluator *ev = evaluator_new(p->books);
        double *books = calloc((size_t)p->books->results + 1, sizeof *books);
        TEST_ASSERT_NOT_NULL(books);
        evaluator_run(ev, 0.0, angle_rad, real, real + (p->coordinates - p->angles),
                      d->instance->input, books);
        evaluator_free(ev);
        for (int i = 0; i < e->count; i++) {
            result[i] = books[i]; /* highest derivatives */
        }
        free(books);
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

void suite_emit(void) {
    UnitySetTestFile(__FILE__);
    RUN_TEST(test_printed_equations_say_what_was_derived);
    RUN_TEST(test_first_order_form_solves_the_equations);
    RUN_TEST(test_short_equations_look_as_in_the_dissertation);
    RUN_TEST(test_latex_is_balanced);
    RUN_TEST(test_octave_files_compute_the_same);
}
