/* slots_exti.c: the slot sensors as plain external interrupts (RM0090, 12.2), for pins without a timer capture, and for
 * QEMU, which has no capture. The time is read when the interrupt begins, so it is late by the latency, some
 * microseconds. There is no filter. The file always uses lines 0 and 1 of port A, and ignores BOARD_SLOT_PINS. */
#include "hal/slots.h"

#include "boards/board.h"
#include "pulses.h"
#include "stm32f4.h"

#define EXTI0_IRQ 6U
#define EXTI1_IRQ 7U
#define LINES 3U

void stm32f4_slots_start(void) {
    stm32f4_clock_on(RCC_PART(RCC_APB2ENR, RCC_APB2ENR_SYSCFG));
    stm32f4_pin_is(PIN('A', 0), PIN_INPUT | PULL_DOWN);
    stm32f4_pin_is(PIN('A', 1), PIN_INPUT | PULL_DOWN);
    reg_change(SYSCFG_EXTICR(0), 0xFFU, 0); /* port A */
    reg_set(EXTI_RTSR, LINES);
    reg_store(EXTI_PR, LINES);
    reg_store(EXTI_IMR, LINES);
    stm32f4_interrupt(EXTI0_IRQ);
    stm32f4_interrupt(EXTI1_IRQ);
}

/* Handles an interrupt. QEMU requests it at both edges, but only a rising edge is pending. */
static void see(uint8_t sensor) {
    const uint32_t ticks = board_ticks();
    if ((reg_load(EXTI_PR) & 1U << sensor) == 0) {
        return;
    }
    reg_store(EXTI_PR, 1U << sensor);
    if (!keep_edge(&(hal_slot_edge){ticks, sensor, HAL_SLOT_LEADING})) {
        reg_store(EXTI_IMR, 0);
    }
}

void on_exti0(void) { see(0); }
void on_exti1(void) { see(1); }

bool hal_slots_take(hal_slot_edge *edge) {
    const bool there = stm32f4_ring_take(&edges, edge);
    if (there && reg_load(EXTI_IMR) == 0) {
        reg_store(EXTI_PR, LINES);
        reg_store(EXTI_IMR, LINES);
    }
    return there;
}

uint32_t hal_slots_overruns(void) { return overruns; }
