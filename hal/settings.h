/* settings.h: permanent memory for settings: two slots in separate sectors, for core/station/store.h.
 * Call these functions with the motor off: erasing a flash sector may block the processor for half a second. That
 * exceeds any watchdog's timeout, so the caller must lengthen the timeout first. Not from an interrupt. */
#ifndef HAL_SETTINGS_H
#define HAL_SETTINGS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Least size of a slot. */
#define HAL_SETTINGS_BYTES 256U

/* The longest time of one call, in ticks of the capture timer (clock.h). */
#define HAL_SETTINGS_TICKS 1000000U

typedef enum hal_settings_result {
    HAL_SETTINGS_DONE,
    HAL_SETTINGS_OUTSIDE, /* no such slot or bytes, or a forbidden start: nothing was changed */
    HAL_SETTINGS_BUSY,    /* the memory stays busy: nothing was changed */
    HAL_SETTINGS_FAILED   /* the memory reports an error: it is protected, worn out or absent */
} hal_settings_result;

/* `slot` is 0 or 1; at + count <= HAL_SETTINGS_BYTES. A power failure during a call leaves arbitrary bytes in this
 * slot and does not touch the other one. */

/* Set all bytes of the slot to 0xFF. */
hal_settings_result hal_settings_erase(unsigned slot);

/* Write to an erased slot, front to back; `at` is a multiple of 4, `count` any number. */
hal_settings_result hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes,
                                       unsigned count);

hal_settings_result hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
