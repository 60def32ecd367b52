/* even_rig.c: the rig's controller on an imitated rotor with constant speed within each turn. */
#include "even_rig.h"

#include "draw.h"

#include <stddef.h>

#include "core/angle.h"

#include "tests/suites.h"

wh_rig_config even_config(void) {
    wh_rig_config config = wh_rig_standard;
    config.measure.cell = (wh_cell_config){.newton_per_count = WH_R(1.0) / EVEN_COUNTS_PER_N,
                                           .period_ticks = EVEN_STEP_TICKS,
                                           .raw_max = INT32_C(32767)};
    /* such a small floor counts as calibrated */
    config.measure.result.amplitude_floor = WH_R(1e-4);
    config.measure.result.phase_floor_rad = WH_R(0.01) / WH_RIG_DEG_PER_RAD;
    /* The imitated rotor has a constant speed within a turn. */
    config.measure.rotor.gravity_mps2 = WH_R(0.0);
    wh_rig_slots(&config, WH_R(0.0));
    return config;
}

void even_start(even_rig *even) {
    *even = (even_rig){.config = even_config(),
                       .inputs = {.now_ticks = EVEN_START_TICKS, .supply_V = WH_RIG_RATED_V},
                       .fails = {.in = EVEN_NEVER}};
    wh_rig_start(&even->config, &even->rig, EVEN_START_TICKS, NULL);
}

static void see_failure(even_rig *even) {
    const wh_rig_phase phase = even->rig.run.phase;
    const bool begun = phase == even->fails.in &&
                       even->inputs.now_ticks - even->phase_ticks >= even->fails.after_ticks;
    even->failing = even->failing || begun || (phase > even->fails.in);
    if (even->failing && even->fails.jams) {
        even->turns = false;
    }
}

static uint32_t ticks_of_turn(wh_real speed_radps) {
    return (uint32_t)(WH_RIG_TWO_PI / speed_radps * (wh_real)WH_RIG_TICKS_PER_S + WH_R(0.5));
}

/* Sets the speed of the turn that begins now to the set-point. */
static void lead(even_rig *even) {
    const wh_run *run = &even->rig.run;
    const wh_real open_rpm = even->hand_rpm > WH_R(0.0) ? even->hand_rpm : EVEN_BEGIN_RPM;
    wh_real off_rpm = WH_R(0.0);
    if (run->phase == WH_PHASE_SETTLE || run->phase == WH_PHASE_RECORD) {
        const wh_real passed_s = (wh_real)(even->from_ticks - even->settle_ticks) / WH_R(1e6);
        wh_wave hunts;
        wh_sincos(wh_phase_from_rad(WH_RIG_TWO_PI * even->fails.hunts_Hz * passed_s), &hunts.sine,
                  &hunts.cosine);
        off_rpm =
            even->fails.hunts_rpm * hunts.sine + even->fails.drifts_rpm_s * (passed_s - WH_R(2.0));
    }
    even->turn_ticks =
        ticks_of_turn((wh_run_is_closed(run) ? run->drive.setpoint_radps : open_rpm * EVEN_RPM) +
                      off_rpm * EVEN_RPM);
}

static void begin_turning(even_rig *even, uint32_t from_ticks) {
    even->turns = true;
    even->from_ticks = from_ticks;
    even->due_sensor = 0;
    lead(even);
}

void even_turn_by_hand(even_rig *even, wh_real rpm) {
    even->hand_rpm = rpm;
    even->turns = false;
    if (rpm > WH_R(0.0)) {
        begin_turning(even, even->inputs.now_ticks);
    }
}

static void give_pulses(even_rig *even) {
    while (even->turns) {
        const unsigned due = even->due_sensor;
        const uint32_t turned = due == 2U ? even->turn_ticks : due * (even->turn_ticks / 4U);
        const uint32_t ticks = even->from_ticks + turned + (due == 2U ? 0U : even->late_ticks);
        if ((int32_t)(even->inputs.now_ticks - ticks) < 0) {
            break;
        }
        if (due == 2U) {
            even->from_ticks = ticks;
            even->due_sensor = 0;
            lead(even);
            continue;
        }
        even->due_sensor++;
        even->late_ticks = (uint32_t)draw_whole(&even->seed, 0, (int)even->fails.jitter_ticks);
        if (even->failing && even->fails.lose[due] > 0) {
            even->fails.lose[due]--;
            continue;
        }
        wh_rig_pulse(&even->config, &even->rig, even->fails.swapped ? 1U - due : due, ticks);
    }
    for (unsigned sensor = 0; sensor < WH_RIG_SENSORS; sensor++) {
        if (even->failing && even->fails.adds[sensor]) {
            even->fails.adds[sensor] = false;
            wh_rig_pulse(&even->config, &even->rig, sensor, even->inputs.now_ticks);
        }
    }
}

