/* test_monitor.c: telemetry as records, waves and counts (host/monitor/recording.h). Frames of random channels, with
 * losses, clock wraps and restarts, are compared with files that the test itself writes. Also schema lines. */
#include "host/base/alloc.h"
#include "host/monitor/recording.h"
#include "host/monitor/wire.h"

#include "command.h"

/* === suite recording ========================================================================== */

enum { PAYLOAD_MOST = 400, PULSES_MOST = 200 };

static dice die;

typedef struct told {
    schema s;
    recording r;
    char *csv;
    char *waves;
    char *ring;
    size_t length[3];
    char *wanted_csv;
    char *wanted_ring;
    size_t wanted_length[2];
    FILE *to_csv;
    FILE *to_ring;
    recording_counts counts;
    int64_t time_us;     /* time of the next sample */
    uint32_t ticks_of_0; /* the rig's clock at time 0 */
    bool begun;          /* a frame has come since the start */
    bool run_came;
    bool headed; /* the header of the records is written */
    bool ring_headed;
    uint16_t next[SCHEMA_CHANNELS];
    uint16_t dropped[SCHEMA_CHANNELS];
    bool any[SCHEMA_CHANNELS];
    int pulses;
    int64_t pulse_us[PULSES_MOST];
    unsigned pulse_of[PULSES_MOST];
    int pulse_long[PULSES_MOST]; /* length of each pulse, us; 0: unknown */
    bool tells_ends;             /* the rig reports the ends of pulses */
    bool has_ended;
    int64_t free_from_us[2]; /* end of the last pulse of each sensor */
    int64_t trip_us;
    unsigned trip;
    int64_t sample_us; /* time of the last sample */
    double sample;     /* first field of the last sample; NaN if none */
} told;

static told t;

static uint32_t drawn_32(void) {
    return dice_one_of(&die, 65536U) << 16 | dice_one_of(&die, 65536U);
}

static schema_field drawn_field(const char *what, int i) {
    static const unsigned sizes[] = {1, 2, 2, 4};
    schema_field f = {.size = sizes[dice_one_of(&die, 4)],
                      .is_signed = dice_one_of(&die, 2) == 0,
                      .scale = dice_between(&die, 1e-4, 1.0),
                      .offset =
                          dice_one_of(&die, 2) == 0 ? 0.0 : dice_between(&die, -100.0, 100.0)};
    snprintf(f.name, sizeof f.name, "%s%d%s", what, i, dice_one_of(&die, 3) == 0 ? "" : " [N]");
    return f;
}

static schema_channel drawn_channel(int eaches, int onces, uint32_t period_ticks) {
    schema_channel c = {
        .known = true, .period_ticks = period_ticks, .onces = onces, .eaches = eaches};
    for (int i = 0; i < eaches; i++) {
        c.each[i] = drawn_field("each", i);
    }
    for (int i = 0; i < onces; i++) {
        c.once[i] = drawn_field("once", i);
    }
    return c;
}

static void head_of(FILE *to, const schema_channel *c, int from) {
    fputs("time", to);
    for (int i = from; i < c->eaches; i++) {
        fprintf(to, ",%s", c->each[i].name);
    }
    for (int i = 0; i < c->onces; i++) {
        fprintf(to, ",%s", c->once[i].name);
    }
    fputs("\r\n", to);
}

static void begin(bool files, bool plots) {
    t = (told){.ticks_of_0 = drawn_32(), .tells_ends = dice_one_of(&die, 2) == 0};
    t.s.channel[RECORDING_RUN] =
        drawn_channel(1 + (int)dice_one_of(&die, 4), (int)dice_one_of(&die, 4),
                      1000U + 1000U * dice_one_of(&die, 5));
    t.s.channel[RECORDING_RING] = drawn_channel(2 + (int)dice_one_of(&die, 4), 0, 0);
    t.s.channel[RECORDING_RING].each[0].size = 2;
    t.s.channel[RECORDING_EVENT].known = true;
    t.sample = (double)NAN;
    t.to_csv = alloc_text(&t.wanted_csv, &t.wanted_length[0]);
    t.to_ring = alloc_text(&t.wanted_ring, &t.wanted_length[1]);
    recording_begin(&t.r, files ? alloc_text(&t.csv, &t.length[0]) : NULL,
                    files ? alloc_text(&t.waves, &t.length[1]) : NULL,
                    files ? alloc_text(&t.ring, &t.length[2]) : NULL, plots);
}

