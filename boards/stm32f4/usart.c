/* usart.c: the console on serial interface 6, 115,200 baud, 8 bits, no parity (RM0090, 30): rings both ways, which an
 * interrupt fills and empties; and, for a fault or before anything else is up, by polling.
 *
 * Whoever offers feeds the transmitter as long as it is ready, and leaves the rest to the interrupt: so bytes also leave
 * where no interrupt comes of an empty transmitter (QEMU 7.2). */
#include "boards/board.h"

#include "stm32f4.h"

#define BAUD 115200U
#define USART6_IRQ 71U
#define USART6_FUNCTION 8U

/* Powers of two: indices count on and wrap. A control step of 2 ms takes 23 bytes at most, and in each the console gives out as
 * many as there is room for: its answers wait with itself. */
#define IN_BYTES 128U
#define OUT_BYTES 128U

static volatile char in[IN_BYTES];
static volatile uint32_t in_head; /* the interrupt's */
static volatile uint32_t in_tail;
static volatile char out[OUT_BYTES];
static volatile uint32_t out_head;
static volatile uint32_t out_tail; /* the interrupt's, and of who holds it off */
static volatile bool lost;

void uart_start(void) {
    reg_set(RCC_APB2ENR, RCC_APB2ENR_USART6);
    (void)reg_load(RCC_APB2ENR);
    stm32f4_pin_is(BOARD_PIN_TX, PIN_ALTERNATE, PULL_NONE, USART6_FUNCTION);
    stm32f4_pin_is(BOARD_PIN_RX, PIN_ALTERNATE, PULL_UP, USART6_FUNCTION);
    reg_store(USART_BRR, (stm32f4_clocks_now()->usart_Hz + BAUD / 2U) / BAUD);
    reg_store(USART_CR1, USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE);
    stm32f4_interrupt(USART6_IRQ);
}

/* What waits, as long as the transmitter takes it. */
static void feed(void) {
    while (out_tail != out_head && (reg_load(USART_SR) & USART_SR_TXE) != 0) {
        reg_store(USART_DR, (uint8_t)out[out_tail % OUT_BYTES]);
        out_tail++;
    }
}

static void keep(char byte) {
    if (in_head - in_tail < IN_BYTES) {
        in[in_head % IN_BYTES] = byte;
        in_head++;
    } else {
        lost = true;
    }
}

/* Reading the status, then the data, clears what both say (30.6.1). Bytes that were overrun, which came behind this one, leave
 * a zero before the next, as those do that found no room: no line with it is obeyed. */
static void fetch(void) {
    for (unsigned i = 0; i < IN_BYTES; i++) {
        const uint32_t status = reg_load(USART_SR);
        if ((status & (USART_SR_RXNE | USART_SR_ORE)) == 0) {
            return;
        }
        const char byte = (char)(reg_load(USART_DR) & 0xFFU);
        if (lost) {
            lost = false;
            keep('\0');
        }
        if ((status & USART_SR_RXNE) != 0) {
            keep(byte);
        }
        lost = lost || (status & USART_SR_ORE) != 0;
    }
}

void on_usart6(void) {
    fetch();
    feed();
    if (out_tail == out_head) {
        reg_clear(USART_CR1, USART_CR1_TXEIE);
    }
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
    while (taken < count && out_head - out_tail < OUT_BYTES) {
        out[out_head % OUT_BYTES] = bytes[taken++];
        out_head++;
    }
    const uint32_t before = stm32f4_hold();
    feed();
    if (out_tail != out_head) {
        reg_set(USART_CR1, USART_CR1_TXEIE);
    }
    stm32f4_go_on(before);
    return taken;
}

/* Ready within a byte's time, 87 us: one that never gets ready is no reason to hang. */
static void send(char byte) {
    for (uint32_t i = 0; i < 100000U && (reg_load(USART_SR) & USART_SR_TXE) == 0; i++) {
    }
    reg_store(USART_DR, (uint8_t)byte);
}

void uart_write(const char *bytes, unsigned count) {
    if ((reg_load(USART_CR1) & USART_CR1_TE) == 0) {
        uart_start();
    }
    const uint32_t before = stm32f4_hold();
    for (; out_tail != out_head; out_tail++) { /* what was offered before comes before */
        send(out[out_tail % OUT_BYTES]);
    }
    for (unsigned i = 0; i < count; i++) {
        send(bytes[i]);
    }
    stm32f4_go_on(before);
}
