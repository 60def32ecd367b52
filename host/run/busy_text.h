/* busy_text.h: words for contacts that are too busy for a run's steps, and what would do. */
#ifndef RUN_BUSY_TEXT_H
#define RUN_BUSY_TEXT_H

#include <stdio.h>

#include "cure.h"
#include "retrial.h"

/* The step that would do for its contacts, done with all that may be said of a run (cure.h). */
typedef struct busy_cure {
    const char *options; /* "--step 50us": that step, or one that does more */
    cure_outcome outcome;
} busy_cure;

/* Which contacts, when and how often, and behind "hint: " what would do; where `r` is to be told. `who`: what begins it,
 * "whirl run: warning". `cure`: NULL where none was tried beside what `r` tells. */
void busy_say(FILE *out, const char *who, const busy *b, const retrial *r, const busy_cure *cure);

#endif
