/* tel_answer.c: the console's command `tel`. */
#include "tel_answer.h"

#include <stddef.h>

#include "answer.h"
#include "core/packed_words.h"

/* What a run's frame has of speed and drive, telemetry.c. */
#define RPM_PER_COUNT WH_R(0.02)
#define V_PER_COUNT WH_R(0.001)
#define SCALE_DECIMALS 12U

static uint32_t cell_per_s(const wh_cell_config *cell) {
    return cell->period_ticks > 0 ? WH_RIG_TICKS_PER_S / cell->period_ticks : 0;
}

static void add_channels(wh_text *answer) {
    static const char *const names[] = {
#define NAME(channel, number, name) name,
        WH_TEL_CHANNEL_ROWS(NAME)
#undef NAME
    };
    wh_answer_word(answer, "channels", "");
    for (unsigned i = 0; i < WH_TEL_CHANNELS; i++) {
        wh_text_add(answer, i > 0 ? "," : "");
        wh_text_add(answer, names[i]);
    }
}

static const char *format_word(wh_tel_format format) {
#define WORD(name, word) \
    case name: return word;
    switch (format) { WH_TEL_FORMAT_ROWS(WORD) case WH_TEL_FORMATS : break; }
#undef WORD
    return "";
}

static const char *trigger_word(wh_capture_trigger trigger) {
#define WORD(name, word) \
    case name: return word;
    switch (trigger) { WH_CAPTURE_ROWS(WORD) case WH_CAPTURE_TRIGGERS : break; }
#undef WORD
    return "";
}

#if WH_STATION_TAPE
static const char *tape_word(const wh_tape *tape) {
#define WORD(name, word) \
    case name: return word;
    switch (tape->state) { WH_TAPE_STATE_ROWS(WORD) case WH_TAPE_STATES : break; }
#undef WORD
    return "";
}

static void add_tape(const wh_tape *tape, wh_text *answer) {
    if (tape != NULL) {
        wh_answer_word(answer, "tape", tape_word(tape));
    }
}

static wh_station_error set_tape(wh_tape *tape, const char *word, wh_text *answer) {
    if (tape == NULL) {
        return WH_STATION_NOT_HERE;
    }
    if (wh_answer_is(word, "on")) {
        wh_tape_on(tape);
    } else if (wh_answer_is(word, "off")) {
        wh_tape_off(tape);
    } else {
        return WH_STATION_TEL_HOW;
    }
    wh_text_add(answer, "OK");
    add_tape(tape, answer);
    return WH_STATION_FINE;
}
#endif

static void list(const wh_tel *tel, const wh_tape *tape, const wh_cell_config *cell,
                 wh_text *answer) {
    wh_text_add(answer, "OK");
    wh_answer_count(answer, "rate", tel->every > 0 ? cell_per_s(cell) / tel->every : 0);
    wh_answer_word(answer, "fmt", format_word(tel->format));
    uint32_t dropped = 0;
    for (unsigned i = 0; i < WH_TEL_CHANNELS; i++) {
        dropped += tel->dropped[i];
    }
    wh_answer_count(answer, "dropped", dropped);
    add_channels(answer);
#if WH_STATION_TAPE
    add_tape(tape, answer);
#else
    (void)tape;
#endif
}

static void ring_told(const wh_tel *tel, wh_text *answer) {
    const wh_capture *capture = &tel->capture;
    wh_text_add(answer, "OK");
    wh_answer_word(answer, "trigger", trigger_word(capture->trigger));
    wh_answer_word(answer, "ring",
                   capture->trigger == WH_CAPTURE_OFF ? "off"
                   : capture->full                    ? "full"
                   : capture->triggered               ? "triggered"
                                                      : "waiting");
    wh_answer_count(answer, "steps", capture->count);
    wh_answer_count(answer, "frames", (capture->count + WH_TEL_SAMPLES - 1U) / WH_TEL_SAMPLES);
}

/* --- what a frame holds ---------------------------------------------------------------------------------- */

