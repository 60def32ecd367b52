/* trial.h: trials of settings: the error against the references, and the cost. */
#ifndef STUDY_TRIAL_H
#define STUDY_TRIAL_H

#include "host/engine/engine.h"
#include "host/study/cost.h"
#include "host/study/reference_run.h"

/* === settings ================================================================================= */
/* The settings of a scene that are priced: every combination of the words below, each at several steps. A
 * choice more is a row of SETTING_AXES. */

/* The options of `whirl run` and `whirl derive`, except the step. */
typedef struct setting {
    image_settings image; /* --method, --compensated, --angles, --matrix, --tables, --cells */
    const engine_kind *number;
} setting;

/* X(id, heading of a column, words), in the order of the options. The first word of an axis is its default. */
#define SETTING_AXES(X) \
    X(AXIS_METHOD, "method") \
    X(AXIS_NUMBER, "number") \
    X(AXIS_ANGLES, "angles") \
    X(AXIS_MATRIX, "matrix") \
    X(AXIS_TABLES, "tables")
#define SETTING_AXIS(id, heading) id,
typedef enum setting_axis { SETTING_AXES(SETTING_AXIS) AXES } setting_axis;
#undef SETTING_AXIS

const char *setting_heading(setting_axis axis);
/* The word that a setting has on an axis. */
const char *setting_word(const setting *s, setting_axis axis);

/* All combinations that any scene takes. A matrix has neither method nor angles, and tables have no angles to turn. Fixed point
 * has one method and no other setting. */
int setting_count(void);
setting setting_at(int i); /* 0 <= i < setting_count() */

/* Is its method requested? NULL: the default ones, rk4 and nystroem3 to 5. Over the points of docs/figures/price.csv the
 * others save nothing in the median. A matrix takes the place of the default method. */
bool setting_is_asked(const setting *s, const bool method[WH_METHODS]);
/* Its place among all, and its number's among the numbers: float, float compensated, double, fixed. */
int setting_order(const setting *s);
enum { SETTING_NUMBERS = 4 };
int setting_number(const setting *s);
cost_number setting_cost_number(const setting *s);

/* May a scene refuse this form without an error? A matrix requires a linear scene, tables one turn angle. */
bool setting_may_be_refused(const image_settings *s);

/* Does this setting differ from earlier ones, for an image made with it? Not if its method does not take the system.
 * Not if its angles cannot turn either, because they are then looked up in any case. */
bool setting_is_own(const setting *s, const image *im);
/* In fixed point a scene may have no step, or no step of this length (host/fixed). */
bool setting_is_fixed(const setting *s);
/* Does the cost of a step depend on its length? The entries of a matrix do, and so do shifts in fixed point. */
bool setting_price_varies(const setting *s);

/* Room for setting_options(). */
enum { SETTING_TEXT = 160 };
/* " --method rk4 --angles lookup": of `whirl derive`, or with the number those of `whirl run`. Returns text. */
const char *setting_options(const setting *s, bool with_number, char text[SETTING_TEXT]);
/* Additional option of `whirl derive --as c`: " --number fixed", or "". */
const char *setting_form(const setting *s);

/* === trials =================================================================================== */
/* The source of images: the scene, varied. */
typedef struct trial_source {
    void *context;
    int points; /* the scene itself, or this many places of its ranges and the scene's own values */
    /* The image of a place, with this setting, step and end ("0.001", seconds; NULL: the scene's own). The caller frees it.
     * NULL without an image: reported, unless the scene refuses the setting (setting_may_be_refused()). */
    image *(*make)(void *context, int point, const setting *s, const char *step, const char *until);
    /* A place as options: " --set duty=0.2"; "" is the scene itself. Valid until the next call. */
    const char *(*name)(void *context, int point);
} trial_source;

