/* room.h: memory from the heap. All of the host's comes through here, so that running out of it ends the program in
 * one way: a message and exit status 1. No caller ever sees NULL; free() gives back what these functions hand out.
 *
 * Counts are of elements, sizes of one element in bytes. A product that no size_t holds, or a count below zero, is
 * memory that there is not.
 */
#ifndef BASE_ROOM_H
#define BASE_ROOM_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* `count` zeroed elements; for none, one that must not be used. */
void *room(int64_t count, size_t size);

/* Room for `count` elements in place of `array` (NULL: none yet), which begins with what `array` held and is freed.
 * What is new in it is not set. */
void *room_more(void *array, int64_t count, size_t size);

/* One structure of `head` bytes with `count` zeroed elements behind it. */
void *room_tail(size_t head, int64_t count, size_t size);

/* A copy of `length` bytes with a zero byte after them. */
char *room_copy(const char *text, size_t length);

/* What printf() would print. */
char *room_words(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A stream into memory. room_text_end() closes it; *text, to be freed, then has its `length` bytes and a zero byte. */
FILE *room_text(char **text, size_t *length);
void room_text_end(FILE *stream);

/* "whirl: out of memory", and the end. */
_Noreturn void room_none(void);

#endif
