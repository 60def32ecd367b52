/* motion.h: a built-in scene stepped inside a test, for the accuracy suites.
 *
 * All quantities are SI; angles are unwrapped radians. An unknown scene or name fails the test. */
#ifndef TESTS_MOTION_H
#define TESTS_MOTION_H

#include "test.h"

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

typedef struct stepping {
    const engine_kind *kind;
    wh_method method;
    bool compensated;
    /* 0: the scene's own step. The float engine rounds this double to float */
    double step_s;
    const char *set;   /* a parameter or an input, "M=1.5", or NULL */
    const char *start; /* a coordinate or a rate, "theta'=3", or NULL */
    bool ledger;       /* with the energy balance */
    bool stabilized;   /* with correction of the energy drift */
    image_angles angles;
    image_matrix_of matrix;
} stepping;

/* RK4 in double or float. The names with _STEP take a step in s, the others have the scene's own. */
#define IN_DOUBLE ((stepping){.kind = &engine_double, .method = WH_RK4})
#define IN_DOUBLE_STEP(h) ((stepping){.kind = &engine_double, .method = WH_RK4, .step_s = (h)})
#define IN_FLOAT ((stepping){.kind = &engine_float, .method = WH_RK4})
#define IN_FLOAT_STEP(h) ((stepping){.kind = &engine_float, .method = WH_RK4, .step_s = (h)})
#define IN_FLOAT_COMPENSATED \
    ((stepping){.kind = &engine_float, .method = WH_RK4, .compensated = true})
#define IN_FLOAT_COMPENSATED_STEP(h) \
    ((stepping){.kind = &engine_float, .method = WH_RK4, .compensated = true, .step_s = (h)})

/* Starts a scene of a built-in model. End it with motion_close(). */
void motion_open(motion *m, const char *scene, stepping how);
/* Starts the first scene of a text, as motion_open() does. */
void motion_open_text(motion *m, const char *text, stepping how);
/* Starts the last scene of a built-in file such as "epicyclic.whirl", with the text `more` appended. */
void motion_open_more(motion *m, const char *file, const char *more, stepping how);
/* Starts a named scene of a file such as "docs/hard/rotor.whirl", with the text `more` appended. */
void motion_open_file(motion *m, const char *path, const char *more, const char *scene,
                      stepping how);
void motion_close(motion *m);

/* Does `steps` steps and returns the last status. Stops at a failure. */
wh_status motion_step(motion *m, uint64_t steps);
/* Advances to `time_s`, a whole number of steps. A step that fails, fails the test. */
void motion_to(motion *m, double time_s);

/* The value of "theta1", "theta1'" or an output of this name. */
double motion_value(const motion *m, const char *name);

/* Kinetic energy of Thomson's device with set A, derived by hand: m = 2 kg, r = 0.3 m, M = -2 N m. */
double thomson_kinetic_J(const motion *m);

/* Largest error of `m` against the line `core/models/FILE:scene | time | name=value ...` of the file `references`, over all
 * states; SI. */
double motion_error(const motion *m, const char *references, const char *scene, const char *time);

#endif
