/* linear.h: linear mechanisms as text, with their matrices in 113 bits. The matrices are computed from the drawn masses
 * and springs, not by the program. */
#ifndef TESTS_HOST_LINEAR_H
#define TESTS_HOST_LINEAR_H

#include "test.h"

__extension__ typedef __float128 quad;

enum { LINEAR_STATES = 8, LINEAR_INPUTS = 2, LINEAR_COLUMNS = LINEAR_STATES + LINEAR_INPUTS + 1 };

/* x' = A x + B u + c. x has the coordinates, then their rates. The columns are A's, B's, then c. */
typedef struct linear {
    int coordinates;
    int states;
    int inputs;
    int columns;
    quad h; /* a step, s */
    quad rate[LINEAR_STATES][LINEAR_COLUMNS];
    double start[LINEAR_STATES];
} linear;

typedef struct linear_kind {
    int stiff;    /* springs and dampers up to 2^stiff times stronger */
    bool coupled; /* coupled masses: full mass matrix, whose inverse is not exact in double */
} linear_kind;

/* A mechanism of 1 to 4 `coordinates` with a scene `s`: masses, springs and dampers between them and to the ground,
 * gravity, up to two inputs. Some masses have no springs or dampers. Numbers are multiples of 1/8 and uncoupled masses
 * powers of two, so that A, B and c are doubles. */
void linear_draw(uint64_t *seed, int coordinates, linear_kind kind, char *text, size_t size,
                 linear *made);

/* Rows of a step's matrix exp([A B c; 0 0 0] h), or the first terms of its series up to `order` > 0. */
void linear_step(const linear *of, int order, quad step[LINEAR_STATES][LINEAR_COLUMNS]);

void linear_move(const linear *of, quad step[LINEAR_STATES][LINEAR_COLUMNS], const double *input,
                 quad *x);

quad quad_size(quad x);

#endif
