/* show.c: sums for readers: collected by rates and accelerations, factored. */
#include "show.h"

#include <math.h>
#include <stdlib.h>

#include "show_term.h"

/* --- sums ----------------------------------------------------------------------------------------*/

static void show_sign(const show *s, bool negative, bool first) {
    if (first) {
        fputs(negative ? "-" : "", s->out);
    } else {
        fputs(negative ? " - " : " + ", s->out);
    }
}

static void show_sum(const show *s, const poly *p) {
    piece *pieces = calloc((size_t)p->count + 1, sizeof *pieces);
    if (pieces == NULL) {
        abort();
    }
    const int count = pieces_of(s->algebra, p, pieces);
    for (int i = 0; i < count; i++) {
        show_sign(s, pieces[i].coefficient < 0.0, i == 0);
        show_product(s, &pieces[i], fabs(pieces[i].coefficient));
    }
    free(pieces);
}

/* A number that all coefficients are small whole multiples of, or 1. */
static double common_number(const piece *pieces, int count) {
    double smallest = (double)INFINITY;
    for (int i = 0; i < count; i++) {
        smallest = fmin(smallest, fabs(pieces[i].coefficient));
    }
    for (int i = 0; i < count; i++) {
        const double ratio = fabs(pieces[i].coefficient) / smallest;
        if (fabs(ratio - floor(ratio + 0.5)) > 1e-12 * ratio || ratio > 100.0) {
            return 1.0;
        }
    }
    return smallest;
}

/* The factors that every term has, as a term of its own. */
const poly *show_common(algebra *a, const poly *p) {
    const poly *common = poly_number(a, 1.0);
    const mono *first = p->terms[0].mono;
    for (int k = 0; k < first->count; k++) {
        double lowest = first->factors[k].exponent;
        for (int i = 1; i < p->count; i++) {
            const mono *m = p->terms[i].mono;
            double here = 0.0;
            for (int j = 0; j < m->count; j++) {
                here = m->factors[j].atom == first->factors[k].atom ? m->factors[j].exponent : here;
            }
            lowest = (here > 0.0) == (lowest > 0.0) && here != 0.0
                         ? (fabs(here) < fabs(lowest) ? here : lowest)
                         : 0.0;
        }
        if (lowest != 0.0) {
            common = poly_mul(a, common, poly_of_atom(a, first->factors[k].atom, lowest));
        }
    }
    return common;
}

/* The parameter that most terms contain, if at least two do. */
static const atom *shared_parameter(const poly *p) {
    const atom *best = NULL;
    int best_uses = 1;
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < p->terms[i].mono->count; k++) {
            const atom *x = p->terms[i].mono->factors[k].atom;
            int uses = 0;
            for (int j = 0; j < p->count && show_rank(x) == 0; j++) {
                for (int m = 0; m < p->terms[j].mono->count; m++) {
                    uses += p->terms[j].mono->factors[m].atom == x;
                }
            }
            if (uses > best_uses) {
                best = x;
                best_uses = uses;
            }
        }
    }
    return best;
}

static void show_group(const show *s, const poly *p, const poly *key, bool leading);

/* A sum without rates and without a factor common to all: K1*(X - L1) + K2*(...). */
static void show_parted(const show *s, const poly *p, bool leading) {
    const atom *shared = shared_parameter(p);
    algebra *a = s->algebra;
    const poly *one = poly_number(a, 1.0);
    if (shared == NULL) {
        for (int i = 0; i < p->count; i++) {
            const poly *t = poly_of_term(a, p->terms[i].coefficient, p->terms[i].mono);
            show_group(s, t, one, leading && i == 0);
        }
        return;
    }
    const poly *with = poly_number(a, 0.0);
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < p->terms[i].mono->count; k++) {
            if (p->terms[i].mono->factors[k].atom == shared) {
                with =
                    poly_add(a, with, poly_of_term(a, p->terms[i].coefficient, p->terms[i].mono));
            }
        }
    }
    const poly *without = poly_sub(a, p, with);
    if (!poly_is_zero(without)) {
        show_group(s, with, one, leading);
        show_group(s, without, one, false);
        return;
    }
    if (!leading) {
        fputs(" + ", s->out);
    }
    show_sum(s, p); /* every term has it, in powers of different signs */
}

