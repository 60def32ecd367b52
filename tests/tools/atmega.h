/* atmega.h: shared parts of the tests of an ATmega2560's firmware (atmega.c). */
#ifndef TESTS_TOOLS_ATMEGA_H
#define TESTS_TOOLS_ATMEGA_H

#include "tests/tools/board_tests.h"
#include "tests/tools/mega.h"

/* Sends a line. Returns true if the answer begins with `begin`. */
bool asks(const char *order, const char *begin);
extern char answer[400]; /* the firmware's last answer to a line */

/* Switches the power on and starts a run at this speed. Returns true `ms` after the order `start`. */
bool runs(unsigned rpm, unsigned ms);

/* atmega_states.c: faults, resets and settings. */
bool all_faults(unsigned times);
bool all_resets(unsigned times);
bool keeps_settings(unsigned times);

bool sees_supply(unsigned times);

/* atmega_slots.c: edges. */
bool sees_edges(unsigned times);
bool survives_storm(unsigned times);

#endif
