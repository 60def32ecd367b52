/* answer.h: how the console's answers are put together: "OK name=value name=value: words". */
#ifndef WH_STATION_ANSWER_H
#define WH_STATION_ANSWER_H

#include "core/text.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_answer_is WH_NAME(wh_answer_is)
#define wh_answer_refused WH_NAME(wh_answer_refused)
#define wh_answer_word WH_NAME(wh_answer_word)
#define wh_answer_number WH_NAME(wh_answer_number)
#define wh_answer_exact WH_NAME(wh_answer_exact)
#define wh_answer_count WH_NAME(wh_answer_count)
#define wh_answer_words WH_NAME(wh_answer_words)
#define wh_answer_back WH_NAME(wh_answer_back)

/* Are these the same? */
bool wh_answer_is(const char *word, const char *name);

/* "ERR number why", as WH_WORDS() has it (core/packed_words.h). */
void wh_answer_refused(wh_text *text, unsigned number, const char *why);

/* " name=word", a blank in what is a word as _ */
void wh_answer_word(wh_text *text, const char *name, const char *word);

/* " name=number", with so many decimals; or to the seventh digit, as it can be typed, without zeros at the end. */
void wh_answer_number(wh_text *text, const char *name, wh_real number, unsigned decimals);
void wh_answer_exact(wh_text *text, const char *name, wh_real number);
void wh_answer_count(wh_text *text, const char *name, uint32_t count);

/* ": words", to a person, behind all values; ditto. */
void wh_answer_words(wh_text *text, const char *words);

/* Take back what was added since it had this length. */
void wh_answer_back(wh_text *text, unsigned length);

#ifdef __cplusplus
}
#endif

#endif
