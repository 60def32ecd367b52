/* kept.c: replays stored inputs of a fuzzer, without the fuzzer. `NAME FILE...` gives each file to the linked
 * LLVMFuzzerTestOneInput(). Each file's name is printed first, so after a crash the last name is that of the failing
 * input. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIZE_MAX_BYTES = 8192 }; /* largest input in tests/fuzz.sh */

static uint8_t data[SIZE_MAX_BYTES];

/* Reads the bytes of a file. Returns their number; -1 if the file cannot be read or is longer than a fuzzer's
 * inputs. */
static long bytes_of(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return -1;
    }
    const size_t size = fread(data, 1, sizeof data, file);
    const int is_all = getc(file) == EOF && !ferror(file);
    fclose(file);
    return is_all ? (long)size : -1;
}

int main(int count, char **path) {
    if (count < 2) {
        fprintf(stderr, "usage: %s FILE...\n", path[0]);
        return 2;
    }
    for (int i = 1; i < count; i++) {
        fprintf(stderr, "\r%s", path[i]);
        const long size = bytes_of(path[i]);
        if (size < 0) {
            fprintf(stderr, ": error: cannot be read, or is longer than %d bytes\n",
                    (int)SIZE_MAX_BYTES);
            return 2;
        }
        /* the exact size, so that a sanitizer sees a read past its end */
        uint8_t *given = malloc(size > 0 ? (size_t)size : 1);
        if (given == NULL) {
            return 2;
        }
        memcpy(given, data, (size_t)size);
        (void)LLVMFuzzerTestOneInput(given, (size_t)size);
        free(given);
    }
    fprintf(stderr, "\r%d files\n", count - 1);
    return 0;
}
