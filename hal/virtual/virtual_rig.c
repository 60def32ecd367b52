/* virtual_rig.c: the sensors around the core's model of the eccentric-mass rig. */
#include "virtual_rig.h"

#include "hal/clock.h"

/* This file needs integer angles, which the double reference build does not have. */
#if !WH_DOUBLE

#define QUARTER_TURN 0x40000000U
#define DEG ((float)QUARTER_TURN / 90.0f) /* phase units per degree */
#define CELL_OUTPUT 0U                    /* index of the model's output cell_force */
#define OUTPUTS_MAX 8U

static void start_timer(hal_virtual_rig *rig) {
    rig->ticks = 0U - HAL_VIRTUAL_WRAP_AFTER_S * HAL_TICKS_PER_S;
    rig->sample_ticks = rig->ticks + HAL_LOADCELL_PERIOD_TICKS;
}

bool hal_virtual_rig_start(hal_virtual_rig *rig, const wh_scene *scene) {
    const float step_ticks = scene->step_s * (float)HAL_TICKS_PER_S;
    *rig = (hal_virtual_rig){.scene = scene,
                             .step_ticks = (uint32_t)(step_ticks + 0.5f),
                             .supply_V = HAL_VIRTUAL_RATED_V};
    if (scene->angles != 1 || scene->reals != 1 || scene->inputs != 1 || scene->observe == NULL ||
        scene->outputs < 1 || scene->outputs > OUTPUTS_MAX || rig->step_ticks == 0) {
        return false;
    }
    start_timer(rig);
    rig->status = wh_scene_start(scene, &rig->state, rig->memory, sizeof rig->memory);
    return rig->status == WH_OK;
}

void hal_virtual_rig_reset(hal_virtual_rig *rig, hal_reset cause) {
    hal_virtual_rig_motor_off(rig, HAL_MOTOR_COAST);
    rig->cause = cause;
    rig->in_reset = true;
    rig->watched = false;
    rig->cut = false;
    rig->stop_cuts = false;
    rig->pulses = 0;
    rig->samples = 0;
    start_timer(rig);
}

float hal_virtual_rig_speed_radps(const hal_virtual_rig *rig) {
    return wh_scene_rates(rig->scene, &rig->state)[0];
}

/* A step of the model. */
typedef struct slice {
    uint32_t phase; /* phase at the begin */
    float way;      /* angle turned in the step, phase units */
    float before;   /* rate at the begin, phase units per step */
    float after;    /* rate at the end */
} slice;

/* Returns the angle turned in the first fraction s (0 to 1) of the step, by cubic Hermite interpolation. */
static float way_at(const slice *during, float s, float *slope) {
    const float a = during->before + during->after - 2.0f * during->way;
    const float b = 3.0f * during->way - 2.0f * during->before - during->after;
    *slope = (3.0f * a * s + 2.0f * b) * s + during->before;
    return ((a * s + b) * s + during->before) * s;
}

/* If the rotor reaches the angle `edge` in this step, sets *part to the share of the step before `edge`. */
static bool opens(const slice *during, uint32_t edge, bool forward, float *part) {
    const float gap = (float)(int32_t)(edge - during->phase);
    if (forward ? !(gap > 0.0f && during->way >= gap) : !(gap < 0.0f && during->way <= gap)) {
        return false;
    }
    float s = gap / during->way;
    for (unsigned round = 0; round < 3; round++) {
        float slope;
        const float miss = way_at(during, s, &slope) - gap;
        /* if the rotor turns back at s, the slope gives no useful correction */
        if (slope * during->way > 0.0f) {
            s -= miss / slope;
        }
    }
    *part = s < 0.0f ? 0.0f : s > 1.0f ? 1.0f : s;
    return true;
}

static void add_pulse(hal_virtual_rig *rig, unsigned sensor, uint32_t ticks) {
    if (rig->faults.dead_sensor[sensor]) {
        return;
    }
    if (rig->faults.lose_pulses[sensor] > 0) {
        rig->faults.lose_pulses[sensor]--;
        return;
    }
    if (rig->pulses < HAL_VIRTUAL_PULSES) {
        rig->pulse[rig->pulses++] = (hal_slot_edge){.ticks = ticks, .sensor = (uint8_t)sensor};
    } else {
        rig->overruns++;
    }
}

/* Adds the pulses that begin in the step. The step began at `ticks`. */
static void watch_slots(hal_virtual_rig *rig, const slice *during, uint32_t ticks) {
    const uint32_t lead = (uint32_t)(HAL_SLOT_LEAD_DEG * DEG);
    for (unsigned sensor = 0; sensor < 2; sensor++) {
        const uint32_t stand = sensor * QUARTER_TURN;
        float part = 0.0f;
        if (opens(during, stand - lead, true, &part) || opens(during, stand + lead, false, &part)) {
            add_pulse(rig, sensor, ticks + (uint32_t)(part * (float)rig->step_ticks));
        }
    }
}

