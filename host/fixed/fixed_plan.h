/* fixed_plan.h: a scene's step in fixed point: ranges and formats of the state, its list, the method's constants. */
#ifndef FIXED_FIXED_PLAN_H
#define FIXED_FIXED_PLAN_H

#include "core/fixed_scene.h"
#include "host/fixed/fixed_list.h"
#include "host/image/image.h"

/* === statements that fixed point refuses, each at its place =================================== */

/* Reports inputs without a declared range, and their range in the run: generated code may get other inputs. Returns
 * false if there are any. */
bool fixed_inputs_declared(const image *im, const enclosure *range, diags *errors);

/* Multiplication by a constant, with a change of the binary point: x 2^shift number 2^-(32 + by), rounded. */
typedef struct fixed_gain {
    int32_t number;
    int shift;
    int by;
} fixed_gain;

/* How RK4 moves a component. Second order: a position q and its rate v, with W = h/2 v, and A1 to A4 = h/2 times the
 * acceleration at the four stages (results of the list):
 *
 *     v2 = v + A1   v3 = v + A2   v4 = v + 2 A3   v+ = v + (A1 + 2 A2 + 2 A3 + A4)/3
 *     q2 = q + W    q3 = q + W + h/2 A1    q4 = q + 2 W + h A2    q+ = q + 2 W + h/3 (A1 + A2 + A3)
 *
 * First order: a component moves as v does. A1 to A4 have `to_kept` more digits after the point than v. W and the terms
 * added to W have `guard` more digits than q. */
typedef struct fixed_mover {
    int to_kept;
    fixed_gain third;
    int guard;              /* second order only, as the three gains below */
    fixed_gain half_rate;   /* of v */
    fixed_gain half_accel;  /* of A: `number` and `by` for wh_fixed_mul_short() */
    fixed_gain third_accel; /* of A1 + A2 + A3 */
} fixed_mover;

typedef struct fixed_plan {
    const image *image;
    wh_fixed_format *format; /* [reals + inputs] in the order of the scene */
    enclosure *range;        /* [reals + inputs] at the ends of steps */
    enclosure *stage;        /* [reals + inputs] at the stages of steps */
    /* [reals + inputs] true: declared; false: from a reference run, or twice an input's value */
    bool *declared;
    bool second;
    int coordinates;    /* for first order, the number of components */
    fixed_mover *mover; /* [coordinates], angles first */
    fixed_list *list;
    int cells; /* number of cells per turn with which no denominator was zero */
    int64_t *start_angle;
    int32_t *start_real;
    int32_t *start_input;
} fixed_plan;

/* Makes the plan of an image with the default method. Returns NULL (reported) if the scene has no step in fixed point,
 * or after an interrupt. `progress`: show the progress on standard error. */
fixed_plan *fixed_plan_make(const image *im, bool progress, diags *errors);
void fixed_plan_free(fixed_plan *plan);

/* Prints `begin` and a text, such as "range theta' = -40 .. 40: not declared, ...", for each undeclared range, and for
 * each range of a turn angle, which is not used. */
void fixed_plan_say(const fixed_plan *plan, FILE *out, const char *begin);

#endif
