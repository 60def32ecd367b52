/* station.c: the rig's console: what each line asks for, and its answer. */
#include "station.h"

#include "answer.h"
#include "brief.h"
#include "conf_answer.h"
#include "selftest.h"
#include "tel_answer.h"

#define RPM_PER_RADPS (WH_R(1.0) / WH_RIG_RADPS_PER_RPM)
#define ANSWER_BYTES 240U
#define ESCAPE_KEY '\x1b'
#define HOST_MOST_S WH_R(3600.0)
#define DIALOGUE 1U /* a program at the other end asks `id` for it */

/* What a command has to work with. */
typedef struct request {
    wh_station *station;
    wh_rig *rig;
    const wh_words *words;
    wh_text *answer;
} request;

/* --- lines out ------------------------------------------------------------------------------------ */

static void send(wh_station *station, wh_text *text) {
    wh_text_add(text, "\r\n");
    if (text->truncated || !wh_ring_put(&station->out, text->bytes, text->length)) {
        station->lost_answers++;
    }
}

static void refuse(const request *r, wh_station_error error) {
    wh_answer_refused(r->answer, (unsigned)error, wh_station_error_text(error));
}

/* --- what it can be asked -------------------------------------------------------------------------- */

/* The answer comes when the rig has one. */
static void order(const request *r, wh_rig_event event, wh_real value) {
    r->station->answers = r->rig->answers;
    if (wh_rig_post(r->rig, event, value)) {
        r->station->waits = true;
    } else {
        wh_answer_refused(r->answer, WH_REFUSED_QUEUE, wh_refusal_text(WH_REFUSED_QUEUE));
    }
}

static void order_speed(const request *r, wh_rig_event event) {
    wh_real speed_rpm = WH_R(0.0);
    if (r->words->count < 2U || !wh_line_number(r->words->word[1], &speed_rpm)) {
        refuse(r, WH_STATION_NO_NUMBER);
        return;
    }
    order(r, event, speed_rpm * WH_RIG_RADPS_PER_RPM);
}

static void do_id(const request *r) {
    wh_text_add(r->answer, "OK");
    wh_answer_word(r->answer, "program", r->station->program);
    wh_answer_word(r->answer, "board", r->station->board);
    wh_answer_count(r->answer, "dialogue", DIALOGUE);
}

static void do_arm(const request *r) { order(r, WH_EVENT_ARM, WH_R(0.0)); }
static void do_start(const request *r) { order_speed(r, WH_EVENT_START); }
static void do_set(const request *r) { order_speed(r, WH_EVENT_SET); }
static void do_stop(const request *r) { order(r, WH_EVENT_STOP, WH_R(0.0)); }
static void do_clear(const request *r) { order(r, WH_EVENT_CLEAR, WH_R(0.0)); }

static void do_status(const request *r) {
    const wh_rig *rig = r->rig;
    const bool runs = rig->run.phase != WH_PHASE_NONE;
    wh_text_add(r->answer, "OK");
    wh_answer_word(r->answer, "state", wh_rig_stage_text(wh_rig_stage(rig)));
    if (rig->pulses.speed.known) {
        wh_answer_number(r->answer, "speed_rpm", rig->pulses.speed.turn_radps * RPM_PER_RADPS, 2);
    } else {
        const bool rests = rig->guard.quiet && !wh_run_drives(&rig->run);
        wh_answer_word(r->answer, "speed_rpm", rests ? "0.00" : "?");
    }
    wh_answer_number(r->answer, "set_rpm", runs ? rig->run.target_radps * RPM_PER_RADPS : WH_R(0.0),
                     2);
    wh_answer_number(r->answer, "motor_V", rig->command.volts, 2);
    wh_answer_count(r->answer, "trip", (uint32_t)rig->guard.trip);
    wh_answer_word(r->answer, "result",
                   rig->has_result ? wh_quality_text(rig->result.force.quality) : "none");
    wh_answer_count(r->answer, "lost_answers", r->station->lost_answers);
    wh_answer_count(r->answer, "lost_bytes", r->station->lost_bytes);
    wh_answer_count(r->answer, "host_losses", r->station->host_losses);
}

