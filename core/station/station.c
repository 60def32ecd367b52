/* station.c: the rig's console: executes each line and answers it. */
#include "station.h"

#include "answer.h"
#include "conf.h"
#include "selftest.h"
#include "telemetry.h"

#define RPM_PER_RADPS (WH_R(1.0) / WH_RIG_RADPS_PER_RPM)
/* `measure` needs up to 380 characters, with the longest reason for a refused result. */
#define ANSWER_BYTES 400U
#define END_BYTES 2U /* "\r\n" */
#define ESCAPE_KEY '\x1b'
#define HOST_MOST_S WH_R(3600.0)
#define DIALOGUE 1U /* version of the console's protocol */

typedef struct request {
    wh_station *station;
    wh_rig *rig;
    unsigned stage; /* the rig's stage */
    wh_words words;
    wh_text answer; /* initially "OK" */
    char bytes[ANSWER_BYTES];
} request;

/* Sends the answer and clears it. An answer that is too long is cut, but its line still has an end. */
static void send(request *r) {
    wh_text *text = &r->answer;
    text->size += END_BYTES;
    wh_text_add(text, "\r\n");
    if (!wh_ring_put(&r->station->out, text->bytes, text->length)) {
        r->station->lost_answers++;
    }
    text->size -= END_BYTES;
    text->length = 0;
    text->truncated = false;
}

/* Sends the answer if `why` is 0, else the refusal `why` (a wh_refusal or a wh_station_error). */
static void send_answer(request *r, unsigned why) {
    if (why != 0) {
        wh_answer_refused(&r->answer, why);
    }
    if (why == WH_REFUSED_SUPPLY && r->station->seen != NULL) {
        const wh_value value[] = {{.number = r->station->seen->inputs.supply_V}};
        wh_answer(&r->answer, ": supply_V=@2", value);
    }
    send(r);
}

/* Posts an order to the rig, whose answer becomes the console's. Returns 0, or the refusal if the queue is full. */
static unsigned order(request *r, wh_rig_event event, wh_real value) {
    r->station->answers = r->rig->answers;
    r->station->waits = wh_rig_post(r->rig, event, value);
    return r->station->waits ? 0 : WH_REFUSED_QUEUE;
}

static unsigned order_speed(request *r, wh_rig_event event) {
    wh_real speed_rpm;
    if (!wh_line_number(r->words.word[1], &speed_rpm)) {
        return WH_STATION_NO_NUMBER;
    }
    return order(r, event, speed_rpm * WH_RIG_RADPS_PER_RPM);
}

static unsigned do_id(request *r) {
    const wh_value value[] = {
        {.word = r->station->program}, {.word = r->station->board}, {.count = DIALOGUE}};
    wh_answer(&r->answer, " program=@w board=@w dialogue=@c", value);
    return 0;
}

static unsigned do_arm(request *r) { return order(r, WH_EVENT_ARM, WH_R(0.0)); }
static unsigned do_start(request *r) { return order_speed(r, WH_EVENT_START); }
static unsigned do_set(request *r) { return order_speed(r, WH_EVENT_SET); }
static unsigned do_stop(request *r) { return order(r, WH_EVENT_STOP, WH_R(0.0)); }
static unsigned do_clear(request *r) { return order(r, WH_EVENT_CLEAR, WH_R(0.0)); }

/* Returns the time of the last step, or rig->result_ticks if wh_station_see() is not used. */
static uint32_t now_ticks(const request *r) {
    return r->station->seen != NULL ? r->station->seen->inputs.now_ticks : r->rig->result_ticks;
}

/* True if the settings have changed since the result was measured. */
static bool is_outdated(const request *r) {
    return r->station->conf != NULL && r->rig->settings != r->station->conf->config->settings;
}

static const char *verdict(const request *r) {
    return !r->rig->has_result ? "none"
           : is_outdated(r)    ? "outdated"
                               : wh_quality_text(r->rig->result.force.quality);
}

static void add_result_of(request *r) {
    const wh_value of[] = {{.count = wh_rig_result_age_s(r->rig, now_ticks(r))},
                           {.count = r->rig->settings}};
    wh_answer(&r->answer, " age_s=@c settings=@x", of);
}

