/* recording.c: the recording of a rig's telemetry, by the schema from `tel schema`. */
#include "host/monitor/recording.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/io/plot.h"
#include "host/number/decimal.h"

/* The text after " name=" in the line, or NULL. */
static const char *value_of(const char *line, const char *name) {
    const size_t length = strlen(name);
    for (const char *at = strchr(line, ' '); at != NULL; at = strchr(at + 1, ' ')) {
        if (strncmp(at + 1, name, length) == 0 && at[1 + length] == '=') {
            return at + 2 + length;
        }
    }
    return NULL;
}

static bool read_whole(const char *at, double most, uint32_t *number) {
    const char *end = at;
    const double value = at != NULL ? decimal_read(at, &end) : -1.0;
    if (end == at || !(value >= 0.0 && value <= most)) {
        return false;
    }
    *number = (uint32_t)value;
    return true;
}

/* Copies the characters before one of `ends`, at most SCHEMA_NAME - 1. Returns NULL if there are none or too many. */
static const char *copy_word(char *to, const char *from, const char *ends) {
    const size_t length = strcspn(from, ends);
    if (length == 0 || length >= SCHEMA_NAME) {
        return NULL;
    }
    memcpy(to, from, length);
    to[length] = '\0';
    return from + length;
}

/* Stores "load[N]" as "load [N]". */
static bool set_name(schema_field *field, const char *word) {
    const char *unit = strchr(word, '[');
    if (unit == NULL || unit == word) {
        snprintf(field->name, sizeof field->name, "%s", word);
        return unit == NULL;
    }
    if (strlen(word) + 2U > SCHEMA_NAME) {
        return false;
    }
    snprintf(field->name, sizeof field->name, "%.*s %s", (int)(unit - word), word, unit);
    return true;
}

/* Reads "name[unit]:i2:scale:offset"; the offset is optional. Returns the remaining text, or NULL if unreadable. */
static const char *read_field(schema_field *field, const char *at) {
    char word[SCHEMA_NAME];
    *field = (schema_field){.scale = 1.0};
    at = copy_word(word, at, ": ,");
    if (at == NULL || *at != ':' || !set_name(field, word) || (at[1] != 'i' && at[1] != 'u') ||
        (at[2] != '1' && at[2] != '2' && at[2] != '4') || at[3] != ':') {
        return NULL;
    }
    field->is_signed = at[1] == 'i';
    field->size = (unsigned)(at[2] - '0');
    at += 4;
    const char *end;
    field->scale = decimal_read(at, &end);
    if (end == at || !isfinite(field->scale)) {
        return NULL;
    }
    at = end;
    if (*at == ':' && at[1] != ' ' && at[1] != '\0') {
        field->offset = decimal_read(at + 1, &end);
        if (end == at + 1 || !isfinite(field->offset)) {
            return NULL;
        }
        at = end;
    }
    return at;
}

/* Reads fields, separated by commas, up to a blank, a colon or the end. Returns their number, or -1 if unreadable. */
static int read_fields(schema_field *fields, const char *at) {
    int count = 0;
    if (at == NULL) {
        return -1;
    }
    while (*at != '\0' && *at != ' ' && *at != ':') {
        if (count == SCHEMA_FIELDS || (at = read_field(&fields[count], at)) == NULL) {
            return -1;
        }
        count++;
        at += *at == ',';
    }
    return count;
}

static bool take_channel(schema *s, const char *line) {
    schema_channel made = {.known = true};
    uint32_t index = 0;
    const char *name = value_of(line, "name");
    if (!read_whole(value_of(line, "channel"), SCHEMA_CHANNELS - 1, &index) ||
        !read_whole(value_of(line, "period_ticks"), 4294967295.0, &made.period_ticks) ||
        name == NULL || copy_word(made.name, name, " :") == NULL) {
        return false;
    }
    made.onces = read_fields(made.once, value_of(line, "once"));
    made.eaches = read_fields(made.each, value_of(line, "each"));
    if (made.onces < 0 || made.eaches < 0) {
        return false;
    }
    s->channel[index] = made;
    return true;
}

