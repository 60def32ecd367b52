/* between.c: see between.h. */
#include "between.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field.h"
#include "host/base/room.h"
#include "host/number/functions.h"

/* Steps that are asked, about, so many in a row each time; so many are to be seen, or of fewer half, but some. What a row is
 * off counts: a force whose period nearly divides the step goes round once in many steps, and none of its turns is there. */
#define PLACES 64U
#define ROW 2U
#define SEEN_ENOUGH 8U
#define SEEN_LEAST 3U
/* Off the straight line, of the largest slope so far: a swing of h w = 1 is an eighth, of h w = 0.4 this. */
#define BENT 0.02
/* Three slopes are off by rounding at most. */
#define ROUNDED 3.0
/* In the mean of rows, of the largest slope at ends of steps so far, and of what each step is off. So far: a swing that is not
 * there, and is met in its time, grows beyond what has made it. Of slopes that are nothing at ends of steps all is off. */
#define TOLD 0.02
#define ONE_WAY 0.5
#define BY_CHANCE 7.0
#define ALL_OFF 100.0
/* What a contact makes of a force is not that of its mean: so far from the line in the mean. */
#define TOLD_BENT 0.25
/* By so much of the largest slope no contact has turned a step. */
#define UNTOUCHED 0.1
/* Parts of a step: 5, 21, 85, 341, 1365, 5461: what is a whole number of periods in two of them is so in none that is likely. */
#define PARTS_FIRST 5
#define PARTS_MOST 5461 /* one of the row */
/* Of all steps that are taken again; and in operations, a third of a second, half of it for one of them. */
#define PARTS_IN_ALL 150000
#define OPERATIONS_MOST 8e7
/* Places of a step that are asked, and of one in so many rows many more: pulses are narrow. What is seen of these alone is asked
 * for in all steps from then on, and is in no coarser parts. */
#define ASKED_IN_STEP 12
#define ASKED_DEEP 768
/* Of a short run fewer, so that it takes at most this part longer; what is narrow there is not seen. */
#define ASKED_PART 0.5
#define DEEP_ROWS 8U
#define PARTS_DEEP 1365
#define PARTS_NARROW 64
/* What goes up and down from step to step, too fast for all but so many parts, is told where it is as much as this of all that
 * the rate does. */
#define PARTS_FAST 85
#define WIDE 0.25
#define AGREED 1e-3
/* The finest know what edges make of pulses as well as that, of what the run is off. */
#define KNOWN 0.25
/* The golden ratio of 2^32. */
#define GOLDEN 2654435769U

struct between {
    field *field;
    double step_s;
    bool
        proxy; /* the run's own end of a step says too little, or is off by its method: taken again by Runge-Kutta 4 */
    uint64_t stride;
    uint64_t asked;
    uint64_t seen;
    uint64_t first; /* steps before the first that was seen */
    int parts;      /* that the finest of those took */
    int spent;      /* parts, so far, */
    int afford;     /* and in all */
    bool narrow;    /* what few places do not show was seen */
    int few;        /* places of a step that are asked, */
    int many;       /* and of one in so many rows */
    double *from;   /* [n] before the step, */
    double *to;     /* and behind it */
    double *at;     /* [n] */
    double *slope;  /* [3 * n] at both ends, and between */
    double *row;    /* [n] what the ends of this row's steps were off by; */
    double *sum;    /* of all rows so far, its sizes, */
    double *all;    /* those of each step, */
    double *bent;   /* where there are contacts, how far slopes were off their lines, */
    double *part;   /* and what rows are off in parts of the largest slopes at ends of steps; */
    double *size;   /* the largest slope, */
    double *ends;   /* and that at ends of steps alone; */
    double *total;  /* of what rows were off, with its sign, */
    double *square; /* and of its square; */
    double *low;    /* values between which the run has been */
    double *high;
};

