/* link.c: hal/link.h by semihosting (Arm semihosting specification 2.0: SYS_OPEN, SYS_WRITE, SYS_READ). The debugger or
 * emulator opens the inherited descriptors as /dev/fd/N, so no file remains. A read waits for data. */
#include "hal/link.h"

#include "boards/board.h"

enum { SYS_OPEN = 0x01, SYS_WRITE = 0x05, SYS_READ = 0x06 };
enum { MODE_READ_BINARY = 1, MODE_WRITE_BINARY = 5 };

static uint32_t down;
static uint32_t up;

static uint32_t call(uint32_t number, const uint32_t *block) {
    register uint32_t operation __asm__("r0") = number;
    register const uint32_t *argument __asm__("r1") = block;
    __asm__ volatile("bkpt 0xAB" : "+r"(operation) : "r"(argument) : "memory");
    return operation;
}

static uint32_t open_file(const char *name, unsigned length, uint32_t mode) {
    const uint32_t block[3] = {(uint32_t)(uintptr_t)name, mode, length};
    return call(SYS_OPEN, block);
}

bool hal_link_open(void) {
    static const char down_name[] = {'/', 'd', 'e', 'v', '/', 'f', 'd', '/', '0' + HAL_LINK_DOWN,
                                     0};
    static const char up_name[] = {'/', 'd', 'e', 'v', '/', 'f', 'd', '/', '0' + HAL_LINK_UP, 0};
    down = open_file(down_name, sizeof down_name - 1, MODE_READ_BINARY);
    up = open_file(up_name, sizeof up_name - 1, MODE_WRITE_BINARY);
    return down != UINT32_MAX && up != UINT32_MAX;
}

unsigned hal_link_read(uint8_t *bytes, unsigned room) {
    const uint32_t block[3] = {down, (uint32_t)(uintptr_t)bytes, room};
    const uint32_t missing = call(SYS_READ, block);
    if (missing >= room) {
        board_exit(HAL_LINK_GONE);
    }
    return room - missing;
}

void hal_link_write(const uint8_t *bytes, unsigned count) {
    for (unsigned done = 0; done < count;) {
        const uint32_t block[3] = {up, (uint32_t)(uintptr_t)(bytes + done), count - done};
        const uint32_t missing = call(SYS_WRITE, block);
        if (missing >= count - done) {
            board_exit(HAL_LINK_GONE);
        }
        done = count - missing;
    }
}

uint32_t hal_link_timer(void) { return board_ticks(); }
uint32_t hal_link_timer_per_s(void) { return board_ticks_per_s; }
const char *hal_link_board(void) { return board_name; }
