/* layout.h: the components of a state, and the mapping from symbols to them. */
#ifndef DERIVE_LAYOUT_H
#define DERIVE_LAYOUT_H

#include "conserve.h"
#include "core/scene.h"
#include "host/derive/equations.h"
#include "host/derive/lower.h"
#include "host/image/image.h"

typedef struct layout {
    const equations *equations;
    const conservation *conserved;
    wh_form form;
    int coordinates;  /* integrated coordinates, angles included (second order) */
    int angles;       /* components stored as turn angles */
    int reals;        /* components stored as reals */
    int inputs;       /* the mechanism's own and those of the active effects */
    int *input;       /* [inputs] number in the mechanism */
    component *angle; /* [angles] */
    component *real;  /* [reals] */
    /* [unknown] coordinate number in the scene's order, or -1 (second order) */
    int *place;
    int *angle_number; /* [unknown] turn angle, or -1 */
    int *real_number;  /* [unknown * order_room + primes] real component, or -1 */
    int order_room;
    /* during the entry of a list: */
    const int *highest; /* operations of the highest derivatives by unknown, or NULL */
    const int *record;  /* operations of recorded outputs (noise_records.h), or NULL */
} layout;

/* Arrange the state. An angle that `dynamics` [count] contain only inside sines and cosines becomes a turn angle. False
 * if there are too many components. */
bool layout_arrange(layout *map, const equations *e, const conservation *conserved,
                    const poly *const *dynamics, int count);
void layout_free(layout *map);

/* p ready for a list: folded, and without conserved coordinates. */
const poly *layout_ready(const layout *map, const poly *p);

/* `leaf` and `turn` of a lowering whose context is a layout; and such a lowering onto `t`. */
int layout_leaf(void *context, op_list *t, const symbol *s, int primes);
int layout_turn(void *context, const symbol *s);
lowering layout_lowering(layout *map, op_list *t);

#endif
