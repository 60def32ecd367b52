/* fault.c: faults on a chip without fault hardware. The software detects an interrupt without a handler, a stack that
 * has reached the variables, and a restart without a reset. (A wild jump into erased flash continues at address 0.) The
 * handler BADISR_vect and the start-up code begin with OFF, which needs no register and no stack. */
#include "boards/board.h"
#include "hal/motor.h"

#include "atmega.h"

#define OFF "cbi 0x05, 6\n\t" /* clears the enable's bit of PORTB */
_Static_assert(ATMEGA_ENABLE_BIT == 6, "the bit that OFF clears");

/* The first piece of the start-up code. */
__attribute__((naked, used, section(".init0"))) void atmega_off_first(void);
__attribute__((naked, used, section(".init0"))) void atmega_off_first(void) {
    __asm__ volatile(OFF "cli");
}

/* MCUSR at the start, in memory that the start-up code does not clear afterwards. */
__attribute__((section(".noinit"))) static volatile uint8_t flags;

/* Stores and clears MCUSR, then stops the watchdog, which cannot be stopped while WDRF in MCUSR is set. */
__attribute__((used)) void atmega_see_reset(void);
__attribute__((used)) void atmega_see_reset(void) {
    const uint8_t change = _BV(WDCE) | _BV(WDE);
    TCCR1A = 0;
    flags = MCUSR;
    MCUSR = 0;
    __asm__ volatile("wdr");
    WDTCSR = change;
    WDTCSR = 0;
}

/* Runs after the stack is set up and before the variables are initialized. */
__attribute__((naked, used, section(".init3"))) void atmega_first(void);
__attribute__((naked, used, section(".init3"))) void atmega_first(void) {
    __asm__ volatile("call atmega_see_reset");
}

uint8_t atmega_reset_flags(void) { return flags; }

/* Resets by the watchdog: software cannot request another kind of reset. */
_Noreturn void atmega_fault(atmega_fault_kind kind, uint32_t at) {
    hal_motor_off(HAL_MOTOR_COAST);
    cli();
    atmega_keep_fault(kind, at, atmega_ticks());
    atmega_watch(0);
    for (;;) {
        __asm__ volatile("" ::: "memory");
    }
}

/* `sp` is the stack pointer. The three bytes above it are the return address, its highest byte first. */
__attribute__((used)) _Noreturn void atmega_stray(const uint8_t *sp);
__attribute__((used)) _Noreturn void atmega_stray(const uint8_t *sp) {
    const uint32_t words = (uint32_t)sp[1] << 16 | (uint16_t)((uint16_t)sp[2] << 8) | sp[3];
    atmega_fault(ATMEGA_FAULT_STRAY, 2U * words);
}

ISR(BADISR_vect, ISR_NAKED) {
    __asm__ volatile(OFF "clr __zero_reg__\n\t"
                         "in r24, __SP_L__\n\t"
                         "in r25, __SP_H__\n\t"
                         "jmp atmega_stray");
}