static void end(void) {
    recording_end(&t.r);
    TEST_ASSERT_TRUE(t.r.vcd == NULL && t.r.plot == NULL);
    alloc_text_end(t.to_csv);
    alloc_text_end(t.to_ring);
    if (t.r.csv != NULL) {
        alloc_text_end(t.r.csv);
        alloc_text_end(t.r.waves);
        alloc_text_end(t.r.ring);
    }
}

static void drop(void) {
    free(t.csv);
    free(t.waves);
    free(t.ring);
    free(t.wanted_csv);
    free(t.wanted_ring);
}

/* Writes random bytes of a field to at[], and to `words` the text that a record must have. Returns the value, NaN if
 * the field is invalid. */
static double put_field(const schema_field *f, uint8_t *at, char *words) {
    const uint32_t usual = drawn_32() >> (32U - 8U * f->size);
    const bool none = f->size == 2 && dice_one_of(&die, 5) == 0;
    const uint32_t raw = none ? (f->is_signed ? 0x8000U : 0xFFFFU) : usual;
    const int64_t whole = 256LL << (8U * (f->size - 1U));
    const int64_t number = f->is_signed && raw >= (uint64_t)whole / 2U ? (int64_t)raw - whole : raw;
    for (unsigned i = 0; i < f->size; i++) {
        at[i] = (uint8_t)(raw >> 8U * i);
    }
    const bool is_none = f->size == 2 && (f->is_signed ? number == -32768 : number == 65535);
    const double value = (double)number * f->scale + f->offset;
    words[0] = '\0';
    if (!is_none) {
        snprintf(words, 40, "%.9g", value);
    }
    return is_none ? (double)NAN : value;
}

static void send(unsigned channel, int64_t time_us, const uint8_t *payload, unsigned length) {
    const wire_frame frame = {.channel = channel,
                              .sequence = channel < SCHEMA_CHANNELS ? t.next[channel] : 0,
                              .dropped = channel < SCHEMA_CHANNELS ? t.dropped[channel] : 0,
                              .ticks = t.ticks_of_0 + (uint32_t)time_us,
                              .payload = payload,
                              .length = length};
    recording_frame(&t.r, &t.s, &frame);
    if (channel < SCHEMA_CHANNELS) {
        t.next[channel]++;
        t.any[channel] = true;
        t.counts.frames++;
    }
}

/* Loses some frames. The rig itself dropped a part of them. */
static void lose(unsigned channel) {
    if (t.any[channel] && dice_one_of(&die, 4) == 0) {
        const unsigned lost =
            dice_one_of(&die, 3) == 0 ? dice_one_of(&die, 0x7FFF) : dice_one_of(&die, 3);
        const unsigned dropped = lost > 0 ? dice_one_of(&die, lost + 1U) : 0;
        t.next[channel] = (uint16_t)(t.next[channel] + lost);
        t.dropped[channel] = (uint16_t)(t.dropped[channel] + dropped);
        t.counts.lost += lost;
        t.counts.dropped += dropped;
    }
}

/* A time between two samples, so that a pulse has a clear place among the samples. */
static int64_t about_now_us(void) { return t.time_us + 1 + (int64_t)dice_one_of(&die, 900); }

