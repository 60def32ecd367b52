/* naive_sines.h: the sines and cosines of Thomson's device. */
#ifndef TESTS_NAIVE_SINES_H
#define TESTS_NAIVE_SINES_H

/* Sines and cosines of theta1 (a), theta2 (b), 2a, a - b and 2a - b. */
typedef struct sines {
    double sin_a, cos_a, sin_b, cos_b, sin_2a, cos_2a, sin_a_b, cos_a_b, sin_2a_b, cos_2a_b;
} sines;

#endif
