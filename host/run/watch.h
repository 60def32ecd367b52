/* watch.h: what a run that takes too coarse a step, or passes where its coordinates are singular, is known by while it goes
 * on; the judgement and the words are advice.h's.
 *
 * Five things, none of which touches the run:
 *
 *   - Records of the state, at most WATCH_RECORDS, evenly over the run so far, and the start. Where it is asked why, the
 *     motion is linearised there.
 *   - A close look: the way of the last few steps again, in double, in steps so small that it is known, where the
 *     accelerations changed most. By how much the run's own steps are off it is the error of these steps, whatever
 *     its cause. On the way the mass matrix is watched: a pivot of nearly nothing is a singular position.
 *   - The energy's balance without a rule of integration: where the books' own (Simpson's) is in doubt, because the
 *     powers change within a step, what two steps did to the energy is held against what the accurate way does from
 *     the same state. Summed, that is what the method took or gave, and only that.
 *   - Steps that jump over a pole of an expression (jumped.h).
 *   - What goes on between the stages of a step (between.h).
 *
 * Scenes with contacts get records, poles and what is between stages alone: their forces are not in the right-hand side. */
#ifndef RUN_WATCH_H
#define RUN_WATCH_H

#include "watched.h"

/* `b` may be NULL. */
watch *watch_open(const image *im, const engine_kind *kind);
void watch_close(watch *w);
/* Enter the state after each step, the start included, after the books. */
void watch_enter(watch *w, const engine_kind *kind, const books *b, const void *run);
/* The run is over: what was to be looked at still is, and where it failed the next steps are. */
void watch_end(watch *w, bool failed);

#endif