static void send_run(void) {
    const schema_channel *c = &t.s.channel[RECORDING_RUN];
    uint8_t payload[PAYLOAD_MOST];
    char once_words[SCHEMA_FIELDS][40];
    double once[SCHEMA_FIELDS] = {0.0};
    unsigned at = 0;
    lose(RECORDING_RUN);
    if (t.run_came && dice_one_of(&die, 3) == 0) { /* some samples are missing */
        const uint32_t lost = dice_one_of(&die, 8) == 0 ? 40000 : 1 + dice_one_of(&die, 5);
        t.time_us += (int64_t)lost * c->period_ticks;
        t.counts.lost_samples += lost;
    }
    const int64_t most_us =
        c->period_ticks * 9 / 20; /* below half a period, so that rounding removes the jitter */
    const int64_t jitter_us =
        t.run_came ? (int64_t)dice_one_of(&die, 2U * (unsigned)most_us) - most_us : 0;
    const int64_t begin_us = t.time_us + jitter_us;
    for (int i = 0; i < c->onces; i++) {
        once[i] = put_field(&c->once[i], payload + at, once_words[i]);
        at += c->once[i].size;
    }
    const unsigned samples = dice_one_of(&die, 5);
    if (!t.headed) {
        t.headed = true;
        head_of(t.to_csv, c, 0);
    }
    for (unsigned k = 0; k < samples; k++) {
        const int64_t time_us = begin_us + (int64_t)(k * c->period_ticks);
        fprintf(t.to_csv, "%.6f", (double)time_us / 1e6);
        for (int i = 0; i < c->eaches; i++) {
            char words[40];
            const double value = put_field(&c->each[i], payload + at, words);
            at += c->each[i].size;
            fprintf(t.to_csv, ",%s", words);
            if (i == 0 && isfinite(value)) {
                t.sample = value;
            }
        }
        for (int i = 0; i < c->onces; i++) {
            fprintf(t.to_csv, ",%s", once_words[i]);
            TEST_ASSERT_TRUE(once_words[i][0] != '\0' || isnan(once[i]));
        }
        fputs("\r\n", t.to_csv);
        t.sample_us = time_us;
    }
    send(RECORDING_RUN, begin_us, payload, at);
    t.counts.samples += samples;
    t.time_us = begin_us + (int64_t)(samples * c->period_ticks);
    t.run_came = true;
}

static void send_ring(void) {
    const schema_channel *c = &t.s.channel[RECORDING_RING];
    uint8_t payload[PAYLOAD_MOST];
    unsigned at = 0;
    lose(RECORDING_RING);
    const int64_t begin_us = t.time_us;
    const unsigned rows = dice_one_of(&die, 6);
    if (!t.ring_headed) {
        t.ring_headed = true;
        head_of(t.to_ring, c, 1);
    }
    int64_t time_us = begin_us;
    for (unsigned k = 0; k < rows; k++) {
        time_us += dice_one_of(&die, 60000); /* only the low 16 bits of the clock are sent */
        const uint32_t ticks = t.ticks_of_0 + (uint32_t)time_us;
        payload[at++] = (uint8_t)ticks;
        payload[at++] = (uint8_t)(ticks >> 8);
        fprintf(t.to_ring, "%.6f", (double)time_us / 1e6);
        for (int i = 1; i < c->eaches; i++) {
            char words[40];
            (void)put_field(&c->each[i], payload + at, words);
            at += c->each[i].size;
            fprintf(t.to_ring, ",%s", words);
        }
        fputs("\r\n", t.to_ring);
    }
    send(RECORDING_RING, begin_us, payload, at);
}

static void send_event(void) {
    uint8_t payload[2] = {(uint8_t)dice_one_of(&die, 5), (uint8_t)dice_one_of(&die, 4)};
    const int64_t time_us = about_now_us();
    int high_us = 0;
    if (payload[0] == 0 && payload[1] < 2) {
        const unsigned sensor = payload[1];
        if (time_us < t.free_from_us[sensor] || t.pulses == PULSES_MOST) {
            return;
        }
        high_us = t.tells_ends ? 1 + (int)dice_one_of(&die, 2000) : 0;
        t.free_from_us[sensor] = time_us + (high_us > 100 ? high_us : 100) + 1;
        t.pulse_us[t.pulses] = time_us;
        t.pulse_long[t.pulses] = t.has_ended || (high_us > 0 && high_us < 100) ? high_us : 100;
        t.pulse_of[t.pulses++] = sensor;
        t.counts.pulses++;
    } else if (payload[0] == 2) {
        if (time_us <= t.trip_us) {
            return;
        }
        t.trip_us = time_us;
        t.trip = payload[1];
    } else if (payload[0] == 3 && payload[1] < 2) {
        return; /* an end of a pulse is only sent after its begin */
    }
    lose(RECORDING_EVENT);
    send(RECORDING_EVENT, time_us, payload, 2);
    if (high_us > 0 && t.has_ended && dice_one_of(&die, 8) == 0) { /* loses the pulse's end */
        t.pulse_long[t.pulses - 1] = 0;
    } else if (high_us > 0) {
        payload[0] = 3;
        lose(RECORDING_EVENT);
        send(RECORDING_EVENT, time_us + high_us, payload, 2);
        t.has_ended = true;
    }
}

