/* rig.c: the firmware of the eccentric-mass rig without a console, the same on every board. The program acts as the
 * operator of one test run: `arm` as soon as the rotor rests, `start` at 330 rpm; then it reports. After a reset other
 * than power-on, and after a stop, it gives no orders.
 *
 * Exit status 0: done. 1: the guard tripped, stop was pressed, the processor was reset, or an order or the result was
 * refused. 2: not started, because the hardware does not answer or the arithmetic differs from IEEE 754. */
#include "core/rig/rig.h"

#include <stddef.h>

#include "boards/board.h"
#include "core/rig/datasheet.h"
#include "core/text.h"
#include "hal/clock.h"
#include "hal/console.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/reset.h"
#include "hal/stop.h"
#include "hal/watchdog.h"
#include "rig_control.h"
#include "rig_report.h"

/* 1: the rig is on a carriage, with an operator's dials (pil_carriage.c) */
#ifndef RIG_CARRIAGE
#define RIG_CARRIAGE 0
#endif
/* 1: dials set the set-point and the compensated part of gravity (pil_dialled.c) */
#ifndef RIG_DIALLED
#define RIG_DIALLED 0
#endif
#if RIG_CARRIAGE
static wh_carriage carriage;
static float displacement_m; /* measured amplitude of the carriage */
#endif

#ifndef RIG_TARGET_RPM
#define RIG_TARGET_RPM WH_RIG_NOMINAL_RPM
#endif

/* 1: the run ends in a free swing, which gives the sensors' positions */
#ifndef RIG_SWINGS
#define RIG_SWINGS 0
#endif

/* number of off commands before the program ends */
#define LAST_ORDERS 10U

/* longest wait until the rotor rests */
#define PATIENCE_TICKS (120U * HAL_TICKS_PER_S)

static float target_radps = RIG_TARGET_RPM * WH_RIG_RADPS_PER_RPM;

/* Sends notes, by which the plant's side judges the run (docs/pil.md). */
static void tell(void) {
#if HAL_FRAMES
    const wh_measured *force = &rig.result.force;
    hal_frames_note(HAL_NOTE_STATE, (float)wh_rig_stage(&rig));
    hal_frames_note(HAL_NOTE_TRIP, (float)rig.guard.trip);
    hal_frames_note(HAL_NOTE_QUALITY, (float)force->quality);
    hal_frames_note(HAL_NOTE_AMPLITUDE, force->amplitude_N);
    hal_frames_note(HAL_NOTE_AMPLITUDE_HALF, force->amplitude_half_N);
    hal_frames_note(HAL_NOTE_PHASE, force->phase_rad);
    hal_frames_note(HAL_NOTE_PHASE_HALF, force->phase_half_rad);
    hal_frames_note(HAL_NOTE_TURNS, rig.has_result ? (float)force->turns : 0.0f);
    hal_frames_note(HAL_NOTE_RESET, (float)hal_reset_cause());
#endif
#if RIG_CARRIAGE
    hal_frames_note(HAL_NOTE_DISPLACEMENT, displacement_m);
#endif
}

static void put_state(uint32_t started_ticks) {
    char bytes[96];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add_fixed(&text, (float)(hal_clock_ticks() - started_ticks) / (float)HAL_TICKS_PER_S,
                      3);
    wh_text_add(&text, " s  ");
    wh_text_add(&text, wh_rig_stage_text(wh_rig_shown_stage(&rig)));
    if (wh_run_is_closed(&rig.run)) {
        wh_text_add(&text, ", ");
        wh_text_add_fixed(&text, rig.pulses.speed.turn_radps * RPM_PER_RADPS, 1);
        wh_text_add(&text, " rpm, ");
        wh_text_add_fixed(&text, rig.run.volts, 2);
        wh_text_add(&text, " V");
    }
    wh_text_add_char(&text, '\n');
    hal_console_write(text.bytes, text.length);
}

#if RIG_CARRIAGE || RIG_DIALLED
/* longest wait for the dials' first readings, which may be late or lost */
#define DIALS_MOST_TICKS (20U * HAL_DIAL_TICKS)

