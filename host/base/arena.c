#include "arena.h"

#include <stdalign.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "alloc.h"

enum { BLOCK_BYTES = 64 * 1024 };

typedef struct block {
    struct block *before;
    size_t used;
    size_t size;
    alignas(max_align_t) unsigned char bytes[];
} block;

struct arena {
    block *last;
};

struct arena *arena_new(void) {
    struct arena *fresh = alloc(1, sizeof *fresh);
    return fresh;
}

void arena_free(struct arena *arena) {
    if (arena == NULL) {
        return;
    }
    block *each = arena->last;
    while (each != NULL) {
        block *before = each->before;
        free(each);
        each = before;
    }
    free(arena);
}

void *arena_alloc(struct arena *arena, size_t size) {
    const size_t grain = alignof(max_align_t);
    if (size > SIZE_MAX - sizeof(block) - grain) {
        alloc_none();
    }
    size = (size + grain - 1) / grain * grain;
    block *last = arena->last;
    if (last == NULL || last->size - last->used < size) {
        const size_t whole = size > BLOCK_BYTES ? size : BLOCK_BYTES;
        block *fresh = alloc_more(NULL, 1, sizeof *fresh + whole);
        fresh->before = last;
        fresh->used = 0;
        fresh->size = whole;
        arena->last = fresh;
        last = fresh;
    }
    void *piece = last->bytes + last->used;
    last->used += size;
    memset(piece, 0, size);
    return piece;
}

char *arena_copy(struct arena *arena, const char *text, size_t length) {
    char *copy = arena_alloc(arena, length + 1);
    if (length > 0) {
        memcpy(copy, text, length);
    }
    return copy;
}

void *arena_room(struct arena *arena, void *array, int count, size_t element_size) {
    const size_t held = (size_t)count;
    if (held != 0 && (held & (held - 1)) != 0) {
        return array;
    }
    void *longer = arena_alloc(arena, (held == 0 ? 1 : 2 * held) * element_size);
    if (held != 0) {
        memcpy(longer, array, held * element_size);
    }
    return longer;
}
