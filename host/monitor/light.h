/* light.h: the record of a board's first light (core/light_fields.h), as it came over a line or stands in a terminal's log. */
#ifndef MONITOR_LIGHT_H
#define MONITOR_LIGHT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/light_fields.h"
#include "core/version.h"

#define LIGHT_ONE(scene) +1
enum { LIGHT_SCENES = 0 WH_LIGHT_SCENES(LIGHT_ONE), LIGHT_FIELDS = 13 + 3 * LIGHT_SCENES };
#undef LIGHT_ONE
enum { LIGHT_ROOM = 8192 };

extern const char *const light_names[LIGHT_FIELDS];

typedef struct light {
    char text[LIGHT_ROOM];  /* the record as its board meant it, a line feed behind each line */
    size_t length;          /* of it, */
    char lines[LIGHT_ROOM]; /* and again, in words: */
    const char *value[LIGHT_FIELDS]; /* of light_names[] */
    uint32_t crc;
} light;

/* Reads bytes[count]: noise, then one record, and nothing behind it. Carriage returns before a line feed are a terminal's. NULL
 * when the record is whole; else what is wrong with it, in words, and *hint. */
const char *light_read(light *l, const char *bytes, size_t count, const char **hint);

/* Where a record begins last; NULL: nowhere. And behind its end, from there on; NULL: it has none yet. */
const char *light_begin(const char *bytes, size_t count);
const char *light_end(const char *from, const char *end);

bool light_is_none(const char *value);

#endif
