/* test_taping.c: a rig's control steps, from telemetry's channel onto a tape (host/monitor/taping.h), drawn: the tape, read
 * frame by frame, has each setting, step and answer in its order, to the bit; and it ends, saying why, where what comes is
 * not what may come. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/base/room.h"
#include "host/monitor/taping.h"
#include "unity.h"

void suite_taping(void);

enum { SETTINGS_MOST = 40, STEPS_MOST = 30, FRAMES_MOST = 120, PAYLOAD_MOST = 256 };

static dice die;

/* A frame of the channel, with memory of its own. */
typedef struct kept_frame {
    wire_frame frame;
    uint8_t payload[PAYLOAD_MOST];
} kept_frame;

/* A tape as the rig would tell it. */
typedef struct told {
    unsigned settings;
    uint8_t setting[SETTINGS_MOST];
    uint32_t value[SETTINGS_MOST];
    uint32_t begin_ticks;
    wh_taped_answer begin;
    unsigned steps;
    wh_taped_step step[STEPS_MOST];
    unsigned steps_before[FRAMES_MOST]; /* a frame, steps of those before it */
    unsigned frames;
    unsigned begin_frame;
    kept_frame frame[FRAMES_MOST];
} told;

static told t;

static uint32_t drawn_32(void) {
    return dice_one_of(&die, 65536U) << 16 | dice_one_of(&die, 65536U);
}

static wh_taped_answer drawn_answer(void) {
    return (wh_taped_answer){.way = (uint8_t)dice_one_of(&die, 3),
                             .volts = drawn_32(),
                             .stage = (uint8_t)dice_one_of(&die, 256),
                             .trip = (uint8_t)dice_one_of(&die, 256)};
}

static wh_taped_step drawn_step(uint32_t ticks) {
    wh_taped_step s;
    memset(&s, 0, sizeof s);
    s.ticks = ticks;
    s.supply = dice_one_of(&die, 2) == 0 ? 0x41400000U : drawn_32();
    s.pins = (uint8_t)dice_one_of(&die, 8);
    s.pulsed = dice_one_of(&die, 3) == 0;
    s.samples = dice_one_of(&die, WH_TAPED_SAMPLES + 1U);
    s.orders = dice_one_of(&die, WH_TAPED_ORDERS + 1U);
    s.answer = drawn_answer();
    if (s.pulsed) {
        s.sensor = (uint8_t)dice_one_of(&die, 2);
        s.pulse_ticks = ticks - dice_one_of(&die, 2000);
    }
    for (unsigned i = 0; i < s.samples; i++) {
        s.sample[i] = (wh_taped_sample){.ticks = ticks - dice_one_of(&die, 2000),
                                        .raw = (int32_t)drawn_32(),
                                        .status = (uint8_t)dice_one_of(&die, 8)};
    }
    for (unsigned i = 0; i < s.orders; i++) {
        s.order[i] =
            (wh_taped_order){.event = (uint8_t)dice_one_of(&die, 256), .value = drawn_32()};
    }
    return s;
}

/* The next frame of the channel, begun. */
static wh_bytes open_frame(uint32_t ticks, unsigned kind) {
    TEST_ASSERT_TRUE(t.frames < FRAMES_MOST);
    kept_frame *f = &t.frame[t.frames];
    t.steps_before[t.frames] = t.steps;
    f->frame = (wire_frame){.channel = 3, .ticks = ticks, .payload = f->payload};
    wh_bytes out = {.to = f->payload, .room = sizeof f->payload};
    wh_bytes_put(&out, kind, 1);
    return out;
}

static void close_frame(const wh_bytes *out) {
    TEST_ASSERT_FALSE(out->over);
    t.frame[t.frames++].frame.length = out->at;
}

static void tell_settings(void) {
    t.settings = dice_one_of(&die, SETTINGS_MOST + 1);
    for (unsigned i = 0; i < t.settings;) {
        wh_bytes out = open_frame(drawn_32(), WH_TAPED_SETTINGS);
        const unsigned end = i + 1U + dice_one_of(&die, 15);
        for (; i < t.settings && i < end; i++) {
            t.setting[i] = (uint8_t)dice_one_of(&die, 256);
            t.value[i] = drawn_32();
            wh_bytes_put(&out, t.setting[i], 1);
            wh_bytes_put(&out, t.value[i], 4);
        }
        close_frame(&out);
    }
}

static void tell_begin(void) {
    t.begin_ticks = drawn_32();
    t.begin = drawn_answer();
    t.begin_frame = t.frames;
    wh_bytes out = open_frame(t.begin_ticks, WH_TAPED_BEGIN);
    wh_bytes_put(&out, WH_TAPED_VERSION, 1);
    wh_taped_put_answer(&t.begin, &out);
    close_frame(&out);
}

