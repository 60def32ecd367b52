/* Frames by docs/dev/pil.md ("Bytes on the line"), and the firmware as a child process at the other end of the line. */
#ifndef TESTS_OUTSIDE_BENCH_LINE_H
#define TESTS_OUTSIDE_BENCH_LINE_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

enum { HELLO = 1, ORDERS = 2, READINGS = 3, REMEMBER = 5 }; /* kinds of frames */
enum { HEADER = 8 }; /* bytes: version, kind, sequence, ticks */

typedef struct {
    uint8_t byte[2048];
    size_t n, at; /* at: index of the next byte to be read */
} message;

typedef struct {
    pid_t child;
    FILE *to, *from;
} line;

_Noreturn void disagree(const char *format, ...); /* exits with 2: page and firmware differ */

void put(message *m, uint32_t value, int bytes);
uint32_t get(message *m, int bytes);
double get_float(message *m);
const char *get_string(message *m);

void line_start(line *l, const char *firmware);
void line_say(const line *l, message *m);  /* adds the CRC */
bool line_hear(const line *l, message *m); /* reads the next frame; false at the end */
int line_end(const line *l);               /* closes the line; returns the exit status or -1 */

#endif
