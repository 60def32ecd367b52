/* on_plant.c: the rig's controller on the virtual rig. */
#include "on_plant.h"

#include <stddef.h>

#include "tests/scattered.h"
#include "tests/suites.h"

#if !WH_DOUBLE

/* Returns an approximately Gaussian number: the sum of twelve uniform ones. */
static float normal(void) {
    float sum = -6.0f;
    for (unsigned i = 0; i < 12; i++) {
        sum += (float)(scattered() >> 40) / 16777216.0f;
    }
    return sum;
}

void plant_control(on_plant *on) {
    hal_clock_wait_until(hal_clock_ticks() + CONTROL_TICKS);
    hal_slot_edge pulse;
    while (hal_slots_take(&pulse)) {
        if (pulse.end == HAL_SLOT_LEADING) {
            wh_rig_pulse(&on->config, &on->rig, pulse.sensor, pulse.ticks);
        }
    }
    hal_load_sample sample;
    while (hal_loadcell_take(&sample)) {
        if (on->noise_N > 0.0f) {
            sample.raw += (int32_t)(on->noise_N * normal() / HAL_LOADCELL_N_PER_COUNT);
        }
        wh_rig_load(&on->config, &on->rig, sample.ticks, sample.raw, (wh_load_status)sample.status);
    }
    const wh_rig_inputs inputs = {.now_ticks = hal_clock_ticks(),
                                  .supply_V = hal_motor_supply_V(),
                                  .stop_pressed = stop_was_pressed(hal_watchdog_has_cut()),
                                  .stop_by = stop_was_by(),
                                  .watchdog_has_cut = hal_watchdog_has_cut()};
    on->command = wh_rig_step(&on->config, &on->rig, &inputs);
    obey(&on->command, &on->drives);
    trip_memory_keep(&on->memory, &on->rig);
    hal_watchdog_kick(); /* also after a trip */
    const float speed = hal_virtual_rig_speed_radps(hal_virtual_rig_instance());
    on->fastest_radps = speed > on->fastest_radps ? speed : on->fastest_radps;
}

wh_refusal plant_order(on_plant *on, wh_rig_event event, float value) {
    TEST_ASSERT_TRUE(wh_rig_post(&on->rig, event, value));
    plant_control(on);
    return on->rig.answer;
}

static void begin_control(on_plant *on) {
    TEST_ASSERT_TRUE(hal_clock_start());
    on->drives = false;
    trip_memory_start(&on->memory, &on->config, &on->rig, hal_clock_ticks());
    hal_watchdog_start(10U * CONTROL_TICKS);
}

void plant_reset(on_plant *on, hal_reset cause) {
    hal_virtual_rig_reset(hal_virtual_rig_instance(), cause);
    on->rig = (wh_rig){.state = WH_RIG_ARMED,
                       /* any phase, because real memory is not zeroed either */
                       .run.phase = WH_PHASE_RECORD};
    on->memory = (wh_trip_record){.trip = WH_TRIP_NONE};
    begin_control(on);
}

void plant_start(on_plant *on) {
    on->config = wh_rig_standard;
    on->config.measure.cell = (wh_cell_config){.newton_per_count = HAL_LOADCELL_N_PER_COUNT,
                                               .period_ticks = HAL_LOADCELL_PERIOD_TICKS,
                                               .raw_max = HAL_LOADCELL_RAW_MAX};
    wh_rig_slots(&on->config, HAL_SLOT_LEAD_DEG / WH_RIG_DEG_PER_RAD);
    /* a rotor that coasts needs a minute to come to rest */
    on->config.tripped_max_s = on->config.rest_max_s;
    scattered_state = UINT64_C(0x5eed0041);
    on->fastest_radps = 0.0f;
    on->noise_N = 0.0f;
    on->memory = (wh_trip_record){.trip = WH_TRIP_NONE};
    begin_control(on);
    for (unsigned i = 0; i < 1000U && !on->rig.guard.quiet; i++) {
        plant_control(on);
    }
}

void plant_arm(on_plant *on) {
    plant_start(on);
    TEST_ASSERT_TRUE(plant_order(on, WH_EVENT_ARM, 0.0f) == WH_ALLOWED);
}

void plant_begin(on_plant *on, float target_rpm) {
    plant_arm(on);
    TEST_ASSERT_TRUE(plant_order(on, WH_EVENT_START, target_rpm * RPM) == WH_ALLOWED);
}

static bool is_over(const on_plant *on) {
    return on->rig.state == WH_RIG_IDLE || (on->rig.state == WH_RIG_TRIPPED && on->rig.rested);
}

void plant_go_on_until(on_plant *on, wh_rig_phase phase) {
    for (uint32_t i = 0; i < 90000U && on->rig.run.phase != phase && !is_over(on); i++) {
        plant_control(on);
    }
}

void plant_go_on_to_the_end(on_plant *on) { plant_go_on_until(on, WH_PHASES); }

void plant_check_stopped(const on_plant *on) {
    TEST_ASSERT_TRUE(is_over(on));
    TEST_ASSERT_TRUE(on->command.way != WH_MOTOR_DRIVES);
    CHECK_NEAR(0.0f, 0.0f, on->command.volts);
    CHECK_NEAR(0.1f, 0.0f, hal_virtual_rig_speed_radps(hal_virtual_rig_instance()));
}

bool plant_is_done(const on_plant *on) {
    return on->rig.state == WH_RIG_IDLE && on->rig.has_result && on->rig.guard.trip == WH_TRIP_NONE;
}

#endif
