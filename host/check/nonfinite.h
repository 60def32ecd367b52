/* nonfinite.h: locates the expression of a scene that is not a finite number, for messages.
 *
 * A failed step keeps the last good state. The expressions are evaluated at that state and at a few states that its
 * rates lead to. */
#ifndef CHECK_NONFINITE_H
#define CHECK_NONFINITE_H

#include "host/engine/engine.h"

/* === expressions at one state ================================================================= */
/* The expressions of a file (image_blame in host/image/image.h) at one state, node by node. */

typedef struct blamed {
    const image *image;
    double **state; /* [unknowns][order + 1] value, rate, ... */
    double *input;  /* [inputs] values at the start */
    double *value;  /* [blame.nodes] */
} blamed;

blamed blamed_open(const image *im);
void blamed_close(blamed *b);

/* Sets the components of a state, as engine_kind.state() gives them; all other values stay. */
void blamed_place(blamed *b, const double *angle_rad, const double *real);
/* The value of a node, from the values of its operands. */
double blamed_node(const blamed *b, const diagnostics_node *n);
/* The operands of a node; returns how many it has. */
int blamed_operands(const diagnostics_node *n, int of[static 2]);
/* [node + 1]: true for this node and all nodes that it depends on. The caller frees it. */
bool *blamed_parts(const image *im, int node);

/* Largest angle with a sine, rad: in double, and in float (core/angle.h). Turn angles of float runs have no such limit. */
#define ANGLE_SINE_MOST_RAD 5e8
#define ANGLE_SINE_MOST_FLOAT_RAD 1e9

/* The state where a failure is searched. Use an image made for a run: only that has the expressions as written. */
typedef struct nonfinite_at {
    const image *image;
    const double *angle_rad; /* [angles] the last good state */
    const double *real;      /* [reals] */
    bool turns;              /* angles are integers (float), so their sines exist for all values */
    double ahead_steps;      /* steps from the state to the evaluation; 0: at the state */
    const char *when;        /* begins the message: "in the step after t = 1.2 s" */
} nonfinite_at;

/* Each function reports the first undefined expression, with its place and statement. Returns false if there is
 * none. */

/* Searches the energies, losses, forces and equations, and their slopes. */
bool nonfinite_term(const nonfinite_at *at, diags *errors);
/* Searches the values that crossings set. */
bool nonfinite_set(const nonfinite_at *at, diags *errors);
/* Searches contact k. Always reports: the contact as a whole if no expression is found. */
void nonfinite_contact(const nonfinite_at *at, int k, diags *errors);

/* Reports why the energies of a run were not finite at this time. */
bool nonfinite_energies(const image *im, const engine_kind *kind, const double *angle_rad,
                        const double *real, double time_s, diags *errors);

/* Reports why a step of this run failed; false unless an expression or an angle of the model is the cause. */
bool nonfinite_step(const image *im, const engine_kind *kind, const void *run, wh_status status,
                    diags *errors);

#endif
