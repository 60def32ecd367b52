/* wait.c: the wait functions of board.h, by polling. */
#include "boards/board.h"

void board_wait_until(uint32_t ticks) {
    while ((int32_t)(board_ticks() - ticks) < 0) {
    }
}
