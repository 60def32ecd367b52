/* springs_told.h: a run of two springs that is right, about which findings may be made up; the steps that are to be named for it by
 * closed form; and what trying one comes to. */
#ifndef TESTS_HOST_SPRINGS_TOLD_H
#define TESTS_HOST_SPRINGS_TOLD_H

#include "command.h"
#include "derived.h"
#include "host/run/verdict.h"

/* 1, 2 or 5 times a power of ten, s, not beyond it, and as it is written. */
double springs_nice_s(double most_s, char word[40]);

typedef struct springs {
    derived d;
    verdict *v;
    void *run;
    double step_s;
    int steps;
    wh_method method;
} springs;

/* Of 1 kg each, x with h w = `z`, y five times as slow; q turns evenly. */
springs springs_of(const engine_kind *kind, wh_method method, double step_s, int steps, double z);
void springs_end(springs *s);

/* What trying it comes to: it does, there is no time for it, or it ends early; drawn. `failing` outlives the springs. */
typedef enum trial { DOES, NOT_TRIED, FAILS, TRIALS } trial;
trial springs_trial(dice *d, springs *s, engine_kind *failing);
extern const char *const springs_done[TRIALS]; /* so it is said */

/* How much of an oscillator's amplitude steps of Heun or Runge-Kutta 4 take or give over a time. */
double springs_lost_by(wh_method method, double w, double step_s, double span_s);
/* The largest nice step, not beyond it, at which no more than that is lost of the energy of a motion with that share. */
double springs_nice_words(const springs *s, double w, double most_s, double share, double allowed,
                          char word[40]);

#endif
