/* chip.h: a model of an STM32F405 on the PC. It implements the parts that the drivers of boards/stm32f4 use, from the reference
 * manual (ST RM0090) and data sheet (DS8626) alone, not from the drivers. Time passes with each access to a register and when a
 * test lets it pass. Interrupts come between accesses. An action that the manual forbids is a violation: it is counted, and the
 * first is recorded in words.
 *
 * Each start of the chip restores the drivers' variables from the image (drivers_as_flashed()), so a reset is one for them
 * too. */
#ifndef TESTS_CHIP_CHIP_H
#define TESTS_CHIP_CHIP_H

#include <stdbool.h>
#include <stdint.h>

/* Time: units that divide every clock of the chip. */
#define CHIP_UNITS_PER_S UINT64_C(8400000000)
#define CHIP_UNITS_PER_US UINT64_C(8400)
#define CHIP_NEVER UINT64_MAX

typedef enum chip_cause {
    CHIP_BY_POWER, /* power-on: volatile memories are lost */
    CHIP_BY_DIP,   /* the supply dipped below the brown-out level, not below power-down */
    CHIP_BY_PIN,
    CHIP_BY_WATCHDOG,
    CHIP_BY_SOFTWARE /* the core's own SYSRESETREQ */
} chip_cause;

typedef enum chip_end {
    CHIP_RETURNED,
    CHIP_RESET,     /* the chip has been reset; chip_start() restarts it */
    CHIP_POWER_OFF, /* as ordered by chip_power_off_after() */
    CHIP_HANGS      /* longer than chip_may_take() */
} chip_end;

typedef enum chip_counter {
    CHIP_COUNTS,
    CHIP_NO_COUNTER,   /* DWT_CTRL.NOCYCCNT */
    CHIP_COUNTER_STILL /* the counter does not count, as in emulators */
} chip_counter;

/* The world around the chip. A test may change all of it at any time; the crystal stops only by chip_crystal_stops(). */
typedef struct chip_world {
    uint32_t crystal_Hz;
    bool crystal;           /* the crystal oscillates */
    uint64_t crystal_units; /* the crystal's start-up time */
    bool pll;               /* the PLL locks */
    uint64_t watchdog_Hz;   /* LSI: 17 to 47 kHz */
    bool
        /* does a halt of the counter disable a timer's outputs? Not verified on this chip */
        halt_disables;
    double (*volts)(unsigned input, double s); /* voltage at an ADC1 input, at a time; NULL: 0 */
    double vdda_V;
    chip_counter counter;
    unsigned access_cycles; /* core cycles of each register access and the code around it */
} chip_world;
extern chip_world world;

/* A new chip of typical properties: erased flash, factory option bytes, no power yet. */
void chip_new(uint64_t seed);
/* Power-on or another reset. The pins have the levels that the world drives. */
void chip_reset(chip_cause cause);
unsigned chip_resets(void); /* count since the chip was new */

/* The drivers' variables get the values of the flashed image; board_clock_start() has run before. */
void drivers_as_flashed(void);

/* Runs the program until a reset, the end of power or the time limit. Not nestable. */
chip_end chip_try(void (*what)(void));
chip_end chip_try_with(void (*what)(void *), void *with);
void chip_may_take(uint64_t units); /* limit of chip_try() from its start (default 5 s) */
/* Power fails in place of a later store: 0 means the next store, 1 the one after it. */
void chip_power_off_after(unsigned stores);
void chip_power_off_at(uint64_t when); /* power fails at this time */
void chip_power_stays(void);
unsigned chip_stores(void);
/* Called after each store; NULL: no call. */
extern void (*chip_stored)(void);
bool chip_is_masked(void);

uint64_t chip_now(void);
double chip_s(void);
void chip_pass(uint64_t units); /* takes interrupts while the program idles */
void chip_pass_us(uint64_t us);
/* The core is halted by a debugger and takes no interrupt. */
void chip_halt(bool halted);

/* Number of violations since the chip was new, and the first of them in words. */
unsigned chip_violations(void);
const char *chip_violation(void);
void chip_forgive(void);

/* A pin's external drive. CHIP_OPEN leaves it to a resistor. */
typedef enum chip_level { CHIP_LOW, CHIP_HIGH, CHIP_OPEN } chip_level;
typedef enum chip_resistor { CHIP_NO_RESISTOR, CHIP_TO_GROUND, CHIP_TO_SUPPLY } chip_resistor;
void chip_pin_drive(char port, unsigned pin, chip_level level);
void chip_pin_drive_at(uint64_t when, char port, unsigned pin,
                       chip_level level); /* `when` is not before earlier ones */
void chip_pin_resistor(char port, unsigned pin, chip_resistor resistor);
chip_level chip_pin(char port, unsigned pin); /* CHIP_OPEN: undriven */

typedef struct chip_clocks {
    uint32_t core_Hz, apb1_Hz, apb2_Hz, timers1_Hz, timers2_Hz;
} chip_clocks;
chip_clocks chip_clocks_now(void);
void chip_crystal_stops(void);
bool chip_nmi_taken(void);

/* Sets TIM2's counter, to reach values that would take an hour. */
void chip_tim2_count_is(uint32_t count);
uint32_t chip_tim2_count(void);
uint64_t chip_tim1_tick_units(void);
uint32_t chip_tim1_period_ticks(void);

/* The bus is busy: DMA takes the next value too late, so the ADC overruns. */
void chip_adc_overruns(void);

/* Serial line of USART6. A received byte comes at the end of its stop bit. Sent bytes are recorded with the time of their end. */
void chip_serial_comes(uint64_t when, uint8_t byte);
/* A byte that sets these flags of SR: 2 a framing error, 4 noise. */
void chip_serial_comes_as(uint64_t when, uint8_t byte, uint8_t flags);
unsigned chip_serial_sent(void);
uint8_t chip_serial_byte(unsigned at);
uint64_t chip_serial_byte_units(void); /* at the present baud rate */

/* Flash: 1 MB from 0x08000000, and the option bytes. */
uint8_t chip_flash_byte(uint32_t address);
void chip_flash_byte_is(uint32_t address, uint8_t byte);
unsigned chip_flash_erases(unsigned sector);
void chip_protect_sector(unsigned sector); /* sets the sector's option byte */
unsigned chip_option_writes(void);
bool chip_options_are_locked(void);
uint32_t chip_option_bytes(void); /* bits of FLASH_OPTCR, as loaded at power-on */

/* Interrupts taken since the chip was new, by number. */
unsigned long chip_interrupts(unsigned number);

#endif
