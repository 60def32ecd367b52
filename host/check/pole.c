#include "pole.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

/* Halvings until a share of the way has no more digits. */
enum { HALVINGS = 56 };
/* Factor of the distance if round-off hides the growth of a value. */
#define FARTHER 2.5
/* A smooth expression has few zeros on its way to a pole. Round-off alternates its sign, at distances that grow by
 * FURTHER. */
enum { TURNS_MOST = 4 };
#define NEAR 0.2
#define FURTHER 1.4
/* A value that touches zero is at most this part of both ends there. */
#define TOUCHES 1e-3
/* The least point of an even value is found by golden sections, to the last digit of its place. */
#define GOLDEN 0.6180339887498949
enum { SECTIONS = 72 };
/* Rejected places, each with more parts of the way around it. */
enum { PARTS_MOST = 16 };

/* Number of sampled distances, each GROWTH_CLOSER times nearer than the one before. */
enum { GROWTH_POINTS = 10 };
#define GROWTH_CLOSER 1.7099759466766968 /* the third root of 5 */
/* The farthest distance, relative to the nearest. */
#define GROWTH_REACH 125.0
/* A value that overflows must have been this large before. */
#define GROWTH_BEYOND 1e60

typedef enum growth {
    GROWTH_ROUGH, /* it does not go on evenly: rounding, or a zero; from farther off it may */
    GROWTH_NONE,  /* evenly, and no pole: it has a limit, or one over a root has */
    GROWTH_POLE   /* evenly */
} growth;

/* Least growth of a pole at each distance. A pole grows by 1.71, the distance to the power -9/10 by 1.62. The ratio of distances
 * is no power of two: numbers with the same digits have the same round-off, which would look like even growth. */
#define GROWS 1.64
/* Growth is even if its ratios differ by less than this factor. */
#define EVEN 1.1

typedef struct part {
    double low; /* shares of the way */
    double high;
} part;

typedef struct looker {
    const pole_way *way;
    double *sign; /* [signs] at the begin of a part, */
    double *then; /* and at its end */
    double *value;
    double *side;  /* [GROWTH_POINTS * values] */
    bool *done;    /* [values] it has been seen to be no pole there */
    double *touch; /* [4 * signs] */
} looker;

/* The growth of value[k * stride] at the k-th distance, the farthest first. */
static growth growth_of(const double *value, int stride) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < GROWTH_POINTS; k++) {
        const double before = value[(k - 1) * stride];
        const double now = value[k * stride];
        const double by = before == now ? 1.0 : now / before; /* both may be zero */
        if (isinf(now) && isfinite(before) && fabs(before) > GROWTH_BEYOND) {
            return GROWTH_POLE;
        }
        if (!(by > 0.0) || isinf(now)) { /* or no number, or another sign */
            return GROWTH_ROUGH;
        }
        least = number_least(least, by);
        most = number_most(most, by);
    }
    if (!(most < EVEN * least)) {
        return GROWTH_ROUGH;
    }
    return least > GROWS ? GROWTH_POLE : GROWTH_NONE;
}

/* The first that changes its sign in this part, or -1. */
static int changes(const looker *l) {
    for (int i = 0; i < l->way->signs; i++) {
        if ((l->sign[i] < 0.0 && l->then[i] > 0.0) || (l->sign[i] > 0.0 && l->then[i] < 0.0)) {
            return i;
        }
    }
    return -1;
}

bool pole_may_touch(const double value[static 4]) {
    const double begin = fabs(value[0]);
    const double end = fabs(value[3]);
    const double falls = (begin - fabs(value[1])) / POLE_ASIDE;
    const double rises = (end - fabs(value[2])) / POLE_ASIDE;
    if (!(falls > 0.0 && rises > 0.0) || value[0] * value[3] < 0.0) {
        return false;
    }
    /* crossing of the tangents */
    const double share = (begin - end + rises) / (falls + rises);
    return begin - falls * share <= TOUCHES * number_least(begin, end);
}

/* The first that may touch zero in this part, or -1. */
static int touches(const looker *l, part p) {
    const double aside = POLE_ASIDE * (p.high - p.low);
    const double share[4] = {p.low, p.low + aside, p.high - aside, p.high};
    for (int k = 0; k < 4; k++) {
        l->way->at(l->way->of, share[k], l->touch + (ptrdiff_t)k * l->way->signs, l->value);
    }
    for (int i = 0; i < l->way->signs; i++) {
        double value[4];
        for (int k = 0; k < 4; k++) {
            value[k] = l->touch[k * l->way->signs + i];
        }
        if (pole_may_touch(value)) {
            return i;
        }
    }
    return -1;
}

