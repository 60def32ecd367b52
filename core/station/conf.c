/* conf.c: the rig's settings as named numbers. */
#include "conf.h"

#include <stddef.h>

#include "answer.h"
#include "core/frame.h"
#include "core/number/flash.h"
#include "core/root.h"
#include "line.h"

#define UNIT(unit, word, number) WH_R(number),
static const wh_real per_unit[] = {WH_CONF_SCALED_ROWS(UNIT)};
#undef UNIT
#define DEG per_unit[WH_CONF_DEG]

#define ROW(name, number, kind, unit, least, most, goes, member, words) \
    {WH_R(least),    WH_R(most),    offsetof(wh_rig_config, member), number, kind, \
     WH_CONF_##unit, WH_CONF_##goes},
static const wh_conf_row rows[] WH_FLASH = {WH_CONF_ROWS(ROW)};
#undef ROW

/* The damping must be at least this multiple of stall torque / no-load speed. 0.9 allows for a measurement error. */
#define LINE_PART WH_R(0.9)

#define ENTRY_BYTES 5U /* number, float value */
_Static_assert(WH_CONF_COUNT *ENTRY_BYTES <= WH_STORE_PAYLOAD_MOST, "all settings fit into a slot");

static inline wh_conf_row row_of(unsigned id) {
    wh_conf_row row;
    wh_flash_copy(&row, &rows[id], sizeof row);
    return row;
}

wh_conf_row wh_conf_row_of(wh_conf_id id) { return row_of(id); }

#define NAME(name, ...) "|" #name
static const char *names(void) { return WH_CONF_ROWS(NAME); }
#undef NAME

wh_conf_id wh_conf_find(const char *name) { return (wh_conf_id)wh_list_find(names(), name); }
const char *wh_conf_name(wh_conf_id id) { return wh_list_item(names(), id); }

static const char *words_of(wh_conf_id id) {
#define WORDS(name, number, kind, unit, least, most, goes, member, words) words "\0"
    static const char words[] WH_WORD_LIST = WH_CONF_ROWS(WORDS);
#undef WORDS
    return wh_words_item(words, id);
}

/* Returns the setting's allowed words as a list (answer.h). For a number, the list is `real` or `whole`. */
static const char *choices(wh_conf_id id) {
#define WORDS(kind, words) words "\0"
    static const char words[] WH_WORD_LIST = WH_CONF_KIND_ROWS(WORDS);
#undef WORDS
    return wh_words_item(words, row_of(id).kind);
}

static bool is_on(wh_real value) { return value > WH_R(0.5); }

/* Returns the factor from the configuration's unit to the row's unit, such as 1000 from newtons to millinewtons. */
static wh_real units(const wh_conf_row *row) {
    return row->unit < sizeof per_unit / sizeof per_unit[0] ? per_unit[row->unit] : WH_R(1.0);
}

static wh_real value_of(const wh_rig_config *c, wh_conf_id id) {
    const wh_conf_row row = row_of(id);
    const void *member = (const uint8_t *)c + row.place;
    switch ((wh_conf_kind)row.kind) {
    case WH_CONF_WHOLE: return (wh_real) * (const uint32_t *)member;
    case WH_CONF_SWITCH: return (wh_real) * (const uint8_t *)member;
    case WH_CONF_WHEN: return (wh_real) * (const wh_compensation_when *)member;
    case WH_CONF_REAL:
    case WH_CONF_KINDS: break;
    }
    return *(const wh_real *)member * units(&row);
}

static void put(wh_rig_config *c, wh_conf_id id, wh_real value) {
    const wh_conf_row row = row_of(id);
    void *member = (uint8_t *)c + row.place;
    switch ((wh_conf_kind)row.kind) {
    case WH_CONF_WHOLE: *(uint32_t *)member = (uint32_t)value; break;
    case WH_CONF_SWITCH: *(uint8_t *)member = (uint8_t)(uint32_t)value; break;
    case WH_CONF_WHEN:
        *(wh_compensation_when *)member = (wh_compensation_when)(uint32_t)value;
        break;
    case WH_CONF_REAL: *(wh_real *)member = value / units(&row); break;
    case WH_CONF_KINDS: break;
    }
}

/* Returns the value as permanent memory stores it. */
static wh_real as_kept(wh_real value) { return (wh_real)(float)value; }

/* True if this build lacks the feature that the value selects. */
static bool is_absent(wh_conf_id id, wh_real value) {
    return is_on(value) && ((id == WH_CONF_compensation && !WH_RIG_COMPENSATES) ||
                            (id == WH_CONF_swings && !WH_RIG_SWINGS));
}

/* Returns the reason for refusing the value, or WH_STATION_FINE. */
static wh_station_error fits(wh_conf_id id, wh_real value) {
    const wh_conf_row row = row_of(id);
    const wh_real kept = as_kept(value);
    if (!(kept >= as_kept(row.least)) || !(kept <= as_kept(row.most)) ||
        ((wh_conf_kind)row.kind != WH_CONF_REAL && value != (wh_real)(int32_t)value)) {
        return WH_STATION_CONF_RANGE;
    }
    return is_absent(id, value) ? WH_STATION_NOT_HERE : WH_STATION_FINE;
}

/* Scales the members that depend on the unbalance, on gravity and on the inertia (docs/dev/rig.md). */
static void put_rotor(const wh_conf *conf, wh_rig_config *c) {
    const wh_real moment = conf->value[WH_CONF_mass_moment];
    const wh_real moments = moment / conf->standard[WH_CONF_mass_moment];
    const wh_real weights = moments * (conf->value[WH_CONF_gravity] / WH_RIG_GRAVITY_MPS2);
    const wh_real inertias = conf->value[WH_CONF_inertia] / conf->standard[WH_CONF_inertia];
    c->compensation.weight_Nm = moment * conf->value[WH_CONF_gravity];
    c->compensation.gravity_rad = c->measure.rotor.gravity_rad;
    c->guard.load_still_kgm *=
        moments * conf->value[WH_CONF_mount_factor] / conf->standard[WH_CONF_mount_factor];
    c->guard.fall_radps *= WH_SQRT(weights / inertias);
    c->guard.braked_radps /= inertias;
}

static void put_sensors(const wh_conf *conf, wh_rig_config *c) {
    const wh_real lead_deg = conf->value[WH_CONF_slot_lead];
    wh_rig_slots(c, lead_deg / DEG);
    c->measure.rotor.pulse_rad[0] = (conf->value[WH_CONF_sensor1] - lead_deg) / DEG;
    c->measure.rotor.pulse_rad[1] = (conf->value[WH_CONF_sensor2] - lead_deg) / DEG;
    c->observer.pulse_rad[0] = c->measure.rotor.pulse_rad[0];
    c->observer.pulse_rad[1] = c->measure.rotor.pulse_rad[1];
}

/* settings whose defaults are computed from the motor's data */
static const uint8_t of_motor[] = {WH_CONF_damping, WH_CONF_gain,         WH_CONF_gain_integral,
                                   WH_CONF_spin_up, WH_CONF_supply_least, WH_CONF_supply_most};

static void begin_with_motor(wh_conf *conf) {
    wh_rig_config *c = conf->config;
    conf->own(c);
    if (conf->given[WH_CONF_no_load_speed] || conf->given[WH_CONF_rated_voltage] ||
        conf->given[WH_CONF_stall_torque]) {
        wh_rig_motor motor;
        wh_rig_motor_of(c, &motor);
        if (conf->given[WH_CONF_no_load_speed]) {
            motor.no_load_radps = conf->value[WH_CONF_no_load_speed] / per_unit[WH_CONF_RPM];
        }
        if (conf->given[WH_CONF_rated_voltage]) {
            motor.rated_V = conf->value[WH_CONF_rated_voltage];
        }
        if (conf->given[WH_CONF_stall_torque]) {
            motor.stall_Nm = conf->value[WH_CONF_stall_torque];
        }
        wh_rig_use_motor(c, &motor);
    }
    for (unsigned i = 0; i < sizeof of_motor; i++) {
        const wh_conf_id id = (wh_conf_id)of_motor[i];
        const wh_real standard = as_kept(value_of(c, id));
        if (!conf->given[id]) {
            conf->value[id] = standard;
        }
        conf->standard[id] = standard;
    }
}

/* True if the settings fit the motor. For example, the motor must lift the arms and reach the largest set-point. */
static bool motor_goes(const wh_conf *conf) {
    const wh_real *value = conf->value;
    const wh_rig_config *c = conf->config;
    const wh_real line_Nms = c->compensation.stall_Nm / c->run.no_load_radps;
    for (unsigned i = 0; i < sizeof of_motor; i++) {
        if (fits((wh_conf_id)of_motor[i], value[of_motor[i]]) != WH_STATION_FINE) {
            return false;
        }
    }
    return c->compensation.stall_Nm > value[WH_CONF_mass_moment] * value[WH_CONF_gravity] &&
           wh_run_needs_V(&c->run, value[WH_CONF_speed_most] / per_unit[WH_CONF_RPM]) <=
               c->run.rated_V &&
           value[WH_CONF_spin_up] <= c->run.rated_V &&
           value[WH_CONF_supply_least] < c->run.rated_V &&
           value[WH_CONF_supply_most] > c->run.rated_V &&
           value[WH_CONF_damping] >= LINE_PART * line_Nms;
}

/* Returns a hash of the settings. A change of one setting always changes the hash, because it is a CRC-32. */
static uint32_t hash(const wh_conf *conf) {
    uint32_t crc = 0;
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        uint8_t bytes[ENTRY_BYTES];
        wh_bytes entry = {.to = bytes, .room = sizeof bytes};
        wh_bytes_put(&entry, row_of(id).number, 1);
        wh_bytes_put_float(&entry, (float)conf->value[id]);
        crc = wh_frame_crc(crc, bytes, sizeof bytes);
    }
    return crc;
}

