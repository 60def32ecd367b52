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

#ifdef __cplusplus
extern "C" {
#endif

/* Half the angle that the slot covers: 2 mm wide at a radius of 57.3 mm. */
#define HAL_SLOT_LEAD_DEG 1.0f

typedef enum hal_slot_end { HAL_SLOT_LEADING, HAL_SLOT_TRAILING } hal_slot_end;

typedef struct hal_slot_edge {
    uint32_t ticks; /* of the capture timer (clock.h) at the edge */
    uint8_t sensor; /* 0: on the loading-train axis; 1: a quarter turn later */
    uint8_t end;    /* a hal_slot_end: which end of the pulse this edge is */
} hal_slot_edge;

/* Take the oldest edge not yet taken, in order of time. Returns false if there is none. At least 16 edges (8 pulses)
 * are stored between calls; if more come, the newest are lost. Not from an interrupt: one reader only. One of a
 * pulse's two edges is missing if edges were lost, or if the pulse began unseen or was very short. A board with
 * simulated pulses, or one that cannot distinguish edges, gives only leading edges. */
bool hal_slots_take(hal_slot_edge *edge);

/* The number of times since the start that edges were lost, or may have been lost: an edge came before the previous
 * edge was read, or the memory was full. Capture then pauses until an edge is taken, so that a storm of edges takes no
 * computing time. The number of lost edges is unknown. */
uint32_t hal_slots_overruns(void);

#ifdef __cplusplus
}
#endif

#endif
