/* judged.h: what of a run is to be warned of, yes or no; the words and what would do are advice.h's.
 *
 * Everything is made of what was watched (watch.h) and of the balance (belief.h); eigenvalues are looked for only where
 * there is something to say, and of systems without energies, whose swings have no other witness. */
#ifndef RUN_JUDGED_H
#define RUN_JUDGED_H

#include "belief.h"
#include "linearised.h"

/* More than this part of the largest entry is missing on the way, and not only at the end. */
#define JUDGED_ON_THE_WAY 3e-3
/* Off by more than this in a few steps is not resolved (watch.h says of what). */
#define JUDGED_NOT_RESOLVED 3e-3
/* Rounding of the mass matrix makes so much of accelerations. */
#define JUDGED_BLURRED 1e-4
/* The same of constants that were folded, where it moves rates by such a part of their range over the run. */
#define JUDGED_FOLDED 1e-3
#define JUDGED_FOLDED_MOVES 1e-3
/* Of a system's swing: what of it is lost. */
#define JUDGED_SWING_LOST 0.01

typedef struct judged {
    const image *image;
    const engine_kind *kind;
    const watch *watch;
    const belief *balance;
    linearised *motions; /* NULL until they are asked for */
    bool folded_known;   /* it has been asked, */
    double
        folded_off; /* how far off folding puts an acceleration, of its largest; 0: nowhere that it moves much, */
    int folded;          /* and which component's slope that is; */
    double start_off;    /* how far off it puts where a component starts, of its range or size, */
    int start;           /* and of which; */
    double contacts_off; /* how far off it puts numbers of contacts */
    bool energy_known;   /* it has been asked whether */
    bool energy;
    bool swing_known; /* likewise */
    bool swing;
    double swing_off; /* of a swing that varies along its way: swing_off(); else 0 */
} judged;

judged judged_of(const image *im, const engine_kind *kind, const watch *w, const belief *balance);
void judged_end(judged *j);

/* The method that steps it, the matrix of Runge-Kutta's included. */
wh_method judged_method(const image *im);
/* The motions of the run, looked for once. */
linearised *judged_motions(judged *j);

/* Is the energy's balance to be warned of? As belief_lost() has it, but for what the books' own rule has made of powers
 * that change within a step; and where it was lost on the way and came back. */
bool judged_lost(const judged *j);
/* And is the motion off, where that rule was in doubt? What steps give and take of a force that is too fast for the rule may
 * come to more than is told of, and put the motion nowhere: then a way of a quarter of the step agrees with the run. */
bool judged_energy(judged *j);
/* What is missing of the largest entry, at the end or on the way. */
double judged_missing(const judged *j);
/* Is so little left of the mass matrix, wherever it stands, that numbers do not tell what moves? */
bool judged_blurred(const judged *j);
/* Have constants lost digits that the motion needs, when they were folded to double? */
bool judged_folded(judged *j);
/* Or an initial value its own? */
bool judged_start(judged *j);
/* Or numbers of its contacts? */
bool judged_contacts(judged *j);
/* Any of the three, or is one of the scene's numbers, rounded otherwise, beyond all bounds? */
bool judged_numbers(judged *j);
/* Is there a singular position that the step does not resolve? A swing that a system given by its equations loses? */
bool judged_singular(const judged *j);
bool judged_swing(judged *j);

#endif
