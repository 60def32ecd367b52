/* conf_answer.h: the console's command `conf`. */
#ifndef WH_STATION_CONF_ANSWER_H
#define WH_STATION_CONF_ANSWER_H

#include "conf.h"
#include "core/text.h"
#include "errors.h"
#include "line.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_conf_answer WH_NAME(wh_conf_answer)

/* Answer the words after `conf` into *answer, which is empty; or return the error. `idle`: settings may change. */
wh_station_error wh_conf_answer(wh_conf *conf, const wh_words *words, bool idle, wh_text *answer);

#ifdef __cplusplus
}
#endif

#endif
