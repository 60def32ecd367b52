/* motion.h: a built-in scene, stepped inside the test: what the accuracy suites share.
 *
 * Everything in a motion is SI; angles are unwrapped radians. A scene or a name that does not exist
 * fails the running test. */
#ifndef TESTS_MOTION_H
#define TESTS_MOTION_H

#include "host/derive/image_make.h"
#include "host/engine/engine.h"

typedef struct motion {
    diags *errors;
    whirl_model *model;
    instance *instance;
    equations *equations;
    image *image;
    const engine_kind *kind;
    void *run;
} motion;

/* How a scene is to be stepped. */
typedef struct stepping {
    const engine_kind *kind;
    wh_method method;
    bool compensated;
    double step_s;     /* 0: the scene's own. A double; the float engine rounds it once more */
    const char *set;   /* a parameter or an input, "M=1.5", or NULL */
    const char *start; /* a coordinate or a rate, "theta'=3", or NULL */
    bool ledger;       /* keep the books */
    bool stabilized;   /* and give back what the energy drifts by */
    image_angles angles;
    image_matrix_of matrix;
} stepping;

/* RK4 with the scene's own step, or with another. */
#define IN_DOUBLE ((stepping){.kind = &engine_double, .method = WH_RK4})
#define IN_DOUBLE_STEP(h) ((stepping){.kind = &engine_double, .method = WH_RK4, .step_s = (h)})
#define IN_FLOAT ((stepping){.kind = &engine_float, .method = WH_RK4})
#define IN_FLOAT_STEP(h) ((stepping){.kind = &engine_float, .method = WH_RK4, .step_s = (h)})
#define IN_FLOAT_COMPENSATED \
    ((stepping){.kind = &engine_float, .method = WH_RK4, .compensated = true})
#define IN_FLOAT_COMPENSATED_STEP(h) \
    ((stepping){.kind = &engine_float, .method = WH_RK4, .compensated = true, .step_s = (h)})

/* Start the scene of a built-in model. Close it with motion_close(). */
void motion_open(motion *m, const char *scene, stepping how);
/* The same for a model's text: its first scene. */
void motion_open_text(motion *m, const char *text, stepping how);
/* The same for a built-in file, "epicyclic.whirl", with more text behind it: the last scene. */
void motion_open_more(motion *m, const char *file, const char *more, stepping how);
/* The same for a file, "docs/hard/rotor.whirl", with more text behind it, or "": the scene of that name. */
void motion_open_file(motion *m, const char *path, const char *more, const char *scene,
                      stepping how);
void motion_close(motion *m);

/* Do `steps` more steps; the status of the last, and no further one after a failure. */
wh_status motion_step(motion *m, uint64_t steps);
/* Go on to `time_s`, a whole number of steps; a step that fails fails the test. */
void motion_to(motion *m, double time_s);

/* "theta1", "theta1'" or the name of an output. */
double motion_value(const motion *m, const char *name);

/* Kinetic energy of Thomson's device with set A, written down by hand: m = 2 kg, r = 0.3 m, M = -2 N m. */
double thomson_kinetic_J(const motion *m);

/* Largest difference between `m` and the state in tests/reference/trajectory.txt of `scene` at
 * `time` (as written there), over all coordinates and rates; absolute, and relative to the largest
 * entry of the reference. */
double motion_error(const motion *m, const char *scene, const char *time);
double motion_relative_error(const motion *m, const char *scene, const char *time);

#endif
