/* test_emit.c: printed equations are read back and must equal the derived ones. Short equations must look as in a
 * textbook, and LaTeX must be well-formed. */
#include "formula.h"
#include "printed.h"
#include "test.h"

enum { STATES = 10 };

/* The printed text, in which value_of_name() looks up the values of lets. */
static const char *whole_text;

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
    /* the name of a let, whose formula is printed below "with" */
    char label[80];
    snprintf(label, sizeof label, "\n  %.*s = ", length, name);
    const char *at = strstr(whole_text, label);
    const char *end;
    return at == NULL ? (double)NAN
                      : formula_value(at + strlen(label), &end, value_of_name, context);
}

/* The value of the formula after `label` at the beginning of a line; NaN without such a line. */
static double labelled(const char *text, const char *label, state_values *s) {
    const char *at = strstr(text, label);
    const char *end;
    return at == NULL ? (double)NAN : formula_value(at + strlen(label), &end, value_of_name, s);
}

/* Checks the first-order form: the closed formulas must satisfy the equations; without them, the printed A and b
 * must be right. */
static void check_first_order(const char *name, derived *d) {
    const equations *e = d->equations;
    char *text = printed(d, TEXT);
    whole_text = text;
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

TEST(emit, first_order_form_solves_the_equations) { each_mechanism(check_first_order); }

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

TEST(emit, short_equations_look_as_in_the_dissertation) {
    expect_lines("spherical_particle",
                 (const char *const[]){
                     "  r:  m*r'' - m*r*theta'^2 - m*r*sin(theta)^2*phi'^2 + m*g*cos(theta) = 0\n",
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
                                  "  X:  2*m*X'' - 2*m*r*sin(theta)*theta'' - "
                                  "2*m*r*cos(theta)*theta'^2 = 0\n",
                                  NULL});
    expect_lines("driven_hinge",
                 (const char *const[]){
                     "  theta1:  m*r^2*theta1'' + m*r^2*cos(theta1 - theta2)*theta2'' + "
                     "m*r^2*sin(theta1 - theta2)*theta2'^2 = M\n",
                     "  theta2:  (I + m*r^2)*theta2'' + m*r^2*cos(theta1 - theta2)*theta1'' - "
                     "m*r^2*sin(theta1 - theta2)*theta1'^2 = 0\n",
                     NULL});
}

TEST(emit, names_in_latex) {
    derived d =
        derived_text("mechanism m\ncoordinate phi_1_a [m]\ncoordinate _odd [m]\n"
                     "parameter mass_of_it = 2 [kg]\n"
                     "T = mass_of_it*(phi_1_a'^2 + _odd'^2)/2\nV = 1.5e-7 [N/m]*phi_1_a^2/2\n");
    TEST_ASSERT_NOT_NULL(d.image);
    char *text = printed(&d, LATEX);
    TEST_ASSERT_NOT_NULL(
        strstr(text, "\\mathrm{mass}_{\\mathrm{of\\_it}} \\, \\ddot{\\phi}_{1\\_a}"));
    TEST_ASSERT_NOT_NULL(
        strstr(text, "\\mathrm{mass}_{\\mathrm{of\\_it}} \\, \\ddot{\\mathrm{\\_odd}}"));
    TEST_ASSERT_NOT_NULL(strstr(text, "1.5 \\cdot 10^{-7}"));
    free(text);
    derived_free(&d);
}
