/* engine.h: the interpreter of operation lists, which runs an image without a compiler. One source is built in float,
 * bit for bit the boards' arithmetic, and in double, the reference. Both step with core/step.h. The interface has
 * doubles in both cases. */
#ifndef ENGINE_ENGINE_H
#define ENGINE_ENGINE_H

#include "host/image/image.h"

typedef struct engine_event {
    int contact;  /* its index in the image */
    int mode;     /* the contact's mode before the event (core/state.h) */
    double at_s;  /* time since the beginning of the step, s */
    bool strikes; /* a stop or a hold gave an impulse */
} engine_event;

/* Impacts with a restitution outside 0 to 1, which is clamped. All members but `count` are of the first one. */
typedef struct engine_clamped {
    uint64_t count;
    int contact;    /* the stop */
    double value;   /* the restitution */
    double begin_s; /* begin of the step with the impact, s */
} engine_clamped;

/* The motion between two events of a step, or between an event and an end of the step. */
typedef struct engine_piece {
    double span_s;
    const double *from; /* [angles + reals] state at the begin, as engine_kind's state() gives it */
    const double *to;
    const int *mode; /* [contacts] */
} engine_piece;

typedef struct engine_kind {
    const char *name; /* "float", "double" or "fixed" (host/fixed) */
    int digits;       /* a number with this many significant digits is read back exactly */
    void *(*start)(const image *im); /* the image must outlive the run */
    void (*stop)(void *run);
    wh_status (*step)(void *run);
    void (*set_input)(void *run, int input, double value);
    /* angle_rad[angles] unwrapped, real[reals]; SI */
    void (*state)(const void *run, double *angle_rad, double *real);
    void (*outputs)(void *run, double *output);
    uint64_t (*hash)(const void *run);
    uint64_t (*steps)(const void *run);
    /* The component that diverged, angles first, or -1. */
    int (*fault)(const void *run);
    /* Events since the start. *overruns: number of steps with events at more than WH_EVENTS_MAX different times. */
    uint64_t (*events)(const void *run, uint64_t *overruns);
    /* The events of the last step in their order, list[WH_EVENT_LOG]; returns their number. */
    int (*happened)(const void *run, engine_event *list);
    /* The contacts' modes, mode[contacts]; before the first step those with which it will begin. */
    void (*modes)(const void *run, int *mode);
    /* Evaluations of the accelerations since the start; *most: the declared bound for one step with contacts. */
    uint64_t (*evaluations)(const void *run, uint64_t *most);
    /* The ledger so far: total[entries], error[accounts] (the residuals); SI. NULL: this number type has no ledger. */
    void (*ledger)(const void *run, double *total, double *error);
    /* The largest |summed round-off| of component i, angles first, since the start: each increment is rounded to whole
     * units. *span: the component's range without round-off. Both SI. If unit() is NULL, only turn angles are rounded,
     * in float to 2^-32 turn. Returns 0 in double, and with compensated sums. */
    double (*component_off)(const void *run, int i, double *span);
    /* The number of values that were clamped to their range since the start; NULL: this number type has no ranges. */
    uint64_t (*saturated)(const void *run);
    /* The unit to which component i is rounded; SI. NULL: floating point. */
    double (*unit)(const void *run, int i);
    engine_clamped (*clamped)(const void *run); /* NULL: this number type has no impacts */
    /* The pieces of the last step, if it was searched for events; else an empty list. NULL: not available. */
    const engine_piece *(*pieces)(const void *run, int *count);
} engine_kind;

/* Number of list operations that this process has evaluated; the same on every machine. Other work counts as the
 * operations that would take as long, within a third. */
extern uint64_t engine_operations;
/* Number of operations of one evaluation of the accelerations, and of the method's and contacts' work for it. */
uint64_t engine_evaluation(const image *im);

extern const engine_kind engine_float;
extern const engine_kind engine_double;

/* Evaluates a list in double, repeatedly. An array may be NULL if the list does not read it. */
typedef struct evaluator evaluator;
evaluator *evaluator_new(const op_list *t);
void evaluator_free(evaluator *ev);
/* Wraps angles to one turn before their sines: a float run's angles may exceed the range of the double sine. */
void evaluator_wrap(evaluator *ev);
void evaluator_run(evaluator *ev, double time_s, const double *angle_rad, const double *linear,
                   const double *rate, const double *input, double *result);
/* The value of this operation of the list in the last evaluator_run(). */
double evaluator_value(const evaluator *ev, int operation);
/* Bounds on the round-off of the last evaluator_run(), with its angles: error[results], in unit
 * round-offs (rounding.h). */
void evaluator_rounding(const evaluator *ev, const double *angle_rad, double least, double *error);

/* A list of an image, evaluated in double at any state. The inputs keep their start values. */
typedef struct state_list {
    const image *image;
    evaluator *evaluator;
    double *input;  /* [inputs] */
    double *result; /* [results of the list] of the last state_list_at() */
} state_list;
state_list state_list_open(const image *im, image_role role);
void state_list_close(const state_list *l);
/* The results at a state as from engine_kind's state(). */
const double *state_list_at(const state_list *l, double time_s, const double *angle_rad,
                            const double *real);

#endif
