/* watched.h: what is known of a run that is watched (watch.h, look_close.h). */
#ifndef RUN_WATCHED_H
#define RUN_WATCHED_H

#include "between.h"
#include "books.h"
#include "field.h"
#include "jumped.h"

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
    /* Of a scene with energies, on the accurate way: the least pivot of the mass matrix, of the largest it has had. Singular is what
     * falls: one that is the same everywhere does not */
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
    /* what the slopes make of each component, trapezoids summed: now, its least and its most, and the most that the run was
     * elsewhere */
    double *asked; /* [n] */
    double *asked_low;
    double *asked_high;
    double *strayed;
    double *start; /* [n] */
    double *mass;  /* [rows * rows] */
    double *most;  /* [rows] largest diagonal entries seen */
    /* looks */
    double metric; /* the largest that was looked at */
    uint64_t next; /* not before this step, unless it is larger */
    uint64_t due;  /* the step after which to look; 0: none */
    uint64_t looked;
    watch_look worst;    /* of all */
    watch_look singular; /* of those near a singular position */
    /* balance */
    double power_W[3];
    double energy_J;  /* at the last even step, */
    double middle_J;  /* and at the one behind it */
    double lost_J;    /* what the method took or gave so far */
    double most_J;    /* its largest size */
    uint64_t doubted; /* up to this step the books' rule is in doubt; 0: it never was */
    uint64_t doubts;  /* pairs of steps for which it was */
    bool balanced;    /* false: not known */
    jumped *jumped;   /* NULL: over nothing */
    between *between;
} watch;

/* Of a step that is kept: the last WATCH_WINDOW + 1. */
static inline double *watch_past(const watch *w, uint64_t step) {
    return w->past + (ptrdiff_t)(step % (WATCH_WINDOW + 1)) * w->field->n;
}

static inline double watch_time_s(const watch *w, uint64_t step) {
    return (double)step * w->step_s;
}

#endif
