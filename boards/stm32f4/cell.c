/* cell.c: load cell and supply by the chip's 12-bit converter (RM0090, 13 and 10).
 *
 * Timer 3 starts 32,000 pairs of conversions per second: first the load, then the supply. DMA interrupts after every 64
 * pairs (2 ms). A sample is the mean of 64 loads, with the middle of the 64 conversions as its time stamp. A sample
 * waits for the next mean, because the correction of a mean needs the means before and after (hal/averaged.h). One
 * count of the converter is 109 mN; the unit of a sample is 6.8 mN.
 *
 * Without force, the amplifier's output is half of the reference. If a wire is broken, a resistor pulls the pin down,
 * and the mean is below OPEN_BELOW. */
#include "hal/averaged.h"
#include "hal/loadcell.h"
#include "hal/motor.h"

#include "boards/board.h"
#include "ring.h"
#include "stm32f4.h"

#define DMA2_STREAM0_IRQ 56U
#define PAIRS 64U
#define PAIRS_PER_S 32000U
#define PAIRS_TICKS (PAIRS * (BOARD_TICKS_PER_S / 1000U) / (PAIRS_PER_S / 1000U))
_Static_assert(PAIRS_TICKS == HAL_LOADCELL_PERIOD_TICKS, "a sample each period");

/* Time from the middle of the 64 load conversions to the interrupt, which comes 5 us after the last load. */
#define BEHIND_TICKS (PAIRS_TICKS / 2U - (PAIRS_TICKS / PAIRS + 1U) / 2U + 5U)

/* highest clock of the converter (STM32F405's data sheet, table 67) */
#define ADC_HZ_MOST 36000000U

#define FULL 4095U
#define MIDDLE 2048
#define RAIL (FULL / 64U)       /* within 51 mV of either end no amplifier is linear */
#define OPEN_BELOW (FULL / 16U) /* an input below 0.2 V is not connected */

/* If one conversion of the supply exceeds this limit, the mean is invalid. */
#define SUPPLY_END (FULL - RAIL)
#define SUPPLY_V_PER_COUNT ((float)BOARD_SUPPLY_FULL_mV / 1000.0f / (float)FULL)
_Static_assert(HAL_MOTOR_SUPPLY_IS_SEEN(BOARD_SUPPLY_MOST_mV,
                                        BOARD_SUPPLY_FULL_mV *SUPPLY_END / FULL),
               "the board's measurement ends too near to its limit");

#define SAMPLES_KEPT 8U

/* Marks a missing mean; the converter never has this status. */
#define NO_MEAN HAL_LOAD_REPEATED

/* Not in core-coupled memory, which DMA cannot reach (RM0090, 2.3.1). */
static volatile uint16_t pair[2][PAIRS][2];
static hal_load_sample kept_samples[SAMPLES_KEPT];
static stm32f4_ring_counts sample_counts;
static const stm32f4_ring samples = {&sample_counts, kept_samples, SAMPLES_KEPT,
                                     sizeof *kept_samples};
static volatile uint32_t supply_sum; /* UINT32_MAX: a conversion was above SUPPLY_END */

static hal_load_sample last;
static int32_t before_last; /* `raw` of the mean before `last` */
static bool last_follows;   /* the last two means are successive */

static void start_dma(void) {
    stm32f4_clock_on(RCC_PART(RCC_AHB1ENR, RCC_AHB1ENR_DMA2));
    reg_store(DMA2_S0CR, 0);
    reg_store(DMA2_LIFCR, DMA2_S0_ALL_FLAGS);
    reg_store(DMA2_S0PAR, ADC1_DR);
    reg_store(DMA2_S0M0AR, reg_address(pair));
    reg_store(DMA2_S0NDTR, 2U * PAIRS * 2U);
    const uint32_t settings = DMA_CR_PRIORITY_HIGH | DMA_CR_MSIZE_16 | DMA_CR_PSIZE_16 |
                              DMA_CR_MINC | DMA_CR_CIRC | DMA_CR_TCIE | DMA_CR_HTIE;
    reg_store(DMA2_S0CR, settings);
    reg_store(DMA2_S0CR, settings | DMA_CR_EN);
}

/* Sampling takes 84 clocks, and conversion 12: together 4.6 us at 21 MHz, or 12 us at the fallback clock's 8 MHz. */
static inline void sample_for(unsigned input) {
    stm32f4_field(input < 10U ? ADC1_SMPR2 : ADC1_SMPR1, 3U, input % 10U, ADC_SMP_84);
}

