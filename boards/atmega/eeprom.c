/* eeprom.c: settings in the EEPROM (DS 8.6). A changed byte takes 1.8 ms, a slot of 256 bytes at most 0.46 s. */
#include "hal/settings.h"

#include "atmega.h"

#define FIRST 256U /* not 0: EEAR rests at 0, and a failing supply may corrupt the byte at EEAR */
#define SLOTS 2U
#define ERASED 0xFFU
#define ERASE _BV(EEPM0)
#define WRITE _BV(EEPM1)
_Static_assert(FIRST + SLOTS * HAL_SETTINGS_BYTES <= E2END + 1U, "it has room");

static uint16_t address_of(unsigned slot, unsigned at) {
    return (uint16_t)(FIRST + slot * HAL_SETTINGS_BYTES + at);
}

/* Returns false if the EEPROM stays busy. A byte takes less than 20 ms; the loop waits longer. */
static bool rests(void) {
    for (uint16_t i = 0; i < 60000U; i++) {
        if ((EECR & _BV(EEPE)) == 0) {
            return true;
        }
    }
    return false;
}

static uint8_t load(uint16_t address) {
    EEAR = address;
    EECR |= _BV(EERE);
    const uint8_t byte = EEDR;
    EEAR = 0;
    return byte;
}

/* EEPE must be set within four clocks after EEMPE. Returns false if the byte reads back wrong. */
static bool program(uint16_t address, uint8_t mode, uint8_t byte) {
    if (!rests()) {
        return false;
    }
    EEAR = address;
    EEDR = byte;
    const uint8_t before = atmega_hold();
    EECR = mode;
    EECR |= _BV(EEMPE);
    EECR |= _BV(EEPE);
    atmega_go_on(before);
    return rests() && load(address) == byte;
}

bool hal_settings_erase(unsigned slot) {
    bool done = rests();
    for (unsigned at = 0; at < HAL_SETTINGS_BYTES && done; at++) {
        const uint16_t address = address_of(slot, at);
        done = load(address) == ERASED || program(address, ERASE, ERASED);
    }
    return done;
}

bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    bool done = rests();
    for (unsigned i = 0; i < count && done; i++) {
        const uint16_t address = address_of(slot, at + i);
        done = load(address) == bytes[i] || program(address, WRITE, bytes[i]);
    }
    return done;
}

bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    const bool done = rests();
    for (unsigned i = 0; i < count && done; i++) {
        bytes[i] = load(address_of(slot, at + i));
    }
    return done;
}
