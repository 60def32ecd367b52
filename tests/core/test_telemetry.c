/* test_telemetry.c: frames beside the console's text: all that was seen is in them or counted, answers come through, and the
 * rig does what it does without. */
#include <string.h>

#include "core/cobs.h"
#include "core/station/station.h"
#include "draw.h"
#include "even_rig.h"
#include "unity.h"
#include "wire.h"

void suite_telemetry(void);

#define STEPS_PER_S (WH_RIG_TICKS_PER_S / EVEN_STEP_TICKS)
#define FREE 4096U /* bytes a step: a line that is never full */
#define AT_115200 23U
#define TRUTHS 1024U

static even_rig even;
static even_rig twin;
static wh_station station;
static wh_tel tel;
static wh_seen seen;
static wire heard;
static uint64_t seed;
static uint32_t cell_ticks;

/* What was sent, and has not been heard yet: samples, pulses. */
static struct {
    uint32_t ticks[TRUTHS];
    int32_t value[TRUTHS];
    unsigned put;
    unsigned taken;
} samples, pulses;

typedef struct counts {
    unsigned frames;
    uint32_t gaps; /* in the sequences of all channels */
    uint16_t dropped;
    unsigned loads;
    bool uneven;
    bool blind; /* what frames hold is not looked at */
    bool any[WH_TEL_CHANNELS];
    uint16_t next[WH_TEL_CHANNELS];
} counts;
static counts got;

static void begin(void) {
    even_start(&even);
    even_rest(&even);
    wh_station_start(&station, "rig", "here", STEPS_PER_S);
    tel = (wh_tel){.every = 0};
    station.tel = &tel;
    memset(&heard, 0, sizeof heard);
    memset(&got, 0, sizeof got);
    samples.put = samples.taken = pulses.put = pulses.taken = 0;
    cell_ticks = even.inputs.now_ticks;
}

static void type(const char *line) {
    wh_station_take(&station, line, (unsigned)strlen(line));
    wh_station_take(&station, "\n", 1);
}

/* --- what is heard ------------------------------------------------------------------------------------- */

/* Whichever of a kind is the next with this time and value; those before it were dropped. Where samples do not come evenly
 * their times are told within an eighth of what lies between them. */
static void find_sample(uint32_t ticks, int32_t value) {
    const uint32_t within = got.uneven ? tel.every * EVEN_STEP_TICKS / 8U : 0;
    while (samples.taken < samples.put &&
           (ticks - samples.ticks[samples.taken % TRUTHS] + within > 2U * within ||
            samples.value[samples.taken % TRUTHS] != value)) {
        samples.taken++;
    }
    TEST_ASSERT_TRUE(samples.taken < samples.put);
    samples.taken++;
}

static void find_pulse(uint32_t ticks, int32_t sensor) {
    while (pulses.taken < pulses.put && pulses.ticks[pulses.taken % TRUTHS] != ticks) {
        pulses.taken++;
    }
    TEST_ASSERT_TRUE(pulses.taken < pulses.put);
    TEST_ASSERT_EQUAL_INT32(pulses.value[pulses.taken % TRUTHS], sensor);
    pulses.taken++;
}

static void hear_frame(const wire_frame *frame) {
    TEST_ASSERT_TRUE(frame->channel < WH_TEL_CHANNELS);
    if (got.any[frame->channel]) {
        got.gaps += (uint16_t)(frame->sequence - got.next[frame->channel]);
    } else {
        got.gaps += frame->sequence;
    }
    got.any[frame->channel] = true;
    got.next[frame->channel] = (uint16_t)(frame->sequence + 1U);
    got.dropped = frame->dropped;
    got.frames++;
    if (got.blind) {
        return;
    }
    if (frame->channel == WH_TEL_RUN) {
        const unsigned count = (frame->count - 5U) / 2U;
        TEST_ASSERT_TRUE(count >= 1U && count <= 10U && frame->count == 5U + 2U * count);
        for (unsigned i = 0; i < count; i++) {
            const int16_t load = (int16_t)wire_number(frame->payload + 5U + 2U * i, 2);
            find_sample(frame->ticks + i * tel.every * EVEN_STEP_TICKS, load);
        }
        got.loads += count;
    } else if (frame->channel == WH_TEL_EVENT) {
        TEST_ASSERT_EQUAL_UINT(2, frame->count);
        if (frame->payload[0] == WH_TEL_PULSE) {
            find_pulse(frame->ticks, frame->payload[1]);
        }
    }
}

