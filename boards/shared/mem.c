/* mem.c: the functions that a compiler calls on its own to copy, clear and compare structures. */
#include <stddef.h>
#include <stdint.h>

/* Without this option gcc turns the loops below into calls of the functions themselves. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-loop-distribute-patterns")
#endif

void *memcpy(void *restrict to, const void *restrict from, size_t bytes);
void *memmove(void *to, const void *from, size_t bytes);
void *memset(void *to, int value, size_t bytes);
int memcmp(const void *left, const void *right, size_t bytes);

/* Copying by words takes a quarter of the instructions of copying by bytes; structures are word-aligned. */
typedef uint32_t __attribute__((may_alias)) word;

static int word_aligned(const void *pointer) { return ((uintptr_t)pointer & 3U) == 0; }

void *memcpy(void *restrict to, const void *restrict from, size_t bytes) {
    unsigned char *out = to;
    const unsigned char *in = from;
    if (word_aligned(out) && word_aligned(in)) {
        for (; bytes >= 4; bytes -= 4) {
            *(word *)(void *)out = *(const word *)(const void *)in;
            out += 4;
            in += 4;
        }
    }
    while (bytes-- > 0) {
        *out++ = *in++;
    }
    return to;
}

void *memmove(void *to, const void *from, size_t bytes) {
    unsigned char *out = to;
    const unsigned char *in = from;
    if ((uintptr_t)out <= (uintptr_t)in) {
        for (size_t i = 0; i < bytes; i++) {
            out[i] = in[i];
        }
    } else {
        while (bytes-- > 0) {
            out[bytes] = in[bytes];
        }
    }
    return to;
}

void *memset(void *to, int value, size_t bytes) {
    unsigned char *out = to;
    const unsigned char byte = (unsigned char)value;
    if (word_aligned(out)) {
        const uint32_t four = byte * UINT32_C(0x01010101);
        for (; bytes >= 4; bytes -= 4) {
            *(word *)(void *)out = four;
            out += 4;
        }
    }
    while (bytes-- > 0) {
        *out++ = byte;
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
