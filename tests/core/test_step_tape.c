/* test_step_tape.c: what a control step sees and answers, as bytes and as an exchange, and back: the same to the bit, whatever
 * it is; and what the station tells of its steps is what there was, until it says that it is not. */
#include <string.h>

#include "core/station/tape_out.h"
#include "draw.h"
#include "tel_bench.h"
#include "unity.h"

void suite_step_tape(void);

#define CODED_STEPS 4000U
#define STEPS_MOST 1200U /* that are kept: boards have room for so many */

static uint64_t seed;

static uint32_t draw_32(void) { return (uint32_t)(draw_bits(&seed) << 16 ^ draw_bits(&seed)); }

/* Usual, or anything. */
static uint32_t draw_rarely(uint32_t usual) { return draw_one_in(&seed, 12) ? draw_32() : usual; }

static wh_taped_answer draw_answer(const wh_taped_answer *before) {
    return (wh_taped_answer){.way = (uint8_t)draw_one_of(&seed, 3),
                             .volts = draw_one_in(&seed, 2) ? draw_32() : before->volts,
                             .stage = (uint8_t)draw_rarely(before->stage),
                             .trip = (uint8_t)draw_rarely(before->trip)};
}

static wh_taped_step draw_step(const wh_taped_before *before) {
    wh_taped_step step;
    memset(&step, 0, sizeof step);
    step.ticks = before->ticks + draw_rarely(WH_TAPED_PERIOD);
    step.supply = draw_rarely(before->supply);
    step.pins = (uint8_t)(draw_rarely(before->pins) & 7U);
    step.pulsed = draw_one_in(&seed, 5);
    step.sensor = step.pulsed ? (uint8_t)draw_one_of(&seed, 2) : 0;
    step.pulse_ticks = step.pulsed ? draw_32() : 0;
    step.samples = draw_one_of(&seed, WH_TAPED_SAMPLES + 1U);
    for (unsigned i = 0; i < step.samples; i++) {
        const uint32_t late = draw_one_in(&seed, 2) ? before->late : draw_one_of(&seed, 70000);
        step.sample[i] = (wh_taped_sample){
            .ticks = step.ticks - draw_rarely(late),
            .raw = draw_one_in(&seed, 2) ? (int32_t)draw_32() : (int16_t)(uint16_t)draw_32(),
            .status = (uint8_t)draw_one_of(&seed, 8)};
    }
    step.orders = draw_one_in(&seed, 8) ? draw_one_of(&seed, WH_TAPED_ORDERS + 1U) : 0;
    for (unsigned i = 0; i < step.orders; i++) {
        step.order[i] = (wh_taped_order){.event = (uint8_t)draw_32(), .value = draw_32()};
    }
    step.answer = draw_one_in(&seed, 3) ? draw_answer(&before->answer) : before->answer;
    return step;
}

static void same_answer(const wh_taped_answer *is, const wh_taped_answer *was) {
    TEST_ASSERT_EQUAL_UINT(was->way, is->way);
    TEST_ASSERT_EQUAL_HEX32(was->volts, is->volts);
    TEST_ASSERT_EQUAL_UINT(was->stage, is->stage);
    TEST_ASSERT_EQUAL_UINT(was->trip, is->trip);
}