/* The line takes so many bytes in a control step. */
static void hear(unsigned bytes) {
    char room[64];
    while (bytes > 0) {
        const unsigned most = bytes < sizeof room ? bytes : (unsigned)sizeof room;
        const unsigned count = wh_station_peek(&station, room, most);
        wh_station_drop(&station, count);
        for (unsigned i = 0; i < count; i++) {
            wire_frame frame;
            if (wire_take(&heard, (uint8_t)room[i], &frame)) {
                hear_frame(&frame);
            }
        }
        if (count < most) {
            return;
        }
        bytes -= most;
    }
}

/* --- what is seen --------------------------------------------------------------------------------------- */

static void draw_sample(bool evenly) {
    const wh_cell_config *cell = &even.config.measure.cell;
    wh_seen_sample *sample = &seen.sample[seen.samples++];
    const unsigned shift = wh_tel_shift(cell);
    sample->ticks = cell_ticks;
    sample->raw = (int32_t)draw_whole(&seed, -cell->raw_max, cell->raw_max);
    sample->status = WH_LOAD_OK;
    if (!evenly && draw_one_in(&seed, 30)) {
        sample->status = (wh_load_status)draw_one_of(&seed, WH_LOAD_STATUSES);
    }
    const bool full = sample->status == WH_LOAD_OK &&
                      (sample->raw >= cell->raw_max || sample->raw <= -cell->raw_max);
    const bool none =
        full || sample->status == WH_LOAD_SATURATED || sample->status == WH_LOAD_DISCONNECTED;
    if (sample->status == WH_LOAD_REPEATED) {
        return;
    }
    samples.ticks[samples.put % TRUTHS] = cell_ticks - cell->delay_ticks;
    samples.value[samples.put % TRUTHS] = none ? -32768 : sample->raw / (1 << shift);
    samples.put++;
}

static void draw_seen(bool evenly) {
    seen = (wh_seen){.inputs = even.inputs};
    cell_ticks += EVEN_STEP_TICKS;
    if (evenly || !draw_one_in(&seed, 40)) {
        draw_sample(evenly);
    }
    if (!evenly && draw_one_in(&seed, 50)) { /* two at once, or a break */
        cell_ticks += draw_one_in(&seed, 2) ? EVEN_STEP_TICKS : 777U;
        draw_sample(evenly);
    }
    seen.pulsed = draw_one_in(&seed, 45);
    if (seen.pulsed) {
        seen.sensor = draw_one_of(&seed, 2);
        seen.pulse_ticks = even.inputs.now_ticks - draw_one_of(&seed, 1999);
        pulses.ticks[pulses.put % TRUTHS] = seen.pulse_ticks;
        pulses.value[pulses.put % TRUTHS] = (int32_t)seen.sensor;
        pulses.put += tel.every > 0 && tel.format == WH_TEL_FRAMES ? 1U : 0U;
    }
}

/* One control period of the firmware; the line takes so many bytes of it. */
static void period(bool evenly, unsigned bytes) {
    even_step(&even);
    draw_seen(evenly);
    wh_station_see(&station, &even.config, &even.rig, &seen);
    wh_station_step(&station, &even.rig);
    hear(bytes);
}

static void turn_on(const char *rate) {
    type(rate);
    period(true, FREE);
    TEST_ASSERT_TRUE(tel.every > 0);
    samples.taken = samples.put; /* from now on */
    pulses.taken = pulses.put;
}

/* --- the coding ------------------------------------------------------------------------------------------ */

static void test_sum(void) {
    const uint8_t digits[9] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    TEST_ASSERT_EQUAL_HEX16(0x29B1, wh_crc16(WH_CRC16_START, digits, 9));
    TEST_ASSERT_EQUAL_HEX16(0x29B1, wh_crc16(wh_crc16(WH_CRC16_START, digits, 4), digits + 4, 5));
}

