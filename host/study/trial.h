/* trial.h: trials of settings: the error against the references, and the cost. */
#ifndef STUDY_TRIAL_H
#define STUDY_TRIAL_H

#include "host/engine/engine.h"
#include "host/number/decimal.h"
#include "host/study/cost.h"
#include "host/study/reference_run.h"

/* === settings ================================================================================= */
/* The priced settings of a scene: every combination of the words of SETTING_AXES, each at several steps. */

/* The options of `whirl run` and `whirl derive`, except the step. */
typedef struct setting {
    image_settings image; /* --method, --compensated, --angles, --matrix, --tables, --cells */
    const engine_kind *number;
} setting;

/* In the order of the options. The first word of an axis is its default. */
typedef enum setting_axis {
    AXIS_METHOD,
    AXIS_NUMBER,
    AXIS_ANGLES,
    AXIS_MATRIX,
    AXIS_TABLES,
    AXES
} setting_axis;

const char *setting_heading(setting_axis axis); /* of a column */
const char *setting_word(const setting *s, setting_axis axis);

/* All combinations that make sense for some scene. With a matrix there is no choice of method or angles, and with
 * tables none of angles. Fixed point has one method and no other setting. */
int setting_count(void);
setting setting_at(int i); /* 0 <= i < setting_count() */

/* Is the method of this setting requested? `method` NULL requests rk4 and nystroem3 to 5, because in the median of the
 * points in docs/figures/price.csv no other method is cheaper. A matrix replaces the default method. */
bool setting_is_asked(const setting *s, const bool method[WH_METHODS]);
/* setting_order(): a sort key. setting_number(): index of the number type: float, float compensated, double, fixed. */
int setting_order(const setting *s);
enum { SETTING_NUMBERS = 4 };
int setting_number(const setting *s);
cost_number setting_cost_number(const setting *s);

/* May a scene refuse this form without an error? A matrix requires a linear scene, tables one turn angle. */
bool setting_may_be_refused(const image_settings *s);

/* Does this setting, with which `im` was made, give a step that no other one gives? False: the method does not support
 * the system, or sines are looked up in any case because they cannot be rotated. */
bool setting_is_own(const setting *s, const image *im);
/* Is the number type fixed point? Then a scene may have no step, or no step of this length (host/fixed). */
bool setting_is_fixed(const setting *s);
/* Does the cost of a step depend on its length? The entries of a matrix do, and so do shifts in fixed point. */
bool setting_price_varies(const setting *s);

enum { SETTING_TEXT = 160 }; /* room for setting_options() */
/* " --method rk4 --angles lookup": options of `whirl derive`; with the number type, of `whirl run`. Returns text. */
const char *setting_options(const setting *s, bool with_number, char text[SETTING_TEXT]);
/* Additional option of `whirl derive --as c`: " --number fixed", or "". */
const char *setting_form(const setting *s);

/* === trials =================================================================================== */
/* Makes images of the scene at each point of its varied values. */
typedef struct trial_source {
    void *context;
    int points; /* 1: the scene itself; else also the points of its ranges */
    /* The image of a point, with this setting, step and end ("0.001", seconds; NULL: the scene's own). The caller frees
     * it. NULL without an image: reported, unless the scene refuses the setting (setting_may_be_refused()). */
    image *(*make)(void *context, int point, const setting *s, const char *step, const char *until);
    /* A point as options: " --set duty=0.2"; "" is the scene itself. Valid until the next call. */
    const char *(*name)(void *context, int point);
} trial_source;

typedef struct trial_request {
    const trial_source *source;
    const cost_board *board;
    const char *target;  /* the scene as typed, for command lines that repeat a trial */
    const char *changes; /* its changes as typed: "" or " --set m=3 ..." */
    const char *of;      /* the compared output, coordinate or rate; NULL: the worst component */
    whole_ratio spacing; /* interval of the records, s */
    int records;         /* number of records after the start */
    reference_steps by;  /* the steps of the references */
    const image_settings *plain; /* settings of the references' images; NULL: the default ones */
} trial_request;

typedef struct trials {
    trial_request request;
    int points;    /* number of the source's points with motion; all points if there is no motion */
    int *place;    /* [points] number of each point in the source */
    char *still;   /* the options of the omitted points: " --set M=0,"; or NULL */
    image **image; /* [points] images of the references */
    reference **reference; /* [points] */
    int worst;             /* the point whose reference ends first, or is least accurate */
    int records;           /* records after the start for which all references are trusted */
    deviation_of_what what;
    double tolerated;    /* with --of: errors up to this are usable, even for a smaller quantity */
    bool reliable;       /* all references are reliable */
    bool without_events; /* with contacts, prices are those of a step without an event */
    bool stopped;
} trials;

/* The results of one setting with one step length. */
typedef struct trial_result {
    bool ran;     /* false: stopped, or there is no image */
    bool usable;  /* at all points the run reached its end, with an error below the largest value */
    double error; /* the largest of all points, in trial_unit() */
    bool bound;   /* `error` includes the reference's error, which is about as large */
    int point;    /* the point with the worst error */
    int column;   /* the component with the worst error */
    double evaluations;      /* of the accelerations per simulated second, the most of all points */
    double evaluations_most; /* most evaluations in one step */
} trial_result;

/* Computes the references. False, reported on standard error, if the scene has no `of`, or an image is missing. */
bool trial_begin(trials *t, const trial_request *w);
void trial_end(trials *t);

trial_result trial_run(trials *t, const setting *s, deviation_pace pace);
/* Estimated operations of trial_run(), without those of events. */
double trial_operations(const trials *t, const setting *s, deviation_pace pace);
/* The setting's cost at the most expensive point. *own: false if setting_is_own() is, or if the scene refuses the
 * setting, perhaps only with this step (setting_price_varies()). In fixed point this takes as long as a run. */
cost trial_cost(const trials *t, const setting *s, deviation_pace pace, bool *own);

const char *trial_place(const trials *t, int point);
whole_ratio trial_step(const trials *t, deviation_pace pace);
double trial_horizon_s(const trials *t);
/* The unit of errors: "m", or "" for parts of the largest value. */
const char *trial_unit(const trials *t);
/* Converts an error from trial_unit() to SI. */
double trial_error_si(const trials *t, double error);
/* The component's name: "X", "theta'". Returns text. */
enum { TRIAL_NAME = 96 };
const char *trial_column(const trials *t, int column, char text[TRIAL_NAME]);

/* The step as --step takes it, with the fewest digits that are read back exactly. Returns text. */
const char *trial_step_text(const trials *t, deviation_pace pace, char text[NUMBER_SIZE]);
/* The end of the compared motion, as --until takes it. Ranges in fixed point come from a run to it. Returns text. */
const char *trial_until(const trials *t, char text[NUMBER_SIZE]);

#endif
