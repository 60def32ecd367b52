/* f405.h: what the tests of f405.c share: the emulated board, and what was seen of it. */
#ifndef TESTS_TOOLS_F405_H
#define TESTS_TOOLS_F405_H

#include "tests/tools/board_tests.h"
#include "tests/tools/emulated.h"

extern emulated board;

/* The log may be so much later than the answer on a busy machine. */
#define LOG_BEHIND_MS 600000U

/* Where the image has this name; 0: nowhere. */
uint32_t symbol(const char *name);

/* The decimal numbers that a line has, `most` at most; returns how many. */
unsigned numbers_of(const char *line, unsigned *numbers, unsigned most);

/* The console's next line that begins so. */
bool hear(const char *begin, char *line, unsigned room, unsigned ms);

/* A line to the console; its answer goes to line[room] and begins so. */
bool answers(const char *order, const char *begin, char *line, unsigned room);

/* The same where the line may be lost on its way, because nobody listens yet: it is said again every few seconds. */
bool answers_at_last(const char *order, const char *begin, char *line, unsigned room);

/* Stores that were logged, by their number. */
const emulated_store_seen *seen_at(uint64_t number);
bool is(const emulated_store_seen *seen, const char *device, uint32_t offset);
bool drives(const emulated_store_seen *seen); /* the motor */
bool kicks(const emulated_store_seen *seen);  /* the watchdog */

#define TIM2_CNT 0x40000024U

/* A mark in the log, channel 2's compare of TIM1, which no driver uses; and its number, later. */
void set_mark(uint32_t value);
bool marked(uint32_t value, uint64_t *number);

/* Until the motor's timer runs, in the log behind this number: the console listens by then. What is typed before is lost. */
bool starts_after(uint64_t number);

/* f405_states.c: the rig in every state, so many times. */
bool all_faults(unsigned times);
bool all_resets(unsigned times);

#endif
