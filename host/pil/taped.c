/* taped.c: the reader of tapes of `whirl pil --tape`. */
#include "host/pil/lockstep.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/exchange.h"
#include "core/hash.h"
#include "host/base/alloc.h"
#include "host/io/plot.h"
#include "host/os/atomic_file.h"
#include "host/os/guest.h"

/* === the reader =============================================================================== */
/* A tape begins with a hello. Then readings and orders alternate. Each restart adds a hello and a reset. */

typedef struct taped {
    const char *name;
    FILE *file;
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    uint64_t hash;  /* of all orders and remembered data so far */
    uint64_t turns; /* exchanges read so far */
    uint16_t sequence;
    double before_s; /* time of the last reset */
    bool failed;     /* the tape is unreadable or damaged (reported) */
    wh_frame_reader reader;
    bool endless; /* a frame is longer than any valid one */
    uint8_t bytes[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
    uint8_t words[GUEST_LINE_BYTES]; /* texts of the hello */
} taped;

/* Readings at `ticks` and their answer; or a reset. */
typedef struct taped_turn {
    uint32_t ticks;
    double time_s; /* plant time */
    bool is_reset; /* only `reset` is valid */
    wh_reset reset;
    wh_readings readings;
    bool answered; /* false: the firmware had ended, or the run was over */
    wh_orders orders;
} taped_turn;

/* Gives up if a frame is longer than any valid one, because the file may be an endless device. */
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

/* Does the tape end within a frame, contain an invalid frame, or fail to be read? */
static bool is_cut_off(const taped *t) {
    return t->reader.dropped > 0 || t->reader.length > 0 || t->endless || ferror(t->file) != 0;
}

static bool is_no_tape(taped *t, const char *why) {
    if (ferror(t->file) != 0) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", t->name, strerror(errno));
    } else {
        fprintf(stderr,
                "%s: error: %s after %llu exchanges\nhint: record a tape with "
                "whirl pil SCENE --tape FILE\n",
                t->name, why, (unsigned long long)t->turns);
    }
    t->failed = true;
    return false;
}

/* Plant time for a value of the firmware's timer. */
static double time_of(const taped *t, uint32_t ticks) {
    return t->before_s + (double)(ticks - t->hello.start_ticks) / (double)t->hello.ticks_per_s;
}

/* Reads the hello. Returns false after an error (reported). Call taped_close() in any case. */
static bool taped_open(taped *t, const char *name) {
    wh_frame frame;
    *t = (taped){.name = name, .file = fopen(name, "rb"), .hash = WH_HASH_START};
    wh_frame_reader_start(&t->reader, t->bytes, sizeof t->bytes);
    if (t->file == NULL) {
        fprintf(stderr, "%s: error: cannot be read: %s\n", name, strerror(errno));
        t->failed = true;
        return false;
    }
    bool good = read_frame(t, &frame) && frame.version == WH_FRAME_VERSION &&
                frame.kind == WH_FRAME_HELLO && frame.length <= sizeof t->words;
    if (good) {
        memcpy(t->words, frame.payload, frame.length);
        good =
            wh_hello_get(&t->hello, t->signal, t->words, frame.length) && t->hello.ticks_per_s > 0;
    }
    return good || is_no_tape(t, "this is not a tape of this version");
}

static void taped_close(taped *t) {
    if (t->file != NULL) {
        fclose(t->file);
    }
}

/* Does the hello declare all channels of the turn's messages? */
static bool has_channels(const taped *t, const taped_turn *turn) {
    const unsigned edges = hello_channels(&t->hello, WH_SIGNAL_EDGE);
    const unsigned samples = hello_channels(&t->hello, WH_SIGNAL_SAMPLE);
    const unsigned outputs =
        hello_channels(&t->hello, WH_SIGNAL_OUTPUT) + hello_channels(&t->hello, WH_SIGNAL_NOTE);
    bool good = !turn->answered || turn->orders.outputs == outputs;
    for (unsigned i = 0; i < turn->readings.edges; i++) {
        good = good && turn->readings.edge[i].channel < edges;
    }
    for (unsigned i = 0; i < turn->readings.samples; i++) {
        good = good && turn->readings.sample[i].channel < samples;
    }
    return good;
}

/* A hello in the middle of a tape is a restart. The next frame has the reason. */
static bool take_reset(taped *t, wh_frame *frame, taped_turn *turn) {
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    if (!wh_hello_get(&hello, signal, frame->payload, frame->length) ||
        !talk_is_same_hello(&hello, &t->hello) || !read_frame(t, frame) ||
        frame->kind != WH_FRAME_RESET ||
        !wh_reset_get(&turn->reset, frame->payload, frame->length)) {
        return is_no_tape(t, "the tape is damaged");
    }
    turn->is_reset = true;
    turn->ticks = frame->ticks;
    turn->time_s = time_of(t, frame->ticks);
    t->before_s = turn->time_s;
    t->sequence = 0;
    return true;
}

