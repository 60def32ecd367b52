/* pulses.h: stores the edges of slot pulses between the interrupt and the control loop. Included by slots.c or
 * slots_exti.c. */
#ifndef BOARDS_STM32F4_PULSES_H
#define BOARDS_STM32F4_PULSES_H

#include "hal/slots.h"
#include "ring.h"

#define EDGES_KEPT 16U

static hal_slot_edge kept_edges[EDGES_KEPT];
static stm32f4_ring_counts edge_counts;
static const stm32f4_ring edges = {&edge_counts, kept_edges, EDGES_KEPT, sizeof *kept_edges};
static volatile uint32_t overruns;

/* Stores an edge; the interrupt calls this. Returns false if there is no room, which counts as one overrun: the
 * interrupt then stays off until an edge is taken. */
static inline bool keep_edge(const hal_slot_edge *edge) {
    if (stm32f4_ring_put(&edges, edge) && stm32f4_ring_has_room(&edges)) {
        return true;
    }
    overruns++;
    return false;
}

#endif
