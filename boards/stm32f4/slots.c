/* slots.c: the slot sensors on two channels of timer 2, which takes the time of an edge by itself (RM0090, 18.3.5), after a
 * filter of 12 us. The interrupt only carries the stamps away. */
#include "hal/slots.h"

#include "pulse_ring.h"
#include "stm32f4.h"

#define TIM2_IRQ 28U
#define TIM2_FUNCTION 1U

static pulse_ring ring;
static const unsigned pins[2] = {BOARD_SLOT_PINS};
static const unsigned channels[2] = {BOARD_SLOT_CHANNELS};
static uint32_t all; /* both channels' interrupts */

void stm32f4_slots_start(void) {
    all = 0;
    for (unsigned i = 0; i < 2; i++) {
        const unsigned half = (channels[i] - 1U) / 2U;
        const unsigned shift = (channels[i] - 1U) % 2U * 8U;
        stm32f4_pin_is(pins[i], PIN_ALTERNATE, PULL_DOWN, TIM2_FUNCTION);
        reg_change(TIM_CCMR(TIM2, half), 0xFFU << shift,
                   (TIM_CCMR_CAPTURE | TIM_CCMR_FILTER_SLOWEST) << shift);
        reg_set(TIM_CCER(TIM2), TIM_CCER_CCE(channels[i])); /* rising edges */
        all |= TIM_SR_CCIF(channels[i]);
    }
    reg_store(TIM_SR(TIM2), 0);
    reg_store(TIM_DIER(TIM2), all);
    stm32f4_interrupt(TIM2_IRQ);
}

/* Of two that came in one go the earlier first. Reading a capture clears its flag; that one was overrun says its other. */
void on_tim2(void) {
    const uint32_t status = reg_load(TIM_SR(TIM2));
    uint32_t ticks[2] = {0, 0};
    bool seen[2] = {false, false};
    for (unsigned i = 0; i < 2; i++) {
        if ((status & TIM_SR_CCIF(channels[i])) != 0) {
            ticks[i] = reg_load(TIM_CCR(TIM2, channels[i]));
            seen[i] = true;
        }
        if ((status & TIM_SR_CCOF(channels[i])) != 0) {
            reg_store(TIM_SR(TIM2), ~TIM_SR_CCOF(channels[i]));
            ring.overruns++;
        }
    }
    const uint8_t first = seen[0] && seen[1] && (int32_t)(ticks[1] - ticks[0]) < 0 ? 1 : 0;
    bool room = true;
    for (uint8_t n = 0; n < 2; n++) {
        const uint8_t i = n ^ first;
        if (seen[i]) {
            room = pulse_ring_put(&ring, ticks[i], i) && room;
        }
    }
    if (!room) {
        reg_store(TIM_DIER(TIM2), 0);
    }
}

/* Once one is taken there is room again. What a storm left in the captures meanwhile may be of any age: forgotten. */
bool hal_slots_take(hal_slot_pulse *pulse) {
    const bool there = pulse_ring_take(&ring, pulse);
    if (there && reg_load(TIM_DIER(TIM2)) == 0) {
        for (unsigned i = 0; i < 2; i++) {
            (void)reg_load(TIM_CCR(TIM2, channels[i]));
        }
        reg_store(TIM_SR(TIM2), 0);
        reg_store(TIM_DIER(TIM2), all);
    }
    return there;
}

uint32_t hal_slots_overruns(void) { return ring.overruns; }