static void do_measure(const request *r) {
    const wh_measured *force = &r->rig->result.force;
    if (!r->rig->has_result) {
        refuse(r, WH_STATION_NO_RESULT);
        return;
    }
    wh_text_add(r->answer, "OK");
    wh_answer_word(r->answer, "result", wh_quality_text(force->quality));
    wh_answer_count(r->answer, "turns", force->turns);
    wh_answer_number(r->answer, "speed_rpm", force->speed_radps * RPM_PER_RADPS, 2);
    wh_answer_number(r->answer, "force_N", force->amplitude_N, 3);
    wh_answer_number(r->answer, "force_half_N", force->amplitude_half_N, 4);
    wh_answer_number(r->answer, "phase_deg", force->phase_rad * WH_RIG_DEG_PER_RAD, 3);
    wh_answer_number(r->answer, "phase_half_deg", force->phase_half_rad * WH_RIG_DEG_PER_RAD, 4);
    wh_answer_number(r->answer, "expected_N", force->expected_N, 3);
    wh_answer_words(r->answer, wh_why_text(force->why));
}

static void do_fault(const request *r) {
    const wh_trip_record *record = &r->rig->record;
    const wh_trip trip = r->rig->guard.trip;
    wh_text_add(r->answer, "OK");
    wh_answer_count(r->answer, "trip", (uint32_t)trip);
    if (trip != WH_TRIP_NONE && record->trip == trip) {
        wh_answer_word(r->answer, "in", wh_phase_text(record->phase));
        wh_answer_number(r->answer, "speed_rpm", record->speed_radps * RPM_PER_RADPS, 2);
        wh_answer_number(r->answer, "motor_V", record->volts, 2);
        wh_answer_number(r->answer, "supply_V", record->supply_V, 2);
    }
    wh_answer_words(r->answer, wh_trip_text(trip));
}

#if WH_STATION_TAPE
/* Does a tape hold what this would change? */
static bool is_taped(const request *r) {
    const wh_tape *tape = r->station->tape;
    const char *what = r->words->count > 1U ? r->words->word[1] : "";
    return tape != NULL && wh_tape_holds(tape) &&
           (wh_answer_is(what, "set") || wh_answer_is(what, "default"));
}
#endif

static void do_conf(const request *r) {
    const bool idle = r->rig->state == WH_LIFE_IDLE;
#if WH_STATION_TAPE
    if (is_taped(r)) {
        refuse(r, WH_STATION_TAPED);
        return;
    }
#endif
    const wh_station_error error = r->station->conf != NULL
                                       ? wh_conf_answer(r->station->conf, r->words, idle, r->answer)
                                       : WH_STATION_NOT_HERE;
    if (error != WH_STATION_FINE) {
        refuse(r, error);
    }
}

static void do_tel(const request *r) {
    wh_station *station = r->station;
    const wh_station_error error =
        WH_STATION_TELEMETRY && station->tel != NULL && station->config != NULL
            ? wh_tel_answer(station->tel, station->tape, &station->config->measure.cell, r->words,
                            r->answer)
            : WH_STATION_NOT_HERE;
    if (error != WH_STATION_FINE) {
        refuse(r, error);
    }
}

static void do_selftest(const request *r) {
    if (r->station->config == NULL) {
        refuse(r, WH_STATION_NOT_HERE);
    } else if (r->rig->state != WH_LIFE_IDLE) {
        refuse(r, WH_STATION_BUSY);
    } else {
        wh_selftest_answer(r->station->config, r->rig, &r->station->seen, r->answer);
    }
}

static void do_host(const request *r) {
    wh_real limit_s = WH_R(0.0);
    const bool said = r->words->count > 1U && wh_line_number(r->words->word[1], &limit_s);
    if (!said || !(limit_s <= HOST_MOST_S) || (limit_s < WH_R(1.0) && limit_s != WH_R(0.0))) {
        refuse(r, WH_STATION_SECONDS);
        return;
    }
    r->station->host_steps = (uint32_t)(limit_s * (wh_real)r->station->steps_per_s);
    wh_text_add(r->answer, "OK");
}

