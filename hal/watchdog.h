/* watchdog.h: cuts the motor when the controller falls silent. Not for interrupts: an interrupt must not keep a hanging
 * controller alive. */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Arm the watchdog: from now on it cuts the drive if hal_watchdog_kick() is not called for more than `timeout_ticks`.
 * It cannot be disarmed. It either cuts the drive permanently, or resets the processor (hal/reset.h), which switches
 * the drive off. A watchdog with its own oscillator may take up to three times as long. */
void hal_watchdog_start(uint32_t timeout_ticks);

/* The controller is alive. Does not bring a cut motor back. */
void hal_watchdog_kick(void);

/* True if the watchdog has cut the motor. */
bool hal_watchdog_has_cut(void);

#ifdef __cplusplus
}
#endif

#endif
