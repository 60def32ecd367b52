/* test_telemetry.c: frames beside the console's text: all events are in them or counted, and the rig acts as without telemetry. */
#include <string.h>

#include "core/cobs.h"
#include "draw.h"
#include "tel_bench.h"
#include "tests/suites.h"

static even_rig twin;

TEST(telemetry, sum) {
    const uint8_t digits[9] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    TEST_ASSERT_EQUAL_HEX16(0x29B1, wh_crc16(WH_CRC16_START, digits, 9));
    TEST_ASSERT_EQUAL_HEX16(0x29B1, wh_crc16(wh_crc16(WH_CRC16_START, digits, 4), digits + 4, 5));
}

TEST(telemetry, coding) {
    bench.seed = 40;
    uint8_t bytes[WIRE_CHUNK];
    uint8_t back[WIRE_CHUNK];
    for (unsigned i = 0; i < 3000U; i++) {
        const unsigned count = draw_one_of(&bench.seed, 290);
        const unsigned kind = draw_one_of(&bench.seed, 3);
        wh_cobs cobs;
        memset(&bench.heard, 0, sizeof bench.heard);
        wh_cobs_start(&cobs, bench.heard.chunk, sizeof bench.heard.chunk);
        for (unsigned k = 0; k < count; k++) {
            const uint8_t byte = (uint8_t)draw_bits(&bench.seed);
            bytes[k] = kind == 0 ? byte : kind == 1U ? (uint8_t)(byte & 1U) : (uint8_t)(byte | 1U);
            wh_cobs_put(&cobs, bytes[k]);
        }
        const unsigned length = wh_cobs_end(&cobs);
        TEST_ASSERT_TRUE(length > count && length <= WH_COBS_BYTES(count));
        TEST_ASSERT_TRUE(memchr(bench.heard.chunk, 0, length) == bench.heard.chunk + length - 1U);
        if (count <= WH_COBS_SHORT_MOST) {
            memcpy(back + 1, bytes, count);
            TEST_ASSERT_EQUAL_UINT(length, wh_cobs_short(back, count));
            TEST_ASSERT_TRUE(memcmp(back, bench.heard.chunk, length) == 0);
        }
        bench.heard.count = length - 1U;
        TEST_ASSERT_EQUAL_UINT(count, wire_without_codes(&bench.heard, back));
        TEST_ASSERT_TRUE(memcmp(bytes, back, count) == 0);
        TEST_ASSERT_EQUAL_UINT(count, wh_cobs_decode(bench.heard.chunk, length - 1U));
        TEST_ASSERT_TRUE(memcmp(bytes, bench.heard.chunk, count) == 0);
    }
}

TEST(telemetry, off_at_first_and_after) {
    bench.seed = 41;
    tel_begin();
    for (unsigned i = 0; i < 600U; i++) {
        if (i % 100U == 0) {
            tel_type("status");
        }
        tel_period(false, 0);
    }
    char bytes[WH_STATION_OUT_BYTES];
    unsigned count = wh_station_peek(&bench.station, bytes, sizeof bytes);
    wh_station_drop(&bench.station, count);
    TEST_ASSERT_TRUE(count > 400U && memchr(bytes, 0, count) == NULL);
    tel_turn_on("tel rate 500");
    for (unsigned i = 0; i < 100U; i++) {
        tel_period(true, FREE);
    }
    TEST_ASSERT_TRUE(bench.got.frames > 9U);
    tel_type("tel off");
    tel_period(true, FREE);
    const unsigned frames = bench.got.frames;
    for (unsigned i = 0; i < 100U; i++) {
        tel_period(true, FREE);
    }
    TEST_ASSERT_EQUAL_UINT(frames, bench.got.frames);
}