static void do_talk(const request *r) {
    const char *word = r->words->count > 1U ? r->words->word[1] : "";
    if (!wh_answer_is(word, "on") && !wh_answer_is(word, "off")) {
        refuse(r, WH_STATION_ON_OFF);
        return;
    }
    r->station->talks = wh_answer_is(word, "on");
    r->station->stage = wh_rig_stage(r->rig);
    wh_text_add(r->answer, "OK");
}

static void do_help(const request *r);

typedef struct command {
    const char *name;
    unsigned words_most;
    const char *follows;
    const char *words;
} command;

#define COMMAND(name, most, follows, words) {#name, most, WH_WORDS(follows), WH_SAY(words)},
static const command commands[] = {WH_COMMAND_ROWS(COMMAND)};
#undef COMMAND
#define COMMAND(name, most, follows, words) COMMAND_##name,
typedef enum command_id { WH_COMMAND_ROWS(COMMAND) COMMANDS } command_id;
#undef COMMAND

/* COMMANDS: there is none of this name. */
static command_id command_of(const char *name) {
    unsigned id = 0;
    while (id < COMMANDS && !wh_answer_is(name, commands[id].name)) {
        id++;
    }
    return (command_id)id;
}

/* By cases, not by pointers: what calls through a pointer itself (settings) would look like recursion to who bounds the
 * stack. */
static void run(const request *r, command_id id) {
#define COMMAND(name, most, follows, words) \
    case COMMAND_##name: do_##name(r); break;
    switch (id) {
        WH_COMMAND_ROWS(COMMAND)
    case COMMANDS: break;
    }
#undef COMMAND
}

static void do_help(const request *r) {
    if (r->words->count < 2U) {
        wh_text_add(r->answer, "OK");
        for (unsigned i = 0; i < COMMANDS; i++) {
            wh_text_add_char(r->answer, ' ');
            wh_text_add(r->answer, commands[i].name);
        }
        return;
    }
    const command_id id = command_of(r->words->word[1]);
    if (id == COMMANDS) {
        refuse(r, WH_STATION_NO_COMMAND);
        return;
    }
    const command *asked = &commands[id];
    wh_text_add(r->answer, "OK ");
    wh_text_add(r->answer, asked->name);
    wh_text_add(r->answer, wh_word_at(asked->follows) != '\0' ? " " : "");
    wh_text_add_words(r->answer, asked->follows);
    wh_answer_words(r->answer, asked->words);
}

/* --- lines in ------------------------------------------------------------------------------------- */

static void obey(const request *r, wh_line_event event) {
    if (event == WH_LINE_BAD) {
        refuse(r, WH_STATION_LINE);
        return;
    }
    if (r->words->count == 0) {
        return; /* nothing was asked */
    }
    const command_id asked = command_of(r->words->word[0]);
    if (asked == COMMANDS) {
        refuse(r, WH_STATION_NO_COMMAND);
    } else if (r->words->count - 1U > commands[asked].words_most) {
        refuse(r, WH_STATION_WORDS);
    } else {
        run(r, asked);
    }
}

static void echo(wh_station *station, char byte, unsigned before) {
    if (byte == '\r' || byte == '\n') {
        (void)wh_ring_put(&station->out, "\r\n", 2);
    } else if (station->line.length < before) {
        (void)wh_ring_put(&station->out, "\b \b", 3);
    } else if (station->line.length > before) {
        (void)wh_ring_put(&station->out, &byte, 1);
    }
}

/* The next line of what came, as far as it has come. */
static wh_line_event next_line(wh_station *station) {
    char byte;
    while (wh_ring_peek(&station->in, &byte, 1) == 1U) {
        wh_ring_drop(&station->in, 1);
        const unsigned before = station->line.ended ? 0 : station->line.length;
        const bool pair = station->line.returned && byte == '\n';
        const wh_line_event event = wh_line_take(&station->line, byte);
        if (station->talks && !pair) {
            echo(station, byte, before);
        }
        if (event == WH_LINE_WHOLE || event == WH_LINE_BAD) {
            return event;
        }
    }
    return WH_LINE_NOTHING;
}

