/* fixed_plan.h: plan of a scene's RK4 step in fixed point: ranges, binary points, operation list and constants. */
#ifndef FIXED_FIXED_PLAN_H
#define FIXED_FIXED_PLAN_H

#include "core/fixed_scene.h"
#include "host/fixed/fixed_list.h"
#include "host/image/image.h"

/* Reports each input without a declared range, because generated code may get other values than the run. Returns false
 * if there is such an input. */
bool fixed_inputs_declared(const image *im, const enclosure *range, diags *errors);

/* Multiplication of x by a constant, with a change of the binary point: wh_fixed_mul(x << shift, number, by). */
typedef struct fixed_gain {
    int32_t number;
    int shift;
    int by;
} fixed_gain;

/* How RK4 moves a component. A1 to A4 are the list's results at the four stages: h/2 times the accelerations.
 * Second order: a position q and its rate v, with W = h/2 v:
 *
 *     v2 = v + A1   v3 = v + A2   v4 = v + 2 A3   v+ = v + (A1 + 2 A2 + 2 A3 + A4)/3
 *     q2 = q + W    q3 = q + W + h/2 A1    q4 = q + 2 W + h A2    q+ = q + 2 W + h/3 (A1 + A2 + A3)
 *
 * First order: each component moves as v does. */
typedef struct fixed_mover {
    int to_kept; /* digits after the point of A1 to A4, minus those of v */
    fixed_gain third;
    int guard;              /* second order: digits after the point of W, minus those of q */
    fixed_gain half_rate;   /* multiplies v by h/2 */
    fixed_gain half_accel;  /* multiplies A1 or A2 by h/2, with wh_fixed_mul_short() */
    fixed_gain third_accel; /* multiplies A1 + A2 + A3 by h/3 */
} fixed_mover;

typedef struct fixed_plan {
    const image *image;
    wh_fixed_format *format; /* [reals + inputs] in the order of the scene */
    enclosure *range;        /* [reals + inputs] at the ends of steps */
    enclosure *stage;        /* [reals + inputs] at the stages of steps */
    bool second;
    int coordinates;    /* second order: integrated coordinates; first order: angles + reals */
    int linears;        /* coordinates that are no angles */
    fixed_mover *mover; /* [coordinates], angles first */
    fixed_list *list;
    int cells; /* cells per turn of a turn angle, from fixed_hull() */
    int64_t *start_angle;
    int32_t *start_real;
    int32_t *start_input;
} fixed_plan;

/* Makes the plan of an image with the default method. Returns NULL (reported) if the scene has no step in fixed point,
 * or after an interrupt. `progress`: show the progress on standard error. */
fixed_plan *fixed_plan_make(const image *im, bool progress, diags *errors);
void fixed_plan_free(fixed_plan *plan);

/* Prints each range that is not declared. Prints each turn angle whose declared range Whirl ignores. Each line
 * starts with `begin`. */
void fixed_plan_say(const fixed_plan *plan, FILE *out, const char *begin);

#endif
