/* program.c: folding the parameters in, arranging the state, entering the lists. */
#include "program.h"

#include <stdlib.h>

#include "lower.h"
#include "solve.h"

/* --- folding -------------------------------------------------------------------------------------*/

static const poly *parameter_value(void *context, algebra *a, const symbol *s, int primes) {
    const instance *inst = context;
    (void)primes;
    return s->kind == SYM_PARAMETER ? poly_number(a, inst->parameter[s->index]) : NULL;
}

static const poly *fold(const equations *e, const poly *p) {
    /* poly_substitute() does not write through its context */
    return poly_substitute(e->algebra, p, parameter_value, (void *)(uintptr_t)e->instance);
}

/* --- leaves --------------------------------------------------------------------------------------*/

typedef struct place_map {
    const program *program;
    const equations *equations;
    const int *highest; /* operations of the highest derivatives by unknown, or NULL */
    int *angle_number;  /* [unknown] turn angle, or -1 */
    int *real_number;   /* [unknown * order_room + primes] real component, or -1 */
    int order_room;
} place_map;

static int turn_of(void *context, const symbol *s) {
    const place_map *map = context;
    const bool moves = s->kind == SYM_COORDINATE || s->kind == SYM_STATE;
    return moves ? map->angle_number[s->index] : -1;
}

