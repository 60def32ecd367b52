/* flash.c: settings in sectors 1 and 2 of the chip's flash, 16 KB each (RM0090, 3.6), which the linker leaves free
 * (stm32f405.ld). An erase takes 0.25 to 0.5 s, and stalls the core meanwhile. */
#include "hal/settings.h"

#include "boards/shared/remembered.h"
#include "stm32f4.h"

#define FIRST_SECTOR 1U
#define SECTOR_BYTES 0x4000U
#define FIRST_ADDRESS 0x08004000U
#define SLOTS 2U

static bool within(unsigned slot, unsigned at, unsigned count) {
    return slot < SLOTS && at <= HAL_SETTINGS_BYTES && count <= HAL_SETTINGS_BYTES - at;
}

static uint32_t address_of(unsigned slot, unsigned at) {
    return FIRST_ADDRESS + SECTOR_BYTES * slot + at;
}

/* Waits until the operation in progress ends. Returns its result. */
static hal_settings_result ended(void) {
    return stm32f4_flash_rests() && (reg_load(FLASH_SR) & FLASH_SR_ERRORS) == 0
               ? HAL_SETTINGS_DONE
               : HAL_SETTINGS_FAILED;
}

/* Unlocks the flash for these bytes. Returns an error if they do not exist or if the flash is busy. */
static hal_settings_result opened(unsigned slot, unsigned at, unsigned count) {
    if (!within(slot, at, count)) {
        return HAL_SETTINGS_OUTSIDE;
    }
    if (!stm32f4_flash_rests()) {
        return HAL_SETTINGS_BUSY;
    }
    reg_store(FLASH_KEYR, FLASH_KEY1);
    reg_store(FLASH_KEYR, FLASH_KEY2);
    reg_store(FLASH_SR, FLASH_SR_ERRORS); /* clears the errors of an earlier operation */
    return HAL_SETTINGS_DONE;
}

/* Empties the data cache, which may have old data of an erased sector (3.5.2). */
static void forget_cached(void) {
    reg_clear(FLASH_ACR, FLASH_ACR_DCEN);
    reg_set(FLASH_ACR, FLASH_ACR_DCRST);
    reg_clear(FLASH_ACR, FLASH_ACR_DCRST);
    reg_set(FLASH_ACR, FLASH_ACR_DCEN);
}

hal_settings_result hal_settings_erase(unsigned slot) {
    hal_settings_result result = opened(slot, 0, 0);
    if (result != HAL_SETTINGS_DONE) {
        return result;
    }
    const uint32_t order = FLASH_CR_SER | FLASH_CR_SNB(FIRST_SECTOR + slot) | FLASH_CR_PSIZE_32;
    reg_store(FLASH_CR, order);
    reg_store(FLASH_CR, order | FLASH_CR_STRT);
    result = ended();
    reg_store(FLASH_CR, FLASH_CR_LOCK);
    forget_cached();
    return result;
}

/* Writes whole words. The bytes of the last word after `count` stay 0xFF. */
hal_settings_result hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes,
                                       unsigned count) {
    hal_settings_result result = at % 4U == 0 ? opened(slot, at, count) : HAL_SETTINGS_OUTSIDE;
    if (result != HAL_SETTINGS_DONE) {
        return result;
    }
    reg_store(FLASH_CR, FLASH_CR_PG | FLASH_CR_PSIZE_32);
    for (unsigned i = 0; i < count && result == HAL_SETTINGS_DONE; i += 4U) {
        uint32_t word = UINT32_MAX;
        __builtin_memcpy(&word, bytes + i, count - i < 4U ? count - i : 4U);
        reg_store(address_of(slot, at + i), word);
        board_kept_settle(); /* completes the store before the status is read */
        result = ended();
    }
    reg_store(FLASH_CR, FLASH_CR_LOCK);
    return result;
}

hal_settings_result hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    if (!within(slot, at, count)) {
        return HAL_SETTINGS_OUTSIDE;
    }
    for (unsigned i = 0; i < count; i++) {
        const uint32_t address = address_of(slot, at + i);
        bytes[i] = (uint8_t)(reg_load(address & ~3U) >> (8U * (address & 3U)));
    }
    return HAL_SETTINGS_DONE;
}
