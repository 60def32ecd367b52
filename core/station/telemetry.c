/* telemetry.c: the rig's data as frames, or as lines of text for plotters. */
#include "telemetry.h"

#include "answer.h"
#include "core/cobs.h"
#include "core/frame.h"
#include <stddef.h>

#define RUN_BYTES (5U + 2U * WH_TEL_SAMPLES)
#define EVENT_BYTES 2U
#define LINE_BYTES_OF(count) (WH_TEL_FIXED_BYTES + (count))
#define BEFORE 2U /* bytes in tel->line before the frame: a zero and the first COBS code */
#define TEXT_BYTES 96U

_Static_assert(WH_TEL_FIXED_BYTES + WH_TEL_PAYLOAD_MOST <= WH_COBS_SHORT_MOST, "frames are short");
#define NONE_16 0xFFFFU

/* === the control steps around a trigger ====================================================== */

#define HALF (WH_CAPTURE_STEPS / 2U)
#define PULSED 3U
#define TRIGGERED 4U
#define TRIPPED 8U

static bool triggers(const wh_capture *capture, uint8_t flags) {
    switch (capture->trigger) {
    case WH_CAPTURE_PULSE: return (flags & PULSED) != 0 && capture->count >= HALF;
    case WH_CAPTURE_FAULT: return (flags & TRIPPED) != 0;
    case WH_CAPTURE_OFF:
    case WH_CAPTURE_TRIGGERS: break;
    }
    return false;
}

/* Records a step. Steps must be less than 65 ms apart, because wh_captured has only 16 bits of their times. */
static void capture_step(wh_capture *capture, const wh_captured *step, uint32_t now_ticks) {
    wh_captured *to = &capture->step[capture->next];
    if (capture->count == 0) {
        capture->first_ticks = now_ticks;
    } else if (capture->count == WH_CAPTURE_STEPS) { /* the new step replaces the oldest */
        const uint16_t second = capture->step[(capture->next + 1U) % WH_CAPTURE_STEPS].ticks;
        capture->first_ticks += (uint16_t)(second - to->ticks);
    }
    *to = *step;
    if (capture->state == WH_CAPTURE_WAITS && triggers(capture, step->flags)) {
        capture->state = WH_CAPTURE_TRIGGERED;
        to->flags |= TRIGGERED;
    }
    capture->next = (capture->next + 1U) % WH_CAPTURE_STEPS;
    capture->count += capture->count < WH_CAPTURE_STEPS ? 1U : 0U;
    if (capture->state == WH_CAPTURE_TRIGGERED && --capture->left == 0) {
        capture->state = WH_CAPTURE_FULL;
    }
}

/* Returns stored step i; step 0 is the oldest. */
static const wh_captured *capture_at(const wh_capture *capture, unsigned i) {
    const unsigned oldest = capture->next + WH_CAPTURE_STEPS - capture->count;
    return &capture->step[(oldest + i) % WH_CAPTURE_STEPS];
}

/* === frames and text ========================================================================= */

typedef struct sight {
    wh_tel *tel;
    const wh_rig_config *config;
    const wh_rig *rig;
    const wh_step_inputs *seen;
    wh_ring *out;
    unsigned stage;
    uint16_t speed; /* in 1/50 rpm */
    wh_bytes frame; /* the frame in progress */
    unsigned spare; /* number of bytes in the output ring that must stay free for other data */
} sight;

/* Returns the number rounded and limited to 0 ... 65534, or NONE_16 for NaN. */
static uint16_t in_16(wh_real number) {
    if (!(number >= WH_R(0.0))) {
        return number < WH_R(0.0) ? 0 : NONE_16;
    }
    const wh_real up = number + WH_R(0.5);
    return number < WH_R(65534.0) ? (uint16_t)up : 65534U;
}

unsigned wh_tel_shift(const wh_cell_config *cell) {
    unsigned shift = 0;
    while (cell->raw_max >> shift > 32767) {
        shift++;
    }
    return shift;
}

static int16_t load_of(const wh_cell_config *cell, int32_t raw, wh_load_status status) {
    if (status == WH_LOAD_SATURATED || status == WH_LOAD_DISCONNECTED) {
        return WH_TEL_NO_LOAD;
    }
    const int32_t value = raw / (int32_t)(1U << wh_tel_shift(cell));
    return (int16_t)(value > 32767 ? 32767 : value < -32767 ? -32767 : value);
}

static uint16_t drive_mV(const wh_rig *rig) { return in_16(rig->command.volts * WH_R(1000.0)); }

