/* nonfinite.h: finds the expression of a scene whose value is not finite, for messages. After a failed step,
 * expressions are evaluated at the last good state, and at states extrapolated from the last good state. */
#ifndef CHECK_NONFINITE_H
#define CHECK_NONFINITE_H

#include "host/engine/engine.h"

/* === expressions at one state ================================================================= */
/* Evaluates the expressions of a scene (image_diagnostics in host/image/image.h) at one state. */

typedef struct diagnosis {
    const image *image;
    double **state; /* [unknowns][order + 1] value, rate, ... */
    double *input;  /* [inputs] values at the start */
    double *value;  /* [diagnostics.nodes] */
} diagnosis;

diagnosis diagnosis_open(const image *im);
void diagnosis_close(diagnosis *b);

/* Enters a state, as engine_kind.state() gives it, in b->state. Other entries of b->state do not change. */
void diagnosis_place(diagnosis *b, const double *angle_rad, const double *real);
/* The value of a node, from the values of its operands. */
double diagnosis_value(const diagnosis *b, const diagnostics_node *n);
/* of[]: the operands of a node. Returns their number. */
int diagnosis_operands(const diagnostics_node *n, int of[static 2]);
/* [node + 1]: true for this node and all nodes that it depends on. The caller frees it. */
bool *diagnosis_parts(const image *im, int node);

/* Largest argument of sine and cosine, rad (core/number/sine.h). Turn angles of a float run have no limit. */
#define ANGLE_SINE_MOST_RAD 5e8
#define ANGLE_SINE_MOST_FLOAT_RAD 1e9

/* Where to search for the cause of a failure. `image` must be made for a run; else it has no diagnostics. */
typedef struct nonfinite_at {
    const image *image;
    const double *angle_rad; /* [angles] the last good state */
    const double *real;      /* [reals] */
    bool turns;              /* the run is in float: sines of turn angles have no limit */
    double ahead_steps;      /* also searches states up to 2 * ahead_steps steps later */
    const char *when;        /* begins the message: "in the step after t = 1.2 s" */
} nonfinite_at;

/* Each function reports the first undefined expression, with its place and statement; false: there is none. */

/* Searches the energies, losses, forces, equations, and their derivatives. */
bool nonfinite_term(const nonfinite_at *at, diags *errors);
/* Searches the values that crossings set. */
bool nonfinite_set(const nonfinite_at *at, diags *errors);
/* Searches contact k. If no expression is found, reports the contact as a whole. */
void nonfinite_contact(const nonfinite_at *at, int k, diags *errors);

/* Reports why the energies of a run were not finite at this time. state[]: angles, then reals. */
bool nonfinite_energies(const image *im, const engine_kind *kind, const double *state,
                        double time_s, diags *errors);

/* Reports why a step of this run failed; false unless an expression or an angle of the model is the cause. */
bool nonfinite_step(const image *im, const engine_kind *kind, const void *run, wh_status status,
                    diags *errors);

#endif
