/* watchdog.c: the chip's watchdog (DS 12.4). After a reset the pins float, so the drive is off. If the timeout is 14 ms
 * to 7 s, the reset comes after 1 to 2.7 times the timeout. */
#include "hal/watchdog.h"

#include "atmega.h"
#include "boards/avr/stack.h"

#define SHORTEST_TICKS UINT32_C(13900) /* 2048 clocks of the fastest oscillator, 13.9 ms */
#define LONGEST 9U                     /* largest number of doublings */

void hal_watchdog_start(uint32_t timeout_ticks) {
    uint8_t twice = 0;
    while (twice < LONGEST && SHORTEST_TICKS << twice < timeout_ticks) {
        twice++;
    }
    atmega_watch(twice);
}

/* Also checks the stack, for which the chip has no hardware. */
void hal_watchdog_kick(void) {
    if (!avr_stack_is_whole()) {
        atmega_fault(ATMEGA_FAULT_STACK, 0);
    }
    __asm__ volatile("wdr");
}

/* This watchdog resets the chip instead of cutting the drive. */
bool hal_watchdog_has_cut(void) { return false; }
