/* step_tape.c: steps as bytes and as exchanges; each `put` has its `get` behind it. */
#include "step_tape.h"

#define PAIR 2U /* samples that are told together */

_Static_assert(2U + PAIR * WH_TAPED_SAMPLES + PAIR * WH_TAPED_ORDERS <= WH_SAMPLES_MAX,
               "a step is one exchange");
_Static_assert(PAIR *WH_TAPED_SETTINGS_MOST + 1U <= WH_SAMPLES_MAX, "and so are some settings");

/* What stands in a step, by its first byte; samples are two bits of it. */
enum { TICKS = 1, SUPPLY = 2, PINS = 4, PULSE = 8, SAMPLES_AT = 4, ORDERS = 64, ANSWER = 128 };
/* And in a sample, by its first: the status is three bits of it. */
enum { STATUS = 7, LATE = 8, LATE_LONG = 16, RAW_LONG = 32 };
/* And in an answer that is not as it was: the way is two bits of it. */
enum { WAY = 3, VOLTS = 4, STAGE = 8, TRIP = 16 };

/* --- bytes ------------------------------------------------------------------------------------------------------*/

static void put_sample(wh_taped_before *before, const wh_taped_sample *sample, uint32_t now_ticks,
                       wh_bytes *out) {
    const uint32_t late = now_ticks - sample->ticks;
    const unsigned is_late = late == before->late ? 0U : late < 0x10000U ? LATE : LATE_LONG;
    const bool is_long = sample->raw > 32767 || sample->raw < -32768;
    wh_bytes_put(out, (sample->status & (unsigned)STATUS) | is_late | (is_long ? RAW_LONG : 0U), 1);
    if (is_late != 0) {
        wh_bytes_put(out, late, is_late == LATE ? 2U : 4U);
    }
    wh_bytes_put(out, (uint32_t)sample->raw, is_long ? 4U : 2U);
    before->late = late;
}

static void get_sample(wh_taped_before *before, wh_taped_sample *sample, uint32_t now_ticks,
                       wh_bytes *in) {
    const uint32_t head = wh_bytes_get(in, 1);
    if ((head & (LATE | LATE_LONG)) != 0) {
        before->late = wh_bytes_get(in, (head & LATE) != 0 ? 2U : 4U);
    }
    sample->status = (uint8_t)(head & STATUS);
    sample->ticks = now_ticks - before->late;
    sample->raw = (head & RAW_LONG) != 0 ? (int32_t)wh_bytes_get(in, 4)
                                         : (int16_t)(uint16_t)wh_bytes_get(in, 2);
}

static bool same_answer(const wh_taped_answer *one, const wh_taped_answer *other) {
    return one->way == other->way && one->volts == other->volts && one->stage == other->stage &&
           one->trip == other->trip;
}

static void put_change(const wh_taped_answer *before, const wh_taped_answer *now, wh_bytes *out) {
    const unsigned changed = (now->volts != before->volts ? (unsigned)VOLTS : 0U) |
                             (now->stage != before->stage ? (unsigned)STAGE : 0U) |
                             (now->trip != before->trip ? (unsigned)TRIP : 0U);
    wh_bytes_put(out, (now->way & (unsigned)WAY) | changed, 1);
    if ((changed & VOLTS) != 0) {
        wh_bytes_put(out, now->volts, 4);
    }
    if ((changed & STAGE) != 0) {
        wh_bytes_put(out, now->stage, 1);
    }
    if ((changed & TRIP) != 0) {
        wh_bytes_put(out, now->trip, 1);
    }
}

static void get_change(wh_taped_answer *answer, wh_bytes *in) {
    const uint32_t changed = wh_bytes_get(in, 1);
    answer->way = (uint8_t)(changed & WAY);
    if ((changed & VOLTS) != 0) {
        answer->volts = wh_bytes_get(in, 4);
    }
    if ((changed & STAGE) != 0) {
        answer->stage = (uint8_t)wh_bytes_get(in, 1);
    }
    if ((changed & TRIP) != 0) {
        answer->trip = (uint8_t)wh_bytes_get(in, 1);
    }
}