static int32_t convert(float force_N) {
    const float counts = force_N / HAL_LOADCELL_N_PER_COUNT;
    const float top = (float)HAL_LOADCELL_RAW_MAX;
    if (!(counts < top)) {
        return HAL_LOADCELL_RAW_MAX;
    }
    if (counts < -top) {
        return -HAL_LOADCELL_RAW_MAX;
    }
    return (int32_t)(counts + (counts < 0.0f ? -0.5f : 0.5f));
}

static void read_load_cell(hal_virtual_rig *rig) {
    wh_real output[OUTPUTS_MAX];
    rig->scene->observe(rig->scene, &rig->state, output);
    if (!rig->faults.stuck_load_cell) {
        rig->last_raw = convert(output[CELL_OUTPUT]);
    }
    if (rig->faults.lose_samples > 0) {
        rig->faults.lose_samples--;
        return;
    }
    if (rig->samples < HAL_VIRTUAL_SAMPLES) {
        const int32_t raw = rig->last_raw;
        const bool ends = raw >= HAL_LOADCELL_RAW_MAX || raw <= -HAL_LOADCELL_RAW_MAX;
        rig->sample[rig->samples++] = (hal_load_sample){
            .ticks = rig->ticks, .raw = raw, .status = ends ? HAL_LOAD_SATURATED : HAL_LOAD_OK};
    }
}

/* Returns the model's duty. A duty equal to back_emf gives no torque. */
static float duty_of(const hal_virtual_rig *rig) {
    const float back_emf = hal_virtual_rig_speed_radps(rig) * (1.0f / HAL_VIRTUAL_NO_LOAD_RADPS);
    const bool stuck = rig->faults.stuck > 0.0f;
    if (!(rig->enabled || (stuck && rig->faults.deaf)) || rig->cut || rig->stop_cuts) {
        return back_emf;
    }
    const float volts = stuck                        ? rig->faults.stuck * rig->supply_V
                        : rig->volts > rig->supply_V ? rig->supply_V
                                                     : rig->volts;
    const float duty = volts * (1.0f / HAL_VIRTUAL_RATED_V);
    return rig->faults.freewheels && duty < back_emf ? back_emf : duty;
}

static void step(hal_virtual_rig *rig) {
    if (rig->watched && rig->ticks - rig->kicked_ticks > rig->watchdog_ticks) {
        rig->cut = true;
    }
    rig->state.input[0] = duty_of(rig);

    const wh_angle angle = rig->state.angle[0];
    const float scale = WH_PHASE_PER_RAD * rig->scene->step_s;
    slice during = {.phase = wh_phase_of(angle),
                    .before = hal_virtual_rig_speed_radps(rig) * scale};
    if (rig->status == WH_OK) {
        rig->status = wh_scene_step(rig->scene, &rig->state);
    }
    during.way = (float)(int32_t)(rig->state.angle[0] - angle); /* less than half a turn */
    during.after = hal_virtual_rig_speed_radps(rig) * scale;
    if (rig->status == WH_OK) {
        watch_slots(rig, &during, rig->ticks);
    }
    rig->ticks += rig->step_ticks;
    if ((int32_t)(rig->ticks - rig->sample_ticks) >= 0) {
        rig->sample_ticks += HAL_LOADCELL_PERIOD_TICKS;
        read_load_cell(rig);
    }
}

void hal_virtual_rig_advance(hal_virtual_rig *rig, uint32_t ticks) {
    while ((int32_t)(ticks - rig->ticks) > 0) {
        step(rig);
    }
}

void hal_virtual_rig_drive(hal_virtual_rig *rig, float volts) {
    rig->volts = volts > 0.0f ? volts : 0.0f;
    rig->enabled = true;
}

void hal_virtual_rig_motor_off(hal_virtual_rig *rig, hal_motor_off_way way) {
    rig->volts = 0.0f;
    rig->enabled = way == HAL_MOTOR_BRAKE;
    rig->stop_cuts = false;
}

bool hal_virtual_rig_take_pulse(hal_virtual_rig *rig, hal_slot_edge *leading) {
    if (rig->pulses == 0) {
        return false;
    }
    *leading = rig->pulse[0];
    rig->pulses--;
    for (unsigned i = 0; i < rig->pulses; i++) {
        rig->pulse[i] = rig->pulse[i + 1U];
    }
    return true;
}

bool hal_virtual_rig_take_sample(hal_virtual_rig *rig, hal_load_sample *sample) {
    if (rig->samples == 0) {
        return false;
    }
    *sample = rig->sample[0];
    rig->samples--;
    for (unsigned i = 0; i < rig->samples; i++) {
        rig->sample[i] = rig->sample[i + 1U];
    }
    return true;
}

#endif