/* Computes *conf->config from the settings. If they contradict each other, returns false, and *config is incomplete. */
static bool renew(wh_conf *conf) {
    wh_rig_config *c = conf->config;
    bool goes[WH_CONF_CELL + 1U] = {false};
    const wh_real *value = conf->value;
    begin_with_motor(conf);
    if (!motor_goes(conf) || !(value[WH_CONF_speed_least] < value[WH_CONF_speed_most]) ||
        !(value[WH_CONF_speed_most] < value[WH_CONF_speed_limit]) ||
        !(value[WH_CONF_supply_least] < value[WH_CONF_supply_most])) {
        return false;
    }
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        if (conf->given[id]) {
            put(c, (wh_conf_id)id, value[id]);
            goes[row_of(id).goes] = true;
        }
    }
    if (goes[WH_CONF_ROTOR]) {
        put_rotor(conf, c);
    }
    if (goes[WH_CONF_SENSORS]) {
        put_sensors(conf, c);
    }
    if (goes[WH_CONF_CELL]) {
        const wh_real scale = value[WH_CONF_cell_scale] / per_unit[WH_CONF_MILLINEWTON];
        c->measure.cell.newton_per_count = is_on(value[WH_CONF_cell_reversed]) ? -scale : scale;
    }
    c->guard.braked_radps *= value[WH_CONF_damping] / conf->standard[WH_CONF_damping];
    if (conf->given[WH_CONF_supply_most]) {
        wh_rig_bound_pulses(c);
    }
    c->settings = hash(conf);
    return true;
}

