#include "schema.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/number/decimal.h"

/* The text after " name=" in the line; NULL without it. */
static const char *value_of(const char *line, const char *name) {
    const size_t length = strlen(name);
    for (const char *at = strchr(line, ' '); at != NULL; at = strchr(at + 1, ' ')) {
        if (strncmp(at + 1, name, length) == 0 && at[1 + length] == '=') {
            return at + 2 + length;
        }
    }
    return NULL;
}

static bool read_whole(const char *at, double most, uint32_t *number) {
    const char *end = at;
    const double value = at != NULL ? decimal_read(at, &end) : -1.0;
    if (end == at || !(value >= 0.0 && value <= most)) {
        return false;
    }
    *number = (uint32_t)value;
    return true;
}

/* The characters up to one of `ends`, at most SCHEMA_NAME - 1; NULL if there are none or too many. */
static const char *copy_word(char *to, const char *from, const char *ends) {
    const size_t length = strcspn(from, ends);
    if (length == 0 || length >= SCHEMA_NAME) {
        return NULL;
    }
    memcpy(to, from, length);
    to[length] = '\0';
    return from + length;
}

/* "load[N]" as "load [N]" */
static bool set_name(schema_field *field, const char *word) {
    const char *unit = strchr(word, '[');
    if (unit == NULL || unit == word) {
        snprintf(field->name, sizeof field->name, "%s", word);
        return unit == NULL;
    }
    if (strlen(word) + 2U > SCHEMA_NAME) {
        return false;
    }
    snprintf(field->name, sizeof field->name, "%.*s %s", (int)(unit - word), word, unit);
    return true;
}

/* "name[unit]:i2:scale:offset"; the offset is optional. Returns the following text, or NULL if unreadable. */
static const char *read_field(schema_field *field, const char *at) {
    char word[SCHEMA_NAME];
    *field = (schema_field){.scale = 1.0};
    at = copy_word(word, at, ": ,");
    if (at == NULL || *at != ':' || !set_name(field, word) || (at[1] != 'i' && at[1] != 'u') ||
        (at[2] != '1' && at[2] != '2' && at[2] != '4') || at[3] != ':') {
        return NULL;
    }
    field->is_signed = at[1] == 'i';
    field->size = (unsigned)(at[2] - '0');
    at += 4;
    const char *end;
    field->scale = decimal_read(at, &end);
    if (end == at || !isfinite(field->scale)) {
        return NULL;
    }
    at = end;
    if (*at == ':' && at[1] != ' ' && at[1] != '\0') {
        field->offset = decimal_read(at + 1, &end);
        if (end == at + 1 || !isfinite(field->offset)) {
            return NULL;
        }
        at = end;
    }
    return at;
}

/* Fields between commas, up to a blank, a colon before words, or the end. -1: unreadable. */
static int read_fields(schema_field *fields, const char *at) {
    int count = 0;
    if (at == NULL) {
        return -1;
    }
    while (*at != '\0' && *at != ' ' && *at != ':') {
        if (count == SCHEMA_FIELDS || (at = read_field(&fields[count], at)) == NULL) {
            return -1;
        }
        count++;
        at += *at == ',';
    }
    return count;
}

static bool take_channel(schema *s, const char *line) {
    schema_channel made = {.known = true};
    uint32_t index = 0;
    const char *name = value_of(line, "name");
    if (!read_whole(value_of(line, "channel"), SCHEMA_CHANNELS - 1, &index) ||
        !read_whole(value_of(line, "period_ticks"), 4294967295.0, &made.period_ticks) ||
        name == NULL || copy_word(made.name, name, " :") == NULL) {
        return false;
    }
    made.onces = read_fields(made.once, value_of(line, "once"));
    made.eaches = read_fields(made.each, value_of(line, "each"));
    if (made.onces < 0 || made.eaches < 0) {
        return false;
    }
    s->channel[index] = made;
    return true;
}

/* "OK 0=idle 1=armed ..." */
static bool take_states(schema *s, const char *line) {
    char states[SCHEMA_STATES][SCHEMA_NAME] = {{0}};
    int count = 0;
    for (const char *at = line + 2; *at == ' '; count++) {
        const char *end;
        const double index = decimal_read(at + 1, &end);
        if (end == at + 1 || *end != '=' || !(index >= 0.0 && index < SCHEMA_STATES)) {
            return false;
        }
        at = copy_word(states[(int)index], end + 1, " ");
        if (at == NULL) {
            return false;
        }
    }
    if (count == 0) {
        return false;
    }
    memcpy(s->state, states, sizeof states);
    s->states_known = true;
    return true;
}

/* Another rate changes the period. */
static bool take_rate(schema *s, const char *line) {
    uint32_t period_ticks = 0;
    if (!s->channel[0].known ||
        !read_whole(value_of(line, "period_ticks"), 4294967295.0, &period_ticks)) {
        return false;
    }
    s->channel[0].period_ticks = period_ticks;
    return true;
}

bool schema_take(schema *s, const char *line) {
    if (strncmp(line, "OK channel=", 11) == 0) {
        return take_channel(s, line);
    }
    if (strncmp(line, "OK rate=", 8) == 0) {
        return take_rate(s, line);
    }
    return strncmp(line, "OK 0=", 5) == 0 && take_states(s, line);
}

bool schema_value(const schema_field *field, const uint8_t *bytes, double *value) {
    uint32_t raw = 0;
    for (unsigned i = 0; i < field->size; i++) {
        raw |= (uint32_t)bytes[i] << 8 * i;
    }
    const uint32_t top = field->size > 0 ? 1U << (8U * field->size - 1U) : 0;
    const bool below = field->is_signed && (raw & top) != 0;
    const double number = below ? (double)raw - 2.0 * (double)top : (double)raw;
    const bool none = field->size == 2U && raw == (field->is_signed ? 0x8000U : 0xFFFFU);
    *value = number * field->scale + field->offset;
    return !none;
}

unsigned schema_bytes(const schema_field *fields, int count) {
    unsigned bytes = 0;
    for (int i = 0; i < count; i++) {
        bytes += fields[i].size;
    }
    return bytes;
}
