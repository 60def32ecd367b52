/* layout.h: which numbers a state consists of, and where an expression's symbols are found in it. */
#ifndef DERIVE_LAYOUT_H
#define DERIVE_LAYOUT_H

#include "lower.h"
#include "program.h"

typedef struct layout {
    const program *program;
    const equations *equations;
    const int *highest; /* operations of the highest derivatives by unknown, or NULL */
    const int *record;  /* operations of recorded outputs (noise_records.h), or NULL */
    int *angle_number;  /* [unknown] turn angle, or -1 */
    int *real_number;   /* [unknown * order_room + primes] real component, or -1 */
    int order_room;
} layout;

/* Arrange the state of `p`: an angle that `dynamics` [count] have only inside sines and cosines becomes
 * a turn angle. False when there are too many components. */
bool layout_arrange(layout *map, program *p, const poly *const *dynamics, int count);
void layout_free(layout *map);

/* `leaf` and `turn` of a lowering whose context is a layout; and such a lowering onto `t`. */
int layout_leaf(void *context, tape *t, const symbol *s, int primes);
int layout_turn(void *context, const symbol *s);
lowering layout_lowering(layout *map, tape *t);

#endif
