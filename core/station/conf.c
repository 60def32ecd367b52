/* conf.c: the rig's settings as numbers that have names. */
#include "conf.h"

#include <stddef.h>

#include "answer.h"
#include "brief.h"
#include "core/flash.h"
#include "core/frame.h"
#include "core/root.h"
#include "line.h"

#define UNIT(name, number) UNITS_##name,
enum { WH_CONF_UNIT_ROWS(UNIT) UNITS };
#undef UNIT
#define UNIT(name, number) WH_R(number),
static const wh_real per_unit[UNITS] = {WH_CONF_UNIT_ROWS(UNIT)};
#undef UNIT
#define DEG per_unit[UNITS_DEG]

/* Where words stay in flash, so do these. */
#if defined(WH_WORDS_FROM)
#define ROWS_KEPT WH_FLASH
#else
#define ROWS_KEPT
#endif

#define ROW(name, number, kind, unit, least, most, member, units, words) \
    {#name,  unit, WH_SAY(words), WH_R(least), WH_R(most), offsetof(wh_rig_config, member), \
     number, kind, UNITS_##units},
static const wh_conf_row rows[] ROWS_KEPT = {WH_CONF_ROWS(ROW)};
#undef ROW

#define ENTRY_BYTES 5U /* a setting's number, and its value */
_Static_assert(WH_CONF_COUNT *ENTRY_BYTES <= WH_STORE_PAYLOAD_MOST, "all settings fit into a slot");

#if defined(WH_WORDS_FROM)
static const wh_conf_row *row_in(wh_conf_row *room, unsigned id) {
    wh_flash_copy(room, &rows[id], sizeof *room);
    return room;
}
#define ROW_IN(room, id) row_in(room, id)
#else
#define ROW_IN(room, id) ((void)(room), &rows[id])
#endif
#define ROW(id) ROW_IN(&(wh_conf_row){.name = NULL}, id)

const wh_conf_row *wh_conf_row_of(wh_conf_id id, wh_conf_row *room) { return ROW_IN(room, id); }

wh_conf_id wh_conf_find(const char *name) {
    unsigned id = 0;
    while (id < WH_CONF_COUNT && !wh_answer_is(name, ROW(id)->name)) {
        id++;
    }
    return (wh_conf_id)id;
}

/* --- a configuration's settings ---------------------------------------------------------------------- */

static bool is_on(wh_real value) { return value > WH_R(0.5); }

/* The member that a row names: of the type that goes with its kind. */
static void *member_of(wh_rig_config *c, const wh_conf_row *row) {
    return (uint8_t *)c + row->place;
}

static wh_real value_of(wh_rig_config *c, wh_conf_id id) {
    const wh_conf_row *row = ROW(id);
    const void *member = member_of(c, row);
    if (id == WH_CONF_cell_reversed) {
        return *(const wh_real *)member < WH_R(0.0) ? WH_R(1.0) : WH_R(0.0);
    }
    switch ((wh_conf_kind)row->kind) {
    case WH_CONF_WHOLE: return (wh_real) * (const uint32_t *)member;
    case WH_CONF_SWITCH: return *(const bool *)member ? WH_R(1.0) : WH_R(0.0);
    case WH_CONF_FEEDS: return (wh_real) * (const wh_feed_when *)member;
    case WH_CONF_REAL:
    case WH_CONF_KINDS: break;
    }
    wh_real value = *(const wh_real *)member;
    if (id == WH_CONF_sensor1 || id == WH_CONF_sensor2) {
        value += c->swing.lead_rad;
    }
    if (id == WH_CONF_cell_scale) {
        value = WH_ABS(value);
    }
    return value * per_unit[row->units];
}

/* What comes of several settings is put by put_rotor(), put_sensors() and put_cell(), behind these. */
static void put(wh_rig_config *c, wh_conf_id id, wh_real value) {
    const wh_conf_row *row = ROW(id);
    void *member = member_of(c, row);
    if (id == WH_CONF_cell_reversed) {
        return;
    }
    switch ((wh_conf_kind)row->kind) {
    case WH_CONF_WHOLE: *(uint32_t *)member = (uint32_t)value; break;
    case WH_CONF_SWITCH: *(bool *)member = is_on(value); break;
    case WH_CONF_FEEDS: *(wh_feed_when *)member = (wh_feed_when)(int)value; break;
    case WH_CONF_REAL: *(wh_real *)member = value / per_unit[row->units]; break;
    case WH_CONF_KINDS: break;
    }
}

/* --- into the rig's configuration --------------------------------------------------------------------- */

static bool same(wh_real one, wh_real other) { return one >= other && one <= other; }

static bool is_set(const wh_conf *conf, wh_conf_id id) {
    return !same(conf->value[id], conf->standard[id]);
}

/* What gravity and the masses' force do elsewhere, in proportion: docs/rig.md has the reasons. */
static void put_rotor(const wh_conf *conf, wh_rig_config *c) {
    const wh_real moment = conf->value[WH_CONF_mass_moment];
    const wh_real moments = moment / conf->standard[WH_CONF_mass_moment];
    const wh_real weights = moments * (conf->value[WH_CONF_gravity] / WH_RIG_GRAVITY_MPS2);
    const wh_real inertias = conf->value[WH_CONF_inertia] / conf->standard[WH_CONF_inertia];
    c->feed.weight_Nm = moment * conf->value[WH_CONF_gravity];
    c->feed.gravity_rad = c->measure.rotor.gravity_rad;
    c->guard.load_still_kgm *=
        moments * conf->value[WH_CONF_mount_factor] / conf->standard[WH_CONF_mount_factor];
    c->guard.fall_radps *= WH_SQRT(weights / inertias);
}

static void put_sensors(const wh_conf *conf, wh_rig_config *c) {
    const wh_real lead_deg = conf->value[WH_CONF_slot_lead];
    wh_rig_slots(c, lead_deg / DEG);
    c->measure.rotor.mark_rad[0] = (conf->value[WH_CONF_sensor1] - lead_deg) / DEG;
    c->measure.rotor.mark_rad[1] = (conf->value[WH_CONF_sensor2] - lead_deg) / DEG;
    c->observer.mark_rad[0] = c->measure.rotor.mark_rad[0];
    c->observer.mark_rad[1] = c->measure.rotor.mark_rad[1];
}

static void put_cell(const wh_conf *conf, wh_rig_config *c) {
    const wh_real scale = conf->value[WH_CONF_cell_scale] / per_unit[UNITS_MILLI];
    c->measure.cell.newton_per_count = is_on(conf->value[WH_CONF_cell_reversed]) ? -scale : scale;
}

static void renew(const wh_conf *conf) {
    wh_rig_config *c = conf->config;
    conf->own(c);
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        if (is_set(conf, (wh_conf_id)id)) {
            put(c, (wh_conf_id)id, conf->value[id]);
        }
    }
    if (is_set(conf, WH_CONF_mass_moment) || is_set(conf, WH_CONF_gravity) ||
        is_set(conf, WH_CONF_inertia) || is_set(conf, WH_CONF_mount_factor) ||
        is_set(conf, WH_CONF_gravity_angle)) {
        put_rotor(conf, c);
    }
    if (is_set(conf, WH_CONF_sensor1) || is_set(conf, WH_CONF_sensor2) ||
        is_set(conf, WH_CONF_slot_lead)) {
        put_sensors(conf, c);
    }
    if (is_set(conf, WH_CONF_cell_scale) || is_set(conf, WH_CONF_cell_reversed)) {
        put_cell(conf, c);
    }
}

