/* answer.c: formatting of the console's answers. */
#include "answer.h"

#include <stddef.h>

#include "core/rig/state_machine.h"

/* Adds `words` with each space replaced by `blank`. If `blank` is not a space, stops at a '|'. */
static void add_words(wh_text *text, const char *words, char blank) {
    for (char next = wh_word_at(words); next != '\0'; next = wh_word_at(++words)) {
        if (next == '|' && blank != ' ') {
            break;
        }
        wh_text_add_char(text, next == ' ' ? blank : next);
    }
}

/* Adds at most nine digits if |number| < 1e9, because wh_line_number() reads no more. */
static void add_exact(wh_text *text, wh_real number) {
    unsigned decimals = 8;
    wh_real size = WH_ABS(number);
    while (size >= WH_R(0.1) && decimals > 0) {
        size *= WH_R(0.1);
        decimals--;
    }
    wh_text_add_fixed(text, number, decimals);
    if (decimals == 0 || text->truncated) {
        return;
    }
    while (text->bytes[text->length - 1U] == '0') {
        text->length--;
    }
    text->length -= text->bytes[text->length - 1U] == '.' ? 1U : 0U;
    text->bytes[text->length] = '\0';
}

static void add_value(wh_text *text, char as, const wh_value *value) {
    if (as <= '9') {
        wh_text_add_fixed(text, value->number, (unsigned)(as - '0'));
        return;
    }
    switch (as) {
    case 'w': add_words(text, value->word, '_'); break;
    case 's': add_words(text, value->word, ' '); break;
    case 'g': wh_text_add(text, value->count != 0 ? "good" : "bad"); break;
    case 'c': wh_text_add_unsigned(text, value->count); break;
    case 'x': wh_text_add_hex(text, value->count, 8); break;
    case 'e': add_exact(text, value->number); break;
    }
}

void wh_answer(wh_text *text, const char *form, const wh_value *value) {
    for (char next = wh_word_at(form); next != '\0'; next = wh_word_at(++form)) {
        if (next == '@') {
            add_value(text, wh_word_at(++form), value++);
        } else {
            wh_text_add_char(text, next);
        }
    }
}

unsigned wh_list_find(const char *list, const char *word) {
    const char part = wh_word_at(list);
    unsigned number = 0;
    for (char next = part; next == part; number++) {
        const char *at = word; /* NULL after the first difference */
        for (next = wh_word_at(++list); next != '\0' && next != part; next = wh_word_at(++list)) {
            at = at != NULL && wh_word_at(at) == next ? at + 1 : NULL;
        }
        if (at != NULL && wh_word_at(at) == '\0') {
            break;
        }
    }
    return number;
}

const char *wh_list_item(const char *list, unsigned number) {
    const char part = wh_word_at(list++);
    while (number > 0) {
        number -= wh_word_at(list++) == part ? 1U : 0U;
    }
    return list;
}

/* === reasons for refusing a console line ===================================================== */

/* the index of each reason in the list of words */
#define WH_STATION_ROW(name, number, words) ROW_##name,
enum { WH_STATION_ERROR_ROWS(WH_STATION_ROW) ROWS };
#undef WH_STATION_ROW
#define FIRST WH_STATION_NO_COMMAND
#define WH_STATION_ROW(name, number, words) \
    _Static_assert((int)(name) == (int)FIRST + (int)ROW_##name, "no number is left out");
WH_STATION_ERROR_ROWS(WH_STATION_ROW)
#undef WH_STATION_ROW

void wh_answer_refused(wh_text *answer, unsigned why) {
#define WH_STATION_ROW(name, number, words) words "\0"
    static const char words[] WH_WORD_LIST = WH_STATION_ERROR_ROWS(WH_STATION_ROW);
#undef WH_STATION_ROW
    const wh_value value[] = {{.count = why},
                              {.word = why < FIRST ? wh_refusal_text((wh_refusal)why)
                                                   : wh_words_item(words, why - FIRST)}};
    wh_text_start(answer, answer->bytes, answer->size);
    wh_answer(answer, "ERR @c @s", value);
}