static bool wait_for_dials(void) {
    const uint32_t started = hal_clock_ticks();
    for (uint32_t waited = 0;
         waited <= HAL_DIAL_TICKS || (waited <= DIALS_MOST_TICKS && !hal_frames_dials_heard());
         waited += CONTROL_TICKS) {
        hal_clock_wait_until(started + waited + CONTROL_TICKS);
        hal_load_sample none_yet;
        while (hal_loadcell_take(&none_yet)) {
        }
    }
    return hal_frames_dials_heard();
}
#endif

/* Reads the operator's dials. Returns false if no readings come. */
#if RIG_CARRIAGE
static bool take_dials(wh_rig_config *config) {
    if (!wait_for_dials()) {
        return false;
    }
    carriage = (wh_carriage){.disc_m = hal_frames_dial(HAL_DIAL_RADIUS),
                             .ratio = hal_frames_dial(HAL_DIAL_RATIO)};
    target_radps = hal_frames_dial(HAL_DIAL_SPEED);
    wh_carriage_mount(config, &carriage);
    return true;
}
#elif RIG_DIALLED
static bool take_dials(wh_rig_config *config) {
    if (hal_reset_cause() != HAL_RESET_POWER_ON) {
        return true; /* after a reset the program gives no orders, so it needs no dials */
    }
    if (!wait_for_dials()) {
        return false;
    }
    target_radps = hal_frames_dial(HAL_DIAL_TARGET);
    const float compensated = hal_frames_dial(HAL_DIAL_COMPENSATION);
    if (compensated < 0.0f || compensated > 0.0f) {
        config->compensation_when = WH_COMPENSATION_ALWAYS;
        config->compensation.weight_Nm *= compensated;
    }
    config->stop_brakes = hal_frames_dial(HAL_DIAL_BRAKES) > 0.5f;
    return true;
}
#endif

#if HAL_VIRTUAL
static void put_plant_hash(void) {
    const hal_virtual_rig *plant = hal_virtual_rig_instance();
    char bytes[96];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, "Virtual rig: model ");
    wh_text_add_hex(&text, rig_fixed.model_hash, 16);
    wh_text_add(&text, ", ");
    wh_text_add_unsigned(&text, plant->state.steps);
    wh_text_add(&text, " steps, state hash ");
    wh_text_add_hex(&text, wh_scene_hash(plant->scene, &plant->state), 16);
    wh_text_add_char(&text, '\n');
    hal_console_write(text.bytes, text.length);
}
#endif

/* Progress of the operator. After a reset or a stop no order follows: a person must check the rig first. */
typedef enum operator_step {
    WAITS_FOR_REST,
    HAS_ARMED,
    HAS_STARTED,
    WAS_RESET,
    WAS_STOPPED,
    STOP_SILENT /* the stop input has no reading */
} operator_step;

/* Does one step of the operator. Returns true after the last step. */
static bool operate(operator_step *at, uint32_t waited_ticks) {
    const bool rests = rig.guard.quiet || waited_ticks > PATIENCE_TICKS;
    const bool stop = hal_stop_pressed();
    if (stop && hal_stop_heard()) {
        *at = WAS_STOPPED;
    } else if (stop &&
               (*at == HAS_ARMED || *at == HAS_STARTED || (*at == WAITS_FOR_REST && rests))) {
        *at = STOP_SILENT;
    }
    if (rig.state == WH_RIG_TRIPPED) {
        return rig.rested;
    }
    switch (*at) {
    case WAITS_FOR_REST:
        if (rests) {
            *at = HAS_ARMED;
            (void)wh_rig_post(&rig, WH_EVENT_ARM, 0.0f);
        }
        return false;
    case HAS_ARMED:
        *at = HAS_STARTED;
        (void)wh_rig_post(&rig, WH_EVENT_START, target_radps);
        return rig.state != WH_RIG_ARMED; /* true: `arm` was refused */
    case HAS_STARTED: break;
    case WAS_RESET:
    case WAS_STOPPED:
    case STOP_SILENT: return rig.state == WH_RIG_IDLE && rests;
    }
    return (rig.state == WH_RIG_IDLE && !wh_swing_works(&rig.swing)) || rig.answer != WH_ALLOWED;
}

