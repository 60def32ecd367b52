/* conf_answer.c: the console's command `conf`. */
#include "conf_answer.h"

#include <stddef.h>

#include "answer.h"
#include "core/flash.h"

/* Of an answer, for what `conf list` says behind the settings. */
#define LIST_TAIL 12U

static void add_value(wh_text *answer, const char *name, wh_conf_id id, wh_real value) {
    const char *word = wh_conf_text(id, value);
    if (word == NULL) {
        wh_answer_exact(answer, name, value);
        return;
    }
    wh_answer_word(answer, name, "");
    for (char next = wh_word_at(word); next != '\0' && next != '|'; next = wh_word_at(++word)) {
        wh_text_add_char(answer, next);
    }
}

static void add_setting(wh_text *answer, const wh_conf *conf, wh_conf_id id) {
    wh_conf_row room;
    add_value(answer, wh_conf_row_of(id, &room)->name, id, conf->value[id]);
}

static wh_station_error list(const wh_conf *conf, const wh_words *words, wh_text *answer) {
    wh_real from = WH_R(0.0);
    if (words->count > 3U) {
        return WH_STATION_WORDS;
    }
    if (words->count > 2U && (!wh_line_number(words->word[2], &from) || !(from >= WH_R(0.0)) ||
                              !(from < (wh_real)WH_CONF_COUNT))) {
        return WH_STATION_CONF_NONE;
    }
    unsigned id = (unsigned)from;
    wh_text_add(answer, "OK");
    wh_answer_count(answer, "settings", WH_CONF_COUNT);
    for (; id < WH_CONF_COUNT; id++) {
        const unsigned before = answer->length;
        add_setting(answer, conf, (wh_conf_id)id);
        if (answer->truncated || answer->length + LIST_TAIL > answer->size) {
            wh_answer_back(answer, before);
            break;
        }
    }
    if (id < WH_CONF_COUNT) {
        wh_answer_count(answer, "next", id);
    }
    return WH_STATION_FINE;
}

static wh_station_error get(const wh_conf *conf, wh_conf_id id, wh_text *answer) {
    static const char *const kinds[] = {
#define WORD(kind, word) word,
        WH_CONF_KIND_ROWS(WORD)
#undef WORD
    };
    wh_conf_row room;
    const wh_conf_row *row = wh_conf_row_of(id, &room);
    wh_text_add(answer, "OK");
    add_value(answer, row->name, id, conf->value[id]);
    wh_answer_word(answer, "type", kinds[row->kind]);
    if (wh_conf_text(id, conf->value[id]) == NULL) {
        wh_answer_word(answer, "unit", row->unit);
        wh_answer_exact(answer, "least", row->least);
        wh_answer_exact(answer, "most", row->most);
    }
    add_value(answer, "default", id, conf->standard[id]);
    wh_answer_words(answer, row->words);
    return WH_STATION_FINE;
}

static wh_station_error refused(wh_conf_status status) {
    switch (status) {
    case WH_CONF_NONE: return WH_STATION_CONF_NONE;
    case WH_CONF_VALUE: return WH_STATION_CONF_VALUE;
    case WH_CONF_RANGE: return WH_STATION_CONF_RANGE;
    case WH_CONF_AGAINST: return WH_STATION_CONF_AGAINST;
    case WH_CONF_ABSENT: return WH_STATION_NOT_HERE;
    case WH_CONF_FAILED: return WH_STATION_CONF_FAILED;
    case WH_CONF_DONE: break;
    }
    return WH_STATION_FINE;
}

static wh_station_error set(wh_conf *conf, wh_conf_id id, const char *typed, wh_text *answer) {
    const wh_conf_status status = wh_conf_type(conf, id, typed);
    if (status == WH_CONF_DONE) {
        wh_text_add(answer, "OK");
        add_setting(answer, conf, id);
    }
    return refused(status);
}

static wh_station_error save(wh_conf *conf, wh_text *answer) {
    const wh_conf_status status = wh_conf_save(conf);
    if (status == WH_CONF_DONE) {
        wh_text_add(answer, "OK");
        wh_answer_count(answer, "sequence", conf->sequence);
    }
    return refused(status);
}

wh_station_error wh_conf_answer(wh_conf *conf, const wh_words *words, bool idle, wh_text *answer) {
    const char *what = words->count > 1U ? words->word[1] : "";
    if (wh_answer_is(what, "list")) {
        return list(conf, words, answer);
    }
    const bool gets = wh_answer_is(what, "get") && words->count == 3U;
    const bool sets = wh_answer_is(what, "set") && words->count == 4U;
    const bool saves = wh_answer_is(what, "save") && words->count == 2U;
    const bool clears = wh_answer_is(what, "default") && words->count == 2U;
    if (!gets && !sets && !saves && !clears) {
        return WH_STATION_CONF_HOW;
    }
    const wh_conf_id id = gets || sets ? wh_conf_find(words->word[2]) : WH_CONF_COUNT;
    if ((gets || sets) && id == WH_CONF_COUNT) {
        return WH_STATION_CONF_NONE;
    }
    if (gets) {
        return get(conf, id, answer);
    }
    if (!idle) {
        return WH_STATION_BUSY;
    }
    if (sets) {
        return set(conf, id, words->word[3], answer);
    }
    if (saves) {
        return save(conf, answer);
    }
    wh_conf_default(conf);
    wh_text_add(answer, "OK");
    return WH_STATION_FINE;
}
