/* settings.h: memory that keeps settings without power: two slots in two sectors of their own, for core/station/store.h.
 *
 * To be called with the motor off: the erase of a flash sector may hold up the processor for half a second, beyond any
 * watchdog's time, which the caller makes longer before. Not from an interrupt. */
#ifndef HAL_SETTINGS_H
#define HAL_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of a slot at least. */
#define HAL_SETTINGS_BYTES 256U

/* The longest that one call may take, capture timer (clock.h). */
#define HAL_SETTINGS_TICKS 1000000U

/* slot 0 or 1; at + count <= HAL_SETTINGS_BYTES. False: the memory says that it failed. A supply that fails in one of these
 * leaves anything in this slot, and nothing else in the other. */

/* All bytes of the slot are 0xFF. */
bool hal_settings_erase(unsigned slot);

/* Of a slot that was erased, front to back; `at` is a multiple of 4, `count` may be any. */
bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);

bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
