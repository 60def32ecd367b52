/* inner.h: interfaces between the parts of the chip model. */
#ifndef TESTS_CHIP_INNER_H
#define TESTS_CHIP_INNER_H

#include "tests/chip/chip.h"

/* Addresses: RM0090, table 1 (memory map). */
#define AT_TIM2 0x40000000U
#define AT_TIM3 0x40000400U
#define AT_IWDG 0x40003000U
#define AT_PWR 0x40007000U
#define AT_TIM1 0x40010000U
#define AT_USART6 0x40011400U
#define AT_ADC1 0x40012000U
#define AT_SYSCFG 0x40013800U
#define AT_EXTI 0x40013C00U
#define AT_GPIOA 0x40020000U
#define AT_RCC 0x40023800U
#define AT_FLASH 0x40023C00U
#define AT_DMA2 0x40026400U
#define AT_FLASH_MEMORY 0x08000000U
#define FLASH_MEMORY_BYTES 0x100000U
#define AT_RAM 0x20000000U
#define AT_DBGMCU 0xE0042000U
#define AT_NVIC 0xE000E100U
#define AT_SCB 0xE000ED00U
#define AT_DWT 0xE0001000U
#define AT_CORE_DEBUG 0xE000EDF0U

#define BIT(n) (UINT32_C(1) << (n))
#define FIELD(value, low, bits) (((value) >> (low)) & ((UINT32_C(1) << (bits)) - 1U))

/* A part of the chip: registers at an address, the clock that they need, and the part's events. All members except
 * name, base and bytes may be NULL. */
typedef struct part {
    const char *name;
    uint32_t base;
    uint32_t bytes;
    uint32_t clock_register; /* offset in RCC; 0: no clock register */
    uint32_t clock_bit;
    uint32_t (*load)(uint32_t offset);
    void (*store)(uint32_t offset, uint32_t value);
    void (*reset)(void);                 /* resets the part; reset_by is the cause */
    uint64_t (*next)(void);              /* time of the part's next event */
    void (*happens)(void);               /* handles the event of next() */
    bool (*pending)(unsigned interrupt); /* true if the part requests this interrupt */
} part;

extern const part rcc_part, pwr_part, flash_part, flash_memory_part, gpio_part, tim1_part,
    tim2_part, tim3_part, adc_part, dma_part, usart_part, iwdg_part, nvic_part, scb_part,
    dbgmcu_part, dwt_part, core_debug_part;

/* Implemented by chip.c: */
extern chip_cause reset_by; /* cause of the last reset */
/* If `broken`, counts a violation of the manual, and keeps the words of the first one. */
__attribute__((format(printf, 2, 3))) void forbid_if(bool broken, const char *words, ...);
#define forbidden(...) forbid_if(true, __VA_ARGS__)
uint64_t now_units(void);
bool core_halted(void);
uint64_t drawn(void); /* a random number */
/* Resets the chip. Within chip_try() it does not return. */
void core_resets(chip_cause cause);
volatile void *memory_at(uint32_t address); /* set by reg_address() */

/* Implemented by rcc.c: frequencies in Hz; 0: the clock does not run. */
uint32_t core_Hz(void);
uint32_t apb1_timer_Hz(void);
uint32_t apb2_timer_Hz(void);
uint32_t apb2_Hz(void);
bool part_is_clocked(const part *which);
bool pll_is_on(void);
bool lsi_is_on(void);
void lsi_forced(void);             /* the watchdog calls this */
uint64_t units_of(uint32_t hertz); /* units of time in a period */
/* rcc.c calls these before and after a change of clocks. */
void timers_hold_counts(void);
void timers_go_on(void);
void tim1_hold_count(void);
void tim1_go_on(void);
bool nmi_pending(void);

/* Implemented by flash.c: */
void flash_clock_is(uint32_t hertz);
bool flash_busy(void);
uint64_t flash_busy_until(void);
void flash_power_goes(void);
void flash_new(void);

/* Implemented by gpio.c: whether a function is selected at a pin, and the level of a pin as its input reads it. */
bool pin_is_function(unsigned port, unsigned pin, unsigned function);
bool pin_is_analogue(unsigned port, unsigned pin);
bool pin_input(unsigned port, unsigned pin);
void pins_changed(void); /* call it when an output has changed */
void pins_new(void);

/* Implemented by tim1.c: the level that TIM1_CH1N drives at PB13. CHIP_OPEN: it drives none. */
chip_level tim1_ch1n(void);
void tim1_break_input(void);  /* call it when the pin may have changed */
void tim1_clock_failed(void); /* the clock security system calls this */

/* Implemented by timers.c: */
void tim2_input(unsigned channel, bool high); /* channels 1 to 4 */

/* Implemented by adc.c: TIM3's update triggers the converter. `event` is its EXTSEL number. */
void adc_trigger(unsigned event);
bool adc_dma_takes(uint16_t *value);
void dma_request_adc(void);

/* Implemented by rcc.c: true if this bit of DBGMCU stops a clock while a debugger holds the core. */
bool debug_stops(uint32_t offset, unsigned bit);

/* Implemented by iwdg.c. iwdg_holds(): a debugger holds the core; iwdg_goes_on(): it is about to release the core. */
void iwdg_holds(void);
void iwdg_goes_on(void);

void usart_new(void);
void iwdg_new(void);
void tim1_new(void);

#endif
