/* ring.h: a FIFO of bytes between a console, which sends bytes one by one, and a program that must not wait for the
 * console. It has one writer and one reader, both in the same context. */
#ifndef WH_STATION_RING_H
#define WH_STATION_RING_H

#include "core/number/flash.h"

typedef struct wh_ring {
    uint32_t put; /* numbers of bytes put and taken so far; put - taken bytes wait */
    uint32_t taken;
    uint32_t size; /* a power of two */
    char *bytes;   /* memory of the caller */
} wh_ring;

static inline uint32_t wh_ring_waiting(const wh_ring *ring) { return ring->put - ring->taken; }
static inline uint32_t wh_ring_room(const wh_ring *ring) {
    return ring->size - wh_ring_waiting(ring);
}

/* Put all bytes, or none if there is no room for all: half a line is useless. Returns true if they were put. */
bool wh_ring_put(wh_ring *ring, const char *bytes, uint32_t count);

/* Copy the oldest bytes, at most `room`, and return their number. The bytes stay until wh_ring_drop(). */
uint32_t wh_ring_peek(const wh_ring *ring, char *bytes, uint32_t room);
void wh_ring_drop(wh_ring *ring, uint32_t count);

#endif
