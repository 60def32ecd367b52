/* ring.h: what waits between an interrupt and the control loop, first in, first out: records of one size. One of them puts, the
 * other takes. */
#ifndef BOARDS_STM32F4_RING_H
#define BOARDS_STM32F4_RING_H

#include <stdbool.h>
#include <stdint.h>

/* Records so far, wrapping; those that wait are the difference. */
typedef struct stm32f4_ring_counts {
    volatile uint32_t put;
    volatile uint32_t taken;
} stm32f4_ring_counts;

typedef struct stm32f4_ring {
    stm32f4_ring_counts *counts;
    void *records;
    uint16_t kept; /* so many at most: a power of two */
    uint16_t bytes;
} stm32f4_ring;

static inline bool stm32f4_ring_has_room(const stm32f4_ring *ring) {
    return ring->counts->put - ring->counts->taken < ring->kept;
}

/* False: there is no room. */
bool stm32f4_ring_put(const stm32f4_ring *ring, const void *record);

/* The oldest. False: there is none. */
bool stm32f4_ring_take(const stm32f4_ring *ring, void *record);

#endif
