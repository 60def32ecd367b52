/* pins.c: general purpose ports, and the interrupt controller's switch. */
#include "stm32f4.h"

void stm32f4_pin_is(unsigned pin, stm32f4_pin_mode mode, stm32f4_pin_pull pull, unsigned function) {
    const unsigned port = pin / 16U;
    const unsigned number = pin % 16U;
    reg_set(RCC_AHB1ENR, 1U << port);
    (void)reg_load(RCC_AHB1ENR); /* it has its clock after the next two (RM0090, 7.3.10) */
    reg_change(GPIO_AFR(port, number / 8U), 15U << (4U * (number % 8U)),
               function << (4U * (number % 8U)));
    reg_change(GPIO_PUPDR(port), 3U << (2U * number), (uint32_t)pull << (2U * number));
    reg_change(GPIO_MODER(port), 3U << (2U * number), (uint32_t)mode << (2U * number));
}

void stm32f4_pin_set(unsigned pin, bool high) {
    reg_store(GPIO_BSRR(pin / 16U), 1U << (pin % 16U + (high ? 0U : 16U)));
}

bool stm32f4_pin_is_high(unsigned pin) {
    return (reg_load(GPIO_IDR(pin / 16U)) >> (pin % 16U) & 1U) != 0;
}

/* In the middle: below the faults, which have 0 and interrupt it. */
#define PRIORITY 0x80U

void stm32f4_interrupt(unsigned number) {
    reg_change(NVIC_IPR(number / 4U), 0xFFU << (8U * (number % 4U)),
               PRIORITY << (8U * (number % 4U)));
    reg_store(NVIC_ISER(number / 32U), 1U << (number % 32U));
}
