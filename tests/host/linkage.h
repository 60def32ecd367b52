/* linkage.h: random planar linkages: bodies on hinges and rails, with springs, dampers, drives and gravity. They are
 * written as text. Their reference accelerations come from the energies in numbers (linkage_lagrange.c). */
#ifndef TESTS_HOST_LINKAGE_H
#define TESTS_HOST_LINKAGE_H

#include "test.h"

enum { LINKAGE_BODIES = 4, LINKAGE_SPRINGS = 2, LINKAGE_TEXT = 16384 };

/* A body and its joint. The body's coordinate is the angle of its hinge or the displacement along its rail. */
typedef struct linkage_body {
    int parent; /* number of an earlier body; -1: the ground */
    /* the joint is a rail fixed to the parent, on which the body does not rotate */
    bool slides;
    /* the hinge's angle counts from the parent's direction instead of the x axis */
    bool relative;
    double at_m;     /* position of the joint along the parent's direction */
    double rail_rad; /* angle from the parent's direction to the rail and the body */
    double mass_kg;  /* the centre of mass is centre_m from the joint, along the body */
    double centre_m;
    double inertia_kgm2; /* moment of inertia about the centre of mass */
    /* stiffness of a spring at the joint, relaxed at coordinate zero, N m/rad or N/m */
    double stiffness;
    double rest;
    double damping; /* damping at the joint, N m s/rad or N s/m */
    double drive;   /* amplitude of the force or torque drive cos(wave q), N m or N */
    double wave;    /* 1, 2, ... per rad of a hinge or per metre of a rail */
    /* drag coefficient at the body's end, which is 2 centre_m from the joint; loss function drag/2 v^2 */
    double drag_Nspm;
} linkage_body;

/* A spring between a body's end, which is 2 centre_m from its joint, and the fixed point (x_m, y_m). */
typedef struct linkage_spring {
    int body;
    double x_m, y_m;
    double stiffness_Npm;
    double length_m; /* relaxed length; zero: the force is proportional to the spring's length */
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

/* Draws a linkage. Every body has mass and inertia, so the mass matrix is positive definite. */
linkage linkage_draw(uint64_t *seed);

typedef enum linkage_forces {
    LINKAGE_BARE,   /* there are no drives, dampers and springs */
    LINKAGE_INSIDE, /* forces are statements of the mechanism */
    /* each kind of force is an effect; the scene switches all effects off */
    LINKAGE_EFFECTS_OFF,
    LINKAGE_EFFECTS_ON /* each kind of force is an effect; the scene switches all on */
} linkage_forces;

typedef struct linkage_writing {
    linkage_forces forces;
    bool backwards;   /* coordinates and terms are written in reverse */
    double until_s;   /* time of the scene's end; 0: half a second. The scene has 500 steps. */
    const char *more; /* further statements; may use q0, q0', ... and ey0, ..., the ends' heights */
} linkage_writing;

/* Writes a mechanism `name` with a scene `name_moves`. The coordinates are q0, q1, ... */
void linkage_write(const linkage *of, const char *name, linkage_writing how,
                   char text[static LINKAGE_TEXT]);

/* The equations M q'' = force at one state, in long double, from numeric derivatives of the energies. The height y
 * of each body's end has the derivatives y' = row . q' and y'' = row . q'' + bend. */
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

/* Solves M x = y by elimination. Returns the smallest ratio of a pivot to the original diagonal entry. Each factor
 * of 0.1 in this ratio costs one digit of the solution. */
long double linkage_solve(const linkage *of, const linkage_numbers *at, const long double *y,
                          long double *x);

typedef struct linkage_motion {
    long double state[2 * LINKAGE_BODIES];
    long double least; /* smallest result of linkage_solve() during the motion */
} linkage_motion;
/* Computes the state after `steps` steps of Runge-Kutta 4, in long double. */
void linkage_integrate(const linkage *of, double step_s, int steps, linkage_motion *end);

#endif
