/* hand.h: contact mechanisms of one or two coordinates with constant masses, loads and springs, whose motion is known
 * in closed form. */
#ifndef TESTS_HAND_H
#define TESTS_HAND_H

/* A generated scene defines such sizes, too. The core's largest sizes need too much of a board's stack. */
#define WH_LEDGER 1
#define WH_LEDGER_MAX 12
#define WH_ACCOUNTS_MAX 3
#define WH_COORDS 2
#define WH_UNROLL
#define HAND_CONTACTS 3
#define WH_CONTACTS_MAX HAND_CONTACTS
#define WH_SETS_MAX 1
#include "core/contact/contact_step.h"

typedef struct hand {
    unsigned n;
    wh_real mass[2][2];
    wh_real inverse[2][2];
    wh_real load[2];   /* N */
    wh_real spring[2]; /* N/m, towards the origin */
    struct {
        wh_real row[2]; /* row of the gap, the held or the crossing expression: row . x - offset */
        wh_real offset;
        wh_real first;  /* restitution, or mu_static times the normal force */
        wh_real second; /* mu_kinetic times the normal force, in N */
    } law[HAND_CONTACTS];
    wh_contact contact[HAND_CONTACTS];
    wh_contact_system system;
    unsigned bent;    /* a crossing's value is raised to the power 1 + 2 bent */
    unsigned lost[2]; /* bits: contacts whose first (lost[0]) or second signal is `nothing` */
    wh_real nothing;  /* NaN or infinity */
    /* the work of the loads counts as potential energy instead of external work */
    bool weighs;
    bool eventful; /* every step takes the code path of steps with events */
    bool places;   /* a crossing assigns the first coordinate instead of its rate */
    wh_real place; /* the value that is assigned */
    wh_real start[4];
    wh_scene scene;
} hand;

extern hand hand_now;             /* the mechanism of the calls below */
extern wh_ledger_form hand_books; /* the ledger of hand_now */
extern wh_state hand_state;
extern unsigned hand_looks; /* number of evaluations of the signals */
extern wh_real hand_pushed; /* the scene's input: the condition of a hold is true above zero */

/* Sets up one body (of mass m00), or two with the given mass matrix, without contact, load or spring. */
void hand_build(unsigned n, wh_real m00, wh_real m01, wh_real m11);
/* Adds a contact with the numbers of hand.law. Returns its number. Contacts with a force come first. */
unsigned hand_add(wh_contact_kind kind, int pin, wh_real row0, wh_real row1, wh_real offset,
                  wh_real first, wh_real second);
/* Draws a row of whole numbers for n coordinates. Returns the only coordinate with a nonzero entry, or -1. */
int hand_draw_row(uint64_t *seed, unsigned n, wh_real *row);
/* Starts the mechanism, with a step of 1 ms. */
void hand_start(bool with_books);
/* Does `count` steps. All must succeed. */
void hand_steps(unsigned count);
/* True if |value - wanted| is at most `bound` (in float `bound_f`). In float a sum gets an error of up to 3e-8 of its
 * value in each step. */
bool hand_near(wh_real value, wh_real wanted, double bound, double bound_f);

/* Gravity, m/s^2. */
#define HAND_G WH_R(9.81)

/* A ball of 1 kg, 1 m above a stop. */
void hand_build_ball(wh_real restitution);

#endif
