/* trip_memory.h: the record of a trip, kept during a reset (hal/reset.h). The next start latches the trip again. */
#ifndef PROGRAMS_TRIP_MEMORY_H
#define PROGRAMS_TRIP_MEMORY_H

#include <stddef.h>

#include "core/rig/rig.h"
#include "hal/reset.h"

_Static_assert(WH_TRIP_RECORD_BYTES <= HAL_REMEMBER_BYTES, "it is remembered whole");

/* Starts the rig: tripped if a trip's record has survived the reset, else idle. Copies that record to *kept. */
static inline void trip_memory_start(wh_trip_record *kept, const wh_rig_config *config, wh_rig *rig,
                                     uint32_t now_ticks) {
    uint8_t bytes[HAL_REMEMBER_BYTES];
    const bool tripped = wh_trip_record_get(kept, bytes, hal_recall(bytes));
    wh_rig_start(config, rig, now_ticks, tripped ? kept : NULL);
}

/* Remembers the record if it has changed. Call this after each control step. */
static inline void trip_memory_keep(wh_trip_record *kept, const wh_rig *rig) {
    const wh_trip_record *record = &rig->record;
    if (record->trip != kept->trip || record->ticks != kept->ticks) {
        uint8_t bytes[WH_TRIP_RECORD_BYTES];
        *kept = *record;
        wh_trip_record_put(record, bytes);
        hal_remember(bytes, record->trip != WH_TRIP_NONE ? (unsigned)sizeof bytes : 0U);
    }
}

#endif
