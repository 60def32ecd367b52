/* record.h: the record of a trip, readable later and also after a reset: as bytes, the same on every processor. */
#ifndef WH_RIG_RECORD_H
#define WH_RIG_RECORD_H

#include "phases.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Given to wh_rig_start() after a reset, it is latched again. */
typedef struct wh_trip_record {
    wh_trip trip;
    wh_rig_phase phase;
    uint32_t ticks; /* of a timer that a reset may have cleared since */
    wh_real speed_radps;
    wh_real volts;
    wh_real supply_V;
} wh_trip_record;

#define WH_TRIP_RECORD_BYTES 18U

#define wh_trip_record_put WH_NAME(wh_trip_record_put)
#define wh_trip_record_get WH_NAME(wh_trip_record_get)

/* Into bytes[WH_TRIP_RECORD_BYTES]. */
void wh_trip_record_put(const wh_trip_record *record, uint8_t *bytes);

/* False if the bytes are no record: another length, or an unknown trip or phase. */
bool wh_trip_record_get(wh_trip_record *record, const uint8_t *bytes, unsigned length);

#ifdef __cplusplus
}
#endif

#endif
