/* slots.h: the two infrared slot sensors on the rotor's slotted disc (Almesallmy 2006, I.1.1 and I.3.3.2). The slot is
 * in line with the arms. Sensor 1 is on the loading-train axis (theta = 0), sensor 2 is 90 degrees later in the sense
 * of rotation. A monostable makes one pulse for each passage of the slot. The pulse begins at the slot's leading edge,
 * when the arms are HAL_SLOT_LEAD_DEG before the sensor. A timer captures both edges of the pulse: the leading edge
 * gives the rotor's position, the length distinguishes pulses from noise. */
#ifndef HAL_SLOTS_H
#define HAL_SLOTS_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* half of the slot's angle; the slot is 2 mm wide at a radius of 57.3 mm */
#define HAL_SLOT_LEAD_DEG 1.0f

typedef enum hal_slot_end { HAL_SLOT_LEADING, HAL_SLOT_TRAILING } hal_slot_end;

typedef struct hal_slot_edge {
    uint32_t ticks; /* time on the capture timer (clock.h) */
    uint8_t sensor; /* 0: on the loading-train axis; 1: a quarter turn later */
    uint8_t end;    /* HAL_SLOT_LEADING or HAL_SLOT_TRAILING */
} hal_slot_edge;

/* Takes the oldest edge, or returns false. The queue holds 16 edges or more. If the queue is full, edges are lost. Do
 * not call this function from an interrupt. A pulse can lack an edge. Some boards give only leading edges. */
bool hal_slots_take(hal_slot_edge *edge);

/* Returns how often edges may have been lost. On the chips, a full queue pauses the capture until an edge is taken. */
uint32_t hal_slots_overruns(void);

WH_C_END

#endif