static void answer_order(wh_station *station, const wh_rig *rig) {
    char bytes[ANSWER_BYTES];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    if (rig->answer == WH_ALLOWED) {
        wh_text_add(&text, "OK ");
        wh_text_add(&text, wh_rig_event_text(rig->asked));
    } else {
        wh_answer_refused(&text, (unsigned)rig->answer, wh_refusal_text(rig->answer));
    }
    station->waits = false;
    send(station, &text);
}

static void tell_stage(wh_station *station, const wh_rig *rig) {
    char bytes[ANSWER_BYTES];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    station->stage = wh_rig_stage(rig);
    wh_text_add(&text, "# ");
    wh_text_add(&text, wh_rig_stage_text(station->stage));
    if (rig->guard.trip != WH_TRIP_NONE) {
        wh_text_add(&text, ": ");
        wh_text_add_words(&text, wh_trip_text(rig->guard.trip));
    }
    send(station, &text);
}

/* Whether just now whoever gives the orders has been silent for too long: the rig is told, once. */
static bool host_is_lost(wh_station *station, wh_rig *rig) {
    if (station->host_steps == 0 || station->silent_steps > station->host_steps) {
        return false;
    }
    station->silent_steps++;
    if (station->silent_steps <= station->host_steps) {
        return false;
    }
    if (!wh_rig_post(rig, WH_EVENT_HOST_LOST, WH_R(0.0))) {
        station->silent_steps--; /* no room: in the next step */
        return false;
    }
    station->host_losses++;
    return true;
}

void wh_station_start(wh_station *station, const char *program, const char *board,
                      uint32_t steps_per_s) {
    *station = (wh_station){.program = program, .board = board, .steps_per_s = steps_per_s};
    station->in = (wh_ring){.size = WH_STATION_IN_BYTES, .bytes = station->in_bytes};
    station->out = (wh_ring){.size = WH_STATION_OUT_BYTES, .bytes = station->out_bytes};
}

void wh_station_see(wh_station *station, const wh_rig_config *config, const wh_rig *rig,
                    const wh_seen *seen) {
    station->seen = *seen;
    station->config = config;
    if (WH_STATION_TELEMETRY && station->tel != NULL) {
        wh_tel_step(station->tel, config, rig, seen, &station->out, WH_STATION_KEPT_BYTES);
    }
}

/* "start 330" that lost a byte may be "start 30": a line without all of its bytes is made one that is refused. */
static void take_byte(wh_station *station, char byte) {
    static const char spoilt[] = {'\1', '\n'};
    if (byte == ESCAPE_KEY) {
        station->escaped = true; /* what waits was typed before it */
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
    station->silent_steps = count > 0 ? 0 : station->silent_steps;
    for (unsigned i = 0; i < count; i++) {
        take_byte(station, bytes[i]);
    }
}

void wh_station_step(wh_station *station, wh_rig *rig) {
    if (station->talks && station->stage != wh_rig_stage(rig)) {
        tell_stage(station, rig);
    }
    if (station->waits && rig->answers != station->answers) {
        answer_order(station, rig);
    }
    if (station->waits || host_is_lost(station, rig)) {
        return; /* an order's answer is the next one, as no two are in the queue */
    }
    char bytes[ANSWER_BYTES];
    wh_text text;
    wh_words words = {.count = 0};
    wh_text_start(&text, bytes, sizeof bytes);
    const request r = {station, rig, &words, &text};
    if (station->escaped) {
        station->escaped = false;
        order(&r, WH_EVENT_STOP, WH_R(0.0));
    } else {
        const wh_line_event event = next_line(station);
        if (event == WH_LINE_NOTHING) {
            return;
        }
        words = wh_line_split(station->line.text);
        obey(&r, event);
    }
    if (text.length > 0) {
        send(station, &text);
    }
}
