#include "cost_board.h"

#include <stddef.h>
#include <string.h>

#define COST_BASIS_WORD(id, word, says) word,
const char *const cost_basis_words[COST_BASES] = {COST_BASIS_ROWS(COST_BASIS_WORD)};
const char *const cost_number_words[COST_NUMBERS] = {"float", "double", "fixed"};

/* Cycles per instruction of boards without counted cycles. The least is for a core that always issues as many instructions
 * at once as it can. The most is two to three times Arm's timing of such steps on a Cortex-M4 (1.2 to 1.7). */
const cost_board cost_boards[] = {
    {"atmega328p", "AVR", "ATmega328P: Arduino Uno, Nano", false, COST_SIMULATED, 0, 0, 16e6, 32768,
     2048},
    {"atmega2560", "AVR", "ATmega2560: Arduino Mega", false, COST_SIMULATED, 0, 0, 16e6, 262144,
     8192},
    {"mps2-an385-m0", "Cortex-M0", "STM32F0, nRF51, LPC11xx", false, COST_ESTIMATED, 0, 0, 0, 0, 0},
    {"mps2-an385", "Cortex-M3", "STM32F1, LPC17xx, SAM3X", false, COST_ESTIMATED, 0, 0, 0, 0, 0},
    {"mps2-an386", "Cortex-M4F", "STM32F4, nRF52, SAMD51, MSP432", true, COST_ESTIMATED, 0, 0, 0, 0,
     0},
    {"mps2-an500", "Cortex-M7", "STM32F7, STM32H7, i.MX RT (Teensy 4)", true, COST_RANGE, 0.5, 3.0,
     0, 0, 0},
    {"mps2-an505", "Cortex-M33", "STM32U5, nRF53, RP2350", true, COST_RANGE, 0.8, 3.0, 0, 0, 0},
    {"rv32imac", "RV32IMAC", "GD32VF103, CH32V203, FE310", false, COST_RANGE, 1.0, 4.0, 0, 0, 0},
    {"rv32imafc", "RV32IMAFC", "CH32V307", true, COST_RANGE, 1.0, 5.0, 0, 0, 0},
    {"host", "x86-64", "a PC", true, COST_RANGE, 0.2, 3.0, 0, 0, 0},
};
const int cost_board_count = sizeof cost_boards / sizeof cost_boards[0];

const cost_board *cost_board_named(const char *name) {
    for (int i = 0; i < cost_board_count; i++) {
        if (strcmp(cost_boards[i].name, name) == 0) {
            return &cost_boards[i];
        }
    }
    return NULL;
}
