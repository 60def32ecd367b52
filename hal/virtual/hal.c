/* hal.c: the hal_ functions, on one virtual rig. */
#include "hal/clock.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/reset.h"
#include "hal/slots.h"
#include "hal/stop.h"
#include "hal/watchdog.h"
#include "virtual_rig.h"

#if !WH_DOUBLE

/* The board's one rig: hardware is global, and so is what plays it. */
static hal_virtual_rig board_rig;

hal_virtual_rig *hal_virtual_rig_instance(void) { return &board_rig; }

bool hal_clock_start(void) {
    const bool again = board_rig.in_reset;
    board_rig.in_reset = false;
    return again ? board_rig.status == WH_OK : hal_virtual_rig_start(&board_rig, &rig_fixed);
}

uint32_t hal_clock_ticks(void) { return board_rig.ticks; }

void hal_clock_wait_until(uint32_t ticks) { hal_virtual_rig_advance(&board_rig, ticks); }

void hal_motor_set_voltage(float volts) { hal_virtual_rig_set_voltage(&board_rig, volts); }

void hal_motor_off(hal_motor_off_way way) { hal_virtual_rig_motor_off(&board_rig, way); }

float hal_motor_supply_V(void) { return board_rig.supply_V; }

bool hal_slots_take(hal_slot_pulse *pulse) { return hal_virtual_rig_take_pulse(&board_rig, pulse); }

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

bool hal_stop_heard(void) { return true; }

hal_reset hal_reset_cause(void) { return board_rig.cause; }

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
