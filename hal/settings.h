/* settings.h: permanent memory for settings: two slots in separate sectors, for core/station/store.h. Do not call
 * these functions from an interrupt or while the motor is on: the erase of a flash sector may block the processor for
 * half a second. Before a call, set the watchdog's timeout to more than HAL_SETTINGS_TICKS. */
#ifndef HAL_SETTINGS_H
#define HAL_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* smallest size of a slot, in bytes */
#define HAL_SETTINGS_BYTES 256U

/* Longest duration of a call, in ticks of the capture timer (clock.h). */
#define HAL_SETTINGS_TICKS 1000000U

/* For all functions: `slot` is 0 or 1, and at + count <= HAL_SETTINGS_BYTES. The result is false if the memory stays
 * busy or is protected, worn out or absent. A power failure during a call leaves arbitrary bytes in this slot only. */

/* Sets all bytes of the slot to 0xFF. */
bool hal_settings_erase(unsigned slot);

/* Writes bytes[count] to an erased slot at byte `at`, a multiple of 4. Write a slot front to back. */
bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);

bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);

WH_C_END

#endif