between *between_open(const image *im, const engine_kind *kind) {
    between *b = room(1, sizeof *b);
    b->field = field_open(im, kind);
    b->step_s = im->step_s;
    b->proxy = kind != &engine_double ||
               wh_methods[im->settings.method].order < wh_methods[WH_METHOD_DEFAULT].order;
    b->stride = 1U + im->steps / PLACES;
    const double asked =
        ASKED_PART * wh_methods[im->settings.method].stages * (double)im->steps / PLACES;
    b->few = (int)number_least(ASKED_IN_STEP, 1.0 + 0.5 * asked);
    b->many = (int)number_least(ASKED_DEEP, 1.0 + 0.5 * DEEP_ROWS * asked);
    const double stages = 4.0 * (im->list[IMAGE_BOOKS]->count + 8.0 * b->field->n);
    b->afford = (int)number_least(PARTS_IN_ALL, OPERATIONS_MOST / stages);
    const int64_t n = b->field->n;
    b->from = room(17 * n, sizeof *b->from);
    b->to = b->from + n;
    b->at = b->to + n;
    b->slope = b->at + n;
    b->row = b->slope + 3 * n;
    b->sum = b->row + n;
    b->all = b->sum + n;
    b->bent = b->all + n;
    b->part = b->bent + n;
    b->size = b->part + n;
    b->ends = b->size + n;
    b->total = b->ends + n;
    b->square = b->total + n;
    b->low = b->square + n;
    b->high = b->low + n;
    for (int64_t i = 0; i < n; i++) {
        b->low[i] = (double)INFINITY;
        b->high[i] = -(double)INFINITY;
    }
    return b;
}

void between_close(between *b) {
    if (b != NULL) {
        field_close(b->field);
        free(b->from);
        free(b);
    }
}

/* Angles are given within a turn, and go less than half of one in a step. */
static void unwrap(between *b) {
    for (int i = 0; i < b->field->image->angles; i++) {
        b->to[i] = b->from[i] + number_centred(b->to[i] - b->from[i], 6.283185307179586);
    }
}

static bool is_highest(const between *b, int i) { return b->field->next[i] < 0; }

/* The cubic through both ends of the step and the slopes there. */
static void go_between(between *b, double share) {
    const int n = b->field->n;
    const double back = 1.0 - share;
    for (int i = 0; i < n; i++) {
        const double way = b->to[i] - b->from[i];
        const double first = b->slope[i] * b->step_s - way;
        const double last = way - b->slope[n + i] * b->step_s;
        b->at[i] = b->from[i] + share * way + share * back * (back * first + share * last);
    }
}

/* How far the slope of component i is from the straight line between those at the ends. */
static double off_line(const between *b, int i, double share) {
    const int n = b->field->n;
    const double line = b->slope[i] + share * (b->slope[n + i] - b->slope[i]);
    return fabs(b->slope[2 * (ptrdiff_t)n + i] - line);
}

/* Is the slope of component i so far off the line that it counts? By `rounds` it may be for rounding alone. */
static bool is_off_line(const between *b, int i, double share, double rounds) {
    const double least = number_most(BENT * b->size[i], ROUNDED * rounds);
    return is_highest(b, i) && off_line(b, i, share) > least;
}

/* Is one of the highest slopes far from it, of the largest that it has had, and further than rounding puts it? */
static bool is_bent(between *b, double share) {
    const int n = b->field->n;
    bool bent = false;
    for (int i = 0; i < n; i++) {
        const double *slope = b->slope + i;
        for (int k = 0; k < 3; k++) {
            b->size[i] = number_most(b->size[i], fabs(slope[k * (ptrdiff_t)n]));
        }
        b->ends[i] = number_most(b->ends[i], number_most(fabs(slope[0]), fabs(slope[n])));
        bent = bent || is_off_line(b, i, share, 0.0);
    }
    if (!bent) {
        return false;
    }
    double *rounds = room(n, sizeof *rounds);
    field_rounding(b->field, b->at, rounds);
    bent = false;
    for (int i = 0; i < n; i++) {
        bent = bent || is_off_line(b, i, share, rounds[i]);
    }
    free(rounds);
    return bent;
}

