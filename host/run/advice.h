/* advice.h: why a run is to be warned of, in words, and what would do. Words on standard error; no exit status.
 *
 * What is told is in docs/stability.md; whether anything is, judged.h knows. */
#ifndef RUN_ADVICE_H
#define RUN_ADVICE_H

#include <stdio.h>

#include "cure.h"
#include "judged.h"

typedef struct advice {
    judged judged;
    cures cures;
} advice;

advice advice_of(const image *im, const engine_kind *kind, const watch *w, const belief *balance);
void advice_end(advice *a);

/* The cause and the cure of an energy that is lost, a sentence to stand behind "hint: "; NULL: none that is known better
 * than belief_say()'s. To be freed. */
char *advice_cure(advice *a);
/* A singular position that the step does not resolve, and a swing that a system given by its equations loses, with what
 * would do. */
void advice_say(FILE *out, advice *a);
/* A run in which an expression has been no number: what keeps it away from there, if anything that was tried does. */
void advice_say_undefined(FILE *out, advice *a);
/* A run that has ended for leaving all bounds: the motion that the method does not carry, if it is one. */
void advice_say_diverged(FILE *out, advice *a);

#endif
