/* thumb_cycles.c: see thumb_cycles.h. Encodings: Armv7-M Architecture Reference Manual (DDI 0403), A5 to A7. */
#include "thumb_cycles.h"

#include <stddef.h>
#include <string.h>

/* Refilling the pipeline takes 1 to 3 cycles on a Cortex-M3 or M4; two of them are assumed. On a Cortex-M0 it takes 2. */
#define REFILL 2U
/* These end early, by their operands, which are not looked at: the middle of 2 to 12, of 3 to 5 and of 4 to 7. */
#define DIVIDE 7U
#define M3_LONG_PRODUCT 4U
#define M3_LONG_SUM 6U
#define DIVIDE_FP 14U
#define FUSED_FP 3U

#define CORE(number) (UINT64_C(1) << ((number)&15U))
#define SINGLE(number) (UINT64_C(1) << (16U + ((number)&31U)))
#define PC 15U
#define SP 13U

thumb_core thumb_core_of(const char *name) {
    return strcmp(name, "m0") == 0   ? THUMB_M0
           : strcmp(name, "m3") == 0 ? THUMB_M3
           : strcmp(name, "m4") == 0 ? THUMB_M4
                                     : THUMB_NONE;
}

bool thumb_is_wide(unsigned first) { return first >> 11 >= 0x1DU; }

static unsigned bits_in(unsigned list) {
    unsigned count = 0;
    for (; list != 0; list &= list - 1U) {
        count++;
    }
    return count;
}

static thumb_timing plain(unsigned cycles) {
    return (thumb_timing){.cycles = cycles, .jumping = REFILL};
}

/* An operation of the core with a result in `to`. */
static thumb_timing computing(unsigned cycles, unsigned to) {
    thumb_timing timing = plain(cycles);
    timing.computes = true;
    timing.writes = CORE(to);
    return timing;
}

/* One register to or from memory; `index` is PC where the address has none. */
static thumb_timing single(thumb_core core, bool load, unsigned what, unsigned base,
                           unsigned index) {
    thumb_timing timing = plain(2U);
    timing.address = (base == PC ? 0U : CORE(base)) | (index == PC ? 0U : CORE(index));
    timing.writes = load ? CORE(what) : 0U;
    if (core != THUMB_M0) {
        timing.loads = load;
        timing.overlaps = load || index != PC;
        timing.cycles = load || index != PC ? 2U : 1U; /* the write buffer takes it */
    }
    return timing;
}

static thumb_timing several(unsigned count, unsigned base) {
    thumb_timing timing = plain(1U + count);
    timing.address = CORE(base);
    return timing;
}

static thumb_timing miscellaneous(thumb_core core, unsigned i) {
    if ((i & 0xFF00U) == 0xB000U) {
        return computing(1U, SP);
    }
    if ((i & 0xF600U) == 0xB400U) { /* push, pop */
        thumb_timing timing = several(bits_in(i & 0x1FFU), SP);
        if (core == THUMB_M0) {
            timing.jumping = 3U;
        }
        return timing;
    }
    if ((i & 0xFF00U) == 0xB200U || (i & 0xFF00U) == 0xBA00U) { /* extend, reverse */
        return computing(1U, i & 7U);
    }
    return plain(1U); /* compare and branch on zero, if-then, hints */
}

static thumb_timing special(unsigned i) { /* high registers, and branches through a register */
    const unsigned operation = i >> 8 & 3U;
    const unsigned to = (i & 7U) | (i >> 4 & 8U);
    if (operation == 3U || operation == 1U || to == PC) {
        return plain(1U);
    }
    return computing(1U, to);
}

static thumb_timing narrow(thumb_core core, unsigned i) {
    const unsigned low = i & 7U;
    const unsigned middle = i >> 3 & 7U;
    switch (i >> 12) {
    case 0x0:
    case 0x1: return computing(1U, low);
    case 0x2:
    case 0x3: return (i >> 11 & 3U) == 1U ? plain(1U) : computing(1U, i >> 8 & 7U);
    case 0x4:
        if ((i & 0x0800U) != 0) {
            return single(core, true, i >> 8 & 7U, PC, PC);
        }
        if ((i & 0x0400U) != 0) {
            return special(i);
        }
        return (0x0D00U >> (i >> 6 & 15U) & 1U) != 0 ? plain(1U)
                                                     : computing(1U, low); /* tst, cmp, cmn */
    case 0x5: return single(core, (i >> 9 & 7U) >= 3U, low, middle, i >> 6 & 7U);
    case 0x6:
    case 0x7:
    case 0x8: return single(core, (i & 0x0800U) != 0, low, middle, PC);
    case 0x9: return single(core, (i & 0x0800U) != 0, i >> 8 & 7U, SP, PC);
    case 0xA: return computing(1U, i >> 8 & 7U);
    case 0xB: return miscellaneous(core, i);
    case 0xC: return several(bits_in(i & 0xFFU), i >> 8 & 7U);
    default: return plain(1U); /* branches */
    }
}

