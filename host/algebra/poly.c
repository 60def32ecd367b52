/* poly.c: sums, products and powers in the normal form. */
#include "poly.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "algebra.h"
#include "host/base/room.h"
#include "host/number/folding.h"

/* A product of sums with more terms than this is kept as a product. */
#define PRODUCT_TERMS_MAX 400000
/* Whole powers of a sum of positions from this one on stay powers: multiplied out, (x - b)^3 would lose
 * its digits near x = b. Squares do not, for the sake of what is equal only when multiplied out. */
#define POWER_KEPT 3.0

const poly *poly_of_atom(algebra *a, const atom *x, double exponent) {
    const mono_factor one = {x, exponent};
    return poly_of_term(a, 1.0, mono_make(a, &one, 1, TRIG_NONE, NULL));
}

const poly *poly_symbol(algebra *a, const symbol *sym, int primes) {
    return poly_of_atom(a, atom_symbol(a, sym, primes), 1.0);
}

bool poly_may_contain(const poly *p, const symbol *sym, int primes) {
    return (p->symbols & symbol_bit(sym, primes)) != 0;
}

/* left + factor * right: a merge of two sorted lists. */
static const poly *merge(algebra *a, const poly *left, const poly *right, double scale) {
    algebra_work(a, (size_t)left->count + (size_t)right->count);
    poly *sum = poly_scratch(left->count + right->count);
    int i = 0;
    int j = 0;
    while (i < left->count || j < right->count) {
        const mono *l = i < left->count ? left->terms[i].mono : NULL;
        const mono *r = j < right->count ? right->terms[j].mono : NULL;
        const int order = l == NULL ? 1 : r == NULL ? -1 : mono_order(l, r);
        if (order < 0) {
            sum->terms[sum->count++] = left->terms[i++];
        } else if (order > 0) {
            sum->terms[sum->count++] =
                (poly_term){folding_product(right->terms[j++].coefficient, scale), r};
        } else {
            const double x = left->terms[i++].coefficient;
            const double both =
                coefficient_sum(x, folding_product(right->terms[j++].coefficient, scale));
            if (both != 0.0) {
                sum->terms[sum->count++] = (poly_term){both, l};
            }
        }
    }
    const poly *made = poly_intern(a, sum);
    free(sum);
    return made;
}

const poly *poly_add(algebra *a, const poly *left, const poly *right) {
    return merge(a, left, right, 1.0);
}

const poly *poly_sub(algebra *a, const poly *left, const poly *right) {
    return merge(a, left, right, -1.0);
}

const poly *poly_scale(algebra *a, const poly *p, double scale) {
    if (scale == 0.0) {
        return a->zero;
    }
    return scale == 1.0 ? p : merge(a, a->zero, p, scale);
}

const poly *poly_each_number(algebra *a, const poly *p, double (*change)(double number, double by),
                             double by) {
    algebra_work(a, (size_t)p->count);
    poly *changed = poly_scratch(p->count);
    for (int i = 0; i < p->count; i++) { /* the order is one of the products alone */
        const double number = change(p->terms[i].coefficient, by);
        if (number != 0.0) {
            changed->terms[changed->count++] = (poly_term){number, p->terms[i].mono};
        }
    }
    const poly *made = poly_intern(a, changed);
    free(changed);
    return made;
}

/* --- sines and cosines ---------------------------------------------------------------------------*/

static const poly *trig_of(algebra *a, trig kind, const poly *angle) {
    double value;
    if (poly_is_number(angle, &value)) {
        return poly_number(a, folding_call(kind == TRIG_SIN ? FN_SIN : FN_COS, value, 0.0));
    }
    double sign = 1.0;
    if (angle->terms[0].coefficient < 0.0) {
        angle = poly_scale(a, angle, -1.0);
        sign = kind == TRIG_SIN ? -1.0 : 1.0;
    }
    return poly_of_term(a, sign, mono_make(a, NULL, 0, kind, angle));
}

const poly *poly_sin(algebra *a, const poly *angle) { return trig_of(a, TRIG_SIN, angle); }
const poly *poly_cos(algebra *a, const poly *angle) { return trig_of(a, TRIG_COS, angle); }

/* trig(x) * trig(y) as a sum of sines or cosines of x + y and x - y. */
static const poly *trig_product(algebra *a, trig left, const poly *x, trig right, const poly *y) {
    const poly *plus = poly_add(a, x, y);
    const poly *minus = poly_sub(a, x, y);
    const poly *p;
    if (left == TRIG_COS && right == TRIG_COS) {
        p = poly_add(a, poly_cos(a, minus), poly_cos(a, plus));
    } else if (left == TRIG_SIN && right == TRIG_SIN) {
        p = poly_sub(a, poly_cos(a, minus), poly_cos(a, plus));
    } else if (left == TRIG_SIN) {
        p = poly_add(a, poly_sin(a, plus), poly_sin(a, minus));
    } else {
        p = poly_sub(a, poly_sin(a, plus), poly_sin(a, minus));
    }
    return poly_scale(a, p, 0.5);
}

