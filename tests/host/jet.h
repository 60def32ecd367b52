/* jet.h: numbers with first and second derivatives by all variables, in long double. A Lagrangian's equations need no
 * algebra with them. */
#ifndef TESTS_HOST_JET_H
#define TESTS_HOST_JET_H

enum { JET_VARIABLES = 8, JET_PAIRS = JET_VARIABLES * (JET_VARIABLES + 1) / 2 };

typedef struct jet {
    int variables; /* depends on the first `variables` only: derivatives by later ones are zero */
    long double value;
    long double slope[JET_VARIABLES];
    long double curve[JET_PAIRS]; /* by two variables, the later first: 00, 10, 11, 20, ... */
} jet;

/* Second derivative by the i-th and j-th variable. */
long double jet_curve(const jet *a, int i, int j);

jet jet_number(long double value);
jet jet_variable(int which, long double value);
jet jet_sum(jet a, jet b);
void jet_add(jet *sum, long double factor, const jet *a);
jet jet_times(long double factor, jet a);
jet jet_product(jet a, jet b);
jet jet_square(jet a);
jet jet_sine(jet a);
jet jet_cosine(jet a);
/* `a` is above zero. */
jet jet_root(jet a);

#endif
