/* drawn.h: random mechanisms with a constant mass matrix and constant loads, as text. All contacts act at the same
 * moment. The expected solution comes from trying every combination of the cases of the contact laws. */
#ifndef TESTS_DRAWN_H
#define TESTS_DRAWN_H

#include "motion.h"

#include <stdint.h>

enum { DRAWN_MOST = 4, DRAWN_CONTACTS = 6 };

#define DRAWN_STEP_S (1.0 / 1024.0)

typedef struct drawn_contact {
    char kind; /* 's' for a stop, 'h' for a hold, 'f' for a friction */
    double row[DRAWN_MOST];
    double offset;      /* the gap in metres is row . x - offset */
    double restitution; /* of a stop, from 0 to 1 */
    double limit;       /* friction limit, N; static and kinetic friction are equal */
    double target;      /* rate (impact) or acceleration (load) that an active contact must have */
    /* only for a hold: the hold acts while since . x > since_m, or always if `since` and since_m are zero */
    double since[DRAWN_MOST];
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

/* Draws a body with the integer mass matrix 1 + A^T A, without contacts. */
drawn drawn_body(uint64_t *seed);
double drawn_whole(uint64_t *seed, int least, int most);
drawn_contact *drawn_add(drawn *b, char kind);
/* Draws a nonzero integer row. Every third row has only one coordinate. */
void drawn_row(const drawn *b, uint64_t *seed, double *row);
void drawn_row_at_rest(const drawn *b, uint64_t *seed, double *row);

/* drawn_along() returns J_k x, with row k of J. drawn_inverse() computes x = M^-1 y. */
double drawn_along(const drawn *b, int k, const double *x);
void drawn_inverse(const drawn *b, const double *y, double *x);

void drawn_open(motion *m, const drawn *b, const engine_kind *kind);

/* Solves x = from + M^-1 J^T lambda for x (rates or accelerations) and lambda, with these conditions:
 * - a hold: J x = target;
 * - a stop: lambda >= 0 and J x >= target, with equality in one of the two;
 * - a friction: |lambda| <= limit; if |lambda| is at the limit, J x - target has the opposite sign.
 * Returns false if the contact rows are linearly dependent. */
bool drawn_solved(const drawn *b, const double *from, double *lambda, double *x);
/* Are the contact rows linearly independent? Only then are the forces unique. */
bool drawn_independent(const drawn *b);

#endif
