/* ring.h: a FIFO of records of one size, written by an interrupt and read by the control loop, or the reverse. */
#ifndef BOARDS_STM32F4_RING_H
#define BOARDS_STM32F4_RING_H

#include <stdbool.h>
#include <stdint.h>

/* Numbers of records put and taken since the start, modulo 2^32. */
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

/* Returns false if the ring is full. */
bool stm32f4_ring_put(const stm32f4_ring *ring, const void *record);

/* Takes the oldest record. Returns false if there is none. */
bool stm32f4_ring_take(const stm32f4_ring *ring, void *record);

#endif