static unsigned do_status(request *r) {
    const wh_rig *rig = r->rig;
    wh_real speed_radps;
    const bool known = wh_rig_speed(rig, now_ticks(r), &speed_radps);
    const wh_value state[] = {{.word = wh_rig_stage_text(r->stage)},
                              {.number = speed_radps * RPM_PER_RADPS}};
    const wh_value value[] = {{.number = rig->run.phase != WH_PHASE_NONE
                                             ? rig->run.target_radps * RPM_PER_RADPS
                                             : WH_R(0.0)},
                              {.number = rig->command.volts},
                              {.count = (uint32_t)rig->guard.trip},
                              {.word = verdict(r)},
                              {.count = r->station->lost_answers},
                              {.count = r->station->lost_bytes},
                              {.count = r->station->host_losses},
                              {.count = rig->runs},
                              {.word = wh_rig_end_text(rig->ended)}};
    wh_answer(&r->answer, known ? " state=@w speed_rpm=@2" : " state=@w speed_rpm=-", state);
    wh_answer(&r->answer,
              " set_rpm=@2 motor_V=@2 trip=@c result=@w"
              " lost_answers=@c lost_bytes=@c host_losses=@c run=@c ended=@w",
              value);
    if (rig->has_result) {
        add_result_of(r);
    }
    if (!known) {
        wh_answer(&r->answer,
                  wh_run_drives(&rig->run) ? ": no whole turn yet"
                                           : ": no whole turns, and not at rest yet",
                  NULL);
    }
    return 0;
}

static unsigned do_measure(request *r) {
    const wh_measured *force = &r->rig->result.force;
    if (!r->rig->has_result) {
        return WH_STATION_NO_RESULT;
    }
    const wh_value value[] = {{.word = verdict(r)},
                              {.count = force->turns},
                              {.number = force->speed_radps * RPM_PER_RADPS},
                              {.number = force->scatter_radps * RPM_PER_RADPS},
                              {.number = force->amplitude_N},
                              {.number = force->amplitude_half_N},
                              {.number = force->phase_rad * WH_RIG_DEG_PER_RAD},
                              {.number = force->phase_half_rad * WH_RIG_DEG_PER_RAD},
                              {.number = force->expected_N},
                              {.word = force->calibrated ? "entered" : "uncalibrated"},
                              {.count = r->rig->runs}};
    const wh_value words[] = {{.word = wh_quality_text(force->quality)},
                              {.word = wh_why_text(force->why)}};
    wh_answer(&r->answer,
              " result=@w turns=@c speed_rpm=@2 scatter_rpm=@3 force_N=@3 force_half_N=@4"
              " phase_deg=@3 phase_half_deg=@4 expected_N=@3 calibration=@w run=@c",
              value);
    add_result_of(r);
    if (is_outdated(r)) {
        wh_answer(&r->answer, ": @s with other settings: @s", words);
    } else {
        wh_answer(&r->answer, ": @s", &words[1]);
    }
    return 0;
}

static unsigned do_fault(request *r) {
    const wh_trip_record *record = &r->rig->record;
    const wh_trip trip = r->rig->guard.trip;
    const wh_value value[] = {{.count = (uint32_t)trip}, {.word = wh_trip_text(trip)}};
    const wh_value ended[] = {{.word = wh_rig_end_text(r->rig->ended)}};
    const wh_value then[] = {{.word = wh_phase_text(record->phase)},
                             {.number = record->speed_radps * RPM_PER_RADPS},
                             {.number = record->volts},
                             {.number = record->supply_V}};
    wh_answer(&r->answer, " trip=@c", &value[0]);
    if (trip != WH_TRIP_NONE && record->trip == trip) {
        wh_answer(&r->answer, " in=@w speed_rpm=@2 motor_V=@2 supply_V=@2", then);
    }
    wh_answer(&r->answer, " ended=@w", ended);
    wh_answer(&r->answer, ": @s", &value[1]);
    return 0;
}

static unsigned do_conf(request *r) {
    wh_station *station = r->station;
    return station->conf != NULL
               ? wh_conf_answer(station->conf, &r->words, r->rig->state == WH_RIG_IDLE, &r->answer)
               : WH_STATION_NOT_HERE;
}

