/* mem.c: the four functions a compiler may call on its own for copying and clearing structures. */
#include <stddef.h>
#include <stdint.h>

/* Without this gcc recognises the loops below and turns them into calls of themselves. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-loop-distribute-patterns")
#endif

void *memcpy(void *restrict to, const void *restrict from, size_t bytes);
void *memmove(void *to, const void *from, size_t bytes);
void *memset(void *to, int value, size_t bytes);
int memcmp(const void *left, const void *right, size_t bytes);

/* Structures are word-aligned, and copying them by words is four times fewer instructions. */
typedef uint32_t __attribute__((may_alias)) word;

static int word_aligned(const void *pointer) { return ((uintptr_t)pointer & 3U) == 0; }

/* Front to back: what is moved towards the front may overlap. */
static void *copy(void *to, const void *from, size_t bytes) {
    unsigned char *out = to;
    const unsigned char *in = from;
    size_t i = 0;
    if (word_aligned(out) && word_aligned(in)) {
        for (; i < (bytes & ~(size_t)3U); i += 4U) {
            *(word *)(void *)(out + i) = *(const word *)(const void *)(in + i);
        }
    }
    for (; i < bytes; i++) {
        out[i] = in[i];
    }
    return to;
}

void *memcpy(void *restrict to, const void *restrict from, size_t bytes) {
    return copy(to, from, bytes);
}

void *memmove(void *to, const void *from, size_t bytes) {
    unsigned char *out = to;
    const unsigned char *in = from;
    if ((uintptr_t)out <= (uintptr_t)in) {
        return copy(to, from, bytes);
    }
    while (bytes-- > 0) {
        out[bytes] = in[bytes];
    }
    return to;
}

void *memset(void *to, int value, size_t bytes) {
    unsigned char *out = to;
    const unsigned char byte = (unsigned char)value;
    size_t i = 0;
    if (word_aligned(out)) {
        const uint32_t four = byte * UINT32_C(0x01010101);
        for (; i < (bytes & ~(size_t)3U); i += 4U) {
            *(word *)(void *)(out + i) = four;
        }
    }
    for (; i < bytes; i++) {
        out[i] = byte;
    }
    return to;
}

int memcmp(const void *left, const void *right, size_t bytes) {
    const unsigned char *a = left;
    const unsigned char *b = right;
    for (size_t i = 0; i < bytes; i++) {
        if (a[i] != b[i]) {
            return a[i] < b[i] ? -1 : 1;
        }
    }
    return 0;
}
