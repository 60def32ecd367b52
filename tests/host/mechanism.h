/* mechanism.h: random mechanisms as text, for properties of every mechanism. */
#ifndef TESTS_HOST_MECHANISM_H
#define TESTS_HOST_MECHANISM_H

#include "test.h"

enum { MECHANISM_SIZE = 16384 };

/* A mechanism `mNUMBER` with a scene `sNUMBER`, of one to four coordinates. Pendulums and carriages carry each other,
 * with springs, gravity, any energies, losses, forces, effects, contacts and units. Every eighth is a system of
 * equations. Integer arithmetic makes the text of a seed the same on every host. The language or the deriver refuses a
 * few of them. */
void mechanism_write(unsigned number, uint64_t seed, char text[static MECHANISM_SIZE]);

#endif