/* "load[N]:i2:scale:offset" */
static void add_load(const wh_cell_config *cell, wh_text *answer) {
    wh_text_add(answer, "load[N]:i2:");
    wh_text_add_fixed(answer, cell->newton_per_count * (wh_real)(1U << wh_tel_shift(cell)),
                      SCALE_DECIMALS);
    wh_text_add_char(answer, ':');
    wh_text_add_fixed(answer, -cell->offset_N, 6);
}

static void add_scaled(wh_text *answer, const char *name, wh_real scale, unsigned decimals) {
    wh_text_add(answer, name);
    wh_text_add(answer, ":u2:");
    wh_text_add_fixed(answer, scale, decimals);
}

static void schema_run(const wh_tel *tel, const wh_cell_config *cell, wh_text *answer) {
    wh_text_add_words(answer, WH_WORDS("OK channel=0 name=run"));
    wh_answer_count(answer, "period_ticks",
                    cell->period_ticks * (tel->every > 0 ? tel->every : 1U));
    wh_answer_word(answer, "once", "");
    add_scaled(answer, "speed[rpm]", RPM_PER_COUNT, 2);
    add_scaled(answer, ",drive[V]", V_PER_COUNT, 3);
    wh_text_add(answer, ",state:u1:1");
    wh_answer_word(answer, "each", "");
    add_load(cell, answer);
    wh_answer_words(answer, WH_WORDS("i2 -32768, u2 65535: none"));
}

static void schema_ring(const wh_cell_config *cell, wh_text *answer) {
    wh_text_add_words(answer,
                      WH_WORDS("OK channel=2 name=ring period_ticks=0 once= each=ticks:u2:1,"));
    add_load(cell, answer);
    add_scaled(answer, ",drive[V]", V_PER_COUNT, 3);
    wh_text_add_words(answer, WH_WORDS(",flags:u1:1,state:u1:1"));
    wh_answer_words(answer, WH_WORDS("flags 1, 2 pulse, 4 trigger, 8 tripped"));
}

static void schema_states(wh_text *answer) {
    wh_text_add(answer, "OK");
    for (unsigned stage = 0; stage < WH_RIG_STAGE_OF_PHASE + WH_PHASES; stage++) {
        if (stage < WH_LIVES || stage > WH_RIG_STAGE_OF_PHASE) {
            wh_text_add_char(answer, ' ');
            wh_text_add_unsigned(answer, stage);
            wh_text_add_char(answer, '=');
            for (const char *at = wh_rig_stage_text(stage); *at != '\0'; at++) {
                wh_text_add_char(answer, *at == ' ' ? '_' : *at);
            }
        }
    }
}

static wh_station_error schema(const wh_tel *tel, const wh_cell_config *cell, const char *name,
                               wh_text *answer) {
    if (wh_answer_is(name, "run")) {
        schema_run(tel, cell, answer);
    } else if (wh_answer_is(name, "event")) {
        wh_text_add_words(
            answer,
            WH_WORDS("OK channel=1 name=event period_ticks=0 once=what:u1:1,value:u1:1 each="));
        wh_answer_words(answer, WH_WORDS("what 0 pulse of sensor, 1 state, 2 trip"));
    } else if (wh_answer_is(name, "ring")) {
        schema_ring(cell, answer);
#if WH_STATION_TAPE
    } else if (wh_answer_is(name, "tape")) {
        wh_text_add_words(answer, WH_WORDS("OK channel=3 name=tape period_ticks=0 once= each="));
        wh_answer_words(answer, WH_WORDS("control steps, for whirl monitor --tape"));
#endif
    } else if (wh_answer_is(name, "states")) {
        schema_states(answer);
    } else {
        return WH_STATION_TEL_CHANNEL;
    }
    return WH_STATION_FINE;
}

/* --- what it is told --------------------------------------------------------------------------------------- */

