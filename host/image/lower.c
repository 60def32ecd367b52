/* lower.c: conversion of polys to operations: half angles, factoring, sharing. */
#include "host/image/lower.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/folding.h"

/* === turn angles ============================================================================== */

static bool whole_in_angle(const poly *angle, const symbol *sym);

static bool is_tangent(const atom *x) { return x->kind == ATOM_CALL && x->function == FN_TAN; }

/* Does `sym` occur in this product only inside sines and cosines? If `tangents`, tangents are allowed, too. */
static bool is_in_waves(const mono *m, const symbol *sym, bool tangents) {
    for (int k = 0; k < m->count; k++) {
        const atom *x = m->factors[k].atom;
        if (x->kind == ATOM_SYMBOL && x->symbol == sym && x->primes == 0) {
            return false;
        }
        const bool tangent = tangents && is_tangent(x);
        for (int j = 0; j < 2 && x->argument[j] != NULL; j++) {
            if (!(tangent ? whole_in_angle : lower_only_in_waves)(x->argument[j], sym)) {
                return false;
            }
        }
    }
    return m->angle == NULL || whole_in_angle(m->angle, sym);
}

static bool whole_in_angle(const poly *angle, const symbol *sym) {
    for (int i = 0; i < angle->count; i++) {
        const poly_term *t = &angle->terms[i];
        const bool alone = t->mono->trig == TRIG_NONE && t->mono->count == 1 &&
                           t->mono->factors[0].exponent == 1.0 &&
                           t->mono->factors[0].atom->kind == ATOM_SYMBOL;
        const bool is_sym = alone && t->mono->factors[0].atom->symbol == sym &&
                            t->mono->factors[0].atom->primes == 0;
        const bool whole = t->coefficient == number_floor(t->coefficient);
        if (is_sym ? !(whole && fabs(t->coefficient) <= 1e6) : !is_in_waves(t->mono, sym, false)) {
            return false;
        }
    }
    return true;
}

bool lower_only_in_waves(const poly *p, const symbol *sym) {
    bool only = true;
    for (int i = 0; i < p->count && only && poly_may_contain(p, sym, 0); i++) {
        only = is_in_waves(p->terms[i].mono, sym, true);
    }
    return only;
}

/* === powers from multiple angles ============================================================== */
/* Sums of cos 2kx become sums of products sin(x)^(2j) cos(x)^(2m). Sums of sin 2kx become sin x cos x times such a sum.
 * Near an x at which a sum vanishes, the products keep digits that the sum loses. */

#define SAME_PIECE 1e-13 /* coefficients with a smaller relative difference count as equal */
#define CANCELLED 1e-14  /* a sum below this, relative to its addends, counts as zero */
#define MULTIPLE_MAX 8   /* largest k in cos 2kx */
#define INDICES (MULTIPLE_MAX + 1)
#define GROWTH_MAX 8.0

/* Compares by member, because padding bytes between a 32-bit pointer and a double are undefined. */
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

typedef struct family {
    trig trig;                   /* TRIG_COS: c_k cos 2kx; TRIG_SIN: c_k sin 2kx */
    int last;                    /* largest k */
    double coefficient[INDICES]; /* c_k */
    int member[INDICES];         /* index of the poly's term that has c_k, or -1 */
    int members;
} family;

/* Returns the whole number m with angle = m * base; 0 if there is none. */
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

/* Collects the terms whose angles are multiples of the angle of term `base`. Returns false if that angle is itself a
 * multiple of another term's angle. */
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

/* The sum of coefficient[j] s^j c^(degree-j), with s = sin(x)^2 and c = cos(x)^2. added[j] sums the absolute values of
 * the numbers that coefficient[j] sums. */
typedef struct expansion {
    int degree;
    double coefficient[INDICES];
    double added[INDICES];
} expansion;

/* Multiplies p by sin(x)^2 + cos(x)^2 = 1. */
static void times_one(double *p, int degree) {
    p[degree + 1] = 0.0;
    for (int j = degree + 1; j > 0; j--) {
        p[j] += p[j - 1];
    }
}

