/* watchdog.c: a board's watchdog must do nothing if it is kicked in time. Otherwise it must interrupt after its
 * timeout, and then reset the board (watchdog.sh). */
#include "hal/watchdog.h"
#include "boards/board.h"
#include "core/text.h"
#include "hal/clock.h"

#define TIMEOUT_TICKS 50000U
#define KICKS 40U
#define WAITING 0xB17E0001U
#define INTERRUPTED 0xB17E0002U

/* Memory that keeps its contents through a reset. After power-on its contents are arbitrary. */
#define KEPT __attribute__((section(".noinit")))
KEPT static volatile uint32_t stage;
KEPT static volatile uint32_t kicked_at;
KEPT static volatile uint32_t interrupted_at;
KEPT static volatile uint32_t last_seen;

/* The watchdog's interrupt. Waits for the reset, as a fault's handler would. */
void on_nmi(void);
void on_nmi(void) {
    interrupted_at = board_ticks();
    stage = stage == WAITING ? INTERRUPTED : 0;
    for (;;) {
        last_seen = board_ticks();
    }
}

static void say(const char *words, uint32_t ticks) {
    char bytes[96];
    wh_text line;
    wh_text_start(&line, bytes, sizeof bytes);
    wh_text_add(&line, words);
    wh_text_add_unsigned(&line, ticks / (board_ticks_per_s / HAL_TICKS_PER_S));
    wh_text_add(&line, " us\n");
    hal_console_write(line.bytes, line.length);
}

static uint32_t in_us(uint32_t us) {
    return board_ticks() + us * (board_ticks_per_s / HAL_TICKS_PER_S);
}

int main(void) {
    board_start();
    if (stage == INTERRUPTED) {
        say("interrupted after ", interrupted_at - kicked_at);
        say("reset after ", last_seen - kicked_at);
        return 0;
    }
    stage = 0;
    const uint32_t began = board_ticks();
    hal_watchdog_start(TIMEOUT_TICKS);
    for (unsigned i = 0; i < KICKS; i++) { /* each kick comes after nine tenths of the timeout */
        board_wait_until(in_us(TIMEOUT_TICKS / 10U * 9U));
        kicked_at = board_ticks();
        hal_watchdog_kick();
    }
    stage = WAITING;
    say("kicked for ", kicked_at - began);
    board_wait_until(in_us(TIMEOUT_TICKS * 10U));
    say("nothing happened in ", board_ticks() - kicked_at);
    return 1;
}
