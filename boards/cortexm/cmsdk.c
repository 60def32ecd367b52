/* cmsdk.c: console and clock on Arm's CMSDK peripherals (Cortex-M System Design Kit Technical Reference Manual). */
#include "cortexm.h"

#include "boards/board.h"

#define UART_DATA (BOARD_UART + 0x0U)
#define UART_STATE (BOARD_UART + 0x4U)
#define UART_CTRL (BOARD_UART + 0x8U)
#define UART_BAUDDIV (BOARD_UART + 0x10U)
#define UART_STATE_TX_FULL 1U
#define UART_STATE_RX_FULL 2U
#define UART_CTRL_TX_ENABLE 1U
#define UART_CTRL_RX_ENABLE 2U

#define TIMER_CTRL (BOARD_TIMER + 0x0U)
#define TIMER_VALUE (BOARD_TIMER + 0x4U)
#define TIMER_RELOAD (BOARD_TIMER + 0x8U)
#define TIMER_CTRL_ENABLE 1U

void uart_start(void) {
    REGISTER(UART_BAUDDIV) = BOARD_UART_DIVISOR;
    REGISTER(UART_CTRL) = UART_CTRL_TX_ENABLE | UART_CTRL_RX_ENABLE;
}

/* Starts the device if the program has not called board_start(): otherwise the wait would never end. */
void uart_write(const char *bytes, unsigned count) {
    if ((REGISTER(UART_CTRL) & UART_CTRL_TX_ENABLE) == 0) {
        uart_start();
    }
    for (unsigned i = 0; i < count; i++) {
        while ((REGISTER(UART_STATE) & UART_STATE_TX_FULL) != 0) {
        }
        REGISTER(UART_DATA) = (uint8_t)bytes[i];
    }
}

unsigned hal_console_read(char *bytes, unsigned room) {
    unsigned count = 0;
    while (count < room && (REGISTER(UART_STATE) & UART_STATE_RX_FULL) != 0) {
        bytes[count++] = (char)REGISTER(UART_DATA);
    }
    return count;
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    unsigned taken = 0;
    while (taken < count && (REGISTER(UART_STATE) & UART_STATE_TX_FULL) == 0) {
        REGISTER(UART_DATA) = (uint8_t)bytes[taken++];
    }
    return taken;
}

void board_clock_start(void) {}

void timer_start(void) {
    REGISTER(TIMER_RELOAD) = 0xFFFFFFFFU;
    REGISTER(TIMER_VALUE) = 0xFFFFFFFFU;
    REGISTER(TIMER_CTRL) = TIMER_CTRL_ENABLE;
}

/* The timer counts down. */
uint32_t board_ticks(void) { return ~REGISTER(TIMER_VALUE); }
