/* test_telemetry.c: telemetry: its commands, and the ring of records. */
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

TEST(telemetry, telemetry_is_off_unless_enabled) {
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

/* Every sample and pulse is received: with any status of the converter, at each rate and delay, for converters of 12 to
 * 24 bits. */
TEST(telemetry, every_sample_and_pulse_arrives) {
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

/* A line of 115,200 baud transmits everything. On a slow line frames are lost, and each loss is counted; the console's
 * answers still come. */
TEST(telemetry, losses_are_counted) {
    static const unsigned baud[] = {115200, 57600, 38400, 19200, 9600, 4800};
    bench.seed = 43;
    for (unsigned k = 0; k < 6U; k++) {
        tel_begin();
        tel_turn_on("tel rate 500");
        unsigned asked = 0;
        unsigned credit = 0;
        for (unsigned i = 0; i < 10000U; i++) {
            credit += baud[k] / 10U; /* a byte is ten bits, and a second has 500 steps */
            if (i % 500U == 250U) {
                tel_type("fault");
                asked++;
            }
            tel_period(true, credit / STEPS_PER_S);
            credit %= STEPS_PER_S;
        }
        for (unsigned i = 0; i < 20U; i++) {
            /* the last count of losses is complete when all other frames have been sent */
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

/* Each step has a begin and an end of a pulse, more than 115,200 baud can transmit. Ends are dropped, samples are
 * not. */
TEST(telemetry, pulse_ends_are_dropped_first) {
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

/* The line corrupts, loses or inserts bytes. Each frame is received as sent or not at all, and text is complete after
 * the next zero. */
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
                /* the receiver compares the frame's samples with the sent ones */
                tel_hear_frame(&frame);
            }
            if (fate == 2U && wire_take(&bench.heard, (uint8_t)draw_bits(&bench.seed), &frame)) {
                tel_hear_frame(&frame);
            }
        }
    }
    TEST_ASSERT_TRUE(bench.got.frames > 1200U && bench.got.gaps > 100U && bench.heard.bad > 100U);
    TEST_ASSERT_EQUAL_UINT(0, bench.got.dropped);
}

/* A terminal is connected, disconnected and connected again, and its user types. The rig must give the same commands as
 * a second rig without a terminal. */
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

TEST(telemetry, states_are_sent) {
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
                CHECK_NEAR(0.011f, bench.even.rig.pulses.speed.turn_radps * WH_R(9.549296585), rpm);
                CHECK_NEAR(0.00051f, bench.even.rig.command.volts, drive_V);
                TEST_ASSERT_EQUAL_UINT(WH_RIG_STAGE_OF_PHASE + WH_PHASE_RECORD, frame.payload[4]);
                fast++;
            }
        }
        TEST_ASSERT_TRUE(changed || i < 3U || wh_rig_shown_stage(&bench.even.rig) == before);
    }
    TEST_ASSERT_TRUE(told >= 8U && fast > 80U);
}

/* === telemetry ring ========================================================================== */

static wh_captured truth[4096];
static uint32_t truth_ticks[4096];

/* Does a period of telemetry and records it as step `at` of the reference. */
static void note_period(unsigned at, unsigned bytes) {
    tel_period(true, bytes);
    truth_ticks[at] = bench.seen.inputs.now_ticks;
    truth[at] =
        (wh_captured){.ticks = (uint16_t)bench.seen.inputs.now_ticks,
                      .load = (int16_t)bench.samples.value[(bench.samples.put - 1U) % TRUTHS],
                      .drive_mV = (uint16_t)((float)bench.even.rig.command.volts * 1000.0f + 0.5f),
                      .flags = (uint8_t)((bench.seen.pulsed ? 1U << bench.seen.sensor : 0U) |
                                         (bench.even.rig.guard.trip != WH_TRIP_NONE ? 8U : 0U)),
                      .stage = (uint8_t)wh_rig_stage(&bench.even.rig)};
}

