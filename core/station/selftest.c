/* selftest.c: the console's command `selftest`. */
#include "selftest.h"

#include <stddef.h>

#include "answer.h"
#include "core/arithmetic.h"

/* More of it is a load, or a cell that is not wired. */
#define LOAD_PART WH_R(0.5)

static bool cell_is_good(const wh_rig_config *config, const wh_rig *rig, const wh_seen *seen) {
    if (!rig->guard.load_good ||
        !wh_guard_load_comes(&config->guard, &rig->guard, seen->inputs.now_ticks)) {
        return false;
    }
    const wh_real most = LOAD_PART * (wh_real)config->measure.cell.raw_max;
    return seen->samples == 0 || WH_ABS((wh_real)seen->sample[seen->samples - 1U].raw) <= most;
}

void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_seen *seen,
                        wh_text *answer) {
    enum { ARITHMETIC, CLOCK, WATCHDOG, SUPPLY, CELL, STOP, ROTOR, SWING, PARTS };
    const wh_scene *scene = config->observer.scene;
    const wh_swung *swung = &rig->swing.result;
    const bool swings = swung->why == WH_SWING_FOUND;
    const bool good[PARTS] = {[ARITHMETIC] =
                                  scene == NULL || scene->arithmetic == NULL ||
                                  wh_arithmetic_wrong(scene->arithmetic) == WH_PROBED_COUNT,
                              [CLOCK] = !seen->inputs.clock_is_fallback,
                              [WATCHDOG] = !seen->inputs.watchdog_has_cut,
                              [SUPPLY] = wh_guard_supply(&config->guard, seen->inputs.supply_V),
                              [CELL] = cell_is_good(config, rig, seen),
                              [STOP] = !seen->inputs.stop_pressed,
                              [ROTOR] = rig->guard.quiet,
                              [SWING] = !swings || WH_ABS(swung->place_rad[0]) <=
                                                       config->swing.off_rad + swung->half_rad[0]};
    wh_value value[1U + PARTS]; /* the first is of all */
    value[0].word = "good";
    for (unsigned i = 0; i < PARTS; i++) {
        value[1U + i].word = good[i] ? "good" : "bad";
        if (!good[i]) {
            value[0].word = "bad";
        }
    }
    const wh_value place[] = {{.number = swung->place_rad[0] * WH_RIG_DEG_PER_RAD},
                              {.number = swung->half_rad[0] * WH_RIG_DEG_PER_RAD}};
    if (!swings) {
        value[1U + SWING].word = "none";
    }
    wh_answer(answer,
              WH_WORDS(" selftest=@w arithmetic=@w clock=@w watchdog=@w supply=@w cell=@w stop=@w")
                  WH_WORDS(" rotor=@w swing=@w"),
              value);
    if (swings) {
        wh_answer(answer, WH_WORDS(" place_deg=@2 place_half_deg=@2"), place);
    }
}
