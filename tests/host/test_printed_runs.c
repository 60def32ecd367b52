/* test_printed_runs.c: what is printed and what runs are made of one thing by two ways: text from the equations, the
 * image's lists by elimination and lowering. Held against each other at random states: the accelerations that the
 * lists give solve the printed equations, are the printed closed forms, and solve the printed A x = b. Every built-in
 * scene, tests/mechanisms, and generated mechanisms; PRINTED_MECHANISMS=N in the environment takes N of these. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formula.h"
#include "mechanism.h"
#include "printed.h"
#include "unity.h"

void suite_printed_runs(void);

enum { STATES = 3, SEED = 77, RESULTS_MAX = 256 };

/* What the printed numbers' digits and the rounding of both ways may leave, as part of what is added up. */
#define ROUNDING 1e-9

typedef struct comparison {
    const char *name;
    const derived *of;
    state_values s;
    int compared; /* formulas */
} comparison;

static double symbol_here(void *context, const char *name, int length) {
    const comparison *c = context;
    const mechanism *m = c->of->instance->mechanism;
    int primes = 0;
    while (length > 0 && name[length - 1] == '\'') {
        length--;
        primes++;
    }
    const struct {
        const symbol **list;
        int count;
    } all[] = {{m->coordinates, m->coordinate_count},
               {m->parameters, m->parameter_count},
               {m->inputs, m->input_count}};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < all[k].count; i++) {
            const symbol *s = all[k].list[i];
            if ((int)strlen(s->name) == length && strncmp(s->name, name, (size_t)length) == 0) {
                return state_value((void *)(uintptr_t)&c->s, s, primes);
            }
        }
    }
    for (int i = 0; i < m->let_count && primes == 0;
         i++) { /* check_lets() reads their definitions */
        const char *let = m->lets[i]->name;
        if ((int)strlen(let) == length && strncmp(let, name, (size_t)length) == 0) {
            return poly_evaluate(poly_from_expr(c->of->equations->algebra, m->lets[i]->value),
                                 state_value, (void *)(uintptr_t)&c->s);
        }
    }
    return (double)NAN;
}

/* The formula that begins here; *end is behind it. */
static double value_of(comparison *c, const char *text, const char **end) {
    const double value = formula_value(text, end, symbol_here, c);
    c->compared++;
    return value;
}

/* Sizes of what equation i adds up. */
static double size_of(const comparison *c, int i) {
    const equations *e = c->of->equations;
    void *s = (void *)(uintptr_t)&c->s;
    double size = poly_magnitude(e->velocity[i], state_value, s) +
                  poly_magnitude(e->potential[i], state_value, s) +
                  poly_magnitude(e->applied[i], state_value, s);
    for (int j = 0; j < e->count; j++) {
        size += poly_magnitude(e->mass[i * e->count + j], state_value, s) *
                fabs(c->s.value[j][e->unknowns[j].order]);
    }
    return size;
}

static void expect_zero(const comparison *c, double rest, double size, const char *what) {
    if (!(fabs(rest) <= ROUNDING * size)) {
        printf("  %s: %s: off by %.3g of %.3g\n", c->name, what, rest, size);
    }
    TEST_ASSERT_TRUE_MESSAGE(fabs(rest) <= ROUNDING * size, c->name);
}

/* The equations: "  theta:  LEFT = RIGHT", or "  LEFT = RIGHT" of a system. Returns what is behind them. */
static const char *check_equations(comparison *c, const char *text) {
    const equations *e = c->of->equations;
    const char *line = strstr(strstr(text, "\nequations"), "\n\n") + 2;
    for (int i = 0; i < e->count; i++) {
        const char *end;
        const char *label = strstr(line, ":  ");
        const bool labelled = label != NULL && label < strchr(line, '\n');
        const double left = value_of(c, labelled ? label + 3 : line, &end);
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("= ", end, 2, c->name);
        const double right = value_of(c, end + 2, &end);
        TEST_ASSERT_EQUAL_INT_MESSAGE('\n', *end, c->name);
        expect_zero(c, left - right, size_of(c, i), "an equation of motion");
        line = end + 1;
    }
    return line;
}