/* Sends frames that have no schema, or that do not fit their schema. */
static void send_strange(void) {
    static const uint8_t payload[PAYLOAD_MOST];
    const schema_channel *run = &t.s.channel[RECORDING_RUN];
    const schema_channel *ring = &t.s.channel[RECORDING_RING];
    const unsigned once = schema_bytes(run->once, run->onces);
    t.counts.strange++;
    switch (dice_one_of(&die, 6)) {
    case 0: send(SCHEMA_CHANNELS + dice_one_of(&die, 9), t.time_us, payload, 4); return;
    case 1:
        recording_frame(&t.r, &t.s, &(wire_frame){.channel = 6, .payload = payload, .length = 3});
        return;
    case 2: send(RECORDING_EVENT, t.time_us, payload, dice_one_of(&die, 2) == 0 ? 1 : 3); return;
    case 3:
        if (once > 0) {
            send(RECORDING_RUN, t.time_us, payload, once - 1U);
            return;
        }
        break;
    case 4:
        if (schema_bytes(run->each, run->eaches) > 1) {
            send(RECORDING_RUN, t.time_us, payload,
                 once + schema_bytes(run->each, run->eaches) + 1U);
            return;
        }
        break;
    default:
        send(RECORDING_RING, t.time_us, payload, schema_bytes(ring->each, ring->eaches) + 1U);
        return;
    }
    t.counts.strange--;
}

/* The rig restarts with another clock and other sequence numbers. A line of the rig, or a lower sequence number,
 * shows this. The first sample comes at the expected time. */
static void begin_anew(void) {
    if (!t.begun || !t.run_came) {
        return;
    }
    const bool is_told = dice_one_of(&die, 2) == 0;
    const uint16_t before = t.next[RECORDING_RUN];
    t.ticks_of_0 = drawn_32();
    t.tells_ends = dice_one_of(&die, 2) == 0;
    t.has_ended = false;
    memset(t.any, 0, sizeof t.any);
    for (int i = 0; i < SCHEMA_CHANNELS; i++) {
        t.next[i] = (uint16_t)drawn_32();
        t.dropped[i] = (uint16_t)drawn_32();
    }
    if (is_told) {
        recording_anew(&t.r);
    } else {
        t.next[RECORDING_RUN] = (uint16_t)(before - 1U - dice_one_of(&die, 0x7FFF));
    }
    t.counts.restarts++;
    t.run_came = false;
    send_run();
}

static void ask_anew(void) {
    recording_asked(&t.r);
    t.time_us += dice_one_of(&die, 200000);
    t.run_came = false;
    send_run();
}

static void send_any(void) {
    const unsigned kind = dice_one_of(&die, 11);
    t.begun = true;
    if (kind < 4 || t.counts.samples == 0) {
        send_run();
    } else if (kind < 5) {
        send_ring();
    } else if (kind < 7) {
        send_event();
    } else if (kind < 8) {
        send_strange();
    } else if (kind < 10) {
        begin_anew();
    } else {
        ask_anew();
    }
}

/* A signal's value at a time of the dump; NaN before its first value. `name` is the last word of the signal's
 * declaration. */
