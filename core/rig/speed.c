/* speed.c: speed of the rotor from the pulses of the two slot sensors. */
#include "speed.h"

#include "datasheet.h"

#define QUARTERS 4U

static wh_real radps(uint32_t quarters, uint32_t ticks) {
    const wh_real time_s = (wh_real)ticks * (WH_R(1.0) / (wh_real)WH_RIG_TICKS_PER_S);
    return (wh_real)quarters * (WH_RIG_TWO_PI / (wh_real)QUARTERS) / time_s;
}

void wh_speed_start(wh_speed *speed, wh_real impossible_radps) {
    *speed = (wh_speed){.impossible_radps = impossible_radps};
}

static void begin(wh_speed *speed, unsigned sensor) {
    speed->running = true;
    speed->quarter = sensor;
    speed->seen[0] = false;
    speed->seen[1] = false;
}

/* Advances `quarter` to this sensor's next position. Returns false if the pulse needs an impossible speed. */
static bool go_on(wh_speed *speed, unsigned sensor, uint32_t ticks) {
    const uint32_t ahead = (sensor - speed->quarter) % QUARTERS;
    const uint32_t moved = ahead == 0 ? QUARTERS : ahead;
    const uint32_t interval = ticks - speed->ticks;
    const wh_real interval_radps = interval > 0 ? radps(moved, interval) : WH_R(0.0);
    if (interval == 0 || interval_radps > speed->impossible_radps) {
        return false;
    }
    /* If a pulse is more than a quarter turn late, at least two pulses were lost. */
    const wh_real due_quarters = (wh_real)moved * speed->turn_radps / interval_radps;
    if (speed->known && due_quarters > (wh_real)(moved + 1U)) {
        speed->lost += 2;
        speed->restarts++;
        /* Two successive gaps show that turn_radps is wrong. */
        speed->known = speed->interval_radps > WH_R(0.0);
        speed->interval_radps = WH_R(0.0);
        begin(speed, sensor);
        return true;
    }
    if (moved == QUARTERS) {
        speed->lost++;
    }
    speed->quarter += moved;
    speed->interval_radps = interval_radps;
    if (speed->seen[sensor]) {
        speed->turn_radps =
            radps(speed->quarter - speed->seen_quarter[sensor], ticks - speed->seen_ticks[sensor]);
        speed->known = true;
    }
    return true;
}

bool wh_speed_pulse(wh_speed *speed, unsigned sensor, uint32_t ticks) {
    if (speed->running && !go_on(speed, sensor, ticks)) {
        speed->rejected++;
        return false;
    }
    if (!speed->running) {
        begin(speed, sensor);
    }
    speed->ticks = ticks;
    speed->seen[sensor] = true;
    speed->seen_ticks[sensor] = ticks;
    speed->seen_quarter[sensor] = speed->quarter;
    speed->taken++;
    return true;
}
