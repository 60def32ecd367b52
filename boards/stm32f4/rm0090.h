/* rm0090.h: the STM32F405's registers that the drivers use. Section numbers, and table 62 of the interrupts, are those
 * of ST's reference manual RM0090, revision 19. */
#ifndef BOARDS_STM32F4_RM0090_H
#define BOARDS_STM32F4_RM0090_H

/* Power controller, 5.4. */
#define PWR_CR 0x40007000U
#define PWR_CR_VOS (1U << 14) /* scale 1, required above 144 MHz */

/* Reset and clock control, 7.3. */
#define RCC 0x40023800U
#define RCC_CR (RCC + 0x00U)
#define RCC_CR_HSION (1U << 0)
#define RCC_CR_HSIRDY (1U << 1)
#define RCC_CR_HSEON (1U << 16)
#define RCC_CR_HSERDY (1U << 17)
#define RCC_CR_HSEBYP (1U << 18)
#define RCC_CR_CSSON (1U << 19)
#define RCC_CR_PLLON (1U << 24)
#define RCC_CR_PLLRDY (1U << 25)
#define RCC_PLLCFGR (RCC + 0x04U)
#define RCC_PLLCFGR_N(n) ((n) << 6)
#define RCC_PLLCFGR_P_2 (0U << 16)
#define RCC_PLLCFGR_HSE (1U << 22)
#define RCC_PLLCFGR_Q(q) ((q) << 24)
#define RCC_CFGR (RCC + 0x08U)
#define RCC_CFGR_SW 3U
#define RCC_CFGR_SW_HSI 0U
#define RCC_CFGR_SW_PLL 2U
#define RCC_CFGR_SWS (3U << 2)
#define RCC_CFGR_SWS_HSI (0U << 2)
#define RCC_CFGR_SWS_PLL (2U << 2)
#define RCC_CFGR_PPRE1_4 (5U << 10)
#define RCC_CFGR_PPRE2_2 (4U << 13)
#define RCC_CIR (RCC + 0x0CU)
#define RCC_AHB1ENR (RCC + 0x30U)
#define RCC_AHB1ENR_DMA2 (1U << 22)
#define RCC_APB1ENR (RCC + 0x40U)
#define RCC_APB1ENR_TIM2 (1U << 0)
#define RCC_APB1ENR_TIM3 (1U << 1)
#define RCC_APB1ENR_PWR (1U << 28)
#define RCC_APB2ENR (RCC + 0x44U)
#define RCC_APB2ENR_TIM1 (1U << 0)
#define RCC_APB2ENR_USART6 (1U << 5)
#define RCC_APB2ENR_ADC1 (1U << 8)
#define RCC_CSR (RCC + 0x74U)
#define RCC_CSR_RMVF (1U << 24) /* clears the reset flags */
#define RCC_CSR_BORRSTF (1U << 25)
#define RCC_CSR_PINRSTF (1U << 26)
#define RCC_CSR_PORRSTF (1U << 27)
#define RCC_CSR_SFTRSTF (1U << 28)
#define RCC_CSR_IWDGRSTF (1U << 29)
#define RCC_CSR_WWDGRSTF (1U << 30)
#define RCC_CSR_LPWRRSTF (1U << 31)

