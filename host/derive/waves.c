/* waves.c: which sines are evaluated, and which follow by the addition theorems.
 *
 * Evaluating a pair costs some thirty instructions, sin(a + b) from known pairs at most six. So the
 * angles are taken in order of size, and one that is a sum, a difference or the double of others is
 * not evaluated. An angle such as theta2 - theta1 that stands alone is evaluated as one phase. Where another angle leads,
 * it is evaluated as well: of b = a - (a - b) and 2a - b = a + (a - b) all four products are shared. */
#include "waves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

/* Of many known angles only the first, the smallest, are tried as parts of another. */
#define PARTS_MAX 96
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
    if (l->wave_count == l->wave_room) {
        l->wave_room = l->wave_room == 0 ? 16 : l->wave_room * 2;
        l->waves = room_more(l->waves, l->wave_room, sizeof *l->waves);
    }
    w.sine = -1;
    w.cosine = -1;
    l->waves[l->wave_count] = w;
    return l->wave_count++;
}

/* How large an angle is: sum of the factors of its parts. */
static double size_of(const poly *angle) {
    double size = 0.0;
    for (int i = 0; i < angle->count; i++) {
        size += fabs(angle->terms[i].coefficient);
    }
    return size + 0.01 * angle->count;
}

/* Angles are kept with a positive first factor: cos(-x) = cos(x), sin(-x) = -sin(x). */
static const poly *upright(lowering *l, const poly *angle, bool *flipped) {
    *flipped = angle->count > 0 && angle->terms[0].coefficient < 0.0;
    return *flipped ? poly_scale(l->algebra, angle, -1.0) : angle;
}

/* How many sines stand inside one another in it. */
static int sines_inside(const poly *p) {
    int most = 0;
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        int here = m->angle == NULL ? 0 : 1 + sines_inside(m->angle);
        most = here > most ? here : most;
        for (int k = 0; k < m->count; k++) {
            const atom *x = m->factors[k].atom;
            const int own = lower_is_tangent(x);
            for (int j = 0; j < 2 && x->kind != ATOM_SYMBOL && x->argument[j] != NULL; j++) {
                here = own + sines_inside(x->argument[j]);
                most = here > most ? here : most;
            }
        }
    }
    return most;
}

/* May a wave be part of this angle's rule? Not if more sines are inside it: the angle's own could be one of
 * them, and each would be made from the other. Rules lead to earlier waves, evaluating one to fewer sines
 * inside: so there is an end. */
static bool may_be_part(const lowering *l, int part, const poly *angle) {
    return sines_inside(l->waves[part].angle) <= sines_inside(angle);
}

/* A rule that makes `angle` from two known ones, if there is one. */
static bool rule_for(lowering *l, const poly *angle, wave *w) {
    int longest = 0;
    for (int i = 0; i < l->wave_count; i++) {
        longest = l->waves[i].angle->count > longest ? l->waves[i].angle->count : longest;
    }
    for (int i = 0; i < l->wave_count && i < PARTS_MAX; i++) {
        bool flipped;
        const poly *rest = poly_sub(l->algebra, angle, l->waves[i].angle);
        double number;
        if (poly_is_number(rest, &number) || rest->count > longest) {
            continue; /* equal but for a fixed offset: no help; or none of those known */
        }
        rest = upright(l, rest, &flipped);
        const int other = find(l, rest);
        if (other < 0 || !may_be_part(l, i, angle) || !may_be_part(l, other, angle)) {
            continue;
        }
        if (other == i) {
            *w = (wave){angle, WAVE_DOUBLE, i, i, -1, -1};
            return true;
        }
        *w = (wave){angle, flipped ? WAVE_DIFFERENCE : WAVE_SUM, i, other, -1, -1};
        return true;
    }
    return false;
}

/* The turn angle that the term is a number times of, or -1. */
static int turn_of(const lowering *l, const poly_term *t) {
    const mono *m = t->mono;
    const bool alone = m->trig == TRIG_NONE && m->count == 1 && m->factors[0].exponent == 1.0;
    const atom *x = alone ? m->factors[0].atom : NULL;
    return alone && x->kind == ATOM_SYMBOL && x->primes == 0 ? l->turn(l->context, x->symbol) : -1;
}

bool waves_turns(const lowering *l, const poly *angle) {
    for (int i = 0; i < angle->count; i++) {
        if (turn_of(l, &angle->terms[i]) >= 0) {
            return true;
        }
    }
    return false;
}

