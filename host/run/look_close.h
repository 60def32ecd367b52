/* look_close.h: a close look at the last steps of a run: the same way in steps so small that it is known, and the mass matrix on
 * it (watch.h says what for). */
#ifndef RUN_LOOK_CLOSE_H
#define RUN_LOOK_CLOSE_H

#include "watched.h"

/* At the last WATCH_WINDOW steps, and at `ahead` steps beyond, which the run could not take. What is found is kept in
 * w->worst and w->singular where it is more than what is there. */
void look_close(watch *w, int ahead);

#endif
