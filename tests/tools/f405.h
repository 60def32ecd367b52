/* f405.h: shared parts of the tests of f405.c: the emulated board and its log. */
#ifndef TESTS_TOOLS_F405_H
#define TESTS_TOOLS_F405_H

#include "tests/tools/board_tests.h"
#include "tests/tools/emulated.h"

extern emulated board;

/* The log may lag the answer by this much on a busy machine. */
#define LOG_BEHIND_MS 600000U

/* The symbol's address in the image; 0: none. */
uint32_t symbol(const char *name);

/* The console's next line that begins with this. */
bool hear(const char *begin, char *line, unsigned room, unsigned ms);

/* Sends a line. The answer goes to line[room] and must begin with `begin`. */
bool answers(const char *order, const char *begin, char *line, unsigned room);

/* As above, for a line that may be lost because the console does not listen yet: repeats it every few seconds. */
bool answers_at_last(const char *order, const char *begin, char *line, unsigned room);

const emulated_store_seen *seen_at(uint64_t number);
bool is(const emulated_store_seen *seen, const char *device, uint32_t offset);
bool drives(const emulated_store_seen *seen); /* does this store drive the motor? */
bool kicks(const emulated_store_seen *seen);  /* does this store kick the watchdog? */

#define TIM2_CNT 0x40000024U

/* set_mark() stores a mark, which the log shows; marked() waits for it and sets *number to its place in the log. */
void set_mark(uint32_t value);
bool marked(uint32_t value, uint64_t *number);

/* Waits until the log after this number shows the motor's timer running: the console listens from then on. */
bool starts_after(uint64_t number);

/* f405_states.c: tests in every state of the rig. */
bool all_faults(unsigned times);
bool all_resets(unsigned times);

#endif