static uint16_t speed_50(const wh_rig *rig, uint32_t now_ticks) {
    wh_real speed_radps;
    return wh_rig_speed(rig, now_ticks, &speed_radps)
               ? in_16(speed_radps * (WH_R(50.0) / WH_RIG_RADPS_PER_RPM))
               : NONE_16;
}

/* True if `count` more bytes leave half of the ring to the console's answers. */
static bool fits(const wh_ring *out, unsigned count) {
    return wh_ring_room(out) >= out->size / 2U + count;
}

static bool put_out(const sight *s, wh_tel_channel channel, const char *bytes, unsigned count) {
    if (fits(s->out, count + s->spare) && wh_ring_put(s->out, bytes, count)) {
        return true;
    }
    s->tel->dropped[channel]++;
    return false;
}

static void add(sight *s, uint32_t number, unsigned size) { wh_bytes_put(&s->frame, number, size); }

static void begin_frame(sight *s, wh_tel_channel channel, uint32_t ticks) {
    wh_tel *tel = s->tel;
    s->frame.to = tel->line + BEFORE;
    s->frame.room = sizeof tel->line - BEFORE;
    s->frame.at = 0;
    add(s, 0x80U + (uint32_t)channel, 1);
    add(s, tel->sequence[channel]++, 2);
    add(s, tel->dropped[channel], 2);
    add(s, ticks, 4);
}

static bool send_frame(sight *s, wh_tel_channel channel) {
    const wh_bytes *frame = &s->frame;
    uint8_t *line = s->tel->line;
    add(s, wh_crc16(WH_CRC16_START, frame->to, frame->at), 2);
    line[0] = 0;
    return put_out(s, channel, (const char *)line, 1U + wh_cobs_short(line + 1, frame->at));
}

static void send_run(sight *s) {
    wh_tel *tel = s->tel;
    if (tel->samples == 0) {
        return;
    }
    begin_frame(s, WH_TEL_RUN, tel->first_ticks);
    add(s, s->speed, 2);
    add(s, drive_mV(s->rig), 2);
    add(s, s->stage, 1);
    for (unsigned i = 0; i < tel->samples; i++) {
        add(s, (uint16_t)tel->load[i], 2);
    }
    (void)send_frame(s, WH_TEL_RUN);
    tel->samples = 0;
}

static void send_event(sight *s, wh_tel_event what, unsigned value, uint32_t ticks) {
    begin_frame(s, WH_TEL_EVENT, ticks);
    add(s, (uint32_t)what, 1);
    add(s, value, 1);
    (void)send_frame(s, WH_TEL_EVENT);
}

/* Sends the capture's next frame. If the output ring has no space, does nothing: the next step tries again. */
static void send_ring(sight *s) {
    wh_tel *tel = s->tel;
    const wh_capture *capture = &tel->capture;
    const wh_captured *step = capture_at(capture, tel->read_at);
    if (!fits(s->out, LINE_BYTES_OF(WH_TEL_PAYLOAD_MOST))) {
        return;
    }
    tel->read_ticks += (uint16_t)(step->ticks - tel->read_ticks);
    begin_frame(s, WH_TEL_RING, tel->read_ticks);
    for (unsigned i = 0; i < WH_TEL_SAMPLES && tel->read_at < capture->count; i++) {
        step = capture_at(capture, tel->read_at++);
        tel->read_ticks += (uint16_t)(step->ticks - tel->read_ticks);
        add(s, step->ticks, 2);
        add(s, (uint16_t)step->load, 2);
        add(s, step->drive_mV, 2);
        add(s, step->flags, 1);
        add(s, step->stage, 1);
    }
    (void)send_frame(s, WH_TEL_RING);
    tel->reads = tel->read_at < capture->count;
}

static void send_text(sight *s, wh_real force_N) {
    const bool plots = s->tel->format == WH_TEL_TELEPLOT;
    const char *next = plots ? "\r\n>" : ",";
    const wh_value value[] = {{.number = force_N},
                              {.number = (wh_real)s->speed * WH_R(0.02)},
                              {.number = s->rig->command.volts}};
    char bytes[TEXT_BYTES];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, plots ? ">" : "");
    wh_answer(&text, "load_N:@3", &value[0]);
    if (s->speed != NONE_16) {
        wh_text_add(&text, next);
        wh_answer(&text, "speed_rpm:@2", &value[1]);
    }
    wh_text_add(&text, next);
    wh_answer(&text, "drive_V:@3", &value[2]);
    wh_text_add(&text, "\r\n");
    if (text.truncated) {
        s->tel->dropped[WH_TEL_RUN]++;
    } else {
        (void)put_out(s, WH_TEL_RUN, text.bytes, text.length);
    }
}

