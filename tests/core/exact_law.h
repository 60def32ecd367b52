/* exact_law.h: the contact laws that exact.c moves by, for mechanisms by hand (hand.h): all cases, forces, places. */
#ifndef TESTS_EXACT_LAW_H
#define TESTS_EXACT_LAW_H

#include "exact.h"

/* What is below it is zero; what is but a little above may be, and is vague. */
#define EXACT_ZERO 1e-11

/* What is to be solved: x + M^-1 J^T lambda such that J x reaches target[k], by contacts that push only (a stop), that
 * push so far and no further (limit), or both ways. */
typedef struct exact_problem {
    unsigned members; /* as bits */
    double target[HAND_CONTACTS];
    double low[HAND_CONTACTS];
    double high[HAND_CONTACTS];
} exact_problem;

#define EXACT_ENDLESS 1e9

double exact_size_of(double value);
/* Above zero, at it or below. */
int exact_sign(exact *e, double value);
bool exact_in(unsigned bits, unsigned k);

/* hand_now's contacts with a force; is one of this kind? */
unsigned exact_forced(void);
bool exact_is(unsigned k, wh_contact_kind kind);
/* Contacts of a kind in a mode (those of crossings are none), as bits. */
unsigned exact_those(const exact *e, wh_contact_kind kind, int mode);
/* Those in `bits` have this mode from now on. */
void exact_give(exact *e, unsigned bits, int mode);
/* All that keep their J_k q' at zero, as bits. */
unsigned exact_holding(const exact *e);

/* J_k x; the gap; x += M^-1 J_k^T lambda; what an impulse of l makes of J_k x. */
double exact_along(unsigned k, const double *x);
double exact_gap(const exact *e, unsigned k);
void exact_push(unsigned k, double lambda, double *x);
double exact_coupled(unsigned k, unsigned l);

/* lambda[] of those in `tight`, which reach their targets; the others' are given. False: their rows repeat each other. */
bool exact_reach(const exact_problem *p, unsigned tight, const double *x, double *lambda);
/* The case that meets the conditions: x changes, lambda[] of the members. Returns those whose J x is beyond their
 * targets, as bits. */
unsigned exact_solve(exact *e, const exact_problem *p, double *x, double *lambda);
/* Do rows of the members repeat each other? */
bool exact_repeat(const exact *e, unsigned members);

/* Accelerations and forces as the modes are; what has to pull pulls. */
void exact_accelerate(exact *e, double *a, double *force);
/* What has more than it takes gives way: the stops first, then the friction that is furthest above its limit. */
void exact_give_way(exact *e);

/* Energies, J. */
double exact_stored(const exact *e);
double exact_kinetic(const exact *e);

/* What rests goes back onto its place, and what else holds, but for those in `but`, stays with it. The energy is
 * contact `mover`'s, or, if that is HAND_CONTACTS, the first one's that is off. */
void exact_put_back(exact *e, unsigned but, unsigned mover);

#endif