static void same_inputs(const wh_taped_step *is, const wh_taped_step *was, uint32_t begin_ticks) {
    TEST_ASSERT_EQUAL_HEX32(was->ticks - begin_ticks, is->ticks);
    TEST_ASSERT_EQUAL_HEX32(was->supply, is->supply);
    TEST_ASSERT_EQUAL_UINT(was->pins, is->pins);
    TEST_ASSERT_EQUAL(was->pulsed, is->pulsed);
    if (was->pulsed) {
        TEST_ASSERT_EQUAL_UINT(was->sensor, is->sensor);
        TEST_ASSERT_EQUAL_HEX32(was->pulse_ticks - begin_ticks, is->pulse_ticks);
    }
    TEST_ASSERT_EQUAL_UINT(was->samples, is->samples);
    for (unsigned i = 0; i < was->samples; i++) {
        TEST_ASSERT_EQUAL_HEX32(was->sample[i].ticks - begin_ticks, is->sample[i].ticks);
        TEST_ASSERT_EQUAL_INT32(was->sample[i].raw, is->sample[i].raw);
        TEST_ASSERT_EQUAL_UINT(was->sample[i].status, is->sample[i].status);
    }
    TEST_ASSERT_EQUAL_UINT(was->orders, is->orders);
    for (unsigned i = 0; i < was->orders; i++) {
        TEST_ASSERT_EQUAL_UINT(was->order[i].event, is->order[i].event);
        TEST_ASSERT_EQUAL_HEX32(was->order[i].value, is->order[i].value);
    }
}

/* --- as bytes, as exchanges -------------------------------------------------------------------------------------*/

static void test_bytes(void) {
    wh_taped_before there = {.ticks = 0};
    wh_taped_before here = {.ticks = 0};
    unsigned longest = 0;
    seed = 60;
    for (unsigned i = 0; i < CODED_STEPS; i++) {
        uint8_t bytes[WH_TAPED_STEP_BYTES];
        const wh_taped_before before = here;
        const wh_taped_step step = draw_step(&there);
        wh_taped_step back;
        wh_bytes out = {.to = bytes, .room = sizeof bytes};
        wh_taped_put(&there, &step, &out);
        TEST_ASSERT_FALSE(out.over);
        longest = out.at > longest ? out.at : longest;
        wh_bytes in = {.from = bytes, .room = out.at};
        TEST_ASSERT_TRUE(wh_taped_get(&here, &back, &in));
        TEST_ASSERT_EQUAL_UINT(out.at, in.at);
        same_inputs(&back, &step, 0);
        same_answer(&back.answer, &step.answer);
        for (unsigned cut = 0; cut < out.at; cut++) { /* none of it may be missing */
            wh_taped_before again = before;
            wh_bytes part = {.from = bytes, .room = cut};
            TEST_ASSERT_FALSE(wh_taped_get(&again, &back, &part));
        }
    }
    TEST_ASSERT_TRUE(longest > WH_TAPED_STEP_BYTES / 2U);
}

/* The longest there is, and a step of which nothing has changed. */
static void test_lengths(void) {
    uint8_t bytes[WH_TAPED_STEP_BYTES];
    wh_taped_before before = {.ticks = 0};
    wh_bytes out = {.to = bytes, .room = sizeof bytes};
    wh_taped_step step = {
        .ticks = 1, .supply = 1, .pins = 1, .pulsed = true, .samples = 2, .orders = 4};
    step.sample[0] = (wh_taped_sample){.ticks = 0x20000000U, .raw = INT32_MAX, .status = 7};
    step.sample[1] = (wh_taped_sample){.ticks = 0x40000000U, .raw = INT32_MIN, .status = 7};
    step.answer = (wh_taped_answer){.way = 2, .volts = 1, .stage = 1, .trip = 1};
    wh_taped_put(&before, &step, &out);
    TEST_ASSERT_EQUAL_UINT(WH_TAPED_STEP_BYTES, out.at);
    out.at = 0;
    step = (wh_taped_step){
        .ticks = 1U + WH_TAPED_PERIOD, .supply = 1, .pins = 1, .answer = step.answer};
    wh_taped_put(&before, &step, &out);
    TEST_ASSERT_EQUAL_UINT(1, out.at);
    bytes[0] = 3U << 4; /* three samples there are not */
    wh_bytes in = {.from = bytes, .room = sizeof bytes};
    TEST_ASSERT_FALSE(wh_taped_get(&before, &step, &in));
}

