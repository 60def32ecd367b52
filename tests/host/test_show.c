/* test_show.c: every expression of the language, printed, is read back by the language's own parser as the
 * same thing, and is LaTeX that compiles (latex.h). Random expressions and mechanisms, the same ones every
 * time; SHOW_CASES=N in the environment takes N of them instead of some hundreds. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "expressions.h"
#include "host/emit/show.h"
#include "host/lang/value.h"
#include "latex.h"
#include "parsed.h"
#include "printed.h"
#include "unity.h"

void suite_show(void);

enum { TEXT_SIZE = 1 << 16, STATES = 4, COORDINATES = 4, CONSTANTS = 6, PARAMETERS = 3 };

/* Names as people give them, Greek, of TeX's own words, with indices and underscores in odd places. */
static const char *const coordinates[COORDINATES] = {"theta1", "x", "phi_1_a", "_odd"};
static const char *const constants[CONSTANTS] = {"a1", "n_1", "mass_of_it", "Omega_", "x__2", "y1"};
static const expression_names names = {coordinates, COORDINATES, 1, constants, CONSTANTS};

static const char front[] =
    "mechanism m\ncoordinate theta1\ncoordinate x\ncoordinate phi_1_a\ncoordinate _odd\n"
    "parameter a1 = 2\nparameter n_1 = 1.5\nparameter mass_of_it = 0.7\ninput Omega_ = 1.2\n"
    "input x__2 = 0.4\ninput y1 = 3\n";

static int cases(int usual) {
    const char *wanted = getenv("SHOW_CASES");
    return wanted != NULL ? (int)strtol(wanted, NULL, 10) : usual;
}

/* --- a state ---------------------------------------------------------------------------------------*/

typedef struct state {
    double q[COORDINATES][3]; /* value, rate, acceleration */
    double constant[CONSTANTS];
} state;

static state random_values(uint64_t *seed) {
    state s;
    for (int i = 0; i < COORDINATES; i++) {
        for (int primes = 0; primes < 3; primes++) {
            s.q[i][primes] = random_between(seed, -1.5, 1.5);
        }
    }
    for (int i = 0; i < CONSTANTS; i++) {
        s.constant[i] = random_between(seed, 0.3, 3.0);
    }
    return s;
}

/* A neighbour: how far apart their values are says how well an expression can be computed there. */
static state nudged(const state *from, uint64_t *seed) {
    state s = *from;
    for (int i = 0; i < COORDINATES; i++) {
        for (int primes = 0; primes < 3; primes++) {
            s.q[i][primes] *= 1.0 + random_between(seed, -1e-12, 1e-12);
        }
    }
    for (int i = 0; i < CONSTANTS; i++) {
        s.constant[i] *= 1.0 + random_between(seed, -1e-12, 1e-12);
    }
    return s;
}

static double value_here(void *context, const symbol *sym, int primes) {
    const state *s = context;
    switch (sym->kind) {
    case SYM_PARAMETER: return s->constant[sym->index];
    case SYM_INPUT: return s->constant[PARAMETERS + sym->index];
    case SYM_COORDINATE:
    case SYM_STATE: return s->q[sym->index][primes];
    case SYM_LET:
    case SYM_OUTPUT: break;
    }
    return (double)NAN;
}

/* --- reading back ----------------------------------------------------------------------------------*/

/* The language gives q' the dimension of a rate, and a printed formula has its numbers without units: what is
 * read back is a formula of plain numbers, in which q' is a name, q_rate, and q'' q_rate_rate. */
static void plain_names(const char *from, size_t length, char *to) {
    for (size_t i = 0; i < length; i++) {
        if (from[i] == '\'') {
            to += sprintf(to, "_rate");
        } else {
            *to++ = from[i];
        }
    }
    *to = '\0';
}

typedef struct read_back {
    diags *said;
    model *model;
    instance *instance;
} read_back;

/* The formulas, each as an output of a mechanism whose inputs are all the names; NULL: a gap. */
static read_back parse_back(const char *const *formulas, int count) {
    char *text = NULL;
    size_t size = 0;
    char *plain = malloc(8 * TEXT_SIZE);
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    TEST_ASSERT_NOT_NULL(plain);
    fprintf(out, "mechanism back\nstate _u\nequation 1 [s]*_u' = 0\n");
    for (int i = 0; i < COORDINATES; i++) {
        fprintf(out, "input %s = 1\ninput %s_rate = 1\ninput %s_rate_rate = 1\n", coordinates[i],
                coordinates[i], coordinates[i]);
    }
    for (int i = 0; i < CONSTANTS; i++) {
        fprintf(out, "input %s = 1\n", constants[i]);
    }
    for (int i = 0; i < count; i++) {
        plain_names(formulas[i], strlen(formulas[i]), plain);
        fprintf(out, "output _f%d = %s\n", i, plain);
    }
    fclose(out);
    free(plain);
    read_back b = {.said = diags_new()};
    b.model = model_parse("printed.whirl", text, size, b.said);
    diags_flush(b.said, stdout);
    free(text);
    if (b.model != NULL) {
        b.instance = instance_make(b.model->mechanisms[0], NULL, NULL, b.said);
    }
    return b;
}