/* --- products ------------------------------------------------------------------------------------*/

/* Powers that do not stay a power: |p|^n = p^n for an even n, and a whole power of a group that is small enough to
 * be multiplied out. Returns NULL for all others. */
static const poly *power_expands(algebra *a, const mono_factor *f) {
    if (f->atom->kind == ATOM_CALL && f->atom->function == FN_ABS && f->exponent >= 2.0) {
        const poly *inside = f->atom->argument[0];
        const double even = 2.0 * number_floor(f->exponent / 2.0);
        const poly *opened = even == 2.0 ? poly_mul(a, inside, inside) : poly_pow(a, inside, even);
        return f->exponent == even
                   ? opened
                   : poly_mul(a, opened, poly_of_atom(a, f->atom, f->exponent - even));
    }
    if (f->atom->kind == ATOM_GROUP && exponent_is_whole(f->exponent) && f->exponent > 0.0) {
        const poly *inside = f->atom->argument[0];
        if (f->exponent == 1.0 || power_multiplies_out(inside, f->exponent, POWER_KEPT)) {
            return poly_pow(a, inside, f->exponent);
        }
    }
    return NULL;
}

/* The product of two products; more than one term when sines multiply or a group opens. */
static const poly *mono_product(algebra *a, const mono *left, const mono *right) {
    mono *product = mono_scratch(left->count + right->count);
    const poly *extra = NULL;
    int i = 0;
    int j = 0;
    while (i < left->count || j < right->count) {
        const int order = i >= left->count ? 1
                          : j >= right->count
                              ? -1
                              : atom_order(left->factors[i].atom, right->factors[j].atom);
        mono_factor f;
        if (order < 0) {
            f = left->factors[i++];
        } else if (order > 0) {
            f = right->factors[j++];
        } else {
            f = left->factors[i++];
            f.exponent += right->factors[j++].exponent;
            if (fabs(f.exponent) < 1e-12) {
                continue;
            }
            const poly *opened = power_expands(a, &f);
            if (opened != NULL) {
                extra = extra == NULL ? opened : poly_mul(a, extra, opened);
                continue;
            }
        }
        product->factors[product->count++] = f;
    }
    const bool both = left->trig != TRIG_NONE && right->trig != TRIG_NONE;
    if (!both) {
        const mono *with = left->trig != TRIG_NONE ? left : right;
        product->trig = with->trig;
        product->angle = with->angle;
    }
    const poly *result = poly_of_term(a, 1.0, mono_intern(a, product));
    free(product);
    if (both) {
        const poly *sum = trig_product(a, left->trig, left->angle, right->trig, right->angle);
        result = poly_mul(a, result, sum);
    }
    return extra == NULL ? result : poly_mul(a, result, extra);
}

static const atom *group_of(algebra *a, const poly *p) {
    return atom_of_polys(a, ATOM_GROUP, FUNCTION_NONE, p, NULL);
}

static const poly *product_of(algebra *a, const poly *left, const poly *right) {
    if (left->count > 1 && right->count > 1 &&
        (double)left->count * right->count > PRODUCT_TERMS_MAX) {
        const mono_factor f = {group_of(a, right), 1.0};
        return poly_mul(a, left, poly_of_term(a, 1.0, mono_make(a, &f, 1, TRIG_NONE, NULL)));
    }
    poly_sum sum = {0};
    poly_sum row = {0};
    for (int i = 0; i < left->count && !a->overflow; i++) {
        for (int j = 0; j < right->count && !a->overflow; j++) {
            const poly *p = mono_product(a, left->terms[i].mono, right->terms[j].mono);
            sum_add(a, &row, p,
                    folding_product(left->terms[i].coefficient, right->terms[j].coefficient));
        }
        sum_add_row(&sum, &row);
    }
    free(row.items);
    return sum_close(a, &sum);
}

const poly *poly_mul(algebra *a, const poly *left, const poly *right) {
    double value;
    if (poly_is_number(left, &value)) {
        return poly_scale(a, right, value);
    }
    if (poly_is_number(right, &value)) {
        return poly_scale(a, left, value);
    }
    if (a->overflow) {
        return a->zero;
    }
    if (poly_order(right, left) < 0) { /* one order, so that rounding does not depend on it */
        const poly *swap = left;
        left = right;
        right = swap;
    }
    const poly *known = memo_get(&a->products, left, right);
    if (known == NULL) {
        known = product_of(a, left, right);
        memo_put(a, &a->products, left, right, known);
    }
    return known;
}

/* --- powers and functions ------------------------------------------------------------------------*/

