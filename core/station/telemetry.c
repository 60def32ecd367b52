/* telemetry.c: frames, or lines for plotters, of the rig's data. */
#include "telemetry.h"

#include "answer.h"
#include "core/cobs.h"
#include "core/frame.h"

#define RUN_BYTES (5U + 2U * WH_TEL_SAMPLES)
#define EVENT_BYTES 2U
#define LINE_BYTES_OF(count) (WH_TEL_FIXED_BYTES + (count))
#define BEFORE 2U /* of a frame on the line: a zero, and the first byte of the code */
#define TEXT_BYTES 96U

_Static_assert(WH_TEL_FIXED_BYTES + WH_TEL_PAYLOAD_MOST <= WH_COBS_SHORT_MOST, "frames are short");
#define NONE_16 0xFFFFU

/* The destination and the source. */
typedef struct sight {
    wh_tel *tel;
    const wh_rig_config *config;
    const wh_rig *rig;
    const wh_step_inputs *seen;
    wh_ring *out;
    unsigned stage;
    uint16_t speed; /* in 1/50 rpm */
    wh_bytes frame; /* in progress */
    unsigned spare; /* room reserved for others */
} sight;

/* --- numbers ------------------------------------------------------------------------------------------ */

/* Rounded, within 16 bits; NONE_16 for NaN. */
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

/* In 1/50 rpm. */
static uint16_t speed_50(const wh_rig *rig, uint32_t now_ticks) {
    wh_real speed_radps;
    return wh_rig_speed(rig, now_ticks, &speed_radps)
               ? in_16(speed_radps * (WH_R(50.0) / WH_RIG_RADPS_PER_RPM))
               : NONE_16;
}

/* --- frames ------------------------------------------------------------------------------------------- */

/* Half of the buffer is the console's own. */
static bool fits(const wh_ring *out, unsigned count) {
    return wh_ring_room(out) >= out->size / 2U + count;
}

/* Send the whole frame, or nothing. */
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

/* The ring's frames are never dropped: they wait for room. */
static void send_ring(sight *s) {
    wh_tel *tel = s->tel;
    const wh_capture *capture = &tel->capture;
    const wh_captured *step = wh_capture_at(capture, tel->read_at);
    if (!fits(s->out, LINE_BYTES_OF(WH_TEL_PAYLOAD_MOST))) {
        return;
    }
    tel->read_ticks += (uint16_t)(step->ticks - tel->read_ticks);
    begin_frame(s, WH_TEL_RING, tel->read_ticks);
    for (unsigned i = 0; i < WH_TEL_SAMPLES && tel->read_at < capture->count; i++) {
        step = wh_capture_at(capture, tel->read_at++);
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

/* --- lines -------------------------------------------------------------------------------------------- */

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

/* --- a control step ------------------------------------------------------------------------------------- */

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
        send_run(s); /* the samples so far: the next one is no neighbour */
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
    if (seen->ended) { /* the first to be dropped if many pulses fill the line */
        s->spare = LINE_BYTES_OF(RUN_BYTES) +
                   2U * LINE_BYTES_OF(EVENT_BYTES); /* for later data of this step */
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

static void capture_step(sight *s) {
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
    wh_capture_step(&s->tel->capture, &step, seen->inputs.now_ticks);
}

void wh_tel_rate(wh_tel *tel, uint32_t every) {
    tel->every = every;
    tel->passed = 0;
    tel->samples = 0;
    tel->stage = NONE_16; /* to be reported again */
    tel->trip = NONE_16;
}

bool wh_tel_read(wh_tel *tel) {
    if (tel->capture.state != WH_CAPTURE_FULL) {
        return false;
    }
    tel->reads = true;
    tel->read_at = 0;
    tel->read_ticks = tel->capture.first_ticks;
    return true;
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
    if (wh_capture_runs(&tel->capture)) {
        capture_step(&s);
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
