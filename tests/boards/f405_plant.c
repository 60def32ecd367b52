/* f405_plant.c: a plant (hal/virtual) inside the flashed firmware: rotor, slot sensors, load cell, supply and stop. An
 * emulated STM32F405 lacks these. The drivers of clock, console, motor, watchdog and memory are the board's. The linker
 * routes the motor's commands to the plant (--wrap). The rotor keeps turning through a reset.
 *
 * The test sets these symbols from outside: */
#include <stdint.h>

#include "board_data.h"
#include "boards/board.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/slots.h"
#include "hal/stop.h"
#include "hal/virtual/virtual_rig.h"

extern volatile uint32_t bench_stop;   /* not 0: stop is pressed */
extern volatile uint32_t bench_silent; /* not 0: the load cell gives no samples */
/* not 0: the plant starts again, with the rotor at rest */
extern volatile uint32_t bench_rest;
volatile uint32_t bench_stop;
volatile uint32_t bench_silent;
volatile uint32_t bench_rest;

#define KNOWN 0x91A9C3D5U
__attribute__((section(".noinit"))) static uint32_t known;
__attribute__((section(".noinit"))) static hal_virtual_rig plant;
static uint32_t ahead_ticks; /* the plant's time minus the board's time */

void stm32f4_cell_start(void);
void stm32f4_slots_start(void);
unsigned hear_start(void) __asm__("__wrap_hal_motor_start");
void hear_voltage(float volts) __asm__("__wrap_hal_motor_set_voltage");
void hear_off(hal_motor_off_way way) __asm__("__wrap_hal_motor_off");
unsigned tell_start(void) __asm__("__real_hal_motor_start");
void tell_voltage(float volts) __asm__("__real_hal_motor_set_voltage");
void tell_off(hal_motor_off_way way) __asm__("__real_hal_motor_off");

static void go_on(void) {
    if (bench_rest != 0) {
        bench_rest = 0;
        (void)hal_virtual_rig_start(&plant, &rig_fixed);
        ahead_ticks = plant.ticks - board_ticks();
    }
    hal_virtual_rig_advance(&plant, board_ticks() + ahead_ticks);
}

void stm32f4_cell_start(void) {
    if (known == KNOWN) {
        hal_virtual_rig_reset(&plant, HAL_RESET_OTHER);
    } else {
        (void)hal_virtual_rig_start(&plant, &rig_fixed);
        known = KNOWN;
    }
    ahead_ticks = plant.ticks - board_ticks();
}

void stm32f4_slots_start(void) {}

static bool started; /* the motor's driver is started, and was not switched off since */

unsigned hear_start(void) {
    const unsigned wrong = tell_start();
    started = started || wrong == 0;
    return wrong;
}

void hear_voltage(float volts) {
    tell_voltage(volts);
    if (started) {
        hal_virtual_rig_drive(&plant, volts);
    }
}

void hear_off(hal_motor_off_way way) {
    tell_off(way);
    started = false;
    hal_virtual_rig_motor_off(&plant, way);
}

bool hal_slots_take(hal_slot_edge *pulse) {
    go_on();
    const bool there = hal_virtual_rig_take_pulse(&plant, pulse);
    pulse->ticks -= there ? ahead_ticks : 0U;
    return there;
}

uint32_t hal_slots_overruns(void) { return plant.overruns; }

bool hal_loadcell_take(hal_load_sample *sample) {
    const bool there = hal_virtual_rig_take_sample(&plant, sample);
    sample->ticks -= there ? ahead_ticks : 0U;
    return there && bench_silent == 0;
}

float hal_motor_supply_V(void) { return HAL_VIRTUAL_RATED_V; }
float hal_motor_supply_most_V(void) { return (float)BOARD_SUPPLY_MOST_mV / 1000.0f; }

bool hal_stop_pressed(void) { return bench_stop != 0; }
hal_stop_source hal_stop_source_now(void) { return HAL_STOP_EITHER; }
