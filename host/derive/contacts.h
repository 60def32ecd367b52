/* contacts.h: the contacts of an instance, in symbols, in the order core/contact.h wants. */
#ifndef DERIVE_CONTACTS_H
#define DERIVE_CONTACTS_H

#include "host/algebra/poly.h"

/* One stop, hold, friction or crossing. */
typedef struct contact_law {
    const contact_statement *from;
    const poly
        *value; /* stop: the gap; hold: its condition; friction: the rate; crossing: the value
                         * that changes its sign */
    const poly *speed; /* J q': rate of the gap or of what is held; zero for others */
    const poly
        *first; /* stop: restitution; friction: mu_static * max(N, 0); curved hold: what it holds */
    const poly *second; /* friction: mu_kinetic * max(N, 0) */
    const poly *bias;   /* J' q' */
    const poly **row;   /* [coordinates] J; NULL for a crossing */
    bool straight;      /* J is constant, and no input is in what is held */
    bool driven;        /* it follows an input with a rate */
} contact_law;

typedef struct contact_set {
    const poly **value; /* one for each of from->sets */
} contact_set;

typedef struct contact_laws {
    int count;
    int forced;               /* all but crossings, which come last */
    contact_law *law;         /* [count] */
    contact_set *sets;        /* [count] */
    int set_count;            /* of all crossings */
    contact_statement *loose; /* [loosening] crossings that no file has: see contact_loosens() */
    int loosening;
} contact_laws;

/* Is this the crossing at which a friction's normal force, which the motion changes, comes to zero or returns from there?
 * There the force has a kink, which a step of fourth order must not lie across. It sets nothing. */
bool contact_loosens(const contact_statement *h);

/* Those that the instance calls for; NULL when there are none. */
contact_laws *contact_laws_make(algebra *a, const instance *inst);
void contact_laws_free(contact_laws *laws);

/* Can this contact, or one of all, change the momentum of coordinate i? */
bool contact_law_pushes(const contact_law *law, int i);
bool contact_laws_push(const contact_laws *laws, int i);

#endif
