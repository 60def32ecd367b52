#include "jet.h"

#include <math.h>

static int most(int a, int b) { return a > b ? a : b; }

static int pairs(int variables) { return variables * (variables + 1) / 2; }

long double jet_curve(const jet *a, int i, int j) {
    return i >= j ? a->curve[i * (i + 1) / 2 + j] : a->curve[j * (j + 1) / 2 + i];
}

jet jet_number(long double value) { return (jet){.value = value}; }

jet jet_variable(int which, long double value) {
    jet made = {.variables = which + 1, .value = value};
    made.slope[which] = 1.0L;
    return made;
}

void jet_add(jet *sum, long double factor, const jet *a) {
    sum->variables = most(sum->variables, a->variables);
    sum->value += factor * a->value;
    for (int i = 0; i < a->variables; i++) {
        sum->slope[i] += factor * a->slope[i];
    }
    for (int k = 0; k < pairs(a->variables); k++) {
        sum->curve[k] += factor * a->curve[k];
    }
}

jet jet_sum(jet a, jet b) {
    jet_add(&a, 1.0L, &b);
    return a;
}

/* f(a) by the chain rule, from f, f' and f'' at a's value. */
static jet chained(const jet *a, long double f, long double first, long double second) {
    jet made = {.variables = a->variables, .value = f};
    for (int i = 0, k = 0; i < a->variables; i++) {
        made.slope[i] = first * a->slope[i];
        for (int j = 0; j <= i; j++, k++) {
            made.curve[k] = first * a->curve[k] + second * a->slope[i] * a->slope[j];
        }
    }
    return made;
}

jet jet_times(long double factor, jet a) { return chained(&a, factor * a.value, factor, 0.0L); }

jet jet_product(jet a, jet b) {
    jet made = {.variables = most(a.variables, b.variables), .value = a.value * b.value};
    for (int i = 0, k = 0; i < made.variables; i++) {
        made.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
        for (int j = 0; j <= i; j++, k++) {
            made.curve[k] = a.curve[k] * b.value + a.value * b.curve[k] + a.slope[i] * b.slope[j] +
                            a.slope[j] * b.slope[i];
        }
    }
    return made;
}

jet jet_square(jet a) { return chained(&a, a.value * a.value, 2.0L * a.value, 2.0L); }

jet jet_sine(jet a) { return chained(&a, sinl(a.value), cosl(a.value), -sinl(a.value)); }

jet jet_cosine(jet a) { return chained(&a, cosl(a.value), -sinl(a.value), -cosl(a.value)); }

jet jet_root(jet a) {
    const long double root = sqrtl(a.value);
    return chained(&a, root, 0.5L / root, -0.25L / (root * a.value));
}
