/* pieces.c: powers of sines and cosines from multiple angles.
 *
 * With s = sin(x)^2 and c = cos(x)^2, a sum over k = 0 ... n of a_k cos 2kx is a sum of products
 * s^j c^(n-j), and one of sin 2kx is sin x cos x times such a sum of degree n - 1. Where it has no c^n, it
 * cancels near x = 0, and without s^n near x = pi/2: there the products keep the digits. */
#include "pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/number/folding.h"

/* Coefficients that differ by less than this part count as equal: they come from the same number. */
#define SAME 1e-13
/* What is left of a sum below this part of what was added counts as cancelled, as in the algebra. */
#define CANCELLED 1e-14
/* Powers are put back up to sin(x)^16, from k = 0 ... 8. */
#define MULTIPLE_MAX 8
#define INDICES (MULTIPLE_MAX + 1)
/* The numbers that make up what is put back may be so much larger, without their signs, at the worst
 * angle, than the sum it replaces: more would lose elsewhere what is won near the zero. */
#define GROWTH_MAX 8.0

/* One by one: between a pointer of 32 bits and a double there may be bytes that belong to neither. */
static bool same_factors(const mono *x, const mono *y) {
    bool same = x->count == y->count;
    for (int i = 0; i < x->count && same; i++) {
        same = x->factors[i].atom == y->factors[i].atom &&
               x->factors[i].exponent == y->factors[i].exponent;
    }
    return same;
}

static bool halves_to_whole(const poly *angle) {
    for (int i = 0; i < angle->count; i++) {
        if (number_remainder(angle->terms[i].coefficient, 2.0) != 0.0) {
            return false;
        }
    }
    return true;
}

/* --- families of multiple angles -----------------------------------------------------------------*/

typedef struct family {
    trig trig;                   /* TRIG_COS: c_k cos 2kx; TRIG_SIN: c_k sin 2kx */
    int last;                    /* largest k */
    double coefficient[INDICES]; /* c_k */
    int member[INDICES];         /* the poly's term, or -1 */
    int members;
} family;

/* m with angle = m * base, a whole number; 0 when there is none. */
static int multiple_of(const poly *angle, const poly *base) {
    if (angle->count != base->count) {
        return 0;
    }
    const double m = angle->terms[0].coefficient / base->terms[0].coefficient;
    bool good = m == number_floor(m) && m >= 1.0 && m <= MULTIPLE_MAX;
    for (int i = 0; i < angle->count && good; i++) {
        good = angle->terms[i].mono == base->terms[i].mono &&
               angle->terms[i].coefficient == m * base->terms[i].coefficient;
    }
    return good ? (int)m : 0;
}

/* The terms that belong to term `base`: false when its angle is itself a multiple of another's. */
static bool collect(const poly *p, const bool *used, int base, family *f) {
    const mono *lead = p->terms[base].mono;
    *f = (family){.trig = lead->trig};
    memset(f->member, -1, sizeof f->member);
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        const bool flat = lead->trig == TRIG_COS && m->trig == TRIG_NONE;
        if (used[i] || !same_factors(m, lead) || (m->trig != lead->trig && !flat)) {
            continue;
        }
        if (!flat && i != base && multiple_of(lead->angle, m->angle) > 0 &&
            halves_to_whole(m->angle)) {
            return false;
        }
        const int k = flat ? 0 : multiple_of(m->angle, lead->angle);
        if (flat || k > 0) {
            f->coefficient[k] = p->terms[i].coefficient;
            f->member[k] = i;
            f->last = k > f->last ? k : f->last;
            f->members++;
        }
    }
    return true;
}

/* A sum of coefficient[j] s^j c^(degree-j); `added` is what was added up without signs. */
typedef struct products {
    int degree;
    double coefficient[INDICES];
    double added[INDICES];
} products;

/* p (s + c) = p, written one degree higher. */
static void times_one(double *p, int degree) {
    p[degree + 1] = 0.0;
    for (int j = degree + 1; j > 0; j--) {
        p[j] += p[j - 1];
    }
}

/* The family's sum, but for sin x cos x. With P_0 = cos 0 = 1 or P_1 = sin 2x / (sin x cos x) = 2,
 * P_(k+1) = 2 (c - s) P_k - (c + s)^2 P_(k-1). */