/* sign and size * common * (inside) * key / below, each part left out where it is one. */
static void show_group(const show *s, const poly *p, const poly *key, bool leading) {
    algebra *a = s->algebra;
    piece *pieces = calloc((size_t)p->count + 1, sizeof *pieces);
    if (pieces == NULL) {
        abort();
    }
    const int count = pieces_of(a, p, pieces);
    const double number = common_number(pieces, count);
    bool negative = true;
    for (int i = 0; i < count; i++) {
        negative = negative && pieces[i].coefficient < 0.0;
    }
    if (count == 1) { /* a single product: write it with its key */
        const poly *whole = poly_mul(a, p, key);
        if (pieces_of(a, whole, pieces) == 1) {
            show_sign(s, pieces[0].coefficient < 0.0, leading);
            show_product(s, &pieces[0], fabs(pieces[0].coefficient));
            free(pieces);
            return;
        }
    }
    free(pieces);
    const poly *common = show_common(a, p);
    const mono *outside = common->terms[0].mono;
    const bool bare = key->terms[0].mono->count == 0;
    if (bare && outside->count == 0 && number == 1.0 && !negative) {
        show_parted(s, p, leading);
        return;
    }
    const poly *inside = poly_mul(a, p, poly_pow(a, common, -1.0));
    inside = poly_scale(a, inside, (negative ? -1.0 : 1.0) / number);
    double top;
    double bottom;
    show_as_fraction(number, &top, &bottom);
    show_sign(s, negative, leading);
    const piece front = {top, outside, NULL, 0, 0};
    bool first = true;
    if (top != 1.0) {
        show_separate(s, &first);
        show_number(s, top);
    }
    show_factors(s, &front, 1, &first);
    show_separate(s, &first);
    fputs(s->style == SHOW_LATEX ? "\\left(" : "(", s->out);
    show_sum(s, inside);
    fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out);
    if (!bare) {
        show_separate(s, &first);
        const piece behind = {1.0, key->terms[0].mono, NULL, 0, 0};
        show_product(s, &behind, 1.0);
    }
    const int below = show_count_below(&front) + (bottom != 1.0);
    if (below > 0) {
        fputs(below > 1 ? "/(" : "/", s->out);
        first = true;
        if (bottom != 1.0) {
            show_separate(s, &first);
            show_number(s, bottom);
        }
        show_factors(s, &front, -1, &first);
        fputs(below > 1 ? ")" : "", s->out);
    }
}

/* The rates and accelerations of a term: what its coefficient is collected by. */
static const poly *motion_of(algebra *a, const mono *m, int *highest) {
    const poly *key = poly_number(a, 1.0);
    *highest = 0;
    for (int i = 0; i < m->count; i++) {
        const atom *x = m->factors[i].atom;
        if (x->kind == ATOM_SYMBOL && x->primes > 0 && m->factors[i].exponent > 0.0) {
            key = poly_mul(a, key, poly_of_atom(a, x, m->factors[i].exponent));
            *highest = x->primes > *highest ? x->primes : *highest;
        }
    }
    return key;
}

int show_size(const poly *p) { return p->count; }

void show_poly(const show *s, const poly *p) {
    algebra *a = s->algebra;
    if (poly_is_zero(p)) {
        fputs("0", s->out);
        return;
    }
    const poly **keys = calloc((size_t)p->count, sizeof *keys);
    int *highest = calloc((size_t)p->count, sizeof *highest);
    if (keys == NULL || highest == NULL) {
        abort();
    }
    for (int i = 0; i < p->count; i++) {
        keys[i] = motion_of(a, p->terms[i].mono, &highest[i]);
    }
    bool leading = true;
    for (int rank = 9; rank >= 0; rank--) {
        for (int i = 0; i < p->count; i++) {
            if (keys[i] == NULL || highest[i] != rank) {
                continue;
            }
            const poly *key = keys[i];
            const poly *group = poly_number(a, 0.0);
            for (int j = i; j < p->count; j++) {
                if (keys[j] == key) {
                    const poly *t = poly_of_term(a, p->terms[j].coefficient, p->terms[j].mono);
                    group = poly_add(a, group, poly_mul(a, t, poly_pow(a, key, -1.0)));
                    keys[j] = NULL;
                }
            }
            show_group(s, group, key, leading);
            leading = false;
        }
    }
    free(keys);
    free(highest);
}
