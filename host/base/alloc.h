/* alloc.h: heap allocation for the whole host. The caller calls free(). No allocation returns NULL: if memory runs out,
 * if `count` < 0, or if the size exceeds SIZE_MAX bytes, the program ends with a message and exit status 1. */
#ifndef BASE_ALLOC_H
#define BASE_ALLOC_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Returns `count` zeroed elements. If `count` is 0, the pointer must not be dereferenced. */
void *alloc(int64_t count, size_t size);

/* Resizes `array` to `count` elements. New elements are not initialized. If `array` is NULL, it is allocated. */
void *alloc_more(void *array, int64_t count, size_t size);

/* Returns a zeroed structure of `head` bytes, followed by `count` zeroed elements. */
void *alloc_tail(size_t head, int64_t count, size_t size);

/* A copy of `length` bytes with a zero byte after them. */
char *alloc_copy(const char *text, size_t length);
/* As alloc_copy(), without white space at both ends. */
char *alloc_trimmed(const char *text, size_t length);

/* Returns a copy of the text before the first comma of *list, without white space at both ends. *list becomes the text
 * after the comma, or NULL if there is no comma. If *list is NULL, returns NULL. */
char *alloc_entry(const char **list);

/* The text that printf() would print. */
char *alloc_words(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Opens a memory stream. alloc_text_end() closes it, and stores its text in *text (with a zero byte at the end) and the
 * text's length in *length. The caller frees *text. `length` may be NULL. */
FILE *alloc_text(char **text, size_t *length);
void alloc_text_end(FILE *stream);

/* === a memory arena: allocation piece by piece, release all at once =========================== */

struct arena;

struct arena *arena_new(void);
void arena_free(struct arena *arena); /* `arena` may be NULL */

/* `size` zeroed bytes, aligned for any type. */
void *arena_alloc(struct arena *arena, size_t size);

/* arena_copy() and arena_words() are as alloc_copy() and alloc_words(). */
char *arena_copy(struct arena *arena, const char *text, size_t length);
char *arena_words(struct arena *arena, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Returns an array with room for one more element: if `count` is 0 or a power of two, a larger copy of `array`,
 * otherwise `array` itself. This is correct only if the array always grows by one element. */
void *arena_room(struct arena *arena, void *array, int count, size_t element_size);

/* Appends a copy of `element`, and adds one to *count. Returns the array, which may have moved. */
void *arena_push(struct arena *arena, const void *array, int *count, const void *element,
                 size_t element_size);

#endif
