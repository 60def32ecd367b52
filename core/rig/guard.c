/* guard.c: the reasons to stop the rig. */
#include "guard.h"

#include "cell.h"
#include "core/root.h"
#include "core/text.h"

void wh_guard_start(wh_guard *guard, uint32_t now_ticks) {
    *guard = (wh_guard){.trip = WH_TRIP_NONE, .load_ticks = now_ticks, .pulse_ticks = now_ticks};
}

WH_CALLED bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps,
                               bool compensated) {
    return target_radps >=
               (compensated ? config->target_min_compensated_radps : config->target_min_radps) &&
           target_radps <= config->target_max_radps;
}

wh_real wh_guard_bound_radps(const wh_guard_config *config, wh_real limit_radps, wh_real falls) {
    const wh_real led = limit_radps * (WH_R(1.0) + config->over);
    const wh_real fall = falls * config->fall_radps;
    const wh_real bound = WH_SQRT(led * led + fall * fall);
    const wh_real most = config->limit_radps * (WH_R(1.0) + config->ripple);
    return bound < most ? bound : most; /* NaN gives `most` */
}

WH_CALLED void wh_guard_trip(wh_guard *guard, wh_trip reason) {
    if (guard->trip == WH_TRIP_NONE) {
        guard->trip = reason;
    }
}

void wh_guard_drives(wh_guard *guard) { guard->off = (wh_off){.released = false}; }

/* Duration of a turn at 1,000 rpm. Pulses of one sensor that come sooner are ignored: 36 V give at most 900 rpm. */
#define BOUNCE_TICKS 60000U
#define LONGER WH_R(1.02) /* least ratio of a turn's duration to that of the turn before */
#define FASTER WH_R(1.01) /* WH_TRIP_RUNS_ON needs first_ticks/turn_ticks above this */
#define ALTERNATE_PAIR 4U /* value of wh_off.alternate after two turns */
#define ALTERNATE_RISE 6U /* value of wh_off.alternate after three turns */
#define ALONE_PAIR 2U     /* value of wh_off.alone after two turns */
#define ALONE_RISE 3U
#define ALONE_COASTS 4U
#define ALONE_SURE 6U /* value of wh_off.alone that jitter at rest does not reach */

static uint8_t one_more(uint8_t count) {
    return (uint8_t)(count < ALONE_SURE ? count + 1U : count);
}

static WH_CALLED wh_real radps_of(uint32_t turn_ticks) {
    return WH_RIG_TWO_PI * (wh_real)WH_RIG_TICKS_PER_S / (wh_real)turn_ticks;
}

/* Compares a turn with the previous turn of the same sensor. */
static void see_turn(const wh_guard_config *config, wh_guard *guard, bool brakes, unsigned sensor,
                     uint32_t before_ticks) {
    wh_off *off = &guard->off;
    struct wh_off_turns *of = &off->of[sensor];
    const wh_real now = radps_of(of->turn_ticks);
    const wh_real before = radps_of(before_ticks);
    const wh_real swing = WH_GUARD_LIGHTER * config->fall_radps;
    const bool alone = off->alone >= ALONE_PAIR && now > swing && before > swing;
    if (of->turn_ticks < before_ticks) {
        of->first_ticks = of->faster == 0 ? before_ticks : of->first_ticks;
        of->faster = one_more(of->faster);
    } else {
        of->faster = 0;
    }
    of->longer =
        (wh_real)of->turn_ticks > LONGER * (wh_real)before_ticks ? one_more(of->longer) : 0;
    if (brakes && !off->released && !(now <= before - config->braked_radps)) {
        off->released = true;
        off->doubted = off->alone >= ALONE_PAIR;
        off->asks = off->alternate >= ALTERNATE_PAIR;
        if (alone || (off->asks && sensor != 0)) {
            wh_guard_trip(guard, WH_TRIP_UNBRAKED);
        }
    }
    if (off->doubted && off->alone >= ALONE_COASTS && of->longer >= 3U) {
        wh_guard_trip(guard, WH_TRIP_UNBRAKED);
    }
    if (of->faster >= 2U && now > config->hand_radps &&
        (wh_real)of->first_ticks > FASTER * (wh_real)of->turn_ticks &&
        (off->alternate >= ALTERNATE_RISE || (alone && off->alone >= ALONE_RISE))) {
        wh_guard_trip(guard, WH_TRIP_RUNS_ON);
    }
    if (off->alone >= ALONE_SURE && now > config->limit_radps && before > config->limit_radps) {
        wh_guard_trip(guard, WH_TRIP_OVERSPEED);
    }
}

WH_CALLED void wh_guard_off_pulse(const wh_guard_config *config, wh_guard *guard, bool brakes,
                                  unsigned sensor, uint32_t ticks) {
    wh_off *off = &guard->off;
    if (guard->quiet) { /* the times of old pulses may have wrapped */
        *off = (wh_off){.released = off->released};
    }
    struct wh_off_turns *of = &off->of[sensor];
    const uint32_t turn_ticks = ticks - of->ticks;
    if (of->seen && turn_ticks < BOUNCE_TICKS) {
        return;
    }
    const bool again = off->sensor == sensor + 1U;
    off->alternate = off->sensor == 0 || again ? 0U : one_more(off->alternate);
    off->alone = again ? one_more(off->alone) : 0U;
    off->sensor = (uint8_t)(sensor + 1U);
    if (off->asks && !again) {
        wh_guard_trip(guard, WH_TRIP_UNBRAKED);
    }
    off->asks = false;
    of->ticks = ticks;
    if (of->seen) {
        const uint32_t before_ticks = of->turn_ticks;
        of->turn_ticks = turn_ticks;
        if (before_ticks > 0) {
            see_turn(config, guard, brakes, sensor, before_ticks);
        }
    }
    of->seen = true;
}

#define NUMBER(name, number, words) number,
#define ITEM(name, number, words) words "\0"
#define FITS(name, number, words) \
    _Static_assert((number) <= 255 && sizeof(words) <= 96U, \
                   "the number must fit in a byte; the words must fit in a line of a report");
WH_TRIP_ROWS(FITS)

const char *wh_trip_text(wh_trip reason) {
    static const char words[] WH_WORD_LIST = WH_TRIP_ROWS(ITEM) WH_WORDS("unknown reason");
    static const uint8_t numbers[] = {WH_TRIP_ROWS(NUMBER)};
    unsigned row = 0;
    while (row < sizeof numbers && numbers[row] != (unsigned)reason) {
        row++;
    }
    return wh_words_item(words, row);
}
