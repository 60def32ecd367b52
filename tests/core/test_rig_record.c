/* test_rig_record.c: the record of a trip is read back as written; invalid bytes are refused. */
#include "core/rig/rig.h"

#include "draw.h"
#include "tests/suites.h"

static uint8_t bytes[WH_TRIP_RECORD_BYTES + 4U];
static uint64_t seed;

static const wh_trip trips[] = {
#define TRIP(name, number, words) name,
    WH_TRIP_ROWS(TRIP)
#undef TRIP
};
#define TRIPS (sizeof trips / sizeof trips[0])

/* Draws a number with the precision of a float, as the bytes have. */
static wh_real any(void) { return (wh_real)((float)(int32_t)draw_bits(&seed) * 1e-4f); }

static wh_trip_record draw_record(unsigned i) {
    return (wh_trip_record){.trip = trips[i % TRIPS],
                            .phase = (wh_rig_phase)draw_one_of(&seed, WH_PHASES),
                            .ticks = (uint32_t)draw_bits(&seed),
                            .speed_radps = any(),
                            .volts = any(),
                            .supply_V = any()};
}

static bool is_same(wh_real one, wh_real other) {
    return __builtin_memcmp(&one, &other, sizeof one) == 0;
}

TEST(rig_record, there_and_back) {
    seed = 5;
    for (unsigned i = 0; i < 20U * TRIPS; i++) {
        const wh_trip_record record = draw_record(i);
        wh_trip_record read = {.trip = WH_TRIP_NONE};
        wh_trip_record_put(&record, bytes);
        const bool is = wh_trip_record_get(&read, bytes, WH_TRIP_RECORD_BYTES);
        /* A record without a trip is not accepted. */
        TEST_ASSERT_TRUE(is == (record.trip != WH_TRIP_NONE));
        if (is) {
            TEST_ASSERT_TRUE(read.trip == record.trip && read.phase == record.phase);
            TEST_ASSERT_EQUAL_UINT32(record.ticks, read.ticks);
            TEST_ASSERT_TRUE(is_same(record.speed_radps, read.speed_radps));
            TEST_ASSERT_TRUE(is_same(record.volts, read.volts));
            TEST_ASSERT_TRUE(is_same(record.supply_V, read.supply_V));
        }
    }
}

static bool is_trip(unsigned number) {
    bool is = false;
    for (unsigned i = 0; i < TRIPS; i++) {
        is = is || (trips[i] != WH_TRIP_NONE && (unsigned)trips[i] == number);
    }
    return is;
}

TEST(rig_record, invalid_records_are_refused) {
    const wh_trip_record record = {.trip = WH_TRIP_OVERSPEED, .phase = WH_PHASE_RECORD};
    wh_trip_record read;
    wh_trip_record_put(&record, bytes);
    for (unsigned length = 0; length <= WH_TRIP_RECORD_BYTES + 1U; length++) {
        TEST_ASSERT_TRUE(wh_trip_record_get(&read, bytes, length) ==
                         (length == WH_TRIP_RECORD_BYTES));
    }
    for (unsigned number = 0; number < 256; number++) {
        bytes[0] = (uint8_t)number;
        TEST_ASSERT_TRUE(wh_trip_record_get(&read, bytes, WH_TRIP_RECORD_BYTES) == is_trip(number));
    }
    wh_trip_record_put(&record, bytes);
    for (unsigned phase = 0; phase < 256; phase++) {
        bytes[1] = (uint8_t)phase;
        TEST_ASSERT_TRUE(wh_trip_record_get(&read, bytes, WH_TRIP_RECORD_BYTES) ==
                         (phase < (unsigned)WH_PHASES));
    }
}
