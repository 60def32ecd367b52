/* answer.c: how the console's answers are put together. */
#include "answer.h"

#include "core/flash.h"
#include "core/packed_words.h"

bool wh_answer_is(const char *word, const char *name) {
    while (wh_word_at(word) != '\0' && wh_word_at(word) == wh_word_at(name)) {
        word++;
        name++;
    }
    return wh_word_at(word) == wh_word_at(name);
}

void wh_answer_refused(wh_text *text, unsigned number, const char *why) {
    wh_text_add(text, "ERR ");
    wh_text_add_unsigned(text, number);
    wh_text_add_char(text, ' ');
    wh_text_add_words(text, why);
}

void wh_answer_word(wh_text *text, const char *name, const char *word) {
    wh_text_add_char(text, ' ');
    wh_text_add(text, name);
    wh_text_add_char(text, '=');
    for (char next = wh_word_at(word); next != '\0'; next = wh_word_at(++word)) {
        wh_text_add_char(text, next == ' ' ? '_' : next);
    }
}

void wh_answer_number(wh_text *text, const char *name, wh_real number, unsigned decimals) {
    wh_answer_word(text, name, "");
    wh_text_add_fixed(text, number, decimals);
}

/* Seven digits that count: a float has no more, and nine can be typed (line.h). */
void wh_answer_exact(wh_text *text, const char *name, wh_real number) {
    unsigned decimals = 8;
    wh_real size = WH_ABS(number);
    while (size >= WH_R(0.1) && decimals > 0) {
        size *= WH_R(0.1);
        decimals--;
    }
    wh_answer_number(text, name, number, decimals);
    if (decimals == 0) {
        return;
    }
    unsigned length = text->length;
    while (!text->truncated && length > 0 && text->bytes[length - 1U] == '0') {
        length--;
    }
    if (length > 0 && text->bytes[length - 1U] == '.') {
        length--;
    }
    wh_answer_back(text, length);
}

void wh_answer_count(wh_text *text, const char *name, uint32_t count) {
    wh_answer_word(text, name, "");
    wh_text_add_unsigned(text, count);
}

void wh_answer_words(wh_text *text, const char *words) {
    wh_text_add(text, ": ");
    wh_text_add_words(text, words);
}

void wh_answer_back(wh_text *text, unsigned length) {
    if (length < text->length) {
        text->length = length;
        text->bytes[length] = '\0';
        text->truncated = false;
    }
}
