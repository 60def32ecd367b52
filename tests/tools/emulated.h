/* emulated.h: a board in QEMU with its image, driven from outside by its console and by qtest (memory). The
 * log of stores to devices that QEMU does not model (-d unimp) is read too.
 *
 * A fault of the emulator itself ends the program with a message. */
#ifndef TESTS_TOOLS_EMULATED_H
#define TESTS_TOOLS_EMULATED_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define EMULATED_STORES 4096U /* only the newest are stored */

typedef struct emulated_store_seen {
    char device
        [12]; /* QEMU's name: timer[1], GPIOB, I2S2ext (the block that contains the watchdog) */
    uint32_t offset;
    uint32_t value;
} emulated_store_seen;

typedef struct emulated {
    pid_t process;
    int console;
    int test;
    int log;
    char heard[262144]; /* bytes from the console that were not read yet */
    unsigned heard_bytes;
    char said[256]; /* the answer of qtest */
    unsigned said_bytes;
    char logged[512]; /* the log's last, incomplete line */
    unsigned logged_bytes;
    emulated_store_seen store[EMULATED_STORES];
    uint64_t stores; /* number of stores since the start */
} emulated;

/* `serial`: number of interfaces before the console's. An instruction takes 2^shift ns of the board's time. */
void emulated_start(emulated *e, const char *machine, const char *elf, unsigned serial,
                    unsigned shift);
void emulated_end(emulated *e);

void emulated_say(emulated *e, const char *words);

/* Reads the console's next line. Returns false after `ms` of the emulator's processor time, or 20 `ms` in all. */
bool emulated_hear(emulated *e, char *line, unsigned room, unsigned ms);

void emulated_wait(emulated *e, unsigned ms);

uint32_t emulated_load(emulated *e, uint32_t address);
void emulated_store(emulated *e, uint32_t address, uint32_t value);

#endif