/* The step once more, in finer and finer parts, until two of them agree: b->at; false where none do. */
static bool take_again(between *b, int first) {
    const int n = b->field->n;
    double *last = room(n, sizeof *last);
    bool agreed = false;
    for (int parts = first; parts <= PARTS_MOST && parts <= b->afford / 2 && !agreed;
         parts = 4 * parts + 1) {
        memcpy(b->at, b->from, (size_t)n * sizeof *b->at);
        field_go(b->field, b->step_s, parts, b->at);
        b->spent += parts;
        agreed = parts > first;
        for (int i = 0; i < n; i++) {
            const double known = parts == PARTS_MOST ? KNOWN * fabs(b->to[i] - b->at[i]) : 0.0;
            const double room_of = number_most(AGREED * b->step_s * b->size[i], known);
            agreed = agreed && (!is_highest(b, i) || fabs(b->at[i] - last[i]) <= room_of);
        }
        b->parts = agreed && parts > b->parts ? parts : b->parts;
        memcpy(last, b->at, (size_t)n * sizeof *last);
    }
    free(last);
    return agreed;
}

static void note_bent(between *b, double share) {
    for (int i = 0; i < b->field->n; i++) {
        b->bent[i] += is_highest(b, i) ? off_line(b, i, share) : 0.0;
    }
}

/* Did contacts leave this step alone? Then it ends where Runge-Kutta's has, for what is of interest here. */
static bool is_free(const between *b, const double *run) {
    bool free_of_them = true;
    for (int i = 0; i < b->field->n; i++) {
        const double room_of = UNTOUCHED * b->step_s * b->size[i];
        free_of_them = free_of_them && (!is_highest(b, i) || fabs(run[i] - b->to[i]) <= room_of);
    }
    return free_of_them;
}

static void compare(between *b, uint64_t begin, double share) {
    const int n = b->field->n;
    if (!take_again(
            b, b->narrow ? PARTS_DEEP
                         : PARTS_FIRST)) { /* rounding alone, or more periods than are asked for */
        return;
    }
    b->first = b->seen == 0 ? begin : b->first;
    b->seen++;
    if (b->field->image->contacts > 0) {
        note_bent(b, share);
    }
    if (b->proxy || b->field->image->contacts > 0) {
        double *run = room(n, sizeof *run);
        memcpy(run, b->to, (size_t)n * sizeof *run);
        memcpy(b->to, b->from, (size_t)n * sizeof *b->to);
        field_go(b->field, b->step_s, 1, b->to);
        const bool counts = b->field->image->contacts == 0 || is_free(b, run);
        free(run);
        if (!counts) {
            return;
        }
    }
    for (int i = 0; i < n; i++) {
        const double off = b->to[i] - b->at[i];
        if (is_highest(b, i) && isfinite(off)) {
            b->row[i] += off;
            b->all[i] += fabs(off);
        }
    }
}

/* What this row is off, in parts of the largest slope at ends of steps so far. */
static double part_of(const between *b, int i) {
    const double off = fabs(b->row[i]) / b->step_s;
    return off < ALL_OFF * b->ends[i] ? off / b->ends[i] : off > 0.0 ? ALL_OFF : 0.0;
}

static void end_row(between *b) {
    for (int i = 0; i < b->field->n; i++) {
        b->sum[i] += fabs(b->row[i]);
        b->part[i] += part_of(b, i);
        b->total[i] += b->row[i];
        b->square[i] += b->row[i] * b->row[i];
        b->row[i] = 0.0;
    }
}

/* Of the row in whose part of the run this step is: which one it is, ROW or more for none. Rows stand irregularly, so that no
 * period of the motion makes all of them alike; the first one is at the begin. */
static uint64_t place_in_row(const between *b, uint64_t step) {
    const uint64_t part = b->stride * ROW;
    const uint64_t row = (step - 1U) / part;
    const uint64_t drawn = (uint32_t)(row * GOLDEN);
    const uint64_t begin = row * part + ((drawn >> 16) * (part - ROW + 1U) >> 16);
    return step > 0 && step - 1U >= begin ? step - 1U - begin : ROW;
}

static bool is_asked(const between *b, uint64_t step) { return place_in_row(b, step) < ROW; }