static void test_exchanges(void) {
    wh_taped_before before = {.ticks = 0};
    seed = 61;
    for (unsigned i = 0; i < CODED_STEPS; i++) {
        uint8_t bytes[WH_READINGS_BYTES];
        const wh_taped_step step = draw_step(&before);
        const uint32_t begin_ticks = draw_32();
        wh_readings readings;
        wh_readings heard;
        wh_taped_step back;
        wh_orders orders;
        wh_bytes nowhere = {.to = bytes, .room = sizeof bytes};
        wh_taped_put(&before, &step, &nowhere); /* what is usual goes on */
        wh_taped_readings(&step, begin_ticks, &readings);
        const unsigned count = wh_readings_put(&readings, bytes, sizeof bytes);
        TEST_ASSERT_TRUE(count > 0 && wh_readings_get(&heard, bytes, count));
        wh_taped_step_of(&heard, step.ticks - begin_ticks, &back);
        same_inputs(&back, &step, begin_ticks);
        wh_taped_orders(&step.answer, step.ticks - begin_ticks, &orders);
        TEST_ASSERT_EQUAL_HEX32(step.ticks - begin_ticks + WH_TAPED_PERIOD, orders.until_ticks);
        TEST_ASSERT_EQUAL_UINT(4, orders.outputs);
        TEST_ASSERT_TRUE(orders.output[0] == (float)step.answer.way &&
                         wh_taped_bits(orders.output[1]) == step.answer.volts &&
                         orders.output[2] == (float)step.answer.stage &&
                         orders.output[3] == (float)step.answer.trip);
    }
}

#if WH_STATION_TAPE
/* --- of the station ---------------------------------------------------------------------------------------------*/

static wh_tape tape;
static wh_taped_step saw[STEPS_MOST]; /* since the begin */
static unsigned seen_steps;
static struct {
    wh_taped_before before;
    unsigned settings;
    bool begun;
    unsigned steps;
    unsigned frames;
    bool ended;
    unsigned why;
    uint16_t next;
    bool missing;
} got;

static void take_steps(wh_bytes *in, uint32_t ticks) {
    for (bool first = true; in->at < in->room; first = false) {
        wh_taped_step step;
        TEST_ASSERT_TRUE(wh_taped_get(&got.before, &step, in));
        TEST_ASSERT_TRUE(!first || step.ticks == ticks);
        TEST_ASSERT_TRUE(got.steps < seen_steps);
        same_inputs(&step, &saw[got.steps], 0);
        same_answer(&step.answer, &saw[got.steps].answer);
        got.steps++;
    }
}

static void take_frame(const wire_frame *frame) {
    if (frame->channel != WH_TEL_TAPE) {
        return;
    }
    wh_bytes in = {.from = frame->payload, .room = frame->count};
    const uint32_t kind = wh_bytes_get(&in, 1);
    got.missing = got.missing || (got.frames > 0 && frame->sequence != got.next);
    got.next = (uint16_t)(frame->sequence + 1U);
    got.frames++;
    TEST_ASSERT_FALSE(got.ended);
    TEST_ASSERT_TRUE(!got.missing || kind == WH_TAPED_END); /* nothing comes behind a gap */
    if (kind == WH_TAPED_SETTINGS) {
        TEST_ASSERT_FALSE(got.begun);
        got.settings += (frame->count - 1U) / WH_TAPED_SETTING_BYTES;
    } else if (kind == WH_TAPED_BEGIN) {
        TEST_ASSERT_EQUAL_UINT(WH_TAPED_VERSION, wh_bytes_get(&in, 1));
        got.begun = true;
        got.before.ticks = frame->ticks;
        wh_taped_get_answer(&got.before.answer, &in);
    } else if (kind == WH_TAPED_STEPS) {
        take_steps(&in, frame->ticks);
    } else {
        got.ended = true;
        got.why = wh_bytes_get(&in, 1);
    }
}

static void hear(unsigned bytes) {
    char room[64];
    while (bytes > 0) {
        const unsigned most = bytes < sizeof room ? bytes : (unsigned)sizeof room;
        const unsigned count = wh_station_peek(&bench.station, room, most);
        wh_station_drop(&bench.station, count);
        for (unsigned i = 0; i < count; i++) {
            wire_frame frame;
            if (wire_take(&bench.heard, (uint8_t)room[i], &frame)) {
                take_frame(&frame);
            }
        }
        bytes = count < most ? 0 : bytes - most;
    }
}