/* A product to a power. Only what is true for every real value of the atoms: (x^2)^(1/2) is not x. */
static const poly *term_pow(algebra *a, const poly_term *t, double exponent) {
    const mono *m = t->mono;
    const bool whole = exponent_is_whole(exponent);
    if (whole && m->trig == TRIG_NONE) {
        mono_factor *f = room(m->count, sizeof *f);
        const poly *extra = a->one;
        int count = 0;
        for (int i = 0; i < m->count; i++) {
            f[count] = (mono_factor){m->factors[i].atom, m->factors[i].exponent * exponent};
            const poly *opened = power_expands(a, &f[count]);
            if (opened != NULL) {
                extra = poly_mul(a, extra, opened);
            } else {
                count++;
            }
        }
        const mono *powered = mono_make(a, f, count, TRIG_NONE, NULL);
        free(f);
        return poly_mul(a, poly_of_term(a, folding_power(t->coefficient, exponent), powered),
                        extra);
    }
    if (whole && exponent > 0.0 && exponent <= 16.0) {
        const poly *base = poly_of_term(a, t->coefficient, m);
        const poly *half = poly_pow(a, base, number_floor(exponent / 2.0));
        const poly *even = poly_mul(a, half, half);
        return number_remainder(exponent, 2.0) == 0.0 ? even : poly_mul(a, even, base);
    }
    if (whole && m->count > 0) { /* 1/(r cos a) = 1/r * 1/(cos a) */
        const mono *plain = mono_make(a, m->factors, m->count, TRIG_NONE, NULL);
        const mono *wave = mono_make(a, NULL, 0, m->trig, m->angle);
        return poly_mul(a, poly_pow(a, poly_of_term(a, t->coefficient, plain), exponent),
                        poly_pow(a, poly_of_term(a, 1.0, wave), exponent));
    }
    /* Take out the size of the number; its sign stays inside unless the exponent is whole. */
    const double sign = t->coefficient < 0.0 ? -1.0 : 1.0;
    const double outside = whole ? folding_power(t->coefficient, exponent)
                                 : folding_power(fabs(t->coefficient), exponent);
    const poly *inside = poly_of_term(a, whole ? 1.0 : sign, m);
    if (m->count == 1 && m->trig == TRIG_NONE && m->factors[0].exponent == 1.0 && sign > 0.0) {
        return poly_scale(a, poly_of_atom(a, m->factors[0].atom, exponent), outside);
    }
    return poly_scale(a, poly_of_atom(a, group_of(a, inside), exponent), outside);
}

/* Equal sums should be one group: by which number to divide. A whole power's is not that of a constant,
 * so that x - b stays what it is when b becomes a number. */
static double size_of_sum(const poly *p, double exponent) {
    const bool constant = p->terms[0].mono->count == 0 && p->terms[0].mono->trig == TRIG_NONE;
    return constant && exponent_is_whole(exponent) && exponent > 0.0 ? p->terms[1].coefficient
                                                                     : p->terms[0].coefficient;
}

const poly *poly_power(algebra *a, const poly *base, double exponent, double kept) {
    double value;
    if (exponent == 0.0) {
        return a->one;
    }
    if (exponent == 1.0) {
        return base;
    }
    if (poly_is_number(base, &value)) {
        return poly_number(a, folding_power(value, exponent));
    }
    if (base->count == 1) {
        return term_pow(a, &base->terms[0], exponent);
    }
    if (power_multiplies_out(base, exponent, kept)) {
        const poly *p = base;
        for (int i = 1; i < (int)exponent; i++) {
            p = poly_mul(a, p, base);
        }
        return p;
    }
    /* The sign stays inside where it cannot leave a broken power. */
    const double size = size_of_sum(base, exponent);
    const double outside = exponent_is_whole(exponent) ? size : fabs(size);
    const poly *inside = poly_scale(a, base, 1.0 / outside);
    return poly_scale(a, poly_of_atom(a, group_of(a, inside), exponent),
                      number_power(outside, exponent));
}

const poly *poly_pow(algebra *a, const poly *base, double exponent) {
    return poly_power(a, base, exponent, POWER_KEPT);
}

const poly *poly_pow_poly(algebra *a, const poly *base, const poly *exponent) {
    double value;
    if (poly_is_number(exponent, &value)) {
        return poly_pow(a, base, value);
    }
    return poly_of_atom(a, atom_of_polys(a, ATOM_POWER, FUNCTION_NONE, base, exponent), 1.0);
}

const poly *poly_call(algebra *a, function_id function, const poly *x, const poly *y) {
    double vx;
    double vy = 0.0;
    if (poly_is_number(x, &vx) && (y == NULL || poly_is_number(y, &vy))) {
        return poly_number(a, folding_call(function, vx, vy));
    }
    /* The normal form has these three itself; all others are atoms. */
    if (function == FN_SIN) {
        return poly_sin(a, x);
    }
    if (function == FN_COS) {
        return poly_cos(a, x);
    }
    if (function == FN_SQRT) {
        return poly_pow(a, x, 0.5);
    }
    return poly_of_atom(a, atom_of_polys(a, ATOM_CALL, function, x, y), 1.0);
}
