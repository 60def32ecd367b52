/* settings.h: memory that keeps settings without power: two slots in two sectors of their own, for core/station/store.h.
 *
 * To be called with the motor off: the erase of a flash sector may hold up the processor for half a second, beyond any
 * watchdog's time, which the caller makes longer before. Not from an interrupt. */
#ifndef HAL_SETTINGS_H
#define HAL_SETTINGS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of a slot at least. */
#define HAL_SETTINGS_BYTES 256U

/* The longest that one call may take, capture timer (clock.h). */
#define HAL_SETTINGS_TICKS 1000000U

typedef enum hal_settings_result {
    HAL_SETTINGS_DONE,
    HAL_SETTINGS_OUTSIDE, /* there is no such slot, or it has no such bytes, or none begins there: nothing was begun */
    HAL_SETTINGS_BUSY,  /* the memory does not come to rest: nothing was begun */
    HAL_SETTINGS_FAILED /* the memory says so: protected, worn out, not there */
} hal_settings_result;

/* slot 0 or 1; at + count <= HAL_SETTINGS_BYTES. A supply that fails in one of these leaves anything in this slot, and nothing
 * else in the other. */

/* All bytes of the slot are 0xFF. */
hal_settings_result hal_settings_erase(unsigned slot);

/* Of a slot that was erased, front to back; `at` is a multiple of 4, `count` may be any. */
hal_settings_result hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes,
                                       unsigned count);

hal_settings_result hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
