/* drawn.h: random mechanisms with a constant mass matrix and constant loads, whose contacts act at one moment: as texts,
 * and what the laws of contacts make of them, found by trying every case. */
#ifndef TESTS_DRAWN_H
#define TESTS_DRAWN_H

#include "motion.h"

#include <stdint.h>

enum { DRAWN_MOST = 4, DRAWN_CONTACTS = 6 };

/* The step of their scenes, s. */
#define DRAWN_STEP_S (1.0 / 1024.0)

typedef struct drawn_contact {
    char kind; /* 's'top, 'h'old, 'f'riction */
    double row[DRAWN_MOST];
    double offset;            /* the gap is row . x - offset, m */
    double restitution;       /* of a stop */
    double limit;             /* N, of a friction; it slides with the same force */
    double target;            /* what J v+, or J a, is where it holds */
    double since[DRAWN_MOST]; /* of a hold: while since . x > since_m; all zero: always */
    double since_m;
} drawn_contact;

typedef struct drawn {
    int n;
    int contacts;
    double mass[DRAWN_MOST][DRAWN_MOST];
    double load[DRAWN_MOST];
    double rate[DRAWN_MOST];
    drawn_contact contact[DRAWN_CONTACTS];
} drawn;

/* With a mass matrix 1 + A^T A of whole numbers, and nothing else yet. */
drawn drawn_body(uint64_t *seed);
double drawn_whole(uint64_t *seed, int least, int most);
/* One more contact, of this kind. */
drawn_contact *drawn_add(drawn *b, char kind);
/* A row of whole numbers that is not zero; every third has one coordinate. */
void drawn_row(const drawn *b, uint64_t *seed, double *row);
/* One that the rates are at right angles to, exactly. */
void drawn_row_at_rest(const drawn *b, uint64_t *seed, double *row);

/* J_k x; M^-1 y. */
double drawn_along(const drawn *b, int k, const double *x);
void drawn_inverse(const drawn *b, const double *y, double *x);

/* Start its scene, with books. */
void drawn_open(motion *m, const drawn *b, const engine_kind *kind);

/* With each contact's limits and targets, the x (rates, or accelerations) that follows from x = from + M^-1 J^T lambda,
 * and lambda: a hold's J x is its target; a stop's lambda is not below zero, nor J x below its target, and one
 * of both is there; a friction's lambda is within its limit, and where it is at it, J x is on the other side of zero.
 * False where there is none without rows that repeat each other. */
bool drawn_solved(const drawn *b, const double *from, double *lambda, double *x);
/* Are the contacts' rows independent, so that each one's own force is determined? */
bool drawn_independent(const drawn *b);

#endif
