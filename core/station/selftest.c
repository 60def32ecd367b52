/* selftest.c: the console's command `selftest`. */
#include "selftest.h"

#include <stddef.h>

#include "answer.h"
#include "core/number/arithmetic.h"

/* Largest load at rest, divided by full scale. Above it something pulls at the cell, or the cell is not wired. */
#define LOAD_PART WH_R(0.5)
#define PARTS 8U

static bool cell_is_good(const wh_rig_config *config, const wh_rig *rig,
                         const wh_step_inputs *seen) {
    if (!rig->guard.load_good ||
        !wh_guard_load_comes(&config->guard, &rig->guard, seen->inputs.now_ticks)) {
        return false;
    }
    const wh_real most = LOAD_PART * (wh_real)config->measure.cell.raw_max;
    return seen->samples == 0 || WH_ABS((wh_real)seen->sample[seen->samples - 1U].raw) <= most;
}

void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_step_inputs *seen,
                        wh_text *answer) {
    const wh_scene *scene = config->observer.scene;
    const wh_swung *swung = &rig->swing.result;
    const bool arithmetic = scene == NULL || scene->arithmetic == NULL ||
                            wh_arithmetic_wrong(scene->arithmetic) == WH_PROBED_COUNT;
    const wh_real off = WH_ABS(swung->place_rad[0]);
    const bool swings = swung->why == WH_SWING_FOUND;
    wh_value value[] = {{.count = 1U}, /* whether all parts are good: computed below */
                        {.count = arithmetic},
                        {.count = !seen->inputs.clock_is_fallback},
                        {.count = !seen->inputs.watchdog_has_cut},
                        {.count = wh_guard_supply(&config->guard, seen->inputs.supply_V)},
                        {.count = cell_is_good(config, rig, seen)},
                        {.count = !seen->inputs.stop_pressed},
                        {.count = rig->guard.quiet},
                        {.count = !swings || off <= config->swing.off_rad + swung->half_rad[0]},
                        {.number = swung->place_rad[0] * WH_RIG_DEG_PER_RAD},
                        {.number = swung->half_rad[0] * WH_RIG_DEG_PER_RAD}};
    for (unsigned i = 1; i <= PARTS; i++) {
        value[0].count &= value[i].count;
    }
    wh_answer(answer,
              " selftest=@g arithmetic=@g clock=@g watchdog=@g supply=@g cell=@g stop=@g"
              " rotor=@g",
              value);
    wh_answer(answer, swings ? " swing=@g place_deg=@2 place_half_deg=@2" : " swing=none",
              &value[PARTS]);
}
