/* slots.c: the slot sensors on two channels of timer 2, which takes the time of an edge by itself (RM0090, 18.3.5), after a
 * filter of 12 us. The interrupt only carries the stamps away. */
#include "hal/slots.h"

#include "pulses.h"
#include "stm32f4.h"

#define TIM2_IRQ 28U
#define TIM2_FUNCTION 1U

static const uint8_t pins[2] = {BOARD_SLOT_PINS};
static const uint8_t channels[2] = {BOARD_SLOT_CHANNELS};

/* Both channels' interrupts. */
static uint32_t all(void) { return TIM_SR_CCIF(channels[0]) | TIM_SR_CCIF(channels[1]); }

void stm32f4_slots_start(void) {
    for (unsigned i = 0; i < 2; i++) {
        stm32f4_pin_is(pins[i], PIN_ALTERNATE(TIM2_FUNCTION) | PULL_DOWN);
        stm32f4_field(TIM_CCMR(TIM2, (channels[i] - 1U) / 2U), 8U, (channels[i] - 1U) % 2U,
                      TIM_CCMR_CAPTURE | TIM_CCMR_FILTER_SLOWEST);
        reg_set(TIM_CCER(TIM2), TIM_CCER_CCE(channels[i])); /* rising edges */
    }
    reg_store(TIM_SR(TIM2), 0);
    reg_store(TIM_DIER(TIM2), all());
    stm32f4_interrupt(TIM2_IRQ);
}

/* Of two that came in one go the earlier first. Reading a capture clears its flag; that one was overrun says its other. */
void on_tim2(void) {
    const uint32_t status = reg_load(TIM_SR(TIM2));
    hal_slot_pulse seen[2];
    unsigned count = 0;
    for (uint8_t i = 0; i < 2; i++) {
        if ((status & TIM_SR_CCIF(channels[i])) != 0) {
            seen[count++] = (hal_slot_pulse){reg_load(TIM_CCR(TIM2, channels[i])), i};
        }
        if ((status & TIM_SR_CCOF(channels[i])) != 0) {
            reg_store(TIM_SR(TIM2), ~TIM_SR_CCOF(channels[i]));
            overruns++;
        }
    }
    const unsigned first = count == 2U && (int32_t)(seen[1].ticks - seen[0].ticks) < 0 ? 1U : 0U;
    bool room = true;
    for (unsigned n = 0; n < count; n++) {
        room = keep_pulse(&seen[n ^ first]);
    }
    if (!room) {
        reg_store(TIM_DIER(TIM2), 0);
    }
}

/* Once one is taken there is room again. What a storm left in the captures meanwhile may be of any age: forgotten. */
bool hal_slots_take(hal_slot_pulse *pulse) {
    const bool there = stm32f4_ring_take(&pulses, pulse);
    if (there && reg_load(TIM_DIER(TIM2)) == 0) {
        for (unsigned i = 0; i < 2; i++) {
            (void)reg_load(TIM_CCR(TIM2, channels[i]));
        }
        reg_store(TIM_SR(TIM2), 0);
        reg_store(TIM_DIER(TIM2), all());
    }
    return there;
}

uint32_t hal_slots_overruns(void) { return overruns; }