static void take_sample(sight *s, const wh_step_sample *sample) {
    wh_tel *tel = s->tel;
    const wh_cell_config *cell = &s->config->measure.cell;
    if (sample->status == WH_LOAD_REPEATED || ++tel->passed < tel->every) {
        return;
    }
    tel->passed = 0;
    const wh_load load = wh_cell_load(cell, sample->ticks, sample->raw, sample->status);
    const int16_t value = load_of(cell, sample->raw, load.status);
    if (tel->format != WH_TEL_FRAMES) {
        if (value != WH_TEL_NO_LOAD) {
            send_text(s, load.force_N);
        }
        return;
    }
    const uint32_t period = cell->period_ticks * tel->every;
    const uint32_t due = tel->first_ticks + tel->samples * period;
    if (load.ticks - due + period / 8U > period / 4U) {
        send_run(s);
    }
    if (tel->samples == 0) {
        tel->first_ticks = load.ticks;
    }
    tel->load[tel->samples++] = value;
    if (tel->samples == WH_TEL_SAMPLES) {
        send_run(s);
    }
}

static void take_events(sight *s) {
    wh_tel *tel = s->tel;
    const wh_step_inputs *seen = s->seen;
    const unsigned trip = (unsigned)s->rig->guard.trip;
    if (seen->ended) {
        s->spare = LINE_BYTES_OF(RUN_BYTES) +
                   2U * LINE_BYTES_OF(EVENT_BYTES); /* keep space for this step's other frames */
        send_event(s, WH_TEL_END, seen->end_sensor, seen->end_ticks);
        s->spare = 0;
    }
    if (seen->pulsed) {
        send_event(s, WH_TEL_PULSE, seen->sensor, seen->pulse_ticks);
    }
    if (s->stage != tel->stage) {
        tel->stage = s->stage;
        send_event(s, WH_TEL_STATE, s->stage, seen->inputs.now_ticks);
    } else if (trip != tel->trip) {
        tel->trip = trip;
        send_event(s, WH_TEL_TRIP, trip, seen->inputs.now_ticks);
    }
}

static void record_step(sight *s) {
    const wh_step_inputs *seen = s->seen;
    int16_t load = WH_TEL_NO_LOAD;
    if (seen->samples > 0) {
        const wh_step_sample *last = &seen->sample[seen->samples - 1U];
        const wh_cell_config *cell = &s->config->measure.cell;
        load = load_of(cell, last->raw,
                       wh_cell_load(cell, last->ticks, last->raw, last->status).status);
    }
    const unsigned pulse = seen->pulsed ? 1U << (seen->sensor & 1U) : 0U;
    const unsigned tripped = s->rig->guard.trip != WH_TRIP_NONE ? 8U : 0U;
    const wh_captured step = {.ticks = (uint16_t)seen->inputs.now_ticks,
                              .load = load,
                              .drive_mV = drive_mV(s->rig),
                              .flags = (uint8_t)(pulse | tripped),
                              .stage = (uint8_t)s->stage};
    capture_step(&s->tel->capture, &step, seen->inputs.now_ticks);
}

void wh_tel_step(wh_tel *tel, const wh_rig_config *config, const wh_rig *rig,
                 const wh_step_inputs *seen, wh_ring *out) {
    sight s = {.tel = tel,
               .config = config,
               .rig = rig,
               .seen = seen,
               .out = out,
               .stage = wh_rig_shown_stage(rig),
               .speed = speed_50(rig, seen->inputs.now_ticks)};
    if (tel->capture.state == WH_CAPTURE_WAITS || tel->capture.state == WH_CAPTURE_TRIGGERED) {
        record_step(&s);
    }
    if (tel->every > 0) {
        if (tel->format == WH_TEL_FRAMES) {
            take_events(&s);
        }
        for (unsigned i = 0; i < seen->samples; i++) {
            take_sample(&s, &seen->sample[i]);
        }
    }
    if (tel->reads) {
        send_ring(&s);
    }
}

/* === the console's command `tel` ============================================================= */

#define SPEED "speed[rpm]:u2:0.02"
#define DRIVE ",drive[V]:u2:0.001"
#define SCALE_DECIMALS 12U

#define LISTED(what, word) "|" word
#define CHANNEL(channel, number, name) "," name
#define FORMATS WH_TEL_FORMAT_ROWS(LISTED)
#define TRIGGERS WH_CAPTURE_ROWS(LISTED)
#define STATES WH_CAPTURE_STATE_ROWS(LISTED)
#define CHANNELS WH_TEL_CHANNEL_ROWS(CHANNEL)

