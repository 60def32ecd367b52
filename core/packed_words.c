/* packed_words.c: packed words to text. */
#include "packed_words.h"

#define FIRST 128U /* what is above is a pair */

char wh_words_next(wh_packed *from) {
#define PAIR(number, left, right) {left, right},
    static const uint8_t pair[][2] = {WH_WORD_PAIR_ROWS(PAIR)};
#undef PAIR
    uint8_t byte = from->waiting > 0 ? from->waits[--from->waiting] : (uint8_t)*from->at++;
    while (byte >= FIRST) {
        from->waits[from->waiting++] = pair[byte - FIRST][1];
        byte = pair[byte - FIRST][0];
    }
    return (char)byte;
}

const char *wh_words_item(const char *list, unsigned number) {
    const char *item = list;
    for (; number > 0 && wh_word_at(list) != '\0'; number--) {
        item = list;
        while (wh_word_at(list++) != '\0') {
        }
    }
    return wh_word_at(list) != '\0' ? list : item;
}

void wh_words_unpack(wh_text *text, const char *packed) {
    wh_packed from;
    wh_words_begin(&from, packed);
    for (char next = wh_words_next(&from); next != '\0'; next = wh_words_next(&from)) {
        wh_text_add_char(text, next);
    }
}
