/* tape_out.c: each control step, as frames. */
#include "tape_out.h"

#if WH_STATION_TAPE

_Static_assert(WH_TAPED_SAMPLES == WH_SEEN_SAMPLES && WH_TAPED_ORDERS == WH_RIG_ORDERS_MOST,
               "all that a step may see");
_Static_assert(1U + WH_TAPED_STEP_BYTES <= WH_TEL_PAYLOAD_MOST, "a frame holds a step");

#define SETTINGS_A_FRAME ((WH_TEL_PAYLOAD_MOST - 1U) / WH_TAPED_SETTING_BYTES)

static void ends(wh_tape *tape, wh_taped_end end) {
    tape->state = WH_TAPE_ENDS;
    tape->end = end;
}

static wh_taped_answer answer_of(const wh_rig *rig) {
    return (wh_taped_answer){.way = (uint8_t)rig->command.way,
                             .volts = wh_taped_bits((float)rig->command.volts),
                             .stage = (uint8_t)wh_rig_stage(rig),
                             .trip = (uint8_t)rig->guard.trip};
}

/* --- steps -------------------------------------------------------------------------------------------------- */

static void see_step(const wh_tape *tape, const wh_rig *rig, const wh_seen *seen,
                     wh_taped_step *step) {
    const wh_rig_inputs *inputs = &seen->inputs;
    *step = (wh_taped_step){.ticks = inputs->now_ticks,
                            .supply = wh_taped_bits((float)inputs->supply_V),
                            .pulsed = seen->pulsed,
                            .sensor = (uint8_t)seen->sensor,
                            .pulse_ticks = seen->pulse_ticks,
                            .samples = seen->samples,
                            .orders = tape->orders,
                            .answer = answer_of(rig)};
    step->pins = (uint8_t)((inputs->stop_pressed ? (unsigned)WH_TAPED_STOP : 0U) |
                           (inputs->clock_is_fallback ? (unsigned)WH_TAPED_FALLBACK : 0U) |
                           (inputs->watchdog_has_cut ? (unsigned)WH_TAPED_CUT : 0U));
    for (unsigned i = 0; i < seen->samples; i++) {
        const wh_seen_sample *sample = &seen->sample[i];
        step->sample[i] = (wh_taped_sample){sample->ticks, sample->raw, (uint8_t)sample->status};
    }
    for (unsigned i = 0; i < tape->orders; i++) {
        step->order[i] = tape->order[i];
    }
}

static bool send(wh_station *station, uint32_t ticks, const uint8_t *payload, unsigned count) {
    return wh_tel_send(station->tel, WH_TEL_TAPE, ticks, payload, count, &station->out);
}

static bool has_room(const wh_station *station, unsigned count) {
    return wh_tel_has_room(&station->out, count);
}

/* What waits. */
static bool flush(wh_station *station) {
    wh_tape *tape = station->tape;
    const bool sent =
        tape->count == 0 || send(station, tape->first_ticks, tape->bytes, tape->count);
    tape->count = 0;
    return sent;
}

static bool add_step(wh_station *station, const wh_taped_step *step) {
    wh_tape *tape = station->tape;
    uint8_t bytes[WH_TAPED_STEP_BYTES];
    wh_bytes coded = {.to = bytes, .room = sizeof bytes};
    wh_taped_put(&tape->before, step, &coded);
    if (tape->count + coded.at > sizeof tape->bytes && !flush(station)) {
        return false;
    }
    if (tape->count == 0) {
        tape->first_ticks = step->ticks;
        tape->bytes[tape->count++] = WH_TAPED_STEPS;
    }
    for (unsigned i = 0; i < coded.at; i++) {
        tape->bytes[tape->count++] = bytes[i];
    }
    return true;
}

/* What waits first. No try of it is counted, for the end is told until it has found room. */
static void tell_end(wh_station *station, uint32_t now_ticks) {
    wh_tape *tape = station->tape;
    const uint8_t bytes[2] = {WH_TAPED_END, (uint8_t)tape->end};
    if (tape->count > 0 && has_room(station, tape->count)) {
        (void)flush(station);
    }
    if (tape->count == 0 && has_room(station, sizeof bytes) &&
        send(station, now_ticks, bytes, sizeof bytes)) {
        tape->state = WH_TAPE_NONE;
    }
}

/* --- the begin ----------------------------------------------------------------------------------------------- */

/* True when all are out. */
static bool settings_are_out(wh_station *station, uint32_t now_ticks) {
    wh_tape *tape = station->tape;
    const wh_conf *conf = station->conf;
    wh_bytes bytes = {.to = tape->bytes, .room = sizeof tape->bytes};
    wh_bytes_put(&bytes, WH_TAPED_SETTINGS, 1);
    for (unsigned in_frame = 0;
         conf != NULL && tape->setting < WH_CONF_COUNT && in_frame < SETTINGS_A_FRAME;
         tape->setting++) {
        float value;
        const unsigned number = wh_conf_is_set(conf, (wh_conf_id)tape->setting, &value);
        if (number > 0) {
            wh_bytes_put(&bytes, number, 1);
            wh_bytes_put_float(&bytes, value);
            in_frame++;
        }
    }
    if (bytes.at == 1U) {
        return true;
    }
    (void)send(station, now_ticks, tape->bytes, bytes.at);
    return false;
}

static void begin(wh_station *station, wh_rig *rig) {
    wh_tape *tape = station->tape;
    const uint32_t now_ticks = station->seen->inputs.now_ticks;
    if (rig->state != WH_LIFE_IDLE || station->waits || !has_room(station, WH_TEL_PAYLOAD_MOST) ||
        !settings_are_out(station, now_ticks)) {
        return;
    }
    const uint32_t runs = rig->runs;
    wh_rig_start(station->config, rig, now_ticks, NULL);
    rig->runs = runs; /* no two of a session have one number */
    tape->before = (wh_taped_before){.ticks = now_ticks, .answer = answer_of(rig)};
    wh_bytes bytes = {.to = tape->bytes, .room = sizeof tape->bytes};
    wh_bytes_put(&bytes, WH_TAPED_BEGIN, 1);
    wh_bytes_put(&bytes, WH_TAPED_VERSION, 1);
    wh_taped_put_answer(&tape->before.answer, &bytes);
    (void)send(station, now_ticks, tape->bytes, bytes.at);
    tape->state = WH_TAPE_RUNS;
}

/* --- a control step ------------------------------------------------------------------------------------------ */

void wh_tape_see(wh_station *station, wh_rig *rig) {
    wh_tape *tape = station->tape;
    wh_taped_step step;
    switch (tape->state) {
    case WH_TAPE_WAITS: begin(station, rig); break;
    case WH_TAPE_RUNS:
        see_step(tape, rig, station->seen, &step);
        if (!add_step(station, &step)) {
            ends(tape, WH_TAPED_LOST);
        }
        break;
    case WH_TAPE_ENDS: tell_end(station, station->seen->inputs.now_ticks); break;
    case WH_TAPE_NONE:
    case WH_TAPE_STATES: break;
    }
}

void wh_tape_orders(wh_station *station, const wh_rig *rig) {
    wh_tape *tape = station->tape;
    tape->orders = rig->orders;
    for (unsigned i = 0; i < rig->orders; i++) {
        tape->order[i] = (wh_taped_order){.event = (uint8_t)rig->order[i].event,
                                          .value = wh_taped_bits((float)rig->order[i].value)};
    }
}

#endif
