/* cmsdk_watchdog.c: hal/watchdog.h on Arm's CMSDK APB watchdog (Cortex-M System Design Kit Technical Reference Manual,
 * 4.4), as on the MPS2 boards. This watchdog counts down twice. At the end of the first count it requests an interrupt,
 * which is the NMI on these boards. At the end of the second, after twice the timeout, it resets the processor. */
#include "cortexm.h"

#include "hal/clock.h"
#include "hal/watchdog.h"

#define WATCHDOG_LOAD (BOARD_WATCHDOG + 0x000U)
#define WATCHDOG_CONTROL (BOARD_WATCHDOG + 0x008U)
#define WATCHDOG_CLEAR (BOARD_WATCHDOG + 0x00CU)
#define WATCHDOG_LOCK (BOARD_WATCHDOG + 0xC00U)
#define WATCHDOG_CONTROL_INTERRUPT 1U
#define WATCHDOG_CONTROL_RESET 2U
#define WATCHDOG_KEY 0x1ACCE551U

#define TICKS_MOST (UINT32_MAX / (BOARD_TICKS_PER_S / HAL_TICKS_PER_S))

void hal_watchdog_start(uint32_t timeout_ticks) {
    const uint32_t ticks = timeout_ticks < TICKS_MOST ? timeout_ticks : TICKS_MOST;
    REGISTER(WATCHDOG_LOCK) = WATCHDOG_KEY;
    REGISTER(WATCHDOG_LOAD) = ticks * (BOARD_TICKS_PER_S / HAL_TICKS_PER_S);
    REGISTER(WATCHDOG_CONTROL) = WATCHDOG_CONTROL_INTERRUPT | WATCHDOG_CONTROL_RESET;
    REGISTER(WATCHDOG_LOCK) = 0;
}

/* Clearing the interrupt reloads the count, even if no interrupt is pending. */
void hal_watchdog_kick(void) {
    REGISTER(WATCHDOG_LOCK) = WATCHDOG_KEY;
    REGISTER(WATCHDOG_CLEAR) = 1;
    REGISTER(WATCHDOG_LOCK) = 0;
}

bool hal_watchdog_has_cut(void) { return false; }
