/* exact_motion.c: the exact equations of motion as a graph, solved for the highest derivatives. */
#include "exact_motion.h"

#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/prove/graph.h"

typedef struct making {
    struct arena *arena;
    reader_symbols symbols;
    graph *graph;
    const instance *instance;
    int count; /* number of unknowns */
    int states;
    int *matrix; /* [count * count] nodes of the matrix M in M x = f */
    int *force;  /* [count] nodes of f */
    int *solved; /* [count] nodes of x: the highest derivative of each unknown */
    diags *errors;
} making;

/* `count` numbers -1. */
static int *not_made(struct arena *arena, int64_t count) {
    int *number = arena_alloc(arena, (size_t)count * sizeof *number);
    for (int64_t i = 0; i < count; i++) {
        number[i] = -1;
    }
    return number;
}

static bool refuse_contact(place at, contact_kind kind, diags *errors) {
    diag_error(errors, at,
               "use whirl trust, which estimates the error; a proof needs a smooth scene",
               "%s changes the equations during a run, and the proof cannot enclose the time of "
               "the change",
               contact_called(kind));
    return false;
}

static bool is_smooth(const instance *inst, diags *errors) {
    const mechanism *m = inst->mechanism;
    for (int i = 0; i < m->contact_count; i++) {
        const contact_statement *c = &m->contacts[i];
        if (instance_has(inst, c->effect)) {
            return refuse_contact(c->at, c->kind, errors);
        }
    }
    for (int i = 0; i < m->input_count; i++) {
        if (m->inputs[i]->rate != NULL) {
            diag_error(
                errors, m->inputs[i]->at,
                "leave out the rate of the input, write the input as a parameter, or use whirl trust, which estimates the error",
                "an input with a rate changes inside a step, which the proof cannot enclose");
            return false;
        }
    }
    if (inst->scene != NULL && inst->scene->when_count > 0) {
        return refuse_contact(inst->scene->whens[0].at, CONTACT_WHEN, errors);
    }
    return true;
}

/* Returns the node of the sum of all terms of a kind, or -1 (reported). */
static int sum_of_terms(making *k, term_kind kind, int unknown) {
    const mechanism *m = k->instance->mechanism;
    int sum = graph_whole(k->graph, 0);
    for (int i = 0; i < m->term_count && sum >= 0; i++) {
        const term *t = &m->terms[i];
        if (t->kind != kind || !instance_has(k->instance, t->effect) ||
            (unknown >= 0 && t->coordinate->index != unknown)) {
            continue;
        }
        const int value = read_node(&k->symbols, t->value);
        sum = value < 0 ? -1 : graph_add(k->graph, sum, value);
    }
    return sum;
}

/* Builds Lagrange's equations d/dt dL/dq' - dL/dq = Q - dF/dq', with only the terms of q'' on the left. */
static bool lagrange(making *k) {
    graph *g = k->graph;
    const int kinetic = sum_of_terms(k, TERM_T, -1);
    const int stored = sum_of_terms(k, TERM_V, -1);
    const int loss = sum_of_terms(k, TERM_F, -1);
    if (kinetic < 0 || stored < 0 || loss < 0) {
        return false;
    }
    const int lagrangian = graph_sub(g, kinetic, stored);
    for (int i = 0; i < k->count && g->count < GRAPH_NODES_MAX; i++) {
        const int q = k->symbols.first[i];
        const int momentum = graph_slope(g, lagrangian, q + 1);
        const int applied = sum_of_terms(k, TERM_Q, i);
        if (applied < 0) {
            return false;
        }
        int right = graph_add(g, graph_sub(g, applied, graph_slope(g, loss, q + 1)),
                              graph_slope(g, lagrangian, q));
        for (int j = 0; j < k->count; j++) {
            const int other = k->symbols.first[j];
            const int drift =
                graph_mul(g, graph_slope(g, momentum, other), graph_variable(g, other + 1));
            right = graph_sub(g, right, drift);
            k->matrix[i * k->count + j] = graph_slope(g, momentum, other + 1);
        }
        k->force[i] = right;
    }
    return true;
}

