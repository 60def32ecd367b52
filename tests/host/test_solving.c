/* test_solving.c: whatever the matrix is that stands before the highest derivatives, the operation list solves for them:
 * systems of one to five equations, entries of every kind, put back into the equations. And which coordinates are
 * kept as turn angles. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/derive/lower.h"
#include "unity.h"

void suite_solving(void);

static unsigned draw(uint64_t *seed, unsigned bound) {
    return (unsigned)(random_bits(seed) % bound);
}

/* --- equations --------------------------------------------------------------------------------------- */

/* One entry of the matrix: nothing, a number, or what changes with the states, not small as a rule. */
static void entry(FILE *to, int n, unsigned variety, uint64_t *seed) {
    const unsigned state = draw(seed, (unsigned)n);
    const double number = (double)draw(seed, 9) / 4.0 - 1.0;
    switch (draw(seed, variety)) {
    case 0: fputs("0", to); break;
    case 1: fprintf(to, "(%g)", number); break;
    case 2: fprintf(to, "(2 + %g*sin(x%u))", number, state); break;
    case 3: fprintf(to, "(%g + x%u)", number, state); break;
    case 4: fprintf(to, "cos(2*x%u + %g)", state, number); break;
    case 5: fprintf(to, "exp(x%u/4)", state); break;
    default: fprintf(to, "(1 + x%u^2)", state); break;
    }
}

static char *written_system(int n, uint64_t *seed) {
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(to);
    const unsigned variety = 2 + draw(seed, 6); /* from numbers only to all kinds */
    fputs("mechanism m\n", to);
    for (int i = 0; i < n; i++) {
        fprintf(to, "state x%d\n", i);
    }
    for (int i = 0; i < n; i++) {
        fputs("equation 1 [s]*(0", to);
        for (int j = 0; j < n; j++) {
            fputs(" + ", to);
            entry(to, n, variety, seed);
            fprintf(to, "*x%d'", j);
        }
        fputs(") = sin(x0) + ", to);
        entry(to, n, 7, seed);
        fputs("\n", to);
    }
    fclose(to);
    return text;
}

static int check_solution(const derived *d, uint64_t *seed, const char *text) {
    const equations *e = d->equations;
    int checked = 0;
    for (int k = 0; k < 3; k++) {
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, d, seed);
        derived_run(d->image->list[IMAGE_BOOKS], d, &s, result);
        double largest = 0.0;
        for (int i = 0; i < e->count; i++) {
            largest = fmax(largest, fabs(result[i]));
        }
        if (!isfinite(largest) || largest > 1e4) {
            continue; /* next to a singular state */
        }
        for (int i = 0; i < e->count; i++) {
            double size;
            const double rest = derived_rest(d, &s, result, i, &size);
            TEST_ASSERT_TRUE_MESSAGE(fabs(rest) <= 1e-9 * largest + 1e-9 * size, text);
        }
        checked++;
    }
    return checked;
}

static void test_any_regular_system_is_solved(void) {
    uint64_t seed = 41;
    int checked[6] = {0};
    for (int round = 0; round < 1200; round++) {
        const int n = 1 + round % 5;
        char *text = written_system(n, &seed);
        derived d = derived_text(text);
        if (d.image != NULL) {
            checked[n] += check_solution(&d, &seed, text);
        }
        derived_free(&d);
        free(text);
    }
    printf("  seed 41: %d %d %d %d %d states\n", checked[1], checked[2], checked[3], checked[4],
           checked[5]);
    for (int n = 1; n <= 5; n++) {
        TEST_ASSERT_GREATER_THAN_INT(200, checked[n]);
    }
}

/* One equation of a system is made of those above it, in decimals that are no binary fractions: it is named. */
static void test_the_equation_that_repeats_others_is_named(void) {
    uint64_t seed = 47;
    for (int round = 0; round < 60; round++) {
        const int n = 2 + round % 4;
        const int bad = 1 + (int)draw(&seed, (unsigned)n - 1);
        double share[5];
        char *text = NULL;
        size_t size = 0;
        FILE *to = open_memstream(&text, &size);
        TEST_ASSERT_NOT_NULL(to);
        double number[5][5];
        fputs("mechanism m\n", to);
        for (int i = 0; i < n; i++) {
            share[i] = (double)(1 + draw(&seed, 9)) / 10.0;
            fprintf(to, "state x%d\n", i);
        }
        for (int i = 0; i < n; i++) {
            fputs("equation 1 [s]*(0", to);
            for (int j = 0; j < n; j++) {
                number[i][j] = (double)(1 + draw(&seed, 99)) / 10.0 + (i == j ? 20.0 : 0.0);
                for (int k = 0; k < i && i == bad; k++) {
                    fprintf(to, " + %g*(%g + sin(x%d))*x%d'", share[k], number[k][j], k, j);
                }
                if (i != bad) {
                    fprintf(to, " + (%g + sin(x%d))*x%d'", number[i][j], i, j);
                }
            }
            fputs(") = 1\n", to);
        }
        fclose(to);
        derived d = derived_text(text);
        char at[20];
        snprintf(at, sizeof at, ":%d:", 1 + n + bad + 1);
        TEST_ASSERT_TRUE_MESSAGE(d.image == NULL, text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, at), d.errors);
        derived_free(&d);
        free(text);
    }
}