bool schema_take(schema *s, const char *line) {
    if (strncmp(line, "OK channel=", 11) == 0) {
        return take_channel(s, line);
    }
    if (strncmp(line, "OK rate=", 8) == 0) {
        return s->channel[0].known && read_whole(value_of(line, "period_ticks"), 4294967295.0,
                                                 &s->channel[0].period_ticks);
    }
    return strncmp(line, "OK 0=", 5) == 0;
}

/* Returns false if the bytes are the number that means "no value". */
static bool schema_value(const schema_field *field, const uint8_t *bytes, double *value) {
    const uint32_t raw = wire_number(bytes, field->size);
    const uint32_t top = field->size > 0 ? 1U << (8U * field->size - 1U) : 0;
    const bool below = field->is_signed && (raw & top) != 0;
    const double number = below ? (double)raw - 2.0 * (double)top : (double)raw;
    const bool none = field->size == 2U && raw == (field->is_signed ? 0x8000U : 0xFFFFU);
    *value = number * field->scale + field->offset;
    return !none;
}

unsigned schema_bytes(const schema_field *fields, int count) {
    unsigned bytes = 0;
    for (int i = 0; i < count; i++) {
        bytes += fields[i].size;
    }
    return bytes;
}

/* === the recording ============================================================================ */

#define TICKS_PER_S 1e6
/* Longest time from an event's time stamp to its arrival. Usually it is one or two control steps. */
#define SETTLED_US 50000
/* Displayed length of a pulse if the rig does not report ends. */
#define PULSE_US 100
/* If a frame's sequence number exceeds the expected one by this or more (modulo 2^16), the rig has restarted. */
#define GAP_MOST 0x8000U

enum { EVENT_PULSE, EVENT_STATE, EVENT_TRIP, EVENT_END };

void recording_begin(recording *r, FILE *csv, FILE *waves, FILE *ring, bool plots) {
    *r = (recording){.csv = csv, .waves = waves, .ring = ring, .plots = plots};
}

static int64_t time_of(recording *r, uint32_t ticks) {
    if (!r->timed) {
        r->timed = true;
        r->ticks = ticks;
    }
    return r->time_us + (int32_t)(ticks - r->ticks);
}

/* Makes `ticks` the origin from which time_of() measures. */
static void go_on(recording *r, uint32_t ticks) {
    r->time_us = time_of(r, ticks);
    r->ticks = ticks;
}

void recording_anew(recording *r) {
    r->counts.restarts += r->timed;
    r->time_us = r->expects ? r->expected_us : r->time_us;
    r->timed = false; /* the next frame gets the time r->time_us */
    memset(r->channel, 0, sizeof r->channel);
    r->expects = false;
    r->ends = r->high[0] = r->high[1] = false; /* the new program may report no ends of pulses */
}

void recording_asked(recording *r) { r->expects = false; }

static void count(recording *r, const wire_frame *frame) {
    recording_channel *c = &r->channel[frame->channel];
    const uint16_t gap = (uint16_t)(frame->sequence - c->next);
    if (c->any && gap >= GAP_MOST) {
        recording_anew(r);
    } else if (c->any) {
        r->counts.lost += gap;
        r->counts.dropped += (uint16_t)(frame->dropped - c->dropped);
    }
    c->any = true;
    c->next = (uint16_t)(frame->sequence + 1U);
    c->dropped = frame->dropped;
    r->counts.frames++;
}

static void put_number(FILE *to, bool there, double value) {
    if (there) {
        fprintf(to, ",%.9g", value);
    } else {
        fputc(',', to);
    }
}

