/* atmega.h: declarations shared by the drivers of the ATmega2560. "DS 17.3" is a section of its data sheet
 * (DS40002211A). The chip fixes the timers' pins; names in brackets are those of an Arduino Mega:
 *
 *     timer 1    PWM on OC1A, PB5 (D11); enable on PB6 (D12); stop on PB4 (D10)
 *     timer 2    starts the converter 5000 times a second: load cell on ADC0 (A0), supply on ADC1 (A1)
 *     timer 4, 5 the time base, and capture of sensor 1 on ICP4, PL0 (D49), of sensor 2 on ICP5, PL1 (D48)
 *     USART 0    the console: out PE1 (D1), in PE0 (D0) */
#ifndef BOARDS_ATMEGA_H
#define BOARDS_ATMEGA_H

#include <stdbool.h>
#include <stdint.h>

#include <avr/interrupt.h>
#include <avr/io.h>

#include "board_data.h"

#define ATMEGA_PWM_BIT PB5
#define ATMEGA_ENABLE_BIT PB6
#define ATMEGA_STOP_BIT PB4
#define ATMEGA_CELL_INPUT 0U
#define ATMEGA_SUPPLY_INPUT 1U
/* supply voltage that gives the converter's full scale */
#define ATMEGA_SUPPLY_FULL_mV UINT32_C(50000)

/* Switches interrupts off until atmega_go_on(). Returns the interrupt state before the call. */
static inline uint8_t atmega_hold(void) {
    const uint8_t before = SREG;
    cli();
    return before;
}
static inline void atmega_go_on(uint8_t before) { SREG = before; }

/* Timers 4 and 5 always have the same count, two per tick (time_base.c). */
#define ATMEGA_COUNTS_PER_TICK 2U
void atmega_time_base_start(void);

/* Call it with interrupts off. */
uint32_t atmega_ticks(void);

/* The time of an interrupt: a timer's count, and its number of wraps so far. Valid for 4 s after the interrupt. */
typedef struct atmega_instant {
    uint16_t count;
    uint8_t wraps;
} atmega_instant;

/* number of wraps of timers 4 and 5 so far, modulo 256 */
extern volatile uint8_t atmega_wraps;

/* Returns the time at which both timers showed `count`, less than half a wrap ago. Call it within an interrupt. */
static inline atmega_instant atmega_instant_of(uint16_t count) {
    atmega_instant at = {count, atmega_wraps};
    /* TCNT4 is read before TOV4, so that a wrap between both reads does no harm */
    const uint16_t now = TCNT4;
    const bool pending = (TIFR4 & _BV(TOV4)) != 0;
    if (count >= 0x8000U && now < 0x8000U) { /* `count` was before the last wrap */
        at.wraps = (uint8_t)(at.wraps - (pending ? 0U : 1U));
    } else if (pending && count < 0x8000U) {
        at.wraps++;
    }
    return at;
}

uint32_t atmega_ticks_of(atmega_instant at);

/* Starts the watchdog with a timeout of 2048 << twice clocks of the watchdog's oscillator (DS 12.5.2). The second store
 * to WDTCSR must follow the first store within four clocks. */
static inline void atmega_watch(uint8_t twice) {
    const uint8_t change = _BV(WDCE) | _BV(WDE);
    const uint8_t settings =
        (uint8_t)(_BV(WDE) | ((twice & 8U) != 0 ? _BV(WDP3) : 0U) | (twice & 7U));
    const uint8_t before = atmega_hold();
    __asm__ volatile("wdr");
    WDTCSR = change;
    WDTCSR = settings;
    atmega_go_on(before);
}

/* Returns ATMEGA_WHOLE / (supply voltage in V), or 0 without a supply. Only hal_loadcell_take() updates it. */
#define ATMEGA_WHOLE 25600U
float atmega_parts_per_V(void);

/* hal_clock_start() calls these functions (rig_clock.c). */
void atmega_motor_start(void);
void atmega_slots_start(void);
void atmega_cell_start(void);

/* Faults that the software detects, because the chip does not. */
typedef enum atmega_fault_kind {
    ATMEGA_FAULT_NONE,
    ATMEGA_FAULT_STRAY,  /* an interrupt without a handler */
    ATMEGA_FAULT_STACK,  /* the stack has reached the variables */
    ATMEGA_FAULT_RESTART /* the program restarted without a reset, because of a wild jump */
} atmega_fault_kind;

/* Switches the motor off, records the fault, and resets. `at` is the byte address of the fault; 0: unknown. */
_Noreturn void atmega_fault(atmega_fault_kind kind, uint32_t at);

typedef struct atmega_fault_record {
    uint8_t kind; /* an atmega_fault_kind */
    uint32_t at;
    uint32_t ticks;  /* time of the fault; the clock restarts at each start */
    uint32_t state;  /* last argument of hal_reset_mark() */
    uint16_t faults; /* number of faults since power-on */
    uint16_t sum;
} atmega_fault_record;

void atmega_keep_fault(atmega_fault_kind kind, uint32_t at, uint32_t ticks);

/* Reads the record of a fault before this start. Returns false if there is none; a second call finds none. */
bool atmega_take_fault(atmega_fault_record *record);

/* Drops the record and the remembered bytes. Call it after a power-on, because both may then be random. */
void atmega_forget(void);

/* Returns MCUSR at the processor's start (DS 12.5.1); 0: no reset occurred. */
uint8_t atmega_reset_flags(void);

#endif