static thumb_timing fpu_arithmetic(unsigned first, unsigned second) {
    const unsigned to = (second >> 11 & 30U) | (first >> 6 & 1U);
    const unsigned left = (first << 1 & 30U) | (second >> 7 & 1U);
    const unsigned right = (second << 1 & 30U) | (second >> 5 & 1U);
    const unsigned operation = first >> 4 & 0xBU;
    thumb_timing timing = plain(1U);
    timing.writes = SINGLE(to);
    timing.reads_fp = SINGLE(left) | SINGLE(right);
    timing.computes_fp = true;
    switch (operation) {
    case 0x0: /* multiply and add, rounded between or not: the sum's other part is read, too */
    case 0x1:
    case 0x9:
    case 0xA:
        timing.cycles = FUSED_FP;
        timing.reads_fp |= SINGLE(to);
        return timing;
    case 0x8: timing.cycles = DIVIDE_FP; return timing;
    case 0xB: break;
    default: return timing; /* sum, difference, product */
    }
    const unsigned which = first & 15U;
    timing.reads_fp = SINGLE(right);
    if ((second & 0x40U) == 0) { /* a constant */
        timing.reads_fp = 0;
        timing.computes_fp = false;
    } else if (which == 1U && (second & 0x80U) != 0) {
        timing.cycles = DIVIDE_FP; /* root */
    } else if (which <= 1U) {      /* move, sign */
        timing.computes_fp = false;
    } else if (which == 4U ||
               which == 5U) { /* compare: with zero, or with what would be the result */
        timing.reads_fp = which == 4U ? SINGLE(right) | SINGLE(to) : SINGLE(to);
        timing.writes = 0;
        timing.computes_fp = false;
    } else if ((which & 10U) == 10U) { /* fixed point, converted where it stands */
        timing.reads_fp = SINGLE(to);
    }
    return timing;
}

static thumb_timing fpu(thumb_core core, unsigned first, unsigned second) {
    const unsigned to = (second >> 11 & 30U) | (first >> 6 & 1U);
    const unsigned count = second & 0xFFU;
    const bool load = (first & 0x10U) != 0;
    if ((first & 0xFF00U) == 0xEE00U) {
        if ((second & 0x10U) == 0) {
            return fpu_arithmetic(first, second);
        }
        thumb_timing timing = plain(1U); /* between the core and the FPU */
        const unsigned which = (first << 1 & 30U) | (second >> 7 & 1U);
        if ((first & 0xE0U) == 0) {
            timing.writes = load ? CORE(second >> 12) : SINGLE(which);
            timing.reads_fp = load ? SINGLE(which) : 0;
        }
        return timing;
    }
    if ((first & 0xFFE0U) == 0xEC40U) { /* two at once */
        return plain(2U);
    }
    if ((first & 0xFF20U) == 0xED00U) {
        thumb_timing timing = single(core, load, 0, first & 15U, PC);
        timing.cycles = 2U;
        timing.overlaps = true;
        timing.writes = load ? SINGLE(to) : 0;
        timing.reads_fp = load ? 0 : SINGLE(to);
        return timing;
    }
    thumb_timing timing = several(count, first & 15U);
    for (unsigned i = 0; i < count && !load; i++) {
        timing.reads_fp |= SINGLE(to + i);
    }
    return timing;
}

static thumb_timing product(thumb_core core, unsigned first, unsigned second) {
    const bool three = core == THUMB_M3;
    const unsigned high = second >> 8 & 15U;
    if ((first & 0x80U) == 0) {
        const bool sum = (second >> 12 & 15U) != PC;
        return computing(three && sum ? 2U : 1U, high);
    }
    const unsigned operation = first >> 4 & 7U;
    if (operation == 1U || operation == 3U) {
        return computing(DIVIDE, high);
    }
    thumb_timing timing = computing(!three            ? 1U
                                    : operation >= 4U ? M3_LONG_SUM
                                                      : M3_LONG_PRODUCT,
                                    high);
    timing.writes |= CORE(second >> 12);
    return timing;
}

static thumb_timing wide(thumb_core core, unsigned first, unsigned second) {
    const unsigned base = first & 15U;
    const unsigned to = second >> 8 & 15U;
    if ((first & 0xEC00U) == 0xEC00U) {
        return fpu(core, first, second);
    }
    if ((first & 0xFE40U) == 0xE800U) {
        return several(bits_in(second), base);
    }
    if ((first & 0xFFF0U) == 0xE8D0U && (second & 0xFFE0U) == 0xF000U) { /* table branch */
        return plain(2U);
    }
    if ((first & 0xFE40U) == 0xE840U) { /* a pair; exclusive access is not used */
        return several(2U, base);
    }
    if ((first & 0xF800U) == 0xF000U && (second & 0x8000U) != 0) { /* branches and control */
        thumb_timing timing = plain(1U);
        if (core == THUMB_M0) { /* a call, or a barrier */
            timing.cycles = (second & 0xD000U) == 0xD000U ? 2U : 4U;
        }
        return timing;
    }
    if ((first & 0xFE00U) == 0xF800U) {
        const bool indexed = (first & 0x80U) == 0 && base != PC && (second & 0x0FC0U) == 0;
        return single(core, (first & 0x10U) != 0, second >> 12, base, indexed ? second & 15U : PC);
    }
    if ((first & 0xFF00U) == 0xFB00U) {
        return product(core, first, second);
    }
    return to == PC ? plain(1U) : computing(1U, to);
}

thumb_timing thumb_decode(thumb_core core, unsigned first, unsigned second) {
    thumb_timing timing = thumb_is_wide(first) ? wide(core, first, second) : narrow(core, first);
    if (core == THUMB_M0) {
        timing.computes = false; /* a pipeline of three stages has none of these delays */
    }
    return timing;
}

unsigned thumb_cycles(const thumb_timing *last, const thumb_timing *now) {
    unsigned cycles = now->cycles;
    if (last == NULL) {
        return cycles;
    }
    if (last->loads && now->overlaps && (last->writes & now->address) == 0) {
        cycles--;
    }
    if (last->computes && (last->writes & now->address) != 0) {
        cycles++;
    }
    if (last->computes_fp && (last->writes & now->reads_fp) != 0) {
        cycles++;
    }
    return cycles;
}
