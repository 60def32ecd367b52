/* blamed.c: see blamed.h. */
#include "blamed.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"

blamed blamed_open(const image *im) {
    blamed b = {.image = im,
                .state = room(im->count, sizeof *b.state),
                .input = room(im->inputs, sizeof *b.input),
                .value = room(im->blame.nodes, sizeof *b.value)};
    image_inputs(im, b.input);
    for (int i = 0; i < im->count; i++) {
        b.state[i] = room(im->unknown[i].order + 1, sizeof **b.state);
    }
    return b;
}

void blamed_close(blamed *b) {
    for (int i = 0; i < b->image->count; i++) {
        free(b->state[i]);
    }
    free(b->state);
    free(b->input);
    free(b->value);
}

void blamed_place(blamed *b, const double *angle_rad, const double *real) {
    const image *im = b->image;
    for (int i = 0; i < im->angles; i++) {
        b->state[im->angle[i].unknown][0] = angle_rad[i];
    }
    for (int i = 0; i < im->reals; i++) {
        b->state[im->real[i].unknown][im->real[i].primes] = real[i];
    }
}

double blamed_node(const blamed *b, const blame_node *n) {
    const double *value = b->value;
    switch (n->code) {
    case BLAME_NUMBER: return n->number;
    case BLAME_STATE: return n->b <= b->image->unknown[n->a].order ? b->state[n->a][n->b] : 0.0;
    case BLAME_INPUT: return b->input[n->a];
    case BLAME_SAME: return value[n->a];
    case BLAME_ADD: return value[n->a] + value[n->b];
    case BLAME_SUB: return value[n->a] - value[n->b];
    case BLAME_MUL: return value[n->a] * value[n->b];
    case BLAME_DIV: return value[n->a] / value[n->b];
    case BLAME_POW: return number_power(value[n->a], value[n->b]);
    case BLAME_NEG: return -value[n->a];
    case BLAME_CALL: return number_call(n->function, value[n->a], n->b < 0 ? 0.0 : value[n->b]);
    }
    return (double)NAN;
}

int blamed_operands(const blame_node *n, int of[static 2]) {
    switch (n->code) {
    case BLAME_NUMBER:
    case BLAME_STATE:
    case BLAME_INPUT: return 0;
    case BLAME_SAME:
    case BLAME_NEG: of[0] = n->a; return 1;
    case BLAME_ADD:
    case BLAME_SUB:
    case BLAME_MUL:
    case BLAME_DIV:
    case BLAME_POW:
        of[0] = n->a;
        of[1] = n->b;
        return 2;
    case BLAME_CALL:
        of[0] = n->a;
        of[1] = n->b;
        return n->b < 0 ? 1 : 2;
    }
    return 0;
}

bool *blamed_parts(const image *im, int node) {
    bool *of = room((int64_t)node + 1, sizeof *of);
    of[node] = true;
    for (int i = node; i >= 0; i--) {
        int operand[2];
        const int count = of[i] ? blamed_operands(&im->blame.node[i], operand) : 0;
        for (int k = 0; k < count; k++) {
            of[operand[k]] = true;
        }
    }
    return of;
}