static void tell_steps(void) {
    wh_taped_before before = {.ticks = t.begin_ticks, .answer = t.begin};
    const unsigned frames = 1 + dice_one_of(&die, 5);
    for (unsigned f = 0; f < frames; f++) {
        const unsigned end = t.steps + 1 + dice_one_of(&die, 3);
        const uint32_t first = before.ticks + 1U + dice_one_of(&die, 5000);
        wh_bytes out = open_frame(first, WH_TAPED_STEPS);
        for (uint32_t ticks = first; t.steps < end; ticks += 1U + dice_one_of(&die, 5000)) {
            t.step[t.steps] = drawn_step(ticks);
            wh_taped_put(&before, &t.step[t.steps++], &out);
        }
        close_frame(&out);
    }
}

/* Whole, without its end. */
static void tell(void) {
    memset(&t, 0, sizeof t);
    tell_settings();
    tell_begin();
    tell_steps();
}

/* The end, and a number for each frame in turn. */
static void tell_end(unsigned why) {
    wh_bytes out = open_frame(drawn_32(), WH_TAPED_END);
    wh_bytes_put(&out, why, 1);
    close_frame(&out);
}

static void number_frames(void) {
    uint16_t sequence = (uint16_t)drawn_32();
    for (unsigned i = 0; i < t.frames; i++) {
        t.frame[i].frame.sequence = sequence++;
    }
}

/* --- what is on the tape ----------------------------------------------------------------------------------------*/

typedef struct reading {
    const char *bytes;
    size_t length;
    size_t at;
    uint8_t room[WH_FRAME_BYTES(1024U)];
    wh_frame_reader reader;
    wh_frame frame;
} reading;

static bool next_frame(reading *r) {
    while (r->at < r->length) {
        if (wh_frame_take(&r->reader, (uint8_t)r->bytes[r->at++], &r->frame)) {
            return true;
        }
    }
    return false;
}

/* One exchange, the number `sequence`: what was read, and the answer to it. */
static void expect_exchange(reading *r, unsigned sequence, uint32_t ticks, wh_readings *readings,
                            const wh_taped_answer *answer) {
    wh_orders orders;
    wh_orders wanted;
    TEST_ASSERT_TRUE(next_frame(r));
    TEST_ASSERT_EQUAL_UINT(WH_FRAME_READINGS, r->frame.kind);
    TEST_ASSERT_EQUAL_UINT(sequence, r->frame.sequence);
    TEST_ASSERT_EQUAL_HEX32(ticks, r->frame.ticks);
    TEST_ASSERT_TRUE(wh_readings_get(readings, r->frame.payload, r->frame.length));
    TEST_ASSERT_TRUE(next_frame(r));
    TEST_ASSERT_EQUAL_UINT(WH_FRAME_ORDERS, r->frame.kind);
    TEST_ASSERT_EQUAL_UINT(sequence, r->frame.sequence);
    TEST_ASSERT_EQUAL_HEX32(ticks, r->frame.ticks);
    TEST_ASSERT_TRUE(wh_orders_get(&orders, r->frame.payload, r->frame.length));
    wh_taped_orders(answer, ticks, &wanted);
    TEST_ASSERT_EQUAL_HEX32(wanted.until_ticks, orders.until_ticks);
    TEST_ASSERT_EQUAL_UINT(wanted.outputs, orders.outputs);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wanted.output, orders.output, wanted.outputs * sizeof(float));
}

static void expect_setting(const wh_readings *r, unsigned at, unsigned which) {
    TEST_ASSERT_TRUE(2U * at + 1U < r->samples);
    TEST_ASSERT_EQUAL_UINT(WH_TAPED_SETTING, r->sample[2U * at].channel);
    TEST_ASSERT_EQUAL_UINT(t.setting[which], r->sample[2U * at].raw);
    TEST_ASSERT_EQUAL_UINT(WH_TAPED_SETTING_VALUE, r->sample[2U * at + 1U].channel);
    TEST_ASSERT_EQUAL_HEX32(t.value[which], r->sample[2U * at + 1U].raw);
}

