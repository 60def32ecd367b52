/* watchdog.h: cuts the motor when the controller falls silent. Do not call it from an interrupt, which could keep a
 * hanging controller alive. */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Arm the watchdog: after this call it cuts the drive if hal_watchdog_kick() is not called for more than
 * `timeout_ticks`. It cannot be disarmed. It either cuts the drive permanently, or resets the processor (hal/reset.h),
 * which switches the drive off. A watchdog with its own oscillator may take up to three times as long. */
void hal_watchdog_start(uint32_t timeout_ticks);

/* Tell the watchdog that the controller is alive. This does not restore a drive that was cut. */
void hal_watchdog_kick(void);

bool hal_watchdog_has_cut(void);

WH_C_END

#endif
