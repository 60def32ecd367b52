/* settings.c: hal/settings.h on the PC, in the file that RIG_SETTINGS names. A write ends when its data are on disk. */
#define _POSIX_C_SOURCE 200809L

#include "hal/settings.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *name_of_file(void) {
    const char *wanted = getenv("RIG_SETTINGS");
    return wanted != NULL && wanted[0] != '\0' ? wanted : "build/rig.settings";
}

static off_t place_of(unsigned slot, unsigned at) {
    return (off_t)(slot * HAL_SETTINGS_BYTES + at);
}

static bool put(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    const int file = open(name_of_file(), O_RDWR | O_CREAT, 0666);
    unsigned done = 0;
    while (file >= 0 && done < count) {
        const ssize_t more = pwrite(file, bytes + done, count - done, place_of(slot, at + done));
        if (more <= 0 && errno != EINTR) {
            break;
        }
        done += more > 0 ? (unsigned)more : 0U;
    }
    const bool kept = file >= 0 && fsync(file) == 0;
    return file >= 0 && close(file) == 0 && kept && done == count;
}

bool hal_settings_erase(unsigned slot) {
    uint8_t blank[HAL_SETTINGS_BYTES];
    memset(blank, 0xFF, sizeof blank);
    return put(slot, 0, blank, sizeof blank);
}

bool hal_settings_write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    return put(slot, at, bytes, count);
}

/* A byte that the file lacks reads as erased (0xFF). */
bool hal_settings_read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    memset(bytes, 0xFF, count);
    const int file = open(name_of_file(), O_RDONLY);
    if (file < 0) {
        return errno == ENOENT;
    }
    const ssize_t had = pread(file, bytes, count, place_of(slot, at));
    return close(file) == 0 && had >= 0;
}
