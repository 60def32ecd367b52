/* alloc.h: heap allocation for the whole host. Out of memory ends the program with a message and exit status 1, so no
 * function returns NULL. free() releases the memory. Counts are of elements, sizes of one element in bytes. A product
 * above SIZE_MAX or a negative count counts as out of memory. */
#ifndef BASE_ALLOC_H
#define BASE_ALLOC_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* `count` zeroed elements; for count 0 a pointer that must not be dereferenced. */
void *alloc(int64_t count, size_t size);

/* Resize `array` to `count` elements and keep its contents; NULL allocates. New elements are uninitialized. */
void *alloc_more(void *array, int64_t count, size_t size);

/* One structure of `head` bytes followed by `count` zeroed elements. */
void *alloc_tail(size_t head, int64_t count, size_t size);

/* A copy of `length` bytes with a zero byte after them. */
char *alloc_copy(const char *text, size_t length);

/* The formatted text, as printf() would print it. */
char *alloc_words(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A stream into memory. alloc_text_end() closes it; *text, to be freed, then has its `length` bytes and a zero byte. */
FILE *alloc_text(char **text, size_t *length);
void alloc_text_end(FILE *stream);

/* === a memory arena: allocation piece by piece, release all at once =========================== */

struct arena;

/* Out of memory, the program ends with a message: no function returns NULL. */
struct arena *arena_new(void);
void arena_free(struct arena *arena); /* NULL is allowed */

/* `size` zeroed bytes, aligned for any type. */
void *arena_alloc(struct arena *arena, size_t size);

/* A copy of `length` bytes with a zero byte after them. */
char *arena_copy(struct arena *arena, const char *text, size_t length);

/* Space for one more element after the first `count` of `array`. Returns `array`, or a copy of twice the size. The
 * capacity is always the smallest power of two that is at least `count`. */
void *arena_room(struct arena *arena, void *array, int count, size_t element_size);

/* The array with a copy of `element` after its last element; *count becomes one more. */
void *arena_push(struct arena *arena, const void *array, int *count, const void *element,
                 size_t element_size);

#endif
