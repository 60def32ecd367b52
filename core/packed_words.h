/* packed_words.h: what is said to people, which an image with little flash holds packed.
 *
 *     wh_text_add_words(&text, WH_WORDS("the rig is not armed"));
 *
 * Where WH_WORDS_PACKED is 1, mk/size/pack.awk packs what stands in WH_WORDS() on its way to the compiler: pairs that come up often
 * become one byte above 127, and pairs of those again (word_pairs.h). A file that did not go that way does not compile. Only
 * wh_text_add_words() and wh_words_read() know what is packed; it is no name to be compared. */
#ifndef WH_PACKED_WORDS_H
#define WH_PACKED_WORDS_H

#include "flash.h"
#include "text.h"
#include "word_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef WH_WORDS_PACKED
#define WH_WORDS_PACKED 0
#endif

#define wh_words_next WH_NAME(wh_words_next)
#define wh_words_unpack WH_NAME(wh_words_unpack)
#define wh_words_item WH_NAME(wh_words_item)

/* Packed words that are read. */
typedef struct wh_packed {
    const char *at;
    unsigned waiting;
    uint8_t waits[WH_WORD_PAIRS_DEEP]; /* right halves of pairs */
} wh_packed;

WH_INLINE void wh_words_begin(wh_packed *from, const char *packed) {
    from->at = packed;
    from->waiting = 0;
}

/* The next character; beyond the end nothing may be read. */
char wh_words_next(wh_packed *from);

/* Where a list of words is kept: with them. */
#if defined(WH_WORDS_FROM)
#define WH_WORD_LIST __attribute__((__section__(".rodata.str.lists")))
#else
#define WH_WORD_LIST
#endif

/* An item of static const char list[] WH_WORD_LIST = WH_WORDS("one") "\0" WH_WORDS("two") "\0"; beyond them all, the last. */
const char *wh_words_item(const char *list, unsigned number);

/* Add what is packed. */
void wh_words_unpack(wh_text *text, const char *packed);

/* What stood in WH_WORDS(): add it; or the next character of it. */
#if WH_WORDS_PACKED
#define WH_WORDS(words) WH_PACK_THESE_WORDS(words)
WH_INLINE void wh_text_add_words(wh_text *text, const char *words) { wh_words_unpack(text, words); }
WH_INLINE char wh_words_read(wh_packed *from) { return wh_words_next(from); }
#else
#define WH_WORDS(words) words
WH_INLINE void wh_text_add_words(wh_text *text, const char *words) { wh_text_add(text, words); }
WH_INLINE char wh_words_read(wh_packed *from) { return wh_word_at(from->at++); }
#endif

#ifdef __cplusplus
}
#endif

#endif
