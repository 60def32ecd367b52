/* lower.c: from polys to operations: half angles, factoring, sharing. */
#include "lower.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/folding.h"
#include "pieces.h"
#include "waves.h"

/* Coefficients that differ by less than this part count as equal: they come from the same number. */
#define SAME 1e-13

static piece *piece_room(const poly *p) {
    piece *pieces = room(p->count, sizeof *pieces);
    return pieces;
}

/* --- planning the sines --------------------------------------------------------------------------*/

typedef struct angle_list {
    const poly **angles;
    int count;
    int room;
} angle_list;

static void collect_angles(const lowering *l, const poly *p, angle_list *list) {
    algebra *a = l->algebra;
    piece *pieces = piece_room(p);
    const int count = pieces_of(a, p, pieces);
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < pieces[i].mono->count; j++) {
            const atom *x = pieces[i].mono->factors[j].atom;
            for (int k = 0; k < 2 && x->kind != ATOM_SYMBOL && x->argument[k] != NULL; k++) {
                collect_angles(l, x->argument[k], list);
            }
            if (lower_is_tangent(x) && waves_turns(l, x->argument[0])) {
                collect_angles(l, poly_sin(a, x->argument[0]), list);
            }
        }
        if (pieces[i].angle == NULL) {
            continue;
        }
        collect_angles(l, pieces[i].angle, list);
        bool known = false;
        for (int k = 0; k < list->count; k++) {
            known = known || list->angles[k] == pieces[i].angle;
        }
        if (!known) {
            if (list->count == list->room) {
                list->room = list->room == 0 ? 16 : list->room * 2;
                list->angles = room_more(list->angles, list->room, sizeof *list->angles);
            }
            list->angles[list->count++] = pieces[i].angle;
        }
    }
    free(pieces);
}

void lower_plan(lowering *l, const poly *const *polys, int count) {
    angle_list list = {0};
    for (int i = 0; i < count; i++) {
        collect_angles(l, polys[i], &list);
    }
    waves_plan(l, list.angles, list.count);
    free(list.angles);
}

void lower_done(lowering *l) {
    free(l->waves);
    l->waves = NULL;
    l->wave_count = 0;
    l->wave_room = 0;
}

/* --- factoring -----------------------------------------------------------------------------------*/

#define FACTORS_MAX 24
/* Whole exponents beyond this are no row of products, in tape_power() either. They are taken at once: an int would
 * cut large ones, and a reciprocal taken before them would have its rounding multiplied. */
#define EXPONENT_MAX 64.0

typedef struct power {
    int node;
    int exponent; /* positive */
} power;

typedef struct product {
    double coefficient;
    int count;
    power powers[FACTORS_MAX];
} product;

static void product_multiply(lowering *l, product *p, int node, int exponent) {
    double value;
    if (tape_is_constant(l->tape, node, &value)) {
        p->coefficient = folding_product(p->coefficient, folding_power(value, exponent));
        return;
    }
    for (int i = 0; i < p->count; i++) {
        if (p->powers[i].node == node) {
            p->powers[i].exponent += exponent;
            return;
        }
    }
    if (p->count == FACTORS_MAX) { /* never seen; still correct */
        const int last = FACTORS_MAX - 1;
        const int first = tape_power(l->tape, p->powers[last].node, p->powers[last].exponent);
        const int more = tape_power(l->tape, node, exponent);
        p->powers[last].node = tape_mul(l->tape, first, more);
        p->powers[last].exponent = 1;
        return;
    }
    p->powers[p->count++] = (power){node, exponent};
}

static int atom_node(lowering *l, const atom *x) {
    if (x->kind == ATOM_SYMBOL) {
        return l->leaf(l->context, l->tape, x->symbol, x->primes);
    }
    /* a phase has 1.5e-9 rad: enough for a turn angle, whose own digits these are, not for a small number */
    if (lower_is_tangent(x) && waves_turns(l, x->argument[0])) {
        const int s = waves_sine(l, x->argument[0]);
        return tape_div(l->tape, s, waves_cosine(l, x->argument[0]));
    }
    const int first = lower(l, x->argument[0]);
    const int second = x->argument[1] == NULL ? -1 : lower(l, x->argument[1]);
    switch (x->kind) {
    case ATOM_SYMBOL:
    case ATOM_GROUP: break;
    case ATOM_POWER: return tape_pow(l->tape, first, second);
    case ATOM_CALL: return tape_call(l->tape, x->function, first, second);
    }
    return first;
}

