/* hashing.h: hashes for tables and comparisons. Only this file and core/hash.h have FNV-1a's constants. */
#ifndef BASE_HASHING_H
#define BASE_HASHING_H

#include <stddef.h>
#include <stdint.h>

#include "core/hash.h"

/* FNV-1a with 32 bits. The hash of an output's name seeds its noise, so another hash would change runs. */
static inline uint32_t hash_text(const char *text, size_t length) {
    uint32_t hash = 2166136261U;
    for (size_t i = 0; i < length; i++) {
        hash = (hash ^ (unsigned char)text[i]) * 16777619U;
    }
    return hash;
}

/* One step of FNV-1a with 64 bits, for a `word` that is itself a hash. */
static inline uint64_t hash_of_hashes(uint64_t hash, uint64_t word) {
    return (hash ^ word) * WH_HASH_PRIME;
}

/* Mixes a word into a hash for tables in memory, faster than FNV-1a. The result is never written to a file. */
static inline uint64_t hash_mix(uint64_t hash, uint64_t word) {
    hash ^= word + UINT64_C(0x9e3779b97f4a7c15) + (hash << 6) + (hash >> 2);
    return hash * UINT64_C(0xff51afd7ed558ccd);
}

#endif