/* "  speed = FORMULA" behind "with": the lets that formulas name. Returns how many. */
static int check_lets(comparison *c, const char *text) {
    const char *line = strstr(text, "\nwith\n\n");
    int count = 0;
    for (line = line == NULL ? "" : line + 7; *line != '\0'; count++) {
        const char *end;
        const char *from = strstr(line, " = ");
        const double value = value_of(c, from + 3, &end);
        TEST_ASSERT_EQUAL_INT_MESSAGE('\n', *end, c->name);
        const double wanted = symbol_here(c, line + 2, (int)(from - line - 2));
        expect_zero(c, value - wanted, 1.0 + fabs(wanted), "a let");
        line = end + 1;
    }
    return count;
}

/* "  y3' = theta'' = FORMULA": the accelerations in closed form, where they are printed. */
static void check_closed_forms(comparison *c, const char *text) {
    const equations *e = c->of->equations;
    for (int i = 0; i < e->count; i++) {
        char wanted[200];
        const unknown *u = &e->unknowns[i];
        const double should = c->s.value[i][u->order];
        snprintf(wanted, sizeof wanted, " = %s%.*s = ", u->symbol->name, u->order, "''''''''");
        const char *at = strstr(text, wanted);
        if (at != NULL) {
            const char *end;
            const double value = value_of(c, at + strlen(wanted), &end);
            TEST_ASSERT_EQUAL_INT_MESSAGE('\n', *end, c->name);
            double most = 0.0; /* the matrix passes on what the others are off */
            for (int j = 0; j < e->count; j++) {
                most = fmax(most, fabs(c->s.value[j][e->unknowns[j].order]));
            }
            expect_zero(c, value - should, 100.0 * most + 1e-300, "a closed form");
        }
    }
}

/* "  A12 = A21 = FORMULA" and "  b1 = FORMULA", whatever the letters. */
static void check_matrix(comparison *c, const char *text) {
    const equations *e = c->of->equations;
    const int n = e->count;
    double sum[UNKNOWNS] = {0};
    const char *line = strstr(text, "\n  with the highest derivatives from ");
    const bool symmetric = !c->of->instance->mechanism->is_system;
    if (line == NULL) {
        return;
    }
    line = strstr(line, "\n\n") + 2;
    for (int i = 0; i < n; i++) {
        for (int j = symmetric ? i : 0; j < n; j++) {
            const char *end = strchr(line, '\n');
            const char *from = strstr(line, " = ") + 3;
            from = symmetric && j > i ? strstr(from, " = ") + 3 : from;
            TEST_ASSERT_TRUE_MESSAGE(from < end, c->name);
            const double a = value_of(c, from, &end);
            TEST_ASSERT_EQUAL_INT_MESSAGE('\n', *end, c->name);
            sum[i] += a * c->s.value[j][e->unknowns[j].order];
            sum[j] += symmetric && j > i ? a * c->s.value[i][e->unknowns[i].order] : 0.0;
            line = end + 1;
        }
    }
    for (int i = 0; i < n; i++) {
        const char *end;
        const double b = value_of(c, strstr(line, " = ") + 3, &end);
        TEST_ASSERT_EQUAL_INT_MESSAGE('\n', *end, c->name);
        expect_zero(c, sum[i] - b, size_of(c, i), "a row of A x = b");
        line = end + 1;
    }
}

/* --- the derivation, step by step -------------------------------------------------------------------*/

/* The formula behind these words, which begin a line; 0 where there is no such line before `until`. */
static double step_value(comparison *c, const char *from, const char *until, const char *words) {
    const char *at = strstr(from, words);
    const char *end;
    return at == NULL || at > until ? 0.0 : value_of(c, at + strlen(words), &end);
}