void wh_taped_put(wh_taped_before *before, const wh_taped_step *step, wh_bytes *out) {
    const uint32_t period = step->ticks - before->ticks;
    const unsigned head = (period != WH_TAPED_PERIOD ? (unsigned)TICKS : 0U) |
                          (step->supply != before->supply ? (unsigned)SUPPLY : 0U) |
                          (step->pins != before->pins ? (unsigned)PINS : 0U) |
                          (step->pulsed ? (unsigned)PULSE : 0U) | step->samples << SAMPLES_AT |
                          (step->orders > 0 ? (unsigned)ORDERS : 0U) |
                          (same_answer(&step->answer, &before->answer) ? 0U : (unsigned)ANSWER);
    wh_bytes_put(out, head, 1);
    if ((head & TICKS) != 0) {
        wh_bytes_put(out, period, 4);
    }
    if ((head & SUPPLY) != 0) {
        wh_bytes_put(out, step->supply, 4);
    }
    if ((head & PINS) != 0) {
        wh_bytes_put(out, step->pins, 1);
    }
    if ((head & PULSE) != 0) {
        wh_bytes_put(out, step->sensor, 1);
        wh_bytes_put(out, step->ticks - step->pulse_ticks, 4);
    }
    for (unsigned i = 0; i < step->samples; i++) {
        put_sample(before, &step->sample[i], step->ticks, out);
    }
    if ((head & ORDERS) != 0) {
        wh_bytes_put(out, step->orders, 1);
        for (unsigned i = 0; i < step->orders; i++) {
            wh_bytes_put(out, step->order[i].event, 1);
            wh_bytes_put(out, step->order[i].value, 4);
        }
    }
    if ((head & ANSWER) != 0) {
        put_change(&before->answer, &step->answer, out);
    }
    before->ticks = step->ticks;
    before->supply = step->supply;
    before->pins = step->pins;
    before->answer = step->answer;
}

bool wh_taped_get(wh_taped_before *before, wh_taped_step *step, wh_bytes *in) {
    const uint32_t head = wh_bytes_get(in, 1);
    *step = (wh_taped_step){.samples = head >> SAMPLES_AT & 3U};
    if (step->samples > WH_TAPED_SAMPLES) {
        return false;
    }
    before->ticks += (head & TICKS) != 0 ? wh_bytes_get(in, 4) : WH_TAPED_PERIOD;
    before->supply = (head & SUPPLY) != 0 ? wh_bytes_get(in, 4) : before->supply;
    before->pins = (head & PINS) != 0 ? (uint8_t)wh_bytes_get(in, 1) : before->pins;
    step->ticks = before->ticks;
    step->supply = before->supply;
    step->pins = before->pins;
    step->pulsed = (head & PULSE) != 0;
    if (step->pulsed) {
        step->sensor = (uint8_t)wh_bytes_get(in, 1);
        step->pulse_ticks = step->ticks - wh_bytes_get(in, 4);
    }
    for (unsigned i = 0; i < step->samples; i++) {
        get_sample(before, &step->sample[i], step->ticks, in);
    }
    step->orders = (head & ORDERS) != 0 ? (unsigned)wh_bytes_get(in, 1) : 0U;
    if (step->orders > WH_TAPED_ORDERS) {
        return false;
    }
    for (unsigned i = 0; i < step->orders; i++) {
        step->order[i].event = (uint8_t)wh_bytes_get(in, 1);
        step->order[i].value = wh_bytes_get(in, 4);
    }
    if ((head & ANSWER) != 0) {
        get_change(&before->answer, in);
    }
    step->answer = before->answer;
    return !in->over;
}

void wh_taped_put_answer(const wh_taped_answer *answer, wh_bytes *out) {
    wh_bytes_put(out, answer->way, 1);
    wh_bytes_put(out, answer->volts, 4);
    wh_bytes_put(out, answer->stage, 1);
    wh_bytes_put(out, answer->trip, 1);
}

void wh_taped_get_answer(wh_taped_answer *answer, wh_bytes *in) {
    answer->way = (uint8_t)wh_bytes_get(in, 1);
    answer->volts = wh_bytes_get(in, 4);
    answer->stage = (uint8_t)wh_bytes_get(in, 1);
    answer->trip = (uint8_t)wh_bytes_get(in, 1);
}

/* --- exchanges --------------------------------------------------------------------------------------------------*/

#define OUTPUT(word, si, most) \
    { .kind = WH_SIGNAL_OUTPUT, .name = (word), .unit = (si), .low = 0.0f, .high = (most) }
#define EDGE(word) \
    { .kind = WH_SIGNAL_EDGE, .name = (word), .unit = "1" }
#define SAMPLE(word) \
    { \
        .kind = WH_SIGNAL_SAMPLE, .name = (word), .unit = "1", .per_count = 1.0f, \
        .period_ticks = WH_TAPED_PERIOD \
    }
#define NOTE(word) \
    { .kind = WH_SIGNAL_NOTE, .name = (word), .unit = "1" }