static unsigned do_tel(request *r) {
    wh_station *station = r->station;
    return WH_STATION_TELEMETRY && station->tel != NULL && station->config != NULL
               ? wh_tel_answer(station->tel, &station->config->measure.cell, &r->words, &r->answer)
               : WH_STATION_NOT_HERE;
}

static unsigned do_selftest(request *r) {
    if (r->station->config == NULL) {
        return WH_STATION_NOT_HERE;
    }
    if (r->rig->state != WH_RIG_IDLE) {
        return WH_STATION_BUSY;
    }
    wh_selftest_answer(r->station->config, r->rig, r->station->seen, &r->answer);
    return 0;
}

static unsigned do_host(request *r) {
    wh_real limit_s;
    if (!wh_line_number(r->words.word[1], &limit_s) || !(limit_s <= HOST_MOST_S) ||
        (limit_s < WH_R(1.0) && limit_s != WH_R(0.0))) {
        return WH_STATION_SECONDS;
    }
    r->station->host_steps = (uint32_t)(limit_s * (wh_real)r->station->steps_per_s);
    r->station->host_given = true;
    return 0;
}

static unsigned do_talk(request *r) {
    const unsigned on = wh_list_find(WH_LIST_OFF_ON, r->words.word[1]);
    if (on > 1U) {
        return WH_STATION_ON_OFF;
    }
    r->station->talks = on != 0;
    r->station->stage = r->stage;
    return 0;
}

static unsigned do_help(request *r);

#define COMMAND(name, most, follows, words) COMMAND_##name,
typedef enum command { WH_COMMAND_ROWS(COMMAND) COMMANDS } command;
#undef COMMAND
#define COMMAND(name, most, follows, words) " " #name
static const char *command_names(void) { return WH_COMMAND_ROWS(COMMAND); }
#undef COMMAND

/* Uses a switch because the stack analysis would report a table of function pointers as a recursion. */
static unsigned run(request *r) {
#define COMMAND(name, most, follows, words) 1U + (most),
    static const uint8_t words_most[] = {WH_COMMAND_ROWS(COMMAND)};
#undef COMMAND
    const command asked = (command)wh_list_find(command_names(), r->words.word[0]);
    if (asked < COMMANDS && r->words.count > words_most[asked]) {
        return WH_STATION_WORDS;
    }
#define COMMAND(name, most, follows, words) \
    case COMMAND_##name: return do_##name(r);
    switch (asked) {
        WH_COMMAND_ROWS(COMMAND)
    case COMMANDS: break;
    }
#undef COMMAND
    return WH_STATION_NO_COMMAND;
}

static unsigned do_help(request *r) {
    wh_text *answer = &r->answer;
    const unsigned asked = wh_list_find(command_names(), r->words.word[1]);
    if (r->words.count < 2U) {
        const wh_value names[] = {{.word = command_names()}};
        wh_answer(answer, "@s", names);
        return 0;
    }
    if (asked == COMMANDS) {
        return WH_STATION_NO_COMMAND;
    }
#define COMMAND(name, most, follows, words) follows ": " words "\0"
    static const char words[] WH_WORD_LIST = WH_COMMAND_ROWS(COMMAND);
#undef COMMAND
    const wh_value value[] = {{.word = r->words.word[1]}, {.word = wh_words_item(words, asked)}};
    wh_answer(answer, " @w@s", value);
    return 0;
}

static unsigned typed(const wh_line *line) { return line->ended ? 0 : line->length; }

static wh_line_event next_line(wh_station *station) {
    char byte;
    while (wh_ring_peek(&station->in, &byte, 1) == 1U) {
        wh_ring_drop(&station->in, 1);
        const unsigned before = typed(&station->line);
        const wh_line_event event = wh_line_take(&station->line, byte);
        const bool ends = event == WH_LINE_WHOLE || event == WH_LINE_BAD;
        const unsigned now = typed(&station->line);
        if (station->talks && (ends || now != before)) {
            const char *back = ends ? "\r\n" : "\b \b";
            const char *echo = ends || now < before ? back : &byte;
            (void)wh_ring_put(&station->out, echo, ends ? 2U : now < before ? 3U : 1U);
        }
        if (ends) {
            return event;
        }
    }
    return WH_LINE_NOTHING;
}

