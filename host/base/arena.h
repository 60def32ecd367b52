/* arena.h: memory that is handed out piece by piece and given back all at once. */
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stddef.h>

struct arena;

/* Running out of memory ends the program with a message: no caller ever sees NULL. */
struct arena *arena_new(void);
void arena_free(struct arena *arena); /* NULL is fine */

/* `size` zeroed bytes, aligned for any type. */
void *arena_alloc(struct arena *arena, size_t size);

/* A copy of `length` bytes with a zero byte after them. */
char *arena_copy(struct arena *arena, const char *text, size_t length);

/* Room for one more element behind the `count` that `array` holds: returns `array`, or a copy of it
 * twice as long. The capacity is always the power of two at or above `count`. */
void *arena_room(struct arena *arena, void *array, int count, size_t element_size);

#endif
