/* show_lets.c: names of the file for sums and functions, if a formula contains the whole of one. */
#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/show/show.h"
#include "host/show/show_equations.h"

/* A name is shorter than a sum, a product or a function, but not than a symbol, a number or a sine among factors. */
static bool shortens(const poly *p) {
    double number;
    const mono *m = p->count == 1 ? p->terms[0].mono : NULL;
    return !poly_is_number(p, &number) &&
           (m == NULL ||
            (m->trig == TRIG_NONE && (m->count > 1 || m->factors[0].atom->kind != ATOM_SYMBOL)));
}

void show_lets_begin(show *s, const equations *e) {
    const mechanism *m = e->instance->mechanism;
    s->lets = alloc_tail(sizeof *s->lets, m->let_count, sizeof s->lets->row[0]);
    for (int i = 0; i < m->let_count; i++) {
        const symbol *let = m->lets[i];
        const bool takes_part = let->effect < 0 || e->instance->with[let->effect];
        const poly *value = takes_part ? poly_from_expr(s->algebra, let->value) : NULL;
        if (value != NULL && !algebra_overflow(s->algebra) && shortens(value)) {
            s->lets->row[s->lets->count++] = (let_row){let, value, false};
        }
    }
    s->lets->below = s->lets->count;
}

/* Is value * ratio a part of p, term by term? The terms of both are in the same order. */
static bool is_part(const poly *p, const poly *value, double *ratio) {
    int at = 0;
    for (int i = 0; i < value->count; i++) {
        while (at < p->count && p->terms[at].mono != value->terms[i].mono) {
            at++;
        }
        if (at == p->count) {
            return false;
        }
        const double here = p->terms[at].coefficient / value->terms[i].coefficient;
        *ratio = i == 0 ? here : *ratio;
        if (fabs(here - *ratio) > 1e-13 * fabs(here)) {
            return false;
        }
    }
    return true;
}

const symbol *show_let(const show *s, const poly *p, bool whole, const poly **rest, double *ratio) {
    let_row *best = NULL;
    for (int i = 0; s->lets != NULL && i < s->lets->below; i++) {
        let_row *r = &s->lets->row[i];
        double here = 1.0;
        if (r->value->count <= p->count && (r->value->count > 1 || whole) &&
            (!whole || r->value->count == p->count) &&
            (best == NULL || r->value->count > best->value->count) && is_part(p, r->value, &here)) {
            best = r;
            *ratio = here;
        }
    }
    if (best == NULL) {
        return NULL;
    }
    best->used = true;
    *rest = whole ? poly_number(s->algebra, 0.0)
                  : poly_sub(s->algebra, p, poly_scale(s->algebra, best->value, *ratio));
    return best->let;
}

const symbol *show_let_factor(const show *s, const atom *x, double exponent) {
    for (int i = 0; s->lets != NULL && i < s->lets->below; i++) {
        let_row *r = &s->lets->row[i];
        const poly_term *t = &r->value->terms[0];
        if (r->value->count == 1 && t->coefficient == 1.0 && t->mono->count == 1 &&
            t->mono->factors[0].atom == x && t->mono->factors[0].exponent == exponent) {
            r->used = true;
            return r->let;
        }
    }
    return NULL;
}
