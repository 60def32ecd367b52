/* exact_law.h: the contact laws of exact.c, for the mechanisms of hand.h: combinations of modes, forces, positions. */
#ifndef TESTS_EXACT_LAW_H
#define TESTS_EXACT_LAW_H

#include "exact.h"

/* A smaller number counts as zero. A number slightly above makes a decision vague (exact.h). */
#define EXACT_ZERO 1e-11

/* The problem: find forces lambda that move x by M^-1 J^T lambda, so that J_k x = target[k] for each member. A stop
 * only pushes, a friction acts up to a limit, a hold acts both ways. */
typedef struct exact_problem {
    unsigned members; /* contacts, as bits */
    double target[HAND_CONTACTS];
    double low[HAND_CONTACTS];
    double high[HAND_CONTACTS];
} exact_problem;

#define EXACT_ENDLESS 1e9

double exact_size_of(double value);
/* Returns the sign of a value: 1, 0 or -1. */
int exact_sign(exact *e, double value);
bool exact_in(unsigned bits, unsigned k);

/* Returns hand_now's contacts with a force, as bits; the next function: true if contact k is of this kind. */
unsigned exact_forced(void);
bool exact_is(unsigned k, wh_contact_kind kind);
/* Returns the contacts of a kind in a mode, as bits. Crossings have no mode. */
unsigned exact_those(const exact *e, wh_contact_kind kind, int mode);
void exact_give(exact *e, unsigned bits, int mode);
/* Returns the contacts that keep J_k q' at zero, as bits. */
unsigned exact_holding(const exact *e);

/* exact_along(): J_k x. exact_gap(): the gap. exact_push(): x += M^-1 J_k^T lambda. exact_coupled(): the change of
 * J_k x by a unit impulse of contact l. */
double exact_along(unsigned k, const double *x);
double exact_gap(const exact *e, unsigned k);
void exact_push(unsigned k, double lambda, double *x);
double exact_coupled(unsigned k, unsigned l);

/* Computes lambda[] so that the contacts in `tight` reach their targets; the lambda[] of the others are given. Returns
 * false if rows are dependent. */
bool exact_reach(const exact_problem *p, unsigned tight, const double *x, double *lambda);
/* Finds the combination of limits that satisfies the conditions, and sets x and the members' lambda[]. Returns, as
 * bits, the contacts with J x beyond target. */
unsigned exact_solve(exact *e, const exact_problem *p, double *x, double *lambda);
bool exact_repeat(const exact *e, unsigned members);

/* Computes accelerations and forces in the current modes. A contact that would have to pull does pull. If rows are
 * dependent, the later ones get no force. */
void exact_accelerate(exact *e, double *a, double *force);
/* Releases contacts above their limit: stops first, then the friction furthest above its limit. */
void exact_give_way(exact *e);

double exact_stored(const exact *e);
double exact_kinetic(const exact *e);

/* Moves resting contacts back to their constraints; holds, except those in `but`, keep their values. The energy is
 * entered for contact `mover` or, if `mover` is HAND_CONTACTS, for the first contact with an error. */
void exact_put_back(exact *e, unsigned but, unsigned mover);

#endif
