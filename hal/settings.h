/* settings.h: permanent memory for settings: two slots in separate sectors, for core/station/store.h.
 *
 * Call it with the motor off: the erase of a flash sector may block the processor for half a second. That exceeds any
 * watchdog's time, which the caller must lengthen first. Not from an interrupt. */
#ifndef HAL_SETTINGS_H
#define HAL_SETTINGS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of a slot at least. */
#define HAL_SETTINGS_BYTES 256U

/* The longest time of one call, in ticks of the capture timer (clock.h). */
#define HAL_SETTINGS_TICKS 1000000U

typedef enum hal_settings_result {
    HAL_SETTINGS_DONE,
    HAL_SETTINGS_OUTSIDE, /* no such slot or bytes, or a wrong begin: nothing was changed */
    HAL_SETTINGS_BUSY,    /* the memory stays busy: nothing was changed */
    HAL_SETTINGS_FAILED   /* the memory reports it: protected, worn out, absent */
} hal_settings_result;

/* slot 0 or 1; at + count <= HAL_SETTINGS_BYTES. A power failure during one of these leaves arbitrary bytes in this
 * slot and does not touch the other. */

/* Set all bytes of the slot to 0xFF. */
hal_settings_result hal_settings_erase(unsigned slot);

/* Write to an erased slot, front to back; `at` is a multiple of 4, `count` may be any. */
hal_settings_result hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes,
                                       unsigned count);

hal_settings_result hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
