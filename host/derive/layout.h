/* layout.h: the components of a state, and the mapping from symbols to them. */
#ifndef DERIVE_LAYOUT_H
#define DERIVE_LAYOUT_H

#include "core/scene.h"
#include "host/derive/conserve.h"
#include "host/derive/equations.h"
#include "host/derive/lower.h"
#include "host/image/image.h"

/* === noise on recorded quantities: on outputs, and on measures of recorded outputs ============ */

/* Adds the active noises to the outputs result[mechanism->output_count]. Measures get no noise of their own. */
void noise_on_outputs(const equations *e, lowering *l, int *result);

typedef struct layout {
    const equations *equations;
    const conservation *conserved;
    wh_form form;
    int coordinates;  /* second order: integrated coordinates, angles included */
    int angles;       /* components stored as turn angles */
    int reals;        /* components stored as reals */
    int inputs;       /* of the mechanism and of the active effects */
    int *input;       /* [inputs] number of each input in the mechanism */
    component *angle; /* [angles] */
    component *real;  /* [reals] */
    /* [unknown] the coordinate's number in the scene, or -1; for scenes of second order only */
    int *place;
    int *angle_number; /* [unknown] turn angle, or -1 */
    int *real_number;  /* [unknown * order_room + primes] real component, or -1 */
    int order_room;
    /* while a list is entered: the operation of each unknown's highest derivative; else NULL */
    const int *highest;
    /* while a list is entered in which recorded outputs (SYM_RECORD) may occur: the list's lowering; else NULL */
    lowering *recording;
} layout;

/* Completes a layout that has only its equations and conserved coordinates. An angle that dynamics[count] contain only
 * inside sines and cosines becomes a turn angle. Returns false if there are too many components. The equations own the
 * arrays. */
bool layout_arrange(layout *map, const poly *const *dynamics, int count);

/* The component of the state with this derivative of unknown i, angles first; -1 if it is not in the state. */
int layout_component(const layout *map, int i, int primes);

/* Makes p ready for a list: folds it, and replaces conserved coordinates. */
const poly *layout_ready(const layout *map, const poly *p);

/* Returns the output of a record without its noise, ready for a list. */
const poly *layout_recorded(const layout *map, const symbol *record);

/* The leaves and turn angles of the lowering come from this layout. */
lowering layout_lowering(layout *map, op_list *t);

#endif
