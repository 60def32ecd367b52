/* flash.c: settings in sectors 1 and 2 of the chip's flash, 16 KB each (RM0090, 3.6), which the linker leaves free
 * (stm32f405.ld). An erase takes 0.25 to 0.5 s, in which the core stalls. */
#include "hal/settings.h"

#include "boards/shared/remembered.h"
#include "stm32f4.h"

#define FIRST_SECTOR 1U
#define SECTOR_BYTES 0x4000U
#define FIRST_ADDRESS 0x08004000U

static uint32_t address_of(unsigned slot, unsigned at) {
    return FIRST_ADDRESS + SECTOR_BYTES * slot + at;
}

/* Waits for the end of the operation. Returns false if it failed. */
static bool ended(void) {
    return stm32f4_flash_rests() && (reg_load(FLASH_SR) & FLASH_SR_ERRORS) == 0;
}

/* Unlocks the flash. Returns false if it stays busy. */
static bool opened(void) {
    if (!stm32f4_flash_rests()) {
        return false;
    }
    reg_store(FLASH_KEYR, FLASH_KEY1);
    reg_store(FLASH_KEYR, FLASH_KEY2);
    reg_store(FLASH_SR, FLASH_SR_ERRORS); /* clears the errors of an earlier operation */
    return true;
}

/* Empties the data cache, which may have old data of an erased sector (3.5.2). */
static void forget_cached(void) {
    reg_clear(FLASH_ACR, FLASH_ACR_DCEN);
    reg_set(FLASH_ACR, FLASH_ACR_DCRST);
    reg_clear(FLASH_ACR, FLASH_ACR_DCRST);
    reg_set(FLASH_ACR, FLASH_ACR_DCEN);
}

bool hal_settings_erase(unsigned slot) {
    if (!opened()) {
        return false;
    }
    const uint32_t order = FLASH_CR_SER | FLASH_CR_SNB(FIRST_SECTOR + slot) | FLASH_CR_PSIZE_32;
    reg_store(FLASH_CR, order);
    reg_store(FLASH_CR, order | FLASH_CR_STRT);
    const bool done = ended();
    reg_store(FLASH_CR, FLASH_CR_LOCK);
    forget_cached();
    return done;
}

/* Pads the last word with 0xFF, the value of erased bytes. */
bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    bool done = opened();
    if (!done) {
        return false;
    }
    reg_store(FLASH_CR, FLASH_CR_PG | FLASH_CR_PSIZE_32);
    for (unsigned i = 0; i < count && done; i += 4U) {
        uint32_t word = UINT32_MAX;
        __builtin_memcpy(&word, bytes + i, count - i < 4U ? count - i : 4U);
        reg_store(address_of(slot, at + i), word);
        board_kept_settle(); /* completes the store before the status is read */
        done = ended();
    }
    reg_store(FLASH_CR, FLASH_CR_LOCK);
    return done;
}

bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        const uint32_t address = address_of(slot, at + i);
        bytes[i] = (uint8_t)(reg_load(address & ~3U) >> (8U * (address & 3U)));
    }
    return true;
}
