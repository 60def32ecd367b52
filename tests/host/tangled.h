/* tangled.h: random mechanisms with several contacts that meet at the same moments: bodies in a row between walls
 * that touch from the start, rub, are coupled and let go. */
#ifndef TESTS_TANGLED_H
#define TESTS_TANGLED_H

#include <stddef.h>
#include <stdint.h>

typedef struct tangle {
    uint64_t seed;  /* same seed, same mechanism */
    uint64_t order; /* of its statements: 0 as drawn, else a permutation */
    int plain;      /* stops alone, without springs and loads: nothing but impacts */
    double step_s;
    double until_s;
} tangle;

/* The text of a mechanism and its scene, with books, into text[size]. Returns its energy scale, J. */
double tangled_text(const tangle *of, char *text, size_t size);

/* How many bodies it has: coordinates x1, x2 ... */
int tangled_bodies(uint64_t seed);

#endif
