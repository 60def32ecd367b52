/* usart.c: the console on serial interface 6, 115,200 baud, 8 bits, no parity (RM0090, 30). An interrupt fills and
 * empties rings in both directions. After a fault, or before other parts have started, the console polls.
 *
 * The writer feeds the transmitter while it is ready; the interrupt sends the other bytes. So bytes also leave if an
 * empty transmitter raises no interrupt (QEMU 7.2). */
#include "boards/board.h"

#include "ring.h"
#include "stm32f4.h"

#define BAUD 115200U
#define USART6_IRQ 71U
#define USART6_FUNCTION 8U

/* Sizes are powers of two, so that indices wrap correctly. A control step of 2 ms takes at most 23 bytes. In each step
 * the console writes only as many as there is room for: its answers wait in its own buffer. */
#define IN_BYTES 128U
#define OUT_BYTES 128U

static char in_bytes[IN_BYTES];
static stm32f4_ring_counts in_counts;
static const stm32f4_ring in = {&in_counts, in_bytes, IN_BYTES, 1};
static char out_bytes[OUT_BYTES];
/* out_counts.taken is used by the interrupt, and by code that has disabled the interrupt */
static stm32f4_ring_counts out_counts;
static const stm32f4_ring out = {&out_counts, out_bytes, OUT_BYTES, 1};
static bool lost; /* bytes were lost; used by the interrupt only */

void uart_start(void) {
    stm32f4_clock_on(RCC_PART(RCC_APB2ENR, RCC_APB2ENR_USART6));
    stm32f4_pin_is(BOARD_PIN_TX, PIN_ALTERNATE(USART6_FUNCTION));
    stm32f4_pin_is(BOARD_PIN_RX, PIN_ALTERNATE(USART6_FUNCTION) | PULL_UP);
    reg_store(USART_BRR, (stm32f4_clocks_now()->usart_Hz + BAUD / 2U) / BAUD);
    reg_store(USART_CR1, USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE);
    stm32f4_interrupt(USART6_IRQ);
}

/* Send waiting bytes while the transmitter takes them. Returns true if more are waiting. */
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

/* Reading the status, then the data, clears both flags (30.6.1). Bytes after this one are lost by an overrun, or if
 * the FIFO is full. One zero before the next byte stands for them. A line with a zero is not executed. */
static void fetch(void) {
    for (unsigned i = 0; i < IN_BYTES; i++) {
        const uint32_t status = reg_load(USART_SR);
        if ((status & (USART_SR_RXNE | USART_SR_ORE)) == 0) {
            return;
        }
        char byte = (char)(reg_load(USART_DR) & 0xFFU);
        if ((status & (USART_SR_FE | USART_SR_NF)) != 0 && byte != HAL_CONSOLE_STOP) {
            byte = 0; /* a damaged byte: wrong speed, a plug, noise */
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

/* The transmitter is ready within a byte's time, 87 us. The wait is bounded, so that a dead device does not hang the
 * program. */
static void send(char byte) {
    (void)stm32f4_comes(USART_SR, USART_SR_TXE, USART_SR_TXE, 100000U);
    reg_store(USART_DR, (uint8_t)byte);
}

void uart_write(const char *bytes, unsigned count) {
    if ((reg_load(USART_CR1) & USART_CR1_TE) == 0) {
        uart_start();
    }
    const uint32_t before = stm32f4_hold();
    for (;;) {
        char byte;
        if (!stm32f4_ring_take(&out, &byte)) { /* bytes that were queued before go first */
            if (count-- == 0) {
                break;
            }
            byte = *bytes++;
        }
        send(byte);
    }
    stm32f4_go_on(before);
}
