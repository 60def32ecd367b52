/* watchdog.h: cuts the motor's drive if the controller falls silent. Do not call these functions in an interrupt,
 * because interrupts may go on if the controller hangs. */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Arms the watchdog, which cannot be disarmed. If hal_watchdog_kick() is not called for more than `timeout_ticks`, the
 * watchdog cuts the drive permanently, or resets the processor, which switches the drive off. A watchdog with its own
 * oscillator may wait up to three times as long. */
void hal_watchdog_start(uint32_t timeout_ticks);

/* Restarts the timeout. Does not restore a drive that was cut. */
void hal_watchdog_kick(void);

bool hal_watchdog_has_cut(void);

WH_C_END

#endif