/* Skips remembered data, but adds it to the hash. */
static bool read_orders(taped *t, wh_frame *frame) {
    while (read_frame(t, frame)) {
        if (frame->kind != WH_FRAME_REMEMBER) {
            return true;
        }
        t->hash = talk_hash_bytes(t->hash, frame->payload, frame->length);
    }
    return false;
}

/* Returns false at the end, and if the tape is damaged (reported; t->failed). */
static bool taped_next(taped *t, taped_turn *turn) {
    wh_frame frame;
    *turn = (taped_turn){.is_reset = false};
    if (!read_frame(t, &frame)) {
        return is_cut_off(t) ? is_no_tape(t, "the tape is damaged") : false;
    }
    if (frame.kind == WH_FRAME_HELLO) {
        return take_reset(t, &frame, turn);
    }
    turn->ticks = frame.ticks;
    turn->time_s = time_of(t, frame.ticks);
    bool good = frame.kind == WH_FRAME_READINGS && frame.sequence == t->sequence &&
                wh_readings_get(&turn->readings, frame.payload, frame.length);
    if (good) {
        turn->answered = read_orders(t, &frame);
        good = turn->answered ? frame.kind == WH_FRAME_ORDERS && frame.sequence == t->sequence &&
                                    wh_orders_get(&turn->orders, frame.payload, frame.length)
                              : !is_cut_off(t);
    }
    if (!good || !has_channels(t, turn)) {
        return is_no_tape(t, "the tape is damaged");
    }
    if (turn->answered) {
        t->hash = talk_hash(t->hash, &turn->orders);
    }
    t->sequence++;
    t->turns++;
    return true;
}

/* === a tape as a table ======================================================================== */

typedef struct rows {
    const taped *tape;
    FILE *out;
    int decimals; /* decimal places of a printed time: enough to resolve a tick */
    uint32_t ticks;
    uint64_t heard;              /* ticks from plant time 0 to the present message */
    bool cut;                    /* a row for WH_READING_CUT has been printed */
    bool has_rows;               /* value[] is valid: it has the last printed values */
    float value[WH_SIGNALS_MAX]; /* of each output, then of each note */
} rows;

/* `stamp` wraps at 2^32: of its possible times, the row has the one nearest to the message's time. */
static void begin_row(const rows *r, uint32_t stamp, const char *kind) {
    const double per_s = (double)r->tape->hello.ticks_per_s;
    const int64_t heard = (int64_t)r->heard;
    const int64_t then = heard + (int32_t)(stamp - r->ticks);
    fprintf(r->out, "%.*f,%.*f,%s,", r->decimals, (double)then / per_s, r->decimals,
            (double)heard / per_s, kind);
}

/* Prints a text of the firmware. A character that would break the row becomes '_'. */
static void print_word(FILE *out, const char *word) {
    for (; *word != '\0'; word++) {
        const bool breaks = (unsigned char)*word < 0x20 || strchr(",\"\x7f", *word) != NULL;
        fputc(breaks ? '_' : *word, out);
    }
    fputc(',', out);
}

static void print_named(const rows *r, const wh_signal *s, unsigned channel) {
    fprintf(r->out, "%u,", channel + 1);
    print_word(r->out, s->name);
}

static void print_sample(const rows *r, const wh_sample *e) {
    const wh_signal *s = hello_signal(&r->tape->hello, WH_SIGNAL_SAMPLE, e->channel);
    begin_row(r, e->ticks, "sample");
    print_named(r, s, e->channel);
    fprintf(r->out, "%.9g,", (double)e->raw * (double)s->per_count);
    print_word(r->out, s->unit);
    fputs(e->status == WH_SAMPLE_GOOD        ? "good\n"
          : e->status == WH_SAMPLE_SATURATED ? "saturated\n"
                                             : "disconnected\n",
          r->out);
}

/* Merges edges and samples by time. Each kind keeps its order on the tape. */
static void print_readings(const rows *r, const wh_readings *readings) {
    unsigned edge = 0;
    unsigned sample = 0;
    while (edge < readings->edges || sample < readings->samples) {
        const bool is_edge =
            edge < readings->edges &&
            (sample == readings->samples ||
             (int32_t)(readings->edge[edge].ticks - readings->sample[sample].ticks) <= 0);
        if (is_edge) {
            const wh_edge *e = &readings->edge[edge++];
            begin_row(r, e->ticks, "edge");
            print_named(r, hello_signal(&r->tape->hello, WH_SIGNAL_EDGE, e->channel), e->channel);
            fputs(",,\n", r->out);
        } else {
            print_sample(r, &readings->sample[sample++]);
        }
    }
}

static void print_orders(rows *r, const wh_orders *orders) {
    const unsigned outputs = hello_channels(&r->tape->hello, WH_SIGNAL_OUTPUT);
    for (unsigned i = 0; i < orders->outputs; i++) {
        const bool is_note = i >= outputs;
        const unsigned channel = is_note ? i - outputs : i;
        const wh_signal *s =
            hello_signal(&r->tape->hello, is_note ? WH_SIGNAL_NOTE : WH_SIGNAL_OUTPUT, channel);
        if (r->has_rows && memcmp(&r->value[i], &orders->output[i], sizeof r->value[i]) == 0) {
            continue;
        }
        r->value[i] = orders->output[i];
        begin_row(r, r->ticks, is_note ? "note" : "output");
        print_named(r, s, channel);
        fprintf(r->out, "%.9g,", (double)orders->output[i]);
        print_word(r->out, s->unit);
        fputc('\n', r->out);
    }
    r->has_rows = true;
}

