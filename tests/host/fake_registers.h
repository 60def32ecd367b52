/* fake_registers.h: a chip's registers in memory, for drivers compiled for the PC (boards/stm32f4/registers.h).
 * Accesses are counted and stores recorded in order. A test gives registers the behaviour in the manual. */
#ifndef TESTS_HOST_FAKE_REGISTERS_H
#define TESTS_HOST_FAKE_REGISTERS_H

#include "test.h"

#define FAKE_STORES 4096U

typedef struct fake_chip {
    /* Behaviour of a load and a store, by fake_get() and fake_put(); NULL: plain memory. */
    uint32_t (*load)(uint32_t address);
    void (*store)(uint32_t address, uint32_t value);
    unsigned long loads;
    unsigned stores; /* the first FAKE_STORES are recorded */
    struct {
        uint32_t address;
        uint32_t value;
    } stored[FAKE_STORES];
} fake_chip;

extern fake_chip fake;

/* Resets all registers and counts to 0. */
void fake_start(uint32_t (*load)(uint32_t), void (*store)(uint32_t, uint32_t));

/* Access without the behaviour. */
uint32_t fake_get(uint32_t address);
void fake_put(uint32_t address, uint32_t value);

/* The memory that DMA uses by this address, which has 32 bits on every machine; NULL: unknown address. */
volatile void *fake_memory(uint32_t address);

#endif
