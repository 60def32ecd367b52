/* guard.c: what stops the rig. */
#include "guard.h"

#include "core/packed_words.h"
#include "core/root.h"

void wh_guard_start(wh_guard *guard, uint32_t now_ticks) {
    *guard = (wh_guard){.trip = WH_TRIP_NONE, .load_ticks = now_ticks, .pulse_ticks = now_ticks};
}

WH_CALLED bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps, bool fed) {
    return target_radps >= (fed ? config->target_min_fed_radps : config->target_min_radps) &&
           target_radps <= config->target_max_radps;
}

wh_real wh_guard_bound_radps(const wh_guard_config *config, wh_real base_radps, bool falls) {
    const wh_real led = base_radps * (WH_R(1.0) + config->over);
    const wh_real fall = falls ? config->fall_radps : WH_R(0.0);
    const wh_real bound = WH_SQRT(led * led + fall * fall);
    const wh_real most = config->limit_radps * (WH_R(1.0) + config->ripple);
    return bound < most ? bound : most; /* NaN too */
}

WH_CALLED void wh_guard_trip(wh_guard *guard, wh_trip reason) {
    if (guard->trip == WH_TRIP_NONE) {
        guard->trip = reason;
    }
}

#define ONE(name, number, words) +1
#define ITEM(name, number, words) WH_WORDS(words) "\0"
_Static_assert(0 WH_TRIP_ROWS(ONE) == (int)WH_TRIP_SUPPLY, "1 is the only number that is not used");

const char *wh_trip_text(wh_trip reason) {
    static const char words[] WH_WORD_LIST = WH_TRIP_ROWS(ITEM) WH_WORDS("unknown reason") "\0";
    return wh_words_item(words, reason != WH_TRIP_NONE ? (unsigned)reason - 1U : 0U);
}
