/* jumps.h: runs that may step over a pole (host/check/pole.h) and their messages, for the suites `jumped` and
 * `unjumped`. */
#ifndef TESTS_JUMPS_H
#define TESTS_JUMPS_H

#include <stdbool.h>

#include "command.h"
#include "motion.h"

enum { JUMPS_TEXT = 1500, JUMPS_WORDS = 6 };

extern said jumps_said;

/* The number of cases: `few`; `all` if WHIRL_FULL is set; `fewest`, with some of every class, if WHIRL_FEW is set. */
unsigned jumps_cases(unsigned few, unsigned all, unsigned fewest);

/* Runs `whirl run` in that number format, with more options, which may choose another. */
void jumps_run(const char *text, const char *number, char *const more[static JUMPS_WORDS]);
bool jumps_told(void);
/* Writes to `text` the options that a warning names as tried; false if it names none. */
bool jumps_named(char text[static SAID_SIZE], char *words[static JUMPS_WORDS]);

/* Runs to the end. Returns true if some step jumped over a pole. */
bool jumps_some(motion *m);

#endif
