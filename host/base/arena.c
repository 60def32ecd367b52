#include "arena.h"

#include <stdalign.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static void *checked_malloc(size_t size) {
    void *memory = malloc(size);
    if (memory == NULL) {
        fputs("whirl: out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

struct arena *arena_new(void) {
    struct arena *fresh = checked_malloc(sizeof *fresh);
    fresh->last = NULL;
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
    size = (size + grain - 1) / grain * grain;
    block *last = arena->last;
    if (last == NULL || last->size - last->used < size) {
        const size_t room = size > BLOCK_BYTES ? size : BLOCK_BYTES;
        block *fresh = checked_malloc(sizeof *fresh + room);
        fresh->before = last;
        fresh->used = 0;
        fresh->size = room;
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
