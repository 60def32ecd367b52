/* ring.h: a FIFO between an interrupt and the control loop, for records of one size. One of the two writes, the other
 * reads. */
#ifndef BOARDS_STM32F4_RING_H
#define BOARDS_STM32F4_RING_H

#include <stdbool.h>
#include <stdint.h>

/* Numbers of records put and taken so far, wrapping. Their difference is the number of waiting records. */
typedef struct stm32f4_ring_counts {
    volatile uint32_t put;
    volatile uint32_t taken;
} stm32f4_ring_counts;

typedef struct stm32f4_ring {
    stm32f4_ring_counts *counts;
    void *records;
    uint16_t kept; /* capacity in records, a power of two */
    uint16_t bytes;
} stm32f4_ring;

static inline bool stm32f4_ring_has_room(const stm32f4_ring *ring) {
    return ring->counts->put - ring->counts->taken < ring->kept;
}

/* Put a record. Returns false if there is no room. */
bool stm32f4_ring_put(const stm32f4_ring *ring, const void *record);

/* Take the oldest record. Returns false if there is none. */
bool stm32f4_ring_take(const stm32f4_ring *ring, void *record);

#endif