/* Flash interface, 3.9. */
#define FLASH_ACR 0x40023C00U
#define FLASH_ACR_LATENCY 7U
#define FLASH_ACR_ICEN (1U << 9)
#define FLASH_ACR_DCEN (1U << 10)
#define FLASH_ACR_DCRST (1U << 12)
#define FLASH_KEYR 0x40023C04U
#define FLASH_KEY1 0x45670123U
#define FLASH_KEY2 0xCDEF89ABU
#define FLASH_OPTKEYR 0x40023C08U
#define FLASH_OPTKEY1 0x08192A3BU
#define FLASH_OPTKEY2 0x4C5D6E7FU
#define FLASH_SR 0x40023C0CU
/* Error bits: operation, protection, alignment, size, sequence. Writing a one clears a bit. */
#define FLASH_SR_ERRORS 0xF2U
#define FLASH_SR_BSY (1U << 16)
#define FLASH_CR 0x40023C10U
#define FLASH_CR_PG (1U << 0)
#define FLASH_CR_SER (1U << 1)
#define FLASH_CR_SNB(sector) ((sector) << 3)
#define FLASH_CR_PSIZE_32 (2U << 8) /* allowed from 2.7 V on */
#define FLASH_CR_STRT (1U << 16)
#define FLASH_CR_LOCK (1U << 31)
#define FLASH_OPTCR 0x40023C14U
#define FLASH_OPTCR_OPTLOCK (1U << 0)
#define FLASH_OPTCR_OPTSTRT (1U << 1)
#define FLASH_OPTCR_BOR_LEV (3U << 2)
#define FLASH_OPTCR_BOR_LEV_3 (0U << 2) /* reset below 2.7 V */

/* General purpose ports, 8.4. A pin is one number: 16 times its port (A is 0) plus its number in the port. */
#define PIN(port, number) ((unsigned)((port) - 'A') * 16U + (number))
#define GPIO_MODER(port) (0x40020000U + 0x400U * (port) + 0x00U)
#define GPIO_PUPDR(port) (0x40020000U + 0x400U * (port) + 0x0CU)
#define GPIO_IDR(port) (0x40020000U + 0x400U * (port) + 0x10U)
#define GPIO_BSRR(port) (0x40020000U + 0x400U * (port) + 0x18U)
#define GPIO_AFR(port, half) (0x40020000U + 0x400U * (port) + 0x20U + 4U * (half))

/* DMA controller 2 (RM0090, 10.5). ADC1 uses channel 0 of stream 0. */
#define DMA2_LIFCR 0x40026408U
#define DMA2_S0_ALL_FLAGS 0x3DU
#define DMA2_S0CR 0x40026410U
#define DMA2_S0NDTR 0x40026414U
#define DMA2_S0PAR 0x40026418U
#define DMA2_S0M0AR 0x4002641CU
#define DMA_CR_EN (1U << 0)
#define DMA_CR_HTIE (1U << 3)
#define DMA_CR_TCIE (1U << 4)
#define DMA_CR_CIRC (1U << 8)
#define DMA_CR_MINC (1U << 10)
#define DMA_CR_PSIZE_16 (1U << 11)
#define DMA_CR_MSIZE_16 (1U << 13)
#define DMA_CR_PRIORITY_HIGH (2U << 16)

/* Analogue-to-digital converter 1, 13.13. */
#define ADC1_CR1 0x40012004U
#define ADC_CR1_SCAN (1U << 8)
#define ADC1_CR2 0x40012008U
#define ADC_CR2_ADON (1U << 0)
#define ADC_CR2_DMA (1U << 8)
#define ADC_CR2_DDS (1U << 9)
#define ADC_CR2_EXTSEL_TIM3_TRGO (8U << 24)
#define ADC_CR2_EXTEN_RISING (1U << 28)
#define ADC1_SMPR1 0x4001200CU
#define ADC1_SMPR2 0x40012010U
#define ADC_SMP_84 4U
#define ADC1_SQR1 0x4001202CU
#define ADC_SQR1_LENGTH(n) (((n)-1U) << 20)
#define ADC1_SQR3 0x40012034U
#define ADC1_DR 0x4001204CU
#define ADC_CCR 0x40012304U
#define ADC_CCR_ADCPRE_4 (1U << 16)

