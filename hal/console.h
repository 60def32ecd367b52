/* console.h: the connection to a person or a program: a UART; on the PC standard output, or a pseudo-terminal.
 *
 * The board implements it (boards/<family>/), because programs without a rig need it, too: tests, benches. Bytes are
 * not converted, not even line ends. */
#ifndef HAL_CONSOLE_H
#define HAL_CONSOLE_H

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_CONSOLE_STOP 0x1B /* Escape */

/* Write `count` bytes, waiting until all are taken, by polling: works with interrupts off and in a fault handler. Not
 * in a control loop: at 115,200 baud a byte takes 87 us. */
void hal_console_write(const char *bytes, unsigned count);

/* Non-waiting versions for control loops. Read the oldest bytes received, at most `room`; or write as many bytes as the
 * device takes at once. Both return the number, also 0 without a partner. A device that stores only the last byte or
 * two must be read at least once a control step, or loses some. A zero byte replaces lost bytes, if the board notices
 * the loss, and each damaged byte: do not execute a line that contains one. But a damaged Escape counts as Escape: it
 * stops, and a needless stop is harmless. Not from an interrupt or a fault handler. */
unsigned hal_console_read(char *bytes, unsigned room);
unsigned hal_console_offer(const char *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