/* Builds M and f from a system's equations left = right. left - right must be linear in the highest derivatives. */
static bool given_outright(making *k) {
    graph *g = k->graph;
    const mechanism *m = k->instance->mechanism;
    int row = 0;
    for (int i = 0; i < m->term_count && row < k->count; i++) {
        const term *t = &m->terms[i];
        if (t->kind != TERM_EQUATION || !instance_has(k->instance, t->effect)) {
            continue;
        }
        const int left = read_node(&k->symbols, t->value);
        const int right = read_node(&k->symbols, t->right);
        if (left < 0 || right < 0) {
            return false;
        }
        const int rest = graph_sub(g, left, right);
        for (int j = 0; j < k->count; j++) {
            const int slope = graph_slope(g, rest, k->states + j);
            if (graph_without(g, slope, k->states) != slope) {
                diag_error(
                    k->errors, t->value->at,
                    "write each term as one highest derivative times a factor without highest derivatives",
                    "Whirl cannot prove that this is linear in the highest derivatives");
                return false;
            }
            k->matrix[row * k->count + j] = slope;
        }
        k->force[row++] = graph_neg(g, graph_without(g, rest, k->states));
    }
    return true;
}

/* Finds a pivot: a number if there is one, otherwise any node that is not zero. Searches only the
 * diagonal of a mass matrix, because such a matrix is positive definite. */
static bool find_pivot(const making *k, const bool *row_done, const bool *column_done, int *row,
                       int *column) {
    const bool diagonal = !k->instance->mechanism->is_system;
    int best = 0;
    for (int i = 0; i < k->count; i++) {
        for (int j = 0; j < k->count; j++) {
            const int a = k->matrix[i * k->count + j];
            const int worth = graph_is_zero(k->graph, a) ? 0 : graph_is_number(k->graph, a) ? 2 : 1;
            if (!row_done[i] && !column_done[j] && worth > best && (i == j || !diagonal)) {
                best = worth;
                *row = i;
                *column = j;
            }
        }
    }
    return best > 0;
}

/* Subtracts a multiple of row p from row i, so that row i's entry in column c becomes zero. */
static void take_row(making *k, int i, int p, int c) {
    graph *g = k->graph;
    const int n = k->count;
    if (graph_is_zero(g, k->matrix[i * n + c])) {
        return;
    }
    const int by = graph_div(g, k->matrix[i * n + c], k->matrix[p * n + c]);
    for (int j = 0; j < n; j++) {
        int *at = &k->matrix[i * n + j];
        *at =
            j == c ? graph_whole(g, 0) : graph_sub(g, *at, graph_mul(g, by, k->matrix[p * n + j]));
    }
    k->force[i] = graph_sub(g, k->force[i], graph_mul(g, by, k->force[p]));
}

static bool solve(making *k) {
    graph *g = k->graph;
    const int n = k->count;
    bool *row_done = arena_alloc(k->arena, (size_t)n * sizeof *row_done);
    bool *column_done = arena_alloc(k->arena, (size_t)n * sizeof *column_done);
    bool *known = arena_alloc(k->arena, (size_t)n * sizeof *known);
    int *row = not_made(k->arena, n);
    int *column = not_made(k->arena, n);
    bool good = true;
    for (int s = 0; s < n && good; s++) {
        good =
            find_pivot(k, row_done, column_done, &row[s], &column[s]) && g->count < GRAPH_NODES_MAX;
        if (good) {
            row_done[row[s]] = column_done[column[s]] = true;
            for (int i = 0; i < n; i++) {
                if (!row_done[i]) {
                    take_row(k, i, row[s], column[s]);
                }
            }
        }
    }
    /* back substitution */
    for (int s = n - 1; s >= 0 && good; s--) {
        const int *entry = &k->matrix[row[s] * n];
        int right = k->force[row[s]];
        for (int j = 0; j < n; j++) {
            if (known[j]) {
                right = graph_sub(g, right, graph_mul(g, entry[j], k->solved[j]));
            }
        }
        k->solved[column[s]] = graph_div(g, right, entry[column[s]]);
        known[column[s]] = true;
    }
    return good;
}

static void take_nodes(exact_motion *m, const graph *g, const int *rate) {
    bool *needed = alloc(g->count, sizeof *needed);
    int *to = alloc(g->count, sizeof *to);
    for (int i = 0; i < m->states; i++) {
        needed[rate[i]] = true;
    }
    for (int i = g->count - 1; i >= 0; i--) { /* operands come before their users */
        const node *n = &g->node[i];
        if (needed[i] && n->kind != NODE_NUMBER && n->kind != NODE_VARIABLE) {
            needed[n->left] = true;
            if (n->right >= 0) {
                needed[n->right] = true;
            }
        }
        if (needed[i] && n->kind == NODE_SINE) {
            needed[i + 1] = true; /* a sine needs its cosine, the next node, with the same angle */
        }
    }
    m->node = alloc(g->count + m->states, sizeof *m->node);
    for (int i = 0; i < m->states; i++) {
        m->node[m->nodes++] = (node){NODE_VARIABLE, i, -1, enclosure_of(0.0)};
    }
    for (int i = 0; i < g->count; i++) {
        node n = g->node[i];
        if (n.kind == NODE_VARIABLE) {
            to[i] = n.left;
        } else if (needed[i]) {
            n.left = n.left >= 0 ? to[n.left] : -1;
            n.right = n.right >= 0 ? to[n.right] : -1;
            to[i] = m->nodes;
            m->node[m->nodes++] = n;
        }
    }
    for (int i = 0; i < m->states; i++) {
        m->rate[i] = to[rate[i]];
    }
    free(needed);
    free(to);
}

