/* watchdog.h: cuts the motor when the controller falls silent. Nothing of it is for interrupts: a controller that hangs must not be
 * kept alive by one. */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Arm the watchdog: from now on the drive is cut when hal_watchdog_kick() stays away for more than `timeout_ticks`. Cannot be
 * disarmed. Either it cuts the drive for good, or it resets the processor (hal/reset.h), in whose reset the drive is off;
 * one with an oscillator of its own may take up to three times as long. */
void hal_watchdog_start(uint32_t timeout_ticks);

/* The controller is alive. Does not bring a cut motor back. */
void hal_watchdog_kick(void);

/* True when the watchdog has cut the motor. */
bool hal_watchdog_has_cut(void);

#ifdef __cplusplus
}
#endif

#endif
