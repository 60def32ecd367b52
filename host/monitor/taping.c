/* taping.c: see taping.h. */
#include "taping.h"

#include "core/frame.h"

/* --- onto the tape ---------------------------------------------------------------------------------------------- */

static void put_frame(taping *t, uint8_t kind, uint32_t ticks, const uint8_t *payload,
                      unsigned length) {
    uint8_t coded[WH_FRAME_BYTES(1024U)];
    const wh_frame frame = {.kind = kind,
                            .sequence = t->sequence,
                            .ticks = ticks,
                            .payload = payload,
                            .length = length};
    const unsigned count = wh_frame_write(&frame, coded, sizeof coded);
    fwrite(coded, 1, count, t->out); /* the caller asks ferror() */
}

static void put_hello(taping *t) {
    uint8_t payload[1024];
    wh_hello hello;
    wh_taped_hello(&hello, "recorded");
    put_frame(t, WH_FRAME_HELLO, 0, payload, wh_hello_put(&hello, payload, sizeof payload));
    t->asked = true;
}

/* An exchange `ticks` after the begin. */
static void put_exchange(taping *t, uint32_t ticks, const wh_readings *readings,
                         const wh_taped_answer *answer) {
    uint8_t payload[WH_READINGS_BYTES > WH_ORDERS_BYTES ? WH_READINGS_BYTES : WH_ORDERS_BYTES];
    wh_orders orders;
    if (!t->asked) {
        put_hello(t);
    }
    put_frame(t, WH_FRAME_READINGS, ticks, payload,
              wh_readings_put(readings, payload, sizeof payload));
    wh_taped_orders(answer, ticks, &orders);
    put_frame(t, WH_FRAME_ORDERS, ticks, payload, wh_orders_put(&orders, payload, sizeof payload));
    t->sequence++;
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

static void end(taping *t, bool lost, const char *why) {
    t->over = true;
    t->lost = lost;
    t->why = why;
}

static void add(wh_readings *to, unsigned channel, uint32_t raw) {
    to->sample[to->samples++] = (wh_sample){.raw = (int32_t)raw, .channel = (uint8_t)channel};
}

static void take_settings(taping *t, wh_bytes *in) {
    static const wh_taped_answer nothing; /* before it has started */
    while (in->room - in->at >= WH_TAPED_SETTING_BYTES) {
        if (t->start.samples == 2U * WH_TAPED_SETTINGS_MOST) {
            put_exchange(t, 0, &t->start, &nothing);
            t->start.samples = 0;
        }
        add(&t->start, WH_TAPED_SETTING, wh_bytes_get(in, 1));
        add(&t->start, WH_TAPED_SETTING_VALUE, wh_bytes_get(in, 4));
    }
}

static void take_begin(taping *t, uint32_t ticks, wh_bytes *in) {
    const uint32_t version = wh_bytes_get(in, 1);
    wh_taped_answer answer;
    wh_taped_get_answer(&answer, in);
    if (in->over || version != WH_TAPED_VERSION) {
        end(t, true, "the rig records in a way that this program does not know");
        return;
    }
    add(&t->start, WH_TAPED_STARTS, version);
    put_exchange(t, 0, &t->start, &answer);
    t->began = true;
    t->begin_ticks = ticks;
    t->before = (wh_taped_before){.ticks = ticks, .answer = answer};
}

static void take_steps(taping *t, uint32_t ticks, wh_bytes *in) {
    wh_taped_step step;
    wh_readings readings;
    for (bool first = true; in->at < in->room; first = false) {
        const uint32_t from = t->before.ticks;
        if (!wh_taped_get(&t->before, &step, in) || (first && step.ticks != ticks)) {
            end(t, true, "a frame of it is not what the rig should say");
            return;
        }
        wh_taped_readings(&step, t->begin_ticks, &readings);
        put_exchange(t, step.ticks - t->begin_ticks, &readings, &step.answer);
        t->length_ticks += step.ticks - from;
        t->steps++;
    }
}

void taping_anew(taping *t) {
    if (t->any && !t->over) {
        end(t, true, "the rig began anew");
    }
}

/* A gap before it is what it tells of, unless it knows of none. */
static void take_end(taping *t, bool gap, wh_bytes *in) {
    static const char *const words[] = {
#define WORDS(end, words) words,
        WH_TAPED_END_ROWS(WORDS)
#undef WORDS
    };
    const uint32_t why = wh_bytes_get(in, 1);
    if (gap && why == WH_TAPED_OFF) {
        end(t, true, "a frame of it was lost");
    } else {
        end(t, why != WH_TAPED_OFF, why < WH_TAPED_ENDS ? words[why] : "the rig says no more");
    }
}

void taping_frame(taping *t, const wire_frame *frame) {
    wh_bytes in = {.from = frame->payload, .room = frame->length};
    const uint32_t kind = wh_bytes_get(&in, 1);
    const bool gap = t->any && frame->sequence != t->next;
    if (t->over || (!t->any && kind != WH_TAPED_SETTINGS && kind != WH_TAPED_BEGIN)) {
        return; /* of a tape before this one */
    }
    t->any = true;
    t->next = (uint16_t)(frame->sequence + 1U);
    if (kind == WH_TAPED_END) {
        take_end(t, gap, &in);
    } else if (gap) {
        end(t, true, "a frame of it was lost");
    } else if (kind == WH_TAPED_STEPS && t->began) {
        take_steps(t, frame->ticks, &in);
    } else if (kind == WH_TAPED_SETTINGS && !t->began) {
        take_settings(t, &in);
    } else if (kind == WH_TAPED_BEGIN && !t->began) {
        take_begin(t, frame->ticks, &in);
    } else {
        end(t, true, "another one was begun");
    }
}
