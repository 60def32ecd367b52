/* taped_csv.c: a tape as a table: what the firmware heard, and what it said, a row each. */
#include "taped_csv.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/base/written.h"
#include "taped.h"

/* The rows of a tape, as they come. */
typedef struct rows {
    const taped *tape;
    FILE *out;
    int decimals; /* of a time: a tick */
    uint32_t ticks;
    uint64_t heard;              /* ticks since the plant's time 0 */
    bool cut;                    /* that has been told */
    bool told;                   /* outputs and notes have, with these: */
    float value[WH_SIGNALS_MAX]; /* by channel, the notes behind the outputs */
} rows;

static const wh_signal *signal_of(const taped *t, wh_signal_kind kind, unsigned channel) {
    for (unsigned i = 0; i < t->hello.signals; i++) {
        if (t->signal[i].kind == kind && channel-- == 0) {
            return &t->signal[i];
        }
    }
    return NULL; /* taped_next() has looked at all of them */
}

static void print_time(const rows *r, int64_t ticks) {
    fprintf(r->out, "%.*f,", r->decimals, (double)ticks / (double)r->tape->hello.ticks_per_s);
}

/* A stamp lies within half of its 32 bits of the time at which it was heard. */
static void begin_row(const rows *r, uint32_t stamp, const char *kind) {
    print_time(r, (int64_t)r->heard + (int32_t)(stamp - r->ticks));
    print_time(r, (int64_t)r->heard);
    fprintf(r->out, "%s,", kind);
}

/* Names and units stand on a tape as somebody's firmware sent them: what would break a row does not. */
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

static void print_edge(const rows *r, const wh_edge *e) {
    begin_row(r, e->ticks, "edge");
    print_named(r, signal_of(r->tape, WH_SIGNAL_EDGE, e->channel), e->channel);
    fputs(",,\n", r->out);
}

static void print_sample(const rows *r, const wh_sample *e) {
    const wh_signal *s = signal_of(r->tape, WH_SIGNAL_SAMPLE, e->channel);
    begin_row(r, e->ticks, "sample");
    print_named(r, s, e->channel);
    fprintf(r->out, "%.9g,", (double)e->raw * (double)s->per_count);
    print_word(r->out, s->unit);
    fputs(e->status == WH_SAMPLE_GOOD        ? "good\n"
          : e->status == WH_SAMPLE_SATURATED ? "saturated\n"
                                             : "disconnected\n",
          r->out);
}

/* Edges and samples, each in the order of their stamps on the tape, by time. */
static void print_readings(const rows *r, const wh_readings *readings) {
    unsigned edge = 0;
    unsigned sample = 0;
    while (edge < readings->edges || sample < readings->samples) {
        const bool is_edge =
            edge < readings->edges &&
            (sample == readings->samples ||
             (int32_t)(readings->edge[edge].ticks - readings->sample[sample].ticks) <= 0);
        if (is_edge) {
            print_edge(r, &readings->edge[edge++]);
        } else {
            print_sample(r, &readings->sample[sample++]);
        }
    }
}

static void print_orders(rows *r, const wh_orders *orders) {
    const unsigned outputs = taped_channels(r->tape, WH_SIGNAL_OUTPUT);
    for (unsigned i = 0; i < orders->outputs; i++) {
        const bool is_note = i >= outputs;
        const unsigned channel = is_note ? i - outputs : i;
        const wh_signal *s =
            signal_of(r->tape, is_note ? WH_SIGNAL_NOTE : WH_SIGNAL_OUTPUT, channel);
        if (r->told && memcmp(&r->value[i], &orders->output[i], sizeof r->value[i]) == 0) {
            continue;
        }
        r->value[i] = orders->output[i];
        begin_row(r, r->ticks, is_note ? "note" : "output");
        print_named(r, s, channel);
        fprintf(r->out, "%.9g,", (double)orders->output[i]);
        print_word(r->out, s->unit);
        fputc('\n', r->out);
    }
    r->told = true;
}

/* The firmware knows of nothing that was before, and its timer begins anew. */
static void print_reset(rows *r, const wh_reset *reset) {
    begin_row(r, r->ticks, "reset");
    fprintf(r->out, ",,,,%s\n", reset->cause == WH_RESET_WATCHDOG ? "watchdog" : "other");
    r->ticks = r->tape->hello.start_ticks;
    r->cut = false;
    r->told = false;
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
        if (turn.is_reset) {
            print_reset(&r, &turn.reset);
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
    const bool is_standard = csv == NULL || strcmp(csv, "-") == 0;
    taped *t = room(1, sizeof *t);
    FILE *out = NULL;
    bool good = taped_open(t, name);
    if (good) {
        out = written_open(is_standard ? "-" : csv);
        if (out != NULL) {
            print_rows(t, out);
        }
        good = out != NULL && written_close(out, csv, true) && !t->failed;
    }
    taped_close(t);
    free(t);
    return good;
}