static void number_states(making *k, exact_motion *m) {
    const mechanism *of = k->instance->mechanism;
    for (int i = 0; i < k->count; i++) {
        k->symbols.first[i] = k->states;
        k->symbols.order[i] = of->coordinates[i]->order;
        k->states += k->symbols.order[i];
    }
    k->symbols.highest = k->states;
    m->states = k->states;
    m->state = alloc(k->states, sizeof *m->state);
    m->start = alloc(k->states, sizeof *m->start);
    m->rate = alloc(k->states, sizeof *m->rate);
}

static bool read_starts(making *k, exact_motion *m) {
    int at = 0;
    for (int i = 0; i < k->count; i++) {
        for (int p = 0; p < k->symbols.order[i]; p++) {
            const expr *given = k->instance->start_given[i][p].value;
            const int start =
                given != NULL ? read_node(&k->symbols, given) : graph_whole(k->graph, 0);
            if (start < 0 || !graph_is_number(k->graph, start)) {
                return false;
            }
            m->state[at] = (exact_state){i, p};
            m->start[at++] = k->graph->node[start].number;
        }
    }
    return true;
}

/* Returns false (reported) if the interval of a number is not finite, as for 1/0 or the root of -1. */
static bool is_defined(const exact_motion *m, const mechanism *of, diags *errors) {
    bool good = true;
    for (int i = 0; i < m->nodes; i++) {
        good = good && enclosure_is_finite(m->node[i].number);
    }
    for (int i = 0; i < m->states; i++) {
        good = good && enclosure_is_finite(m->start[i]);
    }
    if (!good) {
        diag_error(errors, of->at, NULL,
                   "a number in the equations of '%s' is not finite: its interval has no bounds",
                   of->name);
    }
    return good;
}

static bool derive(making *k, exact_motion *m) {
    const mechanism *of = k->instance->mechanism;
    if (!read_starts(k, m) || !(of->is_system ? given_outright(k) : lagrange(k))) {
        return false;
    }
    if (!solve(k)) {
        diag_error(k->errors, of->at, "use fewer coordinates or simpler energies",
                   "the equations of '%s' are too large for a proof, or cannot be solved",
                   of->name);
        return false;
    }
    int *rate = alloc(k->states, sizeof *rate);
    for (int i = 0; i < k->states; i++) {
        const exact_state s = m->state[i];
        const bool top = s.primes + 1 == k->symbols.order[s.unknown];
        rate[i] = top ? k->solved[s.unknown] : graph_variable(k->graph, i + 1);
    }
    take_nodes(m, k->graph, rate);
    free(rate);
    return is_defined(m, of, k->errors);
}

static making begin(const instance *inst, diags *errors) {
    const mechanism *of = inst->mechanism;
    const int n = of->coordinate_count;
    struct arena *arena = arena_new();
    graph *g = graph_new();
    return (making){.arena = arena,
                    .symbols = {.graph = g,
                                .instance = inst,
                                .first = not_made(arena, n),
                                .order = not_made(arena, n),
                                .parameter = not_made(arena, of->parameter_count),
                                .let = not_made(arena, of->let_count),
                                .errors = errors},
                    .graph = g,
                    .instance = inst,
                    .count = n,
                    .matrix = not_made(arena, (int64_t)n * n),
                    .force = not_made(arena, n),
                    .solved = not_made(arena, n),
                    .errors = errors};
}

exact_motion *exact_motion_make(const instance *inst, diags *errors) {
    if (!is_smooth(inst, errors)) {
        return NULL;
    }
    making k = begin(inst, errors);
    exact_motion *m = alloc(1, sizeof *m);
    number_states(&k, m);
    if (!derive(&k, m)) {
        exact_motion_free(m);
        m = NULL;
    }
    graph_free(k.graph);
    arena_free(k.arena);
    return m;
}

void exact_motion_free(exact_motion *m) {
    if (m != NULL) {
        free(m->state);
        free(m->start);
        free(m->rate);
        free(m->node);
        free(m);
    }
}
