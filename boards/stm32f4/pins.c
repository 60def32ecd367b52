/* pins.c: general purpose ports, and the enabling of interrupts. */
#include "stm32f4.h"

void stm32f4_field(uint32_t first, unsigned bits, unsigned number, uint32_t value) {
    const unsigned at = bits * number;
    reg_change(first + at / 32U * 4U, ((1U << bits) - 1U) << at % 32U, value << at % 32U);
}

/* An output begins low. */
void stm32f4_pin_is(unsigned pin, unsigned what) {
    const unsigned port = pin / 16U;
    const unsigned number = pin % 16U;
    stm32f4_clock_on(port);
    if (what == PIN_OUTPUT) {
        stm32f4_pin_set(pin, false);
    }
    stm32f4_field(GPIO_AFR(port, 0U), 4U, number, what >> 4);
    stm32f4_field(GPIO_PUPDR(port), 2U, number, what >> 2 & 3U);
    stm32f4_field(GPIO_MODER(port), 2U, number, what & 3U);
}

/* Faults have priority 0. A larger number is a lower priority. */
#define PRIORITY 0x80U

void stm32f4_interrupt(unsigned number) {
    stm32f4_field(NVIC_IPR(0U), 8U, number, PRIORITY);
    reg_store(NVIC_ISER(number / 32U), 1U << (number % 32U));
}
