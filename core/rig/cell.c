/* cell.c: a load sample's status in words. */
#include "cell.h"

const char *wh_load_text(wh_load_status status) {
#define WH_LOAD_CASE(name, words) \
    case name: return words;
    switch (status) {
        WH_LOAD_ROWS(WH_LOAD_CASE)
    case WH_LOAD_STATUSES: break;
    }
    return "unknown status";
}