static double size_at(const looker *l, int i, double share) {
    l->way->at(l->way->of, share, l->then, l->value);
    return fabs(l->then[i]);
}

static double least_of(const looker *l, int i, part p) {
    double lower = p.high - GOLDEN * (p.high - p.low);
    double upper = p.low + GOLDEN * (p.high - p.low);
    double at_lower = size_at(l, i, lower);
    double at_upper = size_at(l, i, upper);
    for (int k = 0; k < SECTIONS; k++) {
        if (at_lower < at_upper) {
            p.high = upper;
            upper = lower;
            at_upper = at_lower;
            lower = p.high - GOLDEN * (p.high - p.low);
            at_lower = size_at(l, i, lower);
        } else {
            p.low = lower;
            lower = upper;
            at_lower = at_upper;
            upper = p.low + GOLDEN * (p.high - p.low);
            at_upper = size_at(l, i, upper);
        }
    }
    return 0.5 * (p.low + p.high);
}

/* The part that contains it. */
static part halve(const looker *l, int i, part p) {
    const bool rises = l->sign[i] < 0.0;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (p.low + p.high);
        l->way->at(l->way->of, middle, l->then, l->value);
        if ((l->then[i] < 0.0) == rises) {
            p.low = middle;
        } else {
            p.high = middle;
        }
    }
    return p;
}

/* Does value i change its sign again and again from `from` off the place to `most`? Then it is round-off. */
static bool is_rounding(const looker *l, int i, double place, double from, double most) {
    double before = 0.0;
    double off = from;
    int turns = 0;
    while (fabs(off) <= most) {
        l->way->at(l->way->of, place + off, l->then, l->value);
        turns += before * l->value[i] < 0.0 || l->value[i] == 0.0;
        before = l->value[i];
        off *= FURTHER;
    }
    return turns >= TURNS_MOST;
}

/* The value overflows at `from` off the place. Was it very large before, up to the end of the way? A difference that cancels to
 * zero was not. */
static bool overflows(const looker *l, int i, double place, double from) {
    const double most = from < 0.0 ? place : 1.0 - place;
    double off = from;
    do {
        off *= FARTHER;
        l->way->at(l->way->of, place + off, l->then, l->value);
    } while (isinf(l->value[i]) && fabs(off) * FARTHER <= most);
    return fabs(l->value[i]) > GROWTH_BEYOND;
}

typedef struct spot {
    part in;
    double place;
    double nearest; /* from so near on */
    int of;         /* the value with the sign change there, */
    bool touches;   /* or only touches zero */
} spot;

/* Some nearest of the points, and one that is nine times as far off as the nearest. */
enum { NEAREST = 3, NINE_TIMES = GROWTH_POINTS - 5 };
/* Tolerance of the value at the place. */
#define LEFT 0.05

/* Does it stay off zero there, as y^2 + x^2 does? Yes if the value left after removing the square agrees
 * with the one at the place. */
static bool stands_off(double at_place, const double *over, double far) {
    double off[GROWTH_POINTS];
    off[0] = far;
    for (int k = 1; k < GROWTH_POINTS; k++) {
        off[k] = off[k - 1] / GROWTH_CLOSER;
    }
    const double bend = (1.0 / over[NINE_TIMES] - at_place) / (off[NINE_TIMES] * off[NINE_TIMES]);
    bool stands = at_place > 0.0;
    for (int k = GROWTH_POINTS - NEAREST; k < GROWTH_POINTS; k++) {
        const double left = 1.0 / over[k] - bend * off[k] * off[k];
        stands = stands && fabs(left - at_place) < LEFT * at_place;
    }
    return stands;
}

/* Is the place one of this spot's, as far as its own values tell? over[GROWTH_POINTS]: one over their sizes. */
static bool is_there(const spot *s, const double *over) {
    const growth kind = growth_of(over, 1);
    return s->touches ? kind == GROWTH_POLE : kind != GROWTH_ROUGH;
}

