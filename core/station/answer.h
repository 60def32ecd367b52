/* answer.h: how the console's answers are put together: "OK name=value name=value: words"; and lists of words. */
#ifndef WH_STATION_ANSWER_H
#define WH_STATION_ANSWER_H

#include "core/text.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_answer WH_NAME(wh_answer)
#define wh_list_find WH_NAME(wh_list_find)
#define wh_list_item WH_NAME(wh_list_item)

typedef union wh_value {
    const char *word;
    wh_real number;
    uint32_t count;
} wh_value;

/* All words are as  has them, but for the one that is looked for. */

/* Add a form in which a value stands where it has an @ and a letter or digit, one after the other:
 *
 *     @w           a word, to the end of the list's item that it is: a blank in it as _
 *     @s           words
 *     @c           a count
 *     @x           the same in eight hexadecimal digits
 *     @g           good or bad: a count of 1 or 0
 *     @0 ... @9    a number, with so many decimals
 *     @e           a number to the seventh digit, as it can be typed, without zeros at the end */
void wh_answer(wh_text *text, const char *form, const wh_value *value);

/* A list begins with the character that parts its items, and no item has it:
 * "|" "off" "|" "on". */

#define WH_LIST_OFF_ON \
    "|" \
    "off" \
    "|" \
    "on"

/* Which of the items the word is, from 0; how many there are when it is none. */
unsigned wh_list_find(const char *list, const char *word);

/* This one of them, of which there are more. */
const char *wh_list_item(const char *list, unsigned number);

#ifdef __cplusplus
}
#endif

#endif