/* Every sample and pulse, for any converter's status, at each rate and delay, of 12 to 24 bits. */
TEST(telemetry, all_that_was_seen) {
    static const char *const rates[] = {"tel rate 500", "tel rate 250", "tel rate 100",
                                        "tel rate 20"};
    bench.seed = 42;
    for (unsigned round = 0; round < 24U; round++) {
        const bool evenly = round % 2U == 0;
        const unsigned which = round / 6U;
        tel_begin();
        bench.even.config.measure.cell.raw_max = (int32_t)(1 << (11 + round % 13)) - 1;
        bench.even.config.measure.cell.delay_ticks = draw_one_of(&bench.seed, 5000);
        bench.got.uneven = !evenly && which > 0;
        tel_turn_on(rates[which]);
        for (unsigned i = 0; i < 4000U; i++) {
            tel_period(evenly, FREE);
        }
        TEST_ASSERT_EQUAL_UINT(0, bench.got.gaps + bench.got.dropped + bench.heard.bad);
        TEST_ASSERT_EQUAL_UINT(bench.pulses.put, bench.pulses.taken);
        if (which == 0) {
            TEST_ASSERT_TRUE(bench.samples.put - bench.samples.taken <= WH_TEL_SAMPLES);
            TEST_ASSERT_TRUE(bench.got.loads + WH_TEL_SAMPLES >= bench.samples.put - 1U);
        }
        TEST_ASSERT_TRUE(!evenly ||
                         bench.got.loads >= 4000U / bench.tel.every - 2U * WH_TEL_SAMPLES);
    }
}

/* A 115,200 baud line carries it with room to spare. A slow one does not, and every loss is counted; answers come. */
TEST(telemetry, losses_are_counted) {
    static const unsigned baud[] = {115200, 57600, 38400, 19200, 9600, 4800};
    bench.seed = 43;
    for (unsigned k = 0; k < 6U; k++) {
        tel_begin();
        tel_turn_on("tel rate 500");
        unsigned asked = 0;
        unsigned credit = 0;
        for (unsigned i = 0; i < 10000U; i++) {
            credit += baud[k] / 10U; /* a byte is ten bits, a second 500 steps */
            if (i % 500U == 250U) {
                tel_type("fault");
                asked++;
            }
            tel_period(true, credit / STEPS_PER_S);
            credit %= STEPS_PER_S;
        }
        for (unsigned i = 0; i < 20U; i++) { /* the last report is complete once all others are */
            tel_period(true, FREE);
        }
        TEST_ASSERT_EQUAL_UINT(0, bench.heard.bad);
        TEST_ASSERT_EQUAL_UINT(bench.got.dropped, bench.got.gaps);
        TEST_ASSERT_TRUE((baud[k] <= 19200U) == (bench.got.dropped > 0));
        TEST_ASSERT_EQUAL_UINT(0, bench.station.lost_answers);
        unsigned told = 0;
        for (const char *at = strstr(bench.heard.text, "OK trip=0 ended=none: no fault\r\n");
             at != NULL; at = strstr(at + 1, "OK trip=0 ended=none: no fault\r\n")) {
            told++;
        }
        TEST_ASSERT_EQUAL_UINT(asked, told);
    }
}

/* A pulse and an end in each step, more than a 115,200 baud line takes: ends are dropped, loads are not. */
TEST(telemetry, ends_give_way) {
    bench.seed = 47;
    tel_begin();
    bench.got.blind = true;
    tel_turn_on("tel rate 500");
    for (unsigned i = 0; i < 5000U; i++) {
        even_step(&bench.even);
        tel_draw_seen(true);
        bench.seen.pulsed = bench.seen.ended = true;
        tel_step();
        tel_hear(23);
    }
    TEST_ASSERT_EQUAL_UINT(0, bench.tel.dropped[WH_TEL_RUN]);
    TEST_ASSERT_TRUE(bench.tel.dropped[WH_TEL_EVENT] > 1000U);
}

/* Bytes that the line breaks, loses or invents: each frame is as sent or missing, and text is whole after the next zero. */
TEST(telemetry, a_bad_line) {
    bench.seed = 44;
    tel_begin();
    bench.got.broken = true;
    tel_turn_on("tel rate 500");
    for (unsigned i = 0; i < 20000U; i++) {
        char bytes[WH_STATION_OUT_BYTES];
        even_step(&bench.even);
        tel_draw_seen(true);
        tel_step();
        const unsigned count = wh_station_peek(&bench.station, bytes, sizeof bytes);
        wh_station_drop(&bench.station, count);
        for (unsigned k = 0; k < count; k++) {
            wire_frame frame;
            const unsigned fate = draw_one_of(&bench.seed, 300);
            const uint8_t byte =
                (uint8_t)(fate == 0 ? (uint8_t)bytes[k] ^ 1U << draw_one_of(&bench.seed, 8)
                                    : (uint8_t)bytes[k]);
            if (fate != 1U && wire_take(&bench.heard, byte, &frame)) {
                tel_hear_frame(&frame); /* its samples are found */
            }
            if (fate == 2U && wire_take(&bench.heard, (uint8_t)draw_bits(&bench.seed), &frame)) {
                tel_hear_frame(&frame);
            }
        }
    }
    TEST_ASSERT_TRUE(bench.got.frames > 1200U && bench.got.gaps > 100U && bench.heard.bad > 100U);
    TEST_ASSERT_EQUAL_UINT(0, bench.got.dropped);
}

