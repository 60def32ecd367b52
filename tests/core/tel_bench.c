/* tel_bench.c: a station with telemetry that gets random samples and pulses, and a receiver of its line. */
#include "tel_bench.h"

#include <string.h>

#include "draw.h"
#include "unity.h"

tel_bench bench;

void tel_begin(void) {
    even_start(&bench.even);
    even_rest(&bench.even);
    wh_station_start(&bench.station, "rig", "here", STEPS_PER_S);
    bench.tel = (wh_tel){.every = 0};
    bench.station.tel = &bench.tel;
    memset(&bench.heard, 0, sizeof bench.heard);
    memset(&bench.got, 0, sizeof bench.got);
    bench.samples.put = bench.samples.taken = bench.pulses.put = bench.pulses.taken = 0;
    bench.cell_ticks = bench.even.inputs.now_ticks;
}

void tel_type(const char *line) {
    wh_station_take(&bench.station, line, (unsigned)strlen(line));
    wh_station_take(&bench.station, "\n", 1);
}

/* Finds the next item of this kind with this time and value. Items before it count as dropped. If samples come
 * irregularly, their times are exact to an eighth of their period. */
static void find_sample(uint32_t ticks, int32_t value) {
    const uint32_t within = bench.got.uneven ? bench.tel.every * EVEN_STEP_TICKS / 8U : 0;
    while (bench.samples.taken < bench.samples.put &&
           (ticks - bench.samples.ticks[bench.samples.taken % TRUTHS] + within > 2U * within ||
            bench.samples.value[bench.samples.taken % TRUTHS] != value)) {
        bench.samples.taken++;
    }
    TEST_ASSERT_TRUE(bench.samples.taken < bench.samples.put);
    bench.samples.taken++;
}

/* Begins and ends of pulses are in one sequence. The value of an end is the sensor plus this bit. */
#define OF_AN_END 2

static void find_pulse(uint32_t ticks, int32_t sensor) {
    while (bench.pulses.taken < bench.pulses.put &&
           bench.pulses.ticks[bench.pulses.taken % TRUTHS] != ticks) {
        bench.pulses.taken++;
    }
    TEST_ASSERT_TRUE(bench.pulses.taken < bench.pulses.put);
    TEST_ASSERT_EQUAL_INT32(bench.pulses.value[bench.pulses.taken % TRUTHS], sensor);
    bench.pulses.taken++;
}

void tel_hear_frame(const wire_frame *frame) {
    TEST_ASSERT_TRUE(frame->channel < WH_TEL_CHANNELS);
    const uint16_t gap = (uint16_t)(frame->sequence - bench.got.next[frame->channel]);
    const uint16_t dropped = (uint16_t)(frame->dropped - bench.got.before[frame->channel]);
    TEST_ASSERT_TRUE(bench.got.broken || gap == dropped);
    bench.got.gaps += gap;
    bench.got.dropped += dropped;
    bench.got.before[frame->channel] = frame->dropped;
    bench.got.any[frame->channel] = true;
    bench.got.next[frame->channel] = (uint16_t)(frame->sequence + 1U);
    bench.got.frames++;
    if (bench.got.blind) {
        return;
    }
    if (frame->channel == WH_TEL_RUN) {
        const unsigned count = (frame->count - 5U) / 2U;
        TEST_ASSERT_TRUE(count >= 1U && count <= 10U && frame->count == 5U + 2U * count);
        for (unsigned i = 0; i < count; i++) {
            const int16_t load = (int16_t)wire_number(frame->payload + 5U + 2U * i, 2);
            find_sample(frame->ticks + i * bench.tel.every * EVEN_STEP_TICKS, load);
        }
        bench.got.loads += count;
    } else if (frame->channel == WH_TEL_EVENT) {
        TEST_ASSERT_EQUAL_UINT(2, frame->count);
        if (frame->payload[0] == WH_TEL_PULSE || frame->payload[0] == WH_TEL_END) {
            find_pulse(frame->ticks,
                       frame->payload[1] + (frame->payload[0] == WH_TEL_END ? OF_AN_END : 0));
        }
    }
}

