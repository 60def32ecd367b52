/* record.c: a trip's record as bytes. */
#include "record.h"

#include "core/frame.h"

void wh_trip_record_put(const wh_trip_record *record, uint8_t *bytes) {
    wh_bytes out = {.to = bytes, .room = WH_TRIP_RECORD_BYTES};
    wh_bytes_put(&out, (uint32_t)record->trip, 1);
    wh_bytes_put(&out, (uint32_t)record->phase, 1);
    wh_bytes_put(&out, record->ticks, 4);
    wh_bytes_put_float(&out, (float)record->speed_radps);
    wh_bytes_put_float(&out, (float)record->volts);
    wh_bytes_put_float(&out, (float)record->supply_V);
}

static bool is_trip(uint32_t number) {
#define IS(name, value, words) || number == (value)
    return number != (uint32_t)WH_TRIP_NONE && (false WH_TRIP_ROWS(IS));
#undef IS
}

bool wh_trip_record_get(wh_trip_record *record, const uint8_t *bytes, unsigned length) {
    wh_bytes in = {.from = bytes, .room = length};
    const uint32_t trip = wh_bytes_get(&in, 1);
    const uint32_t phase = wh_bytes_get(&in, 1);
    if (length != WH_TRIP_RECORD_BYTES || !is_trip(trip) || phase >= (uint32_t)WH_PHASES) {
        return false;
    }
    record->trip = (wh_trip)trip;
    record->phase = (wh_rig_phase)phase;
    record->ticks = wh_bytes_get(&in, 4);
    record->speed_radps = (wh_real)wh_bytes_get_float(&in);
    record->volts = (wh_real)wh_bytes_get_float(&in);
    record->supply_V = (wh_real)wh_bytes_get_float(&in);
    return true;
}
