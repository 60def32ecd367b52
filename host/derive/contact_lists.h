/* contact_lists.h: a scene's contacts as operation lists and a table for core/contact.h. */
#ifndef DERIVE_CONTACT_LISTS_H
#define DERIVE_CONTACT_LISTS_H

#include "host/derive/solve.h"
#include "layout.h"

typedef struct contact_row {
    const contact_statement *from;
    int kind; /* wh_contact_kind */
    int pin;
    int direction;
    int first_set;
    int sets;
} contact_row;

typedef struct contact_lists {
    int count;
    int forced;
    int held; /* holds without a pin */
    int set_count;
    contact_row *row; /* [count] */
    int *target;      /* [set_count] component of the state, angles first */
    op_list *signals;
    op_list *forces;
    op_list *sets; /* NULL without sets */
} contact_lists;

/* Every poly of the step of a scene with these laws, folded and settled. Fills p[] (if not NULL) and returns their
 * number. */
int contact_lists_polys(const equations *e, const conservation *c, const poly **p);

/* Enter the lists. `s` is the folded system. NULL after an error, reported. */
contact_lists *contact_lists_make(layout *map, const linear_system *s, diags *errors);
/* `hash` with the lists and the table mixed in. */
uint64_t contact_lists_hash(const contact_lists *c, uint64_t hash);
void contact_lists_free(contact_lists *c);

#endif