/* Bytes of every kind there and, by another reader, back. */
static void test_coding(void) {
    seed = 40;
    uint8_t bytes[WIRE_CHUNK];
    uint8_t back[WIRE_CHUNK];
    for (unsigned i = 0; i < 3000U; i++) {
        const unsigned count = draw_one_of(&seed, 290);
        const unsigned kind = draw_one_of(&seed, 3);
        wh_cobs cobs;
        memset(&heard, 0, sizeof heard);
        wh_cobs_start(&cobs, heard.chunk, sizeof heard.chunk);
        for (unsigned k = 0; k < count; k++) {
            const uint8_t byte = (uint8_t)draw_bits(&seed);
            bytes[k] = kind == 0 ? byte : kind == 1U ? (uint8_t)(byte & 1U) : (uint8_t)(byte | 1U);
            wh_cobs_put(&cobs, bytes[k]);
        }
        const unsigned length = wh_cobs_end(&cobs);
        TEST_ASSERT_TRUE(length > count && length <= WH_COBS_BYTES(count));
        TEST_ASSERT_TRUE(memchr(heard.chunk, 0, length) == heard.chunk + length - 1U);
        heard.count = length - 1U;
        TEST_ASSERT_EQUAL_UINT(count, wire_without_codes(&heard, back));
        TEST_ASSERT_TRUE(memcmp(bytes, back, count) == 0);
        TEST_ASSERT_EQUAL_UINT(count, wh_cobs_decode(heard.chunk, length - 1U));
        TEST_ASSERT_TRUE(memcmp(bytes, heard.chunk, count) == 0);
    }
}

/* --- what goes over the line ------------------------------------------------------------------------------ */

static void test_off_at_first_and_after(void) {
    seed = 41;
    begin();
    for (unsigned i = 0; i < 600U; i++) {
        if (i % 100U == 0) {
            type("status");
        }
        period(false, 0);
    }
    char bytes[WH_STATION_OUT_BYTES];
    unsigned count = wh_station_peek(&station, bytes, sizeof bytes);
    wh_station_drop(&station, count);
    TEST_ASSERT_TRUE(count > 400U && memchr(bytes, 0, count) == NULL);
    turn_on("tel rate 500");
    for (unsigned i = 0; i < 100U; i++) {
        period(true, FREE);
    }
    TEST_ASSERT_TRUE(got.frames > 9U);
    type("tel off");
    period(true, FREE);
    const unsigned frames = got.frames;
    for (unsigned i = 0; i < 100U; i++) {
        period(true, FREE);
    }
    TEST_ASSERT_EQUAL_UINT(frames, got.frames);
}

/* Every sample and pulse, whatever comes of the converter, at each rate and delay, of 12 to 24 bits. */
static void test_all_that_was_seen(void) {
    static const char *const rates[] = {"tel rate 500", "tel rate 250", "tel rate 100",
                                        "tel rate 20"};
    seed = 42;
    for (unsigned round = 0; round < 24U; round++) {
        const bool evenly = round % 2U == 0;
        const unsigned which = round / 6U;
        begin();
        even.config.measure.cell.raw_max = (int32_t)(1 << (11 + round % 13)) - 1;
        even.config.measure.cell.delay_ticks = draw_one_of(&seed, 5000);
        got.uneven = !evenly && which > 0;
        turn_on(rates[which]);
        for (unsigned i = 0; i < 4000U; i++) {
            period(evenly, FREE);
        }
        TEST_ASSERT_EQUAL_UINT(0, got.gaps + got.dropped + heard.bad);
        TEST_ASSERT_EQUAL_UINT(pulses.put, pulses.taken);
        if (which == 0) {
            TEST_ASSERT_TRUE(samples.put - samples.taken <= WH_TEL_SAMPLES);
            TEST_ASSERT_TRUE(got.loads + WH_TEL_SAMPLES >= samples.put - 1U);
        }
        TEST_ASSERT_TRUE(!evenly || got.loads >= 4000U / tel.every - 2U * WH_TEL_SAMPLES);
    }
}

