/* line.h: bytes from a terminal to lines, and a line to its words. */
#ifndef WH_STATION_LINE_H
#define WH_STATION_LINE_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_LINE_MOST 79U /* characters of a line */
#define WH_LINE_WORDS 4U /* of which are told apart; more are counted */

typedef enum wh_line_event {
    WH_LINE_NOTHING,
    WH_LINE_WHOLE, /* line->text has it, until the next one begins */
    WH_LINE_BAD,   /* it was too long, or had what is no character: forgotten */
    WH_LINE_ESCAPE /* the Escape key; what was typed is forgotten */
} wh_line_event;

/* All zeros: nothing typed. */
typedef struct wh_line {
    bool ended;    /* the next byte begins anew */
    bool returned; /* after a carriage return, whose line feed is no line */
    bool bad;
    uint8_t key; /* within what a key beyond the letters sends, which begins with Escape */
    unsigned length;
    char text[WH_LINE_MOST + 1U];
} wh_line;

typedef struct wh_words {
    const char *word[WH_LINE_WORDS]; /* "" where there is none */
    unsigned count;                  /* also of those beyond */
} wh_words;

#define wh_line_take WH_NAME(wh_line_take)
#define wh_line_split WH_NAME(wh_line_split)
#define wh_line_number WH_NAME(wh_line_number)

/* Lines end with carriage return, line feed or both; backspace and delete take the last character back. */
wh_line_event wh_line_take(wh_line *line, char byte);

/* Words are parted by blanks and tabulators. Writes ends of words into the text. */
void wh_line_split(wh_words *words, char *text);

/* "330", "-3.5", ".5": a sign, digits, a point, digits; nine of them at most. False when it is anything else. */
bool wh_line_number(const char *word, wh_real *number);

#ifdef __cplusplus
}
#endif

#endif
