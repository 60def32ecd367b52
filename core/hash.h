/* hash.h: a hash of a state's bits (FNV-1a, 64 bits). Words enter low byte first: the hash is the same everywhere. */
#ifndef WH_HASH_H
#define WH_HASH_H

#include "real.h"

#define WH_HASH_START UINT64_C(0xcbf29ce484222325)
#define WH_HASH_PRIME UINT64_C(0x100000001b3)

static inline uint64_t wh_hash_u64(uint64_t hash, uint64_t word) {
    for (unsigned byte = 0; byte < 8; byte++) {
        hash = (hash ^ (word & 0xffU)) * WH_HASH_PRIME;
        word >>= 8;
    }
    return hash;
}

/* The bits of a real; a float's 32 bits are extended by zeros. */
static inline uint64_t wh_real_bits(wh_real value) {
#if WH_DOUBLE
    uint64_t bits;
#else
    uint32_t bits;
#endif
    __builtin_memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The zeros 0.0 and -0.0 give different hashes. NaNs with different bits do so, too. */
static inline uint64_t wh_hash_real(uint64_t hash, wh_real value) {
    return wh_hash_u64(hash, wh_real_bits(value));
}

#endif