/* Returns the sum of c_k P_k, by the recurrence P_(k+1) = 2 cos 2x P_k - P_(k-1). P_k is cos 2kx in a family of
 * cosines, and sin 2kx / (sin x cos x) in a family of sines. */
static expansion expand(const family *f) {
    const int first = f->trig == TRIG_SIN ? 1 : 0;
    double before[INDICES + 1] = {0};
    double now[INDICES + 1] = {first == 1 ? 2.0 : 1.0};
    expansion sum = {.degree = f->last - first};
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
        /* in a family of cosines, P_1 is cos 2x P_0, without the factor 2 */
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

/* Writes the family's expansion to pieces[]. Returns the number of pieces, or 0 to leave the family unchanged. */
static int products_of(algebra *a, const poly *p, int base, const family *f, piece *pieces) {
    const expansion sum = expand(f);
    double before = 0.0;
    for (int k = 0; k <= f->last; k++) {
        before += fabs(f->coefficient[k]);
    }
    const mono *lead = p->terms[base].mono;
    const poly *angle = poly_scale(a, lead->angle, 0.5);
    const int front = f->trig == TRIG_SIN ? 1 : 0;
    double after = 0.0;
    int count = 0;
    bool vanishes = false; /* is the sum zero at 0 or at pi/2? */
    for (int j = 0; j <= sum.degree; j++) {
        if (folding_cancels(algebra_folding(a), sum.coefficient[j], sum.added[j], CANCELLED)) {
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

/* Expands families, and marks their terms as used. Returns the number of pieces. */
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

/* Finds c (1 - cos 2x) and c (1 + cos 2x), which find_families() misses if other multiples of x are present. */
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
                !folding_same(algebra_folding(a), fabs(flat->coefficient),
                              fabs(turning->coefficient), SAME_PIECE)) {
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
    bool *used = alloc(p->count, sizeof *used);
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

/* === which sines are evaluated ================================================================ */
/* A sine and cosine cost some thirty instructions with WAVE_EVALUATED, and at most six with another rule. */

typedef enum wave_rule {
    WAVE_EVALUATED, /* computed by the core's sine */
    WAVE_DOUBLE,    /* twice the angle of wave p */
    WAVE_SUM,       /* the sum of the angles of waves p and q */
    WAVE_DIFFERENCE /* the angle of wave p minus that of wave q */
} wave_rule;

struct wave {
    const poly *angle;
    wave_rule rule;
    int p;
    int q;
    int sine; /* operation, or -1 */
    int cosine;
};

#define PARTS_MAX 96 /* rule_for() tries only this many waves as wave p */
#define BETWEEN_MAX 32

static int find(const lowering *l, const poly *angle) {
    for (int i = 0; i < l->wave_count; i++) {
        if (l->waves[i].angle == angle) {
            return i;
        }
    }
    return -1;
}

static int append(lowering *l, wave w) {
    l->waves = alloc_more(l->waves, l->wave_count + 1, sizeof *l->waves);
    w.sine = -1;
    w.cosine = -1;
    l->waves[l->wave_count] = w;
    return l->wave_count++;
}

/* The sum of the absolute coefficients, plus a little for each term. */
static double size_of(const poly *angle) {
    double size = 0.0;
    for (int i = 0; i < angle->count; i++) {
        size += fabs(angle->terms[i].coefficient);
    }
    return size + 0.01 * angle->count;
}

/* Negates the angle if its first coefficient is negative. *flipped: was it negated? */
static const poly *upright(lowering *l, const poly *angle, bool *flipped) {
    *flipped = angle->count > 0 && angle->terms[0].coefficient < 0.0;
    return *flipped ? poly_scale(l->algebra, angle, -1.0) : angle;
}

static int sines_inside(const poly *p) {
    int most = 0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        int here = m->angle == NULL ? 0 : 1 + sines_inside(m->angle);
        most = here > most ? here : most;
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            const int own = is_tangent(x);
            for (int j = 0; j < 2 && x->argument[j] != NULL; j++) {
                here = own + sines_inside(x->argument[j]);
                most = here > most ? here : most;
            }
        }
    }
    return most;
}

/* Prevents an endless recursion: a part with more nested sines may contain the sine of `angle`. */
static bool may_be_part(const lowering *l, int part, const poly *angle) {
    return sines_inside(l->waves[part].angle) <= sines_inside(angle);
}

/* Finds a rule that computes `angle` from one or two known angles. */
static bool rule_for(lowering *l, const poly *angle, wave *w) {
    for (int i = 0; i < l->wave_count && i < PARTS_MAX; i++) {
        bool flipped;
        const poly *rest = poly_sub(l->algebra, angle, l->waves[i].angle);
        double number;
        if (poly_is_number(rest, &number)) { /* no help: the angles differ only by a constant */
            continue;
        }
        rest = upright(l, rest, &flipped);
        const int other = find(l, rest);
        if (other < 0 || !may_be_part(l, i, angle) || !may_be_part(l, other, angle)) {
            continue;
        }
        *w = (wave){.angle = angle,
                    .rule = other == i ? WAVE_DOUBLE
                            : flipped  ? WAVE_DIFFERENCE
                                       : WAVE_SUM,
                    .p = i,
                    .q = other};
        return true;
    }
    return false;
}

/* Returns the turn angle if the term is a number times a turn angle; otherwise -1. */
static int turn_of(const lowering *l, const poly_term *t) {
    const mono *m = t->mono;
    const bool alone = m->trig == TRIG_NONE && m->count == 1 && m->factors[0].exponent == 1.0;
    const atom *x = alone ? m->factors[0].atom : NULL;
    return alone && x->kind == ATOM_SYMBOL && x->primes == 0 ? l->turn(l->context, x->symbol) : -1;
}

static bool waves_turns(const lowering *l, const poly *angle) {
    for (int i = 0; i < angle->count; i++) {
        if (turn_of(l, &angle->terms[i]) >= 0) {
            return true;
        }
    }
    return false;
}

/* Does the angle contain a fraction of a turn angle, such as half of it? */
static bool has_part(const lowering *l, const poly *angle) {
    for (int i = 0; i < angle->count; i++) {
        if (!op_list_is_whole(angle->terms[i].coefficient) && turn_of(l, &angle->terms[i]) >= 0) {
            return true;
        }
    }
    return false;
}

static void waves_plan(lowering *l, const poly **angles, int count) {
    if (l->lead > 0 && l->lead < count) {
        const poly *first = angles[l->lead];
        memmove(angles + 1, angles, (size_t)l->lead * sizeof *angles);
        angles[0] = first;
    }
    for (int i = 0; i < count; i++) {
        wave w;
        if (find(l, angles[i]) >= 0) {
            continue;
        }
        if (rule_for(l, angles[i], &w)) {
            append(l, w);
            continue;
        }
        /* tries to add an intermediate angle, such as 2a for 3a = 2a + a */
        bool made = false;
        const int known = l->wave_count;
        for (int k = 0; k < known && k < BETWEEN_MAX && !made; k++) {
            bool flipped;
            wave between;
            const poly *rest = poly_sub(l->algebra, angles[i], l->waves[k].angle);
            rest = upright(l, rest, &flipped);
            if (rest->count > 0 && rule_for(l, rest, &between)) {
                append(l, between);
                made = rule_for(l, angles[i], &w);
            }
        }
        append(l, made ? w : (wave){.angle = angles[i], .rule = WAVE_EVALUATED});
    }
}

static int phase_of(lowering *l, const poly *angle) {
    double *multiple = alloc(l->list->angles, sizeof *multiple);
    double offset = 0.0;
    const poly *rest = poly_number(l->algebra, 0.0);
    for (int i = 0; i < angle->count; i++) {
        const poly_term *t = &angle->terms[i];
        const int turn = turn_of(l, t);
        if (turn >= 0) {
            multiple[turn] += t->coefficient;
        } else if (t->mono->count == 0 && t->mono->trig == TRIG_NONE) {
            offset += t->coefficient;
        } else {
            rest = poly_add(l->algebra, rest, poly_of_term(l->algebra, t->coefficient, t->mono));
        }
    }
    const int radians = poly_is_zero(rest) ? -1 : lower(l, rest);
    const int phase = op_list_phase(l->list, multiple, offset, radians);
    free(multiple);
    return phase;
}

/* At most one argument of each call may add operations to the list: C does not order the evaluation of arguments. */
static int wave_node(lowering *l, int i, trig which);

static int waves_product(lowering *l, int p, trig of_p, int q, trig of_q) {
    const int x = wave_node(l, p, of_p);
    return op_list_mul(l->list, x, wave_node(l, q, of_q));
}

static int wave_enter(lowering *l, wave w, trig which) {
    op_list *t = l->list;
    const bool sine = which == TRIG_SIN;
    if (w.rule == WAVE_EVALUATED) {
        return op_list_unary(t, sine ? OP_SIN : OP_COS, phase_of(l, w.angle));
    }
    if (w.rule == WAVE_DOUBLE) { /* sin 2p = 2 cos p sin p, cos 2p = 2 cos p cos p - 1 */
        const int c = wave_node(l, w.p, TRIG_COS);
        const int twice = op_list_mul(t, op_list_constant(t, 2.0), c);
        const int product = op_list_mul(t, twice, wave_node(l, w.p, which));
        return sine ? product : op_list_sub(t, product, op_list_constant(t, 1.0));
    }
    /* sin(p + q) = x + y and cos(p + q) = x - y; if q is subtracted, the signs are opposite */
    const int x = waves_product(l, w.p, which, w.q, TRIG_COS);
    const int y = waves_product(l, w.p, sine ? TRIG_COS : TRIG_SIN, w.q, TRIG_SIN);
    return (w.rule == WAVE_SUM) == sine ? op_list_add(t, x, y) : op_list_sub(t, x, y);
}

static int wave_node(lowering *l, int i, trig which) {
    const wave w = l->waves[i];
    int node = which == TRIG_SIN ? w.sine : w.cosine;
    if (node < 0) {
        node = wave_enter(l, w, which);
        *(which == TRIG_SIN ? &l->waves[i].sine : &l->waves[i].cosine) = node;
    }
    return node;
}

/* The operation for the sine or cosine of `angle`. Without a planned identity, the core's function computes it. */
static int wave_of(lowering *l, const poly *angle, trig which) {
    const int i = find(l, angle);
    return wave_node(l, i >= 0 ? i : append(l, (wave){.angle = angle, .rule = WAVE_EVALUATED}),
                     which);
}

/* === polys to operations ====================================================================== */

#define SAME 1e-13 /* coefficients with a smaller relative difference count as equal */

/* Different angles, the smallest first, and equally large ones in the order of entry. */
typedef struct angle_list {
    const poly **angles;
    int count;
} angle_list;

static void collect_angles(const lowering *l, const poly *p, angle_list *list) {
    algebra *a = l->algebra;
    piece *pieces = alloc(p->count, sizeof *pieces);
    const int count = pieces_of(a, p, pieces);
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < pieces[i].mono->count; j++) {
            const atom *x = pieces[i].mono->factors[j].atom;
            for (int k = 0; k < 2 && x->argument[k] != NULL; k++) {
                collect_angles(l, x->argument[k], list);
            }
            if (is_tangent(x) && waves_turns(l, x->argument[0])) {
                collect_angles(l, poly_sin(a, x->argument[0]), list);
            }
        }
        if (pieces[i].angle == NULL) {
            continue;
        }
        collect_angles(l, pieces[i].angle, list);
        bool skipped = has_part(l, pieces[i].angle);
        for (int k = 0; k < list->count; k++) {
            skipped = skipped || list->angles[k] == pieces[i].angle;
        }
        if (!skipped) {
            list->angles = alloc_more(list->angles, list->count + 1, sizeof *list->angles);
            int at = list->count++;
            for (; at > 0 && size_of(list->angles[at - 1]) > size_of(pieces[i].angle); at--) {
                list->angles[at] = list->angles[at - 1];
            }
            list->angles[at] = pieces[i].angle;
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
    free(l->uses);
}

#define EXPONENT_MAX 64.0 /* a power with a larger exponent is one operation, not products */

void lower_multiply(lowering *l, node_product *p, int node, int exponent) {
    double value;
    if (op_list_is_constant(l->list, node, &value)) {
        folding *const f = l->list->folding;
        p->coefficient = folding_product(f, p->coefficient, folding_power(f, value, exponent));
        return;
    }
    for (int i = 0; i < p->count; i++) {
        if (p->powers[i].node == node) {
            p->powers[i].exponent += exponent;
            return;
        }
    }
    if (p->count == FACTORS_MAX) { /* no mechanism so far has that many factors */
        const int last = FACTORS_MAX - 1;
        const int first = op_list_power(l->list, p->powers[last].node, p->powers[last].exponent);
        const int more = op_list_power(l->list, node, exponent);
        p->powers[last].node = op_list_mul(l->list, first, more);
        p->powers[last].exponent = 1;
        return;
    }
    p->powers[p->count++] = (node_power){node, exponent};
}

static int atom_node(lowering *l, const atom *x) {
    if (x->kind == ATOM_SYMBOL) {
        return l->leaf(l->context, l->list, x->symbol, x->primes);
    }
    /* without a turn angle, tan() is more precise than sine and cosine of a rounded phase */
    if (is_tangent(x) && waves_turns(l, x->argument[0])) {
        const int s = wave_of(l, x->argument[0], TRIG_SIN);
        return op_list_div(l->list, s, wave_of(l, x->argument[0], TRIG_COS));
    }
    const int first = lower(l, x->argument[0]);
    const int second = x->argument[1] == NULL ? -1 : lower(l, x->argument[1]);
    switch (x->kind) {
    case ATOM_SYMBOL:
    case ATOM_GROUP: break;
    case ATOM_POWER: return op_list_pow(l->list, first, second);
    case ATOM_CALL: return op_list_call(l->list, x->function, first, second);
    }
    return first;
}

static void product_factor(lowering *l, node_product *p, const mono_factor *f) {
    int node = atom_node(l, f->atom);
    double size = fabs(f->exponent);
    if (size != number_floor(size)) {
        if (2.0 * size == number_floor(2.0 * size) && size < 32.0) {
            node = op_list_unary(l->list, OP_SQRT, node);
            size *= 2.0;
        } else {
            node = op_list_power(l->list, node, size);
            size = 1.0;
        }
    }
    if (size > EXPONENT_MAX) {
        node = op_list_power(l->list, node, size);
        size = 1.0;
    }
    if (f->exponent < 0.0) {
        node = op_list_div(l->list, op_list_constant(l->list, 1.0), node);
    }
    lower_multiply(l, p, node, (int)size);
}

/* Returns size * (sum of the members' nodes with positive coefficients - sum of those with negative ones). */
static int sum_of_like(lowering *l, const node_product *products, const int *nodes,
                       const bool *member, int count, double size) {
    op_list *t = l->list;
    int sum = op_list_constant(t, 0.0);
    for (int sign = 0; sign < 2; sign++) {
        for (int i = 0; i < count; i++) {
            if (member[i] && (products[i].coefficient < 0.0) == (sign == 1)) {
                sum = sign == 0 ? op_list_add(t, sum, nodes[i]) : op_list_sub(t, sum, nodes[i]);
            }
        }
    }
    return op_list_mul(t, op_list_constant(t, size), sum);
}

/* Takes no node out of the sum as a common factor. */
static int sum_flat(lowering *l, const node_product *products, int count) {
    op_list *t = l->list;
    int *nodes = alloc(count, sizeof *nodes);
    bool *done = alloc(count, sizeof *done);
    bool *member = alloc(count, sizeof *member);
    for (int i = 0; i < count; i++) {
        nodes[i] = op_list_constant(t, 1.0);
        for (int k = 0; k < products[i].count; k++) {
            const node_power *p = &products[i].powers[k];
            nodes[i] = op_list_mul(t, nodes[i], op_list_power(t, p->node, p->exponent));
        }
    }
    int sum = op_list_constant(t, 0.0);
    for (int i = 0; i < count; i++) {
        if (done[i]) {
            continue;
        }
        const double size = fabs(products[i].coefficient);
        bool all_negative = true;
        for (int k = 0; k < count; k++) {
            member[k] =
                !done[k] && folding_same(t->folding, fabs(products[k].coefficient), size, SAME);
            done[k] = done[k] || member[k];
            all_negative = all_negative && (!member[k] || products[k].coefficient < 0.0);
        }
        const int part =
            sum_of_like(l, products, nodes, member, count, all_negative ? -size : size);
        /* if all_negative, `part` is minus the members' sum */
        sum = all_negative ? op_list_add(t, sum, op_list_unary(t, OP_NEG, part))
                           : op_list_add(t, sum, part);
    }
    free(nodes);
    free(done);
    free(member);
    return sum;
}

/* Returns the node that occurs in the most products, or -1 if none occurs in two. A rate wins a tie. */
static int most_shared(lowering *l, const node_product *products, int count) {
    int best = -1;
    int best_uses = 1;
    if (l->uses_room < l->list->count) {
        free(l->uses);
        l->uses_room = 2 * l->list->count;
        l->uses = alloc(l->uses_room, sizeof *l->uses);
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < products[i].count; k++) {
            l->uses[products[i].powers[k].node]++;
        }
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < products[i].count; k++) {
            const int node = products[i].powers[k].node;
            const int uses = l->uses[node];
            const bool rate = l->list->ops[node].code == OP_RATE;
            const bool best_rate = best >= 0 && l->list->ops[best].code == OP_RATE;
            if (uses > best_uses || (uses == best_uses && best >= 0 && rate && !best_rate)) {
                best = node;
                best_uses = uses;
            }
        }
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < products[i].count; k++) {
            l->uses[products[i].powers[k].node] = 0;
        }
    }
    return best;
}

