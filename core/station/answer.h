/* answer.h: the console's answers, "OK name=value name=value: words", and lists of words in one string. */
#ifndef WH_STATION_ANSWER_H
#define WH_STATION_ANSWER_H

#include "core/text.h"

typedef union wh_value {
    const char *word;
    wh_real number;
    uint32_t count;
} wh_value;

/* Adds `form` to the text. All strings may be in flash (core/number/flash.h). @ and a character stand for the next
 * value:
 *
 *     @w           a word, or a list item with _ in place of blanks
 *     @s           words
 *     @c           a count
 *     @x           a count in eight hexadecimal digits
 *     @g           the word good or bad, for a count of 1 or 0
 *     @0 ... @9    a number with this many decimals
 *     @e           a number with at most seven digits and eight decimals, without trailing zeros */
void wh_answer(wh_text *text, const char *form, const wh_value *value);

/* A list begins with its separator, a character that no item contains: "|" "off" "|" "on". */

#define WH_LIST_OFF_ON \
    "|" \
    "off" \
    "|" \
    "on"

/* Returns the word's index in the list, from 0; for an unknown word, the number of items. */
unsigned wh_list_find(const char *list, const char *word);

/* Returns the start of item `number` (from 0; it must exist). The item ends at the next separator or the list's end. */
const char *wh_list_item(const char *list, unsigned number);

/* === reasons for refusing a console line ===================================================== */

/* The console's own reasons: X(name, number, words). A number never changes. wh_refusal uses the numbers 1 to 99. */
#define WH_STATION_ERROR_ROWS(X) \
    X(WH_STATION_NO_COMMAND, 100, "no such command; help lists them") \
    X(WH_STATION_LINE, 101, "the line is too long, or has an invalid character") \
    X(WH_STATION_WORDS, 102, "too many words") \
    X(WH_STATION_NO_NUMBER, 103, "give a number, such as 330 or 330.5") \
    X(WH_STATION_NO_RESULT, 104, "there is no result") \
    X(WH_STATION_ON_OFF, 105, "give on or off") \
    X(WH_STATION_SECONDS, 106, "give 0, or a number of seconds from 1 to 3600") \
    X(WH_STATION_BUSY, 107, "this works only while the rig is idle") \
    X(WH_STATION_CONF_HOW, 108, "conf has no such subcommand; help conf shows them") \
    X(WH_STATION_CONF_NONE, 109, "no such setting; conf list FROM shows them from number FROM") \
    X(WH_STATION_CONF_VALUE, 110, "not a value of this setting; conf get shows its type") \
    X(WH_STATION_CONF_RANGE, 111, "outside the setting's range; conf get shows it") \
    X(WH_STATION_CONF_AGAINST, 112, "conflicts with another speed, supply or motor setting") \
    X(WH_STATION_CONF_FAILED, 113, \
      "the settings memory failed; the settings saved before are kept") \
    X(WH_STATION_NOT_HERE, 114, "this program does not support it") \
    X(WH_STATION_TEL_HOW, 115, "tel has no such subcommand; help tel shows them") \
    X(WH_STATION_TEL_RATE, 116, "give a divisor of the cell's rate; in text formats at most 100") \
    X(WH_STATION_TEL_CHANNEL, 117, "no such channel; tel list shows all") \
    X(WH_STATION_TEL_FORMAT, 118, "give frames, teleplot or arduino") \
    X(WH_STATION_TEL_RING, 119, "the ring has no records yet")

#define WH_STATION_NAME(name, number, words) name = (number),
typedef enum wh_station_error {
    WH_STATION_FINE,
    WH_STATION_ERROR_ROWS(WH_STATION_NAME)
} wh_station_error;
#undef WH_STATION_NAME

/* Replaces the answer by "ERR why words". `why` is a wh_station_error or a wh_refusal. */
void wh_answer_refused(wh_text *answer, unsigned why);

#endif