typedef struct trial_wish {
    const trial_source *source;
    const cost_board *board;
    const char *of;              /* an output, coordinate or rate; NULL: the worst component */
    whole_ratio spacing;         /* of the records, s */
    int records;                 /* after the start */
    reference_steps by;          /* the steps of the references */
    const image_settings *plain; /* of their images; NULL: the default ones */
    whole_ratio priced_step; /* its cost stands for all steps, if possible; 0: each has its own */
} trial_wish;

typedef struct trial_planned {
    image *image;
    deviation_pace pace;
} trial_planned;

typedef struct trials {
    trial_wish wish;
    int points;    /* the source's moving places; all of them if nothing moves at all */
    int *place;    /* [points] their numbers in the source */
    char *still;   /* the options of the places that were left out: " --set M=0,"; or NULL */
    image **image; /* [points] of the references */
    reference **reference;  /* [points] */
    trial_planned *planned; /* [points] in fixed point: priced and to be run */
    int worst;              /* the point whose reference ends first, or is least accurate */
    int records;            /* records after the start for which all references are trusted */
    deviation_of_what what;
    double
        tolerated; /* for one column: a run with this error is useful, however small the values are */
    double planned_most; /* operations of a run that finds ranges of fixed point; 0: any */
    bool reliable;       /* false: some reference is REFERENCE_NONE */
    bool without_events; /* prices of scenes with contacts are those of a step that has no event */
    bool stopped;
    double operations; /* evaluated in trials so far */
} trials;

/* The results of one setting at one step. */
typedef struct trial_result {
    bool ran; /* false: stopped, or there is no image */
    bool
        usable; /* at all points it came to the end, and was not off by more than the values themselves */
    double
        error; /* the worst, in the unit of `of` or as a part of the largest value, plus the reference's own error */
    bool bound;         /* it is no more than a bound: the reference does not know better */
    int point;          /* with the worst error */
    int column;         /* which component */
    double evaluations; /* of the accelerations, a simulated second, at the place that takes most */
    double evaluations_most; /* in one step */
} trial_result;

/* Computes the references. False, reported on standard error, if `of` is unknown to the scene, or an image is missing. */
bool trial_begin(trials *t, const trial_wish *w);
void trial_end(trials *t);

trial_result trial_run(trials *t, const setting *s, deviation_pace pace);
/* Estimated operations, without those of events. */
double trial_operations(const trials *t, const setting *s, deviation_pace pace);
/* Its cost at the dearest of the points; *own: false if it equals another setting (setting_is_own()), or the scene
 * refuses it. */
cost trial_cost(trials *t, const setting *s, deviation_pace pace, bool *own);
/* The same if a scene takes the setting only with finer steps, as in fixed point: by the first that it takes. */
cost trial_any_cost(trials *t, const setting *s, deviation_pace pace, bool *own);
/* Would that take more than t->planned_most? */
bool trial_is_slow_to_plan(const trials *t, const setting *s, deviation_pace pace);

/* The options of a point: " --set duty=0.2"; "" is the scene itself. Valid until the next call. */
const char *trial_place(const trials *t, int point);
whole_ratio trial_step(const trials *t, deviation_pace pace);
double trial_horizon_s(const trials *t);
/* The unit of errors: "m", or "" for parts of the largest value. */
const char *trial_unit(const trials *t);
/* Converts an error from that unit to SI. */
double trial_error_si(const trials *t, double error);
/* The component's name: "X", "theta'". Returns text. */
enum { TRIAL_NAME = 96 };
const char *trial_column(const trials *t, int column, char text[TRIAL_NAME]);

/* A time as --step and --until take it: seconds in as few digits as bring back the same fraction. Returns text. */
enum { TRIAL_TIME = 40 };
const char *trial_time(whole_ratio time, char text[TRIAL_TIME]);
/* The end of the compared motion, as --until takes it; ranges in fixed point extend to it. Returns text. */
const char *trial_until(const trials *t, char text[TRIAL_TIME]);

#endif