static wh_station_error rate(wh_tel *tel, const wh_cell_config *cell, const char *word,
                             wh_text *answer) {
    wh_real wanted = WH_R(0.0);
    const uint32_t most = cell_per_s(cell);
    if (!wh_line_number(word, &wanted) || !(wanted >= WH_R(1.0)) || !(wanted <= (wh_real)most)) {
        return WH_STATION_TEL_RATE;
    }
    const uint32_t per_s = (uint32_t)wanted;
    if ((wh_real)per_s < wanted || most % per_s != 0 ||
        (tel->format != WH_TEL_FRAMES && per_s > WH_TEL_TEXT_PER_S_MOST)) {
        return WH_STATION_TEL_RATE;
    }
    wh_tel_rate(tel, most / per_s);
    wh_text_add(answer, "OK");
    wh_answer_count(answer, "rate", per_s);
    wh_answer_count(answer, "period_ticks", cell->period_ticks * tel->every);
    return WH_STATION_FINE;
}

static wh_station_error set_format(wh_tel *tel, const wh_cell_config *cell, const char *word,
                                   wh_text *answer) {
    unsigned format = 0;
    while (format < WH_TEL_FORMATS && !wh_answer_is(word, format_word((wh_tel_format)format))) {
        format++;
    }
    if (format == WH_TEL_FORMATS) {
        return WH_STATION_TEL_FORMAT;
    }
    if (format != WH_TEL_FRAMES && tel->every > 0 &&
        cell_per_s(cell) / tel->every > WH_TEL_TEXT_PER_S_MOST) {
        return WH_STATION_TEL_RATE;
    }
    tel->format = (wh_tel_format)format;
    wh_tel_rate(tel, tel->every);
    wh_text_add(answer, "OK");
    wh_answer_word(answer, "fmt", word);
    return WH_STATION_FINE;
}

static wh_station_error set_ring(wh_tel *tel, const char *word, wh_text *answer) {
    if (wh_answer_is(word, "read")) {
        if (!wh_tel_read(tel)) {
            return WH_STATION_TEL_RING;
        }
    } else {
        unsigned trigger = 0;
        while (trigger < WH_CAPTURE_TRIGGERS &&
               !wh_answer_is(word, trigger_word((wh_capture_trigger)trigger))) {
            trigger++;
        }
        if (trigger == WH_CAPTURE_TRIGGERS) {
            return WH_STATION_TEL_HOW;
        }
        tel->reads = false;
        wh_capture_start(&tel->capture, (wh_capture_trigger)trigger);
    }
    ring_told(tel, answer);
    return WH_STATION_FINE;
}

static wh_station_error without_word(wh_tel *tel, wh_tape *tape, const wh_cell_config *cell,
                                     const char *what, wh_text *answer) {
    if (wh_answer_is(what, "list")) {
        list(tel, tape, cell, answer);
    } else if (wh_answer_is(what, "off")) {
        wh_tel_rate(tel, 0);
#if WH_STATION_TAPE
        if (tape != NULL) {
            wh_tape_off(tape);
        }
#endif
        wh_text_add(answer, "OK");
    } else if (wh_answer_is(what, "ring")) {
        ring_told(tel, answer);
    } else {
        return WH_STATION_TEL_HOW;
    }
    return WH_STATION_FINE;
}

wh_station_error wh_tel_answer(wh_tel *tel, wh_tape *tape, const wh_cell_config *cell,
                               const wh_words *words, wh_text *answer) {
    const char *what = words->count > 1U ? words->word[1] : "";
    if (words->count < 3U) {
        return without_word(tel, tape, cell, what, answer);
    }
    const char *word = words->word[2];
    if (wh_answer_is(what, "schema")) {
        return schema(tel, cell, word, answer);
    }
    if (wh_answer_is(what, "rate")) {
        return rate(tel, cell, word, answer);
    }
    if (wh_answer_is(what, "fmt")) {
        return set_format(tel, cell, word, answer);
    }
#if WH_STATION_TAPE
    if (wh_answer_is(what, "tape")) {
        return set_tape(tape, word, answer);
    }
#endif
    return wh_answer_is(what, "ring") ? set_ring(tel, word, answer) : WH_STATION_TEL_HOW;
}
