/* light.h: the record of a board's first light (core/light_fields.h), from a serial line or a terminal's log. */
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
    char text[LIGHT_ROOM]; /* the record, a line feed after each line */
    size_t length;
    char lines[LIGHT_ROOM];          /* a copy, split into words */
    const char *value[LIGHT_FIELDS]; /* values of light_names[] */
    uint32_t crc;
} light;

/* Reads the only record in bytes[count]. Other bytes may precede it. Drops carriage returns. Returns NULL if the record
 * is correct, else an error message, for which *hint is the hint. */
const char *light_read(light *l, const char *bytes, size_t count, const char **hint);

/* Returns the beginning of the last record, or NULL. */
const char *light_begin(const char *bytes, size_t count);
/* Returns the first byte after the first complete record, or NULL. */
const char *light_end(const char *from, const char *end);

bool light_is_none(const char *value);

#endif