static void drop_back(read_back *b) {
    instance_free(b->instance);
    model_free(b->model);
    diags_free(b->said);
}

static double back_value(const read_back *b, int which, const state *s) {
    const mechanism *m = b->model->mechanisms[0];
    double *input = b->instance->input;
    for (int i = 0; i < COORDINATES; i++) {
        for (int primes = 0; primes < 3; primes++) {
            input[3 * i + primes] = s->q[i][primes];
        }
    }
    for (int i = 0; i < CONSTANTS; i++) {
        input[3 * COORDINATES + i] = s->constant[i];
    }
    valuation known = valuation_new(m, b->instance->arena, b->said);
    known.input = input;
    return expr_value(m->outputs[which]->value, &known);
}

/* --- one expression --------------------------------------------------------------------------------*/

static char *shown(algebra *a, const poly *p, show_style style) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    const show s = {out, style, a};
    show_poly(&s, p);
    fclose(out);
    return text;
}

static void expect_compiles(const char *latex) {
    const char *at;
    const char *problem = latex_problem(latex, &at);
    if (problem != NULL) {
        printf("  %s\n  %s: %.60s\n", latex, problem, at);
    }
    TEST_ASSERT_NULL_MESSAGE(problem, "LaTeX");
}

/* What never is, a derivation refuses. */
static bool is_ever_finite(const poly *p, uint64_t *seed) {
    bool finite = false;
    for (int k = 0; k < 8 && !finite; k++) {
        state s = random_values(seed);
        finite = isfinite(poly_evaluate(p, value_here, &s));
    }
    return finite;
}

/* What a formula should be: its value at a state, and the size of what it is the sum of. */
typedef struct quantity {
    double (*value)(const struct quantity *of, const state *at, double *size);
    algebra *algebra;
    const poly *poly;
    const equations *equations;
    int unknown;
} quantity;

/* No part of it is out of range there: 1/(1 + x) hides that x was infinite, sin(x) that no digit of a large x was
 * left. */
static bool is_in_range(const poly *p, double most, state *s) {
    bool good = fabs(poly_evaluate(p, value_here, s)) < most;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        good = good && (m->angle == NULL || is_in_range(m->angle, 1e5, s));
        for (int k = 0; k < m->count; k++) {
            for (int j = 0; j < 2 && m->factors[k].atom->argument[j] != NULL; j++) {
                good = good && is_in_range(m->factors[k].atom->argument[j], 1e5, s);
            }
        }
    }
    return good;
}

static double poly_here(const quantity *of, const state *at, double *size) {
    state s = *at;
    *size = 0.0;
    for (int i = 0; i < of->poly->count; i++) {
        const poly_term *t = &of->poly->terms[i];
        const poly *part = poly_of_term(of->algebra, t->coefficient, t->mono);
        *size += fabs(poly_evaluate(part, value_here, &s));
    }
    return is_in_range(of->poly, 1e60, &s) ? poly_evaluate(of->poly, value_here, &s) : (double)NAN;
}

/* The printed text's value (less that of `right`, if not -1) is that of the quantity at random states;
 * returns at how many it had one. */
static int compare(const quantity *q, const char *text, const read_back *b, int which, int right,
                   uint64_t *seed) {
    int compared = 0;
    for (int k = 0; k < STATES; k++) {
        double size;
        double unused;
        state s = random_values(seed);
        const double wanted = q->value(q, &s, &size);
        double spread = 1e-12 + 1e-13 * size;
        for (int i = 0; i < 3; i++) {
            state other = nudged(&s, seed);
            spread = fmax(spread, fabs(q->value(q, &other, &unused) - wanted));
        }
        if (!(fabs(wanted) < 1e60 && spread < 1e-6 * (1.0 + fabs(wanted)))) {
            continue;
        }
        const double got = back_value(b, which, &s) - (right < 0 ? 0.0 : back_value(b, right, &s));
        if (!(fabs(got - wanted) <= 1000.0 * spread)) {
            printf("  %s\n  is %.17g as derived, %.17g as printed (known to %.1e)\n", text, wanted,
                   got, spread);
        }
        TEST_ASSERT_TRUE_MESSAGE(fabs(got - wanted) <= 1000.0 * spread, "another expression");
        compared++;
    }
    return compared;
}

