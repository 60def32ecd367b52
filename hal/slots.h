/* slots.h: the two infrared slot sensors on the rotor's slotted disc.
 *
 * Almesallmy (2006), I.1.1 and I.3.3.2: the slot is in line with the arms; sensor 1 stands on the
 * loading-train axis (theta = 0), sensor 2 90 degrees on in the sense of rotation. Amplifier, Schmitt
 * trigger and monostable make one pulse of each passing of the slot, at the slot's leading edge:
 * the arms are then still HAL_SLOT_LEAD_DEG short of the sensor. A timer captures both edges of the
 * pulse: the leading one tells where the rotor is, and how long it is high whether it is a pulse. */
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
    uint8_t sensor; /* 0: on the loading-train axis; 1: a quarter turn on */
    uint8_t end;    /* a hal_slot_end: of its pulse */
} hal_slot_edge;

/* Take the oldest edge not yet taken, in order of time. Returns false when there is none. At least 16, of 8 pulses, are kept
 * between calls; when more came, the newest are lost. Not from an interrupt: there is one who takes. Where edges
 * were lost, a pulse began unseen or was over at once, one of its two is missing; a board whose pulses are played, or that
 * cannot tell edges apart, has leading ones alone. */
bool hal_slots_take(hal_slot_edge *edge);

/* So often since the start edges were lost, or may have been: one came before the one ahead of it was read, or the room was
 * full. Then no more are looked at until one is taken, so that a storm of them takes no time: how many there were is not
 * known. */
uint32_t hal_slots_overruns(void);

#ifdef __cplusplus
}
#endif

#endif