/* Names columns and signals, once. */
static void head(recording *r, const schema_channel *c) {
    if (r->headed) {
        return;
    }
    r->headed = true;
    r->columns = 1 + c->eaches + c->onces;
    r->plot = r->plots ? decimation_new(r->columns, false) : NULL;
    if (r->waves != NULL) {
        r->vcd = vcd_new(r->waves, "telemetry, recorded by whirl monitor", 6, "rig", 9);
    }
    if (r->csv != NULL) {
        fputs("time", r->csv);
    }
    for (int i = 0; i < c->eaches + c->onces; i++) {
        const schema_field *field = i < c->eaches ? &c->each[i] : &c->once[i - c->eaches];
        if (r->csv != NULL) {
            fprintf(r->csv, ",%s", field->name);
        }
        r->signal[i] = r->vcd != NULL ? vcd_add(r->vcd, VCD_REAL, field->name, NULL) : -1;
    }
    if (r->csv != NULL) {
        fputs("\r\n", r->csv);
    }
    if (r->vcd != NULL) {
        r->trip = vcd_add(r->vcd, VCD_REAL, "trip", NULL);
        r->pulse[0] = vcd_add(r->vcd, VCD_WIRE, "slot1", NULL);
        r->pulse[1] = vcd_add(r->vcd, VCD_WIRE, "slot2", NULL);
        for (int i = 0; i < 2; i++) {
            vcd_change(r->vcd, r->pulse[i], 0, 0.0);
        }
    }
}

/* Records a sample: its own values at `each`, then those at `once`, which all samples of its frame share. */
static void take_sample(recording *r, const schema_channel *c, int64_t time_us, const uint8_t *each,
                        const uint8_t *once) {
    double values[1 + 2 * SCHEMA_FIELDS];
    values[0] = (double)time_us / TICKS_PER_S;
    if (r->csv != NULL) {
        fprintf(r->csv, "%.6f", values[0]);
    }
    for (int i = 0; i < c->eaches + c->onces; i++) {
        const bool is_each = i < c->eaches;
        const schema_field *field = is_each ? &c->each[i] : &c->once[i - c->eaches];
        const bool there = schema_value(field, is_each ? each : once, &values[1 + i]);
        *(is_each ? &each : &once) += field->size;
        if (r->csv != NULL) {
            put_number(r->csv, there, values[1 + i]);
        }
        if (!there) {
            values[1 + i] = (double)NAN;
        }
        if (r->vcd != NULL && isfinite(values[1 + i])) {
            vcd_change(r->vcd, r->signal[i], time_us, values[1 + i]);
        }
    }
    if (r->csv != NULL) {
        fputs("\r\n", r->csv);
    }
    if (r->plot != NULL) {
        decimation_enter(r->plot, values);
    }
    r->counts.samples++;
}

static void take_run(recording *r, const schema_channel *c, const wire_frame *frame) {
    const unsigned once = schema_bytes(c->once, c->onces);
    const unsigned each = schema_bytes(c->each, c->eaches);
    if (each == 0 || frame->length < once || (frame->length - once) % each != 0) {
        r->counts.strange++;
        return;
    }
    const int64_t begin_us = time_of(r, frame->ticks);
    const int64_t period_us = c->period_ticks;
    head(r, c);
    if (r->expects && period_us > 0 && begin_us > r->expected_us + period_us / 2) {
        r->counts.lost_samples +=
            (uint64_t)((begin_us - r->expected_us + period_us / 2) / period_us);
    }
    const unsigned samples = (frame->length - once) / each;
    for (unsigned i = 0; i < samples; i++) {
        take_sample(r, c, begin_us + (int64_t)i * period_us, frame->payload + once + i * each,
                    frame->payload);
    }
    r->expects = true;
    r->expected_us = begin_us + (int64_t)samples * period_us;
    go_on(r, frame->ticks);
    if (r->vcd != NULL) {
        vcd_settle(r->vcd, r->expected_us - SETTLED_US);
    }
}

