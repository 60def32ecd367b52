/* test_station_odd.c: the station with a full queue, a trip, long input, a cell mounted in reverse, memory that cannot
 * be read, wrong arithmetic. */
#include <string.h>

#include "core/number/arithmetic.h"
#include "core/station/answer.h"
#include "draw.h"
#include "tel_bench.h"
#include "tests/suites.h"

static char heard[WH_STATION_OUT_BYTES + 1U];

static const char *hear(void) {
    const unsigned count = wh_station_peek(&bench.station, heard, sizeof heard - 1U);
    wh_station_drop(&bench.station, count);
    heard[count] = '\0';
    return heard;
}

static void check_begins(const char *with, const char *text) {
    TEST_ASSERT_EQUAL_STRING_LEN(with, text, strlen(with));
}

/* Other code has filled the queue of orders. An order of the console is then refused by number, and the next one is
 * accepted. */
TEST(station_odd, a_full_queue) {
    for (unsigned posted = 0; posted <= WH_RIG_ORDERS_MOST; posted++) {
        tel_begin();
        for (unsigned i = 0; i < posted; i++) {
            TEST_ASSERT_TRUE(wh_rig_post(&bench.even.rig, WH_EVENT_STOP, WH_R(0.0)));
        }
        tel_type("arm");
        wh_station_step(&bench.station, &bench.even.rig);
        const bool full = posted == WH_RIG_ORDERS_MOST;
        check_begins(full ? "ERR 16 too many commands at once" : "", hear());
        TEST_ASSERT_EQUAL_INT(!full, bench.station.waits);
        even_step(&bench.even);
        TEST_ASSERT_EQUAL_INT(full ? WH_RIG_IDLE : WH_RIG_ARMED, bench.even.rig.state);
        wh_station_step(&bench.station, &bench.even.rig);
        tel_type("arm");
        wh_station_step(&bench.station, &bench.even.rig);
        even_step(&bench.even);
        TEST_ASSERT_EQUAL_INT(WH_RIG_ARMED, bench.even.rig.state);
    }
}

/* A host is lost while the queue is full. The rig is notified once, in the first step with room. */
TEST(station_odd, lost_while_the_queue_is_full) {
    for (unsigned full_steps = 0; full_steps < 6U; full_steps++) {
        tel_begin();
        bench.station.host_given = true;
        bench.station.host_steps = 3;
        unsigned told = 0;
        unsigned first = 0;
        for (unsigned step = 1; step < 20U; step++) {
            bench.even.rig.orders = step < 4U + full_steps ? WH_RIG_ORDERS_MOST : 0U;
            wh_station_step(&bench.station, &bench.even.rig);
            if (bench.even.rig.orders == 1U) {
                told++;
                first = first == 0 ? step : first;
                TEST_ASSERT_EQUAL_INT(WH_EVENT_HOST_LOST, bench.even.rig.order[0].event);
            }
        }
        TEST_ASSERT_EQUAL_UINT(1, told);
        TEST_ASSERT_EQUAL_UINT(1, bench.station.host_losses);
        TEST_ASSERT_EQUAL_UINT(4U + full_steps, first);
        wh_station_take(&bench.station, "x", 0); /* a byte, then silence */
        TEST_ASSERT_TRUE(bench.station.silent_steps > 0);
        wh_station_take(&bench.station, "x", 1);
        TEST_ASSERT_TRUE(bench.station.silent_steps == 0);
    }
}

