/* board.c: board.h on the PC. */
#define _POSIX_C_SOURCE 200809L

#include "boards/board.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

const char *const board_name = "host";
const uint32_t board_ticks_per_s = 1000000U;

/* Buffers output by lines, so that a file or pipe has each line before a crash. */
void board_start(void) {
    if (setvbuf(stdout, NULL, _IOLBF, BUFSIZ) != 0) {
        setbuf(stdout, NULL);
    }
}

void hal_console_write(const char *bytes, unsigned count) {
    if (fwrite(bytes, 1, count, stdout) != count) {
        exit(EXIT_FAILURE);
    }
}

_Noreturn void board_exit(int code) {
    if (fflush(stdout) != 0 && code == 0) {
        code = EXIT_FAILURE;
    }
    exit(code);
}

uint32_t board_ticks(void) {
    struct timespec now;
    if (clock_gettime(CLOCK_MONOTONIC, &now) != 0) {
        board_exit(EXIT_FAILURE);
    }
    const uint64_t seconds = (uint64_t)now.tv_sec;
    const uint64_t nanoseconds = (uint64_t)now.tv_nsec;
    return (uint32_t)(seconds * board_ticks_per_s + nanoseconds / 1000U);
}

void board_wait_until(uint32_t ticks) {
    for (int32_t left = (int32_t)(ticks - board_ticks()); left > 0;
         left = (int32_t)(ticks - board_ticks())) {
        const struct timespec nap = {.tv_sec = left / 1000000, .tv_nsec = left % 1000000 * 1000};
        (void)nanosleep(&nap, NULL); /* if a signal ends it early, the loop checks again */
    }
}

void board_stack_paint(void) {}
unsigned board_stack_used_bytes(void) { return 0; }
unsigned board_stack_size_bytes(void) { return 0; }

bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }

uint32_t board_chip(void) { return 0; }
