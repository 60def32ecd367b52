/* hashing.h: hashes inside the host, for tables and comparisons. core/hash.h hashes states and file contents; the
 * constants of FNV-1a are defined only there and here. */
#ifndef BASE_HASHING_H
#define BASE_HASHING_H

#include <stddef.h>
#include <stdint.h>

#include "core/hash.h"

/* FNV-1a, 32 bits, of `length` bytes. The hash of an output's name seeds the output's noise, so another hash would
 * change runs. */
static inline uint32_t hash_text(const char *text, size_t length) {
    uint32_t hash = 2166136261U;
    for (size_t i = 0; i < length; i++) {
        hash = (hash ^ (unsigned char)text[i]) * 16777619U;
    }
    return hash;
}

/* One step of FNV-1a with 64 bits. `word` is itself a hash. */
static inline uint64_t hash_of_hashes(uint64_t hash, uint64_t word) {
    return (hash ^ word) * WH_HASH_PRIME;
}

/* Mixes a word into a hash for tables in memory. It is faster than FNV-1a. The result is never written to a file. */
static inline uint64_t hash_mix(uint64_t hash, uint64_t word) {
    hash ^= word + UINT64_C(0x9e3779b97f4a7c15) + (hash << 6) + (hash >> 2);
    return hash * UINT64_C(0xff51afd7ed558ccd);
}

#endif
