/* pole.c: see pole.h. */
#include "pole.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* A place is halved down to what a share of the way has digits for. */
enum { HALVINGS = 56 };
/* So often the distance is made CLOSER times less. */
enum { LEVELS = 5 };
#define CLOSER 5.0
/* Each time a pole grows 5 times, one over a root 2.2 times; of what grows faster, alike each time. No power of two: numbers
 * with the same digits are rounded alike, and what that leaves would grow as evenly. */
#define GROWS 4.4
#define ALIKE 1.2
/* What grows beyond all numbers was so large before. */
#define BEYOND 1e60
/* And so much farther off, where what changes its sign there is itself a difference with few digits. */
#define FARTHER 1e3
/* A smooth expression has few zeros on its way to a pole; what rounding left has now this sign and now that, at distances
 * that are so much farther each time. */
enum { TURNS_MOST = 4 };
#define NEAR 0.2
#define FURTHER 1.4
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
    double *side; /* [LEVELS * values] */
} looker;

/* The first from `from` on that changes its sign in this part; -1: none. */
static int changes(const looker *l, int from) {
    for (int i = from; i < l->way->signs; i++) {
        if ((l->sign[i] < 0.0 && l->then[i] > 0.0) || (l->sign[i] > 0.0 && l->then[i] < 0.0)) {
            return i;
        }
    }
    return -1;
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
static bool grows(const double *value, int values) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < LEVELS; k++) {
        const double before = value[(k - 1) * values];
        const double by = value[k * values] / before;
        if (isinf(value[k * values]) && fabs(before) > BEYOND) {
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

/* The first value that grows towards `place` from `from` so far away, which is on this side; -1: none. */
static int grows_from(const looker *l, double place, double from, double most) {
    const int values = l->way->values;
    double nearest = from;
    for (int k = 0; k < LEVELS; k++) {
        l->way->at(l->way->of, place + from, l->then, l->side + (ptrdiff_t)k * values);
        nearest = from;
        from /= CLOSER;
    }
    for (int i = 0; i < values; i++) {
        if (grows(l->side + i, values) && !is_rounding(l, i, place, nearest, most)) {
            return i;
        }
    }
    return -1;
}

/* The first value with a pole at `place` in part `p`, from so near. */
static int pole_at(const looker *l, double nearest, part p, double place) {
    double reach = nearest;
    for (int k = 1; k < LEVELS; k++) {
        reach *= CLOSER;
    }
    int found = -1;
    if (place - reach >= p.low) {
        found = grows_from(l, place, -reach, NEAR * (place - p.low));
    }
    if (found < 0 && place + reach <= p.high) {
        found = grows_from(l, place, reach, NEAR * (p.high - place));
    }
    return found;
}

static int look(const looker *l) {
    part waiting[PARTS_MOST + 2] = {{0.0, 1.0}};
    int left = 1;
    int places = 0;
    while (left > 0 && places <= PARTS_MOST) {
        const part p = waiting[--left];
        l->way->at(l->way->of, p.low, l->sign, l->value);
        l->way->at(l->way->of, p.high, l->then, l->value);
        const int i = changes(l, 0);
        if (i < 0) {
            continue;
        }
        const part at = halve(l, i, p);
        const double place = 0.5 * (at.low + at.high);
        int found = pole_at(l, l->way->nearest[i], p, place);
        if (found < 0) {
            found = pole_at(l, FARTHER * l->way->nearest[i], p, place);
        }
        if (found >= 0) {
            return found;
        }
        waiting[left++] = (part){at.high, p.high};
        waiting[left++] = (part){p.low, at.low};
        places++;
    }
    return -1;
}

int pole_on(const pole_way *w) {
    const looker l = {.way = w,
                      .sign = room(w->signs, sizeof *l.sign),
                      .then = room(w->signs, sizeof *l.then),
                      .value = room(w->values, sizeof *l.value),
                      .side = room((int64_t)LEVELS * w->values, sizeof *l.side)};
    const int found = look(&l);
    free(l.sign);
    free(l.then);
    free(l.value);
    free(l.side);
    return found;
}
