/* mechanism.h: generated mechanisms, as text, for what must hold for any mechanism. */
#ifndef TESTS_HOST_MECHANISM_H
#define TESTS_HOST_MECHANISM_H

#include <stddef.h>
#include <stdint.h>

enum { MECHANISM_SIZE = 16384 };

/* A mechanism `mNUMBER` with a scene `sNUMBER`, of one to four coordinates: pendulums and carriages that carry each
 * other, springs, gravity and energies of any function, losses, forces, effects, contacts, units; every eighth
 * is a system of equations. The same seed gives the same text on every host: whole numbers only are computed with,
 * and calls are in sequence. Hardly any is refused by the language or the deriver, but some are. */
void mechanism_write(unsigned number, uint64_t seed, char text[static MECHANISM_SIZE]);

#endif