/* Advanced timer 1, 17.4. */
#define TIM1 0x40010000U
/* General purpose timers 2 and 3, 18.4. */
#define TIM2 0x40000000U
#define TIM3 0x40000400U
#define TIM_CR1(timer) ((timer) + 0x00U)
#define TIM_CR1_CEN (1U << 0)
#define TIM_CR1_CKD_4 (2U << 8) /* the filters sample at a quarter of the timer's clock */
#define TIM_CR2(timer) ((timer) + 0x04U)
#define TIM_CR2_MMS_UPDATE (2U << 4)
#define TIM_DIER(timer) ((timer) + 0x0CU)
#define TIM_SR(timer) ((timer) + 0x10U)
#define TIM_SR_CCIF(channel) (1U << (channel)) /* for channels 1 to 4 */
#define TIM_SR_BIF (1U << 7)
#define TIM_EGR(timer) ((timer) + 0x14U)
#define TIM_EGR_UG (1U << 0)
/* half 0: channels 1 and 2; half 1: 3 and 4 */
#define TIM_CCMR(timer, half) ((timer) + 0x18U + 4U * (half))
#define TIM_CCMR_OC1M_PWM_1 (6U << 4)
#define TIM_CCMR_CAPTURE 1U                /* captures the channel's own input */
#define TIM_CCMR_CAPTURE_OTHER 2U          /* captures the other input of the channel's pair */
#define TIM_CCMR_FILTER_SLOWEST (15U << 4) /* 8 samples at 1/32 of the sampling rate */
#define TIM_CCER(timer) ((timer) + 0x20U)
#define TIM_CCER_CC1NE (1U << 2)
#define TIM_CCER_CCE(channel) (1U << (4U * ((channel)-1U)))
#define TIM_CCER_CCP(channel) (2U << (4U * ((channel)-1U))) /* captures falling edges */
#define TIM_CNT(timer) ((timer) + 0x24U)
#define TIM_PSC(timer) ((timer) + 0x28U)
#define TIM_ARR(timer) ((timer) + 0x2CU)
#define TIM_CCR(timer, channel) ((timer) + 0x30U + 4U * (channel))
#define TIM_BDTR(timer) ((timer) + 0x44U)
#define TIM_BDTR_LOCK_2 (2U << 8)
#define TIM_BDTR_OSSI (1U << 10)
#define TIM_BDTR_OSSR (1U << 11)
#define TIM_BDTR_BKE (1U << 12) /* active low, because BKP is 0 */
#define TIM_BDTR_MOE (1U << 15)

/* Independent watchdog, 21.4. */
#define IWDG_KR 0x40003000U
#define IWDG_KR_RELOAD 0xAAAAU
#define IWDG_KR_UNLOCK 0x5555U
#define IWDG_KR_START 0xCCCCU
#define IWDG_PR 0x40003004U
#define IWDG_RLR 0x40003008U
#define IWDG_SR 0x4000300CU

/* Serial interface 6, 30.6. */
#define USART_SR 0x40011400U
#define USART_SR_FE (1U << 1)
#define USART_SR_NF (1U << 2)
#define USART_SR_ORE (1U << 3)
#define USART_SR_RXNE (1U << 5)
#define USART_SR_TXE (1U << 7)
#define USART_DR 0x40011404U
#define USART_BRR 0x40011408U
#define USART_CR1 0x4001140CU
#define USART_CR1_RE (1U << 2)
#define USART_CR1_TE (1U << 3)
#define USART_CR1_RXNEIE (1U << 5)
#define USART_CR1_TXEIE (1U << 7)
#define USART_CR1_UE (1U << 13)

/* Debug support, 38.16: peripherals that stop while the core is halted. */
#define DBGMCU_APB1_FZ 0xE0042008U
#define DBGMCU_APB1_FZ_IWDG (1U << 12)
#define DBGMCU_APB2_FZ 0xE004200CU
#define DBGMCU_APB2_FZ_TIM1 (1U << 0)

/* Interrupts that a driver handles: X(number, name). */
#define STM32F4_INTERRUPTS 82
#define STM32F4_VECTOR_ROWS(X) \
    X(28, tim2) \
    X(56, dma2_stream0) \
    X(71, usart6)

/* The core's interrupt controller (Armv7-M manual, B3.4): enable bits, and one byte of priority for each interrupt. */
#define NVIC_ISER(word) (0xE000E100U + 4U * (word))
#define NVIC_IPR(word) (0xE000E400U + 4U * (word))

#endif
