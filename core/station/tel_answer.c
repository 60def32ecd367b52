/* tel_answer.c: the console's command `tel`. */
#include "tel_answer.h"

#include <stddef.h>

#include "answer.h"

/* Speed and drive in a frame of the channel run, telemetry.c. */
#define SPEED "speed[rpm]:u2:0.02"
#define DRIVE ",drive[V]:u2:0.001"
#define SCALE_DECIMALS 12U

#define LISTED(what, word) "|" word
#define CHANNEL(channel, number, name) "," name
#define FORMATS WH_TEL_FORMAT_ROWS(LISTED)
#define TRIGGERS WH_CAPTURE_ROWS(LISTED)
#define STATES WH_CAPTURE_STATE_ROWS(LISTED)
#define CHANNELS WH_TEL_CHANNEL_ROWS(CHANNEL)

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

static void ring_told(const wh_tel *tel, wh_text *answer) {
    const wh_capture *capture = &tel->capture;
    const wh_value value[] = {{.word = wh_list_item(TRIGGERS, capture->trigger)},
                              {.word = wh_list_item(STATES, capture->state)},
                              {.count = capture->count},
                              {.count = (capture->count + WH_TEL_SAMPLES - 1U) / WH_TEL_SAMPLES}};
    wh_answer(answer, " trigger=@w ring=@w steps=@c frames=@c", value);
}

/* --- contents of a frame --------------------------------------------------------------------------------- */

/* "load[N]:i2:scale:offset" */
static void add_load(const wh_cell_config *cell, wh_text *answer) {
    const wh_value offset[] = {{.number = -cell->offset_N}};
    wh_answer(answer, "load[N]:i2:", NULL);
    wh_text_add_fixed(answer, cell->newton_per_count * (wh_real)(1U << wh_tel_shift(cell)),
                      SCALE_DECIMALS);
    wh_answer(answer, ":@6", offset);
}

static void schema_run(const wh_tel *tel, const wh_cell_config *cell, wh_text *answer) {
    const wh_value period[] = {{.count = cell->period_ticks * (tel->every > 0 ? tel->every : 1U)}};
    wh_answer(answer,
              " channel=0 name=run period_ticks=@c once=" SPEED DRIVE ",state:u1:1 each=", period);
    add_load(cell, answer);
    wh_answer(answer, ": i2 -32768, u2 65535: none", NULL);
}

static void schema_ring(const wh_cell_config *cell, wh_text *answer) {
    wh_answer(answer, " channel=2 name=ring period_ticks=0 once= each=ticks:u2:1,", NULL);
    add_load(cell, answer);
    wh_answer(answer, DRIVE ",flags:u1:1,state:u1:1: flags 1, 2 pulse, 4 trigger, 8 tripped", NULL);
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
    case WH_TEL_RUN: schema_run(tel, cell, answer); break;
    case WH_TEL_EVENT:
        wh_answer(answer,
                  " channel=1 name=event period_ticks=0 once=what:u1:1,value:u1:1 each="
                  ": what 0 pulse of sensor, 1 state, 2 trip, 3 end of pulse",
                  NULL);
        break;
    case WH_TEL_RING: schema_ring(cell, answer); break;
    case WH_TEL_CHANNELS: schema_states(answer); break;
    }
    return WH_STATION_FINE;
}

/* --- settings ---------------------------------------------------------------------------------------------- */

/* Text has room for fewer samples a second. */
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
    const uint32_t per_s = (uint32_t)(int32_t)wanted; /* at most nine digits */
    if ((wh_real)(int32_t)wanted != wanted || per_s == 0 || per_s > most || most % per_s != 0 ||
        is_too_fast(tel->format, per_s)) {
        return WH_STATION_TEL_RATE;
    }
    wh_tel_rate(tel, most / per_s);
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
    wh_tel_rate(tel, tel->every);
    wh_answer(answer, " fmt=@w", value);
    return WH_STATION_FINE;
}

/* Another trigger, or `read`. */
static wh_station_error set_ring(wh_tel *tel, const char *word, wh_text *answer) {
    const unsigned what = wh_list_find(TRIGGERS "|"
                                                "read",
                                       word);
    if (what > WH_CAPTURE_TRIGGERS) {
        return WH_STATION_TEL_HOW;
    }
    if (what < WH_CAPTURE_TRIGGERS) {
        tel->reads = false;
        wh_capture_start(&tel->capture, (wh_capture_trigger)what);
    } else if (!wh_tel_read(tel)) {
        return WH_STATION_TEL_RING;
    }
    ring_told(tel, answer);
    return WH_STATION_FINE;
}

/* X(what, word): requests without and with a further word. */
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
    case ALONE_OFF: wh_tel_rate(tel, 0); break;
    case ALONE_RING: ring_told(tel, answer); break;
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