static void take_event(recording *r, const schema_channel *run, const wire_frame *frame) {
    if (frame->length != 2U) {
        r->counts.strange++;
        return;
    }
    const int64_t time_us = time_of(r, frame->ticks);
    const unsigned value = frame->payload[1];
    const bool pulses = frame->payload[0] == EVENT_PULSE && value < 2U;
    r->counts.pulses += pulses;
    if (run->known) {
        head(r, run);
    }
    if (r->vcd == NULL) {
        return;
    }
    if (pulses) {
        if (r->high[value]) { /* the end of the last pulse was lost */
            vcd_change(r->vcd, r->pulse[value], time_us - 1, 0.0);
        }
        r->high[value] = r->ends;
        vcd_change(r->vcd, r->pulse[value], time_us, 1.0);
        if (!r->ends) {
            vcd_change(r->vcd, r->pulse[value], time_us + PULSE_US, 0.0);
        }
    } else if (frame->payload[0] == EVENT_END && value < 2U) {
        r->ends = true;
        r->high[value] = false;
        vcd_change(r->vcd, r->pulse[value], time_us, 0.0);
    } else if (frame->payload[0] == EVENT_TRIP) {
        vcd_change(r->vcd, r->trip, time_us, value);
    }
}

static void take_ring(recording *r, const schema_channel *c, const wire_frame *frame) {
    const unsigned each = schema_bytes(c->each, c->eaches);
    if (each < 2U || c->each[0].size != 2U || frame->length % each != 0) {
        r->counts.strange++;
        return;
    }
    if (r->ring == NULL) {
        return;
    }
    if (!r->ring_headed) {
        r->ring_headed = true;
        fputs("time", r->ring);
        for (int i = 1; i < c->eaches; i++) {
            fprintf(r->ring, ",%s", c->each[i].name);
        }
        fputs("\r\n", r->ring);
    }
    uint32_t ticks = frame->ticks;
    for (const uint8_t *at = frame->payload; at < frame->payload + frame->length;) {
        /* a row has only the low 16 bits of its ticks */
        ticks += (uint16_t)(wire_number(at, 2) - ticks);
        fprintf(r->ring, "%.6f", (double)time_of(r, ticks) / TICKS_PER_S);
        at += 2;
        for (int i = 1; i < c->eaches; i++) {
            double value;
            const bool there = schema_value(&c->each[i], at, &value);
            put_number(r->ring, there, value);
            at += c->each[i].size;
        }
        fputs("\r\n", r->ring);
    }
}

void recording_frame(recording *r, const schema *s, const wire_frame *frame) {
    if (frame->channel >= SCHEMA_CHANNELS || !s->channel[frame->channel].known) {
        r->counts.strange++;
        return;
    }
    const schema_channel *c = &s->channel[frame->channel];
    count(r, frame);
    switch (frame->channel) {
    case RECORDING_RUN: take_run(r, c, frame); break;
    case RECORDING_EVENT: take_event(r, &s->channel[RECORDING_RUN], frame); break;
    case RECORDING_RING: take_ring(r, c, frame); break;
    default: break;
    }
}

bool recording_plot(const recording *r, const schema *s, const char *file) {
    const schema_channel *c = &s->channel[RECORDING_RUN];
    plot_run run;
    bool any = false;
    plot_run_open(&run, "Samples of the rig", "rig", r->columns > 0 ? r->columns : 1);
    plot_run_head(&run, 0, "time");
    for (int i = 1; i < r->columns; i++) {
        const schema_field *field = i <= c->eaches ? &c->each[i - 1] : &c->once[i - 1 - c->eaches];
        const bool has_unit = strchr(field->name, '[') != NULL;
        /* a column without a unit gets the name of a rate, because the plot omits rates */
        plot_run_head(&run, i, has_unit ? field->name : "der()");
        any = any || has_unit;
    }
    if (any) {
        run.data = decimation_rows(r->plot, &run.rows);
    } else {
        fputs("whirl monitor: error: nothing to plot: no samples came\n", stderr);
    }
    const bool drawn = any && plot_draw("monitor", file, &(plot_choice){0}, &run, 1);
    plot_run_close(&run);
    return drawn;
}

void recording_end(recording *r) {
    vcd_end(r->vcd);
    decimation_free(r->plot);
    r->vcd = NULL;
    r->plot = NULL;
}
