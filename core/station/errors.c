/* errors.c: why a line at the console is refused, in words. */
#include "errors.h"

#include "brief.h"

const char *wh_station_error_text(wh_station_error error) {
#define WH_STATION_CASE(name, number, words) \
    case name: return WH_SAY(words);
    switch (error) {
        WH_STATION_ERROR_ROWS(WH_STATION_CASE)
    case WH_STATION_FINE: break;
    }
    return WH_SAY("unknown error");
}