/* What this step was, by itself: orders that waited before it, what was seen, what the rig says now. */
static void note_step(const wh_rig *before) {
    wh_taped_step *step = &saw[seen_steps++];
    const wh_rig *rig = &bench.even.rig;
    memset(step, 0, sizeof *step);
    step->ticks = bench.seen.inputs.now_ticks;
    step->supply = wh_taped_bits((float)bench.seen.inputs.supply_V);
    step->pins = (uint8_t)((bench.seen.inputs.stop_pressed ? 1U : 0U) |
                           (bench.seen.inputs.clock_is_fallback ? 2U : 0U) |
                           (bench.seen.inputs.watchdog_has_cut ? 4U : 0U));
    step->pulsed = bench.seen.pulsed;
    step->sensor = (uint8_t)bench.seen.sensor;
    step->pulse_ticks = bench.seen.pulse_ticks;
    step->samples = bench.seen.samples;
    for (unsigned i = 0; i < step->samples; i++) {
        const wh_seen_sample *sample = &bench.seen.sample[i];
        step->sample[i] = (wh_taped_sample){sample->ticks, sample->raw, (uint8_t)sample->status};
    }
    step->orders = before->orders;
    for (unsigned i = 0; i < step->orders; i++) {
        step->order[i] = (wh_taped_order){(uint8_t)before->order[i].event,
                                          wh_taped_bits((float)before->order[i].value)};
    }
    step->answer =
        (wh_taped_answer){(uint8_t)rig->command.way, wh_taped_bits((float)rig->command.volts),
                          (uint8_t)wh_rig_stage(rig), (uint8_t)rig->guard.trip};
}

static void period(unsigned bytes) {
    static wh_rig before;
    before = bench.even.rig;
    bench.even.inputs.supply_V = WH_RIG_RATED_V + draw_whole(&bench.seed, -5, 5) / 64;
    even_step(&bench.even);
    tel_draw_seen(false);
    if (tape.state == WH_TAPE_RUNS && seen_steps < STEPS_MOST) {
        note_step(&before);
    }
    wh_station_see(&bench.station, &bench.even.config, &bench.even.rig, &bench.seen);
    if (bench.station.tape != NULL) {
        wh_tape_see(&bench.station, &bench.even.rig);
    }
    wh_station_step(&bench.station, &bench.even.rig);
    if (bench.station.tape != NULL) {
        wh_tape_orders(&bench.station, &bench.even.rig);
    }
    hear(bytes);
}

static void begin_tape(uint64_t from) {
    bench.seed = from;
    tel_begin();
    tape = (wh_tape){.state = WH_TAPE_NONE};
    bench.station.tape = &tape;
    memset(&got, 0, sizeof got);
    seen_steps = 0;
    tel_type("tel tape on");
    for (unsigned i = 0; i < 4U; i++) {
        period(FREE);
    }
    TEST_ASSERT_TRUE(got.begun && tape.state == WH_TAPE_RUNS);
}

/* What people order. */
static void type_something(void) {
    static const char *const lines[] = {"arm",  "arm",    "start 330", "start 200", "set 250",
                                        "stop", "status", "measure",   "clear"};
    if (draw_one_in(&bench.seed, 60)) {
        tel_type(lines[draw_one_of(&bench.seed, sizeof lines / sizeof lines[0])]);
    }
}

static void test_all_steps(void) {
    begin_tape(62);
    tel_type("tel rate 500");
    while (seen_steps < STEPS_MOST - 4U) {
        type_something();
        period(FREE);
    }
    tel_type("tel tape off");
    period(FREE);
    period(FREE);
    TEST_ASSERT_TRUE(got.ended && got.why == WH_TAPED_OFF && !got.missing);
    TEST_ASSERT_EQUAL_UINT(seen_steps, got.steps);
    TEST_ASSERT_EQUAL_UINT(0, bench.heard.bad);
}

