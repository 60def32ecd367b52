/* choice_text.h: a choice in words. */
#ifndef PRICE_CHOICE_TEXT_H
#define PRICE_CHOICE_TEXT_H

#include "choice.h"
#include "table_text.h"

/* What was chosen, why, and what does it again. */
void choice_print(FILE *out, const trials *t, const choice_wish *w, const choice *c,
                  const table_words *words);
/* That nothing fits, by which limits, and what would. `lower_rate_Hz` and its row: of choice_lower_rate(). */
void choice_print_none(FILE *out, const trials *t, const choice_wish *w, const choice *c,
                       const table_words *words, double lower_rate_Hz, const choice_row *lower);

#endif
