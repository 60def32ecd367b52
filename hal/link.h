/* link.h: a line of bytes to whoever plays the plant, both ways.
 *
 * The board implements it (boards/<family>/link.c): files of the debugger's side by semihosting under an emulator, two
 * file descriptors on the PC; on silicon a UART would do. Bytes come in order, none of them is lost, and a read may
 * bring fewer than there is room for. When the other side is gone there is nothing left to control: the program then
 * ends by itself, with exit status HAL_LINK_GONE. */
#ifndef HAL_LINK_H
#define HAL_LINK_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_LINK_GONE 3

/* Descriptors that the other side hands to the program, or to its emulator: what is read, what is written. */
#define HAL_LINK_DOWN 3
#define HAL_LINK_UP 4

/* Opens the line; false when there is none. To be called before the others. */
bool hal_link_open(void);

/* Waits until there is something; then up to room >= 1 bytes. Returns how many, at least one. */
unsigned hal_link_read(uint8_t *bytes, unsigned room);

/* Writes all. */
void hal_link_write(const uint8_t *bytes, unsigned count);

/* A free-running count, wrapping at 2^32, of hal_link_timer_per_s() a second, by which computing time is told. 0 a
 * second where there is none that means anything. */
uint32_t hal_link_timer(void);
uint32_t hal_link_timer_per_s(void);

/* Who speaks: the board's name. */
const char *hal_link_board(void);

#ifdef __cplusplus
}
#endif

#endif
