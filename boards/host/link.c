/* link.c: hal/link.h on the PC: two descriptors inherited from the parent process. */
#define _POSIX_C_SOURCE 200809L

#include "hal/link.h"

#include "boards/board.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

bool hal_link_open(void) {
    return signal(SIGPIPE, SIG_IGN) != SIG_ERR && fcntl(HAL_LINK_DOWN, F_GETFD) >= 0 &&
           fcntl(HAL_LINK_UP, F_GETFD) >= 0;
}

unsigned hal_link_read(uint8_t *bytes, unsigned room) {
    ssize_t count;
    do {
        count = read(HAL_LINK_DOWN, bytes, room);
    } while (count < 0 && errno == EINTR);
    if (count <= 0) {
        board_exit(HAL_LINK_GONE);
    }
    return (unsigned)count;
}

void hal_link_write(const uint8_t *bytes, unsigned count) {
    for (unsigned done = 0; done < count;) {
        const ssize_t more = write(HAL_LINK_UP, bytes + done, count - done);
        if (more < 0 && errno != EINTR) {
            board_exit(HAL_LINK_GONE);
        }
        done += more > 0 ? (unsigned)more : 0U;
    }
}

/* No timer, because the computing time of a PC says nothing about a controller. */
uint32_t hal_link_timer(void) { return 0; }
uint32_t hal_link_timer_per_s(void) { return 0; }
const char *hal_link_board(void) { return board_name; }
