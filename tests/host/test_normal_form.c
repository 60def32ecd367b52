/* test_normal_form.c: what poly.h promises of every expression, checked on random ones from outside: the order of
 * terms and factors, sizes and what is known to be inside against a walk through them, one object for equal things,
 * one form whatever was made before. WH_FORMS=N: so many random expressions. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "forms.h"

#include "unity.h"

void suite_normal_form(void);

/* --- the order, as order.c and algebra.h describe it -------------------------------------------------- */

static int expected_poly_order(const poly *x, const poly *y);

static int expected_atom_order(const atom *x, const atom *y) {
    int order = form_order(x->kind, y->kind);
    if (order == 0 && x->kind == ATOM_SYMBOL) {
        order = form_order(x->primes, y->primes);
        order = order != 0 ? order : form_order(x->symbol->kind, y->symbol->kind);
        order = order != 0 ? order : form_order(x->symbol->index, y->symbol->index);
        return order != 0 ? order
                          : form_order((double)strcmp(x->symbol->name, y->symbol->name), 0.0);
    }
    order = order != 0 ? order : form_order(x->function, y->function);
    for (int i = 0; i < 2 && order == 0 && x->argument[i] != NULL; i++) {
        order = expected_poly_order(x->argument[i], y->argument[i]);
    }
    return order;
}

static int expected_mono_order(const mono *x, const mono *y) {
    int order = form_order(x->count, y->count);
    for (int i = 0; i < x->count && order == 0; i++) {
        order = expected_atom_order(x->factors[i].atom, y->factors[i].atom);
        order = order != 0 ? order : form_order(x->factors[i].exponent, y->factors[i].exponent);
    }
    order = order != 0 ? order : form_order(x->trig, y->trig);
    return order != 0 || x->angle == NULL ? order : expected_poly_order(x->angle, y->angle);
}

static int expected_poly_order(const poly *x, const poly *y) {
    int order = 0;
    for (int i = 0; i < x->count && i < y->count && order == 0; i++) {
        order = expected_mono_order(x->terms[i].mono, y->terms[i].mono);
        order = order != 0 ? order : form_order(x->terms[i].coefficient, y->terms[i].coefficient);
    }
    return order != 0 ? order : form_order(x->count, y->count);
}

/* --- what is known of an expression, from a walk through it ------------------------------------------- */

typedef struct known {
    uint64_t symbols;
    double size;
    bool keeps_powers;
    bool contains[FORM_SYMBOLS][FORM_PRIMES];
} known;

static void walk_poly(const poly *p, known *all);

static void walk_atom(const atom *x, known *all) {
    if (x->kind == ATOM_SYMBOL) {
        all->symbols |= symbol_bit(x->symbol, x->primes);
        all->size += 1.0;
        all->contains[form_place(x->symbol)][x->primes] = true;
        return;
    }
    all->size += 1.0;
    for (int i = 0; i < 2 && x->argument[i] != NULL; i++) {
        walk_poly(x->argument[i], all);
    }
}

static void walk_poly(const poly *p, known *all) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        all->size += 1.0;
        if (m->angle != NULL) {
            walk_poly(m->angle, all);
        }
        for (int k = 0; k < m->count; k++) {
            const mono_factor *f = &m->factors[k];
            const bool whole = f->exponent == floor(f->exponent) && f->exponent > 1.0;
            all->keeps_powers =
                all->keeps_powers || (f->atom->kind == ATOM_GROUP && whole &&
                                      pow(f->atom->argument[0]->count, f->exponent) <= 64.0);
            walk_atom(f->atom, all);
        }
    }
}

