/* stabilizing.h: which scenes may give back what their energy drifts by (--stabilized; core/stabilize.h). */
#ifndef DERIVE_STABILIZING_H
#define DERIVE_STABILIZING_H

#include "contact_lists.h"
#include "layout.h"
#include "ledger_lists.h"

/* Before there are books: an energy, and steps of stages without events: what is done to rates behind a step would be done
 * behind its contacts' back. `contacts` may be NULL, and so is `integral` where the energy is T + V. False where it cannot,
 * reported with its place. */
bool stabilizing_possible(const layout *map, const contact_lists *contacts, const poly *integral,
                          const image_settings *settings, diags *errors);
/* Of the books: nothing gives energy or takes it. */
bool stabilizing_conserves(const ledger_lists *books, const equations *e, diags *errors);

#endif
