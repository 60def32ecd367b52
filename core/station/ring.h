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

#define wh_ring_put WH_NAME(wh_ring_put)
#define wh_ring_peek WH_NAME(wh_ring_peek)
#define wh_ring_drop WH_NAME(wh_ring_drop)

/* All of them, or none: what is half a line helps nobody. */
bool wh_ring_put(wh_ring *ring, const char *bytes, uint32_t count);

/* The oldest, `room` at most; returns how many. They stay until wh_ring_drop(). */
uint32_t wh_ring_peek(const wh_ring *ring, char *bytes, uint32_t room);
void wh_ring_drop(wh_ring *ring, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
