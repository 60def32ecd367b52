/* advice_numbers.h: warnings of digits that a scene's own numbers have lost, before anything moves. */
#ifndef RUN_ADVICE_NUMBERS_H
#define RUN_ADVICE_NUMBERS_H

#include <stdio.h>

#include "judged.h"

void advice_numbers_say(FILE *out, judged *j);

#endif
