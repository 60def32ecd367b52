#include "host/image/layout.h"

#include <string.h>

#include "host/base/hashing.h"

/* Adds noise to `node`. The output's name enters the seed, so that outputs with equal seeds have different noise. */
static int with_noise(const equations *e, lowering *l, const noise *each, int node) {
    op_list *t = l->list;
    const poly *deviation = poly_from_expr(e->algebra, each->deviation);
    const int size = lower(l, equations_fold(e, deviation));
    const char *name = each->output->name;
    const int drawn = op_list_noise(t, hash_text(name, strlen(name)) ^ each->seed);
    return op_list_add(t, node, op_list_mul(t, size, drawn));
}

void noise_on_outputs(const equations *e, lowering *l, int *result) {
    const mechanism *m = e->instance->mechanism;
    for (int k = 0; k < m->noise_count; k++) {
        const noise *each = &m->noises[k];
        const int at = each->output->index;
        if (instance_has(e->instance, each->effect) && at < m->output_count &&
            m->outputs[at] == each->output) {
            result[at] = with_noise(e, l, each, result[at]);
        }
    }
}

const poly *layout_recorded(const layout *map, const symbol *record) {
    return layout_ready(map, poly_from_expr(map->equations->algebra, record->value));
}

/* The operation for a recorded output with its active noises. */
static int record_leaf(const layout *map, const symbol *record) {
    const mechanism *m = map->equations->instance->mechanism;
    int node = lower(map->recording, layout_recorded(map, record));
    for (int k = 0; k < m->noise_count; k++) {
        if (m->noises[k].record == record &&
            instance_has(map->equations->instance, m->noises[k].effect)) {
            node = with_noise(map->equations, map->recording, &m->noises[k], node);
        }
    }
    return node;
}

/* === the state ================================================================================ */

_Static_assert((int)COORDINATES_MAX == IMAGE_COMPONENTS_MAX, "the parser's bound is the image's");

static int layout_turn(void *context, const symbol *s) {
    const layout *map = context;
    const bool moves = s->kind == SYM_COORDINATE || s->kind == SYM_STATE;
    return moves ? map->angle_number[s->index] : -1;
}

static int layout_leaf(void *context, op_list *t, const symbol *s, int primes) {
    const layout *map = context;
    if (s == &conservation_time) {
        return op_list_leaf(t, OP_TIME, 0);
    }
    if (s->kind == SYM_INPUT) {
        for (int i = 0; i < map->inputs; i++) {
            if (map->input[i] == s->index) {
                return op_list_leaf(t, OP_INPUT, i);
            }
        }
        /* an input of an inactive effect cannot change */
        return op_list_constant(t, map->equations->instance->input[s->index]);
    }
    if (s->kind == SYM_RECORD) {
        return record_leaf(map, s);
    }
    if (primes == map->equations->unknowns[s->index].order && map->highest != NULL) {
        return map->highest[s->index];
    }
    if (primes == 0 && map->angle_number[s->index] >= 0) {
        return op_list_leaf(t, OP_RADIANS, map->angle_number[s->index]);
    }
    const int real = map->real_number[s->index * map->order_room + primes];
    if (map->form == WH_SECOND_ORDER && primes == 1) {
        return op_list_leaf(t, OP_RATE, map->place[s->index]);
    }
    return op_list_leaf(t, OP_LINEAR, real);
}

/* Is this derivative of unknown i in the state? */
static bool in_state(const layout *map, int i, int primes) {
    if (map->conserved->number[i] < 0) {
        return primes < map->equations->unknowns[i].order;
    }
    return primes == 0 && !map->conserved->closed;
}

int layout_component(const layout *map, int i, int primes) {
    if (!in_state(map, i, primes)) {
        return -1;
    }
    return primes == 0 && map->angle_number[i] >= 0
               ? map->angle_number[i]
               : map->angles + map->real_number[i * map->order_room + primes];
}

static int add_real(layout *map, int i, int primes) {
    map->real[map->reals] = (component){i, primes};
    return map->reals++;
}

bool layout_arrange(layout *map, const poly *const *dynamics, int count) {
    const equations *e = map->equations;
    algebra *a = e->algebra;
    const mechanism *m = e->instance->mechanism;
    const int n = e->count;
    int components = 0;
    map->input = algebra_room(a, m->input_count, sizeof *map->input);
    for (int i = 0; i < m->input_count; i++) {
        if (instance_has(e->instance, m->inputs[i]->effect)) {
            map->input[map->inputs++] = i;
        }
    }
    bool second = map->conserved->closed;
    map->order_room = 1;
    for (int i = 0; i < n; i++) {
        const int order = e->unknowns[i].order;
        components += order;
        second = second && order == 2;
        map->order_room = order + 1 > map->order_room ? order + 1 : map->order_room;
    }
    map->form = second ? WH_SECOND_ORDER : WH_FIRST_ORDER;
    if ((second ? n : components) > IMAGE_COMPONENTS_MAX) {
        return false;
    }
    map->angle = algebra_room(a, components, sizeof *map->angle);
    map->real = algebra_room(a, components, sizeof *map->real);
    map->place = algebra_room(a, n, sizeof *map->place);
    map->angle_number = algebra_room(a, n, sizeof *map->angle_number);
    map->real_number = algebra_room(a, n * map->order_room, sizeof *map->real_number);
    for (int i = 0; i < n; i++) {
        const symbol *s = e->unknowns[i].symbol;
        bool turns = s->is_angle && in_state(map, i, 0);
        for (int k = 0; k < count && turns; k++) {
            turns = lower_only_in_waves(dynamics[k], s);
        }
        map->place[i] = map->angle_number[i] = turns ? map->angles : -1;
        if (turns) {
            map->angle[map->angles++] = (component){i, 0};
        }
    }
    map->coordinates = map->angles;
    for (int i = 0; i < n; i++) {
        if (map->angle_number[i] < 0 && in_state(map, i, 0)) {
            map->place[i] = map->coordinates++;
            map->real_number[i * map->order_room] = add_real(map, i, 0);
        }
    }
    for (int slot = 0; slot < map->coordinates && second; slot++) {
        for (int i = 0; i < n; i++) {
            if (map->place[i] == slot) {
                map->real_number[i * map->order_room + 1] = add_real(map, i, 1);
            }
        }
    }
    for (int i = 0; i < n && !second; i++) {
        for (int primes = 1; in_state(map, i, primes); primes++) {
            map->real_number[i * map->order_room + primes] = add_real(map, i, primes);
        }
    }
    return true;
}

const poly *layout_ready(const layout *map, const poly *p) {
    return conservation_settle(map->equations, map->conserved, equations_fold(map->equations, p));
}

lowering layout_lowering(layout *map, op_list *t) {
    return (lowering){.algebra = map->equations->algebra,
                      .list = t,
                      .leaf = layout_leaf,
                      .turn = layout_turn,
                      .context = map};
}
