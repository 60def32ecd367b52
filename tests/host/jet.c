/* jet.c: see jet.h. */
#include "jet.h"

#include <math.h>

jet jet_number(long double value) { return (jet){.value = value}; }

jet jet_variable(int which, long double value) {
    jet made = {.value = value};
    made.slope[which] = 1.0L;
    return made;
}

jet jet_sum(jet a, jet b) {
    a.value += b.value;
    for (int i = 0; i < JET_VARIABLES; i++) {
        a.slope[i] += b.slope[i];
        for (int j = 0; j < JET_VARIABLES; j++) {
            a.curve[i][j] += b.curve[i][j];
        }
    }
    return a;
}

/* f(a), with f, f' and f'' at a's value. */
static jet chained(jet a, long double f, long double first, long double second) {
    jet made = {.value = f};
    for (int i = 0; i < JET_VARIABLES; i++) {
        made.slope[i] = first * a.slope[i];
        for (int j = 0; j < JET_VARIABLES; j++) {
            made.curve[i][j] = first * a.curve[i][j] + second * a.slope[i] * a.slope[j];
        }
    }
    return made;
}

jet jet_times(long double factor, jet a) { return chained(a, factor * a.value, factor, 0.0L); }

jet jet_product(jet a, jet b) {
    jet made = {.value = a.value * b.value};
    for (int i = 0; i < JET_VARIABLES; i++) {
        made.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
        for (int j = 0; j < JET_VARIABLES; j++) {
            made.curve[i][j] = a.curve[i][j] * b.value + a.value * b.curve[i][j] +
                               a.slope[i] * b.slope[j] + a.slope[j] * b.slope[i];
        }
    }
    return made;
}

jet jet_square(jet a) { return chained(a, a.value * a.value, 2.0L * a.value, 2.0L); }

jet jet_sine(jet a) { return chained(a, sinl(a.value), cosl(a.value), -sinl(a.value)); }

jet jet_cosine(jet a) { return chained(a, cosl(a.value), -sinl(a.value), -cosl(a.value)); }

jet jet_root(jet a) {
    const long double root = sqrtl(a.value);
    return chained(a, root, 0.5L / root, -0.25L / (root * a.value));
}
