/* test_chip_constants.c: compares every constant of boards/stm32f4/rm0090.h, which the author took from the manual,
 * with a second source. ST's header for the chip (stm32f405xx.h of STM32CubeF4) gives bases, offsets and interrupts.
 * Headers generated from ST's SVD files give clocks, flash, timers, DMA, converter, serial interface, watchdog and
 * debug. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "tests/suites.h"

#include "boards/stm32f4/rm0090.h"

/* Base addresses, with the names of the second source. */
#define APB1 0x40000000U
#define APB2 0x40010000U
#define AHB1 0x40020000U

static const struct {
    const char *name;
    uint32_t ours, theirs;
} rows[] = {
#define ROW(name, value) \
    { #name, (name), (value) }
    ROW(PWR_CR, APB1 + 0x7000U),
    ROW(PWR_CR_VOS, 0x4000U),
    ROW(RCC, AHB1 + 0x3800U),
    ROW(RCC_CR, AHB1 + 0x3800U),
    ROW(RCC_CR_HSION, 0x1U),
    ROW(RCC_CR_HSIRDY, 0x2U),
    ROW(RCC_CR_HSEON, 0x10000U),
    ROW(RCC_CR_HSERDY, 0x20000U),
    ROW(RCC_CR_HSEBYP, 0x40000U),
    ROW(RCC_CR_CSSON, 0x80000U),
    ROW(RCC_CR_PLLON, 0x1000000U),
    ROW(RCC_CR_PLLRDY, 0x2000000U),
    ROW(RCC_PLLCFGR, AHB1 + 0x3804U),
    ROW(RCC_PLLCFGR_N(1U), 0x40U),
    ROW(RCC_PLLCFGR_N(0x1FFU), 0x7FC0U),
    ROW(RCC_PLLCFGR_P_2, 0x0U),
    ROW(RCC_PLLCFGR_HSE, 0x400000U),
    ROW(RCC_PLLCFGR_Q(1U), 0x1000000U),
    ROW(RCC_PLLCFGR_Q(15U), 0xF000000U),
    ROW(RCC_CFGR, AHB1 + 0x3808U),
    ROW(RCC_CFGR_SW, 0x3U),
    ROW(RCC_CFGR_SW_HSI, 0x0U),
    ROW(RCC_CFGR_SW_PLL, 0x2U),
    ROW(RCC_CFGR_SWS, 0xCU),
    ROW(RCC_CFGR_SWS_HSI, 0x0U),
    ROW(RCC_CFGR_SWS_PLL, 0x8U),
    ROW(RCC_CFGR_PPRE1_4, 0x1400U),
    ROW(RCC_CFGR_PPRE2_2, 0x8000U),
    ROW(RCC_CIR, AHB1 + 0x380CU),
    ROW(RCC_AHB1ENR, AHB1 + 0x3830U),
    ROW(RCC_AHB1ENR_DMA2, 0x400000U),
    ROW(RCC_APB1ENR, AHB1 + 0x3840U),
    ROW(RCC_APB1ENR_TIM2, 0x1U),
    ROW(RCC_APB1ENR_TIM3, 0x2U),
    ROW(RCC_APB1ENR_PWR, 0x10000000U),
    ROW(RCC_APB2ENR, AHB1 + 0x3844U),
    ROW(RCC_APB2ENR_TIM1, 0x1U),
    ROW(RCC_APB2ENR_USART6, 0x20U),
    ROW(RCC_APB2ENR_ADC1, 0x100U),
    ROW(RCC_CSR, AHB1 + 0x3874U),
    ROW(RCC_CSR_RMVF, 0x1000000U),
    ROW(RCC_CSR_BORRSTF, 0x2000000U),
    ROW(RCC_CSR_PINRSTF, 0x4000000U),
    ROW(RCC_CSR_PORRSTF, 0x8000000U),
    ROW(RCC_CSR_SFTRSTF, 0x10000000U),
    ROW(RCC_CSR_IWDGRSTF, 0x20000000U),
    ROW(RCC_CSR_WWDGRSTF, 0x40000000U),
    ROW(RCC_CSR_LPWRRSTF, 0x80000000U),
    ROW(FLASH_ACR, AHB1 + 0x3C00U),
    ROW(FLASH_ACR_LATENCY, 0x7U),
    ROW(FLASH_ACR_ICEN, 0x200U),
    ROW(FLASH_ACR_DCEN, 0x400U),
    ROW(FLASH_ACR_DCRST, 0x1000U),
    ROW(FLASH_KEYR, AHB1 + 0x3C04U),
    ROW(FLASH_KEY1, 0x45670123U),
    ROW(FLASH_KEY2, 0xCDEF89ABU),
    ROW(FLASH_OPTKEYR, AHB1 + 0x3C08U),
    ROW(FLASH_OPTKEY1, 0x08192A3BU),
    ROW(FLASH_OPTKEY2, 0x4C5D6E7FU),
    ROW(FLASH_SR, AHB1 + 0x3C0CU),
    ROW(FLASH_SR_ERRORS, 0x2U | 0x10U | 0x20U | 0x40U | 0x80U),
    ROW(FLASH_SR_BSY, 0x10000U),
    ROW(FLASH_CR, AHB1 + 0x3C10U),
    ROW(FLASH_CR_PG, 0x1U),
    ROW(FLASH_CR_SER, 0x2U),
    ROW(FLASH_CR_SNB(1U), 0x8U),
    ROW(FLASH_CR_SNB(15U), 0x78U),
    ROW(FLASH_CR_PSIZE_32, 0x200U),
    ROW(FLASH_CR_STRT, 0x10000U),
    ROW(FLASH_CR_LOCK, 0x80000000U),
    ROW(FLASH_OPTCR, AHB1 + 0x3C14U),
    ROW(FLASH_OPTCR_OPTLOCK, 0x1U),
    ROW(FLASH_OPTCR_OPTSTRT, 0x2U),
    ROW(FLASH_OPTCR_BOR_LEV, 0xCU),
    ROW(FLASH_OPTCR_BOR_LEV_3, 0x0U),
    ROW(PIN('A', 0U), 0U),
    ROW(PIN('C', 7U), 39U),
    ROW(GPIO_MODER(0U), AHB1),
    ROW(GPIO_MODER(8U), AHB1 + 0x2000U),
    ROW(GPIO_PUPDR(1U), AHB1 + 0x40CU),
    ROW(GPIO_IDR(2U), AHB1 + 0x810U),
    ROW(GPIO_BSRR(1U), AHB1 + 0x418U),
    ROW(GPIO_AFR(2U, 0U), AHB1 + 0x820U),
    ROW(GPIO_AFR(2U, 1U), AHB1 + 0x824U),
    ROW(DMA2_LIFCR, AHB1 + 0x6408U),
    ROW(DMA2_S0_ALL_FLAGS, 0x1U | 0x4U | 0x8U | 0x10U | 0x20U),
    ROW(DMA2_S0CR, AHB1 + 0x6410U),
    ROW(DMA2_S0NDTR, AHB1 + 0x6414U),
    ROW(DMA2_S0PAR, AHB1 + 0x6418U),
    ROW(DMA2_S0M0AR, AHB1 + 0x641CU),
    ROW(DMA_CR_EN, 0x1U),
    ROW(DMA_CR_HTIE, 0x8U),
    ROW(DMA_CR_TCIE, 0x10U),
    ROW(DMA_CR_CIRC, 0x100U),
    ROW(DMA_CR_MINC, 0x400U),
    ROW(DMA_CR_PSIZE_16, 0x800U),
    ROW(DMA_CR_MSIZE_16, 0x2000U),
    ROW(DMA_CR_PRIORITY_HIGH, 0x20000U),
    ROW(ADC1_CR1, APB2 + 0x2004U),
    ROW(ADC_CR1_SCAN, 0x100U),
    ROW(ADC1_CR2, APB2 + 0x2008U),
    ROW(ADC_CR2_ADON, 0x1U),
    ROW(ADC_CR2_DMA, 0x100U),
    ROW(ADC_CR2_DDS, 0x200U),
    ROW(ADC_CR2_EXTSEL_TIM3_TRGO, 0x8000000U),
    ROW(ADC_CR2_EXTEN_RISING, 0x10000000U),
    ROW(ADC1_SMPR1, APB2 + 0x200CU),
    ROW(ADC1_SMPR2, APB2 + 0x2010U),
    ROW(ADC_SMP_84, 4U),
    ROW(ADC1_SQR1, APB2 + 0x202CU),
    ROW(ADC_SQR1_LENGTH(2U), 0x100000U),
    ROW(ADC1_SQR3, APB2 + 0x2034U),
    ROW(ADC1_DR, APB2 + 0x204CU),
    ROW(ADC_CCR, APB2 + 0x2304U),
    ROW(ADC_CCR_ADCPRE_4, 0x10000U),
    ROW(TIM1, APB2),
    ROW(TIM2, APB1),
    ROW(TIM3, APB1 + 0x400U),
    ROW(TIM_CR1(TIM3), APB1 + 0x400U),
    ROW(TIM_CR1_CEN, 0x1U),
    ROW(TIM_CR1_CKD_4, 0x200U),
    ROW(TIM_CR2(TIM1), APB2 + 0x4U),
    ROW(TIM_CR2_MMS_UPDATE, 0x20U),
    ROW(TIM_DIER(TIM1), APB2 + 0xCU),
    ROW(TIM_SR(TIM1), APB2 + 0x10U),
    ROW(TIM_SR_CCIF(1U), 0x2U),
    ROW(TIM_SR_CCIF(4U), 0x10U),
    ROW(TIM_SR_BIF, 0x80U),
    ROW(TIM_EGR(TIM1), APB2 + 0x14U),
    ROW(TIM_EGR_UG, 0x1U),
    ROW(TIM_CCMR(TIM1, 0U), APB2 + 0x18U),
    ROW(TIM_CCMR(TIM1, 1U), APB2 + 0x1CU),
    ROW(TIM_CCMR_OC1M_PWM_1, 0x60U),
    ROW(TIM_CCMR_CAPTURE, 0x1U),
    ROW(TIM_CCMR_CAPTURE_OTHER, 0x2U),
    ROW(TIM_CCER_CCP(1U), 0x2U),
    ROW(TIM_CCER_CCP(4U), 0x2000U),
    ROW(TIM_CCMR_FILTER_SLOWEST, 0xF0U),
    ROW(TIM_CCER(TIM1), APB2 + 0x20U),
    ROW(TIM_CCER_CC1NE, 0x4U),
    ROW(TIM_CCER_CCE(1U), 0x1U),
    ROW(TIM_CCER_CCE(4U), 0x1000U),
    ROW(TIM_CNT(TIM2), APB1 + 0x24U),
    ROW(TIM_PSC(TIM2), APB1 + 0x28U),
    ROW(TIM_ARR(TIM2), APB1 + 0x2CU),
    ROW(TIM_CCR(TIM2, 1U), APB1 + 0x34U),
    ROW(TIM_CCR(TIM2, 4U), APB1 + 0x40U),
    ROW(TIM_BDTR(TIM1), APB2 + 0x44U),
    ROW(TIM_BDTR_LOCK_2, 0x200U),
    ROW(TIM_BDTR_OSSI, 0x400U),
    ROW(TIM_BDTR_OSSR, 0x800U),
    ROW(TIM_BDTR_BKE, 0x1000U),
    ROW(TIM_BDTR_MOE, 0x8000U),
    ROW(IWDG_KR, APB1 + 0x3000U),
    ROW(IWDG_KR_RELOAD, 0xAAAAU),
    ROW(IWDG_KR_UNLOCK, 0x5555U),
    ROW(IWDG_KR_START, 0xCCCCU),
    ROW(IWDG_PR, APB1 + 0x3004U),
    ROW(IWDG_RLR, APB1 + 0x3008U),
    ROW(IWDG_SR, APB1 + 0x300CU),
    ROW(USART_SR, APB2 + 0x1400U),
    ROW(USART_SR_FE, 0x2U),
    ROW(USART_SR_NF, 0x4U),
    ROW(USART_SR_ORE, 0x8U),
    ROW(USART_SR_RXNE, 0x20U),
    ROW(USART_SR_TXE, 0x80U),
    ROW(USART_DR, APB2 + 0x1404U),
    ROW(USART_BRR, APB2 + 0x1408U),
    ROW(USART_CR1, APB2 + 0x140CU),
    ROW(USART_CR1_RE, 0x4U),
    ROW(USART_CR1_TE, 0x8U),
    ROW(USART_CR1_RXNEIE, 0x20U),
    ROW(USART_CR1_TXEIE, 0x80U),
    ROW(USART_CR1_UE, 0x2000U),
    ROW(DBGMCU_APB1_FZ, 0xE0042008U),
    ROW(DBGMCU_APB1_FZ_IWDG, 0x1000U),
    ROW(DBGMCU_APB2_FZ, 0xE004200CU),
    ROW(DBGMCU_APB2_FZ_TIM1, 0x1U),
    ROW(STM32F4_INTERRUPTS, 82U),
    ROW(NVIC_ISER(0U), 0xE000E100U),
    ROW(NVIC_ISER(2U), 0xE000E108U),
    ROW(NVIC_IPR(0U), 0xE000E400U),
};

TEST(chip_constants, values) {
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(rows[i].theirs, rows[i].ours, rows[i].name);
    }
}

