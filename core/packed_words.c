/* packed_words.c: packed words to text. */
#include "packed_words.h"

#include "flash.h"
#include "word_pairs.h"

#define FIRST 128U /* what is above is a pair */

const char *wh_words_nth(const char *words, unsigned number) {
    for (; number > 0; number--) {
        while (wh_word_at(words++) != '\0') {
        }
    }
    return words;
}

void wh_words_unpack(wh_text *text, const char *packed) {
#define PAIR(number, left, right) {left, right},
    static const uint8_t pair[][2] = {WH_WORD_PAIR_ROWS(PAIR)};
#undef PAIR
    uint8_t waits[WH_WORD_PAIRS_DEEP]; /* right halves */
    unsigned waiting = 0;
    for (; *packed != '\0'; packed++) {
        uint8_t byte = (uint8_t)*packed;
        while (byte >= FIRST || waiting > 0) {
            if (byte >= FIRST) {
                waits[waiting++] = pair[byte - FIRST][1];
                byte = pair[byte - FIRST][0];
            } else {
                wh_text_add_char(text, (char)byte);
                byte = waits[--waiting];
            }
        }
        wh_text_add_char(text, (char)byte);
    }
}
