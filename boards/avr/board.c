/* board.c: board.h on the AVR family (Microchip ATmega328P and ATmega2560 data sheets), with the first USART. The C
 * library's start-up code initializes the memory. */
#include "boards/board.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "board_data.h"

const char *const board_name = BOARD_NAME;

#define BAUD 115200UL
#define BAUD_DIVISOR ((F_CPU + 4UL * BAUD) / (8UL * BAUD) - 1UL) /* divisor for double speed */

void board_start(void) {
    UBRR0 = BAUD_DIVISOR;
    UCSR0A = _BV(U2X0);
    UCSR0B = _BV(TXEN0) | _BV(RXEN0);
}

void hal_console_write(const char *bytes, unsigned count) {
    /* otherwise a program without board_start() would hang here */
    if ((UCSR0B & _BV(TXEN0)) == 0) {
        board_start();
    }
    for (unsigned i = 0; i < count; i++) {
        while ((UCSR0A & _BV(UDRE0)) == 0) {
        }
        UDR0 = (uint8_t)bytes[i];
    }
}

unsigned hal_console_read(char *bytes, unsigned room) {
    unsigned count = 0;
    while (count < room && (UCSR0A & _BV(RXC0)) != 0) {
        bytes[count++] = (char)UDR0;
    }
    return count;
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    unsigned taken = 0;
    while (taken < count && (UCSR0A & _BV(UDRE0)) != 0) {
        UDR0 = (uint8_t)bytes[taken++];
    }
    return taken;
}

bool board_converse(void) { return true; }

/* avr_run.c recognizes sleep with interrupts off as the end, and GPIOR0 as the exit status. Silicon only sleeps. */
_Noreturn void board_exit(int code) {
    GPIOR0 = (uint8_t)code;
    cli();
    for (;;) {
        sleep_enable();
        sleep_cpu();
    }
}

bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }
uint32_t board_chip(void) { return 0; }
