/* clock.c: the STM32F405's clocks: 168 MHz from the board's crystal (RM0090, 7.2 and 3.5). If the crystal or the
 * phase-locked loop fails, the chip runs on its own oscillator, 16 MHz within 1 %. Every wait is bounded, and no
 * variable is used: memory is not initialized yet. */
#include "stm32f4.h"

#define PLL_OUT_Hz 336000000U
_Static_assert(BOARD_CRYSTAL_HZ / BOARD_PLL_M >= 1000000U &&
                   BOARD_CRYSTAL_HZ / BOARD_PLL_M <= 2000000U,
               "what the loop compares: 1 to 2 MHz (RM0090, 7.3.2)");
_Static_assert(BOARD_CRYSTAL_HZ / BOARD_PLL_M * BOARD_PLL_N == PLL_OUT_Hz &&
                   BOARD_CRYSTAL_HZ % BOARD_PLL_M == 0,
               "336 MHz, halved");
_Static_assert(BOARD_PLL_N >= 50U && BOARD_PLL_N <= 432U && BOARD_PLL_M >= 2U && BOARD_PLL_M <= 63U,
               "RM0090, 7.3.2");

/* Largest numbers of polls. A poll takes some ten cycles at 16 MHz. SOON suffices for the chip's own oscillator (4 us)
 * and the phase-locked loop (0.3 ms), PATIENTLY for a crystal (some milliseconds). */
#define SOON 2000U
#define PATIENTLY 40000U

bool stm32f4_comes(uint32_t address, uint32_t mask, uint32_t wanted, uint32_t looks) {
    for (uint32_t i = 0; i < looks; i++) {
        if ((reg_load(address) & mask) == wanted) {
            return true;
        }
    }
    return false;
}

void stm32f4_clock_on(unsigned part) {
    const uint32_t enable = RCC_AHB1ENR + part / 32U * 4U;
    reg_set(enable, 1U << part % 32U);
    (void)reg_load(enable);
}

/* Runs the core on the chip's own oscillator: a loader in ROM may have changed the clock, or the crystal has failed.
 * Returns false in an emulator, whose clock registers read as zero. */
static bool to_own_oscillator(void) {
    reg_set(RCC_CR, RCC_CR_HSION);
    if (!stm32f4_comes(RCC_CR, RCC_CR_HSIRDY, RCC_CR_HSIRDY, SOON)) {
        return false;
    }
    reg_change(RCC_CFGR, RCC_CFGR_SW, RCC_CFGR_SW_HSI);
    (void)stm32f4_comes(RCC_CFGR, RCC_CFGR_SWS, RCC_CFGR_SWS_HSI, SOON);
    reg_clear(RCC_CR, RCC_CR_PLLON | RCC_CR_CSSON);
    (void)stm32f4_comes(RCC_CR, RCC_CR_PLLRDY, 0, SOON);
    reg_clear(RCC_CR, RCC_CR_HSEON);
    /* HSEBYP can change only after the oscillator has stopped, which takes six cycles of the crystal (7.3.1) */
    (void)stm32f4_comes(RCC_CR, RCC_CR_HSERDY, 0, SOON);
    reg_clear(RCC_CR, RCC_CR_HSEBYP);
    reg_store(RCC_CFGR, 0);
    reg_store(RCC_CIR, 0);
    return true;
}

static board_clock fall_back(void) {
    (void)to_own_oscillator();
    return BOARD_CLOCK_FALLBACK;
}

/* not cleared, because it is written before the start-up code clears variables */
__attribute__((section(".noinit"))) board_clock board_clock_is;

static board_clock set_up(void) {
    if (!to_own_oscillator()) {
        return BOARD_CLOCK_GIVEN;
    }
    reg_set(RCC_CR, RCC_CR_HSEON);
    if (!stm32f4_comes(RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY, PATIENTLY)) {
        return fall_back();
    }
    stm32f4_clock_on(RCC_PART(RCC_APB1ENR, RCC_APB1ENR_PWR));
    reg_set(PWR_CR, PWR_CR_VOS);
    reg_store(RCC_PLLCFGR, BOARD_PLL_M | RCC_PLLCFGR_N(BOARD_PLL_N) | RCC_PLLCFGR_P_2 |
                               RCC_PLLCFGR_HSE | RCC_PLLCFGR_Q(7U));
    reg_set(RCC_CR, RCC_CR_PLLON);
    if (!stm32f4_comes(RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY, SOON)) {
        return fall_back();
    }
    /* 168 MHz at 2.7 V needs five wait states (3.5.1). Prefetch stays off, because it has a defect in revision A. */
    const uint32_t wait_states = 5U;
    reg_store(FLASH_ACR, FLASH_ACR_ICEN | FLASH_ACR_DCEN | wait_states);
    if (!stm32f4_comes(FLASH_ACR, FLASH_ACR_LATENCY, wait_states, SOON)) {
        return fall_back();
    }
    reg_store(RCC_CFGR, RCC_CFGR_PPRE1_4 | RCC_CFGR_PPRE2_2);
    reg_change(RCC_CFGR, RCC_CFGR_SW, RCC_CFGR_SW_PLL);
    if (!stm32f4_comes(RCC_CFGR, RCC_CFGR_SWS, RCC_CFGR_SWS_PLL, SOON)) {
        return fall_back();
    }
    /* If the crystal stops, TIM1's break switches the motor off, and an NMI calls the fault handler (7.2.7). */
    reg_set(RCC_CR, RCC_CR_CSSON);
    return BOARD_CLOCK_CRYSTAL;
}

void board_clock_start(void) { board_clock_is = set_up(); }

const stm32f4_clocks *stm32f4_clocks_now(void) {
    static const stm32f4_clocks clocks[] = {
        [BOARD_CLOCK_CRYSTAL] = {.timer1_Hz = PLL_OUT_Hz / 2U,
                                 .timers_Hz = PLL_OUT_Hz / 4U,
                                 .usart_Hz = PLL_OUT_Hz / 4U},
        [BOARD_CLOCK_FALLBACK] = {.timer1_Hz = 16000000U,
                                  .timers_Hz = 16000000U,
                                  .usart_Hz = 16000000U},
        /* QEMU's timers count nanoseconds */
        [BOARD_CLOCK_GIVEN] = {.timer1_Hz = PLL_OUT_Hz / 2U,
                               .timers_Hz = 1000000000U,
                               .usart_Hz = PLL_OUT_Hz / 4U},
    };
    return &clocks[board_clock_is];
}
