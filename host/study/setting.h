/* setting.h: the settings of a scene that are priced: every combination of the words below, each at several steps. A
 * choice more is a row of SETTING_AXES. */
#ifndef STUDY_SETTING_H
#define STUDY_SETTING_H

#include "cost_board.h"
#include "host/engine/engine.h"

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

#endif