static void check_knowledge(const poly *p) {
    known all = {0};
    walk_poly(p, &all);
    TEST_ASSERT_TRUE(p->symbols == all.symbols);
    TEST_ASSERT_TRUE(p->size == all.size);
    TEST_ASSERT_TRUE(p->keeps_powers == all.keeps_powers);
    for (int s = 0; s < FORM_SYMBOLS; s++) {
        bool any = false;
        for (int primes = 0; primes < FORM_PRIMES; primes++) {
            const bool inside = all.contains[s][primes];
            any = any || inside;
            TEST_ASSERT_TRUE(poly_contains(p, &form_symbols[s], primes) == inside);
            TEST_ASSERT_TRUE(!inside || poly_may_contain(p, &form_symbols[s], primes));
        }
        TEST_ASSERT_TRUE(poly_contains(p, &form_symbols[s], -1) == any);
    }
}

/* --- form -------------------------------------------------------------------------------------------- */

static void check_form(const poly *p);

static void check_factor(const mono_factor *f) {
    const atom *x = f->atom;
    TEST_ASSERT_TRUE(fabs(f->exponent) >= 1e-12);
    if (x->kind == ATOM_SYMBOL) {
        return;
    }
    check_form(x->argument[0]);
    double value;
    if (x->kind == ATOM_POWER) {
        check_form(x->argument[1]);
        TEST_ASSERT_FALSE(poly_is_number(x->argument[1], &value));
    } else if (x->kind == ATOM_GROUP) {
        TEST_ASSERT_TRUE(f->exponent != 1.0);
        TEST_ASSERT_FALSE(poly_is_number(x->argument[0], &value));
    } else if (x->function == FN_ABS) {
        TEST_ASSERT_TRUE(f->exponent < 2.0); /* |p|^2 = p^2 */
    }
}

static void check_form(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        TEST_ASSERT_TRUE(p->terms[i].coefficient != 0.0);
        TEST_ASSERT_TRUE(i == 0 || expected_mono_order(p->terms[i - 1].mono, m) < 0);
        TEST_ASSERT_TRUE((m->trig == TRIG_NONE) == (m->angle == NULL));
        if (m->angle != NULL) { /* sin(-x) is -sin(x) */
            double value;
            TEST_ASSERT_FALSE(poly_is_number(m->angle, &value));
            TEST_ASSERT_TRUE(m->angle->terms[0].coefficient > 0.0);
            check_form(m->angle);
        }
        for (int k = 0; k < m->count; k++) {
            check_factor(&m->factors[k]);
            TEST_ASSERT_TRUE(k == 0 ||
                             expected_atom_order(m->factors[k - 1].atom, m->factors[k].atom) < 0);
        }
    }
}

/* What is equal is one object: a copy is found again. */
static void check_interned(algebra *a, const poly *p) {
    poly *copy = poly_scratch(p->count);
    copy->count = p->count;
    memcpy(copy->terms, p->terms, (size_t)p->count * sizeof p->terms[0]);
    TEST_ASSERT_TRUE(poly_intern(a, copy) == p);
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        TEST_ASSERT_TRUE(mono_make(a, m->factors, m->count, m->trig, m->angle) == m);
    }
    if (p->count > 0) { /* and what differs is not taken for it */
        copy->terms[p->count - 1].coefficient *= 2.0;
        TEST_ASSERT_TRUE(poly_intern(a, copy) != p);
        copy->terms[p->count - 1] = p->terms[p->count - 1];
        copy->count--;
        TEST_ASSERT_TRUE(poly_intern(a, copy) != p);
    }
    free(copy);
}

/* --- random expressions ------------------------------------------------------------------------------- */

static int forms(void) {
    const char *wanted = getenv("WH_FORMS");
    return wanted != NULL ? (int)strtol(wanted, NULL, 10) : 3000;
}

