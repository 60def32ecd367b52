/* engine.h: running an image without a compiler: the interpreter of operation lists.
 *
 * There is one interpreter source, built in float (the boards' arithmetic, to the bit) and in double
 * (the reference); both step with core/step.h. The interface speaks double whichever is inside.
 */
#ifndef ENGINE_ENGINE_H
#define ENGINE_ENGINE_H

#include "host/image/image.h"

/* What happened to a contact (its number in the image) in a step, and the mode it was in then (core/state.h). */
typedef struct engine_event {
    int contact;
    int mode;
    double at_s;  /* since the step began */
    bool strikes; /* a stop or a hold gave an impulse */
} engine_event;

/* Impacts with a restitution beyond 0 to 1, which counts as the nearer end: how many, and of the first the stop, the
 * restitution and when its step began. */
typedef struct engine_clamped {
    uint64_t count;
    int contact;
    double value;
    double begin_s;
} engine_clamped;

/* The motion between two events of a step, or between an event and an end of the step. */
typedef struct engine_piece {
    double span_s;
    const double *from; /* [angles + reals], as engine_kind's state() */
    const double *to;
    const int *mode; /* [contacts] */
} engine_piece;

typedef struct engine_kind {
    const char *name; /* "float", "double" or "fixed" (host/fixed) */
    int digits;       /* significant digits that carry a number of this kind through text */
    void *(*start)(const image *im); /* must outlive the run */
    void (*stop)(void *run);
    wh_status (*step)(void *run);
    void (*set_input)(void *run, int input, double value);
    /* angle_rad[angles] unwrapped, real[reals]; SI */
    void (*state)(const void *run, double *angle_rad, double *real);
    void (*outputs)(void *run, double *output);
    uint64_t (*hash)(const void *run);
    uint64_t (*steps)(const void *run);
    /* Component that diverged, angles first, or -1. */
    int (*fault)(const void *run);
    /* Events since the start, and steps with more than WH_EVENTS_MAX moments of them. */
    uint64_t (*events)(const void *run, uint64_t *overruns);
    /* Of the last step, in their order, list[WH_EVENT_LOG]; returns how many. */
    int (*happened)(const void *run, engine_event *list);
    /* The contacts' modes, mode[contacts]; at the start those that hold when the first step begins. */
    void (*modes)(const void *run, int *mode);
    /* Evaluations of the accelerations since the start; *most: declared for one step with contacts. */
    uint64_t (*evaluations)(const void *run, uint64_t *most);
    /* The books so far: total[entries], error[accounts] (the numerical drift); SI. */
    void (*ledger)(const void *run, double *total, double *error);
    /* Of component i, angles first: the most that rounding its steps to whole units has put it off what was asked for,
     * since the start, and the span that this asked for; SI. Of numbers without a unit(): turn angles only, which move by
     * units of 2^32 a turn in float; 0 in double, and compensated. */
    double (*component_off)(const void *run, int i, double *span);
    /* Values that were held at an end of their range since the start; NULL: this number has no ranges. */
    uint64_t (*saturated)(const void *run);
    /* What component i is kept in whole units of; SI. NULL: floating point. */
    double (*unit)(const void *run, int i);
    engine_clamped (*clamped)(const void *run); /* NULL: there are no impacts */
    /* The pieces of the last step, if it was looked at for events; else none. NULL: not known. */
    const engine_piece *(*pieces)(const void *run, int *count);
} engine_kind;

/* What this process has evaluated so far, in operations of lists: the same on every machine. What is none is counted as
 * so many as take as long, to a third. */
extern uint64_t engine_operations;
/* Of these, an evaluation of the accelerations takes so many, with what a method and contacts do for it. */
uint64_t engine_evaluation(const image *im);

extern const engine_kind engine_float;
extern const engine_kind engine_double;

/* Evaluates a list in double, again and again. Arrays may be NULL where the list has no such leaves. */
typedef struct evaluator evaluator;
evaluator *evaluator_new(const op_list *t);
void evaluator_free(evaluator *ev);
/* From now on sines are those of the angles within a turn: for the state of a float run, whose turn angles go
 * beyond what the double build knows a sine of. */
void evaluator_wrap(evaluator *ev);
void evaluator_run(evaluator *ev, double time_s, const double *angle_rad, const double *linear,
                   const double *rate, const double *input, double *result);
/* What this operation of the list came to in the evaluator_run() just done. */
double evaluator_value(const evaluator *ev, int operation);
/* How far off the results of the evaluator_run() just done, with the same angles, may be for the rounding of the list's
 * operations: error[results], in units of the numbers' rounding (rounding.h). */
void evaluator_rounding(const evaluator *ev, const double *angle_rad, double least, double *error);

#endif
