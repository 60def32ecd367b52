/* fake_registers.h: a chip's registers in memory, for drivers that are compiled for the PC (boards/stm32f4/registers.h): every
 * access is counted and stores are kept in their order; a test gives registers the behaviour that the manual says. */
#ifndef TESTS_HOST_FAKE_REGISTERS_H
#define TESTS_HOST_FAKE_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

#define FAKE_STORES 4096U

typedef struct fake_chip {
    /* What a load finds, and what a store leaves; NULL: memory. They use fake_get() and fake_put(). */
    uint32_t (*load)(uint32_t address);
    void (*store)(uint32_t address, uint32_t value);
    unsigned long loads;
    unsigned stores; /* the first FAKE_STORES are kept */
    struct {
        uint32_t address;
        uint32_t value;
    } stored[FAKE_STORES];
} fake_chip;

extern fake_chip fake;

/* All registers 0 but those a test puts, nothing counted. */
void fake_start(uint32_t (*load)(uint32_t), void (*store)(uint32_t, uint32_t));

/* Past the behaviour. */
uint32_t fake_get(uint32_t address);
void fake_put(uint32_t address, uint32_t value);

/* The memory that DMA was told of by this address, of 32 bits on every machine; NULL: it was told of none. */
volatile void *fake_memory(uint32_t address);

#endif
