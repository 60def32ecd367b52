/* atmega.h: what the tests of an ATmega2560's firmware share (atmega.c). */
#ifndef TESTS_TOOLS_ATMEGA_H
#define TESTS_TOOLS_ATMEGA_H

#include "tests/tools/board_tests.h"
#include "tests/tools/mega.h"

/* A line, and its answer, which begins so. */
bool asks(const char *order, const char *begin);
extern char answer[400]; /* the last */

/* From the power on to a run at this speed, which has gone on for so many ms behind `start`. */
bool runs(unsigned rpm, unsigned ms);

/* atmega_states.c: faults, resets and settings, so many. */
bool all_faults(unsigned times);
bool all_resets(unsigned times);
bool keeps_settings(unsigned times);

/* Over-voltages, so many. */
bool sees_supply(unsigned times);

/* atmega_slots.c: edges, so many. */
bool sees_edges(unsigned times);
bool survives_storm(unsigned times);

#endif