static void give_load(even_rig *even) {
    const uint32_t now = even->inputs.now_ticks;
    if (even->failing && even->fails.lose_samples > 0) {
        even->fails.lose_samples -= even->fails.lose_samples == EVEN_ALWAYS ? 0U : 1U;
        return;
    }
    wh_real load = WH_R(0.0);
    if (even->turns && (int32_t)(now - even->from_ticks) >= 0) {
        wh_real sine;
        wh_real cosine;
        const wh_real turned = (wh_real)(now - even->from_ticks) / (wh_real)even->turn_ticks;
        wh_sincos(wh_phase_from_rad(WH_RIG_TWO_PI * turned), &sine, &cosine);
        load = EVEN_LOAD_N * EVEN_COUNTS_PER_N * cosine;
    }
    if (even->failing && even->fails.shows != 0) {
        load = (wh_real)(now / EVEN_STEP_TICKS % 2U == 0 ? even->fails.shows : -even->fails.shows);
    }
    if (even->failing) {
        load += (wh_real)even->fails.creeps * (wh_real)(now - even->phase_ticks) / WH_R(1e6);
    }
    const int rounded = (int)(load + (load < WH_R(0.0) ? WH_R(-0.5) : WH_R(0.5)));
    wh_rig_load(&even->config, &even->rig, now, (int32_t)EVEN_TARE_RAW + rounded,
                even->failing ? even->fails.status : WH_LOAD_OK);
}

void even_step(even_rig *even) {
    even->inputs.now_ticks += EVEN_STEP_TICKS;
    see_failure(even);
    give_pulses(even);
    give_load(even);
    even->command = wh_rig_step(&even->config, &even->rig, &even->inputs);
    const wh_rig_phase phase = even->rig.run.phase;
    if (phase != even->phase) {
        even->phase = phase;
        even->phase_ticks = even->inputs.now_ticks;
        if (phase == WH_PHASE_SETTLE) {
            even->settle_ticks = even->inputs.now_ticks;
        }
        if (phase == WH_PHASE_SPIN_UP) {
            begin_turning(even, even->inputs.now_ticks + 100000U);
        }
    }
    even->turns = even->turns && (wh_run_drives(&even->rig.run) || even->hand_rpm > WH_R(0.0));
}

void even_steps(even_rig *even, unsigned steps) {
    for (unsigned i = 0; i < steps; i++) {
        even_step(even);
    }
}

wh_refusal even_order(even_rig *even, wh_rig_event event, wh_real value) {
    const uint32_t answers = even->rig.answers;
    TEST_ASSERT_TRUE(wh_rig_post(&even->rig, event, value));
    even_step(even);
    TEST_ASSERT_EQUAL_UINT32(answers + 1U, even->rig.answers);
    TEST_ASSERT_TRUE(even->rig.asked == event);
    return even->rig.answer;
}

void even_obeys(even_rig *even, wh_rig_event event, wh_real value) {
    TEST_ASSERT_TRUE(even_order(even, event, value) == WH_ALLOWED);
}

void even_rest(even_rig *even) {
    for (unsigned i = 0; i < 1000U && !even->rig.guard.quiet; i++) {
        even_step(even);
    }
    TEST_ASSERT_TRUE(even->rig.guard.quiet);
}

void even_arm(even_rig *even) {
    even_start(even);
    even_rest(even);
    even_obeys(even, WH_EVENT_ARM, WH_R(0.0));
}

void even_begin(even_rig *even, wh_real target_rpm, const even_failure *failure) {
    even_arm(even);
    even->fails = *failure;
    even_obeys(even, WH_EVENT_START, target_rpm * EVEN_RPM);
    TEST_ASSERT_TRUE(even->rig.run.phase == WH_PHASE_TARE);
}

bool even_is_over(const even_rig *even) {
    return even->rig.state == WH_RIG_IDLE ||
           (even->rig.state == WH_RIG_TRIPPED && even->rig.rested);
}

void even_go_on_until(even_rig *even, wh_rig_phase phase) {
    for (uint32_t i = 0; i < 90000U && even->rig.run.phase != phase && !even_is_over(even); i++) {
        even_step(even);
    }
}

void even_reach(even_rig *even, wh_rig_phase phase) {
    even_begin(even, WH_RIG_NOMINAL_RPM, &(even_failure){.in = EVEN_NEVER});
    even_go_on_until(even, phase == WH_PHASE_OFF ? WH_PHASE_SETTLE : phase);
    if (phase == WH_PHASE_OFF) {
        even_obeys(even, WH_EVENT_STOP, WH_R(0.0));
    }
    TEST_ASSERT_TRUE(even->rig.run.phase == phase);
}

void even_run(even_rig *even, wh_real target_rpm, const even_failure *failure) {
    even_begin(even, target_rpm, failure);
    even_go_on_until(even, EVEN_NEVER);
    TEST_ASSERT_TRUE(even_is_over(even));
    TEST_ASSERT_TRUE(even->command.way != WH_MOTOR_DRIVES);
    CHECK_NEAR(0.0f, 0.0f, even->command.volts);
}

bool even_is_done(const even_rig *even) {
    return even->rig.state == WH_RIG_IDLE && even->rig.has_result &&
           even->rig.guard.trip == WH_TRIP_NONE;
}
