/* linkage.h: random planar linkages: bodies on hinges and rails, with springs, dampers, drives and gravity. As text,
 * and with accelerations from the energies in numbers (linkage_lagrange.c). */
#ifndef TESTS_HOST_LINKAGE_H
#define TESTS_HOST_LINKAGE_H

#include "test.h"

enum { LINKAGE_BODIES = 4, LINKAGE_SPRINGS = 2, LINKAGE_TEXT = 16384 };

/* A body's coordinate is that of its joint: the angle of a hinge or the displacement along a rail. */
typedef struct linkage_body {
    int parent;      /* an earlier body; -1: the ground */
    bool slides;     /* on a rail of its parent, without rotation relative to it */
    bool relative;   /* a hinge's angle counts from the parent's direction, not from the x axis */
    double at_m;     /* position of the joint along its parent's direction */
    double rail_rad; /* direction of the rail and the body relative to its parent */
    double mass_kg;  /* the centre of mass is centre_m from the joint along the body's direction */
    double centre_m;
    double inertia_kgm2; /* about the centre */
    double stiffness;    /* of a spring at the joint that is relaxed at zero, N m/rad or N/m */
    double rest;
    double damping; /* of the joint, N m s/rad or N s/m */
    double drive;   /* force or torque on the coordinate, drive cos(wave q), N m or N */
    double wave;    /* 1, 2, ...; per metre on a rail */
    /* drag on the body's end, 2 centre_m from the joint; loss function drag/2 v^2 */
    double drag_Nspm;
} linkage_body;

/* A spring from a body's end, 2 centre_m from its joint, to a point of the ground. */
typedef struct linkage_spring {
    int body;
    double x_m, y_m;
    double stiffness_Npm;
    double length_m; /* relaxed length; zero: the force is proportional to the distance */
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

/* Every body has mass and inertia, so the mass matrix is positive definite. */
linkage linkage_draw(uint64_t *seed);

typedef enum linkage_forces {
    LINKAGE_BARE,   /* no drives, dampers and springs */
    LINKAGE_INSIDE, /* they are statements of the mechanism */
    /* each kind of force is an effect, and the scene switches all of them off */
    LINKAGE_EFFECTS_OFF,
    LINKAGE_EFFECTS_ON /* each kind is an effect, and the scene switches all of them on */
} linkage_forces;

typedef struct linkage_writing {
    linkage_forces forces;
    bool backwards;   /* coordinates and terms are written in reverse order */
    double until_s;   /* end time of the scene, which takes 500 steps; 0: half a second */
    const char *more; /* further statements; may use q0, q0', ... and ey0, an end's height */
} linkage_writing;

/* A mechanism `name` with a scene `name_moves`. Coordinates are q0, q1, ... */
void linkage_write(const linkage *of, const char *name, linkage_writing how,
                   char text[static LINKAGE_TEXT]);

/* Numbers at a state, in long double: M q'' = force, from numeric derivatives of the energies. For the height y of each
 * body's end: y' = row . q' and y'' = row . q'' + bend. */
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

/* Solves M x = y. Returns the least part of a diagonal entry of M that remains after elimination. Each factor of 0.1
 * loses one digit of the solution. */
long double linkage_solve(const linkage *of, const linkage_numbers *at, const long double *y,
                          long double *x);

typedef struct linkage_motion {
    long double state[2 * LINKAGE_BODIES];
    long double least; /* the least result of linkage_solve() during the motion */
} linkage_motion;
/* The state after `steps` steps of Runge-Kutta 4 in long double. */
void linkage_integrate(const linkage *of, double step_s, int steps, linkage_motion *end);

#endif
