/* pulse_ring.h: slot pulses on their way from the interrupt that saw them to the control loop. */
#ifndef BOARDS_STM32F4_PULSE_RING_H
#define BOARDS_STM32F4_PULSE_RING_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/slots.h"

/* A power of two: indices count on and wrap. */
#define PULSES_KEPT 16U

typedef struct pulse_ring {
    volatile hal_slot_pulse pulse[PULSES_KEPT];
    volatile uint32_t head; /* the interrupt's */
    volatile uint32_t tail;
    volatile uint32_t overruns;
} pulse_ring;

/* For the interrupt. False when there is no room for more, which counts as one overrun: it then looks at nothing until one is
 * taken. */
static inline bool pulse_ring_put(pulse_ring *ring, uint32_t ticks, uint8_t sensor) {
    if (ring->head - ring->tail < PULSES_KEPT) {
        ring->pulse[ring->head % PULSES_KEPT].ticks = ticks;
        ring->pulse[ring->head % PULSES_KEPT].sensor = sensor;
        ring->head++;
    }
    if (ring->head - ring->tail < PULSES_KEPT) {
        return true;
    }
    ring->overruns++;
    return false;
}

static inline bool pulse_ring_take(pulse_ring *ring, hal_slot_pulse *pulse) {
    if (ring->tail == ring->head) {
        return false;
    }
    pulse->ticks = ring->pulse[ring->tail % PULSES_KEPT].ticks;
    pulse->sensor = ring->pulse[ring->tail % PULSES_KEPT].sensor;
    ring->tail++;
    return true;
}

#endif