static double dumped(const char *name, int64_t time_us) {
    char var[80];
    char id[12] = "";
    double value = (double)NAN;
    long long now = -1;
    snprintf(var, sizeof var, " %s $end\n", name);
    const char *at = strstr(t.waves, var);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, var);
    while (at[-1] != ' ') {
        at--;
    }
    const char *id_at = at;
    snprintf(id, sizeof id, "%.*s", (int)strcspn(id_at, " "), id_at);
    for (const char *line = strstr(t.waves, "$enddefinitions"); line != NULL;
         line = strchr(line, '\n')) {
        line += line[0] == '\n' ? 1 : 0;
        if (*line == '#') {
            now = strtoll(line + 1, NULL, 10);
        } else if (now <= time_us && (*line == 'r' || *line == '0' || *line == '1')) {
            char *behind = NULL;
            const double number = *line == 'r' ? strtod(line + 1, &behind) : *line - '0';
            const char *of = *line == 'r' ? behind + 1 : line + 1;
            if (strncmp(of, id, strlen(id)) == 0 && of[strlen(id)] == '\n') {
                value = number;
            }
        }
    }
    return value;
}

static void expect_waves(void) {
    static const char *const slots[] = {"slot1", "slot2"};
    TEST_ASSERT_TRUE(dumped(slots[0], 0) == 0.0 && dumped(slots[1], 0) == 0.0);
    for (int i = 0; i < t.pulses; i++) {
        const char *slot = slots[t.pulse_of[i]];
        TEST_ASSERT_TRUE(
            dumped(slot, t.pulse_us[i]) == 1.0 &&
            (t.pulse_long[i] == 0 || dumped(slot, t.pulse_us[i] + t.pulse_long[i] - 1) == 1.0));
        TEST_ASSERT_TRUE(t.pulse_long[i] == 0 ||
                         dumped(slot, t.pulse_us[i] + t.pulse_long[i]) == 0.0);
        TEST_ASSERT_TRUE(t.pulse_us[i] == 0 || dumped(slot, t.pulse_us[i] - 1) == 0.0);
    }
    if (t.trip_us > 0) {
        TEST_ASSERT_TRUE(dumped("trip", t.trip_us) == (double)t.trip);
    }
    if (isfinite(t.sample)) {
        const bool has_unit = strchr(t.s.channel[RECORDING_RUN].each[0].name, '[') != NULL;
        const double got = dumped(has_unit ? "each0_N" : "each0", t.sample_us);
        TEST_ASSERT_TRUE(fabs(got - t.sample) <= 1e-8 * fabs(t.sample));
    }
}

/* Tests recordings with and without files, and with and without rows for a picture. */
TEST(recording, streams) {
    unsigned pulses = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(50, 20)); c++) {
        const bool files = c % 5 != 0;
        const bool plots = c % 10 == 0;
        begin(files, plots);
        for (int i = 0; i < 60; i++) {
            send_any();
        }
        TEST_ASSERT_EQUAL_MEMORY(&t.counts, &t.r.counts, sizeof t.counts);
        int rows = 0;
        free(t.r.plot != NULL ? decimation_rows(t.r.plot, &rows) : NULL);
        TEST_ASSERT_EQUAL_INT64(plots ? (int64_t)t.counts.samples : 0, rows);
        end();
        if (files) {
            TEST_ASSERT_EQUAL_STRING(t.wanted_csv, t.csv);
            TEST_ASSERT_EQUAL_STRING(t.wanted_ring, t.ring);
            expect_waves();
            pulses += (unsigned)t.pulses;
        }
        drop();
    }
    TEST_ASSERT_TRUE(pulses > 10);
}

SUITE(recording) { die = dice_of("recording", 48); }

/* === suite schema ============================================================================= */
/* Schema lines of a rig (host/monitor/recording.h). Random channels, states and rates must be read as written. A
 * line with a missing or wrong part must be refused and change nothing. */

enum { LINE = 600, PIECES = 5 };

/* A channel, and the parts of its line. A test can omit or replace each part. */
typedef struct written {
    schema_channel channel;
    unsigned index;
    char piece[PIECES][LINE]; /* channel, name, period_ticks, once, each */
} written;

static void draw_word(char *to, unsigned longest) {
    const unsigned length = 1U + dice_one_of(&die, longest);
    for (unsigned i = 0; i < length; i++) {
        to[i] = (char)('a' + (char)dice_one_of(&die, 26));
    }
    to[length] = '\0';
}