/* The line of 115,200 baud carries it, with room; a slow one does not, and every loss is counted; answers come. */
static void test_losses_are_counted(void) {
    static const unsigned baud[] = {115200, 57600, 38400, 19200, 9600, 4800};
    seed = 43;
    for (unsigned k = 0; k < 6U; k++) {
        begin();
        turn_on("tel rate 500");
        unsigned asked = 0;
        unsigned credit = 0;
        for (unsigned i = 0; i < 10000U; i++) {
            credit += baud[k] / 10U; /* a byte is ten bits, a second 500 steps */
            if (i % 500U == 250U) {
                type("fault");
                asked++;
            }
            period(true, credit / STEPS_PER_S);
            credit %= STEPS_PER_S;
        }
        for (unsigned i = 0; i < 20U; i++) { /* what is told last is known when all else was */
            period(true, FREE);
        }
        TEST_ASSERT_EQUAL_UINT(0, heard.bad);
        TEST_ASSERT_EQUAL_UINT(got.dropped, got.gaps);
        TEST_ASSERT_TRUE((baud[k] <= 19200U) == (got.dropped > 0));
        TEST_ASSERT_EQUAL_UINT(0, station.lost_answers);
        unsigned told = 0;
        for (const char *at = strstr(heard.text, "OK trip=0: no fault\r\n"); at != NULL;
             at = strstr(at + 1, "OK trip=0: no fault\r\n")) {
            told++;
        }
        TEST_ASSERT_EQUAL_UINT(asked, told);
    }
}

/* Bytes that the line breaks, loses or invents: each frame is as it was sent or is missed, and text is whole again behind
 * the next zero. */
static void test_a_bad_line(void) {
    seed = 44;
    begin();
    turn_on("tel rate 500");
    for (unsigned i = 0; i < 20000U; i++) {
        char bytes[WH_STATION_OUT_BYTES];
        even_step(&even);
        draw_seen(true);
        wh_station_see(&station, &even.config, &even.rig, &seen);
        wh_station_step(&station, &even.rig);
        const unsigned count = wh_station_peek(&station, bytes, sizeof bytes);
        wh_station_drop(&station, count);
        for (unsigned k = 0; k < count; k++) {
            wire_frame frame;
            const unsigned fate = draw_one_of(&seed, 300);
            const uint8_t byte =
                (uint8_t)(fate == 0 ? (uint8_t)bytes[k] ^ 1U << draw_one_of(&seed, 8)
                                    : (uint8_t)bytes[k]);
            if (fate != 1U && wire_take(&heard, byte, &frame)) {
                hear_frame(&frame); /* which finds its samples */
            }
            if (fate == 2U && wire_take(&heard, (uint8_t)draw_bits(&seed), &frame)) {
                hear_frame(&frame);
            }
        }
    }
    TEST_ASSERT_TRUE(got.frames > 1200U && got.gaps > 100U && heard.bad > 100U);
    TEST_ASSERT_EQUAL_UINT(0, got.dropped);
}

/* Somebody reads, goes, comes back, types; the rig beside it that nobody listens to gives the same commands. */
static void test_control_is_undisturbed(void) {
    seed = 45;
    begin();
    turn_on("tel rate 500");
    got.blind = true;
    type("tel ring fault");
    type("arm");
    for (unsigned i = 0; i < 3U; i++) {
        period(true, FREE);
    }
    type("start 330");
    period(true, 0);
    period(true, 0);
    TEST_ASSERT_TRUE(even.rig.state == WH_LIFE_RUNNING);
    twin = even;
    bool reads = true;
    while (!even_is_over(&even)) {
        reads = draw_one_in(&seed, 400) ? !reads : reads;
        if (draw_one_in(&seed, 300)) {
            type("measure");
        }
        period(draw_one_in(&seed, 2), reads ? AT_115200 : 0);
        even_step(&twin);
        TEST_ASSERT_TRUE(memcmp(&even.command, &twin.command, sizeof even.command) == 0);
        TEST_ASSERT_EQUAL_UINT(wh_rig_stage(&twin.rig), wh_rig_stage(&even.rig));
    }
    TEST_ASSERT_TRUE(even_is_done(&even) && tel.dropped > 50U && got.frames > 300U);
    TEST_ASSERT_EQUAL_UINT(0, heard.bad);
}

