/* json.h: a JSON writer (RFC 8259): commas, indentation and escapes. Numbers keep all digits of a double; a number that
 * is not finite becomes null. Text is UTF-8; invalid bytes become U+FFFD. */
#ifndef BASE_JSON_H
#define BASE_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct json {
    FILE *out;
    int depth;
    bool filled; /* the innermost object or array is not empty */
} json;

/* In an array and at the top level, `key` is NULL. */
void json_open(json *j, const char *key, char bracket);
void json_close(json *j, char bracket);

void json_text(json *j, const char *key, const char *text);
void json_number(json *j, const char *key, double value);
void json_whole(json *j, const char *key, int64_t value);
void json_count(json *j, const char *key, uint64_t value);
void json_bool(json *j, const char *key, bool value);
void json_null(json *j, const char *key);

#endif
