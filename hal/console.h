/* console.h: where the software speaks to a person: a UART, or the PC's standard output.
 *
 * The board implements it (boards/<family>/), since every program of a board speaks, also those that
 * have no rig: tests, benches. */
#ifndef HAL_CONSOLE_H
#define HAL_CONSOLE_H

#ifdef __cplusplus
extern "C" {
#endif

/* Write `count` bytes, waiting until all are taken. No conversion of line ends. */
void hal_console_write(const char *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif
