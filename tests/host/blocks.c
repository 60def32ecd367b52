#include "blocks.h"

#include <stdlib.h>

static long blocks;

long blocks_in_use(void) { return blocks; }

#if defined(__has_feature)
#define SANITIZED __has_feature(address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

#if defined(__GLIBC__) && !SANITIZED
bool blocks_are_counted(void) { return true; }

/* NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp,readability-inconsistent-declaration-parameter-name) */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void __libc_free(void *block);

void *malloc(size_t size) {
    void *block = __libc_malloc(size);
    blocks += block != NULL;
    return block;
}

void *calloc(size_t count, size_t size) {
    void *block = __libc_calloc(count, size);
    blocks += block != NULL;
    return block;
}

void *realloc(void *block, size_t size) {
    void *moved = __libc_realloc(block, size);
    blocks += block == NULL && moved != NULL;
    return moved;
}

void free(void *block) {
    blocks -= block != NULL;
    __libc_free(block);
}
/* NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp,readability-inconsistent-declaration-parameter-name) */
#else
bool blocks_are_counted(void) { return false; }
#endif