wh_station_error wh_conf_set(wh_conf *conf, wh_conf_id id, wh_real value) {
    const wh_real before = conf->value[id];
    const bool was_given = conf->given[id];
    const wh_station_error error = fits(id, value);
    if (error != WH_STATION_FINE) {
        return error;
    }
    conf->value[id] = as_kept(value);
    conf->given[id] = true;
    if (!renew(conf)) {
        conf->value[id] = before;
        conf->given[id] = was_given;
        (void)renew(conf);
        return WH_STATION_CONF_AGAINST;
    }
    return WH_STATION_FINE;
}

/* --- settings as words -------------------------------------------------------------------------------------------- */

static bool is_choice(wh_conf_id id) { return row_of(id).kind >= WH_CONF_SWITCH; }

/* Returns a choice's value as a list item, or NULL for a number. */
static const char *text_of(wh_conf_id id, wh_real value) {
    return is_choice(id) ? wh_list_item(choices(id), (unsigned)value) : NULL;
}

wh_station_error wh_conf_type(wh_conf *conf, wh_conf_id id, const char *typed) {
    wh_real value;
    bool known;
    if (is_choice(id)) {
        value = (wh_real)wh_list_find(choices(id), typed);
        known = value <= row_of(id).most;
    } else {
        known = wh_line_number(typed, &value);
    }
    return known ? wh_conf_set(conf, id, value) : WH_STATION_CONF_VALUE;
}

