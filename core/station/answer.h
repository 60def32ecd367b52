/* answer.h: formatting of the console's answers, "OK name=value name=value: words"; and lists of words in one
 * string. */
#ifndef WH_STATION_ANSWER_H
#define WH_STATION_ANSWER_H

#include "core/text.h"

typedef union wh_value {
    const char *word;
    wh_real number;
    uint32_t count;
} wh_value;

/* Adds a form to the text. All texts here may stay in flash (core/number/flash.h), except the word to search for. An @
 * and a letter or digit stand for the next value:
 *
 *     @w           a word: a list item, with _ in place of blanks
 *     @s           words
 *     @c           a count
 *     @x           a count in eight hexadecimal digits
 *     @g           the word good or bad, for a count of 1 or 0
 *     @0 ... @9    a number with this many decimals
 *     @e           a number with seven digits, at most eight of them decimals, without trailing zeros; a user can
 *                  type it */
void wh_answer(wh_text *text, const char *form, const wh_value *value);

/* A list begins with its separator, a character that no item contains: "|" "off" "|" "on". */

#define WH_LIST_OFF_ON \
    "|" \
    "off" \
    "|" \
    "on"

/* Returns the word's index in the list, from 0; or the number of items if the word is not in the list. */
unsigned wh_list_find(const char *list, const char *word);

/* Returns the item with this index. The index must be below the number of items. */
const char *wh_list_item(const char *list, unsigned number);

#endif
