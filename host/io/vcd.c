#include "vcd.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/version.h"
#include "host/base/alloc.h"

enum { VALUE_SIZE = 40 };

typedef struct vcd_signal {
    vcd_kind kind;
    char value[VALUE_SIZE]; /* last written value, or "" */
} vcd_signal;

typedef struct change {
    int64_t time;
    double value;
    int signal;
} change;

struct vcd {
    FILE *out;
    int digits;
    int scopes; /* number of open scopes */
    vcd_signal *signal;
    int64_t signals;
    int64_t time;    /* the last written time; -1: none */
    int64_t last;    /* the latest time of a change */
    change *waiting; /* ordered by time */
    int64_t count;
    int64_t room;
};

/* A colon becomes _, because some viewers read a name with a colon as a vector. */
static void write_name(FILE *out, const char *name) {
    char *copy = alloc_words("%s", name);
    char *to = copy;
    bool simple = *name != '\0' && *name != '$' && (*name < '0' || *name > '9');
    for (const char *at = name; *at != '\0'; at++) {
        if (*at != '[' && *at != ']') {
            *to = (char)((*at >= '\0' && *at <= ' ') || *at == ':' || *at == '\177' ? '_' : *at);
            simple = simple && (isalnum((unsigned char)*to) || *to == '_' || *to == '$');
            to++;
        }
    }
    *to = '\0';
    fprintf(out, "%s%s", simple ? "" : "\\", copy);
    free(copy);
}

/* "$end" would end the comment, and becomes "$ end". */
static void write_comment(FILE *out, const char *text) {
    fputs("$comment ", out);
    for (const char *at = text; *at != '\0'; at++) {
        fputc((unsigned char)*at < ' ' ? ' ' : *at, out);
        if (strncmp(at, "$end", 4) == 0) {
            fputc(' ', out);
        }
    }
    fputs(" $end\n", out);
}

static void open_scope(vcd *v, const char *scope) {
    fputs("$scope module ", v->out);
    write_name(v->out, scope);
    fputs(" $end\n", v->out);
    v->scopes++;
}

vcd *vcd_new(FILE *out, const char *what, int power, const char *scope, int digits) {
    static const char *const unit[] = {"s", "ms", "us", "ns", "ps", "fs"};
    /* $timescale must be 1, 10 or 100 of a unit: 0.1 s is "100 ms" */
    static const char *const number[] = {"1", "100", "10"};
    vcd *v = alloc(1, sizeof *v);
    v->out = out;
    v->digits = digits;
    v->time = -1;
    fputs("$version whirl " WH_VERSION " $end\n", out);
    write_comment(out, what);
    fprintf(out, "$timescale %s%s $end\n", number[power % 3], unit[(power + 2) / 3]);
    open_scope(v, scope);
    return v;
}

void vcd_scope(vcd *v, const char *scope) {
    if (v->scopes > 1) {
        fputs("$upscope $end\n", v->out);
        v->scopes--;
    }
    open_scope(v, scope);
}

/* Writes a signal's identifier, a number whose digits are the printable characters from '!' on, lowest digit first. */
static void write_mark(FILE *out, int64_t signal) {
    enum { DIGITS = '~' - '!' + 1 };
    do {
        fputc((int)('!' + signal % DIGITS), out);
        signal = signal / DIGITS - 1;
    } while (signal >= 0);
}

int vcd_add(vcd *v, vcd_kind kind, const char *name, const char *note) {
    static const char *const words[] = {
        [VCD_WIRE] = "wire 1", [VCD_REAL] = "real 64", [VCD_EVENT] = "event 1"};
    v->signal = alloc_more(v->signal, v->signals + 1, sizeof v->signal[0]);
    v->signal[v->signals] = (vcd_signal){.kind = kind};
    fprintf(v->out, "$var %s ", words[kind]);
    write_mark(v->out, v->signals);
    fputc(' ', v->out);
    write_name(v->out, name);
    fputs(" $end\n", v->out);
    if (note != NULL && note[0] != '\0') {
        write_comment(v->out, note);
    }
    return (int)v->signals++;
}

static void write_time(vcd *v, int64_t time) {
    if (time > v->time) {
        fprintf(v->out, "#%" PRId64 "\n", time);
        v->time = time;
    }
}

static void write_change(vcd *v, const change *c) {
    vcd_signal *s = &v->signal[c->signal];
    char text[VALUE_SIZE];
    switch (s->kind) {
    case VCD_REAL: snprintf(text, sizeof text, "r%.*g ", v->digits, c->value); break;
    case VCD_WIRE:
        snprintf(text, sizeof text, "%s", isnan(c->value) ? "x" : c->value != 0.0 ? "1" : "0");
        break;
    case VCD_EVENT: snprintf(text, sizeof text, "1"); break;
    }
    if (s->kind != VCD_EVENT && strcmp(text, s->value) == 0) {
        return;
    }
    write_time(v, c->time);
    memcpy(s->value, text, sizeof text);
    fputs(text, v->out);
    write_mark(v->out, c->signal);
    fputc('\n', v->out);
}

void vcd_change(vcd *v, int signal, int64_t time, double value) {
    if (signal < 0) {
        return;
    }
    time = time > 0 ? time : 0;
    if (v->count == v->room) {
        v->room = v->room > 0 ? 2 * v->room : 256;
        v->waiting = alloc_more(v->waiting, v->room, sizeof v->waiting[0]);
    }
    int64_t at = v->count++;
    for (; at > 0 && v->waiting[at - 1].time > time; at--) {
        v->waiting[at] = v->waiting[at - 1];
    }
    v->waiting[at] = (change){time, value, signal};
    v->last = time > v->last ? time : v->last;
}

static void write_until(vcd *v, int64_t time) {
    while (v->scopes > 0) {
        v->scopes--;
        fputs(v->scopes > 0 ? "$upscope $end\n" : "$upscope $end\n$enddefinitions $end\n", v->out);
    }
    int64_t done = 0;
    while (done < v->count && v->waiting[done].time <= time) {
        write_change(v, &v->waiting[done++]);
    }
    for (int64_t i = done; i < v->count; i++) {
        v->waiting[i - done] = v->waiting[i];
    }
    v->count -= done;
}

void vcd_settle(vcd *v, int64_t time) {
    write_until(v, time);
    v->last = time > v->last ? time : v->last;
}

void vcd_end(vcd *v) {
    if (v == NULL) {
        return;
    }
    write_until(v, INT64_MAX);
    write_time(v, v->last);
    free(v->signal);
    free(v->waiting);
    free(v);
}
