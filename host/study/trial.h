/* trial.h: trials of settings: the error against the references, and the cost. */
#ifndef STUDY_TRIAL_H
#define STUDY_TRIAL_H

#include "host/engine/engine.h"
#include "host/number/decimal.h"
#include "host/study/cost.h"
#include "host/study/reference_run.h"

/* === settings ================================================================================= */
/* The options of `whirl run` and `whirl derive`, except the step. */
typedef struct setting {
    image_settings image; /* --method, --compensated, --angles, --matrix, --tables, --cells */
    const engine_kind *number;
} setting;

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

/* Settings are the combinations of one word of each axis, except those in which a word would have no effect. */
int setting_count(void);
setting setting_at(int i); /* 0 <= i < setting_count() */

/* Is the setting's method requested? If `method` is NULL, rk4, nystroem3, nystroem4 and nystroem5 are requested. */
bool setting_is_asked(const setting *s, const bool method[WH_METHODS]);
/* setting_order(): a sort key. setting_number(): index of the number type: float, float compensated, double, fixed. */
int setting_order(const setting *s);
enum { SETTING_NUMBERS = 4 };
int setting_number(const setting *s);
cost_number setting_cost_number(const setting *s);

/* Do only some scenes support these settings? If so, a refusal is no error. */
bool setting_may_be_refused(const image_settings *s);

/* Is a trial of this setting useful? `im` was made with the setting. Returns false if the method does not support the
 * scene. Also returns false if --angles lookup gives the same step as --angles turned (image_turns()). */
bool setting_is_own(const setting *s, const image *im);
/* Is the number type fixed point? Fixed point does not support every scene, nor every step length. */
bool setting_is_fixed(const setting *s);
/* Does the cost of a step depend on the step length? True with a matrix, and in fixed point. */
bool setting_price_varies(const setting *s);

enum { SETTING_TEXT = 160 }; /* room for setting_options() */
/* Returns `text`: options of `whirl derive`, or if `with_number`, of `whirl run`, such as " --method rk4". */
const char *setting_options(const setting *s, bool with_number, char text[SETTING_TEXT]);
/* Additional option of `whirl derive --as c`: " --number fixed", or "". */
const char *setting_form(const setting *s);

/* === trials =================================================================================== */
/* A point is a combination of the varied values, or the scene's own values. */
typedef struct trial_source {
    void *context;
    int points; /* number of points */
    /* Makes the image of a point; the caller frees it. `step` and `until` are texts such as "0.001", in s, or NULL for
     * those of the scene. Returns NULL if the scene refuses the setting, or, with a message, after an error. */
    image *(*make)(void *context, int point, const setting *s, const char *step, const char *until);
    /* The options that select a point, " --set duty=0.2"; "" for the scene's own values. Valid until the next call. */
    const char *(*name)(void *context, int point);
} trial_source;

typedef struct trial_request {
    const trial_source *source;
    const cost_board *board;
    const char *target;  /* the scene as typed, for command lines that repeat a trial */
    const char *changes; /* the scene's changes as typed: "" or " --set m=3 ..." */
    const char *of;      /* the compared output, coordinate or rate; NULL: the worst component */
    whole_ratio spacing; /* interval of the records, s */
    int records;         /* number of records after the start */
    reference_steps by;  /* the steps of the references */
    const image_settings *plain; /* settings of the references' images; NULL: the default ones */
} trial_request;

typedef struct trials {
    trial_request request;
    int points;    /* number of compared points: those with motion, or all if none has motion */
    int *place;    /* [points] index of each compared point in the source */
    char *still;   /* names of the omitted points, each followed by a comma; NULL: none */
    image **image; /* [points] images of the references */
    reference **reference; /* [points] */
    int worst;             /* the point with the worst reference */
    int records;           /* number of compared records after the start */
    deviation_of_what what;
    double tolerated;    /* with --of: errors up to this, in trial_unit(), are always usable */
    bool reliable;       /* all references are reliable */
    bool without_events; /* prices are those of a step without events */
    bool stopped;
} trials;

/* The results of one setting with one step length. */
typedef struct trial_result {
    bool ran; /* false: stopped, or there is no image */
    /* at all points the run reached its end, and its error is small enough (see `tolerated`) */
    bool usable;
    double error; /* the largest error of all points, in trial_unit() */
    bool bound;   /* `error` is a bound, the sum of the measured error and the reference's error */
    int point;    /* the point with the worst error */
    int column;   /* the component with the worst error */
    double evaluations;      /* evaluations per simulated second; the maximum of all points */
    double evaluations_most; /* most evaluations in one step */
} trial_result;

/* Computes a reference for each point. Returns false if w->source->make() returns NULL. Returns false with a message if
 * w->of is no column or has noise. */
bool trial_begin(trials *t, const trial_request *w);
void trial_end(trials *t);

trial_result trial_run(trials *t, const setting *s, deviation_pace pace);
/* Estimated operations of trial_run(), without those of events. */
double trial_operations(const trials *t, const setting *s, deviation_pace pace);
/* Returns the setting's cost at the most expensive point. Sets *own to false if setting_is_own() is false, or
 * if the scene does not support the setting. */
cost trial_cost(const trials *t, const setting *s, deviation_pace pace, bool *own);

const char *trial_place(const trials *t, int point);
whole_ratio trial_step(const trials *t, deviation_pace pace);
double trial_horizon_s(const trials *t);
/* The unit of errors, such as "m", or "" if errors are parts of the largest value. */
const char *trial_unit(const trials *t);
/* Converts an error from trial_unit() to SI. */
double trial_error_si(const trials *t, double error);
/* Returns `text`: the column's name with primes, such as "theta'". */
enum { TRIAL_NAME = 96 };
const char *trial_column(const trials *t, int column, char text[TRIAL_NAME]);

/* The step as --step takes it, with the fewest digits that are read back exactly. Returns text. */
const char *trial_step_text(const trials *t, deviation_pace pace, char text[NUMBER_SIZE]);
/* The end of the compared motion, as --until takes it. */
const char *trial_until(const trials *t, char text[NUMBER_SIZE]);

#endif
