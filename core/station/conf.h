/* conf.h: the rig's settings as numbers that have names: from one table (conf_rows.h), within their ranges, into the rig's
 * configuration and into memory that keeps them.
 *
 * A setting that nobody has set is what the program's own configuration has, to the bit. Only what is set is stored, with
 * its number: another version of the program takes what it knows and leaves the rest at its own. */
#ifndef WH_STATION_CONF_H
#define WH_STATION_CONF_H

#include "conf_rows.h"
#include "core/rig/rig.h"
#include "errors.h"
#include "store.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_CONF_NAME(name, ...) WH_CONF_##name,
typedef enum wh_conf_id { WH_CONF_ROWS(WH_CONF_NAME) WH_CONF_COUNT } wh_conf_id;
typedef enum wh_conf_unit { WH_CONF_UNIT_ROWS(WH_CONF_NAME) WH_CONF_UNITS } wh_conf_unit;
#undef WH_CONF_NAME

#define WH_CONF_NAME(kind, words) kind,
typedef enum wh_conf_kind { WH_CONF_KIND_ROWS(WH_CONF_NAME) WH_CONF_KINDS } wh_conf_kind;
#undef WH_CONF_NAME

/* With what others it makes something of the configuration. */
typedef enum wh_conf_goes {
    WH_CONF_ALONE,
    WH_CONF_ROTOR,
    WH_CONF_SENSORS,
    WH_CONF_CELL
} wh_conf_goes;

typedef struct wh_conf_row {
    wh_real least;
    wh_real most;
    uint16_t place; /* of the member */
    uint8_t number;
    unsigned char kind : 2; /* a wh_conf_kind */
    unsigned char unit : 4;
    unsigned char goes : 2;
} wh_conf_row;

typedef struct wh_conf {
    /* Fills in the program's own configuration, whose settings go together. */
    void (*own)(wh_rig_config *config);
    const wh_store_memory *memory; /* NULL: nothing is kept */
    wh_rig_config *config;         /* the rig's: renewed with each change */
    wh_real value[WH_CONF_COUNT];
    wh_real standard[WH_CONF_COUNT]; /* of a setting that was not given */
    bool given[WH_CONF_COUNT];       /* set by somebody, even to its default */
    uint32_t sequence;               /* of what was loaded or saved last; 0: nothing was */
} wh_conf;

#define wh_conf_start WH_NAME(wh_conf_start)
#define wh_conf_row_of WH_NAME(wh_conf_row_of)
#define wh_conf_find WH_NAME(wh_conf_find)
#define wh_conf_name WH_NAME(wh_conf_name)
#define wh_conf_kind_text WH_NAME(wh_conf_kind_text)
#define wh_conf_unit_text WH_NAME(wh_conf_unit_text)
#define wh_conf_words WH_NAME(wh_conf_words)
#define wh_conf_set WH_NAME(wh_conf_set)
#define wh_conf_type WH_NAME(wh_conf_type)
#define wh_conf_default WH_NAME(wh_conf_default)
#define wh_conf_save WH_NAME(wh_conf_save)
#define wh_conf_text WH_NAME(wh_conf_text)

/* Into *config goes the program's own configuration, with what was saved. What does not fit this program (a number that
 * there is not, a value outside its range, settings that go against each other) is left out. */
void wh_conf_start(wh_conf *conf, void (*own)(wh_rig_config *config), const wh_store_memory *memory,
                   wh_rig_config *config);

/* *room is for it where constants stay in flash (core/flash.h). */
const wh_conf_row *wh_conf_row_of(wh_conf_id id, wh_conf_row *room);

/* WH_CONF_COUNT when there is none of this name. */
wh_conf_id wh_conf_find(const char *name);

/* Its name, and in words what it takes and its unit: items of lists (answer.h); and its description. */
const char *wh_conf_name(wh_conf_id id);
const char *wh_conf_kind_text(wh_conf_id id);
const char *wh_conf_unit_text(wh_conf_id id);
const char *wh_conf_words(wh_conf_id id);

/* Set it, in its unit, a choice by its number; or what was typed for it. The configuration follows, unless it is
 * refused. While the rig is idle only. */
wh_station_error wh_conf_set(wh_conf *conf, wh_conf_id id, wh_real value);
wh_station_error wh_conf_type(wh_conf *conf, wh_conf_id id, const char *typed);

/* All as if nobody had set any. What is saved stays. */
void wh_conf_default(wh_conf *conf);

/* Into memory. May take as long as the memory does (hal/settings.h). */
wh_station_error wh_conf_save(wh_conf *conf);

/* A choice's word for a value, of a list (answer.h); NULL for a number. */
const char *wh_conf_text(wh_conf_id id, wh_real value);

#ifdef __cplusplus
}
#endif

#endif
