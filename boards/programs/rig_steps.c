/* rig_steps.c: the cost of each control step of the rig's run, without the hardware's part.
 *
 * It is the firmware's loop (rig.c) on the virtual rig, for several runs. Each step first reads its pulses and samples.
 * Only the controller's work on them is counted. Interval 0 is empty. Prints on the console:
 *
 *     run NAME FIRST LAST TURNS QUALITY    a run's intervals, and its measurement */
#include <stddef.h>

#include "boards/programs/counted.h"
#include "boards/programs/obey.h"
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "hal/virtual/virtual_rig.h"
#include "hal/watchdog.h"

#include "hal/clock.h"
#include "hal/motor.h"

#define CONTROL_TICKS UINT32_C(2000)
#define STEPS_MOST 60000U

/* The observer's model: scene rig_fixed of core/models/eccentric.whirl, with the control step as its step
 * (mk/whirl.mk). */
extern const wh_scene rig_observed;

static wh_rig rig;
static wh_rig_config config;
static unsigned intervals = 1;

/* A run, with the faults that are injected in the middle of the record. */
typedef struct trial {
    const char *name;
    float target_rpm;
    unsigned lose_pulses[2];
    unsigned lose_samples;
    float noise;      /* largest noise of the load, in counts of either sign */
    bool compensated; /* gravity is compensated even if the set-point does not need it */
    bool swings;      /* the run ends in a free swing, which is evaluated */
} trial;

static const trial trials[] = {
    {.name = "100_rpm", .target_rpm = 100.0f},
    {.name = "170_rpm", .target_rpm = 170.0f},
    {.name = "330_rpm", .target_rpm = 330.0f},
    {.name = "360_rpm", .target_rpm = 360.0f},
    {.name = "330_rpm_noise", .target_rpm = 330.0f, .noise = 200.0f},
    {.name = "330_rpm_compensated", .target_rpm = 330.0f, .compensated = true},
    {.name = "330_rpm_swings", .target_rpm = 330.0f, .swings = true},
    {.name = "330_rpm_lost_pulses", .target_rpm = 330.0f, .lose_pulses = {2, 1}},
    {.name = "330_rpm_lost_samples", .target_rpm = 330.0f, .lose_samples = 9},
    {.name = "170_rpm_lost_both", .target_rpm = 170.0f, .lose_pulses = {1, 1}, .lose_samples = 9},
};

static uint32_t seed = 1;
static int32_t noise_of(float counts) {
    seed = seed * UINT32_C(1664525) + UINT32_C(1013904223);
    return (int32_t)(counts * ((float)(int32_t)seed / 2147483648.0f));
}

static bool drives; /* true if the last command drove the motor (obey.h) */

static void control(const trial *tried) {
    hal_slot_edge pulse;
    hal_load_sample samples[8];
    bool pulsed = false;
    unsigned sample_count = 0;
    hal_clock_wait_until(hal_clock_ticks() + CONTROL_TICKS);
    hal_watchdog_kick();
    while (!pulsed && hal_slots_take(&pulse)) { /* one pulse per step, as in rig_control.h */
        pulsed = pulse.end == HAL_SLOT_LEADING;
    }
    while (sample_count < 8U && hal_loadcell_take(&samples[sample_count])) {
        samples[sample_count++].raw += noise_of(tried->noise);
    }
    const wh_rig_inputs inputs = {.now_ticks = hal_clock_ticks(), .supply_V = hal_motor_supply_V()};
    wh_count_begin();
    if (pulsed) {
        wh_rig_pulse(&config, &rig, pulse.sensor, pulse.ticks);
    }
    for (unsigned i = 0; i < sample_count; i++) {
        wh_rig_load(&config, &rig, samples[i].ticks, samples[i].raw,
                    (wh_load_status)samples[i].status);
    }
    const wh_rig_command command = wh_rig_step(&config, &rig, &inputs);
    wh_count_end();
    intervals++;
    obey(&command, &drives);
}

static bool run(const trial *tried) {
    config = wh_rig_standard;
    config.measure.cell = (wh_cell_config){.newton_per_count = HAL_LOADCELL_N_PER_COUNT,
                                           .period_ticks = HAL_LOADCELL_PERIOD_TICKS,
                                           .raw_max = HAL_LOADCELL_RAW_MAX};
    wh_rig_slots(&config, HAL_SLOT_LEAD_DEG / WH_RIG_DEG_PER_RAD);
    config.observer.scene = &rig_observed;
    config.feeds = tried->compensated ? WH_COMPENSATION_ALWAYS : wh_rig_standard.feeds;
    config.swings = tried->swings;
    config.stop_brakes = true; /* the motor brakes, so that runs without a free swing end soon */
    if (!hal_clock_start()) {
        return false;
    }
    const unsigned first = intervals;
    wh_rig_start(&config, &rig, hal_clock_ticks(), NULL);
    hal_watchdog_start(10U * CONTROL_TICKS);
    unsigned recorded = 0;
    unsigned ordered = 0; /* number of orders given so far: `arm`, then `start` */
    bool over = false;
    for (unsigned i = 0; i < STEPS_MOST && !over; i++) {
        if (ordered == 0 && rig.guard.quiet) {
            ordered += wh_rig_post(&rig, WH_EVENT_ARM, 0.0f) ? 1U : 0U;
            ordered += wh_rig_post(&rig, WH_EVENT_START, tried->target_rpm * WH_RIG_RADPS_PER_RPM);
        }
        control(tried);
        recorded += rig.run.phase == WH_PHASE_RECORD ? 1U : 0U;
        if (rig.run.phase == WH_PHASE_RECORD && recorded == 250U) {
            hal_virtual_faults *faults = &hal_virtual_rig_instance()->faults;
            faults->lose_pulses[0] = tried->lose_pulses[0];
            faults->lose_pulses[1] = tried->lose_pulses[1];
            faults->lose_samples = tried->lose_samples;
        }
        over = rig.has_result && rig.state == WH_RIG_IDLE && !wh_swing_works(&rig.swing);
    }
    line_of("run", tried->name);
    line_number(first);
    line_number(intervals - 1U);
    line_number((unsigned)rig.result.force.turns);
    line_word(wh_quality_text(rig.result.force.quality));
    line_end();
    return over;
}

int main(void) {
    board_start();
    (void)memory; /* counted.h's memory is unused: the virtual rig has its own */
    wh_count_begin();
    wh_count_end();
    bool all = true;
    for (unsigned i = 0; i < sizeof trials / sizeof trials[0]; i++) {
        all = run(&trials[i]) && all;
    }
    return all ? 0 : 1;
}
