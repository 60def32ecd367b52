/* tel_answer.h: the console's command `tel`. */
#ifndef WH_STATION_TEL_ANSWER_H
#define WH_STATION_TEL_ANSWER_H

#include "core/text.h"
#include "errors.h"
#include "line.h"
#include "telemetry.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_tel_answer WH_NAME(wh_tel_answer)

/* Answer the words after `tel` into *answer, which is empty; returns the reason if it is refused. */
wh_station_error wh_tel_answer(wh_tel *tel, const wh_cell_config *cell, const wh_words *words,
                               wh_text *answer);

#ifdef __cplusplus
}
#endif

#endif
