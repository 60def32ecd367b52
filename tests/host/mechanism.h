/* mechanism.h: random mechanisms as text, for tests of properties that every mechanism has. */
#ifndef TESTS_HOST_MECHANISM_H
#define TESTS_HOST_MECHANISM_H

#include "test.h"

enum { MECHANISM_SIZE = 16384 };

/* Writes a mechanism `mNUMBER` with a scene `sNUMBER` and one to four coordinates: pendulums and carriages that
 * carry each other, with springs, gravity, other energies, losses, forces, effects, contacts and units. Every eighth
 * mechanism is a system of equations instead. Only integer arithmetic is used, so a seed gives the same text on
 * every host. The language or the deriver refuses a few of the texts. */
void mechanism_write(unsigned number, uint64_t seed, char text[static MECHANISM_SIZE]);

#endif