static void test_every_expression_keeps_the_form(void) {
    uint64_t seed = 20061122;
    printf("  %d expressions, seed %" PRIu64 "\n", forms(), seed);
    int seen[4] = {0};
    int kept = 0;
    int waves = 0;
    algebra *a = NULL;
    for (int i = 0; i < forms(); i++) {
        if (i % 100 == 0) {
            algebra_free(a);
            a = algebra_new();
        }
        const poly *p = form_random(a, &seed, 1 + i % 5);
        check_form(p);
        check_knowledge(p);
        check_interned(a, p);
        kept += p->keeps_powers;
        for (int t = 0; t < p->count; t++) {
            waves += p->terms[t].mono->trig != TRIG_NONE;
            for (int k = 0; k < p->terms[t].mono->count; k++) {
                seen[p->terms[t].mono->factors[k].atom->kind]++;
            }
        }
    }
    TEST_ASSERT_FALSE(algebra_overflow(a));
    algebra_free(a);
    for (int k = 0; k < 4; k++) {
        TEST_ASSERT_GREATER_THAN_INT(forms() / 30, seen[k]);
    }
    TEST_ASSERT_GREATER_THAN_INT(forms() / 200, kept);
    TEST_ASSERT_GREATER_THAN_INT(forms() / 20, waves);
}

/* Sums and products do not ask who came first; neither does the order between two. */
static void test_the_order_of_arguments_does_not_matter(void) {
    uint64_t seed = 31;
    for (int i = 0; i < 400; i++) {
        algebra *a = algebra_new();
        const poly *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = form_random(a, &seed, 1 + i % 4);
        }
        TEST_ASSERT_TRUE(poly_add(a, p[0], p[1]) == poly_add(a, p[1], p[0]));
        TEST_ASSERT_TRUE(poly_mul(a, p[0], p[1]) == poly_mul(a, p[1], p[0]));
        TEST_ASSERT_TRUE(poly_is_zero(poly_sub(a, p[0], p[0])));
        TEST_ASSERT_TRUE(poly_scale(a, poly_scale(a, p[0], -8.0), -0.125) == p[0]);
        TEST_ASSERT_TRUE(poly_sub(a, p[0], p[1]) == poly_add(a, p[0], poly_scale(a, p[1], -1.0)));
        for (int k = 0; k < 3; k++) {
            for (int m = 0; m < 3; m++) {
                const int order = poly_order(p[k], p[m]);
                TEST_ASSERT_TRUE(form_order(order, 0) == expected_poly_order(p[k], p[m]));
                TEST_ASSERT_TRUE((order == 0) == (p[k] == p[m]));
            }
        }
        algebra_free(a);
    }
}

/* --- one form, whatever was made before ---------------------------------------------------------------- */

static void write_poly(FILE *out, const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        fprintf(out, "%+a", p->terms[i].coefficient);
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            fprintf(out, "*%d:%s'%d:%d(", (int)x->kind,
                    x->kind == ATOM_SYMBOL ? x->symbol->name : "", x->primes, (int)x->function);
            for (int j = 0; j < 2 && x->kind != ATOM_SYMBOL && x->argument[j] != NULL; j++) {
                write_poly(out, x->argument[j]);
                fputc(';', out);
            }
            fprintf(out, ")^%a", m->factors[k].exponent);
        }
        if (m->angle != NULL) {
            fprintf(out, "*%d(", (int)m->trig);
            write_poly(out, m->angle);
            fputc(')', out);
        }
    }
}

static char *written(const poly *p) {
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    write_poly(out, p);
    fclose(out);
    return text;
}

static void test_the_form_does_not_hang_on_what_was_made_before(void) {
    for (uint64_t number = 1; number <= 300; number++) {
        algebra *fresh = algebra_new();
        algebra *used = algebra_new();
        uint64_t other = number * 77;
        for (int i = 0; i < 4; i++) {
            form_random(used, &other, 4);
        }
        for (int s = FORM_SYMBOLS - 1; s >= 0; s--) {
            poly_symbol(used, &form_symbols[s], s % FORM_PRIMES);
        }
        uint64_t first = number;
        uint64_t second = number;
        char *left = written(form_random(fresh, &first, 4));
        char *right = written(form_random(used, &second, 4));
        TEST_ASSERT_EQUAL_STRING(left, right);
        free(left);
        free(right);
        algebra_free(fresh);
        algebra_free(used);
    }
}

void suite_normal_form(void) {
    RUN_TEST(test_every_expression_keeps_the_form);
    RUN_TEST(test_the_order_of_arguments_does_not_matter);
    RUN_TEST(test_the_form_does_not_hang_on_what_was_made_before);
}