TEST(chip_constants, interrupts) {
    static const struct {
        const char *name;
        unsigned number;
    } theirs[] = {{"tim2", 28}, {"dma2_stream0", 56}, {"usart6", 71}};
    unsigned at = 0;
#define VECTOR(is, called) \
    TEST_ASSERT_TRUE_MESSAGE(at < sizeof theirs / sizeof *theirs, #called); \
    TEST_ASSERT_EQUAL_STRING(theirs[at].name, #called); \
    TEST_ASSERT_EQUAL_MESSAGE(theirs[at].number, (is), #called); \
    at++;
    STM32F4_VECTOR_ROWS(VECTOR)
    TEST_ASSERT_EQUAL(sizeof theirs / sizeof *theirs, at);
}

TEST(chip_constants, every_constant_has_a_row) {
    FILE *file = fopen("boards/stm32f4/rm0090.h", "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, "to be run from the project's root");
    char line[256];
    unsigned seen = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, "#define ", 8) != 0) {
            continue;
        }
        const size_t length = strcspn(line + 8, " (\n");
        const bool known = strncmp(line + 8, "BOARDS_STM32F4_RM0090_H", length) == 0 ||
                           strncmp(line + 8, "STM32F4_VECTOR_ROWS", length) == 0;
        bool found = false;
        for (unsigned i = 0; i < sizeof rows / sizeof *rows && !found; i++) {
            found = strncmp(rows[i].name, line + 8, length) == 0 &&
                    (rows[i].name[length] == 0 || rows[i].name[length] == '(');
        }
        TEST_ASSERT_TRUE_MESSAGE(known || found, line);
        seen++;
    }
    (void)fclose(file);
    TEST_ASSERT_TRUE(seen > 150);
}
