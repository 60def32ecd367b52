/* drawn.h: random mechanisms with constant mass matrix and loads, as text. All contacts act at one moment, and trying
 * every case of the contact laws gives the solution. */
#ifndef TESTS_DRAWN_H
#define TESTS_DRAWN_H

#include "motion.h"

#include <stdint.h>

enum { DRAWN_MOST = 4, DRAWN_CONTACTS = 6 };

/* The step of these scenes, s. */
#define DRAWN_STEP_S (1.0 / 1024.0)

typedef struct drawn_contact {
    char kind; /* 's'top, 'h'old, 'f'riction */
    double row[DRAWN_MOST];
    double offset;      /* the gap is row . x - offset, m */
    double restitution; /* of a stop */
    double limit;       /* friction limit, N; static and kinetic friction are equal */
    double target;      /* value of J v+, or J a, while the contact acts */
    /* of a hold: it is active while since . x > since_m, or always if both are zero */
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

/* A body with the integer mass matrix 1 + A^T A and no contacts. */
drawn drawn_body(uint64_t *seed);
double drawn_whole(uint64_t *seed, int least, int most);
/* Adds a contact of this kind. */
drawn_contact *drawn_add(drawn *b, char kind);
/* Draws a nonzero integer row; every third has only one coordinate. */
void drawn_row(const drawn *b, uint64_t *seed, double *row);
void drawn_row_at_rest(const drawn *b, uint64_t *seed, double *row);

/* drawn_along() returns J_k x. drawn_inverse() computes x = M^-1 y. */
double drawn_along(const drawn *b, int k, const double *x);
void drawn_inverse(const drawn *b, const double *y, double *x);

void drawn_open(motion *m, const drawn *b, const engine_kind *kind);

/* Solves for x (rates or accelerations) and lambda in x = from + M^-1 J^T lambda. A hold has J x = target. A stop has
 * lambda >= 0, J x >= target, and equality in one of them. A friction has |lambda| <= limit; at the limit, J x points
 * against it. Returns false if contact rows are linearly dependent. */
bool drawn_solved(const drawn *b, const double *from, double *lambda, double *x);
/* Are the contact rows linearly independent? Only then are the forces unique. */
bool drawn_independent(const drawn *b);

#endif
