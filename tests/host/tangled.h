/* tangled.h: random mechanisms with several simultaneous contacts: bodies in a row between walls. They touch from the
 * start, rub, and are coupled and released. */
#ifndef TESTS_TANGLED_H
#define TESTS_TANGLED_H

#include "test.h"

typedef struct tangle {
    uint64_t seed;  /* same seed, same mechanism */
    uint64_t order; /* order of its statements: 0: as generated, else a seed of a permutation */
    int plain;      /* only impacts: stops without springs and loads */
    double step_s;
    double until_s;
} tangle;

/* Writes a mechanism and its scene with energy balance to text[size]. Returns its energy scale, J. */
double tangled_text(const tangle *of, char *text, size_t size);

/* Number of bodies, with coordinates x1, x2 ... */
int tangled_bodies(uint64_t seed);

#endif