int lower_sum(lowering *l, node_product *products, int count) {
    op_list *t = l->list;
    if (count <= 0) {
        return op_list_constant(t, 0.0);
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
    node_product *with = alloc_more(NULL, count, sizeof *with); /* large, so not cleared */
    int in = 0;
    int out = 0; /* number of products without the node `shared`, which are moved to the front */
    for (int i = 0; i < count; i++) {
        node_product *p = &products[i];
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
    bool negative = out > 0; /* true: the sum of with[] is subtracted, which saves a negation */
    for (int i = 0; i < in; i++) {
        negative = negative && with[i].coefficient < 0.0;
    }
    for (int i = 0; i < in && negative; i++) {
        with[i].coefficient = -with[i].coefficient;
    }
    const int inside = lower_sum(l, with, in);
    free(with);
    const int outside = lower_sum(l, products, out);
    const int part = op_list_mul(t, inside, op_list_power(t, shared, lowest));
    return negative ? op_list_sub(t, outside, part) : op_list_add(t, outside, part);
}

int lower(lowering *l, const poly *p) {
    piece *pieces = alloc(p->count, sizeof *pieces);
    const int count = pieces_of(l->algebra, p, pieces);
    node_product *products = alloc(count, sizeof *products);
    for (int i = 0; i < count; i++) {
        products[i].coefficient = pieces[i].coefficient;
        for (int k = 0; k < pieces[i].mono->count; k++) {
            product_factor(l, &products[i], &pieces[i].mono->factors[k]);
        }
        if (pieces[i].sines > 0) {
            const int sine = wave_of(l, pieces[i].angle, TRIG_SIN);
            lower_multiply(l, &products[i], sine, pieces[i].sines);
        }
        if (pieces[i].cosines > 0) {
            const int cosine = wave_of(l, pieces[i].angle, TRIG_COS);
            lower_multiply(l, &products[i], cosine, pieces[i].cosines);
        }
    }
    const int result = lower_sum(l, products, count);
    free(products);
    free(pieces);
    return result;
}
