/* motion.h: scenes that are stepped inside a test, for the accuracy suites.
 *
 * All quantities are in SI units; angles are in radians and not reduced to one turn. An unknown scene or name fails
 * the test. */
#ifndef TESTS_MOTION_H
#define TESTS_MOTION_H

#include "test.h"

#include "host/engine/engine.h"
#include "host/image/image_make.h"

typedef struct motion {
    diags *errors;
    whirl_model *model;
    instance *instance;
    equations *equations;
    image *image;
    const engine_kind *kind;
    void *run;
} motion;

typedef struct stepping {
    const engine_kind *kind;
    wh_method method;
    bool compensated;
    /* 0: the scene's own step. The float engine rounds step_s to float. */
    double step_s;
    const char *set;   /* a parameter or an input, such as "M=1.5", or NULL */
    const char *start; /* a coordinate or a rate, such as "theta'=3", or NULL */
    bool ledger;       /* runs with the energy balance */
    bool stabilized;   /* runs with --stabilized */
    image_angles angles;
    image_matrix_of matrix;
} stepping;

/* RK4 in double or float. The macros with _STEP take a step in seconds; the others use the scene's own step. */
#define IN_DOUBLE ((stepping){.kind = &engine_double, .method = WH_RK4})
#define IN_DOUBLE_STEP(h) ((stepping){.kind = &engine_double, .method = WH_RK4, .step_s = (h)})
#define IN_FLOAT ((stepping){.kind = &engine_float, .method = WH_RK4})
#define IN_FLOAT_STEP(h) ((stepping){.kind = &engine_float, .method = WH_RK4, .step_s = (h)})
#define IN_FLOAT_COMPENSATED \
    ((stepping){.kind = &engine_float, .method = WH_RK4, .compensated = true})
#define IN_FLOAT_COMPENSATED_STEP(h) \
    ((stepping){.kind = &engine_float, .method = WH_RK4, .compensated = true, .step_s = (h)})

/* Starts a built-in scene. motion_close() ends it. */
void motion_open(motion *m, const char *scene, stepping how);
/* Starts the first scene of a text. motion_close() ends it. */
void motion_open_text(motion *m, const char *text, stepping how);
/* Starts the last scene of a built-in file such as "epicyclic.whirl", with `more` appended to its text. */
void motion_open_more(motion *m, const char *file, const char *more, stepping how);
/* Starts the scene `scene` of a file such as "docs/hard/rotor.whirl", with `more` appended to its text. */
void motion_open_file(motion *m, const char *path, const char *more, const char *scene,
                      stepping how);
void motion_close(motion *m);

/* Does `steps` steps, or fewer if a step fails. Returns the last status. */
wh_status motion_step(motion *m, uint64_t steps);
/* Advances to time_s, which must be a whole number of steps. A step that fails makes the test fail. */
void motion_to(motion *m, double time_s);

/* The present value of "theta1", "theta1'" or an output. */
double motion_value(const motion *m, const char *name);

/* The kinetic energy of Thomson's device with parameter set A, in J. The formula was derived by hand, with m = 2 kg,
 * r = 0.3 m, M = -2 N m. */
double thomson_kinetic_J(const motion *m);

/* Largest error of `m` over all states, in SI units. The expected values are in the file `references`, on the line
 * `core/models/FILE:scene | time | name=value ...`. */
double motion_error(const motion *m, const char *references, const char *scene, const char *time);

#endif
