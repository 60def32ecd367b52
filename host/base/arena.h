/* arena.h: a memory arena: allocation piece by piece, release all at once. */
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stddef.h>

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

#endif
