/* taped.c: reading what `whirl pil --tape` has kept. */
#include "taped.h"

#include <errno.h>
#include <string.h>

#include "core/hash.h"
#include "talk.h"

/* A frame and the zeros round it have so many bytes at most: a device that never ends is no tape. */
static bool read_frame(taped *t, wh_frame *frame) {
    for (size_t i = 0; i < sizeof t->bytes + 2; i++) {
        const int byte = getc(t->file);
        if (byte == EOF || wh_frame_take(&t->reader, (uint8_t)byte, frame)) {
            return byte != EOF;
        }
    }
    t->endless = true;
    return false;
}

/* It ends within a frame, had what is none, or could not be read on. */
static bool is_cut_off(const taped *t) {
    return t->reader.dropped > 0 || t->reader.length > 0 || t->endless || ferror(t->file) != 0;
}

/* What a tape cannot be. */
static bool is_no_tape(taped *t, const char *why) {
    if (ferror(t->file) != 0) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", t->name, strerror(errno));
    } else {
        fprintf(stderr,
                "%s: error: %s after %llu exchanges\nhint: whirl pil SCENE --tape FILE makes one\n",
                t->name, why, (unsigned long long)t->turns);
    }
    t->failed = true;
    return false;
}

/* Of the plant, of what the firmware's timer says. */
static double time_of(const taped *t, uint32_t ticks) {
    return t->before_s + (double)(ticks - t->hello.start_ticks) / (double)t->hello.ticks_per_s;
}

bool taped_open(taped *t, const char *name) {
    wh_frame frame;
    *t = (taped){.name = name, .file = fopen(name, "rb"), .hash = WH_HASH_START};
    wh_frame_reader_start(&t->reader, t->bytes, sizeof t->bytes);
    if (t->file == NULL) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", name, strerror(errno));
        t->failed = true;
        return false;
    }
    if (!read_frame(t, &frame) || frame.version != WH_FRAME_VERSION ||
        frame.kind != WH_FRAME_HELLO || frame.length > sizeof t->words) {
        return is_no_tape(t, "no tape of this version");
    }
    memcpy(t->words, frame.payload, frame.length);
    if (!wh_hello_get(&t->hello, t->signal, t->words, frame.length) || t->hello.ticks_per_s == 0) {
        return is_no_tape(t, "no tape of this version");
    }
    return true;
}

void taped_close(taped *t) {
    if (t->file != NULL) {
        fclose(t->file);
    }
}

unsigned taped_channels(const taped *t, wh_signal_kind kind) {
    unsigned count = 0;
    for (unsigned i = 0; i < t->hello.signals; i++) {
        count += t->signal[i].kind == kind;
    }
    return count;
}

/* Of channels that the hello has. */
static bool has_channels(const taped *t, const taped_turn *turn) {
    const unsigned edges = taped_channels(t, WH_SIGNAL_EDGE);
    const unsigned samples = taped_channels(t, WH_SIGNAL_SAMPLE);
    const unsigned outputs =
        taped_channels(t, WH_SIGNAL_OUTPUT) + taped_channels(t, WH_SIGNAL_NOTE);
    bool good = !turn->answered || turn->orders.outputs == outputs;
    for (unsigned i = 0; i < turn->readings.edges; i++) {
        good = good && turn->readings.edge[i].channel < edges;
    }
    for (unsigned i = 0; i < turn->readings.samples; i++) {
        good = good && turn->readings.sample[i].channel < samples;
    }
    return good;
}

/* The frame is a hello: the firmware was started again. The next one says why. */
static bool take_reset(taped *t, wh_frame *frame, taped_turn *turn) {
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    if (!wh_hello_get(&hello, signal, frame->payload, frame->length) ||
        !talk_is_same_hello(&hello, &t->hello) || !read_frame(t, frame) ||
        frame->kind != WH_FRAME_RESET ||
        !wh_reset_get(&turn->reset, frame->payload, frame->length)) {
        return is_no_tape(t, "it is broken");
    }
    turn->is_reset = true;
    turn->ticks = frame->ticks;
    turn->time_s = time_of(t, frame->ticks);
    t->before_s = turn->time_s;
    t->sequence = 0;
    return true;
}

/* The next frame that is not there to be remembered. */
static bool read_orders(taped *t, wh_frame *frame) {
    while (read_frame(t, frame)) {
        if (frame->kind != WH_FRAME_REMEMBER) {
            return true;
        }
        t->hash = talk_hash_bytes(t->hash, frame->payload, frame->length);
    }
    return false;
}

bool taped_next(taped *t, taped_turn *turn) {
    wh_frame frame;
    *turn = (taped_turn){.is_reset = false};
    if (!read_frame(t, &frame)) {
        return is_cut_off(t) ? is_no_tape(t, "it is broken") : false;
    }
    if (frame.kind == WH_FRAME_HELLO) {
        return take_reset(t, &frame, turn);
    }
    turn->ticks = frame.ticks;
    turn->time_s = time_of(t, frame.ticks);
    if (frame.kind != WH_FRAME_READINGS || frame.sequence != t->sequence ||
        !wh_readings_get(&turn->readings, frame.payload, frame.length)) {
        return is_no_tape(t, "it is broken");
    }
    turn->answered = read_orders(t, &frame);
    if (!turn->answered && is_cut_off(t)) {
        return is_no_tape(t, "it is broken");
    }
    if (turn->answered && (frame.kind != WH_FRAME_ORDERS || frame.sequence != t->sequence ||
                           !wh_orders_get(&turn->orders, frame.payload, frame.length))) {
        return is_no_tape(t, "it is broken");
    }
    if (!has_channels(t, turn)) {
        return is_no_tape(t, "it is broken");
    }
    if (turn->answered) {
        t->hash = talk_hash(t->hash, &turn->orders);
    }
    t->sequence++;
    t->turns++;
    return true;
}
