/* rig_steps.c: the cost of each control step (rig_control.h) of several runs on the virtual rig. A step's interval has
 * only the controller's work between readings and outputs. Interval 0 is empty. Prints
 *
 *     run NAME FIRST LAST TURNS QUALITY    first and last interval of a run; turns and quality of the measurement */
#include "boards/programs/counted.h"

static void begin_step(void);
#define STEP_BEGINS() begin_step()
#define STEP_ENDS() wh_count_end()
#include "rig_control.h"

#define STEPS_MOST 60000U

static wh_rig_config config;
static unsigned intervals = 1;

/* A run. After 250 recorded steps, the virtual rig loses lose_pulses[] pulses and lose_samples samples. */
typedef struct trial {
    const char *name;
    float target_rpm;
    unsigned lose_pulses[2];
    unsigned lose_samples;
    float noise;      /* amplitude of the load's noise, in counts */
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
static const trial *tried;

static void begin_step(void) {
    for (unsigned i = 0; i < seen.samples; i++) {
        seed = seed * UINT32_C(1664525) + UINT32_C(1013904223);
        seen.sample[i].raw += (int32_t)(tried->noise * ((float)(int32_t)seed / 2147483648.0f));
    }
    intervals++;
    wh_count_begin();
}

static bool run(void) {
    own_configuration(&config);
    config.compensation_when =
        tried->compensated ? WH_COMPENSATION_ALWAYS : config.compensation_when;
    config.swings = tried->swings;
    config.stop_brakes = true; /* so that runs without a free swing end soon */
    if (why_not_started() != NULL) {
        return false;
    }
    const unsigned first = intervals;
    wh_rig_start(&config, &rig, hal_clock_ticks(), NULL);
    hal_watchdog_start(WATCHDOG_TICKS);
    unsigned recorded = 0;
    unsigned ordered = 0; /* number of orders given: `arm`, then `start` */
    bool over = false;
    for (unsigned i = 0; i < STEPS_MOST && !over; i++) {
        if (ordered == 0 && rig.guard.quiet) {
            ordered += wh_rig_post(&rig, WH_EVENT_ARM, 0.0f) ? 1U : 0U;
            ordered += wh_rig_post(&rig, WH_EVENT_START, tried->target_rpm * WH_RIG_RADPS_PER_RPM);
        }
        hal_clock_wait_until(hal_clock_ticks() + CONTROL_TICKS);
        control(&config);
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
    (void)memory; /* unused: the virtual rig has its own */
    wh_count_begin();
    wh_count_end();
    bool all = true;
    for (unsigned i = 0; i < sizeof trials / sizeof trials[0]; i++) {
        tried = &trials[i];
        all = run() && all;
    }
    return all ? 0 : 1;
}