static bool ends_row(const between *b, uint64_t step) { return place_in_row(b, step) == ROW - 1U; }

/* Places spread over the step, other ones each time; the first that is bent, or 0. */
static double find_bent(between *b) {
    const bool deep = b->narrow || (b->asked / ROW) % DEEP_ROWS == 0;
    const int places = deep ? b->many : b->few;
    double bent = 0.0;
    for (int k = 0; k < places && bent == 0.0; k++) {
        /* the few stand among the many */
        const uint32_t drawn = (uint32_t)(b->asked + 1U + (uint64_t)k) * GOLDEN;
        const double share = 0x1p-32 * (double)drawn;
        go_between(b, share);
        field_slope(b->field, b->at, b->slope + 2 * (ptrdiff_t)b->field->n);
        bent = is_bent(b, share) ? share : 0.0;
        b->narrow = b->narrow || (bent != 0.0 && k >= b->few);
    }
    return bent;
}

static void note_range(between *b) {
    for (int i = 0; i < b->field->n; i++) {
        b->low[i] = number_least(b->low[i], b->to[i]);
        b->high[i] = number_most(b->high[i], b->to[i]);
    }
}

void between_enter(between *b, const engine_kind *kind, const void *run) {
    const uint64_t steps = kind->steps(run);
    const int angles = b->field->image->angles;
    if (is_asked(b, steps) && b->spent < b->afford) {
        const int n = b->field->n;
        kind->state(run, b->to, b->to + angles);
        unwrap(b);
        note_range(b);
        field_slope(b->field, b->from, b->slope);
        field_slope(b->field, b->to, b->slope + n);
        const double share = find_bent(b);
        b->asked++;
        if (share != 0.0) {
            compare(b, steps - 1U, share);
        }
        if (ends_row(b, steps)) {
            end_row(b);
        }
    }
    if (is_asked(b, steps + 1U)) {
        kind->state(run, b->from, b->from + angles);
    }
}

/* Of a step to try first: what is narrow is known much better than it need be. */
static int least_parts(const between *b) { return b->narrow ? b->parts / PARTS_NARROW : b->parts; }

/* What steps are off, whichever way, where it is as much as what the run has made of it; else 0. */
static double wide_of(const between *b, int i) {
    const double off = b->all[i] / (double)b->asked;
    const bool wide = b->parts >= PARTS_FAST && off > WIDE * (b->high[i] - b->low[i]);
    return wide ? off / b->step_s : 0.0;
}

/* Do steps of a row go one way? And where few steps are seen, as those are into which an edge falls now and then, do rows? */
static bool goes_one_way(const between *b, int i, double sum) {
    const double total = b->total[i] + b->row[i];
    const double square = b->square[i] + b->row[i] * b->row[i];
    const bool by_chance = 2U * b->seen < b->asked && total * total < BY_CHANCE * square;
    return sum > ONE_WAY * b->all[i] && !by_chance;
}

between_found between_seen(const between *b) {
    between_found found = {.component = -1};
    if (b->seen < SEEN_LEAST || (b->seen < SEEN_ENOUGH && 2U * b->seen < b->asked)) {
        return found;
    }
    for (int i = 0; i < b->field->n && b->asked > 0; i++) {
        const double sum = b->sum[i] + fabs(b->row[i]); /* a row that has not ended, too */
        const double part = b->part[i] + part_of(b, i);
        const double mean = sum / ((double)b->asked * b->step_s);
        const double bent = b->bent[i] / (double)b->asked;
        const double wide = wide_of(b, i);
        const double most = number_most(number_most(mean, bent), wide);
        const double off = b->size[i] > 0.0 ? most / b->size[i] : 0.0;
        const bool is_told = bent > TOLD_BENT * b->size[i] ||
                             (part > TOLD * (double)b->asked && goes_one_way(b, i, sum)) ||
                             wide > 0.0;
        if (is_highest(b, i) && is_told && off > found.off) {
            found = (between_found){.component = i,
                                    .off = off,
                                    .begin_s = (double)b->first * b->step_s,
                                    .fine_step_s = b->step_s / least_parts(b)};
        }
    }
    return found;
}