/* If telemetry is on as text, a trip is reported with its cause. `fault` prints only the record of the present trip. */
TEST(station_odd, trips_are_reported) {
#define NAME(name, number, words) name,
    static const wh_trip trips[] = {WH_TRIP_ROWS(NAME)};
#undef NAME
    for (unsigned i = 1; i < sizeof trips / sizeof trips[0]; i++) {
        const wh_trip trip = trips[i];
        tel_begin();
        tel_type("talk on");
        wh_station_step(&bench.station, &bench.even.rig);
        (void)hear();
        bench.even.rig.guard.trip = trip;
        bench.even.rig.state = WH_RIG_TRIPPED;
        bench.even.rig.record.trip = WH_TRIP_NONE;
        wh_station_step(&bench.station, &bench.even.rig);
        char wanted[120] = "# tripped: ";
        wh_text text;
        wh_text_start(&text, wanted + 11, sizeof wanted - 11U);
        wh_text_add(&text, wh_trip_text(trip));
        wh_text_add(&text, "\r\n");
        TEST_ASSERT_EQUAL_STRING(wanted, hear());
        for (unsigned known = 0; known < 2U; known++) {
            bench.even.rig.record.trip = known == 1U ? trip : WH_TRIP_NONE;
            tel_type("fault");
            wh_station_step(&bench.station, &bench.even.rig);
            TEST_ASSERT_NOT_NULL(strstr(hear(), "OK trip="));
            TEST_ASSERT_EQUAL_INT(known == 1U, strstr(heard, " supply_V=") != NULL);
        }
    }
}

/* Keys without effect are not echoed: characters beyond the line's room, or backspace in an empty line. */
TEST(station_odd, echo) {
    tel_begin();
    tel_type("talk on");
    wh_station_step(&bench.station, &bench.even.rig);
    (void)hear();
    unsigned long told = 0;
    for (unsigned i = 0; i < 3U * WH_LINE_MOST; i++) {
        wh_station_take(&bench.station, "a", 1);
        wh_station_step(&bench.station, &bench.even.rig);
        told += strlen(hear());
    }
    TEST_ASSERT_EQUAL_UINT(WH_LINE_MOST, told);
    wh_station_take(&bench.station, "\n", 1);
    wh_station_step(&bench.station, &bench.even.rig);
    TEST_ASSERT_NOT_NULL(strstr(hear(), "ERR 101 "));
    wh_station_take(&bench.station, "\b", 1);
    wh_station_step(&bench.station, &bench.even.rig);
    TEST_ASSERT_EQUAL_STRING("", hear());
}

static wh_probed spoilt;

static void compute_otherwise(wh_real *result) {
    wh_arithmetic(result);
    if (spoilt < WH_PROBED_COUNT) {
        result[spoilt] += WH_R(1.0);
    }
}

/* The self-test checks the arithmetic of the observer's scene. Without an observer, or without the check in its scene,
 * it passes. */
TEST(station_odd, arithmetic_is_tested) {
    wh_scene scene = {.name = "none"};
    for (unsigned i = 0; i <= WH_PROBED_COUNT + 2U; i++) {
        tel_begin();
        even_step(&bench.even);
        bench.even.config.observer.scene = i == 0 ? NULL : &scene;
        scene.arithmetic = i <= 1U ? NULL : compute_otherwise;
        spoilt = (wh_probed)(i >= 2U ? i - 2U : 0U);
        const bool good = i < 2U || spoilt == WH_PROBED_COUNT;
        /* There was no sample, so the cell's part is not good. */
        bench.seen = (wh_step_inputs){.inputs = bench.even.inputs};
        wh_station_see(&bench.station, &bench.even.config, &bench.even.rig, &bench.seen);
        tel_type("selftest");
        wh_station_step(&bench.station, &bench.even.rig);
        check_begins(good ? "OK selftest=good arithmetic=good " : "OK selftest=bad arithmetic=bad ",
                     hear());
        TEST_ASSERT_NOT_NULL(strstr(heard, " cell=good "));
    }
}

static void own_turned(wh_rig_config *config) {
    *config = even_config();
    config->measure.cell.newton_per_count = -config->measure.cell.newton_per_count;
}

/* On this board the cell is mounted in reverse: the board's own configuration has a negative scale; the setting has
 * none. */
