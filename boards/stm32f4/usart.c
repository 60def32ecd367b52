/* usart.c: the console on USART6, 115,200 baud, 8 bits, no parity (RM0090, 30), with an interrupt and a ring for each
 * direction. uart_write() polls instead, so that it also works after a fault and before other parts have started.
 * hal_console_offer() sends the first bytes itself: in QEMU 7.2, an empty transmitter may raise no interrupt. */
#include "boards/board.h"

#include "ring.h"
#include "stm32f4.h"

#define BAUD 115200U
#define USART6_IRQ 71U
#define USART6_FUNCTION 8U

/* Powers of two, so that indices wrap correctly. At 115,200 baud, some 23 bytes come in a control step of 2 ms. */
#define IN_BYTES 128U
#define OUT_BYTES 128U

static char in_bytes[IN_BYTES];
static stm32f4_ring_counts in_counts;
static const stm32f4_ring in = {&in_counts, in_bytes, IN_BYTES, 1};
static char out_bytes[OUT_BYTES];
/* Only the interrupt, and code that has switched interrupts off, may change out_counts.taken. */
static stm32f4_ring_counts out_counts;
static const stm32f4_ring out = {&out_counts, out_bytes, OUT_BYTES, 1};
static bool lost; /* only the interrupt uses it */

void uart_start(void) {
    stm32f4_clock_on(RCC_PART(RCC_APB2ENR, RCC_APB2ENR_USART6));
    stm32f4_pin_is(BOARD_PIN_TX, PIN_ALTERNATE(USART6_FUNCTION));
    stm32f4_pin_is(BOARD_PIN_RX, PIN_ALTERNATE(USART6_FUNCTION) | PULL_UP);
    reg_store(USART_BRR, (stm32f4_clocks_now()->usart_Hz + BAUD / 2U) / BAUD);
    reg_store(USART_CR1, USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE);
    stm32f4_interrupt(USART6_IRQ);
}

/* Sends waiting bytes while the transmitter takes them. Returns true if bytes still wait. */
static bool feed(void) {
    uint8_t byte;
    while ((reg_load(USART_SR) & USART_SR_TXE) != 0) {
        if (!stm32f4_ring_take(&out, &byte)) {
            return false;
        }
        reg_store(USART_DR, byte);
    }
    return out_counts.put != out_counts.taken;
}

/* Stores received bytes. Reading the status, then the data, clears the flags (30.6.1). Bytes lost by an overrun or a
 * full ring become one zero before the next byte (hal/console.h). */
static void fetch(void) {
    for (unsigned i = 0; i < IN_BYTES; i++) {
        const uint32_t status = reg_load(USART_SR);
        if ((status & (USART_SR_RXNE | USART_SR_ORE)) == 0) {
            return;
        }
        char byte = (char)(reg_load(USART_DR) & 0xFFU);
        if ((status & (USART_SR_FE | USART_SR_NF)) != 0 && byte != HAL_CONSOLE_STOP) {
            byte = 0; /* damaged, for example by a wrong baud rate or noise */
        }
        if (lost) {
            lost = !stm32f4_ring_put(&in, "");
        }
        if ((status & USART_SR_RXNE) != 0 && !stm32f4_ring_put(&in, &byte)) {
            lost = true;
        }
        if ((status & USART_SR_ORE) != 0) {
            lost = true;
        }
    }
}

void on_usart6(void) {
    fetch();
    if (!feed()) {
        reg_clear(USART_CR1, USART_CR1_TXEIE);
    }
}

unsigned hal_console_read(char *bytes, unsigned room) {
    unsigned count = 0;
    while (count < room && stm32f4_ring_take(&in, &bytes[count])) {
        count++;
    }
    return count;
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    unsigned taken = 0;
    while (taken < count && stm32f4_ring_put(&out, &bytes[taken])) {
        taken++;
    }
    const uint32_t before = stm32f4_hold();
    if (feed()) {
        reg_set(USART_CR1, USART_CR1_TXEIE);
    }
    stm32f4_go_on(before);
    return taken;
}

void uart_write(const char *bytes, unsigned count) {
    if ((reg_load(USART_CR1) & USART_CR1_TE) == 0) {
        uart_start();
    }
    const uint32_t before = stm32f4_hold();
    for (;;) {
        char byte;
        if (!stm32f4_ring_take(&out, &byte)) { /* the queue is empty */
            if (count-- == 0) {
                break;
            }
            byte = *bytes++;
        }
        /* takes at most a byte's time, 87 us; bounded, so that a dead device does not hang the program */
        (void)stm32f4_comes(USART_SR, USART_SR_TXE, USART_SR_TXE, 100000U);
        reg_store(USART_DR, (uint8_t)byte);
    }
    stm32f4_go_on(before);
}