static void product_factor(lowering *l, product *p, const mono_factor *f) {
    int node = atom_node(l, f->atom);
    double size = fabs(f->exponent);
    if (size != number_floor(size)) {
        if (2.0 * size == number_floor(2.0 * size) && size < 32.0) {
            node = tape_unary(l->tape, OP_SQRT, node);
            size *= 2.0;
        } else {
            node = tape_power(l->tape, node, size);
            size = 1.0;
        }
    }
    if (size > EXPONENT_MAX) {
        node = tape_power(l->tape, node, size);
        size = 1.0;
    }
    if (f->exponent < 0.0) {
        node = tape_div(l->tape, tape_constant(l->tape, 1.0), node);
    }
    product_multiply(l, p, node, (int)size);
}

/* Sum of the products' nodes with one size of coefficient taken out: c (x - y + ...). */
static int sum_of_like(lowering *l, const product *products, const int *nodes, const bool *member,
                       int count, double size) {
    tape *t = l->tape;
    int sum = tape_constant(t, 0.0);
    for (int sign = 0; sign < 2; sign++) {
        for (int i = 0; i < count; i++) {
            if (member[i] && (products[i].coefficient < 0.0) == (sign == 1)) {
                sum = sign == 0 ? tape_add(t, sum, nodes[i]) : tape_sub(t, sum, nodes[i]);
            }
        }
    }
    return tape_mul(t, tape_constant(t, size), sum);
}

/* Products without a common factor: terms with coefficients of one size are added first. */
static int sum_flat(lowering *l, const product *products, int count) {
    tape *t = l->tape;
    int *nodes = room(count, sizeof *nodes);
    bool *done = room(count, sizeof *done);
    bool *member = room(count, sizeof *member);
    for (int i = 0; i < count; i++) {
        nodes[i] = tape_constant(t, 1.0);
        for (int k = 0; k < products[i].count; k++) {
            const power *p = &products[i].powers[k];
            nodes[i] = tape_mul(t, nodes[i], tape_power(t, p->node, p->exponent));
        }
    }
    int sum = tape_constant(t, 0.0);
    for (int i = 0; i < count; i++) {
        if (done[i]) {
            continue;
        }
        const double size = fabs(products[i].coefficient);
        bool all_negative = true;
        for (int k = 0; k < count; k++) {
            member[k] = !done[k] && folding_same(fabs(products[k].coefficient), size, SAME);
            done[k] = done[k] || member[k];
            all_negative = all_negative && (!member[k] || products[k].coefficient < 0.0);
        }
        const int part =
            sum_of_like(l, products, nodes, member, count, all_negative ? -size : size);
        /* sum_of_like subtracts negative products; with -size outside they must be added */
        sum = all_negative ? tape_add(t, sum, tape_unary(t, OP_NEG, part)) : tape_add(t, sum, part);
    }
    free(nodes);
    free(done);
    free(member);
    return sum;
}

static int by_number(const void *x, const void *y) {
    const int left = *(const int *)x;
    const int right = *(const int *)y;
    return (left > right) - (left < right);
}

/* Most sums are short, and qsort() has a long way to its first comparison. */
static void sort_numbers(int *numbers, int count) {
    enum { SHORT = 24 };
    if (count > SHORT) {
        qsort(numbers, (size_t)count, sizeof *numbers, by_number);
        return;
    }
    for (int i = 1; i < count; i++) {
        const int moving = numbers[i];
        int at = i;
        for (; at > 0 && numbers[at - 1] > moving; at--) {
            numbers[at] = numbers[at - 1];
        }
        numbers[at] = moving;
    }
}

