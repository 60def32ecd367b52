/* busy_text.h: words for contacts that are too busy for a run's steps, and what would do. */
#ifndef RUN_BUSY_TEXT_H
#define RUN_BUSY_TEXT_H

#include <stdio.h>

#include "retrial.h"

/* Which contacts, when and how often, and behind "hint: " what would do; where `r` is to be told. `who`: what begins it,
 * "whirl run: warning". */
void busy_say(FILE *out, const char *who, const busy *b, const retrial *r);

#endif
