/* test_telemetry_ring.c: telemetry's ring of steps around its trigger, plotter lines, answers and refusals. */
#include <string.h>

#include "draw.h"
#include "tel_bench.h"
#include "tests/suites.h"

static wh_captured truth[4096];
static uint32_t truth_ticks[4096];

/* Records steps; returns the one with a pulse or a trip, or -1. */
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

/* The read-back has all steps in order, with the trigger in its place. */
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

TEST(telemetry_ring, the_ring_has_what_was) {
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
        check_read(at, by_pulse); /* it stays */
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
