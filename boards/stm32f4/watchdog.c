/* watchdog.c: the independent watchdog (RM0090, 21). It resets the chip, even if a debugger halts the core (motor.c).
 * A reset switches the drive off. It comes after 1 to 2.8 timeouts, because the watchdog's clock has 17 to 47 kHz. */
#include "hal/watchdog.h"

#include "hal/clock.h"
#include "stm32f4.h"

#define FASTEST_KHZ 47U
#define TICKS_PER_MS (HAL_TICKS_PER_S / 1000U)
#define LONGEST 4095U
#define DIVIDERS 7U /* dividers 4, 8, ... 256 */

/* Converts ticks to clocks of the fastest oscillator, rounded up. A 64-bit division would need 750 bytes of flash. */
static uint32_t clocks_in(uint32_t ticks) {
    const uint32_t rest = FASTEST_KHZ * (ticks % TICKS_PER_MS);
    return FASTEST_KHZ * (ticks / TICKS_PER_MS) + (rest + TICKS_PER_MS - 1U) / TICKS_PER_MS;
}

/* May be called again, even just before the watchdog resets the chip. */
void hal_watchdog_start(uint32_t timeout_ticks) {
    uint32_t counts = clocks_in(timeout_ticks) / 4U;
    uint32_t divider = 0;
    while (divider + 1U < DIVIDERS && counts >= LONGEST) {
        divider++;
        counts /= 2U;
    }
    reg_store(IWDG_KR, IWDG_KR_START); /* also starts the watchdog's oscillator */
    reg_store(IWDG_KR, IWDG_KR_RELOAD);
    reg_store(IWDG_KR, IWDG_KR_UNLOCK);
    reg_store(IWDG_PR, divider);
    reg_store(IWDG_RLR, counts < LONGEST ? counts + 1U : LONGEST);
    /* both take effect after up to five clocks of the watchdog, 300 us (21.4.4) */
    (void)stm32f4_comes(IWDG_SR, UINT32_MAX, 0, 100000U);
    reg_store(IWDG_KR, IWDG_KR_RELOAD);
}

void hal_watchdog_kick(void) { reg_store(IWDG_KR, IWDG_KR_RELOAD); }

/* This watchdog resets the chip instead of cutting the drive. */
bool hal_watchdog_has_cut(void) { return false; }
