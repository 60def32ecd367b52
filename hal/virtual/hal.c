/* hal.c: the hal_ functions, on one virtual rig. */
#include "core/text.h"
#include "hal/clock.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/reset.h"
#include "hal/slots.h"
#include "hal/stop.h"
#include "hal/watchdog.h"
#include "virtual_rig.h"

#if !WH_DOUBLE

static hal_virtual_rig board_rig;

hal_virtual_rig *hal_virtual_rig_instance(void) { return &board_rig; }

static bool motor_started;

/* True after the leading edge of `pulse` was taken, until its trailing edge is taken. No other pulse begins in between,
 * because pulses are farther apart than they are long. */
static bool is_high;
static hal_slot_edge pulse;

bool hal_clock_start(void) {
    motor_started = false;
    is_high = false;
    const bool again = board_rig.in_reset;
    board_rig.in_reset = false;
    return again ? board_rig.status == WH_OK : hal_virtual_rig_start(&board_rig, &rig_fixed);
}

hal_clock_source hal_clock_source_now(void) { return HAL_CLOCK_PLAYED; }

uint32_t hal_clock_ticks(void) { return board_rig.ticks; }

void hal_clock_wait_until(uint32_t ticks) { hal_virtual_rig_advance(&board_rig, ticks); }

unsigned hal_motor_status(void) {
    return board_rig.cut || board_rig.stop_cuts ? HAL_MOTOR_CUT : 0U;
}

unsigned hal_motor_start(void) {
    if (!motor_started && hal_motor_status() == 0) {
        motor_started = true;
        hal_virtual_rig_drive(&board_rig, 0.0f);
    }
    return hal_motor_status();
}

void hal_motor_set_voltage(float volts) {
    if (motor_started) {
        hal_virtual_rig_drive(&board_rig, volts);
    }
}

void hal_motor_off(hal_motor_off_way way) {
    motor_started = false;
    hal_virtual_rig_motor_off(&board_rig, way);
}

float hal_motor_supply_V(void) { return board_rig.supply_V; }

float hal_motor_supply_most_V(void) { return (float)HAL_MOTOR_SUPPLY_MOST_mV / 1000.0f; }

bool hal_slots_take(hal_slot_edge *edge) {
    if (!is_high) {
        is_high = hal_virtual_rig_take_pulse(&board_rig, &pulse);
        *edge = pulse;
        return is_high;
    }
    edge->ticks = pulse.ticks + HAL_VIRTUAL_PULSE_TICKS;
    edge->sensor = pulse.sensor;
    edge->end = HAL_SLOT_TRAILING;
    is_high = (int32_t)(board_rig.ticks - edge->ticks) < 0;
    return !is_high;
}

uint32_t hal_slots_overruns(void) { return board_rig.overruns; }

bool hal_loadcell_take(hal_load_sample *sample) {
    return hal_virtual_rig_take_sample(&board_rig, sample);
}

void hal_watchdog_start(uint32_t timeout_ticks) {
    board_rig.watched = true;
    board_rig.watchdog_ticks = timeout_ticks;
    board_rig.kicked_ticks = board_rig.ticks;
}

void hal_watchdog_kick(void) { board_rig.kicked_ticks = board_rig.ticks; }

bool hal_watchdog_has_cut(void) { return board_rig.cut; }

bool hal_stop_pressed(void) { return board_rig.stop_pressed; }

hal_stop_source hal_stop_source_now(void) { return HAL_STOP_INPUT; }

bool hal_stop_heard(void) { return true; }

hal_reset hal_reset_cause(void) { return board_rig.cause; }

unsigned hal_reset_words(char *words, unsigned room) {
    wh_text text;
    wh_text_start(&text, words, room);
    wh_text_add(&text, board_rig.cause == HAL_RESET_POWER_ON   ? "power on"
                       : board_rig.cause == HAL_RESET_WATCHDOG ? "watchdog"
                                                               : "other");
    return text.length;
}

void hal_reset_mark(uint32_t state) { (void)state; }

void hal_remember(const void *bytes, unsigned count) {
    const uint8_t *from = bytes;
    board_rig.remembers = count < HAL_REMEMBER_BYTES ? count : HAL_REMEMBER_BYTES;
    for (unsigned i = 0; i < board_rig.remembers; i++) {
        board_rig.remembered[i] = from[i];
    }
}

unsigned hal_recall(void *bytes) {
    uint8_t *to = bytes;
    for (unsigned i = 0; i < board_rig.remembers; i++) {
        to[i] = board_rig.remembered[i];
    }
    return board_rig.remembers;
}

#endif