TEST(station_odd, a_cell_turned_round) {
    static wh_conf conf;
    wh_rig_config config;
    wh_conf_start(&conf, own_turned, NULL, &config);
    TEST_ASSERT_TRUE(conf.standard[WH_CONF_cell_reversed] == WH_R(1.0));
    TEST_ASSERT_TRUE(conf.standard[WH_CONF_cell_scale] > WH_R(0.0));
    TEST_ASSERT_TRUE(config.measure.cell.newton_per_count < WH_R(0.0));
    TEST_ASSERT_TRUE(wh_conf_type(&conf, WH_CONF_cell_scale, "20") == WH_STATION_FINE);
    CHECK_NEAR(1e-7f, -0.02f, config.measure.cell.newton_per_count);
    TEST_ASSERT_TRUE(wh_conf_type(&conf, WH_CONF_cell_reversed, "off") == WH_STATION_FINE);
    CHECK_NEAR(1e-7f, 0.02f, config.measure.cell.newton_per_count);
    TEST_ASSERT_TRUE(wh_conf_type(&conf, WH_CONF_cell_reversed, "") == WH_STATION_CONF_VALUE);
}

static uint8_t slot_bytes[WH_STORE_SLOTS][WH_STORE_SLOT_BYTES];
static unsigned reads_left;

static bool erase_slot(unsigned slot) {
    memset(slot_bytes[slot], 0xFF, WH_STORE_SLOT_BYTES);
    return true;
}
static bool write_slot(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    memcpy(slot_bytes[slot] + at, bytes, count);
    return true;
}
static bool read_slot(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    if (reads_left == 0) {
        return false;
    }
    reads_left--;
    memcpy(bytes, slot_bytes[slot] + at, count);
    return true;
}

/* If a setting cannot be read back, it is reported as not saved, whichever read fails. */
TEST(station_odd, a_memory_that_is_not_read) {
    static const wh_store_memory memory = {erase_slot, write_slot, read_slot};
    static wh_conf conf;
    wh_rig_config config;
    unsigned failed = 0;
    wh_station_error status = WH_STATION_CONF_FAILED;
    for (unsigned reads = 0; reads < 100U && status != WH_STATION_FINE; reads++) {
        memset(slot_bytes, 0xFF, sizeof slot_bytes);
        reads_left = UINT16_MAX;
        wh_conf_start(&conf, own_turned, &memory, &config);
        TEST_ASSERT_TRUE(wh_conf_save(&conf) == WH_STATION_FINE);
        reads_left = reads;
        status = wh_conf_save(&conf);
        failed += status == WH_STATION_CONF_FAILED ? 1U : 0U;
        TEST_ASSERT_TRUE(status == WH_STATION_CONF_FAILED || conf.sequence == 2U);
        reads_left = 0;
        wh_conf_start(&conf, own_turned, &memory, &config);
        TEST_ASSERT_TRUE(conf.sequence == 0U);
        for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
            TEST_ASSERT_TRUE(conf.value[id] == conf.standard[id]);
        }
    }
    TEST_ASSERT_TRUE(status == WH_STATION_FINE && failed > 3U);
}

/* Whole numbers are printed without a point. Text without room is cut, and `truncated` is set. */
TEST(station_odd, exact_numbers) {
    bench.seed = 64;
    for (unsigned i = 0; i < 2000U; i++) {
        const uint32_t whole = (uint32_t)draw_bits(&bench.seed) >> draw_one_of(&bench.seed, 32) &
                               UINT32_C(0xFFFFFF00); /* a number that a float represents exactly */
        char bytes[40];
        char wanted[40];
        wh_text text;
        wh_text_start(&text, wanted, sizeof wanted);
        wh_text_add(&text, " n=");
        wh_text_add_unsigned(&text, whole);
        const wh_value value = {.number = (wh_real)whole};
        const unsigned length = text.length;
        const unsigned size = 1U + draw_one_of(&bench.seed, sizeof bytes);
        wh_text_start(&text, bytes, size);
        wh_answer(&text, " n=@e", &value);
        if (size > length + 10U) {
            TEST_ASSERT_EQUAL_STRING(wanted, bytes);
            TEST_ASSERT_FALSE(text.truncated);
        }
        TEST_ASSERT_TRUE(text.truncated || strcmp(wanted, bytes) == 0);
        TEST_ASSERT_TRUE(text.length < size && bytes[text.length] == '\0');
    }
}
