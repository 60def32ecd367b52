#include "test.h"

#include "reread.h"

#include "host/lang/value.h"
#include "latex.h"

const char *const reread_coordinates[REREAD_COORDINATES] = {"theta1", "x", "phi_1_a", "_odd"};
const char *const reread_constants[REREAD_CONSTANTS] = {"a1",     "n_1",  "mass_of_it",
                                                        "Omega_", "x__2", "y1"};

state random_values(uint64_t *seed) {
    state s;
    for (int i = 0; i < REREAD_COORDINATES; i++) {
        for (int primes = 0; primes < 3; primes++) {
            s.q[i][primes] = random_between(seed, -1.5, 1.5);
        }
    }
    for (int i = 0; i < REREAD_CONSTANTS; i++) {
        s.constant[i] = random_between(seed, 0.3, 3.0);
    }
    return s;
}

/* A state near `from`. If an expression is ill-conditioned, its values at the two states differ much. */
static state nudged(const state *from, uint64_t *seed) {
    state s = *from;
    for (int i = 0; i < REREAD_COORDINATES; i++) {
        for (int primes = 0; primes < 3; primes++) {
            s.q[i][primes] *= 1.0 + random_between(seed, -1e-12, 1e-12);
        }
    }
    for (int i = 0; i < REREAD_CONSTANTS; i++) {
        s.constant[i] *= 1.0 + random_between(seed, -1e-12, 1e-12);
    }
    return s;
}

double value_here(void *context, const symbol *sym, int primes) {
    const state *s = context;
    switch (sym->kind) {
    case SYM_PARAMETER: return s->constant[sym->index];
    case SYM_INPUT: return s->constant[REREAD_PARAMETERS + sym->index];
    case SYM_COORDINATE:
    case SYM_STATE: return s->q[sym->index][primes];
    case SYM_LET:
    case SYM_OUTPUT:
    case SYM_RECORD: break;
    }
    return (double)NAN;
}

/* Writes a formula with q_rate for q' and q_rate_rate for q''. Printed formulas have numbers without units, but the
 * language gives q' the dimension of a rate. */
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

read_back parse_back(const char *const *formulas, int count) {
    char *text = NULL;
    size_t size = 0;
    size_t longest = 0;
    for (int i = 0; i < count; i++) {
        longest = strlen(formulas[i]) > longest ? strlen(formulas[i]) : longest;
    }
    char *plain = malloc(8 * longest + 1);
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    TEST_ASSERT_NOT_NULL(plain);
    fprintf(out, "mechanism back\nstate _u\nequation 1 [s]*_u' = 0\n");
    for (int i = 0; i < REREAD_COORDINATES; i++) {
        fprintf(out, "input %s = 1\ninput %s_rate = 1\ninput %s_rate_rate = 1\n",
                reread_coordinates[i], reread_coordinates[i], reread_coordinates[i]);
    }
    for (int i = 0; i < REREAD_CONSTANTS; i++) {
        fprintf(out, "input %s = 1\n", reread_constants[i]);
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

void drop_back(read_back *b) {
    instance_free(b->instance);
    model_free(b->model);
    diags_free(b->said);
}

double back_value(const read_back *b, int which, const state *s) {
    const mechanism *m = b->model->mechanisms[0];
    double *input = b->instance->input;
    for (int i = 0; i < REREAD_COORDINATES; i++) {
        for (int primes = 0; primes < 3; primes++) {
            input[3 * i + primes] = s->q[i][primes];
        }
    }
    for (int i = 0; i < REREAD_CONSTANTS; i++) {
        input[3 * REREAD_COORDINATES + i] = s->constant[i];
    }
    valuation known = valuation_new(m, b->instance->arena, b->said);
    known.input = input;
    return expr_value(m->outputs[which]->value, &known);
}

bool is_in_range(const poly *p, double most, state *s) {
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

double poly_here(const quantity *of, const state *at, double *size) {
    state s = *at;
    *size = 0.0;
    for (int i = 0; i < of->poly->count; i++) {
        const poly_term *t = &of->poly->terms[i];
        const poly *part = poly_of_term(of->algebra, t->coefficient, t->mono);
        *size += fabs(poly_evaluate(part, value_here, &s));
    }
    return is_in_range(of->poly, 1e60, &s) ? poly_evaluate(of->poly, value_here, &s) : (double)NAN;
}

int compare(const quantity *q, const char *text, const read_back *b, int which, int right,
            uint64_t *seed) {
    int compared = 0;
    for (int k = 0; k < REREAD_STATES; k++) {
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

void expect_compiles(const char *latex) {
    const char *at;
    const char *problem = latex_problem(latex, &at);
    if (problem != NULL) {
        printf("  %s\n  %s: %.60s\n", latex, problem, at);
    }
    TEST_ASSERT_NULL_MESSAGE(problem, "LaTeX");
}
