/* linear.h: linear mechanisms as text and, beside it, their matrices in 113 bits, written down by the test itself:
 * nothing of the program computes them. */
#ifndef TESTS_HOST_LINEAR_H
#define TESTS_HOST_LINEAR_H

#include <stddef.h>
#include <stdint.h>

__extension__ typedef __float128 quad;

enum { LINEAR_STATES = 8, LINEAR_INPUTS = 2, LINEAR_COLUMNS = LINEAR_STATES + LINEAR_INPUTS + 1 };

/* x' = A x + B u + c: coordinates, then their rates; the columns of B behind those of A, c behind both. */
typedef struct linear {
    int coordinates;
    int states;
    int inputs;
    int columns;
    quad h; /* a step, s */
    quad rate[LINEAR_STATES][LINEAR_COLUMNS];
    double start[LINEAR_STATES];
} linear;

/* How a mechanism is drawn. */
typedef struct linear_kind {
    int stiff; /* springs and dampers up to 2^stiff times as strong */
    bool
        coupled; /* masses that move together: the mass matrix is full, and its inverse no double */
} linear_kind;

/* A mechanism with a scene `s`, of `coordinates` 1 to 4: masses, springs and dampers between them and to the ground, some with
 * neither, gravity, up to two inputs. Numbers are multiples of 1/8, masses that are not coupled powers of two, so that A, B and
 * c are doubles. */
void linear_draw(uint64_t *seed, int coordinates, linear_kind kind, char *text, size_t size,
                 linear *made);

/* One step: exp([A B c; 0 0 0] h), or the first terms of its series up to `order` > 0; rows of the states. */
void linear_step(const linear *of, int order, quad step[LINEAR_STATES][LINEAR_COLUMNS]);

/* x moved on by such a step. */
void linear_move(const linear *of, quad step[LINEAR_STATES][LINEAR_COLUMNS], const double *input,
                 quad *x);

quad quad_size(quad x);

#endif
