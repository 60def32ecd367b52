/* f405_seen.c: shared parts of the tests of f405.c (f405.h). */
#define _POSIX_C_SOURCE 200809L

#include "tests/tools/f405.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TIM1_MARK 0x40010038U
#define MOE 0x8000U

emulated board;

uint32_t symbol(const char *name) {
    char line[300];
    char end[100];
    unsigned long address = 0;
    (void)snprintf(line, sizeof line, "arm-none-eabi-nm %s", image);
    (void)snprintf(end, sizeof end, " %s\n", name);
    FILE *symbols = popen(line, "r");
    if (symbols == NULL) {
        return 0;
    }
    while (fgets(line, sizeof line, symbols) != NULL) { /* "20000000 b name" */
        const size_t from = strlen(line) - strlen(end);
        if (strlen(line) > strlen(end) && strcmp(line + from, end) == 0) {
            address = strtoul(line, NULL, 16);
        }
    }
    (void)pclose(symbols);
    return (uint32_t)address;
}

bool hear(const char *begin, char *line, unsigned room, unsigned ms) {
    for (unsigned lines = 0; lines < 200; lines++) {
        if (!emulated_hear(&board, line, room, ms)) {
            return no("no line '%s...'", begin);
        }
        if (strncmp(line, begin, strlen(begin)) == 0) {
            return true;
        }
    }
    return no("only other lines than '%s...'", begin);
}

static bool answered(const char *order, char *line, unsigned room, unsigned ms) {
    char typed[500];
    while (emulated_hear(&board, line, room, 0)) {
    }
    (void)snprintf(typed, sizeof typed, "%s\r", order);
    emulated_say(&board, typed);
    for (unsigned lines = 0; lines < 50 && emulated_hear(&board, line, room, ms); lines++) {
        if (line[0] != '#' && line[0] != '\0') {
            return true;
        }
    }
    return no("'%.40s' is not answered", order);
}

bool answers(const char *order, const char *begin, char *line, unsigned room) {
    return answered(order, line, room, 60000) &&
           (strncmp(line, begin, strlen(begin)) == 0 ||
            no("'%.40s': '%.150s', not '%s...'", order, line, begin));
}

bool answers_at_last(const char *order, const char *begin, char *line, unsigned room) {
    for (unsigned i = 0; i < 10; i++) {
        if (answered(order, line, room, 4000)) {
            return strncmp(line, begin, strlen(begin)) == 0 ||
                   no("'%.40s': '%.150s', not '%s...'", order, line, begin);
        }
    }
    return false;
}

const emulated_store_seen *seen_at(uint64_t number) {
    return &board.store[number % EMULATED_STORES];
}

bool is(const emulated_store_seen *seen, const char *device, uint32_t offset) {
    return seen->offset == offset && strcmp(seen->device, device) == 0;
}

bool drives(const emulated_store_seen *seen) {
    return is(seen, "timer[1]", 0x44) && (seen->value & MOE) != 0;
}

bool kicks(const emulated_store_seen *seen) {
    return is(seen, "I2S2ext", 0) && seen->value == 0xAAAA;
}

void set_mark(uint32_t value) { emulated_store(&board, TIM1_MARK, value); }

static bool is_logged(uint32_t value, uint64_t *number) {
    const uint64_t oldest = board.stores > EMULATED_STORES ? board.stores - EMULATED_STORES : 0;
    for (uint64_t n = board.stores; n-- > oldest;) {
        if (is(seen_at(n), "timer[1]", 0x38) && seen_at(n)->value == value) {
            *number = n;
            return true;
        }
    }
    return false;
}

bool marked(uint32_t value, uint64_t *number) {
    for (unsigned ms = 0; !is_logged(value, number); ms++) {
        if (ms == LOG_BEHIND_MS) {
            return no("the mark is not in the log");
        }
        emulated_wait(&board, 1);
    }
    return true;
}

bool starts_after(uint64_t number) {
    for (unsigned i = 0; i < LOG_BEHIND_MS / 50U; i++) {
        for (uint64_t n = number; n < board.stores; n++) {
            if (is(seen_at(n), "timer[1]", 0) && seen_at(n)->value == 1) {
                return true;
            }
        }
        emulated_wait(&board, 50);
    }
    return no("it does not start");
}
