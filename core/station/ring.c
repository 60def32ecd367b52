/* ring.c: a FIFO of bytes. */
#include "ring.h"

bool wh_ring_put(wh_ring *ring, const char *bytes, uint32_t count) {
    if (count > wh_ring_room(ring)) {
        return false;
    }
    for (; count > 0; count--) {
        ring->bytes[ring->put++ & (ring->size - 1U)] = wh_word_at(bytes++);
    }
    return true;
}

uint32_t wh_ring_peek(const wh_ring *ring, char *bytes, uint32_t room) {
    const uint32_t waiting = wh_ring_waiting(ring);
    const uint32_t count = waiting < room ? waiting : room;
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = ring->bytes[(ring->taken + i) & (ring->size - 1U)];
    }
    return count;
}

void wh_ring_drop(wh_ring *ring, uint32_t count) {
    const uint32_t waiting = wh_ring_waiting(ring);
    ring->taken += count < waiting ? count : waiting;
}
