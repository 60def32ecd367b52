/* tangled.h: random mechanisms with several contacts that act at the same time: bodies in a row between walls, which
 * may touch from the start, rub, and be coupled and released. */
#ifndef TESTS_TANGLED_H
#define TESTS_TANGLED_H

#include "test.h"

typedef struct tangle {
    uint64_t seed;  /* the same seed gives the same mechanism */
    uint64_t order; /* 0: the statements are not shuffled; else the seed of the permutation */
    int plain;      /* impacts only: stops without springs and loads */
    double step_s;
    double until_s;
} tangle;

/* Writes a mechanism and its scene, with energy balance, to text[size]. Returns the scale of its energy in J. */
double tangled_text(const tangle *of, char *text, size_t size);

/* Number of bodies. Their coordinates are x1, x2, ... */
int tangled_bodies(uint64_t seed);

#endif
