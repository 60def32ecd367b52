/* usart.c: the console on USART 0 (8 bits, no parity), with interrupts and a ring for each direction. Its double speed
 * mode gives 117,647 baud, 2.1 % more than 115,200 baud (DS 22.11). hal_console_write() polls. */
#include "boards/board.h"

#include "atmega.h"

#define BAUD 115200UL
#define BAUD_DIVISOR ((F_CPU + 4UL * BAUD) / (8UL * BAUD) - 1UL)

/* Powers of two, because the indices wrap at 256. A control step of 2 ms receives at most 24 bytes. */
#define IN_BYTES 64U
#define OUT_BYTES 64U

static volatile char in[IN_BYTES];
static volatile uint8_t in_head; /* only the interrupt changes it */
static volatile uint8_t in_tail;
static volatile char out[OUT_BYTES];
static volatile uint8_t out_head;
static volatile uint8_t out_tail; /* changes only while interrupts are off */
static volatile bool lost;

void atmega_usart_start(void);

void atmega_usart_start(void) {
    UBRR0 = BAUD_DIVISOR;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(TXEN0) | _BV(RXEN0) | _BV(RXCIE0);
}

static void keep(char byte) {
    if ((uint8_t)(in_head - in_tail) < IN_BYTES) {
        in[in_head % IN_BYTES] = byte;
        in_head++;
    } else {
        lost = true;
    }
}

/* Stores a zero for a damaged byte, and one zero for a loss of bytes (hal/console.h). */
ISR(USART0_RX_vect) {
    const uint8_t status = UCSR0A;
    const char byte = (char)UDR0;
    if (lost || (status & _BV(DOR0)) != 0) {
        lost = false;
        keep('\0');
    }
    keep((status & _BV(FE0)) != 0 && byte != HAL_CONSOLE_STOP ? '\0' : byte);
}

ISR(USART0_UDRE_vect) {
    if (out_tail == out_head) {
        UCSR0B &= (uint8_t)~_BV(UDRIE0);
        return;
    }
    UDR0 = (uint8_t)out[out_tail % OUT_BYTES];
    out_tail++;
}

unsigned hal_console_read(char *bytes, unsigned room) {
    unsigned count = 0;
    while (count < room && in_tail != in_head) {
        bytes[count++] = in[in_tail % IN_BYTES];
        in_tail++;
    }
    return count;
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    unsigned taken = 0;
    while (taken < count && (uint8_t)(out_head - out_tail) < OUT_BYTES) {
        out[out_head % OUT_BYTES] = bytes[taken++];
        out_head++;
    }
    if (taken > 0) {
        const uint8_t before = atmega_hold();
        UCSR0B |= _BV(UDRIE0);
        atmega_go_on(before);
    }
    return taken;
}

/* The wait takes at most a byte's time, 87 us. It is bounded, so that a dead device does not hang the program. */
static void send(char byte) {
    for (uint16_t i = 0; i < 10000U && (UCSR0A & _BV(UDRE0)) == 0; i++) {
    }
    UDR0 = (uint8_t)byte;
}

void hal_console_write(const char *bytes, unsigned count) {
    if ((UCSR0B & _BV(TXEN0)) == 0) {
        atmega_usart_start();
    }
    const uint8_t before = atmega_hold();
    for (; out_tail != out_head; out_tail++) { /* sends the queued bytes first */
        send(out[out_tail % OUT_BYTES]);
    }
    for (unsigned i = 0; i < count; i++) {
        send(bytes[i]);
    }
    atmega_go_on(before);
}
