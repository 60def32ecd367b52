/* console.h: a UART to a person or a program. On a PC it is standard output or a pseudo-terminal. Bytes are unchanged.
 * Each family of boards implements these functions (boards/<family>/). */
#ifndef HAL_CONSOLE_H
#define HAL_CONSOLE_H

#include "core/linkage.h"

WH_C_BEGIN

#define HAL_CONSOLE_STOP 0x1B /* Escape */

/* Writes `count` bytes and polls until the device has taken them all, so it works with interrupts off and in a fault
 * handler. Do not call it in a control loop: at 115,200 baud a byte takes 87 us. */
void hal_console_write(const char *bytes, unsigned count);

/* Functions for control loops: they do not wait. hal_console_read() takes the oldest received bytes, at most `room`;
 * hal_console_offer() writes as many bytes as the device takes at once. Both return the number of bytes, 0 if nobody is
 * connected. Do not call them in an interrupt or a fault handler.
 *
 * Read in every control step, because some devices store only one or two bytes. A damaged byte is read as zero,
 * a damaged Escape as Escape. A detected loss of bytes is read as one zero. Do not execute a line with a zero. */
unsigned hal_console_read(char *bytes, unsigned room);
unsigned hal_console_offer(const char *bytes, unsigned count);

WH_C_END

#endif