/* Each expression and its slope, which has more powers still. */
enum { BATCH = 10, FORMULAS = 2 * BATCH };

static int check_batch(uint64_t *seed, int depth, int tame) {
    char *text = malloc((size_t)BATCH * TEXT_SIZE);
    TEST_ASSERT_NOT_NULL(text);
    size_t at = (size_t)sprintf(text, "%s", front);
    for (int i = 0; i < BATCH; i++) {
        at += (size_t)sprintf(text + at, "output f%d = ", i);
        expression_write(&names, depth, tame, seed, text + at, TEXT_SIZE / 2);
        at += strlen(text + at);
        at += (size_t)sprintf(text + at, "\n");
    }
    sprintf(text + at, "T = 1 [kg*m^2]*(theta1'^2 + x'^2 + phi_1_a'^2 + _odd'^2)\n");
    const mechanism *m = parse(text);
    algebra *a = algebra_new();
    const poly *p[FORMULAS];
    char *printed_text[FORMULAS] = {NULL};
    int count = 0;
    for (int i = 0; i < BATCH; i++) {
        p[count++] = poly_from_expr(a, m->outputs[i]->value);
        p[count] =
            poly_derivative(a, p[count - 1], m->coordinates[random_bits(seed) % COORDINATES], 0);
        count++;
    }
    int kept = 0;
    const bool overflowed =
        algebra_overflow(a); /* before printing; printing may overflow as well */
    for (int i = 0; i < count && !overflowed; i++) {
        if (!is_ever_finite(p[i], seed)) {
            continue;
        }
        char *one = shown(a, p[i], SHOW_TEXT);
        if (strlen(one) > TEXT_SIZE || strstr(one, "inf") != NULL || strstr(one, "nan") != NULL) {
            free(one); /* a derivation would have refused it */
            continue;
        }
        char *latex = shown(a, p[i], SHOW_LATEX);
        expect_compiles(latex);
        free(latex);
        p[kept] = p[i];
        printed_text[kept++] = one;
    }
    read_back b = parse_back((const char *const *)printed_text, kept);
    if (b.instance == NULL) {
        printf("%s", text);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(b.instance, "what was printed is not read back");
    int compared = 0;
    for (int i = 0; i < kept; i++) {
        const quantity q = {poly_here, a, p[i], NULL, 0};
        compared += compare(&q, printed_text[i], &b, i, -1, seed) > 0;
        free(printed_text[i]);
    }
    drop_back(&b);
    algebra_free(a);
    free(text);
    drop();
    return compared;
}

static void test_expressions_are_read_back_as_printed(void) {
    const int wanted = cases(600);
    uint64_t seed = 20;
    int compared = 0;
    int made_up = 0;
    for (; made_up < wanted; made_up += FORMULAS) {
        const uint64_t before = seed;
        const int here =
            check_batch(&seed, 1 + made_up / FORMULAS % 5, made_up / FORMULAS % 3 != 0);
        compared += here;
        (void)before;
    }
    printf("  seed 20: %d of %d expressions compared\n", compared, made_up);
    TEST_ASSERT_TRUE(10 * compared > 6 * made_up);
}

/* --- whole mechanisms ------------------------------------------------------------------------------*/

/* The formulas between `from` and the line's end, parted by " = ": their copies, to be freed. */
static int formulas_of(char *line, char **formula) {
    int count = 0;
    for (char *next = line; next != NULL; line = next) {
        next = strstr(line, " = ");
        if (next != NULL) {
            *next = '\0';
            next += 3;
        }
        formula[count++] = line;
    }
    return count;
}

/* Both sides of an equation as printed against what was derived: A q'' - f. */
static int compare_sides(const equations *e, int row, const read_back *b, const char *text,
                         uint64_t *seed) {
    algebra *a = e->algebra;
    const poly *rest = poly_scale(a, equations_force(e, row), -1.0);
    for (int j = 0; j < e->count; j++) {
        const poly *highest = poly_symbol(a, e->unknowns[j].symbol, e->unknowns[j].order);
        rest = poly_add(a, rest, poly_mul(a, e->mass[row * e->count + j], highest));
    }
    const quantity q = {poly_here, a, rest, NULL, 0};
    return compare(&q, text, b, 2 * row, 2 * row + 1, seed) > 0;
}

/* A highest derivative, from two equations. */
static double solution_here(const quantity *of, const state *at, double *size) {
    const equations *e = of->equations;
    double m[4];
    double f[2];
    state s = *at;
    bool good = true;
    for (int i = 0; i < 2; i++) {
        good = good && is_in_range(equations_force(e, i), 1e5, &s) &&
               is_in_range(e->mass[2 * i], 1e5, &s) && is_in_range(e->mass[2 * i + 1], 1e15, &s);
        f[i] = poly_evaluate(equations_force(e, i), value_here, &s);
        m[2 * i] = poly_evaluate(e->mass[2 * i], value_here, &s);
        m[2 * i + 1] = poly_evaluate(e->mass[2 * i + 1], value_here, &s);
    }
    const double bottom = m[0] * m[3] - m[1] * m[2];
    const int k = of->unknown;
    const double top = k == 0 ? f[0] * m[3] - m[1] * f[1] : m[0] * f[1] - f[0] * m[2];
    *size = (fabs(m[0] * m[3]) + fabs(m[1] * m[2])) * fabs(top / bottom / bottom) +
            (fabs(f[0]) + fabs(f[1])) * (fabs(m[k == 0 ? 3 : 0]) + fabs(m[1 + k])) / fabs(bottom);
    return good ? top / bottom : (double)NAN; /* it has products of these */
}

/* LaTeX: what stands between \begin{align} and \end{align}. */
static void check_align(const derived *d) {
    char *text = printed(d, LATEX);
    int blocks = 0;
    for (char *at = text; (at = strstr(at, "\\begin{align}")) != NULL; blocks++) {
        char *end = strstr(at, "\\end{align}");
        TEST_ASSERT_NOT_NULL(end);
        *end = '\0';
        expect_compiles(at + strlen("\\begin{align}"));
        at = end + 1;
    }
    TEST_ASSERT_TRUE(blocks == 1 || blocks == 2);
    free(text);
}

static int check_mechanism(int depth, uint64_t *seed) {
    char *source_text = malloc(TEXT_SIZE);
    TEST_ASSERT_NOT_NULL(source_text);
    expression_mechanism(depth, seed, source_text, TEXT_SIZE);
    derived d = derived_text(source_text);
    if (d.equations == NULL) { /* never finite, say */
        TEST_ASSERT_NULL_MESSAGE(strstr(d.errors, "x.whirl:1:1: error: 'm'"), d.errors);
        derived_free(&d);
        free(source_text);
        return 0;
    }
    check_align(&d);
    char *text = printed(&d, TEXT);
    char *formula[64];
    int count = 0;
    int solved[2] = {-1, -1};
    char *line = strstr(strstr(text, "\nequations"), "\n\n") + 2;
    for (int i = 0; i < d.equations->count; i++) {
        char *end = strchr(line, '\n');
        char *label = strstr(line, ":  ");
        *end = '\0';
        TEST_ASSERT_EQUAL_INT(2, formulas_of(label != NULL ? label + 3 : line, formula + count));
        count += 2;
        line = end + 1;
    }
    for (int i = 0; i < d.equations->count; i++) { /* s3' = theta1'' = FORMULA */
        char wanted[32];
        const unknown *u = &d.equations->unknowns[i];
        snprintf(wanted, sizeof wanted, " = %s%.*s = ", u->symbol->name, u->order, "''''");
        char *at = strstr(line, wanted);
        if (at != NULL) {
            char *end = strchr(at, '\n');
            *end = '\0';
            solved[i] = count;
            formula[count++] = at + strlen(wanted);
            line = end + 1;
        }
    }
    read_back b = parse_back((const char *const *)formula, count);
    if (b.instance == NULL) {
        printf("%s", source_text);
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(b.instance, "what was printed is not read back");
    int compared = 0;
    for (int i = 0; i < d.equations->count; i++) {
        compared += compare_sides(d.equations, i, &b, formula[2 * i], seed);
        const quantity q = {solution_here, NULL, NULL, d.equations, i};
        if (solved[i] >= 0) {
            compared += compare(&q, formula[solved[i]], &b, solved[i], -1, seed) > 0;
        }
    }
    drop_back(&b);
    free(text);
    derived_free(&d);
    free(source_text);
    return compared;
}

static void test_mechanisms_are_read_back_as_printed(void) {
    const int wanted = cases(600) / 10;
    uint64_t seed = 21;
    int compared = 0;
    for (int i = 0; i < wanted; i++) {
        compared += check_mechanism(1 + i % 4, &seed);
    }
    printf("  seed 21: %d formulas of %d mechanisms compared\n", compared, wanted);
    TEST_ASSERT_TRUE(compared > wanted);
}

void suite_show(void) {
    UnitySetTestFile(__FILE__);
    RUN_TEST(test_expressions_are_read_back_as_printed);
    RUN_TEST(test_mechanisms_are_read_back_as_printed);
}
