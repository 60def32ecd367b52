/* ring.h: a FIFO of bytes between a program and its console, so that neither waits. Not for use in interrupts. */
#ifndef WH_STATION_RING_H
#define WH_STATION_RING_H

#include "core/number/flash.h"

typedef struct wh_ring {
    uint32_t put;   /* number of bytes put since the start; wraps */
    uint32_t taken; /* number of bytes taken since the start; wraps */
    uint32_t size;  /* a power of two */
    char *bytes;    /* memory of the caller */
} wh_ring;

static inline uint32_t wh_ring_waiting(const wh_ring *ring) { return ring->put - ring->taken; }
static inline uint32_t wh_ring_room(const wh_ring *ring) {
    return ring->size - wh_ring_waiting(ring);
}

/* Puts all bytes and returns true. If they do not all fit, puts none and returns false. */
bool wh_ring_put(wh_ring *ring, const char *bytes, uint32_t count);

/* Copies the oldest bytes, at most `room`, and returns their number. The bytes stay until wh_ring_drop(). */
uint32_t wh_ring_peek(const wh_ring *ring, char *bytes, uint32_t room);
void wh_ring_drop(wh_ring *ring, uint32_t count);

#endif
