/* layout.h: the components of a state, and the mapping from symbols to them. */
#ifndef IMAGE_LAYOUT_H
#define IMAGE_LAYOUT_H

#include "core/scene.h"
#include "host/derive/conserve.h"
#include "host/derive/equations.h"
#include "host/image/image.h"
#include "host/image/lower.h"

/* === noise on outputs ========================================================================= */

/* Adds the active noises to the outputs result[mechanism->output_count]. Measures get no noise of their own. */
void noise_on_outputs(const equations *e, lowering *l, int *result);

typedef struct layout {
    const equations *equations;
    const conservation *conserved;
    wh_form form;
    int coordinates;  /* second order: integrated coordinates, angles included */
    int angles;       /* components stored as turn angles */
    int reals;        /* components stored as reals */
    int inputs;       /* number of inputs, without those of inactive effects */
    int *input;       /* [inputs] index of each in mechanism->inputs */
    component *angle; /* [angles] */
    component *real;  /* [reals] */
    /* [unknown] the coordinate's number in the scene, or -1; for scenes of second order only */
    int *place;
    int *angle_number; /* [unknown] index in angle[], or -1 */
    int *real_number;  /* [unknown * order_room + primes] index in real[], if in the state */
    int order_room;
    /* [unknown] operation of the unknown's highest derivative; NULL outside make_observer() */
    const int *highest;
    lowering *recording; /* lowering of the observer's list; NULL outside make_observer() */
} layout;

/* Completes a layout in which only `equations` and `conserved` are set. An angle becomes a turn angle if the
 * expressions dynamics[count] contain it only inside sines and cosines. Returns false if there are too many components.
 * The equations own the arrays. */
bool layout_arrange(layout *map, const poly *const *dynamics, int count);

/* Returns the index of a derivative of unknown i in the state, or -1. Turn angles come first in the state. */
int layout_component(const layout *map, int i, int primes);

/* Makes p ready for a list: folds it, and replaces conserved coordinates. */
const poly *layout_ready(const layout *map, const poly *p);

/* Returns the output of a record without its noise, ready for a list. */
const poly *layout_recorded(const layout *map, const symbol *record);

/* Returns a lowering that adds to the list t. It finds the symbols' components and inputs in `map`. */
lowering layout_lowering(layout *map, op_list *t);

#endif
