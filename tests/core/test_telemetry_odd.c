/* test_telemetry_odd.c: telemetry if values are invalid, too large or late, if a line has no room, and if there is no
 * cell. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "tel_bench.h"
#include "tests/suites.h"

#define RPM_PER_COUNT 0.02f
#define RADPS_PER_RPM 0.104719755f

static wh_real draw_size(void) {
    static const float sizes[] = {0.0f, 1e-3f, 0.4f, 7.0f, 65.5f, 66.0f, 1300.0f, 3e4f, 1e20f};
    const wh_real size = (wh_real)sizes[draw_one_of(&bench.seed, sizeof sizes / sizeof sizes[0])];
    return draw_one_in(&bench.seed, 8)   ? (wh_real)NAN
           : draw_one_in(&bench.seed, 8) ? (wh_real)INFINITY
           : draw_one_in(&bench.seed, 3) ? -size
                                         : size;
}

/* Encodes a number in the format of telemetry.h: 0 to 65534, or 65535 if there is none. */
static unsigned counted(wh_real number, float each) {
    const float counts = (float)number / each;
    return counts != counts     ? 65535U
           : counts <= 0.0f     ? 0U
           : counts >= 65534.0f ? 65534U
                                : (unsigned)(counts + 0.5f);
}

static void see(int32_t raw, wh_load_status status) {
    bench.cell_ticks += EVEN_STEP_TICKS;
    bench.seen = (wh_step_inputs){.inputs = bench.even.inputs, .samples = 1};
    bench.seen.sample[0] = (wh_step_sample){bench.cell_ticks, raw, status};
    wh_station_see(&bench.station, &bench.even.config, &bench.even.rig, &bench.seen);
}

static int load_wanted(int32_t raw, wh_load_status status) {
    const wh_cell_config *cell = &bench.even.config.measure.cell;
    const int32_t counts = raw / (1 << wh_tel_shift(cell));
    const bool full = status == WH_LOAD_OK && (raw >= cell->raw_max || raw <= -cell->raw_max);
    return full || status == WH_LOAD_DISCONNECTED ? -32768
           : counts > 32767                       ? 32767
           : counts < -32767                      ? -32767
                                                  : (int)counts;
}

TEST(telemetry_odd, frames_of_odd_numbers) {
    static const wh_load_status statuses[] = {WH_LOAD_OK, WH_LOAD_LATE, WH_LOAD_DISCONNECTED};
    bench.seed = 61;
    for (unsigned round = 0; round < 100U; round++) {
        tel_begin();
        bench.got.blind = true;
        tel_turn_on("tel rate 500");
        tel_hear(FREE);
        wh_rig *rig = &bench.even.rig;
        rig->pulses.speed.known = !draw_one_in(&bench.seed, 3);
        rig->pulses.speed.turn_radps = draw_size();
        rig->guard.quiet = draw_one_in(&bench.seed, 2);
        rig->command.volts = draw_size();
        const unsigned still = rig->guard.quiet ? 0U : 65535U;
        const unsigned speed = rig->pulses.speed.known ? counted(rig->pulses.speed.turn_radps,
                                                                 RPM_PER_COUNT * RADPS_PER_RPM)
                                                       : still;
        const unsigned drive = counted(rig->command.volts, 1e-3f);
        int wanted[4U * WH_TEL_SAMPLES];
        unsigned at = 0;
        unsigned heard = 0;
        bench.tel.samples = 0;
        while (at < 4U * WH_TEL_SAMPLES) {
            const int32_t raw = (int32_t)draw_whole(&bench.seed, -99999, 99999);
            const wh_load_status status = statuses[draw_one_of(&bench.seed, 3)];
            wanted[at++] = load_wanted(raw, status);
            see(raw, status);
            char bytes[WH_STATION_OUT_BYTES];
            const unsigned count = wh_station_peek(&bench.station, bytes, sizeof bytes);
            wh_station_drop(&bench.station, count);
            for (unsigned k = 0; k < count; k++) {
                wire_frame frame;
                if (!wire_take(&bench.heard, (uint8_t)bytes[k], &frame) ||
                    frame.channel != WH_TEL_RUN) {
                    continue;
                }
                TEST_ASSERT_UINT_WITHIN(1, speed, wire_number(frame.payload, 2));
                TEST_ASSERT_UINT_WITHIN(1, drive, wire_number(frame.payload + 2, 2));
                for (unsigned i = 5; i < frame.count; i += 2U) {
                    TEST_ASSERT_EQUAL_INT(wanted[heard++],
                                          (int16_t)wire_number(frame.payload + i, 2));
                }
            }
        }
        TEST_ASSERT_EQUAL_UINT(4U * WH_TEL_SAMPLES, heard);
    }
}

