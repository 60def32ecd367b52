/* f405_slots.c: prints every slot pulse as "sensor ticks" in a loop of control periods. A storm of edges must not
 * delay the loop. Answers 'l' with "late ticks overruns periods", the lateness since the last 'l'. */
#include "boards/board.h"
#include "core/text.h"
#include "hal/clock.h"
#include "hal/slots.h"

#define PERIOD_TICKS 2000U
#define PULSES_A_PERIOD 4U

static void say(const uint32_t *numbers, unsigned count) {
    char bytes[64];
    wh_text line;
    wh_text_start(&line, bytes, sizeof bytes);
    for (unsigned i = 0; i < count; i++) {
        wh_text_add_unsigned(&line, numbers[i]);
        wh_text_add_char(&line, i + 1U < count ? ' ' : '\n');
    }
    (void)hal_console_offer(line.bytes, line.length);
}

int main(void) {
    board_start();
    if (!hal_clock_start()) {
        board_exit(2);
    }
    uint32_t due = hal_clock_ticks();
    for (uint32_t periods = 0;; periods++) {
        hal_slot_edge pulse;
        char asked;
        due += PERIOD_TICKS;
        hal_clock_wait_until(due);
        for (unsigned i = 0; i < PULSES_A_PERIOD && hal_slots_take(&pulse); i++) {
            const uint32_t numbers[2] = {pulse.sensor, pulse.ticks};
            say(numbers, 2);
        }
        if (hal_console_read(&asked, 1) == 1 && asked == 'l') {
            const uint32_t numbers[3] = {hal_clock_late_ticks(), hal_slots_overruns(), periods};
            say(numbers, 3);
        }
    }
}