/* How a printed formula changes with a direction of the state: by differences of fourth order. False where two widths do not
 * agree: something is singular near by. */
typedef void moved_state(comparison *c, int i, double by);
static bool slope_of(comparison *c, const char *from, const char *words, moved_state *move, int i,
                     double *slope) {
    static const double at[] = {-2.0, -1.0, 1.0, 2.0};
    static const double weight[] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
    const state_values here = c->s;
    double by_width[2] = {0.0, 0.0};
    double size = 1.0;
    for (int k = 0; k < 8; k++) {
        const double width = k < 4 ? 1e-3 : 5e-4;
        move(c, i, at[k % 4] * width);
        const double value = step_value(c, from, from + strlen(from), words);
        by_width[k / 4] += weight[k % 4] * value / width;
        size = fmax(size, fabs(value));
        c->s = here;
    }
    *slope = by_width[1];
    return fabs(by_width[0] - by_width[1]) <= 1e-8 * (size + fabs(*slope));
}

static void move_value(comparison *c, int i, double by) { c->s.value[i][0] += by; }
static void move_rate(comparison *c, int i, double by) { c->s.value[i][1] += by; }
static void move_on(comparison *c, int i, double by) { /* along the motion, for so long */
    (void)i;
    for (int j = 0; j < c->of->equations->count; j++) {
        c->s.value[j][0] += by * (c->s.value[j][1] + by * c->s.value[j][2] / 2.0);
        c->s.value[j][1] += by * c->s.value[j][2];
    }
}

/* Slopes of the printed L are the printed momentum and dL/dq, the momentum's along the motion is its printed rate, and with the
 * printed dF/dq' and Q they are the equation, whose left less right side is zero. Returns how many were compared. */
static int check_steps(comparison *c, const char *text) {
    const equations *e = c->of->equations;
    int checked = 0;
    for (int i = 0; i < e->count; i++) {
        const char *q = e->unknowns[i].symbol->name;
        char words[6][300];
        snprintf(words[0], sizeof words[0], "\n%s\n", q);
        const char *from = strstr(text, words[0]);
        TEST_ASSERT_NOT_NULL_MESSAGE(from, c->name);
        from += 1;
        const char *until = strstr(from, "\n\n");
        until = until == NULL ? from + strlen(from) : until;
        static const char *const forms[] = {"\n  dL/d%s' = ", "\n  d/dt(dL/d%s') = ",
                                            "\n  dL/d%s = ", "\n  dF/d%s' = ", "\n  Q(%s) = "};
        double printed_value[5];
        for (int k = 0; k < 5; k++) {
            const char *parts = strstr(forms[k], "%s");
            snprintf(words[k], sizeof words[k], "%.*s%s%s", (int)(parts - forms[k]), forms[k], q,
                     parts + 2);
            printed_value[k] = step_value(c, from, until, words[k]);
        }
        const double size = size_of(c, i) + fabs(printed_value[2]) + fabs(printed_value[1]);
        expect_zero(c, printed_value[1] - printed_value[2] + printed_value[3] - printed_value[4],
                    size, "the steps' sum");
        const struct {
            const char *of;
            moved_state *move;
            double should;
        } slopes[] = {{"\n  L = T - V = ", move_rate, printed_value[0]},
                      {"\n  L = T - V = ", move_value, printed_value[2]},
                      {words[0], move_on, printed_value[1]}};
        for (int k = 0; k < 3; k++) {
            double slope;
            if (slope_of(c, k < 2 ? text : from, slopes[k].of, slopes[k].move, i, &slope)) {
                expect_zero(c, slope - slopes[k].should,
                            30.0 * (1.0 + size + fabs(slopes[k].should)), slopes[k].of);
                checked++;
            }
        }
    }
    return checked;
}