/* --- what may be set ----------------------------------------------------------------------------------- */

/* As memory and tapes have it. */
static wh_real as_kept(wh_real value) { return (wh_real)(float)value; }

static bool in_range(wh_conf_id id, wh_real value) {
    const wh_conf_row *row = ROW(id);
    const wh_real kept = as_kept(value);
    return kept >= as_kept(row->least) && kept <= as_kept(row->most) &&
           ((wh_conf_kind)row->kind == WH_CONF_REAL || same(value, (wh_real)(int32_t)value));
}

static bool go_together(const wh_conf *conf) {
    const wh_real *value = conf->value;
    return value[WH_CONF_speed_least] < value[WH_CONF_speed_most] &&
           value[WH_CONF_speed_most] < value[WH_CONF_speed_limit] &&
           value[WH_CONF_supply_least] < value[WH_CONF_supply_most];
}

/* What this program is built without. */
static bool is_absent(wh_conf_id id, wh_real value) {
    return is_on(value) &&
           ((id == WH_CONF_feeds && !WH_RIG_FEEDS) || (id == WH_CONF_swings && !WH_RIG_SWINGS));
}

wh_conf_status wh_conf_set(wh_conf *conf, wh_conf_id id, wh_real value) {
    const wh_real kept = as_kept(value);
    if (!in_range(id, value)) {
        return WH_CONF_RANGE;
    }
    if (is_absent(id, value)) {
        return WH_CONF_ABSENT;
    }
    const wh_real before = conf->value[id];
    conf->value[id] = kept;
    if (!go_together(conf)) {
        conf->value[id] = before;
        return WH_CONF_AGAINST;
    }
    renew(conf);
    return WH_CONF_DONE;
}

/* --- words ------------------------------------------------------------------------------------------------ */

