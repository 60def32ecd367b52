/* port.h: a serial line, a pseudo-terminal, or a file with recorded bytes. A program can open one port at a time. */
#ifndef OS_PORT_H
#define OS_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct port {
    int file;
    int failed;   /* errno of a failed read, or 0 */
    bool is_line; /* a terminal; false for a file or a pipe, which has an end */
} port;

#define PORT_SPEEDS "9600, 19200, 38400, 57600, 115200 or 230400"
bool port_has_speed(double baud);

/* Opens and locks a line in raw mode. On failure, returns false and sets errno: EBUSY if another program has it. */
bool port_open(port *p, const char *name, double baud);

/* Discards received bytes. */
void port_forget(const port *p);

/* Reports that the line cannot be opened, with errno and the hint. */
void port_say_unopened(const char *name, const char *hint);

/* Restores the line's settings. */
void port_close(port *p);

/* Waits at most wait_ms for bytes, and reads at most `room` bytes. If `typed` is not NULL, a line on standard input
 * ends the wait, and sets *typed. Returns the number of bytes, which may be 0. Returns -1 if the peer is gone, a file
 * has ended, or the read has failed. After a failed read, p->failed is not 0. */
int port_read(port *p, uint8_t *bytes, size_t room, int wait_ms, bool *typed);

/* Returns false if the peer is gone, or accepts nothing for a second. */
bool port_write(port *p, const char *bytes, size_t count);

#endif
