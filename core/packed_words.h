/* packed_words.h: what is said to people, which an image with little flash holds packed.
 *
 *     wh_text_add_words(&text, WH_WORDS("the rig is not armed"));
 *
 * Where WH_WORDS_PACKED is 1, mk/size/pack.awk packs what stands in WH_WORDS() on its way to the compiler: pairs that come up often
 * become one byte above 127, and pairs of those again (word_pairs.h). A file that did not go that way does not compile. Only
 * wh_text_add_words() writes what is packed; it is no name to be compared. */
#ifndef WH_PACKED_WORDS_H
#define WH_PACKED_WORDS_H

#include "text.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef WH_WORDS_PACKED
#define WH_WORDS_PACKED 0
#endif

#define wh_words_unpack WH_NAME(wh_words_unpack)
#define wh_words_nth WH_NAME(wh_words_nth)

/* Add what is packed. */
void wh_words_unpack(wh_text *text, const char *packed);

/* Of words that stand behind each other, a zero between them, those of this number. */
const char *wh_words_nth(const char *words, unsigned number);

/* Add what stood in WH_WORDS(). */
#if WH_WORDS_PACKED
#define WH_WORDS(words) WH_PACK_THESE_WORDS(words)
WH_INLINE void wh_text_add_words(wh_text *text, const char *words) { wh_words_unpack(text, words); }
#else
#define WH_WORDS(words) words
WH_INLINE void wh_text_add_words(wh_text *text, const char *words) { wh_text_add(text, words); }
#endif

#ifdef __cplusplus
}
#endif

#endif