static products expand(const family *f) {
    const int first = f->trig == TRIG_SIN ? 1 : 0;
    double before[INDICES + 1] = {0};
    double now[INDICES + 1] = {first == 1 ? 2.0 : 1.0};
    products sum = {.degree = f->last - first};
    for (int k = first; k <= f->last; k++) {
        const int degree = k - first;
        if (degree > 0) {
            times_one(sum.coefficient, degree - 1);
            times_one(sum.added, degree - 1);
        }
        for (int j = 0; j <= degree; j++) {
            sum.coefficient[j] += f->coefficient[k] * now[j];
            sum.added[j] += fabs(f->coefficient[k] * now[j]);
        }
        /* cos 2x is half of what the recurrence would make of cos 0 alone */
        const double turn = k == 0 ? 1.0 : 2.0;
        double next[INDICES + 1] = {0};
        for (int j = 0; j <= degree + 1 && j < INDICES; j++) {
            next[j] =
                turn * ((j <= degree ? now[j] : 0.0) - (j > 0 ? now[j - 1] : 0.0)) - before[j];
        }
        memcpy(before, now, sizeof before);
        memcpy(now, next, sizeof now);
        if (degree + 2 < INDICES) {
            times_one(before, degree);
            times_one(before, degree + 1);
        }
    }
    return sum;
}

/* The largest value of |sin x|^a |cos x|^b. */
static double largest_product(int a, int b) {
    const double share = a + b > 0 ? (double)a / (a + b) : 0.0;
    return number_power(share, a / 2.0) * number_power(1.0 - share, b / 2.0);
}

/* Put the family's products into pieces[]; returns how many, 0 when it should stay as it is. */
static int products_of(algebra *a, const poly *p, int base, const family *f, piece *pieces) {
    const products sum = expand(f);
    double before = 0.0;
    for (int k = 0; k <= f->last; k++) {
        before += fabs(f->coefficient[k]);
    }
    const mono *lead = p->terms[base].mono;
    const poly *angle = poly_scale(a, lead->angle, 0.5);
    const int front = f->trig == TRIG_SIN ? 1 : 0;
    double after = 0.0;
    int count = 0;
    bool vanishes = false; /* at 0 or at pi/2 */
    for (int j = 0; j <= sum.degree; j++) {
        if (folding_cancels(sum.coefficient[j], sum.added[j], CANCELLED)) {
            vanishes = vanishes || j == 0 || j == sum.degree;
            continue;
        }
        if (count == f->members) {
            return 0; /* more terms than before */
        }
        const int sines = front + 2 * j;
        const int cosines = front + 2 * (sum.degree - j);
        after += sum.added[j] * largest_product(sines, cosines);
        pieces[count++] = (piece){sum.coefficient[j], lead, angle, sines, cosines};
    }
    return f->last > 1 && vanishes && after <= GROWTH_MAX * before ? count : 0;
}

/* The products of every family; what they are made of is used. */
static int find_families(algebra *a, const poly *p, bool *used, piece *pieces) {
    int count = 0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        family f;
        if (used[i] || m->trig == TRIG_NONE || !halves_to_whole(m->angle) ||
            !collect(p, used, i, &f)) {
            continue;
        }
        const int made = products_of(a, p, i, &f, pieces + count);
        for (int k = 0; k <= f.last && made > 0; k++) {
            if (f.member[k] >= 0) {
                used[f.member[k]] = true;
            }
        }
        count += made;
    }
    return count;
}

/* --- squares -------------------------------------------------------------------------------------*/

/* c (1 - cos 2x) and c (1 + cos 2x), also where other multiples of x do not belong to them. */
static int find_squares(algebra *a, const poly *p, bool *used, piece *pieces) {
    int count = 0;
    for (int i = 0; i < p->count; i++) {
        const poly_term *turning = &p->terms[i];
        if (used[i] || turning->mono->trig != TRIG_COS || !halves_to_whole(turning->mono->angle)) {
            continue;
        }
        for (int j = 0; j < p->count; j++) {
            const poly_term *flat = &p->terms[j];
            if (used[j] || flat->mono->trig != TRIG_NONE ||
                !same_factors(flat->mono, turning->mono) ||
                !folding_same(fabs(flat->coefficient), fabs(turning->coefficient), SAME)) {
                continue;
            }
            const bool like = (flat->coefficient < 0.0) == (turning->coefficient < 0.0);
            pieces[count++] =
                (piece){2.0 * flat->coefficient, turning->mono,
                        poly_scale(a, turning->mono->angle, 0.5), like ? 0 : 2, like ? 2 : 0};
            used[i] = used[j] = true;
            break;
        }
    }
    return count;
}

int pieces_of(algebra *a, const poly *p, piece *pieces) {
    bool *used = room(p->count, sizeof *used);
    int count = find_families(a, p, used, pieces);
    count += find_squares(a, p, used, pieces + count);
    for (int i = 0; i < p->count; i++) {
        if (!used[i]) {
            const mono *m = p->terms[i].mono;
            pieces[count++] = (piece){p->terms[i].coefficient, m, m->angle, m->trig == TRIG_SIN,
                                      m->trig == TRIG_COS};
        }
    }
    free(used);
    return count;
}
