/* stabilizing.h: which scenes may give back what their energy drifts by (--stabilized; core/stabilize.h). */
#ifndef DERIVE_STABILIZING_H
#define DERIVE_STABILIZING_H

#include "program.h"

/* Before there are books: an energy, and steps of stages without events: what is done to rates behind a step would be done
 * behind its contacts' back. False where it cannot, reported with its place. */
bool stabilizing_possible(const program *p, const equations *e, const image_settings *settings,
                          diags *errors);
/* Of p's books: nothing gives energy or takes it. */
bool stabilizing_conserves(const program *p, const equations *e, diags *errors);

#endif
