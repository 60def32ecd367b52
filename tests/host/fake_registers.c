#include "tests/host/fake_registers.h"

#include <stdlib.h>

#define CELLS 1024U

uint32_t reg_load(uint32_t address);
void reg_store(uint32_t address, uint32_t value);

uint32_t reg_address(volatile void *memory);
uint32_t reg_hold(void);
void reg_go_on(uint32_t before);

fake_chip fake;

/* static: its address never changes */
#define MEMORIES 8U
#define MEMORY_BASE UINT32_C(0x20000000)
#define MEMORY_BYTES UINT32_C(0x4000)
static volatile void *memories[MEMORIES];

static struct {
    uint32_t address;
    uint32_t value;
    bool used;
} cell[CELLS];

static unsigned cell_of(uint32_t address) {
    for (unsigned i = 0; i < CELLS; i++) {
        const unsigned at = (address / 4U * 2654435761U + i) % CELLS;
        if (!cell[at].used || cell[at].address == address) {
            cell[at].used = true;
            cell[at].address = address;
            return at;
        }
    }
    abort();
}

void fake_start(uint32_t (*load)(uint32_t), void (*store)(uint32_t, uint32_t)) {
    for (unsigned i = 0; i < CELLS; i++) {
        cell[i].used = false;
        cell[i].value = 0;
    }
    fake = (fake_chip){.load = load, .store = store};
}

uint32_t fake_get(uint32_t address) { return cell[cell_of(address)].value; }

void fake_put(uint32_t address, uint32_t value) { cell[cell_of(address)].value = value; }

uint32_t reg_load(uint32_t address) {
    fake.loads++;
    return fake.load != NULL ? fake.load(address) : fake_get(address);
}

void reg_store(uint32_t address, uint32_t value) {
    if (fake.stores < FAKE_STORES) {
        fake.stored[fake.stores].address = address;
        fake.stored[fake.stores].value = value;
    }
    fake.stores++;
    if (fake.store != NULL) {
        fake.store(address, value);
    } else {
        fake_put(address, value);
    }
}

uint32_t reg_address(volatile void *memory) {
    for (unsigned i = 0; i < MEMORIES; i++) {
        if (memories[i] == NULL || memories[i] == memory) {
            memories[i] = memory;
            return MEMORY_BASE + i * MEMORY_BYTES;
        }
    }
    abort();
}

volatile void *fake_memory(uint32_t address) {
    const uint32_t place = (address - MEMORY_BASE) / MEMORY_BYTES;
    return place < MEMORIES ? memories[place] : NULL;
}

/* Interrupts never occur here. */
uint32_t reg_hold(void) { return 0; }
void reg_go_on(uint32_t before) { (void)before; }