/* The first value with a pole at the place, seen from `far` off on this side, or -1. */
static int grows_from(const looker *l, const spot *s, double place, double far) {
    const int values = l->way->values;
    const double extent = far < 0.0 ? place - s->in.low : s->in.high - place;
    double over[GROWTH_POINTS];
    double off = far;
    for (int k = 0; k < GROWTH_POINTS; k++) {
        l->way->at(l->way->of, place + off, l->then, l->side + (ptrdiff_t)k * values);
        over[k] = 1.0 / fabs(l->then[s->of]);
        off = k + 1 < GROWTH_POINTS ? off / GROWTH_CLOSER : off;
    }
    if (!is_there(s, over) || (s->touches && stands_off(size_at(l, s->of, place), over, far))) {
        return -1;
    }
    for (int i = 0; i < values; i++) {
        const growth kind = l->done[i] ? GROWTH_NONE : growth_of(l->side + i, values);
        const bool pole = isinf(l->side[i]) ? overflows(l, i, place, far)
                                            : kind == GROWTH_POLE &&
                                                  !is_rounding(l, i, place, off, NEAR * extent);
        l->done[i] = kind == GROWTH_NONE;
        if (pole) {
            return i;
        }
    }
    return -1;
}

/* The zero is searched at this many times the distance of the nearest point. */
#define ASIDE 5.0

/* The zero, from the sizes on both sides of the estimate: (a - e)^order and (a + e)^order differ by the part order*e/a. The place
 * of a simple zero is known already. */
static double centred(const looker *l, const spot *s, double aside) {
    const double before = size_at(l, s->of, s->place - aside);
    const double behind = size_at(l, s->of, s->place + aside);
    const double grows = size_at(l, s->of, s->place + 2.0 * aside) / behind;
    const double order = grows > 11.0 ? 4.0 : grows > 5.6 ? 3.0 : grows > 2.8 ? 2.0 : 1.0;
    const double shift = aside / order * (before - behind) / (before + behind);
    return order > 1.0 && isfinite(shift) ? s->place + shift : s->place;
}

static bool all_done(const looker *l) {
    int done = 0;
    for (int i = 0; i < l->way->values; i++) {
        done += l->done[i];
    }
    return done == l->way->values;
}

/* The first value with a pole at the spot, on one side. The nearest distances with even growth decide. */
static int pole_on_side(const looker *l, const spot *s, double side) {
    int found = -1;
    memset(l->done, 0, (size_t)l->way->values * sizeof *l->done);
    double far = GROWTH_REACH * s->nearest;
    while (far < 1.0 && found < 0 && !all_done(l)) {
        const double place = centred(l, s, ASIDE / GROWTH_REACH * far);
        const bool inside = side < 0.0 ? place - far >= s->in.low : place + far <= s->in.high;
        found = inside ? grows_from(l, s, place, side * far) : -1;
        far *= FARTHER;
    }
    return found;
}

static int pole_at(const looker *l, const spot *s) {
    const int found = pole_on_side(l, s, -1.0);
    return found >= 0 ? found : pole_on_side(l, s, 1.0);
}

/* The value with a pole at a sign change in this part, or at a possible touch of zero, or -1. *at is the located interval,
 * from `low` to `high`, or empty. */
static int pole_in(const looker *l, part p, part *at) {
    l->way->at(l->way->of, p.low, l->sign, l->value);
    l->way->at(l->way->of, p.high, l->then, l->value);
    int i = changes(l);
    if (i >= 0) {
        *at = halve(l, i, p);
        return pole_at(l, &(spot){p, 0.5 * (at->low + at->high), l->way->nearest[i], i, false});
    }
    i = touches(l, p);
    if (i >= 0) {
        const double place = least_of(l, i, p);
        *at = (part){place, place};
        return pole_at(l, &(spot){p, place, l->way->nearest[i], i, true});
    }
    *at = (part){p.high, p.high};
    return -1;
}

static int look(const looker *l) {
    part waiting[PARTS_MOST + 2] = {{0.0, 1.0}};
    int left = 1;
    int places = 0;
    int found = -1;
    while (left > 0 && places <= PARTS_MOST && found < 0) {
        const part p = waiting[--left];
        part at;
        found = pole_in(l, p, &at);
        if (at.low < p.high) {
            waiting[left++] = (part){at.high, p.high};
            waiting[left++] = (part){p.low, at.low};
            places++;
        }
    }
    return found;
}

int pole_on(const pole_way *w) {
    const looker l = {.way = w,
                      .sign = alloc(w->signs, sizeof *l.sign),
                      .then = alloc(w->signs, sizeof *l.then),
                      .value = alloc(w->values, sizeof *l.value),
                      .side = alloc((int64_t)GROWTH_POINTS * w->values, sizeof *l.side),
                      .done = alloc(w->values, sizeof *l.done),
                      .touch = alloc(4 * (int64_t)w->signs, sizeof *l.touch)};
    const int found = look(&l);
    free(l.sign);
    free(l.then);
    free(l.value);
    free(l.side);
    free(l.done);
    free(l.touch);
    return found;
}
