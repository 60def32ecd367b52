/* vcd.c: see vcd.h. */
#include "vcd.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"

typedef struct change {
    int64_t time_us;
    double value;
    int signal;
} change;

struct vcd {
    FILE *out;
    const char *what;
    struct {
        char *name;
        bool is_real;
        bool any; /* a value was written */
        double value;
    } signal[VCD_SIGNALS];
    int signals;
    bool begun;
    bool timed; /* a time was written */
    int64_t time_us;
    int64_t last_us; /* of all that was told */
    change *waiting; /* in order of time */
    int64_t count;
    int64_t room;
    uint64_t late;
};

vcd *vcd_new(FILE *out, const char *what) {
    vcd *v = room(1, sizeof *v);
    v->out = out;
    v->what = what;
    return v;
}

static int add_signal(vcd *v, const char *name, bool is_real) {
    if (v->signals == VCD_SIGNALS) {
        return -1;
    }
    char *copy = room_words("%s", name);
    char *to = copy;
    for (const char *at = copy; *at != '\0'; at++) {
        if (*at != '[' && *at != ']') {
            *to++ = (char)(*at <= ' ' ? '_' : *at);
        }
    }
    *to = '\0';
    v->signal[v->signals].name = copy;
    v->signal[v->signals].is_real = is_real;
    return v->signals++;
}

int vcd_wire(vcd *v, const char *name) { return add_signal(v, name, false); }
int vcd_real(vcd *v, const char *name) { return add_signal(v, name, true); }

/* A printable character, from '!' on. */
static int mark(int signal) { return '!' + signal; }

static void begin(vcd *v) {
    if (v->begun) {
        return;
    }
    v->begun = true;
    fprintf(v->out, "$comment %s $end\n$timescale 1us $end\n$scope module rig $end\n", v->what);
    for (int i = 0; i < v->signals; i++) {
        fprintf(v->out, "$var %s %d %c %s $end\n", v->signal[i].is_real ? "real" : "wire",
                v->signal[i].is_real ? 64 : 1, mark(i), v->signal[i].name);
    }
    fputs("$upscope $end\n$enddefinitions $end\n", v->out);
}

static void write_time(vcd *v, int64_t time_us) {
    if (!v->timed || time_us > v->time_us) {
        fprintf(v->out, "#%" PRId64 "\n", time_us);
        v->time_us = time_us;
        v->timed = true;
    }
}

static void write_change(vcd *v, const change *c) {
    const bool is_real = v->signal[c->signal].is_real;
    double value = is_real ? c->value : (c->value != 0.0 ? 1.0 : 0.0);
    if (v->signal[c->signal].any && v->signal[c->signal].value == value) {
        return;
    }
    v->late += v->timed && c->time_us < v->time_us;
    write_time(v, c->time_us);
    v->signal[c->signal].any = true;
    v->signal[c->signal].value = value;
    if (is_real) {
        fprintf(v->out, "r%.9g %c\n", value, mark(c->signal));
    } else {
        fprintf(v->out, "%d%c\n", value != 0.0, mark(c->signal));
    }
}

void vcd_change(vcd *v, int signal, int64_t time_us, double value) {
    if (signal < 0 || !isfinite(value)) {
        return;
    }
    time_us = time_us > 0 ? time_us : 0;
    if (v->count == v->room) {
        v->room = v->room > 0 ? 2 * v->room : 256;
        v->waiting = room_more(v->waiting, v->room, sizeof v->waiting[0]);
    }
    int64_t at = v->count++;
    for (; at > 0 && v->waiting[at - 1].time_us > time_us; at--) {
        v->waiting[at] = v->waiting[at - 1];
    }
    v->waiting[at] = (change){time_us, value, signal};
    v->last_us = time_us > v->last_us ? time_us : v->last_us;
}

void vcd_settle(vcd *v, int64_t time_us) {
    begin(v);
    int64_t done = 0;
    while (done < v->count && v->waiting[done].time_us <= time_us) {
        write_change(v, &v->waiting[done++]);
    }
    for (int64_t i = done; i < v->count; i++) {
        v->waiting[i - done] = v->waiting[i];
    }
    v->count -= done;
}

uint64_t vcd_end(vcd *v) {
    vcd_settle(v, INT64_MAX);
    write_time(v, v->last_us);
    const uint64_t late = v->late;
    for (int i = 0; i < v->signals; i++) {
        free(v->signal[i].name);
    }
    free(v->waiting);
    free(v);
    return late;
}
