/* link_console.c: hal/link.h over the console of a real board. The program also prints text there, so a zero byte
 * precedes each frame and ends the text. The board does not detect the end of the simulator. */
#include "hal/link.h"

#include "boards/board.h"

bool hal_link_open(void) { return board_converse(); }

/* one poll every 20 us, because a device may store only one byte, and a byte takes 87 us at 115,200 baud */
#define POLLS_PER_S 50000U

unsigned hal_link_read(uint8_t *bytes, unsigned room) {
    unsigned count = hal_console_read((char *)bytes, room);
    while (count == 0) {
        board_wait_until(board_ticks() + board_ticks_per_s / POLLS_PER_S);
        count = hal_console_read((char *)bytes, room);
    }
    return count;
}

static void offer_all(const char *bytes, unsigned count) {
    for (unsigned done = 0; done < count;) {
        done += hal_console_offer(bytes + done, count - done);
    }
}

void hal_link_write(const uint8_t *bytes, unsigned count) {
    static const char apart = 0;
    offer_all(&apart, 1);
    offer_all((const char *)bytes, count);
}

uint32_t hal_link_timer(void) { return board_ticks(); }
uint32_t hal_link_timer_per_s(void) { return board_ticks_per_s; }
const char *hal_link_board(void) { return board_name; }