/* Writes fields, separated by commas. The last field may lack its offset. */
static void draw_fields(schema_field *fields, int count, char *text) {
    static const unsigned sizes[] = {1, 2, 4};
    size_t at = strlen(text);
    for (int i = 0; i < count; i++) {
        schema_field *f = &fields[i];
        char word[20];
        const bool has_unit = dice_one_of(&die, 2) != 0;
        draw_word(word, 12);
        *f = (schema_field){.size = sizes[dice_one_of(&die, 3)],
                            .is_signed = dice_one_of(&die, 2) != 0,
                            .scale = dice_between(&die, -3.0, 3.0),
                            .offset =
                                dice_one_of(&die, 2) != 0 ? dice_between(&die, -9.0, 9.0) : 0.0};
        snprintf(f->name, sizeof f->name, has_unit ? "%s [N]" : "%s", word);
        at += (size_t)snprintf(text + at, LINE - at, "%s%s%s:%c%u:%.17g", i > 0 ? "," : "", word,
                               has_unit ? "[N]" : "", f->is_signed ? 'i' : 'u', f->size, f->scale);
        if (f->offset != 0.0) {
            at += (size_t)snprintf(text + at, LINE - at, ":%.17g", f->offset);
        }
    }
}

static void draw_channel(written *w) {
    schema_channel *c = &w->channel;
    memset(w, 0, sizeof *w);
    w->index = dice_one_of(&die, SCHEMA_CHANNELS);
    c->known = true;
    draw_word(c->name, SCHEMA_NAME - 2);
    c->period_ticks = dice_one_of(&die, 3) != 0 ? dice_one_of(&die, 100000) : UINT32_MAX;
    c->onces = (int)dice_one_of(&die, SCHEMA_FIELDS + 1);
    c->eaches = (int)dice_one_of(&die, SCHEMA_FIELDS + 1);
    snprintf(w->piece[0], LINE, "channel=%u", w->index);
    snprintf(w->piece[1], LINE, "name=%s", c->name);
    snprintf(w->piece[2], LINE, "period_ticks=%lu", (unsigned long)c->period_ticks);
    snprintf(w->piece[3], LINE, "once=");
    draw_fields(c->once, c->onces, w->piece[3]);
    snprintf(w->piece[4], LINE, "each=");
    draw_fields(c->each, c->eaches, w->piece[4]);
}

static void join(const written *w, int left_out, char *line) {
    size_t at = (size_t)snprintf(line, (size_t)PIECES * LINE, "OK");
    for (int i = 0; i < PIECES; i++) {
        if (i != left_out) {
            at += (size_t)snprintf(line + at, (size_t)PIECES * LINE - at, " %s", w->piece[i]);
        }
    }
}

static void expect_fields(const schema_field *wanted, const schema_field *found, int count) {
    for (int i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_STRING(wanted[i].name, found[i].name);
        TEST_ASSERT_EQUAL_UINT(wanted[i].size, found[i].size);
        TEST_ASSERT_EQUAL(wanted[i].is_signed, found[i].is_signed);
        TEST_ASSERT_TRUE(wanted[i].scale == found[i].scale && wanted[i].offset == found[i].offset);
    }
}

static void expect_refused(const schema *s, const char *line) {
    schema tried = *s;
    TEST_ASSERT_FALSE_MESSAGE(schema_take(&tried, line), line);
    TEST_ASSERT_TRUE_MESSAGE(memcmp(&tried, s, sizeof tried) == 0, line);
}

TEST(schema, channels_are_as_written) {
    static schema s;
    die = dice_of("schema", 61);
    memset(&s, 0, sizeof s);
    for (unsigned i = 0; i < 300U; i++) {
        written w;
        static char line[PIECES * LINE];
        draw_channel(&w);
        join(&w, -1, line);
        TEST_ASSERT_TRUE_MESSAGE(schema_take(&s, line), line);
        const schema_channel *c = &s.channel[w.index];
        TEST_ASSERT_TRUE(c->known);
        TEST_ASSERT_EQUAL_STRING(w.channel.name, c->name);
        TEST_ASSERT_EQUAL_UINT32(w.channel.period_ticks, c->period_ticks);
        TEST_ASSERT_EQUAL_INT(w.channel.onces, c->onces);
        TEST_ASSERT_EQUAL_INT(w.channel.eaches, c->eaches);
        expect_fields(w.channel.once, c->once, c->onces);
        expect_fields(w.channel.each, c->each, c->eaches);
    }
}

