/* errors.c: reasons for refusing a console line, in words. */
#include "errors.h"

#include "answer.h"
#include "core/rig/state_machine.h"

/* Indices of the rows: a reason's words are the item with this index. */
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