/* --- long products ---------------------------------------------------------------------------------------- */

/* Products of up to forty different factors and their powers, alone and in a sum, of which lowering keeps 24 apart. */
static void test_long_products_keep_their_value(void) {
    uint64_t seed = 43;
    for (int factors = 20; factors <= 40; factors++) {
        char text[4096];
        size_t length = (size_t)snprintf(text, sizeof text,
                                         "mechanism m\ncoordinate q\ncoordinate x\n"
                                         "T = 1 [kg*m^2]*(q'^2 + x'^2)\noutput it = 0.5*q^2");
        for (int part = 0; part < 2; part++) {
            length += (size_t)snprintf(text + length, sizeof text - length, " + 3*x^%d", part + 1);
            for (int k = 1; k <= factors; k++) {
                length += (size_t)snprintf(text + length, sizeof text - length, "*atan(q + %d)^%u",
                                           k, 1 + draw(&seed, 3));
            }
        }
        snprintf(text + length, sizeof text - length, "\n");
        derived d = derived_text(text);
        derived_expect(&d, text);
        state_values s;
        double result[UNKNOWNS];
        random_state(&s, &d, &seed);
        derived_run(d.image->list[IMAGE_OBSERVE], &d, &s, result);
        const double wanted = poly_evaluate(d.equations->output[0], state_value, &s);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * fabs(wanted), wanted, result[0]);
        derived_free(&d);
    }
}

/* --- turn angles ---------------------------------------------------------------------------------------- */

/* Is q, which the expression names, inside sines and tangents only, with whole factors? */
static void test_what_can_be_a_turn_angle(void) {
    static const struct {
        const char *text;
        bool turns;
    } rows[] = {
        {"sin(q)", true},
        {"cos(3*q - 2*x + 0.7)", true},
        {"x*sin(q)^2 + exp(cos(2*q))", true},
        {"tan(q)", true},
        {"tan(2*q + x)", true},
        {"atan2(sin(q), cos(q))", true},
        {"sin(sin(q))", true},
        {"sin(x + 3*cos(q))", true},
        {"sin(x*sin(q))", true},
        {"sin(exp(sin(q)))", true},
        {"(2 + cos(q))^x", true},
        {"x^(2 + cos(q))", true},
        {"sqrt(3 + sin(q))", true},
        {"1 [s]*q'*cos(q)", true},
        {"sin(1 [s]*q')", true},
        {"x", true},
        {"q", false},
        {"q^2", false},
        {"x*q", false},
        {"sin(q) + q", false},
        {"sin(q/2)", false},
        {"sin(1.5*q)", false},
        {"sin(2000001*q)", false},
        {"tan(q/2)", false},
        {"tan(q^2)", false},
        {"sin(x*q)", false},
        {"sin(q^2)", false},
        {"sin(q*x + x)", false},
        {"sin(exp(q))", false},
        {"sin(x + exp(q/2))", false},
        {"sin(x*sin(q/2))", false},
        {"sin(sin(q/2))", false},
        {"sin(q*sin(x))", false},
        {"sin(x*atan2(x, q))", false},
        {"sin(x*atan2(q, x))", false},
        {"exp(q)", false},
        {"atan2(q, x)", false},
        {"atan2(x, q)", false},
        {"(2 + q^2)^x", false},
        {"x^q", false},
        {"(q + x)^3", false},
        {"sqrt(3 + q^2)", false},
        {"abs(sin(q) + q)", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate q\ncoordinate x\nT = 1 [kg*m^2]*(q'^2 + x'^2)\n"
                 "let it = %s\n",
                 rows[i].text);
        diags *all = diags_new();
        whirl_model *m = model_parse("t", text, strlen(text), all);
        if (m == NULL) {
            diags_flush(all, stdout);
        }
        TEST_ASSERT_NOT_NULL_MESSAGE(m, rows[i].text);
        algebra *a = algebra_new();
        const poly *p = poly_from_expr(a, m->mechanisms[0]->lets[0]->value);
        const symbol *q = m->mechanisms[0]->coordinates[0];
        TEST_ASSERT_TRUE_MESSAGE(lower_only_in_waves(p, q) == rows[i].turns, rows[i].text);
        algebra_free(a);
        model_free(m);
        diags_free(all);
    }
}

void suite_solving(void) {
    RUN_TEST(test_any_regular_system_is_solved);
    RUN_TEST(test_the_equation_that_repeats_others_is_named);
    RUN_TEST(test_long_products_keep_their_value);
    RUN_TEST(test_what_can_be_a_turn_angle);
}
