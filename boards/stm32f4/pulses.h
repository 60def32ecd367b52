/* pulses.h: slot pulses on their way from the interrupt that saw them to the control loop. A part of slots.c, or of what is in
 * its place. */
#ifndef BOARDS_STM32F4_PULSES_H
#define BOARDS_STM32F4_PULSES_H

#include "hal/slots.h"
#include "ring.h"

#define PULSES_KEPT 16U

static hal_slot_pulse kept_pulses[PULSES_KEPT];
static stm32f4_ring_counts pulse_counts;
static const stm32f4_ring pulses = {&pulse_counts, kept_pulses, PULSES_KEPT, sizeof *kept_pulses};
static volatile uint32_t overruns;

/* For the interrupt. False when there is no room for more, which counts as one overrun: it then looks at nothing until one is
 * taken. */
static inline bool keep_pulse(const hal_slot_pulse *pulse) {
    if (stm32f4_ring_put(&pulses, pulse) && stm32f4_ring_has_room(&pulses)) {
        return true;
    }
    overruns++;
    return false;
}

#endif