void wh_conf_default(wh_conf *conf) {
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        conf->value[id] = conf->standard[id];
        conf->given[id] = false;
    }
    (void)renew(conf);
}

static void take_all(wh_conf *conf, const uint8_t *payload, unsigned count) {
    wh_bytes bytes = {.from = payload, .room = count};
    while (bytes.room - bytes.at >= ENTRY_BYTES) {
        const unsigned number = (unsigned)wh_bytes_get(&bytes, 1);
        const wh_real value = (wh_real)wh_bytes_get_float(&bytes);
        for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
            if (row_of(id).number == number && fits((wh_conf_id)id, value) == WH_STATION_FINE) {
                conf->value[id] = value;
                conf->given[id] = true;
            }
        }
    }
    if (!renew(conf)) {
        wh_conf_default(conf);
    }
}

void wh_conf_start(wh_conf *conf, void (*own)(wh_rig_config *config), const wh_store_memory *memory,
                   wh_rig_config *config) {
    uint8_t kept[WH_STORE_SLOT_BYTES];
    wh_real *value = conf->standard;
    *conf = (wh_conf){.own = own, .memory = memory, .config = config};
    own(config);
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        value[id] = value_of(config, (wh_conf_id)id);
    }
    /* the inverse of renew() for the sensors and the cell */
    value[WH_CONF_sensor1] += value[WH_CONF_slot_lead];
    value[WH_CONF_sensor2] += value[WH_CONF_slot_lead];
    value[WH_CONF_cell_reversed] = value[WH_CONF_cell_scale] < WH_R(0.0) ? WH_R(1.0) : WH_R(0.0);
    value[WH_CONF_cell_scale] = WH_ABS(value[WH_CONF_cell_scale]);
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        value[id] = as_kept(value[id]);
    }
    wh_conf_default(conf);
    const int count = memory != NULL ? wh_store_load(memory, kept, &conf->sequence) : 0;
    if (count > 0) {
        take_all(conf, kept + WH_STORE_HEAD_BYTES, (unsigned)count);
    }
}

wh_station_error wh_conf_save(wh_conf *conf) {
    uint8_t kept[WH_STORE_SLOT_BYTES];
    wh_bytes bytes = {.to = kept + WH_STORE_HEAD_BYTES, .room = WH_STORE_PAYLOAD_MOST};
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        if (conf->given[id]) {
            wh_bytes_put(&bytes, row_of(id).number, 1);
            wh_bytes_put_float(&bytes, (float)conf->value[id]);
        }
    }
    const uint32_t sequence =
        conf->memory != NULL ? wh_store_save(conf->memory, kept, bytes.at) : 0;
    if (sequence == 0) {
        return WH_STATION_CONF_FAILED;
    }
    conf->sequence = sequence;
    return WH_STATION_FINE;
}

/* === the console's command `conf` ============================================================ */

/* space for " next=" and a number at the end of `conf list` */
#define LIST_TAIL 12U

/* Adds " name=value", with a word for a choice. */
static void add_value(wh_text *answer, const char *name, wh_conf_id id, wh_real number) {
    const char *choice = text_of(id, number);
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
    const wh_conf_row row = row_of(id);
#define WORD(unit, word, number) "|" word
    const wh_value value[] = {{.word = choices(id) + 1},
                              {.word = wh_list_item(WH_CONF_UNIT_ROWS(WORD), row.unit)},
                              {.number = row.least},
                              {.number = row.most}};
#undef WORD
    const wh_value words[] = {{.word = words_of(id)}};
    add_setting(answer, conf, id);
    wh_answer(answer,
              text_of(id, conf->value[id]) == NULL ? " type=@s unit=@w least=@e most=@e"
                                                   : " type=@s",
              value);
    add_value(answer, "default", id, conf->standard[id]);
    wh_answer(answer, ": @s", words);
}

/* The subcommands: X(what, word) */
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
