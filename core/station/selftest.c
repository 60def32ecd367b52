/* selftest.c: the console's command `selftest`. */
#include "selftest.h"

#include <stddef.h>

#include "answer.h"
#include "core/arithmetic.h"

/* More of it is a load, or a cell that is not wired. */
#define LOAD_PART WH_R(0.5)

static void add_part(wh_text *answer, const char *name, bool good, bool *all) {
    wh_answer_word(answer, name, good ? "good" : "bad");
    *all = *all && good;
}

static bool cell_is_good(const wh_rig_config *config, const wh_rig *rig, const wh_seen *seen) {
    if (!rig->guard.load_good ||
        !wh_guard_load_comes(&config->guard, &rig->guard, seen->inputs.now_ticks)) {
        return false;
    }
    const wh_real most = LOAD_PART * (wh_real)config->measure.cell.raw_max;
    return seen->samples == 0 || WH_ABS((wh_real)seen->sample[seen->samples - 1U].raw) <= most;
}

static void add_swing(const wh_rig_config *config, const wh_rig *rig, wh_text *answer, bool *all) {
    const wh_swung *swung = &rig->swing.result;
    if (swung->why != WH_SWING_FOUND) {
        wh_answer_word(answer, "swing", "none");
        return;
    }
    const wh_real off = WH_ABS(swung->place_rad[0]);
    add_part(answer, "swing", off <= config->swing.off_rad + swung->half_rad[0], all);
    wh_answer_number(answer, "place_deg", swung->place_rad[0] * WH_RIG_DEG_PER_RAD, 2);
    wh_answer_number(answer, "place_half_deg", swung->half_rad[0] * WH_RIG_DEG_PER_RAD, 2);
}

void wh_selftest_answer(const wh_rig_config *config, const wh_rig *rig, const wh_seen *seen,
                        wh_text *answer) {
    char bytes[200];
    wh_text parts;
    bool all = true;
    wh_text_start(&parts, bytes, sizeof bytes);
    const wh_scene *scene = config->observer.scene;
    add_part(&parts, "arithmetic",
             scene == NULL || scene->arithmetic == NULL ||
                 wh_arithmetic_wrong(scene->arithmetic) == WH_PROBED_COUNT,
             &all);
    add_part(&parts, "clock", !seen->inputs.clock_is_fallback, &all);
    add_part(&parts, "watchdog", !seen->inputs.watchdog_has_cut, &all);
    add_part(&parts, "supply", wh_guard_supply(&config->guard, seen->inputs.supply_V), &all);
    add_part(&parts, "cell", cell_is_good(config, rig, seen), &all);
    add_part(&parts, "stop", !seen->inputs.stop_pressed, &all);
    add_part(&parts, "rotor", rig->guard.quiet, &all);
    add_swing(config, rig, &parts, &all);
    wh_text_add(answer, all ? "OK selftest=good" : "OK selftest=bad");
    wh_text_add(answer, parts.bytes);
}