/* A reader comes, goes, returns and types. A second rig without a reader gives the same commands. */
TEST(telemetry, control_is_undisturbed) {
    bench.seed = 45;
    tel_begin();
    tel_turn_on("tel rate 500");
    bench.got.blind = true;
    tel_type("tel ring fault");
    tel_type("arm");
    for (unsigned i = 0; i < 3U; i++) {
        tel_period(true, FREE);
    }
    tel_type("start 330");
    tel_period(true, 0);
    tel_period(true, 0);
    TEST_ASSERT_TRUE(bench.even.rig.state == WH_RIG_RUNNING);
    twin = bench.even;
    bool reads = true;
    while (!even_is_over(&bench.even)) {
        reads = draw_one_in(&bench.seed, 400) ? !reads : reads;
        if (draw_one_in(&bench.seed, 300)) {
            tel_type("measure");
        }
        tel_period(draw_one_in(&bench.seed, 2), reads ? AT_115200 : 0);
        even_step(&twin);
        TEST_ASSERT_TRUE(memcmp(&bench.even.command, &twin.command, sizeof bench.even.command) ==
                         0);
        TEST_ASSERT_EQUAL_UINT(wh_rig_stage(&twin.rig), wh_rig_stage(&bench.even.rig));
    }
    TEST_ASSERT_TRUE(even_is_done(&bench.even) && bench.tel.dropped[WH_TEL_RUN] > 50U &&
                     bench.got.frames > 300U);
    TEST_ASSERT_EQUAL_UINT(0, bench.heard.bad);
}

TEST(telemetry, states_are_told) {
    bench.seed = 46;
    tel_begin();
    tel_turn_on("tel rate 500");
    tel_type("arm");
    tel_period(true, FREE);
    tel_type("start 330");
    unsigned stage = WH_RIG_ARMED;
    unsigned told = 0;
    unsigned fast = 0;
    for (unsigned i = 0; i < 60000U && !(told > 3U && even_is_over(&bench.even)); i++) {
        char bytes[WH_STATION_OUT_BYTES];
        const unsigned before = wh_rig_shown_stage(&bench.even.rig);
        even_step(&bench.even);
        tel_draw_seen(true);
        tel_step();
        const unsigned count = wh_station_peek(&bench.station, bytes, sizeof bytes);
        wh_station_drop(&bench.station, count);
        bool changed = false;
        for (unsigned k = 0; k < count; k++) {
            wire_frame frame;
            if (!wire_take(&bench.heard, (uint8_t)bytes[k], &frame)) {
                continue;
            }
            if (frame.channel == WH_TEL_EVENT && frame.payload[0] == WH_TEL_STATE) {
                changed = true;
                told++;
                stage = frame.payload[1];
                TEST_ASSERT_EQUAL_UINT(wh_rig_shown_stage(&bench.even.rig), stage);
                TEST_ASSERT_EQUAL_UINT32(bench.even.inputs.now_ticks, frame.ticks);
            }
            if (frame.channel == WH_TEL_RUN && bench.even.rig.run.phase == WH_PHASE_RECORD) {
                const float rpm = (float)wire_number(frame.payload, 2) * 0.02f;
                const float drive_V = (float)wire_number(frame.payload + 2, 2) * 0.001f;
                TEST_ASSERT_FLOAT_WITHIN(
                    0.011f, (float)(bench.even.rig.pulses.speed.turn_radps * WH_R(9.549296585)),
                    rpm);
                TEST_ASSERT_FLOAT_WITHIN(0.00051f, (float)bench.even.rig.command.volts, drive_V);
                TEST_ASSERT_EQUAL_UINT(WH_RIG_STAGE_OF_PHASE + WH_PHASE_RECORD, frame.payload[4]);
                fast++;
            }
        }
        TEST_ASSERT_TRUE(changed || i < 3U || wh_rig_shown_stage(&bench.even.rig) == before);
    }
    TEST_ASSERT_TRUE(told >= 8U && fast > 80U);
}