/* Each valid sample gives one line, with the speed if it is known. Lines without room are counted. */
TEST(telemetry_odd, lines_of_odd_numbers) {
    bench.seed = 62;
    unsigned none = 0;
    for (unsigned round = 0; round < 200U; round++) {
        tel_begin();
        bench.got.blind = true;
        tel_type(draw_one_in(&bench.seed, 2) ? "tel fmt teleplot" : "tel fmt arduino");
        tel_period(true, FREE);
        tel_turn_on("tel rate 100");
        tel_hear(FREE);
        memset(&bench.heard, 0, sizeof bench.heard);
        bench.tel.dropped[WH_TEL_RUN] = 0;
        bench.tel.passed = 0;
        wh_rig *rig = &bench.even.rig;
        rig->pulses.speed.known = !draw_one_in(&bench.seed, 3);
        rig->pulses.speed.turn_radps = WH_ABS(draw_size());
        rig->guard.quiet = false;
        rig->command.volts = draw_size();
        const bool has_speed =
            rig->pulses.speed.known && rig->pulses.speed.turn_radps <= (wh_real)INFINITY;
        const bool reads = draw_one_in(&bench.seed, 2);
        unsigned samples = 0;
        for (unsigned i = 0; i < 100U; i++) {
            const wh_load_status status =
                draw_one_in(&bench.seed, 3) ? WH_LOAD_DISCONNECTED : WH_LOAD_OK;
            const bool taken = bench.tel.passed + 1U == bench.tel.every;
            samples += taken && status == WH_LOAD_OK ? 1U : 0U;
            see((int32_t)draw_whole(&bench.seed, -30000, 30000), status);
            tel_hear(reads ? FREE : 0);
        }
        tel_hear(FREE);
        wire_frame frame;
        (void)wire_take(&bench.heard, 0, &frame);
        unsigned lines = 0;
        for (const char *at = bench.heard.text; (at = strstr(at, "load_N:")) != NULL; lines++) {
            const char *end = strstr(at, "drive_V:");
            const char *speed = strstr(at, "speed_rpm:");
            TEST_ASSERT_TRUE(end != NULL && has_speed == (speed != NULL && speed < end));
            at = end;
        }
        TEST_ASSERT_EQUAL_UINT(samples, lines + bench.tel.dropped[WH_TEL_RUN]);
        TEST_ASSERT_TRUE(lines > 0);
        none += bench.tel.dropped[WH_TEL_RUN];
    }
    TEST_ASSERT_TRUE(none > 100U);
}

static void check_answer(const char *line, const char *answer) {
    tel_type(line);
    wh_station_step(&bench.station, &bench.even.rig);
    tel_hear(FREE);
    wire_frame frame;
    (void)wire_take(&bench.heard, 0, &frame);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(bench.heard.text, answer), line);
    memset(&bench.heard, 0, sizeof bench.heard);
}

/* A board without a cell refuses a rate of samples. Also: the answers while telemetry is on. */
TEST(telemetry_odd, rates_and_schemas) {
    tel_begin();
    bench.got.blind = true;
    tel_period(true, FREE);
    memset(&bench.heard, 0, sizeof bench.heard);
    for (uint32_t per_s = 500; per_s >= 20U; per_s /= 5U) {
        char line[40] = "tel rate ";
        char answer[60] = "OK rate=";
        wh_text text;
        wh_text_start(&text, line + 9, sizeof line - 9U);
        wh_text_add_unsigned(&text, per_s);
        wh_text_start(&text, answer + 8, sizeof answer - 8U);
        wh_text_add_unsigned(&text, per_s);
        check_answer(line, answer);
        check_answer("tel list", answer);
        wh_text_start(&text, answer, sizeof answer);
        wh_text_add(&text, "OK channel=0 name=run period_ticks=");
        wh_text_add_unsigned(&text, WH_RIG_TICKS_PER_S / per_s);
        wh_text_add(&text, " once=");
        check_answer("tel schema run", answer);
        check_answer("tel fmt teleplot", per_s > 100U ? "ERR 116 " : "OK fmt=teleplot\r\n");
        check_answer("tel fmt frames", "OK fmt=frames\r\n");
    }
    bench.even.config.measure.cell.period_ticks = 0;
    check_answer("tel list", "OK rate=0 ");
    check_answer("tel rate 1", "ERR 116 ");
    check_answer("tel schema run", "OK channel=0 name=run period_ticks=0 ");
}
