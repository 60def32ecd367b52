/* console.h: where the software speaks to a person, or to a program: a UART; on the PC standard output, or a pseudo-terminal.
 *
 * The board implements it (boards/<family>/), since every program of a board speaks, also those that
 * have no rig: tests, benches. Bytes are bytes: no conversion of line ends. */
#ifndef HAL_CONSOLE_H
#define HAL_CONSOLE_H

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_CONSOLE_STOP 0x1B /* Escape */

/* Write `count` bytes, waiting until all are taken, by polling: also with interrupts off and from a fault's handler. Not
 * in a control loop: at 115,200 baud a byte takes 87 us. */
void hal_console_write(const char *bytes, unsigned count);

/* Those that do not wait, for control loops. Take of the bytes that came the oldest, `room` at most; or hand over as many
 * as the device takes at once. Both return how many, 0 also where nobody is at the other end. A device that keeps only the
 * last byte or two is to be read once a control step at least, or loses some. Where a board knows that it has lost some, a
 * zero byte stands in their place, and in that of one that came broken: no line with it is to be obeyed. But a broken Escape
 * is one: it stops, and a stop too many harms nobody. Not from an interrupt or a fault's handler. */
unsigned hal_console_read(char *bytes, unsigned room);
unsigned hal_console_offer(const char *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
