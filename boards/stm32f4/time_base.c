/* time_base.c: timer 2 as the free-running clock, 32 bits at 1 MHz (RM0090, 18.3). Its channels capture slot edges. */
#include "boards/board.h"

#include "stm32f4.h"

void timer_start(void) {
    stm32f4_clock_on(RCC_PART(RCC_APB1ENR, RCC_APB1ENR_TIM2));
    /* The filters sample at 84 MHz / 4 / 32 and need eight equal samples, so an edge passes after 12 us (slots.c). */
    reg_store(TIM_CR1(TIM2), TIM_CR1_CKD_4);
    reg_store(TIM_PSC(TIM2), stm32f4_clocks_now()->timers_Hz / BOARD_TICKS_PER_S - 1U);
    reg_store(TIM_ARR(TIM2), 0xFFFFFFFFU);
    reg_store(TIM_EGR(TIM2), TIM_EGR_UG); /* activates the divider */
    reg_store(TIM_SR(TIM2), 0);
    reg_store(TIM_CR1(TIM2), TIM_CR1_CKD_4 | TIM_CR1_CEN);
}

uint32_t board_ticks(void) { return reg_load(TIM_CNT(TIM2)); }
