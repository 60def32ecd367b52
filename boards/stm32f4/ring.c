/* ring.c: a FIFO of records between an interrupt and the control loop. */
#include "ring.h"

#include <stdatomic.h>

static uint8_t *place_of(const stm32f4_ring *ring, uint32_t count) {
    return (uint8_t *)ring->records + (count & (ring->kept - 1U)) * ring->bytes;
}

/* The fences keep the compiler from moving the copy across accesses to the counts. */
static void copy(void *to, const void *from, unsigned bytes) {
    atomic_signal_fence(memory_order_seq_cst);
    __builtin_memcpy(to, from, bytes);
    atomic_signal_fence(memory_order_seq_cst);
}

bool stm32f4_ring_put(const stm32f4_ring *ring, const void *record) {
    if (!stm32f4_ring_has_room(ring)) {
        return false;
    }
    copy(place_of(ring, ring->counts->put), record, ring->bytes);
    ring->counts->put++;
    return true;
}

bool stm32f4_ring_take(const stm32f4_ring *ring, void *record) {
    if (ring->counts->put == ring->counts->taken) {
        return false;
    }
    copy(record, place_of(ring, ring->counts->taken), ring->bytes);
    ring->counts->taken++;
    return true;
}