/* States, speed and drive as the rig has them. */
static void test_states_are_told(void) {
    seed = 46;
    begin();
    turn_on("tel rate 500");
    type("arm");
    period(true, FREE);
    type("start 330");
    unsigned stage = WH_LIFE_ARMED;
    unsigned told = 0;
    unsigned fast = 0;
    for (unsigned i = 0; i < 60000U && !(told > 3U && even_is_over(&even)); i++) {
        char bytes[WH_STATION_OUT_BYTES];
        const unsigned before = wh_rig_stage(&even.rig);
        even_step(&even);
        draw_seen(true);
        wh_station_see(&station, &even.config, &even.rig, &seen);
        wh_station_step(&station, &even.rig);
        const unsigned count = wh_station_peek(&station, bytes, sizeof bytes);
        wh_station_drop(&station, count);
        bool changed = false;
        for (unsigned k = 0; k < count; k++) {
            wire_frame frame;
            if (!wire_take(&heard, (uint8_t)bytes[k], &frame)) {
                continue;
            }
            if (frame.channel == WH_TEL_EVENT && frame.payload[0] == WH_TEL_STATE) {
                changed = true;
                told++;
                stage = frame.payload[1];
                TEST_ASSERT_EQUAL_UINT(wh_rig_stage(&even.rig), stage);
                TEST_ASSERT_EQUAL_UINT32(even.inputs.now_ticks, frame.ticks);
            }
            if (frame.channel == WH_TEL_RUN && even.rig.run.phase == WH_PHASE_RECORD) {
                const float rpm = (float)wire_number(frame.payload, 2) * 0.02f;
                const float drive_V = (float)wire_number(frame.payload + 2, 2) * 0.001f;
                TEST_ASSERT_FLOAT_WITHIN(
                    0.011f, (float)(even.rig.pulses.speed.turn_radps * WH_R(9.549296585)), rpm);
                TEST_ASSERT_FLOAT_WITHIN(0.00051f, (float)even.rig.command.volts, drive_V);
                TEST_ASSERT_EQUAL_UINT(WH_RIG_STAGE_OF_PHASE + WH_PHASE_RECORD, frame.payload[4]);
                fast++;
            }
        }
        TEST_ASSERT_TRUE(changed || i < 3U || wh_rig_stage(&even.rig) == before);
    }
    TEST_ASSERT_TRUE(told >= 8U && fast > 80U);
}

/* --- the ring ------------------------------------------------------------------------------------------------ */

static wh_captured truth[4096];
static uint32_t truth_ticks[4096];

/* Steps, each written down; returns at which a pulse or a trip came, or -1. */
static void note_period(unsigned at, unsigned bytes) {
    period(true, bytes);
    truth_ticks[at] = seen.inputs.now_ticks;
    truth[at] =
        (wh_captured){.ticks = (uint16_t)seen.inputs.now_ticks,
                      .load = (int16_t)samples.value[(samples.put - 1U) % TRUTHS],
                      .drive_mV = (uint16_t)((float)even.rig.command.volts * 1000.0f + 0.5f),
                      .flags = (uint8_t)((seen.pulsed ? 1U << seen.sensor : 0U) |
                                         (even.rig.guard.trip != WH_TRIP_NONE ? 8U : 0U)),
                      .stage = (uint8_t)wh_rig_stage(&even.rig)};
}