/* Runs the control loop until the run is over. */
static operator_step run(const wh_rig_config *config) {
    const uint32_t started = hal_clock_ticks();
    uint32_t due = started;
    operator_step operator_at =
        hal_reset_cause() == HAL_RESET_POWER_ON ? WAITS_FOR_REST : WAS_RESET;
    trip_memory_start(&kept_trip, config, &rig, started);
    unsigned shown = wh_rig_shown_stage(&rig);
    put_state(started);
    tell();
    hal_watchdog_start(WATCHDOG_TICKS);
    do {
        due += CONTROL_TICKS;
        hal_clock_wait_until(due);
        control(config);
#if RIG_CARRIAGE
        displacement_m = rig.has_result
                             ? wh_carriage_displacement_m(config, &carriage, &rig.result.force)
                             : 0.0f;
#endif
        tell();
        if (wh_rig_shown_stage(&rig) != shown) {
            shown = wh_rig_shown_stage(&rig);
            put_state(started);
        }
    } while (!operate(&operator_at, hal_clock_ticks() - started));
    /* the off command is repeated, with a wait after each, because the line to the motor may lose orders */
    for (unsigned i = 0; i < LAST_ORDERS; i++) {
        hal_motor_off(HAL_MOTOR_COAST);
        hal_clock_wait_until(hal_clock_ticks() + CONTROL_TICKS);
    }
    return operator_at;
}

static void refuse(const char *why) {
    put("NOT STARTED: ");
    put(why);
    put("; the motor is off\n");
    board_exit(2);
}

static void put_supply(float supply_V) {
    char bytes[40];
    if (supply_V >= HAL_MOTOR_SUPPLY_BEYOND) {
        put(": the supply voltage is above its range");
        return;
    }
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, ": supply ");
    wh_text_add_fixed(&text, supply_V, 2);
    wh_text_add(&text, " V");
    hal_console_write(text.bytes, text.length);
}

static void put_end(operator_step ended) {
    if (hal_reset_cause() != HAL_RESET_POWER_ON) {
        put(hal_reset_cause() == HAL_RESET_WATCHDOG ? "RESET by the watchdog" : "RESET");
        put(": the motor stays off\n");
    }
    const char *end = NULL;
    if (rig.state == WH_RIG_TRIPPED) {
        put("TRIPPED: ");
        end = wh_trip_text(rig.guard.trip);
    } else if (ended == WAS_STOPPED) {
        put("STOPPED: ");
        end = "the stop input was pressed";
    } else if (ended == STOP_SILENT) {
        put("STOPPED: ");
        end = "the stop input cannot be read";
    } else if (ended != WAS_RESET && !rig.has_result) {
        put("REFUSED: ");
        end = wh_refusal_text(rig.answer);
    }
    if (end != NULL) {
        put(end);
        if (rig.state == WH_RIG_TRIPPED && rig.guard.trip == WH_TRIP_SUPPLY) {
            put_supply(rig.record.supply_V);
        } else if (rig.answer == WH_REFUSED_SUPPLY) {
            put_supply(seen.inputs.supply_V);
        }
        put("; the motor is off\n");
    }
    if (rig.guard.trip == WH_TRIP_UNSETTLED) {
        put_turns(&rig.run);
    }
}

int main(void) {
    board_start();
    put("Eccentric-mass rig on board ");
    put(board_name);
    put("\n");
#if RIG_CARRIAGE
    hal_frames_with_dials();
#elif RIG_DIALLED
    hal_frames_with_bench_dials();
#endif
    const char *why = why_not_started();
    if (why != NULL) {
        refuse(why);
    }
    wh_rig_config config;
    own_configuration(&config);
    config.swings = RIG_SWINGS != 0;
#if RIG_CARRIAGE || RIG_DIALLED
    if (!take_dials(&config)) {
        refuse("the dials cannot be read");
    }
#endif
    const operator_step ended = run(&config);
    put_end(ended);
    if (rig.has_result) {
        put_result(&config, &rig.result,
                   RIG_CARRIAGE || RIG_DIALLED ? target_radps
                                               : WH_RIG_NOMINAL_RPM * WH_RIG_RADPS_PER_RPM);
#if RIG_CARRIAGE
        put_carriage(&config, &carriage, displacement_m);
#endif
        put_swung(&rig.swing.result);
    }
#if HAL_VIRTUAL
    put_plant_hash();
#endif
    const bool good = rig.state != WH_RIG_TRIPPED && ended == HAS_STARTED && rig.has_result &&
                      rig.result.force.quality != WH_REFUSED;
    board_exit(good ? 0 : 1);
}
