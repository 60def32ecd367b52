/* slots.h: the two infrared slot sensors on the rotor's slotted disc.
 * Almesallmy (2006), I.1.1 and I.3.3.2: the slot is in line with the arms. Sensor 1 is on the loading-train axis
 * (theta = 0), sensor 2 is 90 degrees later in the sense of rotation. Amplifier, Schmitt trigger and monostable make
 * one pulse for each passage of the slot. The pulse begins at the slot's leading edge, when the arms are
 * HAL_SLOT_LEAD_DEG before the sensor. A timer captures both edges of the pulse. The leading edge gives the rotor's
 * position; the length distinguishes pulses from noise. */
#ifndef HAL_SLOTS_H
#define HAL_SLOTS_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Half of the angle that the slot covers: the slot is 2 mm wide at a radius of 57.3 mm. */
#define HAL_SLOT_LEAD_DEG 1.0f

typedef enum hal_slot_end { HAL_SLOT_LEADING, HAL_SLOT_TRAILING } hal_slot_end;

typedef struct hal_slot_edge {
    uint32_t ticks; /* time of the edge on the capture timer (clock.h) */
    uint8_t sensor; /* 0: on the loading-train axis; 1: a quarter turn later */
    uint8_t end;    /* HAL_SLOT_LEADING or HAL_SLOT_TRAILING */
} hal_slot_edge;

/* Take the oldest edge that was not taken before. Returns false if there is none. At least 16 edges (8 pulses) are
 * stored between two calls; if more come, the newest are lost. Do not call it from an interrupt: the queue has one
 * reader only.
 *
 * A pulse may lack one of its two edges, if edges were lost, if the pulse began unseen, or if it was very short. A
 * board that simulates pulses, or cannot distinguish edges, gives only leading edges. */
bool hal_slots_take(hal_slot_edge *edge);

/* Returns the number of times since the start that edges were lost, or may have been lost: an edge came before the
 * previous edge was read, or the memory was full. Capture then pauses until an edge is taken, so that a storm of edges
 * takes no computing time. The number of lost edges is unknown. */
uint32_t hal_slots_overruns(void);

WH_C_END

#endif
