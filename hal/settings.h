/* settings.h: permanent memory for settings: two slots in separate sectors, for core/station/store.h.
 * Call these functions with the motor off: erasing a flash sector may block the processor for half a second. That
 * exceeds any watchdog's timeout, so the caller must lengthen the timeout first. Not from an interrupt. */
#ifndef HAL_SETTINGS_H
#define HAL_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Least size of a slot, in bytes. */
#define HAL_SETTINGS_BYTES 256U

/* The longest time that one call takes, in ticks of the capture timer (clock.h). */
#define HAL_SETTINGS_TICKS 1000000U

/* For the next functions: `slot` is 0 or 1; at + count <= HAL_SETTINGS_BYTES. They return false if the memory stays
 * busy or reports an error: it is protected, worn out or absent. A power failure during a call leaves arbitrary bytes
 * in this slot and does not touch the other slot. */

/* Set all bytes of the slot to 0xFF. */
bool hal_settings_erase(unsigned slot);

/* Write bytes[count] to the slot, beginning at byte `at`, a multiple of 4. Erase the slot first, then write it front to
 * back. `count` may be any number. */
bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);

bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);

WH_C_END

#endif
