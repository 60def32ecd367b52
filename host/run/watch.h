/* watch.h: what a run that takes too coarse a step, or passes where its coordinates are singular, is known by while it goes
 * on; the judgement and the words are advice.h's.
 *
 * Three things, none of which touches the run:
 *
 *   - Records of the state, at most WATCH_RECORDS, evenly over the run so far, and the start. Where it is asked why, the
 *     motion is linearised there.
 *   - A close look: the way of the last few steps again, in double, in steps so small that it is known, where the
 *     accelerations changed most. By how much the run's own steps are off it is the error of these steps, whatever
 *     its cause. On the way the mass matrix is watched: a pivot of nearly nothing is a singular position.
 *   - The energy's balance without a rule of integration: where the books' own (Simpson's) is in doubt, because the
 *     powers change within a step, what two steps did to the energy is held against what the accurate way does from
 *     the same state. Summed, that is what the method took or gave, and only that.
 *
 * Scenes with contacts get records alone: their forces are not in the right-hand side. */
#ifndef RUN_WATCH_H
#define RUN_WATCH_H

#include "books.h"
#include "field.h"

enum { WATCH_RECORDS = 16, WATCH_WINDOW = 8 };

/* The close look that found most. */
typedef struct watch_look {
    bool done;
    double begin_s;
    double end_s;
    double
        off; /* the largest of: an angle, rad; a length, of its range; the rates, of their kinetic energy, by root */
    int component; /* whose position it is; -1: the rates */
    bool failed;   /* the run could not take these steps: `off` is 1 */
    bool resolved;
    double fine_step_s; /* such steps of Runge-Kutta 4 resolve it, if any do */
    /* Of a scene with energies, on the accurate way: the least pivot of the mass matrix, of the largest it has had */
    double inertia; /* 1 where it was not looked at */
    int singular;   /* component: the rate that it is of, */
    double singular_s;
    int near;       /* the position that makes it singular, or -1, */
    double near_at; /* which stood so there */
} watch_look;

typedef struct watch {
    field *field;
    double step_s;
    bool smooth; /* no contacts */
    uint64_t steps;
    /* records */
    double *record; /* [WATCH_RECORDS * n] */
    double record_s[WATCH_RECORDS];
    int records;
    uint64_t stride;
    /* ranges and the last steps */
    double *low; /* [n] */
    double *high;
    int *alike; /* [n] the first component with this one's unit */
    double *
        range; /* [n] how far each has gone; at least a thousandth of the furthest of those alike */
    double
        *past; /* [(WATCH_WINDOW + 1) * n], a ring: the state of step k at k % (WATCH_WINDOW + 1) */
    double *slope;   /* [2 * n] now, before */
    double *scratch; /* [3 * n] */
    double *mass;    /* [rows * rows] */
    double *most;    /* [rows] largest diagonal entries seen */
    /* looks */
    double metric; /* the largest that was looked at */
    uint64_t next; /* not before this step, unless it is larger */
    uint64_t due;  /* the step after which to look; 0: none */
    uint64_t looked;
    watch_look worst;    /* of all */
    watch_look singular; /* of those near a singular position */
    /* balance */
    double power_W[3];
    double energy_J; /* at the last even step, */
    double middle_J; /* and at the one behind it */
    double lost_J;   /* what the method took or gave so far */
    double most_J;   /* its largest size */
    uint64_t doubts;
    bool balanced; /* false: not known */
} watch;

/* `b` may be NULL. */
watch *watch_open(const image *im, const engine_kind *kind);
void watch_close(watch *w);
/* Enter the state after each step, the start included, after the books. */
void watch_enter(watch *w, const engine_kind *kind, const books *b, const void *run);
/* The run is over: what was to be looked at still is, and where it failed the next steps are. */
void watch_end(watch *w, bool failed);

/* Of a step that is kept: the last WATCH_WINDOW + 1. */
static inline double *watch_past(const watch *w, uint64_t step) {
    return w->past + (ptrdiff_t)(step % (WATCH_WINDOW + 1)) * w->field->n;
}

static inline double watch_time_s(const watch *w, uint64_t step) {
    return (double)step * w->step_s;
}

#endif
