/* influence.h: the influences on a coordinate, and of a coordinate. */
#ifndef DERIVE_INFLUENCE_H
#define DERIVE_INFLUENCE_H

#include "host/derive/equations.h"

/* The statements besides the energies that change the momentum of coordinate i, in words: "the Q in line 9, the stop in
 * line 12". *count is their number. */
#define INFLUENCE_TEXT_SIZE 200
const char *influence_on(const equations *e, int i, char text[INFLUENCE_TEXT_SIZE], int *count);

/* Does a force, a loss or a contact depend on the coordinate's position? (Energies are not checked.) */
bool influence_of(const equations *e, const symbol *coordinate);

#endif
