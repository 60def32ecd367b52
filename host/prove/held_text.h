/* held_text.h: what is proved of a run, in words. */
#ifndef PROVE_HELD_TEXT_H
#define PROVE_HELD_TEXT_H

#include <stdio.h>

#include "held.h"

void held_print(FILE *out, const held *h, const held_wish *w);

#endif
