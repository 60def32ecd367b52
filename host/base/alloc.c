#include "host/base/alloc.h"

#include <stdalign.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/exit.h"

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

static _Noreturn void alloc_none(void) {
    fputs("whirl: out of memory\n", stderr);
    exit(EXIT_RUN_FAILED);
}

static void *not_null(void *made) {
    if (made == NULL) {
        alloc_none();
    }
    return made;
}

struct arena *arena_new(void) {
    return alloc(1, sizeof(struct arena));
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

char *arena_words(struct arena *arena, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *words = arena_alloc(arena, (size_t)length + 1);
    va_start(arguments, format);
    vsnprintf(words, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return words;
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

void *arena_push(struct arena *arena, const void *array, int *count, const void *element,
                 size_t element_size) {
    unsigned char *longer = arena_room(arena, (void *)(uintptr_t)array, *count, element_size);
    memcpy(longer + (size_t)(*count)++ * element_size, element, element_size);
    return longer;
}

/* === the heap ================================================================================= */

/* Returns count * size, or, if `count` is 0, the size of one element: realloc() with size 0 may free the array. */
static size_t bytes_of(int64_t count, size_t size) {
    size_t bytes;
    if (count < 0 || __builtin_mul_overflow((size_t)count, size, &bytes)) {
        alloc_none();
    }
    return bytes > 0 ? bytes : size > 0 ? size : 1;
}

void *alloc(int64_t count, size_t size) { return alloc_tail(0, count, size); }

void *alloc_tail(size_t head, int64_t count, size_t size) {
    size_t bytes;
    const bool fits = !__builtin_add_overflow(bytes_of(count, size), head, &bytes);
    return not_null(fits ? calloc(bytes, 1) : NULL);
}

void *alloc_more(void *array, int64_t count, size_t size) {
    return not_null(realloc(array, bytes_of(count, size)));
}

char *alloc_copy(const char *text, size_t length) {
    char *copy = alloc_tail(1, (int64_t)length, 1);
    if (length > 0) {
        memcpy(copy, text, length);
    }
    return copy;
}

char *alloc_trimmed(const char *text, size_t length) {
    static const char blank[] = " \t\r\n";
    const size_t before = strspn(text, blank);
    while (length > before && strchr(blank, text[length - 1]) != NULL) {
        length--;
    }
    return alloc_copy(text + before, length > before ? length - before : 0);
}

char *alloc_entry(const char **list) {
    const char *from = *list;
    if (from == NULL) {
        return NULL;
    }
    const size_t length = strcspn(from, ",");
    *list = from[length] == ',' ? from + length + 1 : NULL;
    return alloc_trimmed(from, length);
}

char *alloc_words(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *words = alloc((int64_t)length + 1, 1);
    va_start(arguments, format);
    vsnprintf(words, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return words;
}

FILE *alloc_text(char **text, size_t *length) {
    static size_t unread;
    return not_null(open_memstream(text, length != NULL ? length : &unread));
}

/* A memory stream fails only when memory runs out. */
void alloc_text_end(FILE *stream) {
    const int failed = ferror(stream);
    if (fclose(stream) != 0 || failed != 0) {
        alloc_none();
    }
}
