#include "words.h"

#include <string.h>

static const statement_word rows[] = {
#define WORD_ROW(id, text, stands, rules, reader, kind, form) \
    [WORD_##id] = {text, form, stands, rules, (int)(kind)},
    BODY_WORD_ROWS(WORD_ROW) SCENE_WORD_ROWS(WORD_ROW)
#undef WORD_ROW
#define WORD_ROW(id, text, rules) [WORD_##id] = {text, "", 0, rules, 0},
        INNER_WORD_ROWS(WORD_ROW)
#undef WORD_ROW
};
_Static_assert(sizeof rows / sizeof rows[0] == WORDS, "a row for each word");

const statement_word *word_row(word_id id) { return &rows[id]; }

bool word_is(word_id id, const char *text, size_t length) {
    const char *word = rows[id].text; /* most differ in their first letter */
    return length > 0 && word[0] == text[0] && strlen(word) == length &&
           memcmp(word, text, length) == 0;
}

int word_find(const char *text, size_t length) {
    for (int i = 0; i < STATEMENT_WORDS; i++) {
        if (word_is((word_id)i, text, length)) {
            return i;
        }
    }
    return WORDS;
}

bool word_is_reserved(const char *text, size_t length) {
    for (int i = 0; i < WORDS && length > 0; i++) {
        if (rows[i].text[0] == text[0] && (rows[i].rules & RESERVED) != 0 &&
            word_is((word_id)i, text, length)) {
            return true;
        }
    }
    return false;
}

const char *contact_word(contact_kind kind) {
#define WORD(id, called, undefined) [CONTACT_##id] = WORD_##id,
    static const word_id words[] = {CONTACT_KIND_ROWS(WORD)};
#undef WORD
    return word_row(words[kind])->text;
}
