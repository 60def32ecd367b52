/* stabilizing.h: the conditions for correcting the energy drift of a scene (--stabilized; core/step/stabilize.h). */
#ifndef DERIVE_STABILIZING_H
#define DERIVE_STABILIZING_H

#include "contact_lists.h"
#include "layout.h"
#include "ledger_lists.h"

/* The check before the ledger exists. The scene needs an energy and a method of stages without events: contacts would
 * not see a correction of the rates after a step. `contacts` may be NULL, and `integral` is NULL if the energy is T +
 * V. False if impossible, reported with its place. */
bool stabilizing_possible(const layout *map, const contact_lists *contacts, const poly *integral,
                          const image_settings *settings, diags *errors);
/* The check of the ledger: nothing may add or remove energy. */
bool stabilizing_conserves(const ledger_lists *books, const equations *e, diags *errors);

#endif