static void tell_stage(request *r) {
    const wh_trip trip = r->rig->guard.trip;
    const wh_value value[] = {{.word = wh_rig_stage_text(r->stage)}, {.word = wh_trip_text(trip)}};
    r->station->stage = r->stage;
    wh_answer(&r->answer, trip != WH_TRIP_NONE ? "# @s: @s" : "# @s", value);
    send(r);
}

/* True only in the step in which the host's silence reaches the limit. */
static bool host_is_lost(wh_station *station, wh_rig *rig) {
    const uint32_t host_steps = station->host_given ? station->host_steps
                                : station->config != NULL
                                    ? station->config->host_max_s * station->steps_per_s
                                    : 0;
    if (host_steps == 0 || station->silent_steps > host_steps ||
        (station->silent_steps == host_steps &&
         !wh_rig_post(rig, WH_EVENT_HOST_LOST,
                      WH_R(0.0)))) { /* queue full: retry in the next step */
        return false;
    }
    station->silent_steps++;
    const bool lost = station->silent_steps > host_steps;
    station->host_losses += lost ? 1U : 0U;
    return lost;
}

void wh_station_start(wh_station *station, const char *program, const char *board,
                      uint32_t steps_per_s) {
    *station = (wh_station){.program = program, .board = board, .steps_per_s = steps_per_s};
    station->in = (wh_ring){.size = WH_STATION_IN_BYTES, .bytes = station->in_bytes};
    station->out = (wh_ring){.size = WH_STATION_OUT_BYTES, .bytes = station->out_bytes};
}

void wh_station_see(wh_station *station, const wh_rig_config *config, const wh_rig *rig,
                    const wh_step_inputs *seen) {
    station->seen = seen;
    station->config = config;
    if (WH_STATION_TELEMETRY && station->tel != NULL) {
        wh_tel_step(station->tel, config, rig, seen, &station->out);
    }
}

/* If a byte is lost, its line becomes invalid: otherwise "start 330" could become "start 30". */
static void take_byte(wh_station *station, char byte) {
    static const char spoilt[] = {'\1', '\n'};
    if (byte == ESCAPE_KEY) {
        station->escaped = true;
        station->spoils = false;
        wh_ring_drop(&station->in, wh_ring_waiting(&station->in));
    }
    if (!station->spoils && wh_ring_put(&station->in, &byte, 1)) {
        return;
    }
    station->lost_bytes++;
    const bool ends = byte == '\r' || byte == '\n';
    station->spoils = !(ends && wh_ring_put(&station->in, spoilt, sizeof spoilt));
}

void wh_station_take(wh_station *station, const char *bytes, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        /* A zero byte is noise: it does not end the host's silence. */
        station->silent_steps = bytes[i] != 0 ? 0 : station->silent_steps;
        take_byte(station, bytes[i]);
    }
}

void wh_station_step(wh_station *station, wh_rig *rig) {
    request r;
    unsigned why;
    r.station = station;
    r.rig = rig;
    r.stage = wh_rig_shown_stage(rig);
    wh_text_start(&r.answer, r.bytes, sizeof r.bytes - END_BYTES);
    if (station->talks && station->stage != r.stage) {
        tell_stage(&r);
    }
    if (station->waits && rig->answers != station->answers) {
        const wh_value value[] = {{.word = wh_rig_event_text(rig->asked)}};
        station->waits = false;
        wh_answer(&r.answer, "OK @s", value);
        send_answer(&r, rig->answer);
    }
    if (station->waits || host_is_lost(station, rig)) {
        return;
    }
    wh_text_add(&r.answer, "OK");
    if (station->escaped) {
        station->escaped = false;
        why = order(&r, WH_EVENT_STOP, WH_R(0.0));
    } else {
        const wh_line_event event = next_line(station);
        if (event == WH_LINE_NOTHING) {
            return;
        }
        wh_line_split(&r.words, station->line.text);
        if (event == WH_LINE_WHOLE && r.words.count == 0) {
            return; /* an empty line has no answer */
        }
        why = event == WH_LINE_BAD ? WH_STATION_LINE : run(&r);
    }
    if (!station->waits) {
        send_answer(&r, why);
    }
}