/* From now on, sends every n-th sample, with n = `every`; 0: no samples. */
static void set_rate(wh_tel *tel, uint32_t every) {
    tel->every = every;
    tel->passed = 0;
    tel->samples = 0;
    tel->stage = NONE_16; /* no stage has this number, so the stage is reported again */
    tel->trip = NONE_16;
}

/* Starts to send the capture. Returns false if it is not full yet. */
static bool read_ring(wh_tel *tel) {
    if (tel->capture.state != WH_CAPTURE_FULL) {
        return false;
    }
    tel->reads = true;
    tel->read_at = 0;
    tel->read_ticks = tel->capture.first_ticks;
    return true;
}

static uint32_t cell_per_s(const wh_cell_config *cell) {
    return cell->period_ticks > 0 ? WH_RIG_TICKS_PER_S / cell->period_ticks : 0;
}

static uint32_t rate_of(const wh_tel *tel, const wh_cell_config *cell) {
    return tel->every > 0 ? cell_per_s(cell) / tel->every : 0;
}

static void list(const wh_tel *tel, const wh_cell_config *cell, wh_text *answer) {
    wh_value value[] = {{.count = rate_of(tel, cell)},
                        {.word = wh_list_item(FORMATS, tel->format)},
                        {.count = 0},
                        {.word = &CHANNELS[1]}};
    for (unsigned i = 0; i < WH_TEL_CHANNELS; i++) {
        value[2].count += tel->dropped[i];
    }
    wh_answer(answer, " rate=@c fmt=@w dropped=@c channels=@w", value);
}

static void answer_ring(const wh_tel *tel, wh_text *answer) {
    const wh_capture *capture = &tel->capture;
    const wh_value value[] = {{.word = wh_list_item(TRIGGERS, capture->trigger)},
                              {.word = wh_list_item(STATES, capture->state)},
                              {.count = capture->count},
                              {.count = (capture->count + WH_TEL_SAMPLES - 1U) / WH_TEL_SAMPLES}};
    wh_answer(answer, " trigger=@w ring=@w steps=@c frames=@c", value);
}

/* Adds the load's part of the schema, "load[N]:i2:scale:offset". */
static void add_load(const wh_cell_config *cell, wh_text *answer) {
    const wh_value offset[] = {{.number = -cell->offset_N}};
    wh_answer(answer, "load[N]:i2:", NULL);
    wh_text_add_fixed(answer, cell->newton_per_count * (wh_real)(1U << wh_tel_shift(cell)),
                      SCALE_DECIMALS);
    wh_answer(answer, ":@6", offset);
}

static void schema_states(wh_text *answer) {
    for (unsigned stage = 0; stage < WH_RIG_STAGES; stage++) {
        if (stage < WH_RIG_STATES || stage > WH_RIG_STAGE_OF_PHASE) {
            const wh_value value[] = {{.count = stage}, {.word = wh_rig_stage_text(stage)}};
            wh_answer(answer, " @c=@w", value);
        }
    }
}

static wh_station_error schema(const wh_tel *tel, const wh_cell_config *cell, const char *name,
                               wh_text *answer) {
    const unsigned number = wh_list_find(CHANNELS ","
                                                  "states",
                                         name);
    if (number > WH_TEL_CHANNELS) {
        return WH_STATION_TEL_CHANNEL;
    }
    switch ((wh_tel_channel)number) {
    case WH_TEL_RUN:
        wh_answer(answer,
                  " channel=0 name=run period_ticks=@c once=" SPEED DRIVE ",state:u1:1 each=",
                  &(wh_value){.count = cell->period_ticks * (tel->every > 0 ? tel->every : 1U)});
        add_load(cell, answer);
        wh_answer(answer, ": i2 -32768, u2 65535: none", NULL);
        break;
    case WH_TEL_EVENT:
        wh_answer(answer,
                  " channel=1 name=event period_ticks=0 once=what:u1:1,value:u1:1 each="
                  ": what 0 pulse of sensor, 1 state, 2 trip, 3 end of pulse",
                  NULL);
        break;
    case WH_TEL_RING:
        wh_answer(answer, " channel=2 name=ring period_ticks=0 once= each=ticks:u2:1,", NULL);
        add_load(cell, answer);
        wh_answer(answer, DRIVE ",flags:u1:1,state:u1:1: flags 1, 2 pulse, 4 trigger, 8 tripped",
                  NULL);
        break;
    case WH_TEL_CHANNELS: schema_states(answer); break;
    }
    return WH_STATION_FINE;
}