/* Lines of all speeds: what comes is what was, in order and from the first step on; what is too much ends it, and that is
 * told. */
static void test_slow_lines(void) {
    static const unsigned a_step[] = {23, 12, 6, 3, 1};
    for (unsigned k = 0; k < sizeof a_step / sizeof a_step[0]; k++) {
        begin_tape(63U + k);
        while (seen_steps < 1000U && tape.state == WH_TAPE_RUNS) {
            type_something();
            period(a_step[k]);
        }
        for (unsigned i = 0; i < 40U; i++) {
            period(FREE);
        }
        TEST_ASSERT_TRUE((a_step[k] < 12U) == got.missing);
        TEST_ASSERT_EQUAL(got.missing, got.ended && got.why == WH_TAPED_LOST);
        TEST_ASSERT_TRUE(got.steps > 20U);
    }
}

/* An end that is ordered waits until there is room, for what was not out yet, too: nothing of it is lost. */
static void test_an_end_waits_for_room(void) {
    for (unsigned k = 0; k < 60U; k++) {
        begin_tape(163U + k);
        const unsigned first = 20U + draw_one_of(&bench.seed, 60);
        for (unsigned i = 0; i < first; i++) {
            period(FREE);
        }
        const unsigned deaf = draw_one_of(&bench.seed, 90);
        for (unsigned i = 0; i < deaf && tape.state == WH_TAPE_RUNS; i++) {
            period(0);
        }
        tel_type("tel tape off");
        const unsigned slow = draw_one_of(&bench.seed, 20);
        for (unsigned i = 0; i < slow; i++) {
            period(i % 4U);
        }
        for (unsigned i = 0; i < 40U; i++) {
            period(FREE);
        }
        TEST_ASSERT_TRUE(got.ended);
        if (got.why == WH_TAPED_OFF) {
            TEST_ASSERT_FALSE(got.missing);
            TEST_ASSERT_EQUAL_UINT(seen_steps, got.steps);
        }
    }
}

static void even_own(wh_rig_config *config) { *config = even_config(); }

static void answers(const char *line, const char *begins) {
    memset(&bench.heard, 0, sizeof bench.heard);
    tel_type(line);
    for (unsigned i = 0; i < 6U; i++) {
        period(FREE);
    }
    TEST_ASSERT_EQUAL_STRING_LEN(begins, bench.heard.text, strlen(begins));
}

static void test_answers(void) {
    static wh_conf conf;
    begin_tape(70);
    wh_conf_start(&conf, even_own, NULL, &bench.even.config);
    bench.station.conf = &conf;
    answers("tel list",
            "OK rate=0 fmt=frames dropped=0 channels=run,event,ring,tape tape=runs\r\n");
    answers("conf set gain 0.5", "ERR 120 ");
    answers("conf default", "ERR 120 ");
    answers("conf get gain", "OK gain=");
    answers("tel tape", "ERR 115 ");
    answers("tel tape twice", "ERR 115 ");
    answers("tel tape off", "OK tape=ends\r\n");
    TEST_ASSERT_TRUE(got.ended);
    answers("conf set gain 0.5", "OK gain=");
    memset(&got, 0, sizeof got);
    seen_steps = 0;
    answers("tel tape on", "OK tape=waits\r\n");
    TEST_ASSERT_TRUE(got.begun);
    TEST_ASSERT_EQUAL_UINT(1, got.settings);
    bench.station.tape = NULL;
    answers("tel tape on", "ERR 114 ");
    answers("tel list", "OK rate=0 fmt=frames dropped=0 channels=run,event,ring,tape\r\n");
}

#endif

void suite_step_tape(void) {
    RUN_TEST(test_bytes);
    RUN_TEST(test_lengths);
    RUN_TEST(test_exchanges);
#if WH_STATION_TAPE
    RUN_TEST(test_all_steps);
    RUN_TEST(test_slow_lines);
    RUN_TEST(test_an_end_waits_for_room);
    RUN_TEST(test_answers);
#endif
}
