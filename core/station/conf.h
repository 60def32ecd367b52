/* conf.h: the rig's settings as numbers that have names: from one table (conf_rows.h), within their ranges, into the rig's
 * configuration and into memory that keeps them.
 *
 * A setting that nobody has set is what the program's own configuration has, to the bit. Only what is set is stored, with
 * its number: another version of the program takes what it knows and leaves the rest at its own. */
#ifndef WH_STATION_CONF_H
#define WH_STATION_CONF_H

#include "conf_rows.h"
#include "core/rig/rig.h"
#include "store.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_CONF_NAME(name, number, kind, unit, least, most, member, units, words) WH_CONF_##name,
typedef enum wh_conf_id { WH_CONF_ROWS(WH_CONF_NAME) WH_CONF_COUNT } wh_conf_id;
#undef WH_CONF_NAME

#define WH_CONF_NAME(kind, word) kind,
typedef enum wh_conf_kind { WH_CONF_KIND_ROWS(WH_CONF_NAME) WH_CONF_KINDS } wh_conf_kind;
#undef WH_CONF_NAME

typedef struct wh_conf_row {
    const char *name;
    const char *unit;
    const char *words;
    wh_real least;
    wh_real most;
    uint16_t place; /* of the member */
    uint8_t number;
    unsigned char kind : 4; /* a wh_conf_kind */
    unsigned char units : 4;
} wh_conf_row;

/* What became of a value. */
typedef enum wh_conf_status {
    WH_CONF_DONE,
    WH_CONF_NONE,    /* there is no such setting */
    WH_CONF_VALUE,   /* no number, or no word, for it */
    WH_CONF_RANGE,   /* outside its range */
    WH_CONF_AGAINST, /* it goes against another setting */
    WH_CONF_ABSENT,  /* this program has not what it would switch on */
    WH_CONF_FAILED   /* the memory failed */
} wh_conf_status;

typedef struct wh_conf {
    void (*own)(wh_rig_config *config); /* fills in the program's own configuration */
    const wh_store_memory *memory;      /* NULL: nothing is kept */
    wh_rig_config *config;              /* the rig's: renewed with each change */
    wh_real value[WH_CONF_COUNT];
    wh_real standard[WH_CONF_COUNT]; /* where nobody has set it */
    uint32_t sequence;               /* of what was loaded or saved last; 0: nothing was */
} wh_conf;

#define wh_conf_start WH_NAME(wh_conf_start)
#define wh_conf_row_of WH_NAME(wh_conf_row_of)
#define wh_conf_find WH_NAME(wh_conf_find)
#define wh_conf_set WH_NAME(wh_conf_set)
#define wh_conf_type WH_NAME(wh_conf_type)
#define wh_conf_default WH_NAME(wh_conf_default)
#define wh_conf_save WH_NAME(wh_conf_save)
#define wh_conf_text WH_NAME(wh_conf_text)
#define wh_conf_is_set WH_NAME(wh_conf_is_set)
#define wh_conf_take WH_NAME(wh_conf_take)

/* Into *config goes the program's own configuration, with what was saved. What does not fit this program (a number that
 * there is not, a value outside its range, settings that go against each other) is left out. */
void wh_conf_start(wh_conf *conf, void (*own)(wh_rig_config *config), const wh_store_memory *memory,
                   wh_rig_config *config);

/* *room is for it where constants stay in flash (core/flash.h). */
const wh_conf_row *wh_conf_row_of(wh_conf_id id, wh_conf_row *room);

/* WH_CONF_COUNT when there is none of this name. */
wh_conf_id wh_conf_find(const char *name);

/* Set it, in its unit, a choice by its number; or what was typed for it. The configuration follows, unless it is
 * refused. While the rig is idle only. */
wh_conf_status wh_conf_set(wh_conf *conf, wh_conf_id id, wh_real value);
wh_conf_status wh_conf_type(wh_conf *conf, wh_conf_id id, const char *typed);

/* All as if nobody had set any. What is saved stays. */
void wh_conf_default(wh_conf *conf);

/* Into memory. May take as long as the memory does (hal/settings.h). */
wh_conf_status wh_conf_save(wh_conf *conf);

/* Its number, as it is stored, and its value, if somebody has set it; else 0. */
unsigned wh_conf_is_set(const wh_conf *conf, wh_conf_id id, float *value);

/* All that were set elsewhere, of this program, and nothing else: payload[count] as it is stored, numbers and values. What does
 * not fit is left out, as at a start. */
void wh_conf_take(wh_conf *conf, const uint8_t *payload, unsigned count);

/* A choice's word for a value; NULL for a number. The word ends at '|' or at its end. */
const char *wh_conf_text(wh_conf_id id, wh_real value);

#ifdef __cplusplus
}
#endif

#endif
