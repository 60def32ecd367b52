/* reach.c: which blocks of a program a test reaches. The compiler calls this at the head of each (gcc -fsanitize-coverage=
 * trace-pc); a byte of $REACH_FOLDER/PROGRAM.map stands for each byte of its code. The file is shared memory: processes add to it
 * that are started by others, and what was reached stands there when one is killed. Made by mk/tests.mk, read by
 * times.sh. */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Names of the linker's and the compiler's. */
extern const char code_begins[] __asm__("__executable_start");
extern const char code_ends[] __asm__("etext");
void reach_block(void) __asm__("__sanitizer_cov_trace_pc");

static unsigned char *reached;

void reach_block(void) {
    if (reached != NULL) {
        reached[(uintptr_t)__builtin_return_address(0) - (uintptr_t)code_begins] = 1;
    }
}

__attribute__((constructor)) static void open_map(void) {
    const char *const folder = getenv("REACH_FOLDER");
    char program[4096];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1U);
    if (folder == NULL || length <= 0) {
        return;
    }
    program[length] = '\0';
    const char *const name = strrchr(program, '/');
    char path[8192];
    if (name == NULL || snprintf(path, sizeof path, "%s%s.map", folder, name) >= (int)sizeof path) {
        return;
    }
    const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    const size_t size = (size_t)((uintptr_t)code_ends - (uintptr_t)code_begins) + 1U;
    if (file < 0 || ftruncate(file, (off_t)size) != 0) {
        perror(path);
        abort();
    }
    void *const map = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    (void)close(file);
    if (map == MAP_FAILED) {
        perror(path);
        abort();
    }
    reached = map;
}
