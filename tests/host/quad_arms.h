/* quad_arms.h: planar mechanisms in 113 bits: point masses on arms, with or without a carriage, and spinning discs.
 * D'Alembert's equations are derived by hand and integrated by the extrapolation of Gragg, Bulirsch and Stoer. This
 * reference uses neither the program's energies nor its algebra, operation lists or double parameters. */
#ifndef TESTS_HOST_QUAD_ARMS_H
#define TESTS_HOST_QUAD_ARMS_H

#include <float.h>

#if LDBL_MANT_DIG >= 113
typedef long double quad;
#define QUAD_KNOWN 1
#elif defined __SIZEOF_FLOAT128__
__extension__ typedef __float128 quad;
#define QUAD_KNOWN 1
#else
typedef long double quad; /* too few bits: QUAD_KNOWN is undefined, and there is no reference */
#endif

enum { QUAD_COORDINATES = 3, QUAD_BODIES = 3, QUAD_ARMS = 3 };

/* An arm is the vector length (cos(multiple q), sin(multiple q)). */
typedef struct quad_arm {
    quad length_m;
    int multiple;
    int coordinate;
} quad_arm;

/* A mass at the end of a chain of arms. The first arm starts at the carriage. */
typedef struct quad_body {
    quad mass_kg;
    int arms;
    quad_arm arm[QUAD_ARMS];
} quad_body;

typedef struct quad_arms {
    int coordinates; /* number of coordinates; the carriage is the last one */
    int carriage;    /* number of the coordinate that moves all bodies along x; -1: no carriage */
    int bodies;
    quad_body body[QUAD_BODIES];
    quad spin_kgm2[QUAD_COORDINATES]; /* the kinetic energy has the terms spin/2 q'^2 */
    quad load[QUAD_COORDINATES];
    quad gravity_mps2; /* gravity acts along x */
} quad_arms;

quad quad_sine(quad rad);
quad quad_cosine(quad rad);

/* Computes the slopes to[states] of a system at state[states]. */
typedef void quad_slopes(const void *of, const quad *state, quad *to);
enum { QUAD_STATES = 8 };
/* Integrates any system of up to QUAD_STATES states over span_s. */
void quad_follow(quad_slopes *slopes, const void *of, int states, quad span_s, quad *state);

/* The slopes of a quad_arms. The state is q0, q0', q1, q1', ... */
quad_slopes quad_arms_slopes;

#endif
