/* contacts.h: the symbolic contacts of an instance, in the order of core/contact.h. */
#ifndef DERIVE_CONTACTS_H
#define DERIVE_CONTACTS_H

#include "host/algebra/poly.h"

/* One stop, hold, friction or crossing. */
typedef struct contact_law {
    const contact_statement *from;
    const poly *value;  /* stop: gap; hold: condition; friction: rate; crossing: left - right */
    const poly *speed;  /* J q': rate of the gap or of the hold's expression; zero for others */
    const poly *first;  /* stop: restitution; friction: mu_static * max(N, 0); curved hold: value */
    const poly *second; /* friction: mu_kinetic * max(N, 0) */
    const poly *bias;   /* J' q' */
    const poly **row;   /* [coordinates] J; NULL for a crossing */
    bool straight;      /* J is constant, and the hold's expression contains no input */
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
    contact_statement *loose; /* [loosening] crossings that are not in the file: see
                               * contact_loosens() */
    int loosening;
} contact_laws;

/* True for the crossing at which a friction's varying normal force reaches or leaves zero. The force has a kink there,
 * and a step of fourth order must not span it. The crossing sets nothing. */
bool contact_loosens(const contact_statement *h);

/* The active contacts of the instance; NULL without any. */
contact_laws *contact_laws_make(algebra *a, const instance *inst);
void contact_laws_free(contact_laws *laws);

/* Can this contact, or any of them, change the momentum of coordinate i? */
bool contact_law_pushes(const contact_law *law, int i);
bool contact_laws_push(const contact_laws *laws, int i);

#endif
