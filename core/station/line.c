/* line.c: splits a terminal's bytes into lines, and a line into words. */
#include "line.h"

enum { BACKSPACE = 0x08, TAB = 0x09, FEED = 0x0A, RETURN = 0x0D, ESCAPE = 0x1B, DELETE = 0x7F };
enum { NO_KEY, AFTER_ESCAPE, IN_SEQUENCE };

static void forget(wh_line *line) {
    line->length = 0;
    line->text[0] = '\0';
    line->bad = false;
    line->ended = false;
}

/* Is the byte part of an arrow key's escape sequence? */
static bool belongs_to_key(wh_line *line, unsigned char byte) {
    const unsigned key = line->key;
    line->key = NO_KEY;
    if (key == AFTER_ESCAPE && (byte == '[' || byte == 'O')) {
        line->key = IN_SEQUENCE;
        return true;
    }
    if (key == IN_SEQUENCE && byte >= 0x20U && byte < DELETE) {
        line->key = byte < 0x40U ? IN_SEQUENCE : NO_KEY;
        return true;
    }
    return false;
}

wh_line_event wh_line_take(wh_line *line, char character) {
    const unsigned char byte = (unsigned char)character;
    const bool second = line->returned && byte == FEED;
    line->returned = byte == RETURN;
    if (second) {
        return WH_LINE_NOTHING;
    }
    if (line->ended) {
        forget(line);
    }
    if (belongs_to_key(line, byte)) {
        return WH_LINE_NOTHING;
    }
    switch (byte) {
    case RETURN:
    case FEED: line->ended = true; return line->bad ? WH_LINE_BAD : WH_LINE_WHOLE;
    case ESCAPE:
        forget(line);
        line->key = AFTER_ESCAPE;
        return WH_LINE_ESCAPE;
    case BACKSPACE:
    case DELETE: line->length -= line->length > 0 ? 1U : 0U; break;
    default:
        if (line->length >= WH_LINE_MOST || (byte != TAB && (byte < 0x20U || byte > DELETE))) {
            line->bad = true;
        } else {
            line->text[line->length++] = character;
        }
    }
    line->text[line->length] = '\0';
    return WH_LINE_NOTHING;
}

void wh_line_split(wh_words *words, char *text) {
    static const char none[] = ""; /* must be in RAM; a literal "" may be in flash */
    bool within = false;
    for (unsigned i = 0; i < WH_LINE_WORDS; i++) {
        words->word[i] = none;
    }
    words->count = 0;
    for (; *text != '\0'; text++) {
        const bool blank = *text == ' ' || *text == TAB;
        if (blank) {
            *text = '\0';
        } else if (!within) {
            if (words->count < WH_LINE_WORDS) {
                words->word[words->count] = text;
            }
            words->count++;
        }
        within = !blank;
    }
}

bool wh_line_number(const char *word, wh_real *number) {
    const bool negative = word[0] == '-';
    const char *at = word + (negative || word[0] == '+' ? 1 : 0);
    uint32_t digits = 0;
    uint32_t scale = 0; /* 10^decimals; 0: no decimal point so far */
    unsigned count = 0;
    for (; *at != '\0'; at++) {
        if (*at == '.' && scale == 0) {
            scale = 1;
            continue;
        }
        if (*at < '0' || *at > '9' || ++count > 9U) {
            return false;
        }
        digits = 10U * digits + (uint32_t)(*at - '0');
        scale *= 10U;
    }
    const wh_real value = (wh_real)digits / (wh_real)(scale > 0 ? scale : 1U);
    *number = negative ? -value : value;
    return count > 0;
}