static int leaf_of(void *context, tape *t, const symbol *s, int primes) {
    const place_map *map = context;
    if (s == &conservation_time) {
        return tape_leaf(t, OP_TIME, 0);
    }
    if (s->kind == SYM_INPUT) {
        return tape_leaf(t, OP_INPUT, s->index);
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

static void *room(int count, size_t size) {
    void *p = calloc((size_t)count + 1, size);
    if (p == NULL) {
        abort();
    }
    return p;
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

static bool arrange(program *p, const equations *e, place_map *map, const poly *const *dynamics,
                    int count) {
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
    if ((second ? n : components) > PROGRAM_COMPONENTS_MAX) {
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

/* --- the lists -----------------------------------------------------------------------------------*/

static lowering lowering_on(const equations *e, tape *t, place_map *map) {
    return (lowering){
        .algebra = e->algebra, .tape = t, .leaf = leaf_of, .turn = turn_of, .context = map};
}

/* The slope of a component of a first-order scene. */
static int slope_of(program *p, const equations *e, place_map *map, lowering *l, component of,
                    const int *highest) {
    const int k = p->conserved->number[of.unknown];
    if (k >= 0) {
        return lower(l, p->conserved->rate[k]);
    }
    const int up = of.primes + 1;
    if (up == e->unknowns[of.unknown].order) {
        return highest[of.unknown];
    }
    return tape_leaf(l->tape, OP_LINEAR, map->real_number[of.unknown * map->order_room + up]);
}

static tape *make_step(program *p, const equations *e, place_map *map, const linear_system *s) {
    const int n = e->count;
    const int components = p->angles + p->reals;
    const bool second = p->form == WH_SECOND_ORDER;
    tape *t = tape_new(p->angles, second ? p->coordinates : components);
    int *highest = room(n, sizeof *highest);
    lowering l = lowering_on(e, t, map);
    solve_highest(&l, s, highest);
    for (int i = 0; i < n && second; i++) {
        if (p->place[i] >= 0) {
            t->result[p->place[i]] = highest[i];
        }
    }
    for (int c = 0; c < components && !second; c++) {
        const component of = c < p->angles ? p->angle[c] : p->real[c - p->angles];
        t->result[c] = slope_of(p, e, map, &l, of, highest);
    }
    lower_done(&l);
    free(highest);
    tape_prune(t);
    return t;
}

/* A list that first solves for the highest derivatives, then computes `wanted`. With `keep`, the
 * highest derivatives are the first results. */
static tape *make_observer(program *p, const equations *e, place_map *map, const linear_system *s,
                           const poly *const *wanted, int count, bool keep) {
    const int n = e->count;
    const int first = keep ? n : 0;
    tape *t = tape_new(p->angles, first + count);
    int *highest = room(n, sizeof *highest);
    const poly **folded = room(count, sizeof(const poly *));
    lowering l = lowering_on(e, t, map);
    solve_highest(&l, s, highest);
    map->highest = highest;
    for (int i = 0; i < n && keep; i++) {
        t->result[i] = highest[i];
    }
    for (int i = 0; i < count; i++) {
        folded[i] = conservation_settle(e, p->conserved, fold(e, wanted[i]));
    }
    lower_plan(&l, folded, count);
    for (int i = 0; i < count; i++) {
        t->result[first + i] = lower(&l, folded[i]);
    }
    lower_done(&l);
    map->highest = NULL;
    free(highest);
    free(folded);
    tape_prune(t);
    return t;
}

/* The mechanism's outputs, then value and rate of each conserved coordinate. */
static tape *make_observe(program *p, const equations *e, place_map *map, const linear_system *s) {
    const int own = e->instance->mechanism->output_count;
    const poly **wanted = room(p->outputs, sizeof(const poly *));
    for (int i = 0; i < own; i++) {
        wanted[i] = e->output[i];
    }
    for (int k = 0; k < p->conserved->count; k++) {
        const symbol *q = e->unknowns[p->conserved->unknown[k]].symbol;
        wanted[own + 2 * k] = poly_symbol(e->algebra, q, 0);
        wanted[own + 2 * k + 1] = poly_symbol(e->algebra, q, 1);
    }
    tape *t = make_observer(p, e, map, s, wanted, p->outputs, false);
    free(wanted);
    return t;
}

static tape *make_books(program *p, const equations *e, place_map *map, const linear_system *s) {
    const int n = e->count;
    const poly **wanted = calloc((size_t)(BOOK_MOMENTA + n), sizeof *wanted);
    if (wanted == NULL) {
        abort();
    }
    int count = 0;
    if (!e->instance->mechanism->is_system) {
        wanted[BOOK_KINETIC] = e->kinetic;
        wanted[BOOK_STORED] = e->stored;
        wanted[BOOK_INPUT_POWER] = e->input_power;
        wanted[BOOK_LOSS_POWER] = e->loss_power;
        for (int i = 0; i < n; i++) {
            wanted[BOOK_MOMENTA + i] = e->momentum[i];
        }
        count = BOOK_MOMENTA + n;
    }
    tape *t = make_observer(p, e, map, s, wanted, count, true);
    free(wanted);
    return t;
}

program *program_make(const equations *e, const bool *conserve, diags *errors) {
    const int n = e->count;
    const mechanism *m = e->instance->mechanism;
    program *p = room(1, sizeof *p);
    p->conserved = conservation_make(e, conserve, fold, errors);
    if (p->conserved == NULL) {
        program_free(p);
        return NULL;
    }
    const poly **dynamics = room(n * n + n, sizeof(const poly *));
    bool *turning = room(n, sizeof *turning);
    bool *wanted = room(n, sizeof *wanted);
    p->count = n;
    p->inputs = m->input_count;
    p->outputs = m->output_count + 2 * p->conserved->count;
    const linear_system s = {n, !m->is_system, dynamics, dynamics + n * n, turning, wanted};
    for (int i = 0; i < n * n; i++) {
        dynamics[i] = fold(e, e->mass[i]);
    }
    for (int i = 0; i < n; i++) {
        const poly *force = fold(e, equations_force(e, i));
        dynamics[n * n + i] = conservation_settle(e, p->conserved, force);
        turning[i] = e->unknowns[i].symbol->is_angle;
        wanted[i] = p->conserved->number[i] < 0;
    }
    place_map map = {.program = p, .equations = e};
    const bool fits = arrange(p, e, &map, dynamics, n * n + n);
    if (fits) {
        p->step = make_step(p, e, &map, &s);
        p->observe = make_observe(p, e, &map, &s);
        p->books = make_books(p, e, &map, &s);
    } else {
        diag_error(errors, m->at, NULL, "'%s' has more than %d components of state", m->name,
                   PROGRAM_COMPONENTS_MAX);
    }
    const bool grown = fits && algebra_overflow(e->algebra);
    if (grown) {
        equations_report_growth(e, errors);
    }
    free(map.angle_number);
    free(map.real_number);
    free(dynamics);
    free(turning);
    free(wanted);
    if (!fits || grown) {
        program_free(p);
        return NULL;
    }
    return p;
}

void program_free(program *p) {
    if (p == NULL) {
        return;
    }
    tape_free(p->step);
    tape_free(p->observe);
    tape_free(p->books);
    free(p->angle);
    free(p->real);
    free(p->place);
    conservation_free(p->conserved);
    free(p);
}

const char *program_needs_libm(const program *p) {
    static const char *const names[FN_COUNT] = {
        [FN_SIN] = "sin",   [FN_COS] = "cos",   [FN_TAN] = "tan",     [FN_ASIN] = "asin",
        [FN_ACOS] = "acos", [FN_ATAN] = "atan", [FN_ATAN2] = "atan2", [FN_SQRT] = "sqrt",
        [FN_EXP] = "exp",   [FN_LOG] = "log",   [FN_ABS] = "abs",     [FN_SIGN] = "sign",
        [FN_MIN] = "min",   [FN_MAX] = "max"};
    const tape *const lists[] = {p->step, p->observe};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < lists[k]->count; i++) {
            const op *o = &lists[k]->ops[i];
            if (o->code == OP_CALL) {
                return names[o->function];
            }
            if (o->code == OP_POW) {
                return "a power that is not a multiple of 1/2";
            }
        }
    }
    return NULL;
}

uint64_t program_hash(const program *p) { return tape_hash(p->step); }

void program_start(const program *p, const instance *inst, double *angle_rad, double *real) {
    for (int i = 0; i < p->angles; i++) {
        angle_rad[i] = inst->start[p->angle[i].unknown][0];
    }
    for (int i = 0; i < p->reals; i++) {
        const component c = p->real[i];
        real[i] = c.primes < inst->start_count[c.unknown] ? inst->start[c.unknown][c.primes] : 0.0;
    }
}
