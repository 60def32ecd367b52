/* conf_answer.c: the console's command `conf`. */
#include "conf_answer.h"

#include <stddef.h>

#include "answer.h"

/* Space in an answer for the text that `conf list` adds after the settings. */
#define LIST_TAIL 12U

/* " name=value", a choice's value in words. */
static void add_value(wh_text *answer, const char *name, wh_conf_id id, wh_real number) {
    const char *choice = wh_conf_text(id, number);
    wh_value value[] = {{.word = name}, {.number = number}};
    if (choice != NULL) {
        value[1].word = choice;
    }
    wh_answer(answer, choice != NULL ? " @w=@w" : " @w=@e", value);
}

static void add_setting(wh_text *answer, const wh_conf *conf, wh_conf_id id) {
    add_value(answer, wh_conf_name(id), id, conf->value[id]);
}

static wh_station_error list(const wh_conf *conf, const wh_words *words, wh_text *answer) {
    static const wh_value settings[] = {{.count = WH_CONF_COUNT}};
    wh_real from = WH_R(0.0);
    if (words->count > 3U) {
        return WH_STATION_WORDS;
    }
    if (words->count > 2U && !wh_line_number(words->word[2], &from)) {
        return WH_STATION_CONF_NONE;
    }
    if (!(from >= WH_R(0.0)) || from >= (wh_real)WH_CONF_COUNT) {
        return WH_STATION_CONF_NONE;
    }
    uint32_t id = (uint32_t)from;
    wh_answer(answer, " settings=@c", settings);
    for (; id < WH_CONF_COUNT; id++) {
        const unsigned before = answer->length;
        add_setting(answer, conf, (wh_conf_id)id);
        if (answer->truncated || answer->length + LIST_TAIL > answer->size) {
            const wh_value next[] = {{.count = id}};
            answer->length = before;
            answer->truncated = false;
            wh_answer(answer, " next=@c", next);
            break;
        }
    }
    return WH_STATION_FINE;
}

static void get(const wh_conf *conf, wh_conf_id id, wh_text *answer) {
    wh_conf_row room;
    const wh_conf_row *row = wh_conf_row_of(id, &room);
    const wh_value value[] = {{.word = wh_conf_kind_text(id)},
                              {.word = wh_conf_unit_text(id)},
                              {.number = row->least},
                              {.number = row->most}};
    const wh_value words[] = {{.word = wh_conf_words(id)}};
    add_setting(answer, conf, id);
    wh_answer(answer,
              wh_conf_text(id, conf->value[id]) == NULL ? " type=@s unit=@w least=@e most=@e"
                                                        : " type=@s",
              value);
    add_value(answer, "default", id, conf->standard[id]);
    wh_answer(answer, ": @s", words);
}

/* X(what, word): the words allowed after `conf`. */
#define ASKED_ROWS(X) \
    X(LIST, "list") X(GET, "get") X(SET, "set") X(SAVE, "save") X(DEFAULT, "default")
#define COUNTED(what, word) what,
enum { ASKED_ROWS(COUNTED) NONE };
#undef COUNTED

wh_station_error wh_conf_answer(wh_conf *conf, const wh_words *words, bool idle, wh_text *answer) {
    static const uint8_t wanted[] = {[GET] = 3, [SET] = 4, [SAVE] = 2, [DEFAULT] = 2};
#define LISTED(what, word) "|" word
    const unsigned what = wh_list_find(ASKED_ROWS(LISTED), words->word[1]);
#undef LISTED
    if (what == LIST) {
        return list(conf, words, answer);
    }
    if (what == NONE || words->count != wanted[what]) {
        return WH_STATION_CONF_HOW;
    }
    const wh_conf_id id = wh_conf_find(words->word[2]);
    if (what <= SET && id == WH_CONF_COUNT) {
        return WH_STATION_CONF_NONE;
    }
    if (what == GET) {
        get(conf, id, answer);
        return WH_STATION_FINE;
    }
    if (!idle) {
        return WH_STATION_BUSY;
    }
    wh_station_error error = WH_STATION_FINE;
    if (what == SET) {
        error = wh_conf_type(conf, id, words->word[3]);
        add_setting(answer, conf, id);
    } else if (what == SAVE) {
        error = wh_conf_save(conf);
        const wh_value sequence[] = {{.count = conf->sequence}};
        wh_answer(answer, " sequence=@c", sequence);
    } else {
        wh_conf_default(conf);
    }
    return error;
}
