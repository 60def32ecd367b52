/* board.c: board.h on the RISC-V family, with the devices of QEMU's machine `virt`: a 16550 UART, the timer of the
 * core-local interruptor, and the register that ends the emulator (SiFive's test finisher). */
#include "riscv.h"

#include "boards/board.h"

const char *const board_name = BOARD_NAME;
const uint32_t board_ticks_per_s = BOARD_TICKS_PER_S;

#define BYTE_REGISTER(address) (*(volatile uint8_t *)(uintptr_t)(address))

/* Registers of the 16550, one byte each (National Semiconductor PC16550D). */
#define UART_DATA BYTE_REGISTER(BOARD_UART + 0U)
#define UART_INTERRUPTS BYTE_REGISTER(BOARD_UART + 1U)
#define UART_LINE_CONTROL BYTE_REGISTER(BOARD_UART + 3U)
#define UART_LINE_STATUS BYTE_REGISTER(BOARD_UART + 5U)
#define UART_EIGHT_BITS 0x03U
#define UART_DIVISOR_ACCESS 0x80U
#define UART_RX_READY 0x01U
#define UART_TX_EMPTY 0x20U

void uart_start(void) {
    UART_INTERRUPTS = 0;
    UART_LINE_CONTROL = UART_EIGHT_BITS | UART_DIVISOR_ACCESS;
    UART_DATA = BOARD_UART_DIVISOR & 0xFFU;
    UART_INTERRUPTS = BOARD_UART_DIVISOR >> 8;
    UART_LINE_CONTROL = UART_EIGHT_BITS;
}

void uart_write(const char *bytes, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        while ((UART_LINE_STATUS & UART_TX_EMPTY) == 0) {
        }
        UART_DATA = (uint8_t)bytes[i];
    }
}

void board_start(void) { uart_start(); }

void hal_console_write(const char *bytes, unsigned count) { uart_write(bytes, count); }

unsigned hal_console_read(char *bytes, unsigned room) {
    unsigned count = 0;
    while (count < room && (UART_LINE_STATUS & UART_RX_READY) != 0) {
        bytes[count++] = (char)UART_DATA;
    }
    return count;
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    unsigned taken = 0;
    while (taken < count && (UART_LINE_STATUS & UART_TX_EMPTY) != 0) {
        UART_DATA = (uint8_t)bytes[taken++];
    }
    return taken;
}

bool board_converse(void) { return true; }

/* The low word of mtime, which counts from reset on. */
uint32_t board_ticks(void) { return REGISTER(BOARD_TIMER); }

_Noreturn void board_exit(int code) {
    const uint32_t passed = 0x5555U;
    const uint32_t failed = 0x3333U;
    REGISTER(BOARD_FINISHER) = code == 0 ? passed : (uint32_t)code << 16 | failed;
    for (;;) {
    }
}

bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }
uint32_t board_chip(void) { return 0; }
