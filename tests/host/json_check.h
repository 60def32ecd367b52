/* json_check.h: a strict reader of JSON (RFC 8259), which checks the output of `whirl describe --json`. */
#ifndef TESTS_HOST_JSON_CHECK_H
#define TESTS_HOST_JSON_CHECK_H

#include <stdbool.h>

/* Is the whole text one JSON value, in which no object has a key twice? If not, why[100] receives the error and its
 * place. */
bool json_is_valid(const char *text, char *why);

/* Copies the value at a path such as "reals/0/name" to value[100]: a number as written, a string without quotes.
 * `text` must be valid. Returns NULL if there is no such value. */
const char *json_value(const char *text, const char *path, char *value);

/* Number of elements of the array at a path; -1 if there is no such array. */
int json_length(const char *text, const char *path);

#endif
