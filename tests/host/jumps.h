/* jumps.h: runs that may step over a pole (host/check/pole.h), and their messages, for the suites `jumped` and
 * `unjumped`. */
#ifndef TESTS_JUMPS_H
#define TESTS_JUMPS_H

#include <stdbool.h>

#include "command.h"
#include "motion.h"

enum { JUMPS_TEXT = 1500, JUMPS_WORDS = 6 };

extern said jumps_said;

/* Number of cases: usually `few`; `all` if WHIRL_FULL is set; `fewest` if WHIRL_FEW is set. `fewest` must cover each
 * class of cases. */
unsigned jumps_cases(unsigned few, unsigned all, unsigned fewest);

/* Runs `whirl run` on a text with the number type `number` and further options. If the options choose a number type,
 * that one is used. */
void jumps_run(const char *text, const char *number, char *const more[static JUMPS_WORDS]);
bool jumps_told(void);
/* Finds the options that a warning names as tried: text[] receives the options, words[] points to each of them.
 * Returns false if no warning names options. */
bool jumps_named(char text[static SAID_SIZE], char *words[static JUMPS_WORDS]);

/* Runs the scene to its end. Returns true if any step jumped over a pole. */
bool jumps_some(motion *m);

#endif