static void start_converter(void) {
    stm32f4_clock_on(RCC_PART(RCC_APB2ENR, RCC_APB2ENR_ADC1));
    stm32f4_pin_is(BOARD_CELL_PIN, PIN_ANALOGUE);
    stm32f4_pin_is(BOARD_SUPPLY_PIN, PIN_ANALOGUE);
    if (stm32f4_clocks_now()->usart_Hz > 2U * ADC_HZ_MOST) {
        /* half of APB2's clock, which a reset selects, would be too fast */
        reg_store(ADC_CCR, ADC_CCR_ADCPRE_4);
    }
    sample_for(BOARD_CELL_INPUT);
    sample_for(BOARD_SUPPLY_INPUT);
    reg_store(ADC1_SQR1, ADC_SQR1_LENGTH(2U));
    reg_store(ADC1_SQR3, BOARD_CELL_INPUT | BOARD_SUPPLY_INPUT << 5);
    reg_store(ADC1_CR1, ADC_CR1_SCAN);
    reg_store(ADC1_CR2, ADC_CR2_EXTEN_RISING | ADC_CR2_EXTSEL_TIM3_TRGO | ADC_CR2_DDS |
                            ADC_CR2_DMA | ADC_CR2_ADON);
}

void stm32f4_cell_start(void) {
    last.status = NO_MEAN;
    start_dma();
    start_converter();
    stm32f4_interrupt(DMA2_STREAM0_IRQ);
    /* Timer 3 triggers the converter, so the timer starts last. */
    stm32f4_clock_on(RCC_PART(RCC_APB1ENR, RCC_APB1ENR_TIM3));
    reg_store(TIM_PSC(TIM3), 0);
    reg_store(TIM_ARR(TIM3), stm32f4_clocks_now()->timers_Hz / PAIRS_PER_S - 1U);
    reg_store(TIM_CR2(TIM3), TIM_CR2_MMS_UPDATE);
    reg_store(TIM_CR1(TIM3), TIM_CR1_CEN);
}

/* True if both means are good, and the converter was not interrupted between them. */
static bool follows(const hal_load_sample *before, const hal_load_sample *sample) {
    const uint32_t passed = sample->ticks - before->ticks;
    return before->status == HAL_LOAD_OK && sample->status == HAL_LOAD_OK &&
           passed > PAIRS_TICKS / 2U && passed < PAIRS_TICKS + PAIRS_TICKS / 2U;
}

/* Delivers `last`, corrected with `before_last` and `mean`. */
static void hand_on(const hal_load_sample *mean) {
    const bool mean_follows = follows(&last, mean);
    if (last.status != NO_MEAN) {
        hal_load_sample sample = last;
        if (last_follows && mean_follows) {
            sample.raw = hal_averaged_middle(before_last, last.raw, mean->raw);
        }
        (void)stm32f4_ring_put(&samples, &sample);
    }
    before_last = last.raw;
    last = *mean;
    last_follows = mean_follows;
}

/* Averages a half of DMA's memory. Four units of the sum are one count of hal/loadcell.h. */
static void average(unsigned half, uint32_t ticks) {
    uint32_t sum = 0;
    uint32_t supply = 0;
    bool clipped = false;
    bool beyond = false;
    for (unsigned i = 0; i < PAIRS; i++) {
        const uint32_t count = pair[half][i][0];
        sum += count;
        supply += pair[half][i][1];
        beyond = beyond || pair[half][i][1] > SUPPLY_END;
        /* near either end */
        clipped = clipped || count - RAIL > FULL - 2U * RAIL;
    }
    supply_sum = beyond ? UINT32_MAX : supply;
    const hal_load_sample mean = {.ticks = ticks,
                                  .raw = ((int32_t)sum - (int32_t)PAIRS * MIDDLE) / 4,
                                  .status =
                                      (uint8_t)(sum < PAIRS * OPEN_BELOW ? HAL_LOAD_DISCONNECTED
                                                : clipped                ? HAL_LOAD_SATURATED
                                                                         : HAL_LOAD_OK)};
    hand_on(&mean);
}

void on_dma2_stream0(void) {
    const uint32_t now = board_ticks();
    reg_store(DMA2_LIFCR, DMA2_S0_ALL_FLAGS);
    const uint32_t laid = (2U * PAIRS * 2U - reg_load(DMA2_S0NDTR)) / 2U;
    average(laid < PAIRS ? 1U : 0U, now - BEHIND_TICKS - laid % PAIRS * PAIRS_TICKS / PAIRS);
}

bool hal_loadcell_take(hal_load_sample *sample) { return stm32f4_ring_take(&samples, sample); }

float hal_motor_supply_V(void) {
    const uint32_t sum = supply_sum;
    return sum == UINT32_MAX ? HAL_MOTOR_SUPPLY_BEYOND
                             : (float)sum * (SUPPLY_V_PER_COUNT / (float)PAIRS);
}

float hal_motor_supply_most_V(void) { return (float)BOARD_SUPPLY_MOST_mV / 1000.0f; }
