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
    char text[LIGHT_ROOM];  /* the record as the board wrote it, a line feed after each line */
    size_t length;          /* its length */
    char lines[LIGHT_ROOM]; /* the record split into words */
    const char *value[LIGHT_FIELDS]; /* the value of each field of light_names[] */
    uint32_t crc;
} light;

/* Reads bytes[count]: noise, then one record at the end. Carriage returns come from a terminal and are dropped. Returns NULL if the record is whole; otherwise the error in words, and sets *hint. */
const char *light_read(light *l, const char *bytes, size_t count, const char **hint);

/* light_begin() finds the beginning of the last record, light_end() the first byte after a record's end; both return
 * NULL if it is missing. */
const char *light_begin(const char *bytes, size_t count);
const char *light_end(const char *from, const char *end);

bool light_is_none(const char *value);

#endif
