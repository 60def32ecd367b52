/* linear.h: random linear mechanisms as text, with their system matrices in 113 bits. The matrices come from the
 * drawn masses and springs, not from the program. */
#ifndef TESTS_HOST_LINEAR_H
#define TESTS_HOST_LINEAR_H

#include "test.h"

__extension__ typedef __float128 quad;

enum { LINEAR_STATES = 8, LINEAR_INPUTS = 2, LINEAR_COLUMNS = LINEAR_STATES + LINEAR_INPUTS + 1 };

/* The system x' = A x + B u + c. x has the coordinates, then their rates. Each row of rate[] has the entries of A,
 * then of B, then of c. */
typedef struct linear {
    int coordinates;
    int states;
    int inputs;
    int columns;
    quad h; /* the step, s */
    quad rate[LINEAR_STATES][LINEAR_COLUMNS];
    double start[LINEAR_STATES];
} linear;

typedef struct linear_kind {
    int stiff;    /* springs and dampers have a factor from 1 to 2^stiff */
    bool coupled; /* the mass matrix is full, and its inverse is not exact in double */
} linear_kind;

/* Draws a mechanism with 1 to 4 coordinates and a scene `s`: masses, springs and dampers between them and to the
 * ground, gravity, up to two inputs. Some masses have no springs or dampers. All numbers are multiples of 1/8, and
 * uncoupled masses are powers of two, so that A, B and c are exact in double. */
void linear_draw(uint64_t *seed, int coordinates, linear_kind kind, char *text, size_t size,
                 linear *made);

/* The rows of exp([A B c; 0 0 0] h), the matrix of one step. If `order` > 0, only the terms of the exponential
 * series up to that order. */
void linear_step(const linear *of, int order, quad step[LINEAR_STATES][LINEAR_COLUMNS]);

void linear_move(const linear *of, quad step[LINEAR_STATES][LINEAR_COLUMNS], const double *input,
                 quad *x);

quad quad_size(quad x);

#endif
