/* errors.h: reasons for refusing a console line. */
#ifndef WH_STATION_ERRORS_H
#define WH_STATION_ERRORS_H

#include "core/text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reasons other than the rig's own refusals (wh_refusal, 1 ... 99): X(name, number, words). Numbers never change. */
#define WH_STATION_ERROR_ROWS(X) \
    X(WH_STATION_NO_COMMAND, 100, "no such command; help lists them") \
    X(WH_STATION_LINE, 101, "the line is too long, or has an invalid character") \
    X(WH_STATION_WORDS, 102, "too many words") \
    X(WH_STATION_NO_NUMBER, 103, "a number is wanted, such as 330 or 330.5") \
    X(WH_STATION_NO_RESULT, 104, "the last run has given no result") \
    X(WH_STATION_ON_OFF, 105, "on or off is wanted") \
    X(WH_STATION_SECONDS, 106, "0 or a number of seconds from 1 to 3600 is wanted") \
    X(WH_STATION_BUSY, 107, "only while the rig is idle") \
    X(WH_STATION_CONF_HOW, 108, "no such words; help conf has them") \
    X(WH_STATION_CONF_NONE, 109, "no such setting; conf list has them") \
    X(WH_STATION_CONF_VALUE, 110, "no value for this setting; conf get tells its type") \
    X(WH_STATION_CONF_RANGE, 111, "outside its range; conf get tells it") \
    X(WH_STATION_CONF_AGAINST, 112, \
      "it goes against another setting: least, most and limit, or the motor") \
    X(WH_STATION_CONF_FAILED, 113, "the memory for settings failed; what was saved before stays") \
    X(WH_STATION_NOT_HERE, 114, "this program has none") \
    X(WH_STATION_TEL_HOW, 115, "no such words; help tel has them") \
    X(WH_STATION_TEL_RATE, 116, \
      "samples a second that part the cell's rate are wanted; with text 100 at most") \
    X(WH_STATION_TEL_CHANNEL, 117, "no such channel; tel list has them") \
    X(WH_STATION_TEL_FORMAT, 118, "frames, teleplot or arduino is wanted") \
    X(WH_STATION_TEL_RING, 119, "the ring has nothing to be read yet")

#define WH_STATION_NAME(name, number, words) name = (number),
typedef enum wh_station_error {
    WH_STATION_FINE,
    WH_STATION_ERROR_ROWS(WH_STATION_NAME)
} wh_station_error;
#undef WH_STATION_NAME

#define wh_answer_refused WH_NAME(wh_answer_refused)

/* Replace the answer by "ERR why words", from a wh_station_error or a wh_refusal. */
void wh_answer_refused(wh_text *answer, unsigned why);

#ifdef __cplusplus
}
#endif

#endif
