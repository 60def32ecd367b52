/* jumps.h: what suites `jumped` and `unjumped` share: runs that may step over a pole (host/check/pole_crossing.h), and what is said of it. */
#ifndef TESTS_JUMPS_H
#define TESTS_JUMPS_H

#include <stdbool.h>

#include "command.h"
#include "motion.h"

enum { JUMPS_TEXT = 1500, JUMPS_WORDS = 6 };

/* What jumps_run() had said. */
extern said jumps_said;

/* `few`; all of them where WHIRL_FULL says so, and some of every class where WHIRL_FEW does. */
unsigned jumps_cases(unsigned few, unsigned all, unsigned fewest);

/* `whirl run` in that number, with more options, which may be of another number. */
void jumps_run(const char *text, const char *number, char *const more[static JUMPS_WORDS]);
bool jumps_told(void);
/* The options that a warning names and has tried, in `text`; false: none. */
bool jumps_named(char text[static SAID_SIZE], char *words[static JUMPS_WORDS]);

/* Stepped to its end: did some step jump over one? */
bool jumps_some(motion *m);

#endif
