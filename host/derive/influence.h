/* influence.h: what acts on a coordinate, and what a coordinate acts on. */
#ifndef DERIVE_INFLUENCE_H
#define DERIVE_INFLUENCE_H

#include "host/derive/equations.h"

/* What changes the momentum of coordinate i beside the energies, in words with lines of the
 * file: "the Q in line 9, the stop in line 12"; *count is how many there are. */
#define INFLUENCE_TEXT_SIZE 200
const char *influence_on(const equations *e, int i, char text[INFLUENCE_TEXT_SIZE], int *count);

/* Does a force, a loss or a contact depend on where the coordinate is? (The energies are not
 * looked at.) */
bool influence_of(const equations *e, const symbol *coordinate);

#endif