/* What is read back is what was, in its order, the trigger where it belongs. */
static void check_read(unsigned end, bool by_pulse) {
    unsigned row = 0;
    unsigned from = end;
    bool first = true;
    unsigned triggers = 0;
    type("tel ring read");
    even_step(&even);
    wh_station_step(&station, &even.rig);
    for (unsigned i = 0; i < 1000U && (tel.reads || station.out.put != station.out.taken); i++) {
        char bytes[AT_115200];
        seen = (wh_seen){.inputs = even.inputs};
        wh_station_see(&station, &even.config, &even.rig, &seen);
        const unsigned count = wh_station_peek(&station, bytes, sizeof bytes);
        wh_station_drop(&station, count);
        for (unsigned k = 0; k < count; k++) {
            wire_frame frame;
            if (!wire_take(&heard, (uint8_t)bytes[k], &frame) || frame.channel != WH_TEL_RING) {
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
                    TEST_ASSERT_EQUAL_UINT(tel.capture.count - WH_CAPTURE_STEPS / 2U, row);
                }
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT(1, triggers);
    TEST_ASSERT_EQUAL_UINT(tel.capture.count, row);
    TEST_ASSERT_EQUAL_UINT(0, heard.bad + tel.dropped);
}

static void test_the_ring_has_what_was(void) {
    seed = 47;
    for (unsigned round = 0; round < 20U; round++) {
        const bool by_pulse = round % 2U == 0;
        begin();
        type(by_pulse ? "tel ring pulse" : "tel ring fault");
        period(true, FREE);
        const unsigned wait = draw_one_of(&seed, 900);
        unsigned at = 0;
        for (; at < 4000U && !tel.capture.full; at++) {
            if (at == wait && !by_pulse) {
                wh_guard_trip(&even.rig.guard, WH_TRIP_PULSES);
            }
            note_period(at, FREE);
        }
        TEST_ASSERT_TRUE(tel.capture.full);
        TEST_ASSERT_TRUE(by_pulse || tel.capture.count == (wait < 96U ? wait + 96U : 192U));
        check_read(at, by_pulse);
        check_read(at, by_pulse); /* it stays */
    }
}

/* --- text ------------------------------------------------------------------------------------------------- */

static void test_text_for_plotters(void) {
    seed = 48;
    for (unsigned which = 0; which < 2U; which++) {
        begin();
        type(which == 0 ? "tel fmt teleplot" : "tel fmt arduino");
        type("tel rate 100");
        for (unsigned i = 0; i < 100U; i++) {
            period(true, AT_115200);
        }
        wire_frame frame;
        (void)wire_take(&heard, 0, &frame);
        TEST_ASSERT_EQUAL_UINT(0, got.frames);
        const char *line = strstr(heard.text, which == 0 ? ">load_N:" : "load_N:");
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
            TEST_ASSERT_NOT_NULL(strstr(heard.text, ",speed_rpm:0.00,drive_V:0.000\r\n"));
        } else {
            TEST_ASSERT_NOT_NULL(strstr(heard.text, "\r\n>speed_rpm:0.00\r\n>drive_V:0.000\r\n"));
        }
    }
}

static void test_answers_and_refusals(void) {
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
        {"tel list", "OK rate=0 fmt=frames dropped=0 channels=run,event,ring\r\n"},
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
         "12=settle 13=record 14=ramp_down 15=coast\r\n"},
        {"tel fmt arduino", "OK fmt=arduino\r\n"},
        {"tel rate 500", "ERR 116 "},
        {"tel rate 1", "OK rate=1\r\n"},
        {"tel fmt frames", "OK fmt=frames\r\n"},
        {"tel rate 250", "OK rate=250\r\n"},
        {"tel fmt arduino", "ERR 116 "},
        {"tel off", "OK\r\n"},
        {"tel list", "OK rate=0 fmt=frames "}};
    seed = 49;
    begin();
    got.blind = true;
    period(true, FREE);
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        wire_frame frame;
        type(rows[i].line);
        for (unsigned k = 0; k < 40U; k++) {
            period(true, FREE);
        }
        (void)wire_take(&heard, 0, &frame);
        const char *found = strstr(heard.text, rows[i].answer);
        TEST_ASSERT_NOT_NULL_MESSAGE(found, rows[i].line);
        memset(&heard, 0, sizeof heard);
    }
}

void suite_telemetry(void) {
    RUN_TEST(test_sum);
    RUN_TEST(test_coding);
    RUN_TEST(test_off_at_first_and_after);
    RUN_TEST(test_all_that_was_seen);
    RUN_TEST(test_losses_are_counted);
    RUN_TEST(test_a_bad_line);
    RUN_TEST(test_control_is_undisturbed);
    RUN_TEST(test_states_are_told);
    RUN_TEST(test_the_ring_has_what_was);
    RUN_TEST(test_text_for_plotters);
    RUN_TEST(test_answers_and_refusals);
}
