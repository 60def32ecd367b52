/* talk.c: frames to and from the firmware, its start and its end. */
#include "talk.h"

#include <string.h>

#include "core/hash.h"
#include "host/base/interrupts.h"

#define ASK_S 0.25 /* interval between requests for a hello */

/* --- frames ---------------------------------------------------------------------------------------------------*/

static void keep_on_tape(talk *t, const uint8_t *bytes, unsigned count) {
    if (t->tape != NULL && fwrite(bytes, 1, count, t->tape) != count) {
        fprintf(stderr, "whirl pil: error: the tape cannot be written\n");
        t->report->end = LOCKSTEP_FAILED;
        t->tape = NULL;
    }
}

/* Record a received frame by coding it again: the coding of a frame is unique. */
static void keep_heard(talk *t, const wh_frame *frame) {
    uint8_t coded[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
    keep_on_tape(t, coded, wh_frame_write(frame, coded, sizeof coded));
}

static void say_silent(const talk *t) {
    fprintf(stderr,
            "whirl pil: error: the firmware has said nothing for %g s\n"
            "hint: %s; --patience says how long to wait\n",
            t->guest.wish.patience_s,
            t->wish->guest.by_line
                ? "a frame that the line has damaged is not asked for again: reset the board"
                : "an endless loop, or a read that nobody answers");
}

/* Ctrl-C reaches all processes in the terminal, and the firmware may end first. */
static lockstep_end when_ended(void) { return interrupted ? LOCKSTEP_STOPPED : LOCKSTEP_DONE; }

static bool hear_frame(talk *t, wh_frame *frame) {
    switch (guest_receive(&t->guest, frame)) {
    case GUEST_FRAME: break;
    case GUEST_ENDED: t->report->end = when_ended(); return false;
    case GUEST_SILENT:
        say_silent(t);
        t->report->end = LOCKSTEP_FAILED;
        return false;
    case GUEST_STOPPED: t->report->end = LOCKSTEP_STOPPED; return false;
    }
    if (frame->version != WH_FRAME_VERSION) {
        fprintf(stderr,
                "whirl pil: error: the firmware speaks version %u of the exchange, this program "
                "version %u\nhint: build both from one source\n",
                frame->version, WH_FRAME_VERSION);
        t->report->end = LOCKSTEP_BAD;
        return false;
    }
    return true;
}

static bool fail(talk *t, const char *what) {
    fprintf(stderr, "whirl pil: error: the firmware sent %s in exchange %llu\n", what,
            (unsigned long long)t->report->exchanges);
    t->report->end = LOCKSTEP_FAILED;
    return false;
}

static bool say(talk *t, const wh_frame *frame) {
    uint8_t coded[WH_FRAME_BYTES(WH_READINGS_BYTES)];
    const unsigned count = wh_frame_write(frame, coded, sizeof coded);
    keep_on_tape(t, coded, count);
    switch (guest_send(&t->guest, coded, count)) {
    case GUEST_FRAME: return true;
    case GUEST_STOPPED: t->report->end = LOCKSTEP_STOPPED; return false;
    case GUEST_ENDED:
    case GUEST_SILENT: break;
    }
    t->report->end = when_ended(); /* its end has the details */
    return false;
}

bool talk_tell(talk *t, uint32_t ticks, const wh_readings *readings) {
    uint8_t payload[WH_READINGS_BYTES];
    const wh_frame frame = {.kind = WH_FRAME_READINGS,
                            .sequence = t->sequence,
                            .ticks = ticks,
                            .payload = payload,
                            .length = wh_readings_put(readings, payload, sizeof payload)};
    return say(t, &frame);
}

/* Ask for its next message: its hello, or the answer to its end. */
static guest_heard ask(talk *t) {
    uint8_t coded[WH_FRAME_BYTES(0)];
    const wh_frame frame = {.kind = WH_FRAME_ASK};
    return guest_send(&t->guest, coded, wh_frame_write(&frame, coded, sizeof coded));
}

static bool take_end(talk *t, const wh_frame *frame) {
    wh_bytes bytes = {.from = frame->payload, .room = frame->length};
    t->said_end = frame->length == 4U;
    t->end_status = (int)(int32_t)wh_bytes_get(&bytes, 4);
    if (!t->said_end) {
        return fail(t, "an end that is none");
    }
    (void)ask(t);
    t->report->end = when_ended();
    return false;
}

/* The next frame other than remembered data. After repeated requests, a firmware sends its hello several times before
 * its first orders. */
static bool hear_past_remembered(talk *t, wh_frame *frame) {
    while (hear_frame(t, frame)) {
        if (frame->kind == WH_FRAME_END) {
            return take_end(t, frame);
        }
        if (frame->kind == WH_FRAME_HELLO && t->wish->guest.by_line && t->sequence == 0) {
            continue;
        }
        if (frame->kind != WH_FRAME_REMEMBER) {
            return true;
        }
        if (frame->length > WH_REMEMBER_MAX) {
            return fail(t, "more than can be remembered");
        }
        keep_heard(t, frame);
        t->report->hash = talk_hash_bytes(t->report->hash, frame->payload, frame->length);
        t->remembered.count = frame->length;
        memcpy(t->remembered.remembered, frame->payload, frame->length);
    }
    return false;
}

bool talk_hear(talk *t, wh_orders *orders) {
    wh_frame frame;
    if (!hear_past_remembered(t, &frame)) {
        return false;
    }
    if (frame.kind != WH_FRAME_ORDERS || frame.sequence != t->sequence) {
        return fail(t, "a frame that is no answer");
    }
    if (!wh_orders_get(orders, frame.payload, frame.length) || orders->outputs != t->outputs) {
        return fail(t, "orders that are none");
    }
    keep_heard(t, &frame);
    t->sequence++;
    t->report->exchanges++;
    t->report->hash = talk_hash(t->report->hash, orders);
    for (unsigned i = 0; i < t->report->notes; i++) {
        t->report->note[i].value = (double)orders->output[t->outputs - t->report->notes + i];
    }
    return t->report->end != LOCKSTEP_FAILED;
}

uint64_t talk_hash(uint64_t hash, const wh_orders *orders) {
    hash = wh_hash_u64(hash, orders->until_ticks);
    hash = wh_hash_u64(hash, orders->watchdog_ticks);
    hash = wh_hash_u64(hash, orders->flags);
    for (unsigned i = 0; i < orders->outputs; i++) {
        uint32_t bits;
        memcpy(&bits, &orders->output[i], sizeof bits);
        hash = wh_hash_u64(hash, bits);
    }
    return hash;
}

uint64_t talk_hash_bytes(uint64_t hash, const uint8_t *bytes, unsigned count) {
    hash = wh_hash_u64(hash, count);
    for (unsigned i = 0; i < count; i++) {
        hash = wh_hash_u64(hash, bytes[i]);
    }
    return hash;
}

/* --- beginning and end ------------------------------------------------------------------------------------------*/

/* It ended before its first message. If the image could not be run, the child has reported that. */
static void say_no_hello(talk *t) {
    const guest_end_status end = guest_end(&t->guest);
    t->report->end = LOCKSTEP_BAD;
    if (end.status == GUEST_NOT_RUN) {
        fputs(t->guest.emulated ? "hint: make deps installs QEMU\n"
                                : "hint: is it a program of this machine, and executable?\n",
              stderr);
    } else {
        fprintf(stderr,
                "%s: error: it ended without a hello\nhint: is it made for `whirl pil`, as "
                "build/pil_rig and build/BOARD/pil_rig.elf are?\n",
                t->guest.wish.image);
    }
}

/* Into the caller's texts and signals. */
static bool take_hello_frame(talk *t, const wh_frame *frame, wh_hello *hello, wh_signal *signal,
                             uint8_t *words, unsigned room) {
    if (frame->kind != WH_FRAME_HELLO || frame->length > room) {
        return fail(t, "no hello");
    }
    memcpy(words, frame->payload, frame->length);
    if (!wh_hello_get(hello, signal, words, frame->length) || hello->ticks_per_s == 0) {
        return fail(t, "a hello that is none");
    }
    keep_heard(t, frame);
    return true;
}

static bool take_hello(talk *t, wh_hello *hello, wh_signal *signal, uint8_t *words, unsigned room) {
    wh_frame frame;
    if (!hear_frame(t, &frame)) {
        if (t->report->end == LOCKSTEP_DONE) { /* before it has said anything */
            say_no_hello(t);
        }
        return false;
    }
    return take_hello_frame(t, &frame, hello, signal, words, room);
}

/* On a serial line: a firmware that waits for a plant's first message sends its hello again. Other frames are from an
 * earlier run. */
static bool ask_for_hello(talk *t) {
    const double patience_s = t->guest.wish.patience_s;
    wh_frame frame;
    guest_heard heard = GUEST_SILENT;
    t->guest.wish.patience_s = ASK_S;
    for (unsigned asked = 0; asked * ASK_S < patience_s && heard == GUEST_SILENT; asked++) {
        heard = ask(t);
        while (heard == GUEST_FRAME) {
            heard = guest_receive(&t->guest, &frame);
            if (heard == GUEST_FRAME && frame.kind == WH_FRAME_HELLO) {
                t->guest.wish.patience_s = patience_s;
                return take_hello_frame(t, &frame, &t->hello, t->signal, t->words, sizeof t->words);
            }
        }
    }
    t->report->end = heard == GUEST_STOPPED ? LOCKSTEP_STOPPED : LOCKSTEP_BAD;
    if (heard != GUEST_STOPPED) {
        fprintf(stderr,
                "whirl pil: error: no hello has come over the line in %g s\n"
                "hint: reset the board, whose firmware may be in the middle of another run; is it "
                "pil_line.elf, and --baud its speed?\n",
                patience_s);
    }
    return false;
}

static bool hear_hello(talk *t) {
    if (t->wish->guest.by_line) {
        if (!ask_for_hello(t)) {
            return false;
        }
    } else if (!take_hello(t, &t->hello, t->signal, t->words, sizeof t->words)) {
        return false;
    }
    for (unsigned i = 0; i < t->hello.signals; i++) {
        const wh_signal *s = &t->signal[i];
        t->outputs += s->kind == WH_SIGNAL_OUTPUT || s->kind == WH_SIGNAL_NOTE;
        if (s->kind == WH_SIGNAL_NOTE) {
            told_note *note = &t->report->note[t->report->notes++];
            snprintf(note->name, sizeof note->name, "%s", s->name);
            snprintf(note->unit, sizeof note->unit, "%s", s->unit);
        }
    }
    snprintf(t->report->program, sizeof t->report->program, "%s", t->hello.program);
    snprintf(t->report->board, sizeof t->report->board, "%s", t->hello.board);
    return true;
}

bool talk_is_same_hello(const wh_hello *one, const wh_hello *other) {
    bool same = one->ticks_per_s == other->ticks_per_s && one->start_ticks == other->start_ticks &&
                one->signals == other->signals && strcmp(one->program, other->program) == 0;
    for (unsigned i = 0; same && i < one->signals; i++) {
        const wh_signal *a = &one->signal[i];
        const wh_signal *b = &other->signal[i];
        same = a->kind == b->kind && strcmp(a->name, b->name) == 0 &&
               strcmp(a->unit, b->unit) == 0 && memcmp(&a->low, &b->low, sizeof a->low) == 0 &&
               memcmp(&a->high, &b->high, sizeof a->high) == 0 &&
               memcmp(&a->per_count, &b->per_count, sizeof a->per_count) == 0 &&
               a->period_ticks == b->period_ticks;
    }
    return same;
}

bool talk_start(talk *t, const lockstep_wish *wish, lockstep_report *report, FILE *onto) {
    *t = (talk){.wish = wish, .report = report, .tape = onto};
    report->hash = WH_HASH_START;
    if (!guest_start(&t->guest, &wish->guest)) {
        report->end = LOCKSTEP_BAD;
        return false;
    }
    return hear_hello(t);
}

/* The previous process's exit status does not matter. */
bool talk_restart(talk *t, uint32_t ticks, const wh_reset *reset) {
    uint8_t words[GUEST_LINE_BYTES];
    wh_signal signal[WH_SIGNALS_MAX];
    wh_hello hello;
    uint8_t payload[WH_RESET_BYTES];
    const wh_frame frame = {.kind = WH_FRAME_RESET,
                            .ticks = ticks,
                            .payload = payload,
                            .length = wh_reset_put(reset, payload, sizeof payload)};
    if (t->wish->guest.by_line) {
        return fail(t, "nothing that resets it: over a line nobody does");
    }
    (void)guest_end(&t->guest);
    if (!guest_start(&t->guest, &t->wish->guest)) {
        t->report->end = LOCKSTEP_FAILED;
        return false;
    }
    t->sequence = 0;
    if (!take_hello(t, &hello, signal, words, sizeof words)) {
        return false;
    }
    if (!talk_is_same_hello(&hello, &t->hello)) {
        return fail(t, "another hello than before its reset");
    }
    return say(t, &frame);
}

double talk_instructions_per_count(const wh_hello *hello) {
    return hello->timer_per_s == 0 ? 0.0
                                   : 1e9 / (double)hello->timer_per_s / (double)(1 << GUEST_SHIFT);
}

void talk_end(talk *t) {
    const bool failed_alone = t->report->end == LOCKSTEP_DONE;
    t->report->status = guest_end(&t->guest);
    if (!failed_alone) {
        return;
    }
    if (t->wish->guest.by_line) {
        t->report->status.status = t->end_status;
        if (!t->said_end) {
            fprintf(stderr, "whirl pil: error: the line is gone\n");
            t->report->end = LOCKSTEP_FAILED;
        }
        return;
    }
    if (t->report->status.killed) {
        fprintf(stderr, "whirl pil: error: the firmware closed the line and did not end: killed\n");
        t->report->end = LOCKSTEP_FAILED;
    } else if (t->report->status.signal_number != 0) {
        fprintf(stderr, "whirl pil: error: the firmware's process was ended by signal %d (%s)\n",
                t->report->status.signal_number, strsignal(t->report->status.signal_number));
        t->report->end = LOCKSTEP_FAILED;
    }
}
