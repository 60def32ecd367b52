/* layout.c: which numbers a state consists of, and where an expression's symbols are found in it. */
#include "layout.h"

#include <stdlib.h>

#include "host/base/room.h"
#include "noise_records.h"

_Static_assert((int)COORDINATES_MAX == IMAGE_COMPONENTS_MAX, "the parser's bound is the image's");

int layout_turn(void *context, const symbol *s) {
    const layout *map = context;
    const bool moves = s->kind == SYM_COORDINATE || s->kind == SYM_STATE;
    return moves ? map->angle_number[s->index] : -1;
}

/* An input of an effect that is not called for cannot change: a constant. */
static int input_leaf(const layout *map, tape *t, const symbol *s) {
    for (int i = 0; i < map->program->inputs; i++) {
        if (map->program->input[i] == s->index) {
            return tape_leaf(t, OP_INPUT, i);
        }
    }
    return tape_constant(t, map->equations->instance->input[s->index]);
}

int layout_leaf(void *context, tape *t, const symbol *s, int primes) {
    const layout *map = context;
    if (s == &conservation_time) {
        return tape_leaf(t, OP_TIME, 0);
    }
    if (s->kind == SYM_INPUT) {
        return input_leaf(map, t, s);
    }
    if (s->kind == SYM_RECORD) {
        return noise_record_node(map->equations, map->record, s);
    }
    if (primes == map->equations->unknowns[s->index].order && map->highest != NULL) {
        return map->highest[s->index];
    }
    if (primes == 0 && map->angle_number[s->index] >= 0) {
        return tape_leaf(t, OP_RADIANS, map->angle_number[s->index]);
    }
    const int real = map->real_number[s->index * map->order_room + primes];
    const program *p = map->program;
    if (p->form == WH_SECOND_ORDER && primes == 1) {
        return tape_leaf(t, OP_RATE, p->place[s->index]);
    }
    return tape_leaf(t, OP_LINEAR, real);
}

/* --- arranging the state -------------------------------------------------------------------------*/

/* Is this derivative of the unknown part of the state? Conserved coordinates are not, but for their
 * value where it must be integrated. */
static bool in_state(const program *p, const equations *e, int i, int primes) {
    if (p->conserved->number[i] < 0) {
        return primes < e->unknowns[i].order;
    }
    return primes == 0 && !p->conserved->closed;
}

static int add_real(program *p, int i, int primes) {
    p->real[p->reals] = (component){i, primes};
    return p->reals++;
}

bool layout_arrange(layout *map, program *p, const poly *const *dynamics, int count) {
    const equations *e = map->equations;
    const int n = e->count;
    int components = 0;
    bool second = p->conserved->closed;
    map->order_room = 1;
    for (int i = 0; i < n; i++) {
        const int order = e->unknowns[i].order;
        components += order;
        second = second && order == 2;
        map->order_room = order + 1 > map->order_room ? order + 1 : map->order_room;
    }
    p->form = second ? WH_SECOND_ORDER : WH_FIRST_ORDER;
    if ((second ? n : components) > IMAGE_COMPONENTS_MAX) {
        return false;
    }
    p->angle = room(components, sizeof *p->angle);
    p->real = room(components, sizeof *p->real);
    p->place = room(n, sizeof *p->place);
    map->angle_number = room(n, sizeof *map->angle_number);
    map->real_number = room(n * map->order_room, sizeof *map->real_number);
    for (int i = 0; i < n; i++) {
        const symbol *s = e->unknowns[i].symbol;
        bool turns = s->is_angle && in_state(p, e, i, 0);
        for (int k = 0; k < count && turns; k++) {
            turns = lower_only_in_waves(dynamics[k], s);
        }
        map->angle_number[i] = turns ? p->angles : -1;
        p->place[i] = turns ? p->angles : -1;
        if (turns) {
            p->angle[p->angles++] = (component){i, 0};
        }
    }
    p->coordinates = p->angles;
    for (int i = 0; i < n; i++) {
        if (map->angle_number[i] < 0 && in_state(p, e, i, 0)) {
            p->place[i] = p->coordinates++;
            map->real_number[i * map->order_room] = add_real(p, i, 0);
        }
    }
    for (int slot = 0; slot < p->coordinates && second; slot++) {
        for (int i = 0; i < n; i++) {
            if (p->place[i] == slot) {
                map->real_number[i * map->order_room + 1] = add_real(p, i, 1);
            }
        }
    }
    for (int i = 0; i < n && !second; i++) {
        for (int primes = 1; in_state(p, e, i, primes); primes++) {
            map->real_number[i * map->order_room + primes] = add_real(p, i, primes);
        }
    }
    return true;
}

void layout_free(layout *map) {
    free(map->angle_number);
    free(map->real_number);
}

lowering layout_lowering(layout *map, tape *t) {
    return (lowering){.algebra = map->equations->algebra,
                      .tape = t,
                      .leaf = layout_leaf,
                      .turn = layout_turn,
                      .context = map};
}
