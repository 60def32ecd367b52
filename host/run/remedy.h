/* remedy.h: options that would do for a run that is warned of. Linear theory, the order of the method or a close look
 * propose them; each is tried (cure.h) before it is named, a finer one where it does not do, and what could not be tried is
 * named as such. */
#ifndef RUN_REMEDY_H
#define RUN_REMEDY_H

#include "cure.h"
#include "judged.h"

enum { REMEDY_TEXT = 200 };

/* "--step 50ms would do, or --method rk38": false where nothing is known that would. A step that is not beyond `most_s`,
 * where the theory has one; where it is so small that a better method has more of it, that one is named with its own.
 * `saturated`: so much is missing that the theory saw another motion. */
bool remedy_text(judged *j, cures *c, double most_s, bool saturated, char text[REMEDY_TEXT]);

/* The options alone, with which what was looked at is resolved, and whether all of the run is right with them. */
cure_outcome remedy_of_look(const judged *j, cures *c, const watch_look *look,
                            char text[REMEDY_TEXT]);

/* The options alone of a step below the run's, and whether the run is right with it. */
cure_outcome remedy_finer(const judged *j, cures *c, char text[REMEDY_TEXT]);

/* Likewise, of a step that is `step_s` or below it. */
cure_outcome remedy_from(const judged *j, cures *c, double step_s, char text[REMEDY_TEXT]);

/* Of a run that failed: does it go through with a step that is much finer, as fine as costs little? True where that is not known. */
bool remedy_goes_through(const judged *j, cures *c);

/* A float's run, with nothing changed but the number: is double enough? */
bool remedy_is_double(const judged *j, cures *c);

/* The step at which the rest is as small as the method's order makes it from `ratio`. */
double remedy_step_by_order_s(const judged *j, double ratio);

#endif
