/* conf.h: the rig's settings as named numbers, listed in conf_rows.h.
 *
 * The program's own configuration gives the defaults. Permanent memory has only the settings that the user has set.
 * A program of another version loads the settings that it knows. All others get that program's defaults. */
#ifndef WH_STATION_CONF_H
#define WH_STATION_CONF_H

#include "answer.h"
#include "conf_rows.h"
#include "core/rig/rig.h"
#include "core/text.h"
#include "line.h"
#include "store.h"

#define WH_CONF_NAME(name, ...) WH_CONF_##name,
typedef enum wh_conf_id { WH_CONF_ROWS(WH_CONF_NAME) WH_CONF_COUNT } wh_conf_id;
typedef enum wh_conf_unit { WH_CONF_UNIT_ROWS(WH_CONF_NAME) WH_CONF_UNITS } wh_conf_unit;
#undef WH_CONF_NAME

#define WH_CONF_NAME(kind, words) kind,
typedef enum wh_conf_kind { WH_CONF_KIND_ROWS(WH_CONF_NAME) WH_CONF_KINDS } wh_conf_kind;
#undef WH_CONF_NAME

/* Groups of settings that together determine a part of the configuration. WH_CONF_ALONE: no group. */
typedef enum wh_conf_goes {
    WH_CONF_ALONE,
    WH_CONF_ROTOR,
    WH_CONF_SENSORS,
    WH_CONF_CELL
} wh_conf_goes;

typedef struct wh_conf_row {
    wh_real least;
    wh_real most;
    uint16_t place; /* offset of the row's member in wh_rig_config */
    uint8_t number;
    unsigned char kind : 2; /* a wh_conf_kind */
    unsigned char unit : 4;
    unsigned char goes : 2;
} wh_conf_row;

typedef struct wh_conf {
    /* Sets *config to the program's own configuration. Its settings must not contradict each other. */
    void (*own)(wh_rig_config *config);
    const wh_store_memory *memory; /* NULL: settings are not saved */
    wh_rig_config *config;         /* the rig's configuration, updated with each change */
    wh_real value[WH_CONF_COUNT];
    wh_real standard[WH_CONF_COUNT]; /* defaults */
    bool given[WH_CONF_COUNT];       /* the user has set a value, which may equal the default */
    /* sequence number of the record that was loaded or saved last; 0: none */
    uint32_t sequence;
} wh_conf;

/* Sets *config to the program's own configuration with the saved settings. Ignores a saved setting whose number is
 * unknown or whose value is outside its range; ignores all if they contradict each other. */
void wh_conf_start(wh_conf *conf, void (*own)(wh_rig_config *config), const wh_store_memory *memory,
                   wh_rig_config *config);

wh_conf_row wh_conf_row_of(wh_conf_id id);

wh_conf_id wh_conf_find(const char *name); /* WH_CONF_COUNT: no such setting */

/* Returns the setting's name as a list item (answer.h). */
const char *wh_conf_name(wh_conf_id id);

/* wh_conf_set() takes a number in the setting's unit, or the index of a choice's value. wh_conf_type() takes text. If
 * they return an error, the configuration does not change. Call them only while the rig is idle. */
wh_station_error wh_conf_set(wh_conf *conf, wh_conf_id id, wh_real value);
wh_station_error wh_conf_type(wh_conf *conf, wh_conf_id id, const char *typed);

/* Resets all settings to their defaults. Permanent memory does not change until wh_conf_save(). */
void wh_conf_default(wh_conf *conf);

/* Saves the settings that the user has set. Returns when the memory has finished (hal/settings.h). */
wh_station_error wh_conf_save(wh_conf *conf);

/* === the console's command `conf` ============================================================ */

/* Executes `conf`, with the subcommand in words->word[1]. Adds to *answer, or returns the error. Settings change only
 * if `idle`. */
wh_station_error wh_conf_answer(wh_conf *conf, const wh_words *words, bool idle, wh_text *answer);

#endif