static const char *words_of(wh_conf_id id) {
#define WORDS(kind, word) \
    case kind: return word;
    switch ((wh_conf_kind)ROW(id)->kind) { WH_CONF_KIND_ROWS(WORDS) case WH_CONF_KINDS : break; }
#undef WORDS
    return "";
}

static bool is_choice(wh_conf_id id) {
    const wh_conf_kind kind = (wh_conf_kind)ROW(id)->kind;
    return kind != WH_CONF_REAL && kind != WH_CONF_WHOLE;
}

/* Behind the next '|'; NULL when there is none. */
static const char *next_word(const char *at) {
    while (wh_word_at(at) != '\0' && wh_word_at(at) != '|') {
        at++;
    }
    return wh_word_at(at) == '|' ? at + 1 : NULL;
}

const char *wh_conf_text(wh_conf_id id, wh_real value) {
    const char *at = is_choice(id) ? words_of(id) : NULL;
    for (int32_t i = (int32_t)value; at != NULL && i > 0; i--) {
        at = next_word(at);
    }
    return at;
}

static bool begins(const char *word, const char *with) {
    while (*with != '\0' && *with != '|' && *with == wh_word_at(word)) {
        with++;
        word++;
    }
    return *with == '\0' && (wh_word_at(word) == '\0' || wh_word_at(word) == '|');
}

wh_conf_status wh_conf_type(wh_conf *conf, wh_conf_id id, const char *typed) {
    wh_real value = WH_R(0.0);
    if (!is_choice(id)) {
        return wh_line_number(typed, &value) ? wh_conf_set(conf, id, value) : WH_CONF_VALUE;
    }
    const char *word = words_of(id);
    while (word != NULL && !begins(word, typed)) {
        word = next_word(word);
        value += WH_R(1.0);
    }
    return word != NULL && *typed != '\0' ? wh_conf_set(conf, id, value) : WH_CONF_VALUE;
}

/* --- all of them ------------------------------------------------------------------------------------------- */

void wh_conf_default(wh_conf *conf) {
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        conf->value[id] = conf->standard[id];
    }
    renew(conf);
}

static void take(wh_conf *conf, unsigned number, wh_real value) {
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        if (ROW(id)->number == number && in_range((wh_conf_id)id, value) &&
            !is_absent((wh_conf_id)id, value)) {
            conf->value[id] = value;
        }
    }
}

static void take_all(wh_conf *conf, const uint8_t *payload, unsigned count) {
    wh_bytes bytes = {.from = payload, .room = count};
    while (bytes.room - bytes.at >= ENTRY_BYTES) {
        const unsigned number = (unsigned)wh_bytes_get(&bytes, 1);
        take(conf, number, (wh_real)wh_bytes_get_float(&bytes));
    }
    if (go_together(conf)) {
        renew(conf);
    } else {
        wh_conf_default(conf);
    }
}

#if WH_STATION_TAPE
void wh_conf_take(wh_conf *conf, const uint8_t *payload, unsigned count) {
    take_all(conf, payload, count);
}

unsigned wh_conf_is_set(const wh_conf *conf, wh_conf_id id, float *value) {
    *value = (float)conf->value[id];
    return is_set(conf, id) ? rows[id].number : 0U;
}
#endif

void wh_conf_start(wh_conf *conf, void (*own)(wh_rig_config *config), const wh_store_memory *memory,
                   wh_rig_config *config) {
    uint8_t payload[WH_STORE_PAYLOAD_MOST];
    *conf = (wh_conf){.own = own, .memory = memory, .config = config};
    own(config);
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        conf->standard[id] = (wh_real)(float)value_of(config, (wh_conf_id)id);
        conf->value[id] = conf->standard[id];
    }
    const int count =
        memory != NULL ? wh_store_load(memory, payload, sizeof payload, &conf->sequence) : -1;
    if (count <= 0) {
        return;
    }
    take_all(conf, payload, (unsigned)count);
}

wh_conf_status wh_conf_save(wh_conf *conf) {
    uint8_t payload[WH_STORE_PAYLOAD_MOST];
    wh_bytes bytes = {.to = payload, .room = sizeof payload};
    for (unsigned id = 0; id < WH_CONF_COUNT; id++) {
        if (is_set(conf, (wh_conf_id)id)) {
            wh_bytes_put(&bytes, ROW(id)->number, 1);
            wh_bytes_put_float(&bytes, (float)conf->value[id]);
        }
    }
    if (conf->memory == NULL || !wh_store_save(conf->memory, payload, bytes.at)) {
        return WH_CONF_FAILED;
    }
    return wh_store_load(conf->memory, payload, sizeof payload, &conf->sequence) < 0
               ? WH_CONF_FAILED
               : WH_CONF_DONE;
}
