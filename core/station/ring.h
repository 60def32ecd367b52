/* ring.h: bytes that wait, first in, first out: between a console that takes them one by one and a program that must not
 * wait for it. One writer, one reader, in one context. */
#ifndef WH_STATION_RING_H
#define WH_STATION_RING_H

#include "core/flash.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wh_ring {
    uint32_t put; /* bytes so far, wrapping; those that wait are the difference */
    uint32_t taken;
    uint32_t size; /* a power of two */
    char *bytes;   /* the caller's */
} wh_ring;

static inline uint32_t wh_ring_waiting(const wh_ring *ring) { return ring->put - ring->taken; }
static inline uint32_t wh_ring_room(const wh_ring *ring) {
    return ring->size - wh_ring_waiting(ring);
}

/* All of them, or none: what is half a line helps nobody. */
static inline bool wh_ring_put(wh_ring *ring, const char *bytes, uint32_t count) {
    if (count > wh_ring_room(ring)) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        ring->bytes[(ring->put + i) & (ring->size - 1U)] = wh_word_at(&bytes[i]);
    }
    ring->put += count;
    return true;
}

/* The oldest, `room` at most; returns how many. They stay until wh_ring_drop(). */
static inline uint32_t wh_ring_peek(const wh_ring *ring, char *bytes, uint32_t room) {
    const uint32_t waiting = wh_ring_waiting(ring);
    const uint32_t count = waiting < room ? waiting : room;
    for (uint32_t i = 0; i < count; i++) {
        bytes[i] = ring->bytes[(ring->taken + i) & (ring->size - 1U)];
    }
    return count;
}

static inline void wh_ring_drop(wh_ring *ring, uint32_t count) {
    const uint32_t waiting = wh_ring_waiting(ring);
    ring->taken += count < waiting ? count : waiting;
}

#ifdef __cplusplus
}
#endif

#endif
