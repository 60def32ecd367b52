/* pole.c: see pole.h. */
#include "pole.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* A place is halved down to what a share of the way has digits for. */
enum { HALVINGS = 56 };
/* So often the distance is made CLOSER times less. */
enum { LEVELS = 5, LEVELS_EVEN = 4 };
#define CLOSER 5.0
/* Each time a pole grows 5 times, one over a root 2.2 times; of what grows faster, alike each time. No power of two: numbers
 * with the same digits are rounded alike, and what that leaves would grow as evenly. */
#define GROWS 4.4
#define ALIKE 1.2
/* What grows beyond all numbers was so large before. */
#define BEYOND 1e60
/* And so much farther off, where what changes its sign there is itself a difference with few digits. */
#define FARTHER 1e3
enum { TIMES_FARTHER = 2 };
/* What touches zero has digits from somewhere on between these, by what is small there. */
#define EVEN_FARTHER 2.5
#define EVEN_FIRST 1e-3
enum { EVEN_TIMES = 15 };
/* A smooth expression has few zeros on its way to a pole; what rounding left has now this sign and now that, at distances
 * that are so much farther each time. */
enum { TURNS_MOST = 4 };
#define NEAR 0.2
#define FURTHER 1.4
/* What touches nothing leaves so much less of itself there than at either end. */
#define TOUCHES 1e-3
/* The least of what is even is found by golden sections, until no digits are left of where it is. */
#define GOLDEN 0.6180339887498949
enum { SECTIONS = 72 };
/* Places that are none, with more parts of the way about them. */
enum { PARTS_MOST = 16 };

typedef struct part {
    double low; /* shares of the way */
    double high;
} part;

typedef struct looker {
    const pole_way *way;
    double *sign; /* [signs] at the begin of a part, */
    double *then; /* and at its end */
    double *value;
    double *side;  /* [LEVELS * values] */
    double *touch; /* [4 * signs] */
} looker;

/* The first that changes its sign in this part; -1: none. */
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
    /* where the tangents meet */
    const double share = (begin - end + rises) / (falls + rises);
    return begin - falls * share <= TOUCHES * number_least(begin, end);
}

/* The first that may touch zero in this part; -1: none. */
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

/* How large it is there. */
static double size_at(const looker *l, int i, double share) {
    l->way->at(l->way->of, share, l->then, l->value);
    return fabs(l->then[i]);
}

/* Where it is least. */
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

/* The part that is left of it. */
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

/* Towards the place, the nearest last: even growth to the end? */
static bool grows(const double *value, int values, int levels) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < levels; k++) {
        const double before = value[(k - 1) * values];
        const double by = value[k * values] / before;
        if (isinf(value[k * values]) && isfinite(before) && fabs(before) > BEYOND) {
            return true;
        }
        if (!(by > GROWS)) { /* or no number */
            return false;
        }
        least = number_least(least, by);
        most = number_most(most, by);
    }
    return most < ALIKE * least;
}

/* Does value i change its sign again and again from `from` off the place to `most`? Then it is what rounding left. */
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

/* Beyond all numbers from `from` off the place on: was it as large before, to the end of the way? A difference of which rounding
 * leaves nothing was not. */
static bool overflows(const looker *l, int i, double place, double from) {
    const double most = from < 0.0 ? place : 1.0 - place;
    double off = from;
    do {
        off *= CLOSER;
        l->way->at(l->way->of, place + off, l->then, l->value);
    } while (isinf(l->value[i]) && fabs(off) * CLOSER <= most);
    return fabs(l->value[i]) > BEYOND;
}

/* Where a value is asked for a pole. */
typedef struct spot {
    double place;
    double nearest; /* from so near on, */
    int times;      /* and so often */
    double farther; /* so much farther off */
    int touches;    /* the one that has its least there; -1: one changes its sign */
} spot;

/* An even pole grows so much that fewer will do. */
static int levels_of(const spot *s) { return s->touches >= 0 ? LEVELS_EVEN : LEVELS; }

/* The first value that grows towards the spot from `from` so far away, which is on this side; -1: none. */
static int grows_from(const looker *l, const spot *s, double from, double most) {
    const int values = l->way->values;
    const int levels = levels_of(s);
    double off = from;
    for (int k = 0; k < levels; k++) {
        l->way->at(l->way->of, s->place + off, l->then, l->side + (ptrdiff_t)k * values);
        off /= CLOSER;
    }
    for (int i = 0; i < values; i++) {
        const bool pole = isinf(l->side[i])
                              ? overflows(l, i, s->place, from)
                              : grows(l->side + i, values, levels) &&
                                    !is_rounding(l, i, s->place, CLOSER * off, NEAR * most);
        if (pole) {
            return i;
        }
    }
    return -1;
}

/* Where what touches zero does, by its roots at both sides of about where it is least. */
static double centred(const looker *l, const spot *s, double aside) {
    const double before = number_root(size_at(l, s->touches, s->place - aside));
    const double behind = number_root(size_at(l, s->touches, s->place + aside));
    const double shift = aside * (before - behind) / (before + behind);
    return isfinite(shift) ? s->place + shift : s->place;
}

/* The first value with a pole at the spot in part `p`. */
static int pole_at(const looker *l, const spot *s, part p) {
    int found = -1;
    double reach = s->nearest;
    for (int k = 1; k < levels_of(s); k++) {
        reach *= CLOSER;
    }
    for (int k = 0; k < s->times && found < 0; k++) {
        spot at = *s;
        at.place = s->touches >= 0 ? centred(l, s, reach / CLOSER) : s->place;
        if (at.place - reach >= p.low) {
            found = grows_from(l, &at, -reach, at.place - p.low);
        }
        if (found < 0 && at.place + reach <= p.high) {
            found = grows_from(l, &at, reach, p.high - at.place);
        }
        reach *= s->farther;
    }
    return found;
}

/* The value with a pole where one changes its sign in this part, or may touch zero: *at is what is left of that place, from
 * `low` to `high`, or nothing. -1: none. */
static int pole_in(const looker *l, part p, part *at) {
    l->way->at(l->way->of, p.low, l->sign, l->value);
    l->way->at(l->way->of, p.high, l->then, l->value);
    int i = changes(l);
    if (i >= 0) {
        *at = halve(l, i, p);
        return pole_at(
            l, &(spot){0.5 * (at->low + at->high), l->way->nearest[i], TIMES_FARTHER, FARTHER, -1},
            p);
    }
    i = touches(l, p);
    if (i >= 0) {
        const double place = least_of(l, i, p);
        *at = (part){place, place};
        return pole_at(
            l, &(spot){place, EVEN_FIRST * l->way->nearest_even[i], EVEN_TIMES, EVEN_FARTHER, i},
            p);
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
                      .sign = room(w->signs, sizeof *l.sign),
                      .then = room(w->signs, sizeof *l.then),
                      .value = room(w->values, sizeof *l.value),
                      .side = room((int64_t)LEVELS * w->values, sizeof *l.side),
                      .touch = room(4 * (int64_t)w->signs, sizeof *l.touch)};
    const int found = look(&l);
    free(l.sign);
    free(l.then);
    free(l.value);
    free(l.side);
    free(l.touch);
    return found;
}
