/* schema.h: the schema of a rig's telemetry, as the rig describes it (`tel schema`). */
#ifndef MONITOR_SCHEMA_H
#define MONITOR_SCHEMA_H

#include <stdbool.h>
#include <stdint.h>

enum { SCHEMA_CHANNELS = 8, SCHEMA_FIELDS = 8, SCHEMA_NAME = 32, SCHEMA_STATES = 32 };

typedef struct schema_field {
    char name[SCHEMA_NAME]; /* with its unit: "load [N]" */
    unsigned size;          /* bytes */
    bool is_signed;
    double scale;
    double offset;
} schema_field;

typedef struct schema_channel {
    bool known;
    char name[SCHEMA_NAME];
    uint32_t period_ticks; /* of periodic frames; 0: no period */
    schema_field once[SCHEMA_FIELDS];
    int onces;
    schema_field each[SCHEMA_FIELDS];
    int eaches;
} schema_channel;

typedef struct schema {
    schema_channel channel[SCHEMA_CHANNELS];
    char state[SCHEMA_STATES][SCHEMA_NAME]; /* "" for an unnamed state */
    bool states_known;
} schema;

/* Take an answer of the console. True if it describes a channel, the states or another rate, which are then known. An
 * unreadable answer changes nothing. */
bool schema_take(schema *s, const char *line);

/* The value at bytes[field->size]; false if it has no value. */
bool schema_value(const schema_field *field, const uint8_t *bytes, double *value);

/* Bytes of fields[count]. */
unsigned schema_bytes(const schema_field *fields, int count);

#endif