/* Settings, eleven in an exchange at most, the last with the start; then so many steps. */
static void expect_tape(const char *bytes, size_t length, unsigned steps) {
    static const wh_taped_answer nothing;
    static reading r;
    wh_readings readings;
    wh_signal signal[WH_SIGNALS_MAX];
    wh_hello hello;
    wh_hello wanted;
    unsigned sequence = 0;
    unsigned setting = 0;
    r = (reading){.bytes = bytes, .length = length};
    wh_frame_reader_start(&r.reader, r.room, sizeof r.room);
    TEST_ASSERT_TRUE(next_frame(&r) && r.frame.kind == WH_FRAME_HELLO);
    TEST_ASSERT_EQUAL_UINT(0, r.frame.ticks);
    TEST_ASSERT_TRUE(wh_hello_get(&hello, signal, r.frame.payload, r.frame.length));
    wh_taped_hello(&wanted, "recorded");
    TEST_ASSERT_EQUAL_STRING(wanted.program, hello.program);
    TEST_ASSERT_EQUAL_STRING("recorded", hello.board);
    TEST_ASSERT_EQUAL_UINT(wanted.signals, hello.signals);
    for (; t.settings - setting > WH_TAPED_SETTINGS_MOST; sequence++) {
        expect_exchange(&r, sequence, 0, &readings, &nothing);
        TEST_ASSERT_EQUAL_UINT(2U * WH_TAPED_SETTINGS_MOST, readings.samples);
        for (unsigned i = 0; i < WH_TAPED_SETTINGS_MOST; i++) {
            expect_setting(&readings, i, setting++);
        }
    }
    expect_exchange(&r, sequence++, 0, &readings, &t.begin);
    for (unsigned i = 0; setting < t.settings; i++) {
        expect_setting(&readings, i, setting++);
    }
    TEST_ASSERT_TRUE(readings.samples % 2U == 1U &&
                     readings.sample[readings.samples - 1U].channel == WH_TAPED_STARTS &&
                     readings.sample[readings.samples - 1U].raw == (int32_t)WH_TAPED_VERSION);
    for (unsigned i = 0; i < steps; i++) {
        const uint32_t ticks = t.step[i].ticks - t.begin_ticks;
        wh_readings as;
        expect_exchange(&r, sequence++, ticks, &readings, &t.step[i].answer);
        wh_taped_readings(&t.step[i], t.begin_ticks, &as);
        TEST_ASSERT_EQUAL_UINT(as.flags, readings.flags);
        TEST_ASSERT_EQUAL_UINT(as.edges, readings.edges);
        TEST_ASSERT_EQUAL_UINT(as.samples, readings.samples);
        for (unsigned k = 0; k < as.samples; k++) {
            TEST_ASSERT_EQUAL_HEX32(as.sample[k].ticks, readings.sample[k].ticks);
            TEST_ASSERT_EQUAL_HEX32(as.sample[k].raw, readings.sample[k].raw);
            TEST_ASSERT_EQUAL_UINT(as.sample[k].channel, readings.sample[k].channel);
        }
        for (unsigned k = 0; k < as.edges; k++) {
            TEST_ASSERT_EQUAL_HEX32(as.edge[k].ticks, readings.edge[k].ticks);
            TEST_ASSERT_EQUAL_UINT(as.edge[k].channel, readings.edge[k].channel);
        }
    }
    TEST_ASSERT_FALSE(next_frame(&r));
    TEST_ASSERT_EQUAL_UINT(0, r.reader.dropped);
}

/* --- cases ------------------------------------------------------------------------------------------------------*/

typedef struct taken {
    char *bytes;
    size_t length;
    taping of;
} taken;

static void take_all(taken *to) {
    to->of = (taping){.out = room_text(&to->bytes, &to->length)};
    for (unsigned i = 0; i < t.frames; i++) {
        taping_frame(&to->of, &t.frame[i].frame);
    }
}

/* It is over, so, with so many steps on it; `why` NULL: it is not over. */
static void expect_over(taken *got, bool lost, const char *why, unsigned steps) {
    TEST_ASSERT_TRUE(got->of.over == (why != NULL) && got->of.lost == lost);
    if (why != NULL) {
        TEST_ASSERT_EQUAL_STRING(why, got->of.why);
    }
    TEST_ASSERT_EQUAL_UINT64(steps, got->of.steps);
    const uint32_t length = steps > 0 ? t.step[steps - 1].ticks - t.begin_ticks : 0;
    TEST_ASSERT_EQUAL_INT64(length, got->of.length_ticks);
    room_text_end(got->of.out);
    if (got->of.began) {
        expect_tape(got->bytes, got->length, steps);
    } else {
        TEST_ASSERT_EQUAL_UINT64(0, steps);
    }
    free(got->bytes);
}

