#include "alloc.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "exit.h"

void alloc_none(void) {
    fputs("whirl: out of memory\n", stderr);
    exit(EXIT_RUN_FAILED);
}

/* Bytes of all elements, at least one. */
static size_t bytes_of(int64_t count, size_t size) {
    size_t bytes;
    if (count < 0 || __builtin_mul_overflow((size_t)count, size, &bytes)) {
        alloc_none();
    }
    return bytes > 0 ? bytes : size > 0 ? size : 1;
}

void *alloc(int64_t count, size_t size) {
    /* calloc() checks the product for overflow */
    void *made = count > 0 && (uint64_t)count <= SIZE_MAX ? calloc((size_t)count, size)
                                                          : calloc(bytes_of(count, size), 1);
    if (made == NULL) {
        alloc_none();
    }
    return made;
}

void *alloc_tail(size_t head, int64_t count, size_t size) {
    size_t bytes;
    if (count < 0 || __builtin_mul_overflow((size_t)count, size, &bytes) ||
        __builtin_add_overflow(bytes, head, &bytes)) {
        alloc_none();
    }
    void *made = calloc(bytes, 1);
    if (made == NULL) {
        alloc_none();
    }
    return made;
}

void *alloc_more(void *array, int64_t count, size_t size) {
    void *made = realloc(array, bytes_of(count, size));
    if (made == NULL) {
        alloc_none();
    }
    return made;
}

char *alloc_copy(const char *text, size_t length) {
    if (length == SIZE_MAX) {
        alloc_none();
    }
    char *copy = malloc(length + 1);
    if (copy == NULL) {
        alloc_none();
    }
    if (length > 0) {
        memcpy(copy, text, length);
    }
    copy[length] = '\0';
    return copy;
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
    FILE *made = open_memstream(text, length);
    if (made == NULL) {
        alloc_none();
    }
    return made;
}

/* A memory stream fails only when memory runs out. */
void alloc_text_end(FILE *stream) {
    const int failed = ferror(stream);
    if (fclose(stream) != 0 || failed != 0) {
        alloc_none();
    }
}
