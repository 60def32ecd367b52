/* quad_arms.h: plane mechanisms of point masses on arms, perhaps on a carriage, and discs that spin, in numbers of 113 bits:
 * d'Alembert's equations by hand and the extrapolation of Gragg, Bulirsch and Stoer, for references that share nothing
 * with the program: no energies, no algebra, no list, no parameter that is a double. */
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
typedef long double quad; /* no reference: QUAD_KNOWN is not defined */
#endif

enum { QUAD_COORDINATES = 3, QUAD_BODIES = 3, QUAD_ARMS = 3 };

/* length (cos(multiple q), sin(multiple q)) */
typedef struct quad_arm {
    quad length_m;
    int multiple;
    int coordinate;
} quad_arm;

/* A mass at the end of its arms, the first of which is at the carriage. */
typedef struct quad_body {
    quad mass_kg;
    int arms;
    quad_arm arm[QUAD_ARMS];
} quad_body;

typedef struct quad_arms {
    int coordinates; /* angles first */
    int carriage;    /* the coordinate along x that all bodies move with; -1: none */
    int bodies;
    quad_body body[QUAD_BODIES];
    quad spin_kgm2[QUAD_COORDINATES]; /* spin/2 q'^2 of the kinetic energy */
    quad load[QUAD_COORDINATES];
    quad gravity_mps2; /* along x */
} quad_arms;

quad quad_sine(quad rad);
quad quad_cosine(quad rad);

/* to[states] = the slopes at state[states] */
typedef void quad_slopes(const void *of, const quad *state, quad *to);
enum { QUAD_STATES = 8 };
/* Any system on by span_s. */
void quad_follow(quad_slopes *slopes, const void *of, int states, quad span_s, quad *state);

/* Of arms: state[2 * coordinates] are q0, q0', q1, q1', ... */
quad_slopes quad_arms_slopes;

#endif