static void test_whole(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 30)); c++) {
        static const char *const words[] = {"it was switched off", "the line was too slow for it",
                                            "the rig says no more"};
        const unsigned why = dice_one_of(&die, 4); /* 3: it has no end yet */
        taken got;
        tell();
        if (why < 3) {
            tell_end(why);
        }
        number_frames();
        take_all(&got);
        TEST_ASSERT_TRUE(got.of.began && got.of.any && got.of.asked);
        if (why < 3 && dice_one_of(&die, 2) == 0) { /* what comes behind it is of another tape */
            taping_anew(&got.of);
            taping_frame(&got.of, &t.frame[t.begin_frame].frame);
        }
        expect_over(&got, why == 1 || why == 2, why < 3 ? words[why] : NULL, t.steps);
    }
}

/* A frame is missing: at the next it is over; the end, if it is the next, tells of it itself. */
static void test_gaps(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 30)); c++) {
        const unsigned why = dice_one_of(&die, 2);
        taken got;
        tell();
        tell_end(why);
        number_frames();
        const unsigned from = 1 + dice_one_of(&die, t.frames - 1);
        const uint16_t gap = (uint16_t)(1U + dice_one_of(&die, 65535));
        for (unsigned i = from; i < t.frames; i++) {
            t.frame[i].frame.sequence = (uint16_t)(t.frame[i].frame.sequence + gap);
        }
        take_all(&got);
        expect_over(&got, true,
                    from == t.frames - 1 && why == WH_TAPED_LOST ? "the line was too slow for it"
                                                                 : "a frame of it was lost",
                    t.steps_before[from]);
    }
}

/* Steps that are not what they should be: at another time, cut off, too long. */
static void test_broken_steps(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 30)); c++) {
        taken got;
        tell();
        number_frames();
        const unsigned first = t.begin_frame + 1U;
        const unsigned which = first + dice_one_of(&die, t.frames - first);
        const unsigned end = which + 1U < t.frames ? t.steps_before[which + 1U] : t.steps;
        unsigned good = t.steps_before[which];
        wire_frame *f = &t.frame[which].frame;
        if (c % 2 == 0) {
            f->ticks += 1U + dice_one_of(&die, 1000);
        } else {
            f->length--;
            good = end - 1U; /* those before the last are whole */
        }
        take_all(&got);
        expect_over(&got, true, "a frame of it is not what the rig should say", good);
    }
}

/* A frame more, where it may not stand. */
static void expect_another(unsigned at, unsigned kind, const char *why, unsigned steps) {
    taken got;
    const kept_frame last = t.frame[at];
    wh_bytes out = {.to = t.frame[at].payload, .room = PAYLOAD_MOST};
    wh_bytes_put(&out, kind, 1);
    const unsigned frames = t.frames;
    t.frame[at].frame.length = 6;
    t.frames = at + 1U;
    take_all(&got);
    expect_over(&got, true, why, steps);
    t.frames = frames;
    t.frame[at] = last;
    t.frame[at].frame.payload = t.frame[at].payload;
}

static void test_order(void) {
    unsigned steps_first = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        tell();
        number_frames();
        const unsigned at = t.begin_frame + 1U + dice_one_of(&die, t.frames - t.begin_frame - 1U);
        const char *const another = "another one was begun";
        expect_another(at, WH_TAPED_SETTINGS, another, t.steps_before[at]);
        expect_another(at, WH_TAPED_BEGIN, another, t.steps_before[at]);
        expect_another(at, 77, another, t.steps_before[at]);
        if (t.begin_frame > 0) {
            expect_another(t.begin_frame, WH_TAPED_STEPS, another, 0);
            steps_first++;
        }
    }
    TEST_ASSERT_TRUE(steps_first > 5);
}

/* Before its first frame there is nothing, whatever comes; a begin of another version, or of too few bytes, is none. */
static void test_begins(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        taken got;
        tell();
        number_frames();
        got.of = (taping){.out = room_text(&got.bytes, &got.length)};
        taping_frame(&got.of, &t.frame[t.begin_frame + 1U].frame);
        taping_anew(&got.of);
        TEST_ASSERT_TRUE(!got.of.any && !got.of.over);
        if (c % 3 == 0) {
            t.frame[t.begin_frame].payload[1]++;
        } else if (c % 3 == 1) {
            t.frame[t.begin_frame].frame.length--;
        }
        for (unsigned i = 0; i < t.frames; i++) {
            taping_frame(&got.of, &t.frame[i].frame);
        }
        if (c % 3 < 2) {
            TEST_ASSERT_FALSE(got.of.began);
            expect_over(&got, true, "the rig records in a way that this program does not know", 0);
        } else {
            taping_anew(&got.of);
            expect_over(&got, true, "the rig began anew", t.steps);
        }
    }
}

void suite_taping(void) {
    die = dice_of("taping", 46);
    RUN_TEST(test_whole);
    RUN_TEST(test_gaps);
    RUN_TEST(test_broken_steps);
    RUN_TEST(test_order);
    RUN_TEST(test_begins);
}
