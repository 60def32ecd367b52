/* json_check.h: a strict reader of JSON (RFC 8259), for what `whirl describe --json` writes. */
#ifndef TESTS_HOST_JSON_CHECK_H
#define TESTS_HOST_JSON_CHECK_H

#include <stdbool.h>

/* Is the whole text one JSON value, with no key twice in an object? `why` [100] says what is wrong, and where. */
bool json_is_valid(const char *text, char *why);

/* The text of the value at a path such as "reals/0/name" in a valid text, up to 100 bytes of it: a number as it
 * stands, a string without its quotes; NULL when there is none. */
const char *json_value(const char *text, const char *path, char *value);

/* Elements of the array at a path, or -1. */
int json_length(const char *text, const char *path);

#endif
