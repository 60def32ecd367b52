/* sums.c: adding many polys at once. Adding them one by one would make, and keep, every sum between. */
#include <stdlib.h>

#include "algebra.h"
#include "host/base/room.h"
#include "host/number/folding.h"
#include "poly.h"

static void push(poly_sum *s, const mono *m, double coefficient) {
    if (s->count == s->room) {
        s->room = s->room == 0 ? 64 : s->room * 2;
        s->items = room_more(s->items, (int64_t)s->room, sizeof *s->items);
    }
    s->items[s->count] = (sum_item){m, coefficient, s->count};
    s->count++;
}

void sum_add(algebra *a, poly_sum *s, const poly *p, double scale) {
    algebra_work(a, (size_t)p->count + 1);
    for (int i = 0; i < p->count && !a->overflow; i++) {
        push(s, p->terms[i].mono, folding_product(p->terms[i].coefficient, scale));
    }
}

static int by_mono(const void *x, const void *y) {
    const sum_item *left = x;
    const sum_item *right = y;
    if (left->mono != right->mono) {
        return mono_order(left->mono, right->mono);
    }
    return left->turn < right->turn ? -1 : 1;
}

/* Sort, and add what belongs to the same product in the order in which it came. */
static void collect(poly_sum *s) {
    if (s->count > 1) {
        qsort(s->items, s->count, sizeof *s->items, by_mono);
    }
    size_t kept = 0;
    for (size_t i = 0; i < s->count;) {
        sum_item sum = s->items[i++];
        for (; i < s->count && s->items[i].mono == sum.mono; i++) {
            sum.coefficient = coefficient_sum(sum.coefficient, s->items[i].coefficient);
        }
        if (sum.coefficient != 0.0) {
            s->items[kept++] = sum;
        }
    }
    s->count = kept;
}

void sum_add_row(poly_sum *s, poly_sum *row) {
    collect(row);
    for (size_t i = 0; i < row->count; i++) {
        push(s, row->items[i].mono, row->items[i].coefficient);
    }
    row->count = 0;
}

const poly *sum_close(algebra *a, poly_sum *s) {
    collect(s);
    poly *p = poly_scratch((int)s->count);
    for (size_t i = 0; i < s->count; i++) {
        p->terms[p->count++] = (poly_term){s->items[i].coefficient, s->items[i].mono};
    }
    const poly *made = poly_intern(a, p);
    free(p);
    free(s->items);
    *s = (poly_sum){0};
    return made;
}
