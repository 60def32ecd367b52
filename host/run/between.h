/* between.h: what goes on between the stages of a step. A force at 1 kHz, in steps of 4 ms, is the same at every stage, and is
 * one that stands still; in steps of half the length, too, so that two such runs agree, and the books of both.
 *
 * At a number of steps, two in a row each time, the accelerations (of a system, the highest slopes) are asked at some more
 * places, other ones each time, and in some of the rows at many, on the way that places and rates at both ends of the step
 * tell. Where they are far from the straight line between those at its ends, the step is taken again in parts so fine that it
 * is known, and in numbers that no common period divides: by how much the rates of the run then are off in the mean of these
 * rows is what its steps never saw. What goes up and down from step to step says nothing, unless it is as much as all that
 * the rate does; and what a method is off by neither: that is less than was seen. Where few steps are seen, as edges are that
 * fall into one now and then, rows are to go one way, too. Forces of contacts are not in it; where there are some, only steps
 * that they leave alone count so, and the slopes' distance from the line counts itself: what a friction makes of a force is
 * not what it makes of its mean. Nothing of it touches the run. */
#ifndef RUN_BETWEEN_H
#define RUN_BETWEEN_H

#include "engine.h"

typedef struct between between;

between *between_open(const image *im, const engine_kind *kind);
void between_close(between *b); /* NULL is fine */
/* Enter the state after each step, the start included. */
void between_enter(between *b, const engine_kind *kind, const void *run);

typedef struct between_found {
    int component;      /* the rate (of a system: the unknown) whose slope it is of; -1: nothing */
    double off;         /* by which its slope is off in the mean, of the largest that it had */
    double begin_s;     /* the first step that was seen so */
    double fine_step_s; /* such steps see it */
} between_found;
/* So far. */
between_found between_seen(const between *b);

#endif
