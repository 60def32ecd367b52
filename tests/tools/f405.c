/* f405.c: an STM32F405's firmware in QEMU's netduinoplus2, driven and observed from outside.
 *
 *     f405 boot|console|time IMAGE [TIMES [SEED]]      the flashed image (station.elf)
 *     f405 faults|resets IMAGE ...                     the firmware with a plant inside (tests/boards/f405_plant.c)
 *
 * Prints "ok - ..." or "not ok - ..." lines; exit status 1 if one fails. QEMU has no registers of the motor's timer but logs
 * each store to one: the tests check their order. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/tools/f405.h"

#define MACHINE "netduinoplus2"
#define SERIALS_BEFORE 5U
#define SHIFT 7U /* 128 ns per instruction: slower than the real chip */

static bool boots(unsigned times) {
    char line[300];
    (void)times;
    return answers("id", "OK program=rig board=netduinoplus2 ", line, sizeof line) &&
           (board.stores > 0 || no("no store is logged")) &&
           answers("arm", "ERR 8 ", line,
                   sizeof line) && /* the emulator's stop line reads as broken */
           answers("start 330", "ERR 1 ", line, sizeof line);
}

static bool converses(unsigned times) {
    static const struct {
        const char *order;
        const char *answer;
    } said[] = {{"id", "OK program="},
                {"host 0", "OK"},
                /* the whole line: it shows that packed words are printed right */
                {"fault", "OK trip=0 ended=none: no fault"},
                {"clear", "ERR 6 there is no trip to clear"},
                {"measure", "ERR 104 there is no result"},
                {"set 20", "ERR 7 the rig is not running"},
                {"nonsense", "ERR 100 no such command; help lists them"},
                {"start much", "ERR 103 give a number, such as 330 or 330.5"},
                {"help clear", "OK clear: release a trip whose cause is gone"}};
    char line[300];
    char many[900] = "";
    for (unsigned i = 0; i < times; i++) {
        const unsigned which = below(sizeof said / sizeof said[0]);
        if (!answers(said[which].order, said[which].answer, line, sizeof line)) {
            return false;
        }
    }
    /* 400 bytes in one write: more than the ring can store */
    memset(many, 'x', 400);
    many[400] = '\0';
    emulated_say(&board, many);
    emulated_wait(&board, 300);
    if (!answers_at_last("", "ERR 101", line, sizeof line)) {
        return false;
    }
    many[0] = '\0';
    for (unsigned i = 0; i < 10; i++) {
        /* in one write: the interrupt stores all lines, and each control step answers one */
        strcat(many, i % 2 == 0 ? "id\r" : "fault\r");
    }
    emulated_say(&board, many);
    for (unsigned i = 0; i < 10; i++) {
        if (!emulated_hear(&board, line, sizeof line, 60000) ||
            strncmp(line, i % 2 == 0 ? "OK program" : "OK trip", 7) != 0) {
            return no("line %u of ten in one go is not answered", i + 1);
        }
    }
    return answers("status", "OK ", line, sizeof line) &&
           (strstr(line, "lost_answers=0 lost_bytes=0") != NULL || no("lost some: %s", line));
}

static bool keeps_time(unsigned times) {
    char line[300];
    if (!answers("id", "OK ", line, sizeof line)) {
        return false;
    }
    for (unsigned i = 0; i < times; i++) {
        uint64_t from = board.stores;
        const uint32_t began = emulated_load(&board, TIM2_CNT);
        emulated_wait(&board, 200 + below(300));
        const uint32_t passed = emulated_load(&board, TIM2_CNT) - began;
        emulated_wait(&board, 20);
        unsigned kicked = 0;
        from = board.stores - from < EMULATED_STORES ? from : board.stores - EMULATED_STORES;
        for (uint64_t n = from; n < board.stores; n++) {
            kicked += kicks(seen_at(n)) ? 1U : 0U;
        }
        /* the log ends between the second and the third reading of the timer, so these are the limits */
        const double periods = (double)passed / 2000.0;
        const double at_most = (double)(emulated_load(&board, TIM2_CNT) - began) / 2000.0;
        if (passed < 2000 || kicked + 2.0 < periods || kicked > at_most + 30.0) {
            return no("%u control periods in %.1f to %.1f of 2 ms", kicked, periods, at_most);
        }
    }
    return true;
}

int main(int count, char **words) {
    static const board_test tests[] = {
        {"boot", boots, 1, "boots though no clock ever answers, converses, and refuses to arm"},
        {"console", converses, 40, "each line is answered, through the receive interrupt"},
        {"time", keeps_time, 3, "control periods are 2 ms of timer 2"},
        {"faults", all_faults, 12,
         "a fault in whatever state: off first, then the record, reset, report; a trip stays"},
        {"resets", all_resets, 20,
         "a reset at whatever instant: not driven, idle or still tripped, its cause told"},
    };
    board_test asked;
    char what[300];
    if (board_test_asked(count, words, tests, sizeof tests / sizeof tests[0], &asked) == NULL) {
        return 2;
    }
    emulated_start(&board, MACHINE, image, SERIALS_BEFORE, SHIFT);
    (void)snprintf(what, sizeof what, "%s, %u times, seed %s: %s", asked.name, asked.times,
                   count > 4 ? words[4] : "1", asked.what);
    const int failed = board_test_tell(starts_after(0) && asked.holds(asked.times), what);
    emulated_end(&board);
    return failed;
}
