/* linkage.h: random planar linkages: bodies that hang on each other or on the ground by hinges and on rails, with springs,
 * dampers, drives and gravity; as texts, and their accelerations from the energies in numbers alone (jet.h). */
#ifndef TESTS_HOST_LINKAGE_H
#define TESTS_HOST_LINKAGE_H

#include <stdbool.h>
#include <stdint.h>

enum { LINKAGE_BODIES = 4, LINKAGE_SPRINGS = 2, LINKAGE_TEXT = 16384 };

/* A body's coordinate is its joint's: the angle of a hinge, or the way along a rail. */
typedef struct linkage_body {
    int parent;      /* a body before it; -1: the ground */
    bool slides;     /* on a rail of its parent, without turning against it */
    bool relative;   /* a hinge's angle is from the parent's direction, not from the x axis */
    double at_m;     /* of the joint, along its parent's direction */
    double rail_rad; /* the rail's direction, and the body's, from its parent's */
    double mass_kg;  /* its centre lies centre_m from the joint along its direction */
    double centre_m;
    double inertia_kgm2; /* about the centre */
    double stiffness;    /* of a spring at the joint, relaxed at rest, N m/rad or N/m */
    double rest;
    double damping;   /* of the joint, N m s/rad or N s/m */
    double drive;     /* force or torque on the coordinate, drive cos(wave q), N m or N */
    double wave;      /* 1, 2, ...; per metre on a rail */
    double drag_Nspm; /* on the end that lies 2 centre_m away: drag/2 v^2 */
} linkage_body;

/* From the end of a body, 2 centre_m from its joint, to a point of the ground. */
typedef struct linkage_spring {
    int body;
    double x_m, y_m;
    double stiffness_Npm;
    double length_m; /* without force; zero: it pulls in proportion */
} linkage_spring;

typedef struct linkage {
    int bodies;
    int springs;
    double gravity_mps2[2];
    linkage_body body[LINKAGE_BODIES];
    linkage_spring spring[LINKAGE_SPRINGS];
    double start[LINKAGE_BODIES];
    double start_rate[LINKAGE_BODIES];
} linkage;

/* Every joint has a body with mass and inertia, so that its mass matrix is positive definite. */
linkage linkage_draw(uint64_t *seed);
/* The same with y for -y: angles and torques turn their signs, ways along rails stay. */
linkage linkage_mirrored(const linkage *of);

/* Springs, damping, drag and drives. */
typedef enum linkage_forces {
    LINKAGE_BARE,        /* left out */
    LINKAGE_INSIDE,      /* in the mechanism */
    LINKAGE_EFFECTS_OFF, /* each kind an effect, and the scene has none of them */
    LINKAGE_EFFECTS_ON   /* and the scene has them all */
} linkage_forces;

/* How a text is to be written. */
typedef struct linkage_writing {
    linkage_forces forces;
    bool backwards; /* coordinates and terms in the other order */
    double until_s; /* of the scene, which takes 500 steps; 0: half a second */
    const char *
        more; /* statements behind the others, which may name q0, q0', ..., and ey0, how high an end is */
} linkage_writing;

/* A mechanism `name` with a scene `name_moves`. Coordinates are q0, q1, ... */
void linkage_write(const linkage *of, const char *name, linkage_writing how,
                   char text[static LINKAGE_TEXT]);

/* At a state: M q'' = force, by the derivatives of the energies in numbers, in long double. And of each body's end how
 * high it is, y, with y' = row . q' and y'' = row . q'' + bend. */
typedef struct linkage_numbers {
    long double mass[LINKAGE_BODIES][LINKAGE_BODIES];
    long double force[LINKAGE_BODIES];
    struct {
        long double y_m;
        long double row[LINKAGE_BODIES];
        long double bend_mps2;
    } end[LINKAGE_BODIES];
} linkage_numbers;
void linkage_evaluate(const linkage *of, const long double *q, const long double *rate,
                      linkage_numbers *at);

/* Solve M x = y. Returns the least share of a diagonal entry of M that elimination leaves of it: a digit of the solution
 * is lost for each tenth. */
long double linkage_solve(const linkage *of, const linkage_numbers *at, const long double *y,
                          long double *x);

/* Values, then rates. */
typedef struct linkage_motion {
    long double state[2 * LINKAGE_BODIES];
    long double least; /* what linkage_solve returned, the least on the way */
} linkage_motion;
/* The state after so many steps from the start: Runge-Kutta 4 in long double. */
void linkage_integrate(const linkage *of, double step_s, int steps, linkage_motion *end);

#endif
