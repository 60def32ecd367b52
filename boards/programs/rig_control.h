/* rig_control.h: the rig's control step on the hal_ functions. Each program of the rig includes it once. */
#ifndef PROGRAMS_RIG_CONTROL_H
#define PROGRAMS_RIG_CONTROL_H

#include <stddef.h>

#include "core/number/arithmetic.h"
#include "core/rig/rig.h"
#include "core/scene.h"
#include "core/station/step_inputs.h"
#include "core/text.h"
#include "hal/clock.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/slots.h"
#include "hal/stop.h"
#include "hal/watchdog.h"
#include "obey.h"
#include "rig_own.h"
#include "trip_memory.h"

/* 1: hal/virtual simulates the rig's hardware. 0: real hardware, or hal/pil if HAL_FRAMES is 1. */
#ifndef HAL_VIRTUAL
#define HAL_VIRTUAL 1
#endif
#if HAL_VIRTUAL
#include "hal/virtual/virtual_rig.h"
#endif
#ifndef HAL_FRAMES
#define HAL_FRAMES 0
#endif
#if HAL_FRAMES
#include "hal/pil/rig_frames.h"
#endif

/* Begin and end of a control step's computation, for programs that measure it. Inputs and outputs are outside. */
#if HAL_FRAMES
#define STEP_BEGINS() hal_frames_step_begins()
#define STEP_ENDS() hal_frames_step_ends()
#elif !defined(STEP_BEGINS)
#define STEP_BEGINS() ((void)0)
#define STEP_ENDS() ((void)0)
#endif

_Static_assert(HAL_TICKS_PER_S == WH_RIG_TICKS_PER_S, "one clock");
_Static_assert((int)HAL_LOAD_SATURATED == (int)WH_LOAD_SATURATED &&
                   (int)HAL_LOAD_DISCONNECTED == (int)WH_LOAD_DISCONNECTED &&
                   (int)HAL_LOAD_LATE == (int)WH_LOAD_LATE &&
                   (int)HAL_LOAD_REPEATED == (int)WH_LOAD_REPEATED,
               "one list of a sample's states");

#define CONTROL_TICKS 2000U /* 500 Hz, the same as wh_rig_standard.step_s */
#define WATCHDOG_TICKS (10U * CONTROL_TICKS)
/* Largest number of samples that a step takes without a pulse, and with a pulse. */
#ifndef RIG_SAMPLES_MOST
#define RIG_SAMPLES_MOST 2U
#endif
#ifndef RIG_SAMPLES_WITH_PULSE
#define RIG_SAMPLES_WITH_PULSE 1U
#endif

_Static_assert(RIG_SAMPLES_MOST <= WH_STEP_SAMPLES, "all are seen");

/* not on the stack, because it contains the samples of a turn */
static wh_rig rig;
static wh_trip_record kept_trip; /* trip_memory.h */
static wh_step_inputs seen;      /* inputs of the last control step */
static bool drives;              /* true if the last command drove the motor (obey.h) */

/* Reads new edges and samples into `seen`, as many as one step may process. */
static void look(void) {
    hal_slot_edge edge;
    hal_load_sample sample;
    /* A step takes at most two edges, so a storm of edges cannot delay the step. */
    const bool owed = RIG_SAMPLES_WITH_PULSE == 0U && seen.pulsed;
    seen.pulsed = false;
    seen.ended = false;
    for (unsigned i = 0; i < 2U && !owed && !seen.pulsed && hal_slots_take(&edge); i++) {
        if (edge.end == HAL_SLOT_LEADING) {
            seen.pulsed = true;
            seen.sensor = edge.sensor;
            seen.pulse_ticks = edge.ticks;
        } else {
            seen.ended = true;
            seen.end_sensor = edge.sensor;
            seen.end_ticks = edge.ticks;
        }
    }
    seen.samples = 0;
    while (seen.samples < (seen.pulsed ? RIG_SAMPLES_WITH_PULSE : RIG_SAMPLES_MOST) &&
           hal_loadcell_take(&sample)) {
        seen.sample[seen.samples] =
            (wh_step_sample){sample.ticks, sample.raw, (wh_load_status)sample.status};
        seen.samples += sample.status != HAL_LOAD_REPEATED ? 1U : 0U;
    }
    seen.inputs.now_ticks = hal_clock_ticks();
    seen.inputs.supply_V = hal_motor_supply_V();
    seen.inputs.clock_is_fallback = hal_clock_source_now() == HAL_CLOCK_FALLBACK;
    seen.inputs.watchdog_has_cut = hal_watchdog_has_cut();
    seen.inputs.stop_pressed = stop_was_pressed(seen.inputs.watchdog_has_cut);
    seen.inputs.stop_by = stop_was_by();
}

/* Does a control step. A separate function, so that its stack is free again when the console runs. */
WH_CALLED static void control(const wh_rig_config *config) {
    look();
    STEP_BEGINS();
    if (seen.pulsed) {
        wh_rig_pulse(config, &rig, seen.sensor, seen.pulse_ticks);
    }
    for (unsigned i = 0; i < seen.samples; i++) {
        const wh_step_sample *sample = &seen.sample[i];
        wh_rig_load(config, &rig, sample->ticks, sample->raw, sample->status);
    }
    const wh_rig_command command = wh_rig_step(config, &rig, &seen.inputs);
    STEP_ENDS();
    obey(&command, &drives);
    trip_memory_keep(&kept_trip, &rig);
    hal_reset_mark(wh_rig_stage(&rig));
    hal_watchdog_kick(); /* even after a trip, because some watchdogs reset the processor if not kicked */
}

static const char *why_no_hardware(void) {
#if HAL_VIRTUAL
    const wh_status status = hal_virtual_rig_instance()->status;
    if (status != WH_OK) {
        return wh_status_text(status);
    }
#endif
    return "the hardware does not answer";
}

/* Starts the hardware and checks the arithmetic. Returns NULL, or the reason for a failure: then the motor is off. */
static const char *why_not_started(void) {
    if (!hal_clock_start()) {
        return why_no_hardware();
    }
    if (wh_arithmetic_wrong(OWN_ARITHMETIC) != WH_PROBED_COUNT) {
        hal_motor_off(HAL_MOTOR_COAST);
        /* no wh_status_text() here, because it would link all its texts */
        return "the arithmetic is not that of IEEE 754";
    }
    return NULL;
}

#endif