/* The lists' highest derivatives become the state's. False when one is no number there. */
static bool accelerate(comparison *c, const image *im) {
    double result[RESULTS_MAX];
    const derived moving = {.instance = c->of->instance,
                            .equations = c->of->equations,
                            .image = (image *)(uintptr_t)im};
    TEST_ASSERT_TRUE(im->list[IMAGE_BOOKS]->results <= RESULTS_MAX);
    derived_run(im->list[IMAGE_BOOKS], &moving, &c->s, result);
    bool finite = true;
    for (int i = 0; i < im->count; i++) {
        c->s.value[i][im->unknown[i].order] = result[i];
        finite = finite && fabs(result[i]) < 1e12;
    }
    return finite;
}

static int stepped; /* slopes that were compared with differences */
static int named;   /* definitions of lets that were */

/* Returns how many formulas were compared. */
static int compare_all(const char *name, derived *d) {
    const equations *e = d->equations;
    if (e == NULL || e->count > UNKNOWNS) {
        return 0;
    }
    for (int i = 0; i < e->count; i++) {
        if (e->unknowns[i].order >= ORDERS_MAX) {
            return 0;
        }
    }
    diags *errors = diags_new();
    image *im = image_make(e, NULL, &plainly, IMAGE_TO_WRITE, errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(im, name);
    char *text = printed(d, TEXT);
    char *steps = d->instance->mechanism->is_system ? NULL : printed(d, STEPS);
    comparison c = {.name = name, .of = d};
    uint64_t seed = SEED;
    for (int k = 0; k < STATES; k++) {
        random_state(&c.s, d, &seed);
        if (accelerate(&c, im)) {
            const char *behind = check_equations(&c, text);
            check_closed_forms(&c, behind);
            check_matrix(&c, behind);
            named += check_lets(&c, text);
            named += steps != NULL ? check_lets(&c, steps) : 0;
            stepped += steps != NULL ? check_steps(&c, steps) : 0;
        }
    }
    free(text);
    free(steps);
    image_free(im);
    diags_free(errors);
    return c.compared;
}

static int compare_scene(const scene *s) {
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    const int compared = compare_all(s->name, &d);
    derived_free(&d);
    return compared > 0;
}

static void test_scenes_run_as_printed(void) {
    stepped = named = 0;
    TEST_ASSERT_TRUE(each_builtin_scene(compare_scene) > 60);
    printf("  %d definitions of lets compared\n", named);
    TEST_ASSERT_TRUE(stepped > 1000 && named > 50);
}

static int files;
static void compare_file(const char *name, derived *d) { files += compare_all(name, d) > 0; }

static void test_files_run_as_printed(void) {
    files = 0;
    each_mechanism(compare_file);
    TEST_ASSERT_TRUE(files > 25);
}

static void test_generated_mechanisms_run_as_printed(void) {
    const char *more = getenv("PRINTED_MECHANISMS");
    const int wanted = more != NULL ? (int)strtol(more, NULL, 10) : 60;
    int compared = 0;
    int formulas = 0;
    stepped = 0;
    for (int i = 0; i < wanted; i++) {
        char text[MECHANISM_SIZE];
        mechanism_write((unsigned)i, (uint64_t)(SEED + i), text);
        derived d = derived_text(text);
        const int here = compare_all(text, &d);
        compared += here > 0;
        formulas += here;
        derived_free(&d);
    }
    printf("  seed %d on: %d formulas of %d of %d mechanisms compared\n", SEED, formulas, compared,
           wanted);
    TEST_ASSERT_TRUE(10 * compared >= 7 * wanted);
    TEST_ASSERT_TRUE(stepped > 5 * wanted);
}

void suite_printed_runs(void) {
    RUN_TEST(test_scenes_run_as_printed);
    RUN_TEST(test_files_run_as_printed);
    RUN_TEST(test_generated_mechanisms_run_as_printed);
}