/* Is a part of a turn angle in it, such as half of one? */
static bool has_part(const lowering *l, const poly *angle) {
    for (int i = 0; i < angle->count; i++) {
        if (!tape_is_whole(angle->terms[i].coefficient) && turn_of(l, &angle->terms[i]) >= 0) {
            return true;
        }
    }
    return false;
}

/* What has parts of turn angles stands in records only: it is evaluated, so that it is as precise as a
 * sine can be, and nothing follows from it, so that whoever stands beside it keeps its bits. */
static int without_parts(const lowering *l, const poly **angles, int count) {
    int kept = 0;
    for (int i = 0; i < count; i++) {
        if (!has_part(l, angles[i])) {
            angles[kept++] = angles[i];
        }
    }
    return kept;
}

void waves_plan(lowering *l, const poly **angles, int count) {
    count = without_parts(l, angles, count);
    for (int i = 1; i < count; i++) { /* smallest first; stable */
        const poly *angle = angles[i];
        int j = i;
        while (j > 0 && size_of(angles[j - 1]) > size_of(angle)) {
            angles[j] = angles[j - 1];
            j--;
        }
        angles[j] = angle;
    }
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
        /* One step between may do: 3a = 2a + a. */
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
        append(l, made ? w : (wave){angles[i], WAVE_EVALUATED, -1, -1, -1, -1});
    }
}

/* The phase of an angle: numbers times turn angles, a fixed offset, and the rest in radians. */
static int phase_of(lowering *l, const poly *angle) {
    double *multiple = room(l->tape->angles, sizeof *multiple);
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
    const int phase = tape_phase(l->tape, multiple, offset, radians);
    free(multiple);
    return phase;
}

/* Each operation stands in a statement of its own here and in lower.c: C leaves open which argument of a call
 * is entered first, and that would be the order of the list. */
static int sine_of(lowering *l, int i);

static int cosine_of(lowering *l, int i) {
    const wave w = l->waves[i];
    tape *t = l->tape;
    if (w.cosine >= 0) {
        return w.cosine;
    }
    int result = -1;
    switch (w.rule) {
    case WAVE_EVALUATED: result = tape_unary(t, OP_COS, phase_of(l, w.angle)); break;
    case WAVE_DOUBLE: {
        const int c = cosine_of(l, w.p);
        const int twice = tape_mul(t, tape_constant(t, 2.0), c);
        const int squares = tape_mul(t, twice, c);
        result = tape_sub(t, squares, tape_constant(t, 1.0));
        break;
    }
    case WAVE_SUM:
    case WAVE_DIFFERENCE: {
        const int cos_p = cosine_of(l, w.p);
        const int cos_q = cosine_of(l, w.q);
        const int cc = tape_mul(t, cos_p, cos_q);
        const int sin_p = sine_of(l, w.p);
        const int sin_q = sine_of(l, w.q);
        const int ss = tape_mul(t, sin_p, sin_q);
        result = w.rule == WAVE_SUM ? tape_sub(t, cc, ss) : tape_add(t, cc, ss);
        break;
    }
    }
    l->waves[i].cosine = result;
    return result;
}

static int sine_of(lowering *l, int i) {
    const wave w = l->waves[i];
    tape *t = l->tape;
    if (w.sine >= 0) {
        return w.sine;
    }
    int result = -1;
    switch (w.rule) {
    case WAVE_EVALUATED: result = tape_unary(t, OP_SIN, phase_of(l, w.angle)); break;
    case WAVE_DOUBLE: {
        const int c = cosine_of(l, w.p);
        const int twice = tape_mul(t, tape_constant(t, 2.0), c);
        result = tape_mul(t, twice, sine_of(l, w.p));
        break;
    }
    case WAVE_SUM:
    case WAVE_DIFFERENCE: {
        const int sin_p = sine_of(l, w.p);
        const int cos_q = cosine_of(l, w.q);
        const int sc = tape_mul(t, sin_p, cos_q);
        const int cos_p = cosine_of(l, w.p);
        const int sin_q = sine_of(l, w.q);
        const int cs = tape_mul(t, cos_p, sin_q);
        result = w.rule == WAVE_SUM ? tape_add(t, sc, cs) : tape_sub(t, sc, cs);
        break;
    }
    }
    l->waves[i].sine = result;
    return result;
}

static int planned(lowering *l, const poly *angle) {
    const int i = find(l, angle);
    return i >= 0 ? i : append(l, (wave){angle, WAVE_EVALUATED, -1, -1, -1, -1});
}

int waves_sine(lowering *l, const poly *angle) { return sine_of(l, planned(l, angle)); }
int waves_cosine(lowering *l, const poly *angle) { return cosine_of(l, planned(l, angle)); }
