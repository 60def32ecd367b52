/* engine.h: the interpreter of operation lists, which runs an image without a compiler. It is built in float, which
 * gives the boards' results bit for bit, and in double, as the reference. Both builds take and return doubles. */
#ifndef ENGINE_ENGINE_H
#define ENGINE_ENGINE_H

#include "host/image/image.h"

typedef struct engine_event {
    int contact;  /* its index in the image */
    int mode;     /* the contact's mode before the event (core/state.h) */
    double at_s;  /* time since the beginning of the step, s */
    bool strikes; /* a stop or a hold gave an impulse */
} engine_event;

/* Impacts whose restitution was outside 0 to 1, and was clamped to it. */
typedef struct engine_clamped {
    uint64_t count; /* number of such impacts; the other members describe the first */
    int contact;    /* the stop */
    double value;   /* the restitution */
    double begin_s; /* begin of the step with the impact, s */
} engine_clamped;

/* A part of a step. Events can be only at its begin and its end. */
typedef struct engine_piece {
    double span_s;
    const double *from; /* [angles + reals] state at the begin, as engine_kind's state() gives it */
    const double *to;
    const int *mode; /* [contacts] */
} engine_piece;

typedef struct engine_kind {
    const char *name; /* "float", "double" or "fixed" (host/fixed) */
    int digits;       /* a number printed with this many significant digits is read back exactly */
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
    /* Number of events since the start. *overruns: as in wh_contacts (core/state.h). */
    uint64_t (*events)(const void *run, uint64_t *overruns);
    /* The events of the last step in their order, list[WH_EVENT_LOG]; returns their number. */
    int (*happened)(const void *run, engine_event *list);
    /* The contacts' modes, mode[contacts]. Before the first step: the modes with which this step will begin. */
    void (*modes)(const void *run, int *mode);
    /* Number of evaluations of the accelerations since the start. *most: bound for one step; 0 without contacts. */
    uint64_t (*evaluations)(const void *run, uint64_t *most);
    /* The ledger so far: total[entries], error[accounts] (the residuals); SI. NULL: this number type has no ledger. */
    void (*ledger)(const void *run, double *total, double *error);
    /* Sums the round-offs of component i's increments since the start. Returns the sum's largest size so far, in SI.
     * Returns 0 in double, or with compensated sums. In float, i must be an angle. *span: the component's range without
     * round-off, in SI; 0 in double. */
    double (*component_off)(const void *run, int i, double *span);
    /* The number of values that were clamped to their range since the start; NULL: this number type has no ranges. */
    uint64_t (*saturated)(const void *run);
    /* The unit to which component i is rounded; SI. NULL: floating point. */
    double (*unit)(const void *run, int i);
    /* The impacts with clamped restitution since the start. NULL: this number type has no impacts. */
    engine_clamped (*clamped)(const void *run);
    /* The pieces of the last step, if it was searched for events; else an empty list. NULL: not available. */
    const engine_piece *(*pieces)(const void *run, int *count);
} engine_kind;

/* The work of this process so far, in list operations. Other work is converted to the number of list operations that
 * take about the same time. The number is the same on every machine. */
extern uint64_t engine_operations;
/* Work for one evaluation of the accelerations, in list operations. It includes work of the method and contacts. */
uint64_t engine_evaluation(const image *im);

extern const engine_kind engine_float;
extern const engine_kind engine_double;

/* Evaluates a list in double, repeatedly. An array may be NULL if the list does not read it. */
typedef struct evaluator evaluator;
evaluator *evaluator_new(const op_list *t);
void evaluator_free(evaluator *ev);
/* Makes the evaluator wrap angles to one turn. A float run's angles may exceed the range of the double sine. */
void evaluator_wrap(evaluator *ev);
void evaluator_run(evaluator *ev, double time_s, const double *angle_rad, const double *linear,
                   const double *rate, const double *input, double *result);
/* The value of this operation of the list in the last evaluator_run(). */
double evaluator_value(const evaluator *ev, int operation);
/* Computes bounds on the round-off of the results of the last evaluator_run(): error[results], in unit round-offs.
 * `angle_rad` must be as in that run; `least` is a member of rounding_values (rounding.h). */
void evaluator_rounding(const evaluator *ev, const double *angle_rad, double least, double *error);

/* A list of an image, evaluated in double at any state. The inputs keep their start values. */
typedef struct state_list {
    const image *image;
    evaluator *evaluator;
    double *input;  /* [inputs] */
    double *result; /* [results of the list], from the last state_list_at() */
} state_list;
state_list state_list_open(const image *im, image_role role);
void state_list_close(const state_list *l);
/* Evaluates the list at t = 0 and a state, given as engine_kind's state() returns it. Returns l->result. */
const double *state_list_at(const state_list *l, const double *angle_rad, const double *real);

#endif
