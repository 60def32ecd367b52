/* json_check.h: a strict reader of JSON (RFC 8259), for the output of `whirl describe --json`. */
#ifndef TESTS_HOST_JSON_CHECK_H
#define TESTS_HOST_JSON_CHECK_H

#include <stdbool.h>

/* Is the whole text one JSON value, without repeated keys in an object? `why` [100] receives the error and its
 * place. */
bool json_is_valid(const char *text, char *why);

/* The value at a path such as "reals/0/name" in a valid text, up to 100 bytes: a number as written, a string without
 * quotes. NULL if absent. */
const char *json_value(const char *text, const char *path, char *value);

/* Elements of the array at a path, or -1. */
int json_length(const char *text, const char *path);

#endif
