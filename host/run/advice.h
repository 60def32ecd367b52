/* advice.h: what of a run is to be warned of, why, and what would do. Words on standard error; no exit status.
 *
 * What is told is in docs/stability.md. Everything is made of what was watched (watch.h) and of the balance (belief.h);
 * eigenvalues are looked for only where there is something to say, and of systems without energies, whose swings have no
 * other witness. */
#ifndef RUN_ADVICE_H
#define RUN_ADVICE_H

#include "belief.h"
#include "linearised.h"

/* More than this part of the largest entry is missing on the way, and not only at the end. */
#define ADVICE_ON_THE_WAY 3e-3

typedef struct advice {
    const image *image;
    const engine_kind *kind;
    const watch *watch;
    const belief *balance;
    linearised *motions; /* NULL until they are asked for */
    bool swing_known;    /* it has been asked whether */
    bool swing;
    double swing_off; /* of a swing that varies along its way: swing_off(); else 0 */
} advice;

advice advice_of(const image *im, const engine_kind *kind, const watch *w, const belief *balance);
void advice_end(advice *a);

/* Is the energy's balance to be warned of? As belief_lost() has it, but for what the books' own rule has made of powers
 * that change within a step; and where it was lost on the way and came back. */
bool advice_lost(const advice *a);
/* The cause and the cure of that, a sentence to stand behind "hint: "; NULL: none that is known better than belief_say()'s.
 * To be freed. */
char *advice_cure(advice *a);
/* Is there a singular position that the step does not resolve? A swing that a system given by its equations loses? */
bool advice_singular(const advice *a);
bool advice_swing(advice *a);
/* Both, with what would do. */
void advice_say(FILE *out, advice *a);
/* A run that has ended for leaving all bounds: the motion that the method does not carry, if it is one. */
void advice_say_diverged(FILE *out, advice *a);

#endif