/* The nodes of all products, sorted; *total is their number. */
static int *sorted_nodes(const product *products, int count, int *total) {
    *total = 0;
    for (int i = 0; i < count; i++) {
        *total += products[i].count;
    }
    int *nodes = room_more(NULL, *total, sizeof *nodes);
    int at = 0;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < products[i].count; k++) {
            nodes[at++] = products[i].powers[k].node;
        }
    }
    sort_numbers(nodes, *total);
    return nodes;
}

/* How often `node` is among the sorted nodes. */
static int times_in(const int *nodes, int total, int node) {
    int edge[2]; /* the first not below the node, the first above it */
    for (int side = 0; side < 2; side++) {
        int low = 0;
        int high = total;
        while (low < high) {
            const int middle = low + (high - low) / 2;
            if (nodes[middle] < node + side) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        edge[side] = low;
    }
    return edge[1] - edge[0];
}

/* The node that most products share; rates first, so that sums of sines stay whole. -1: none. */
static int most_shared(const lowering *l, const product *products, int count) {
    int total;
    int *nodes = sorted_nodes(products, count, &total);
    int best = -1;
    int best_uses = 1;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < products[i].count; k++) {
            const int node = products[i].powers[k].node;
            const int uses = times_in(nodes, total, node);
            const bool rate = l->tape->ops[node].code == OP_RATE;
            const bool best_rate = best >= 0 && l->tape->ops[best].code == OP_RATE;
            if (uses > best_uses || (uses == best_uses && best >= 0 && rate && !best_rate)) {
                best = node;
                best_uses = uses;
            }
        }
    }
    free(nodes);
    return best;
}

/* Takes the products apart: they are of no use after it. */
static int sum_of(lowering *l, product *products, int count) {
    tape *t = l->tape;
    if (count <= 0) {
        return tape_constant(t, 0.0);
    }
    const int shared = count == 1 ? -1 : most_shared(l, products, count);
    if (shared < 0) {
        return sum_flat(l, products, count);
    }
    int lowest = 1 << 20;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < products[i].count; k++) {
            if (products[i].powers[k].node == shared && products[i].powers[k].exponent < lowest) {
                lowest = products[i].powers[k].exponent;
            }
        }
    }
    product *with = room_more(NULL, count, sizeof *with); /* large: not cleared */
    int in = 0;
    int out = 0; /* those without it move to the front */
    for (int i = 0; i < count; i++) {
        product *p = &products[i];
        int k = 0;
        while (k < p->count && p->powers[k].node != shared) {
            k++;
        }
        if (k == p->count) {
            if (out < i) {
                products[out] = *p;
            }
            out++;
            continue;
        }
        p->powers[k].exponent -= lowest;
        if (p->powers[k].exponent == 0) {
            p->powers[k] = p->powers[--p->count];
        }
        with[in++] = *p;
    }
    bool negative = out > 0; /* then the sum is taken away: no operation for its sign */
    for (int i = 0; i < in; i++) {
        negative = negative && with[i].coefficient < 0.0;
    }
    for (int i = 0; i < in && negative; i++) {
        with[i].coefficient = -with[i].coefficient;
    }
    const int inside = sum_of(l, with, in);
    free(with);
    const int outside = sum_of(l, products, out);
    const int part = tape_mul(t, inside, tape_power(t, shared, lowest));
    return negative ? tape_sub(t, outside, part) : tape_add(t, outside, part);
}

int lower(lowering *l, const poly *p) {
    piece *pieces = piece_room(p);
    const int count = pieces_of(l->algebra, p, pieces);
    product *products = room(count, sizeof *products);
    for (int i = 0; i < count; i++) {
        products[i].coefficient = pieces[i].coefficient;
        for (int k = 0; k < pieces[i].mono->count; k++) {
            product_factor(l, &products[i], &pieces[i].mono->factors[k]);
        }
        if (pieces[i].sines > 0) {
            product_multiply(l, &products[i], waves_sine(l, pieces[i].angle), pieces[i].sines);
        }
        if (pieces[i].cosines > 0) {
            product_multiply(l, &products[i], waves_cosine(l, pieces[i].angle), pieces[i].cosines);
        }
    }
    const int result = sum_of(l, products, count);
    free(products);
    free(pieces);
    return result;
}
