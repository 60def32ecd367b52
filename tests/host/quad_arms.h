/* quad_arms.h: planar mechanisms of point masses on arms, perhaps on a carriage, and spinning discs, in 113 bits.
 * D'Alembert's equations are derived by hand and integrated by the extrapolation of Gragg, Bulirsch and Stoer. The
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
typedef long double quad; /* without 113 bits there is no reference: QUAD_KNOWN is undefined */
#endif

enum { QUAD_COORDINATES = 3, QUAD_BODIES = 3, QUAD_ARMS = 3 };

/* the arm is the vector length (cos(multiple q), sin(multiple q)) */
typedef struct quad_arm {
    quad length_m;
    int multiple;
    int coordinate;
} quad_arm;

/* A mass at the end of its arms, the first of which starts at the carriage. */
typedef struct quad_body {
    quad mass_kg;
    int arms;
    quad_arm arm[QUAD_ARMS];
} quad_body;

typedef struct quad_arms {
    int coordinates; /* angles first */
    int carriage;    /* coordinate of all bodies along x; -1: no carriage */
    int bodies;
    quad_body body[QUAD_BODIES];
    quad spin_kgm2[QUAD_COORDINATES]; /* spin/2 q'^2 of the kinetic energy */
    quad load[QUAD_COORDINATES];
    quad gravity_mps2; /* along x */
} quad_arms;

quad quad_sine(quad rad);
quad quad_cosine(quad rad);

/* Computes the slopes to[states] at state[states]. */
typedef void quad_slopes(const void *of, const quad *state, quad *to);
enum { QUAD_STATES = 8 };
/* Integrates any system over span_s. */
void quad_follow(quad_slopes *slopes, const void *of, int states, quad span_s, quad *state);

/* Slopes of arms: state[2 * coordinates] are q0, q0', q1, q1', ... */
quad_slopes quad_arms_slopes;

#endif
