/* schema.h: what a rig's telemetry holds, as it says of itself (`tel schema`). */
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
    uint32_t period_ticks; /* of what repeats; 0: none */
    schema_field once[SCHEMA_FIELDS];
    int onces;
    schema_field each[SCHEMA_FIELDS];
    int eaches;
} schema_channel;

typedef struct schema {
    schema_channel channel[SCHEMA_CHANNELS];
    char state[SCHEMA_STATES][SCHEMA_NAME]; /* "" where there is none */
    bool states_known;
} schema;

/* An answer of the console: true when it describes a channel, the states or another rate, which are then known. One that
 * does not read leaves all as it was. */
bool schema_take(schema *s, const char *line);

/* The value at bytes[field->size]; false when there is none. */
bool schema_value(const schema_field *field, const uint8_t *bytes, double *value);

/* Bytes of fields[count]. */
unsigned schema_bytes(const schema_field *fields, int count);

#endif
