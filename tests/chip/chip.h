/* chip.h: a model of an STM32F405 on the PC. It implements the parts that the drivers of boards/stm32f4 use. Its
 * sources are the reference manual (ST RM0090) and the data sheet (DS8626), not the drivers. Time passes with each
 * access to a register, and when a test lets it pass. Interrupts come between accesses. If a program does what the
 * manual forbids, that is a violation: it is counted, and the first is recorded in words.
 *
 * At each start of the chip the drivers' variables get the values of the flashed image (drivers_as_flashed()), as after
 * a real reset. */
#ifndef TESTS_CHIP_CHIP_H
#define TESTS_CHIP_CHIP_H

#include <stdbool.h>
#include <stdint.h>

/* Unit of time: a period of every clock of the chip is a whole number of these units. */
#define CHIP_UNITS_PER_S UINT64_C(8400000000)
#define CHIP_UNITS_PER_US UINT64_C(8400)
#define CHIP_NEVER UINT64_MAX

typedef enum chip_cause {
    CHIP_BY_POWER, /* power-on: volatile memories lose their content */
    CHIP_BY_DIP,   /* a supply below the brown-out level, but not below power-down */
    CHIP_BY_PIN,
    CHIP_BY_WATCHDOG,
    CHIP_BY_SOFTWARE /* the core's own SYSRESETREQ */
} chip_cause;

typedef enum chip_end {
    CHIP_RETURNED,
    CHIP_RESET,     /* the chip has been reset; chip_start() restarts it */
    CHIP_POWER_OFF, /* as requested by chip_power_off_after() */
    CHIP_HANGS      /* the program takes longer than chip_may_take() allows */
} chip_end;

typedef enum chip_counter {
    CHIP_COUNTS,
    CHIP_NO_COUNTER,   /* the chip has no counter (DWT_CTRL.NOCYCCNT) */
    CHIP_COUNTER_STILL /* the counter does not count, as in emulators */
} chip_counter;

/* The world around the chip. A test may change its members at any time. To stop a running crystal, call
 * chip_crystal_stops(). */
typedef struct chip_world {
    uint32_t crystal_Hz;
    bool crystal;           /* the crystal oscillates */
    uint64_t crystal_units; /* the crystal's start-up time */
    bool pll;               /* the PLL locks */
    uint64_t watchdog_Hz;   /* frequency of the watchdog's oscillator LSI, 17 to 47 kHz */
    bool halt_disables;     /* a debugger's halt disables TIM1's output; not verified on a chip */
    /* voltage at an input of ADC1 at a time; NULL: always 0 */
    double (*volts)(unsigned input, double s);
    double vdda_V;
    chip_counter counter;
    unsigned access_cycles; /* core cycles of a register access and of the code around it */
} chip_world;
extern chip_world world;

/* Makes a new chip with typical properties: erased flash, factory option bytes, no power yet. */
void chip_new(uint64_t seed);
/* Resets the chip, or switches its power on. The pins have the levels that the world drives. */
void chip_reset(chip_cause cause);
unsigned chip_resets(void); /* number of resets since the chip was new */

/* Gives the drivers' variables the values of the flashed image. board_clock_start() has run before. */
void drivers_as_flashed(void);

/* Runs the program until a reset, a loss of power or the time limit. Calls must not be nested. */
chip_end chip_try(void (*what)(void));
chip_end chip_try_with(void (*what)(void *), void *with);
void chip_may_take(uint64_t units); /* limit for chip_try(), counted from its start (default 5 s) */
/* Power fails instead of a later store. If `stores` is 0, it fails instead of the next store. */
void chip_power_off_after(unsigned stores);
void chip_power_off_at(uint64_t when); /* power fails at this time */
void chip_power_stays(void);
unsigned chip_stores(void);
/* The model calls this after each store, unless it is NULL. */
extern void (*chip_stored)(void);
bool chip_is_masked(void);

uint64_t chip_now(void);
double chip_s(void);
void chip_pass(uint64_t units); /* the program idles and takes interrupts */
void chip_pass_us(uint64_t us);
/* While `halted`, a debugger holds the core, which takes no interrupt. */
void chip_halt(bool halted);

/* Return the number of violations since the chip was new, and the first one in words. */
unsigned chip_violations(void);
const char *chip_violation(void);
void chip_forgive(void);

/* The world's drive of a pin. If CHIP_OPEN, a resistor gives the level. */
typedef enum chip_level { CHIP_LOW, CHIP_HIGH, CHIP_OPEN } chip_level;
typedef enum chip_resistor { CHIP_NO_RESISTOR, CHIP_TO_GROUND, CHIP_TO_SUPPLY } chip_resistor;
void chip_pin_drive(char port, unsigned pin, chip_level level);
void chip_pin_drive_at(uint64_t when, char port, unsigned pin,
                       chip_level level); /* call it in the order of `when` */
void chip_pin_resistor(char port, unsigned pin, chip_resistor resistor);
chip_level chip_pin(char port, unsigned pin); /* CHIP_OPEN: the chip does not drive the pin */

typedef struct chip_clocks {
    uint32_t core_Hz, apb1_Hz, apb2_Hz, timers1_Hz, timers2_Hz;
} chip_clocks;
chip_clocks chip_clocks_now(void);
void chip_crystal_stops(void);
bool chip_nmi_taken(void);

/* Sets TIM2's counter, for tests of values that the counter would reach after an hour. */
void chip_tim2_count_is(uint32_t count);
uint32_t chip_tim2_count(void);
uint64_t chip_tim1_tick_units(void);
uint32_t chip_tim1_period_ticks(void);

/* Makes the bus so busy that DMA takes the next value too late: the ADC overruns. */
void chip_adc_overruns(void);

/* Serial line of USART6. A received byte comes at the end of its stop bit. Sent bytes are recorded with the time at
 * which they end. */
void chip_serial_comes(uint64_t when, uint8_t byte);
/* The same for a byte that sets these flags of SR: 2 is a framing error, 4 is noise. */
void chip_serial_comes_as(uint64_t when, uint8_t byte, uint8_t flags);
unsigned chip_serial_sent(void);
uint8_t chip_serial_byte(unsigned at);
uint64_t chip_serial_byte_units(void); /* duration of a byte at the present baud rate */

/* Flash: 1 MB from 0x08000000, and the option bytes. */
uint8_t chip_flash_byte(uint32_t address);
void chip_flash_byte_is(uint32_t address, uint8_t byte);
unsigned chip_flash_erases(unsigned sector);
void chip_protect_sector(unsigned sector); /* sets the sector's option byte */
unsigned chip_option_writes(void);
bool chip_options_are_locked(void);
uint32_t chip_option_bytes(void); /* the bits of FLASH_OPTCR after a power-on */

/* Returns how often the chip took this interrupt since it was new. */
unsigned long chip_interrupts(unsigned number);

#endif
