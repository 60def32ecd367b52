/* json.h: writing JSON (RFC 8259), value by value: commas, indentation and escapes are made here.
 *
 * Numbers keep all digits of a double; what is no finite number is null, since JSON has no word for it. Text is
 * UTF-8; bytes that are not become U+FFFD. */
#ifndef BASE_JSON_H
#define BASE_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct json {
    FILE *out;
    int depth;
    bool filled; /* the innermost object or array has something in it */
} json;

/* `key` is NULL within an array and for the whole. */
void json_open(json *j, const char *key, char bracket);
void json_close(json *j, char bracket);

void json_text(json *j, const char *key, const char *text);
void json_number(json *j, const char *key, double value);
void json_whole(json *j, const char *key, int64_t value);
void json_count(json *j, const char *key, uint64_t value);
void json_bool(json *j, const char *key, bool value);
void json_null(json *j, const char *key);

#endif