static bool is_too_fast(wh_tel_format format, uint32_t per_s) {
    return format != WH_TEL_FRAMES && per_s > WH_TEL_TEXT_PER_S_MOST;
}

static wh_station_error rate(wh_tel *tel, const wh_cell_config *cell, const char *word,
                             wh_text *answer) {
    wh_real wanted;
    const uint32_t most = cell_per_s(cell);
    if (!wh_line_number(word, &wanted)) {
        return WH_STATION_TEL_RATE;
    }
    const uint32_t per_s = (uint32_t)(int32_t)wanted; /* |wanted| < 1e9: no overflow */
    if ((wh_real)(int32_t)wanted != wanted || per_s == 0 || per_s > most || most % per_s != 0 ||
        is_too_fast(tel->format, per_s)) {
        return WH_STATION_TEL_RATE;
    }
    set_rate(tel, most / per_s);
    const wh_value value[] = {{.count = per_s}, {.count = cell->period_ticks * tel->every}};
    wh_answer(answer, " rate=@c period_ticks=@c", value);
    return WH_STATION_FINE;
}

static wh_station_error set_format(wh_tel *tel, const wh_cell_config *cell, const char *word,
                                   wh_text *answer) {
    const wh_tel_format format = (wh_tel_format)wh_list_find(FORMATS, word);
    const wh_value value[] = {{.word = word}};
    if (format == WH_TEL_FORMATS) {
        return WH_STATION_TEL_FORMAT;
    }
    if (is_too_fast(format, rate_of(tel, cell))) {
        return WH_STATION_TEL_RATE;
    }
    tel->format = format;
    set_rate(tel, tel->every);
    wh_answer(answer, " fmt=@w", value);
    return WH_STATION_FINE;
}

static wh_station_error set_ring(wh_tel *tel, const char *word, wh_text *answer) {
    const unsigned what = wh_list_find(TRIGGERS "|"
                                                "read",
                                       word);
    if (what > WH_CAPTURE_TRIGGERS) {
        return WH_STATION_TEL_HOW;
    }
    if (what < WH_CAPTURE_TRIGGERS) {
        tel->reads = false;
        tel->capture.trigger = (wh_capture_trigger)what;
        tel->capture.state = what == WH_CAPTURE_OFF ? WH_CAPTURE_NONE : WH_CAPTURE_WAITS;
        tel->capture.left = HALF;
        tel->capture.count = 0;
        tel->capture.next = 0;
    } else if (!read_ring(tel)) {
        return WH_STATION_TEL_RING;
    }
    answer_ring(tel, answer);
    return WH_STATION_FINE;
}

/* Subcommands: X(what, word). ALONE_ROWS have no argument, WITH_ROWS have one. */
#define ALONE_ROWS(X) X(ALONE_LIST, "list") X(ALONE_OFF, "off") X(ALONE_RING, "ring")
#define WITH_ROWS(X) \
    X(WITH_SCHEMA, "schema") \
    X(WITH_RATE, "rate") \
    X(WITH_FORMAT, "fmt") X(WITH_RING, "ring")
#define COUNTED(what, word) what,
typedef enum alone { ALONE_ROWS(COUNTED) ALONE_NONE } alone;
typedef enum with { WITH_ROWS(COUNTED) WITH_NONE } with;
#undef COUNTED

static wh_station_error without_word(wh_tel *tel, const wh_cell_config *cell, const char *what,
                                     wh_text *answer) {
    switch ((alone)wh_list_find(ALONE_ROWS(LISTED), what)) {
    case ALONE_LIST: list(tel, cell, answer); break;
    case ALONE_OFF: set_rate(tel, 0); break;
    case ALONE_RING: answer_ring(tel, answer); break;
    case ALONE_NONE: return WH_STATION_TEL_HOW;
    }
    return WH_STATION_FINE;
}

wh_station_error wh_tel_answer(wh_tel *tel, const wh_cell_config *cell, const wh_words *words,
                               wh_text *answer) {
    const char *what = words->word[1];
    const char *word = words->word[2];
    if (words->count < 3U) {
        return without_word(tel, cell, what, answer);
    }
    switch ((with)wh_list_find(WITH_ROWS(LISTED), what)) {
    case WITH_SCHEMA: return schema(tel, cell, word, answer);
    case WITH_RATE: return rate(tel, cell, word, answer);
    case WITH_FORMAT: return set_format(tel, cell, word, answer);
    case WITH_RING: return set_ring(tel, word, answer);
    case WITH_NONE: break;
    }
    return WH_STATION_TEL_HOW;
}