static const wh_signal signals[] = {OUTPUT("way", "1", 2.0f),
                                    OUTPUT("volts", "V", 60.0f),
                                    EDGE("slot1"),
                                    EDGE("slot2"),
                                    SAMPLE("load_raw"),
                                    SAMPLE("load_status"),
                                    SAMPLE("supply"),
                                    SAMPLE("pins"),
                                    SAMPLE("order"),
                                    SAMPLE("order_value"),
                                    SAMPLE("setting"),
                                    SAMPLE("setting_value"),
                                    SAMPLE("starts"),
                                    NOTE("state"),
                                    NOTE("trip")};

enum { WAY_OUT, VOLTS_OUT, STATE_OUT, TRIP_OUT, OUTPUTS }; /* by their channels */

_Static_assert(sizeof signals / sizeof signals[0] <= WH_SIGNALS_MAX, "the line takes them");

void wh_taped_hello(wh_hello *hello, const char *board) {
    *hello = (wh_hello){.program = "rig_taped",
                        .board = board,
                        .ticks_per_s = 1000000U,
                        .signal = signals,
                        .signals = sizeof signals / sizeof signals[0]};
}

static void add_sample(wh_readings *to, unsigned channel, uint32_t ticks, uint32_t raw) {
    to->sample[to->samples++] =
        (wh_sample){.ticks = ticks, .raw = (int32_t)raw, .channel = (uint8_t)channel};
}

void wh_taped_readings(const wh_taped_step *step, uint32_t begin_ticks, wh_readings *readings) {
    const uint32_t now_ticks = step->ticks - begin_ticks;
    readings->flags = 0;
    readings->edges = 0;
    readings->samples = 0;
    add_sample(readings, WH_TAPED_SUPPLY, now_ticks, step->supply);
    add_sample(readings, WH_TAPED_PINS, now_ticks, step->pins);
    for (unsigned i = 0; i < step->orders; i++) {
        add_sample(readings, WH_TAPED_ORDER, now_ticks, step->order[i].event);
        add_sample(readings, WH_TAPED_ORDER_VALUE, now_ticks, step->order[i].value);
    }
    if (step->pulsed) {
        readings->edge[readings->edges++] =
            (wh_edge){.ticks = step->pulse_ticks - begin_ticks, .channel = step->sensor};
    }
    for (unsigned i = 0; i < step->samples; i++) {
        const wh_taped_sample *sample = &step->sample[i];
        const uint32_t ticks = sample->ticks - begin_ticks;
        if (sample->status != 0) {
            add_sample(readings, WH_TAPED_STATUS, ticks, sample->status);
        }
        add_sample(readings, WH_TAPED_LOAD, ticks, (uint32_t)sample->raw);
    }
}

void wh_taped_step_of(const wh_readings *readings, uint32_t now_ticks, wh_taped_step *step) {
    uint8_t status = 0;
    uint8_t event = 0;
    *step = (wh_taped_step){.ticks = now_ticks, .pulsed = readings->edges > 0};
    if (step->pulsed) {
        step->sensor = readings->edge[0].channel;
        step->pulse_ticks = readings->edge[0].ticks;
    }
    for (unsigned i = 0; i < readings->samples; i++) {
        const wh_sample *sample = &readings->sample[i];
        const uint32_t raw = (uint32_t)sample->raw;
        if (sample->channel == WH_TAPED_SUPPLY) {
            step->supply = raw;
        } else if (sample->channel == WH_TAPED_PINS) {
            step->pins = (uint8_t)raw;
        } else if (sample->channel == WH_TAPED_ORDER) {
            event = (uint8_t)raw;
        } else if (sample->channel == WH_TAPED_ORDER_VALUE && step->orders < WH_TAPED_ORDERS) {
            step->order[step->orders++] = (wh_taped_order){.event = event, .value = raw};
        } else if (sample->channel == WH_TAPED_STATUS) {
            status = (uint8_t)raw;
        } else if (sample->channel == WH_TAPED_LOAD && step->samples < WH_TAPED_SAMPLES) {
            step->sample[step->samples++] =
                (wh_taped_sample){.ticks = sample->ticks, .raw = sample->raw, .status = status};
            status = 0;
        }
    }
}

void wh_taped_orders(const wh_taped_answer *answer, uint32_t now_ticks, wh_orders *orders) {
    *orders = (wh_orders){.until_ticks = now_ticks + WH_TAPED_PERIOD, .outputs = OUTPUTS};
    orders->output[WAY_OUT] = (float)answer->way;
    orders->output[VOLTS_OUT] = wh_taped_float(answer->volts);
    orders->output[STATE_OUT] = (float)answer->stage;
    orders->output[TRIP_OUT] = (float)answer->trip;
}
