/* thumb_cycles.h: an estimate of the cycles that a Cortex-M takes for the instructions it executes, by Arm's published
 * timing: Cortex-M4 TRM (DDI 0439) tables 3-1 and 7-1 and section 3.3.3, Cortex-M3 TRM (DDI 0337) table 3-1, Cortex-M0
 * TRM (DDI 0432) table 3-1. Decoded from the instructions' bits.
 *
 * docs/dev/price.md says which of these are choices, and what is not modelled. */
#ifndef MK_COUNT_THUMB_CYCLES_H
#define MK_COUNT_THUMB_CYCLES_H

#include <stdbool.h>
#include <stdint.h>

typedef enum thumb_core { THUMB_NONE, THUMB_M0, THUMB_M3, THUMB_M4 } thumb_core;

/* What of an instruction matters. Registers are bits: 0 to 15 the core's, 16 to 47 the FPU's single ones. */
typedef struct thumb_timing {
    unsigned cycles;  /* alone, and not jumping */
    unsigned jumping; /* more, when what follows it is not the next in memory */
    bool loads;       /* one register: a load or store behind it overlaps by a cycle */
    bool overlaps;    /* may be that load or store */
    bool computes;    /* its result comes too late for an address in the next instruction */
    bool computes_fp; /* its result comes too late for the next instruction of the FPU */
    uint64_t writes;
    uint64_t address; /* read for an address */
    uint64_t reads_fp;
} thumb_timing;

/* The core of that name ("m0", "m3", "m4"), or THUMB_NONE. */
thumb_core thumb_core_of(const char *name);

/* `first` and `second` are an instruction's halfwords; the second counts if thumb_is_wide(first). */
bool thumb_is_wide(unsigned first);
thumb_timing thumb_decode(thumb_core core, unsigned first, unsigned second);

/* Cycles of `now` when it is executed right behind `last` in memory; without one, `last` is NULL. */
unsigned thumb_cycles(const thumb_timing *last, const thumb_timing *now);

#endif
