/* replay.c: a tape in the plant's place. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "host/base/room.h"
#include "lockstep.h"
#include "talk.h"

/* A tape is the frames that went over the line, in their order: hello, then readings and orders in turns. */
typedef struct tape_reader {
    const char *name;
    FILE *file;
    wh_frame_reader reader;
    bool endless;    /* no frame where there had to be one */
    double before_s; /* the last reset */
    uint8_t bytes[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
} tape_reader;

/* A frame and the zeros round it have so many bytes at most: a device that never ends is no tape. */
static bool read_frame(tape_reader *t, wh_frame *frame) {
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
static bool is_cut_off(const tape_reader *t) {
    return t->reader.dropped > 0 || t->reader.length > 0 || t->endless || ferror(t->file) != 0;
}

/* What a tape cannot be. */
static bool is_no_tape(tape_reader *t, lockstep_report *r, const char *why) {
    if (ferror(t->file) != 0) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", t->name, strerror(errno));
    } else {
        fprintf(stderr,
                "%s: error: %s after %llu exchanges\nhint: whirl pil SCENE --tape FILE makes one\n",
                t->name, why, (unsigned long long)r->exchanges);
    }
    r->end = LOCKSTEP_BAD;
    return false;
}

static bool open_tape(tape_reader *t, const char *name, wh_hello *hello, wh_signal *signal,
                      lockstep_report *r) {
    wh_frame frame;
    *t = (tape_reader){.name = name, .file = fopen(name, "rb")};
    wh_frame_reader_start(&t->reader, t->bytes, sizeof t->bytes);
    if (t->file == NULL) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", name, strerror(errno));
        r->end = LOCKSTEP_BAD;
        return false;
    }
    if (!read_frame(t, &frame) || frame.version != WH_FRAME_VERSION ||
        frame.kind != WH_FRAME_HELLO || !wh_hello_get(hello, signal, frame.payload, frame.length)) {
        return is_no_tape(t, r, "no tape of this version");
    }
    return true;
}

static void say_difference(const wh_orders *kept, const wh_orders *now, uint32_t since_ticks,
                           const talk *t) {
    fprintf(stderr, "whirl pil: error: exchange %llu, t = %.6f s: other orders than on the tape\n",
            (unsigned long long)t->report->exchanges,
            (double)since_ticks / (double)t->hello.ticks_per_s);
    for (unsigned i = 0; i < now->outputs && i < kept->outputs; i++) {
        if (memcmp(&now->output[i], &kept->output[i], sizeof now->output[i]) != 0) {
            fprintf(stderr, "hint: output %u is %.9g, on the tape %.9g\n", i + 1,
                    (double)now->output[i], (double)kept->output[i]);
        }
    }
}

/* The frame is a hello: there was a reset. The next one says which. */
static bool play_reset(tape_reader *from, talk *t) {
    wh_frame frame;
    wh_reset reset;
    if (!read_frame(from, &frame) || frame.kind != WH_FRAME_RESET ||
        !wh_reset_get(&reset, frame.payload, frame.length)) {
        return is_no_tape(from, t->report, "it is broken");
    }
    from->before_s += (double)(frame.ticks - t->hello.start_ticks) / (double)t->hello.ticks_per_s;
    return talk_restart(t, frame.ticks, &reset);
}

/* The next frame that is not there to be remembered. */
static bool read_orders(tape_reader *from, talk *t, wh_frame *frame) {
    while (read_frame(from, frame)) {
        if (frame->kind != WH_FRAME_REMEMBER) {
            return true;
        }
        t->report->tape_hash = talk_hash_bytes(t->report->tape_hash, frame->payload, frame->length);
    }
    return false;
}

/* One turn. False at the tape's end and when something is wrong, which report->end then says. */
static bool play(tape_reader *from, talk *t) {
    lockstep_report *r = t->report;
    wh_frame frame;
    wh_readings readings;
    wh_orders kept;
    wh_orders now;
    if (!read_frame(from, &frame)) {
        r->end = LOCKSTEP_LET_GO;
        return is_cut_off(from) ? is_no_tape(from, r, "it is broken") : false;
    }
    if (frame.kind == WH_FRAME_HELLO) {
        return play_reset(from, t);
    }
    const uint32_t ticks = frame.ticks;
    if (frame.kind != WH_FRAME_READINGS || frame.sequence != t->sequence ||
        !wh_readings_get(&readings, frame.payload, frame.length)) {
        return is_no_tape(from, r, "it is broken");
    }
    const bool more = read_orders(from, t, &frame);
    if (!more && is_cut_off(from)) {
        return is_no_tape(from, r, "it is broken");
    }
    if (more && (frame.kind != WH_FRAME_ORDERS || frame.sequence != t->sequence ||
                 !wh_orders_get(&kept, frame.payload, frame.length))) {
        return is_no_tape(from, r, "it is broken");
    }
    r->time_s =
        from->before_s + (double)(ticks - t->hello.start_ticks) / (double)t->hello.ticks_per_s;
    if (!talk_tell(t, ticks, &readings) || !talk_hear(t, &now)) {
        if (r->end == LOCKSTEP_DONE && more) {
            fprintf(stderr,
                    "whirl pil: error: exchange %llu, t = %.6f s: the firmware ended, and the tape "
                    "goes on\n",
                    (unsigned long long)r->exchanges, r->time_s);
            r->end = LOCKSTEP_DIFFERENT;
        }
        return false;
    }
    if (!more) { /* the taped firmware had ended here, or was let go */
        r->end = LOCKSTEP_LET_GO;
        return false;
    }
    r->tape_hash = talk_hash(r->tape_hash, &kept);
    if (r->tape_hash != r->hash) {
        say_difference(&kept, &now, ticks - t->hello.start_ticks, t);
        r->end = LOCKSTEP_DIFFERENT;
        return false;
    }
    return true;
}

void lockstep_replay(const lockstep_wish *wish, const char *file, lockstep_report *report) {
    tape_reader *reader = room(1, sizeof *reader);
    talk *t = room(1, sizeof *t);
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    *report = (lockstep_report){.end = LOCKSTEP_DONE, .tape_hash = WH_HASH_START};
    t->guest.up = -1;
    t->guest.down = -1;
    t->report = report;
    if (open_tape(reader, file, &hello, signal, report) && talk_start(t, wish, report, NULL)) {
        if (!talk_is_same_hello(&hello, &t->hello)) {
            fprintf(stderr,
                    "%s: error: it is of '%s', whose signals are not those of the firmware '%s'\n",
                    file, hello.program, t->hello.program);
            report->end = LOCKSTEP_BAD;
        } else {
            while (play(reader, t)) {
            }
        }
    }
    talk_end(t);
    if (reader->file != NULL) {
        fclose(reader->file);
    }
    free(reader);
    free(t);
}