void tel_hear(unsigned bytes) {
    char room[64];
    while (bytes > 0) {
        const unsigned most = bytes < sizeof room ? bytes : (unsigned)sizeof room;
        const unsigned count = wh_station_peek(&bench.station, room, most);
        wh_station_drop(&bench.station, count);
        for (unsigned i = 0; i < count; i++) {
            wire_frame frame;
            if (wire_take(&bench.heard, (uint8_t)room[i], &frame)) {
                tel_hear_frame(&frame);
            }
        }
        if (count < most) {
            return;
        }
        bytes -= most;
    }
}

static void draw_sample(bool evenly) {
    const wh_cell_config *cell = &bench.even.config.measure.cell;
    wh_step_sample *sample = &bench.seen.sample[bench.seen.samples++];
    const unsigned shift = wh_tel_shift(cell);
    sample->ticks = bench.cell_ticks;
    sample->raw = (int32_t)draw_whole(&bench.seed, (int)-cell->raw_max, (int)cell->raw_max);
    if (draw_one_in(&bench.seed, 40)) { /* full scale, which is invalid even without the status */
        sample->raw = draw_one_in(&bench.seed, 2) ? cell->raw_max : -cell->raw_max;
    }
    sample->status = WH_LOAD_OK;
    if (!evenly && draw_one_in(&bench.seed, 30)) {
        sample->status = (wh_load_status)draw_one_of(&bench.seed, WH_LOAD_STATUSES);
    }
    const bool full = sample->status == WH_LOAD_OK &&
                      (sample->raw >= cell->raw_max || sample->raw <= -cell->raw_max);
    const bool none =
        full || sample->status == WH_LOAD_SATURATED || sample->status == WH_LOAD_DISCONNECTED;
    if (sample->status == WH_LOAD_REPEATED) {
        return;
    }
    bench.samples.ticks[bench.samples.put % TRUTHS] = bench.cell_ticks - cell->delay_ticks;
    bench.samples.value[bench.samples.put % TRUTHS] = none ? -32768 : sample->raw / (1 << shift);
    bench.samples.put++;
}

static void put_pulse(uint32_t ticks, int32_t value) {
    bench.pulses.ticks[bench.pulses.put % TRUTHS] = ticks;
    bench.pulses.value[bench.pulses.put % TRUTHS] = value;
    bench.pulses.put += bench.tel.every > 0 && bench.tel.format == WH_TEL_FRAMES ? 1U : 0U;
}

void tel_draw_seen(bool evenly) {
    bench.seen = (wh_step_inputs){.inputs = bench.even.inputs};
    bench.cell_ticks += EVEN_STEP_TICKS;
    if (evenly || !draw_one_in(&bench.seed, 40)) {
        draw_sample(evenly);
    }
    if (!evenly && draw_one_in(&bench.seed, 50)) { /* two samples at once, or a gap */
        bench.cell_ticks += draw_one_in(&bench.seed, 2) ? EVEN_STEP_TICKS : 777U;
        draw_sample(evenly);
    }
    bench.seen.ended = draw_one_in(&bench.seed, 45);
    if (bench.seen.ended) {
        bench.seen.end_sensor = draw_one_of(&bench.seed, 2);
        bench.seen.end_ticks = bench.even.inputs.now_ticks - 1999U - draw_one_of(&bench.seed, 1999);
        put_pulse(bench.seen.end_ticks, OF_AN_END + (int32_t)bench.seen.end_sensor);
    }
    bench.seen.pulsed = draw_one_in(&bench.seed, 45);
    if (bench.seen.pulsed) {
        bench.seen.sensor = draw_one_of(&bench.seed, 2);
        bench.seen.pulse_ticks = bench.even.inputs.now_ticks - draw_one_of(&bench.seed, 1999);
        put_pulse(bench.seen.pulse_ticks, (int32_t)bench.seen.sensor);
    }
}

void tel_step(void) {
    wh_station_see(&bench.station, &bench.even.config, &bench.even.rig, &bench.seen);
    wh_station_step(&bench.station, &bench.even.rig);
}

void tel_period(bool evenly, unsigned bytes) {
    even_step(&bench.even);
    tel_draw_seen(evenly);
    tel_step();
    tel_hear(bytes);
}

void tel_turn_on(const char *rate) {
    tel_type(rate);
    tel_period(true, FREE);
    TEST_ASSERT_TRUE(bench.tel.every > 0);
    bench.samples.taken = bench.samples.put;
    bench.pulses.taken = bench.pulses.put;
}