/* Checks that all recorded steps are read back in order, with the trigger at the right place. */
static void check_read(unsigned end, bool by_pulse) {
    unsigned row = 0;
    unsigned from = end;
    bool first = true;
    unsigned triggers = 0;
    tel_type("tel ring read");
    even_step(&bench.even);
    wh_station_step(&bench.station, &bench.even.rig);
    for (unsigned i = 0;
         i < 1000U && (bench.tel.reads || bench.station.out.put != bench.station.out.taken); i++) {
        char bytes[AT_115200];
        bench.seen = (wh_step_inputs){.inputs = bench.even.inputs};
        wh_station_see(&bench.station, &bench.even.config, &bench.even.rig, &bench.seen);
        const unsigned count = wh_station_peek(&bench.station, bytes, sizeof bytes);
        wh_station_drop(&bench.station, count);
        for (unsigned k = 0; k < count; k++) {
            wire_frame frame;
            if (!wire_take(&bench.heard, (uint8_t)bytes[k], &frame) ||
                frame.channel != WH_TEL_RING) {
                continue;
            }
            for (unsigned at = 0; at < frame.count; at += 8U, row++) {
                const uint8_t *step = frame.payload + at;
                if (first) {
                    from = 0;
                    while (from < end && truth_ticks[from] != frame.ticks) {
                        from++;
                    }
                    first = false;
                }
                const wh_captured *is = &truth[from + row];
                TEST_ASSERT_TRUE(from + row < end);
                TEST_ASSERT_EQUAL_HEX16(is->ticks, wire_number(step, 2));
                TEST_ASSERT_TRUE(at > 0 || truth_ticks[from + row] == frame.ticks);
                TEST_ASSERT_EQUAL_HEX16((uint16_t)is->load, wire_number(step + 2, 2));
                TEST_ASSERT_UINT16_WITHIN(1, is->drive_mV, (uint16_t)wire_number(step + 4, 2));
                TEST_ASSERT_EQUAL_HEX8(is->flags, step[6] & 0xFBU);
                TEST_ASSERT_EQUAL_HEX8(is->stage, step[7]);
                if ((step[6] & 4U) != 0) {
                    triggers++;
                    TEST_ASSERT_TRUE(by_pulse ? (step[6] & 3U) != 0 : (step[6] & 8U) != 0);
                    TEST_ASSERT_EQUAL_UINT(bench.tel.capture.count - WH_CAPTURE_STEPS / 2U, row);
                }
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT(1, triggers);
    TEST_ASSERT_EQUAL_UINT(bench.tel.capture.count, row);
    TEST_ASSERT_NULL(strstr(bench.heard.text, "ERR "));
    TEST_ASSERT_EQUAL_UINT(0, bench.heard.bad + bench.tel.dropped[WH_TEL_RUN] +
                                  bench.tel.dropped[WH_TEL_RING]);
}

TEST(telemetry_ring, ring_has_the_recorded_values) {
    bench.seed = 47;
    for (unsigned round = 0; round < 20U; round++) {
        const bool by_pulse = round % 2U == 0;
        tel_begin();
        tel_type(by_pulse ? "tel ring pulse" : "tel ring fault");
        tel_period(true, FREE);
        const unsigned wait = draw_one_of(&bench.seed, 900);
        unsigned at = 0;
        for (; at < 4000U && bench.tel.capture.state != WH_CAPTURE_FULL; at++) {
            if (at == wait && !by_pulse) {
                wh_guard_trip(&bench.even.rig.guard, WH_TRIP_PULSES);
            }
            note_period(at, FREE);
        }
        TEST_ASSERT_TRUE(bench.tel.capture.state == WH_CAPTURE_FULL);
        TEST_ASSERT_TRUE(by_pulse || bench.tel.capture.count == (wait < 96U ? wait + 96U : 192U));
        check_read(at, by_pulse);
        check_read(at, by_pulse); /* reading does not empty the ring */
    }
}

TEST(telemetry_ring, text_for_plotters) {
    bench.seed = 48;
    for (unsigned which = 0; which < 2U; which++) {
        tel_begin();
        tel_type(which == 0 ? "tel fmt teleplot" : "tel fmt arduino");
        tel_type("tel rate 100");
        for (unsigned i = 0; i < 100U; i++) {
            tel_period(true, AT_115200);
        }
        wire_frame frame;
        (void)wire_take(&bench.heard, 0, &frame);
        TEST_ASSERT_EQUAL_UINT(0, bench.got.frames);
        const char *line = strstr(bench.heard.text, which == 0 ? ">load_N:" : "load_N:");
        unsigned lines = 0;
        TEST_ASSERT_NOT_NULL(line);
        for (; line != NULL && lines < 15U; lines++) {
            const char *end = strstr(line, "\r\n");
            TEST_ASSERT_NOT_NULL(end);
            const char *value = strchr(line, ':') + 1;
            TEST_ASSERT_TRUE(value < end &&
                             strspn(value, "-0123456789.,:abcdefghijklmnopqrstuvwxyz_VN") ==
                                 (size_t)(end - value));
            line = end[2] != '\0' ? end + 2 : NULL;
        }
        TEST_ASSERT_TRUE(lines >= 15U);
        if (which == 1U) {
            TEST_ASSERT_NOT_NULL(strstr(bench.heard.text, ",speed_rpm:0.00,drive_V:0.000\r\n"));
        } else {
            TEST_ASSERT_NOT_NULL(
                strstr(bench.heard.text, "\r\n>speed_rpm:0.00\r\n>drive_V:0.000\r\n"));
        }
    }
}

TEST(telemetry_ring, answers_and_refusals) {
    static const struct {
        const char *line;
        const char *answer;
    } rows[] = {
        {"tel", "ERR 115 "},
        {"tel on", "ERR 115 "},
        {"tel schema", "ERR 115 "},
        {"tel rate", "ERR 115 "},
        {"tel list all", "ERR 115 "},
        {"tel ring twice", "ERR 115 "},
        {"tel ring off now", "ERR 102 "},
        {"tel rate 0", "ERR 116 "},
        {"tel rate 501", "ERR 116 "},
        {"tel rate 300", "ERR 116 "},
        {"tel rate 2.5", "ERR 116 "},
        {"tel rate -5", "ERR 116 "},
        {"tel rate all", "ERR 116 "},
        {"tel schema 7", "ERR 117 "},
        {"tel fmt csv", "ERR 118 "},
        {"tel ring read", "ERR 119 "},
        {"tel list", "OK rate=0 fmt=frames dropped=0 channels=run,event,ring"
                     "\r\n"},
        {"tel ring", "OK trigger=off ring=off steps=0 frames=0\r\n"},
        {"tel ring pulse", "OK trigger=pulse ring=waiting steps=0 frames=0\r\n"},
        {"tel ring off", "OK trigger=off ring=off "},
        {"tel schema run",
         "OK channel=0 name=run period_ticks=2000 once=speed[rpm]:u2:0.02,drive[V]:u2:0.001,"
         "state:u1:1 each=load[N]:i2:0.0"},
        {"tel schema event",
         "OK channel=1 name=event period_ticks=0 once=what:u1:1,value:u1:1 each=: what"},
        {"tel schema ring", "OK channel=2 name=ring period_ticks=0 once= each=ticks:u2:1,load"},
        {"tel schema states",
         "OK 0=idle 1=armed 2=running 3=stopping 4=tripped 9=tare 10=spin_up 11=ramp "
         "12=settle 13=record 14=ramp_down 15=coast 16=brake\r\n"},
        {"tel fmt arduino", "OK fmt=arduino\r\n"},
        {"tel rate 500", "ERR 116 "},
        {"tel rate 1", "OK rate=1 period_ticks=1000000\r\n"},
        {"tel fmt frames", "OK fmt=frames\r\n"},
        {"tel rate 250", "OK rate=250 period_ticks=4000\r\n"},
        {"tel fmt arduino", "ERR 116 "},
        {"tel off", "OK\r\n"},
        {"tel list", "OK rate=0 fmt=frames "}};
    bench.seed = 49;
    tel_begin();
    bench.got.blind = true;
    tel_period(true, FREE);
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        wire_frame frame;
        tel_type(rows[i].line);
        for (unsigned k = 0; k < 40U; k++) {
            tel_period(true, FREE);
        }
        (void)wire_take(&bench.heard, 0, &frame);
        const char *found = strstr(bench.heard.text, rows[i].answer);
        TEST_ASSERT_NOT_NULL_MESSAGE(found, rows[i].line);
        memset(&bench.heard, 0, sizeof bench.heard);
    }
}