TEST(schema, wrong_schemas_are_refused) {
    static const char *const wrong[PIECES][6] = {
        {"channel=8", "channel=-1", "channel=x", "channel=", "channel=1e9", "channel=nan"},
        {"name=", "name=:", "name=abcdefghijklmnopqrstuvwxyzabcdef", "named=a", "nam=a",
         "name = a"},
        {"period_ticks=-1", "period_ticks=4294967296", "period_ticks=x",
         "period_ticks=", "period_ticks=nan", "ticks=1"},
        {"once=a", "once=a:u3:1", "once=a:f4:1", "once=a:u1", "once=a:u1:x", "once=a:u1:inf"},
        {"each=a:u1:", "each=a:u1:1:x", "each=a:u1:1:inf", "each=a,b", "each=a[b:u1:1,c:u0:1",
         "each=a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1"}};
    static schema s;
    die = dice_of("schema", 62);
    memset(&s, 0, sizeof s);
    for (unsigned i = 0; i < 40U; i++) {
        written w;
        static char line[PIECES * LINE];
        draw_channel(&w);
        join(&w, -1, line);
        TEST_ASSERT_TRUE_MESSAGE(schema_take(&s, line), line); /* later lines have no effect */
        for (int k = 0; k < PIECES; k++) {
            char kept[LINE];
            join(&w, k, line);
            expect_refused(&s, line);
            memcpy(kept, w.piece[k], LINE);
            for (int n = 0; n < 6; n++) {
                snprintf(w.piece[k], LINE, "%s", wrong[k][n]);
                join(&w, -1, line);
                expect_refused(&s, line);
            }
            memcpy(w.piece[k], kept, LINE);
        }
    }
}

TEST(schema, rates) {
    static schema s;
    die = dice_of("schema", 63);
    memset(&s, 0, sizeof s);
    expect_refused(&s, "OK rate=100 period_ticks=10000");
    written w;
    static char line[PIECES * LINE];
    do {
        draw_channel(&w);
    } while (w.index != 0);
    join(&w, -1, line);
    TEST_ASSERT_TRUE(schema_take(&s, line));
    for (unsigned i = 0; i < 50U; i++) {
        schema wanted = s;
        const unsigned ticks = dice_one_of(&die, 1000000);
        wanted.channel[0].period_ticks = ticks;
        snprintf(line, sizeof line, "OK rate=%u period_ticks=%u", 1U + ticks / 7U, ticks);
        TEST_ASSERT_TRUE(schema_take(&s, line));
        TEST_ASSERT_TRUE(memcmp(&wanted, &s, sizeof s) == 0);
        expect_refused(&s, "OK rate=5");
        expect_refused(&s, "OK rate=5 period_ticks=-1");
        expect_refused(&s, "OK rate=5 period_ticks=4294967296");
    }
}

TEST(schema, states) {
    static schema s;
    TEST_ASSERT_TRUE(schema_take(&s, "OK 0=idle 1=armed 9=tare"));
    expect_refused(&s, "OK");
    expect_refused(&s, "OK 1=a");
    expect_refused(&s, "ERR 0=a");
}

/* After a frame that was cut off, its remainder and the next line count as torn. The line after that, and a line
 * between complete frames, do not. */
TEST(schema, torn_lines) {
    static wire w;
    static const char bytes[] = "D +\nxH\0ERR 100\r\nOK\r\n\0\x80\x81\0OK\r\n";
    static const bool torn[] = {true, true, false, false};
    int lines = 0;
    wire_forget(&w);
    for (size_t i = 0; i + 1 < sizeof bytes; i++) {
        if (wire_take(&w, (uint8_t)bytes[i]) == WIRE_TEXT) {
            TEST_ASSERT_EQUAL(torn[lines], w.torn);
            lines++;
        }
    }
    TEST_ASSERT_EQUAL(4, lines);
}