static void print_rows(taped *t, FILE *out) {
    rows r = {.tape = t, .out = out, .ticks = t->hello.start_ticks};
    for (uint32_t per_s = 1; per_s < t->hello.ticks_per_s && r.decimals < 9; per_s *= 10U) {
        r.decimals++;
    }
    fputs("time,heard,kind,channel,signal,value,unit,status\n", out);
    taped_turn turn;
    while (ferror(out) == 0 && taped_next(t, &turn)) {
        r.heard += turn.ticks - r.ticks;
        r.ticks = turn.ticks;
        if (turn.is_reset) { /* the firmware's data are lost, and its timer restarts */
            begin_row(&r, r.ticks, "reset");
            fprintf(out, ",,,,%s\n", turn.reset.cause == WH_RESET_WATCHDOG ? "watchdog" : "other");
            r.ticks = t->hello.start_ticks;
            r.cut = false;
            r.has_rows = false;
            continue;
        }
        print_readings(&r, &turn.readings);
        if ((turn.readings.flags & WH_READING_CUT) != 0 && !r.cut) {
            begin_row(&r, r.ticks, "cut");
            fputs(",,,,\n", out);
            r.cut = true;
        }
        if (turn.answered) {
            print_orders(&r, &turn.orders);
        }
    }
}

bool taped_show(const char *name, const char *csv) {
    taped *t = alloc(1, sizeof *t);
    FILE *out = NULL;
    bool good = taped_open(t, name);
    if (good) {
        out = atomic_file_open(csv != NULL ? csv : "-");
        if (out != NULL) {
            print_rows(t, out);
        }
        good = out != NULL && plot_run_csv_end(out, csv, true, "pil", "") && !t->failed;
    }
    taped_close(t);
    free(t);
    return good;
}

/* === a tape in the place of the plant ========================================================= */

static void say_difference(const wh_orders *kept, const wh_orders *now, const talk *t) {
    fprintf(stderr,
            "whirl pil: error: exchange %llu, t = %.6f s: the firmware's outputs differ "
            "from the tape\n",
            (unsigned long long)t->report->exchanges, t->report->time_s);
    for (unsigned i = 0; i < now->outputs && i < kept->outputs; i++) {
        if (memcmp(&now->output[i], &kept->output[i], sizeof now->output[i]) != 0) {
            fprintf(stderr, "output %u is %.9g now, and %.9g on the tape\n", i + 1,
                    (double)now->output[i], (double)kept->output[i]);
        }
    }
}

/* Plays one exchange. Returns false at the end of the tape, and after an error (report->end). */
static bool play(taped *from, talk *t) {
    lockstep_report *r = t->report;
    taped_turn kept;
    wh_orders now;
    if (!taped_next(from, &kept)) {
        r->end = from->failed ? LOCKSTEP_BAD : LOCKSTEP_LET_GO;
        return false;
    }
    r->time_s = kept.time_s;
    if (kept.is_reset) {
        return talk_restart(t, kept.ticks, &kept.reset);
    }
    if (!talk_tell(t, kept.ticks, &kept.readings) || !talk_hear(t, &now)) {
        if (r->end == LOCKSTEP_DONE && kept.answered) {
            fprintf(stderr,
                    "whirl pil: error: exchange %llu, t = %.6f s: the firmware ended, but the "
                    "tape continues\n",
                    (unsigned long long)r->exchanges, r->time_s);
            r->end = LOCKSTEP_DIFFERENT;
        }
        return false;
    }
    if (!kept.answered) { /* the recorded firmware or run had ended here */
        r->end = LOCKSTEP_LET_GO;
        return false;
    }
    if (from->hash != r->hash) {
        say_difference(&kept.orders, &now, t);
        r->end = LOCKSTEP_DIFFERENT;
        return false;
    }
    return true;
}

void lockstep_replay(const lockstep_request *request, const char *file, lockstep_report *report) {
    taped *from = alloc(1, sizeof *from);
    talk *t = alloc(1, sizeof *t);
    *report = (lockstep_report){.end = LOCKSTEP_BAD};
    if (taped_open(from, file)) {
        report->end = LOCKSTEP_DONE;
        const bool started = talk_start(t, request, report, NULL);
        if (started && !talk_is_same_hello(&from->hello, &t->hello)) {
            fprintf(stderr,
                    "%s: error: the firmware '%s' on this tape differs from the running firmware "
                    "'%s' in name, ticks or signals\n",
                    file, from->hello.program, t->hello.program);
            report->end = LOCKSTEP_BAD;
        } else if (started) {
            while (play(from, t)) {
            }
        }
        talk_end(t);
    }
    taped_close(from);
    free(from);
    free(t);
}
