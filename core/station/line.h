/* line.h: splits a terminal's bytes into lines, and a line into words. */
#ifndef WH_STATION_LINE_H
#define WH_STATION_LINE_H

#include "core/real.h"

#define WH_LINE_MOST 79U /* maximum number of characters in a line */
#define WH_LINE_WORDS 4U /* maximum number of stored words; further words are only counted */

typedef enum wh_line_event {
    WH_LINE_NOTHING,
    WH_LINE_WHOLE, /* line->text is complete, and stays until the next line begins */
    WH_LINE_BAD,   /* too long, or with an invalid character: dropped */
    WH_LINE_ESCAPE /* the Escape key: the characters typed so far are dropped */
} wh_line_event;

/* The state of the line editor. Initially all zeros. */
typedef struct wh_line {
    bool ended;    /* the next byte begins a line */
    bool returned; /* the last byte was a carriage return: a line feed after it is ignored */
    bool bad;
    uint8_t key; /* state of the escape sequence of a special key, such as an arrow */
    unsigned length;
    char text[WH_LINE_MOST + 1U];
} wh_line;

typedef struct wh_words {
    const char *word[WH_LINE_WORDS]; /* "" for missing words */
    unsigned count;                  /* number of words, including those not stored */
} wh_words;

/* Takes a byte. A line ends with carriage return, line feed or both. Backspace and Delete remove a character. */
wh_line_event wh_line_take(wh_line *line, char byte);

/* Splits text into words at blanks and tabs, in place: each separator becomes a NUL. */
void wh_line_split(wh_words *words, char *text);

/* Converts a number such as "330", "-3.5" or ".5", of at most nine digits. Returns false for other text. */
bool wh_line_number(const char *word, wh_real *number);

#endif
