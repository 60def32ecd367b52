/* port.h: a serial line, a pseudo-terminal, or a file that was recorded of one. */
#ifndef MONITOR_PORT_H
#define MONITOR_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <termios.h>

typedef struct port {
    int file;
    int failed; /* errno of the read that could not go on, or 0 */
    bool
        is_line; /* there is somebody at the other end: a terminal; else a file or a pipe, which ends */
    struct termios before;
} port;

#define PORT_SPEEDS "9600, 19200, 38400, 57600, 115200 or 230400"
/* True for a speed that there is a name of. */
bool port_has_speed(double baud);

/* Open it: without echo and conversion, at this speed. False, errno tells why, when it is not there, or (EBUSY) another
 * program that asks for a line alone, as this does, has it. */
bool port_open(port *p, const char *name, double baud);

/* What has come of a line and was not read is not to be read. */
void port_forget(const port *p);

/* On standard error: it cannot be opened, why, as errno has it, and what may help. */
void port_say_unopened(const char *name, const char *hint);

/* As it was before. */
void port_close(port *p);

/* What has come, `room` at most, after waiting for wait_ms at most for it, or for a line on standard input where
 * `typed` is not NULL: *typed. Returns how many bytes, 0 for none yet, -1 when the other end is gone, the file ends or
 * could not be read (failed). */
int port_read(port *p, uint8_t *bytes, size_t room, int wait_ms, bool *typed);

/* All of them; false when it is gone, or takes nothing for a second. */
bool port_write(port *p, const char *bytes, size_t count);

#endif
