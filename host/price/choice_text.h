/* choice_text.h: a choice for people. */
#ifndef PRICE_CHOICE_TEXT_H
#define PRICE_CHOICE_TEXT_H

#include <stdio.h>

#include "choice.h"

/* Both answers; or that no row fits, and the nearest one. */
void choice_print(FILE *out, const trials *t, const table *made, const choice_wish *w,
                  const choice *c, const table_words *words);

#endif
