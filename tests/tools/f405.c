/* f405.c: an STM32F405's firmware in QEMU's netduinoplus2, driven and observed from outside.
 *
 *     f405 boot|console|time IMAGE [TIMES [SEED]]      the flashed image (station.elf)
 *     f405 slots|storm IMAGE ...                       tests/boards/f405_slots.c
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
#define SHIFT 7U       /* 128 ns per instruction: slower than the real chip */
#define SHIFT_STORM 4U /* 16 ns: the board's time is so slow that edges from outside are a storm */
#define EXTI "/machine/unattached/device[0]/exti"

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

static unsigned told; /* edges since the last query */

static bool ask_late(unsigned *late, unsigned *overruns, unsigned *periods) {
    char line[100];
    told = 0;
    emulated_say(&board, "l");
    for (unsigned lines = 0; lines < 5000; lines++) {
        if (!emulated_hear(&board, line, sizeof line, 60000)) {
            return no("'l' is not answered");
        }
        unsigned numbers[3];
        if (numbers_of(line, numbers, 3) == 3) {
            *late = numbers[0];
            *overruns = numbers[1];
            *periods = numbers[2];
            return true;
        }
        told++;
    }
    return no("'l' is not answered");
}

static bool sees_edges(unsigned times) {
    char line[100];
    unsigned late = 0;
    unsigned overruns = 0;
    unsigned periods = 0;
    if (!ask_late(&late, &overruns, &periods)) {
        return false;
    }
    for (unsigned i = 0; i < times; i++) {
        const unsigned sensor = below(2);
        unsigned said[2]; /* the two printed numbers: sensor, ticks */
        const uint32_t before = emulated_load(&board, TIM2_CNT);
        emulated_set_line(&board, EXTI, sensor, true);
        const uint32_t after = emulated_load(&board, TIM2_CNT);
        emulated_set_line(&board, EXTI, sensor, false); /* ends the pulse */
        if (!emulated_hear(&board, line, sizeof line, 60000) || numbers_of(line, said, 2) != 2) {
            return no("edge %u is not told", i);
        }
        /* 20 us: the interrupt takes some tens of instructions of 0.128 us */
        if (said[0] != sensor || said[1] - before > after - before + 20U) {
            return no("edge %u of sensor %u between %u and %u: '%s'", i, sensor, (unsigned)before,
                      (unsigned)after, line);
        }
    }
    return !emulated_hear(&board, line, sizeof line, 300) || no("one more: '%s'", line);
}

/* Number of edges between two pauses. On a fast machine, single edges with pauses between them would be no storm. */
#define BURST 8U

static bool survives_storm(unsigned times) {
    unsigned late = 0;
    unsigned overruns = 0;
    unsigned before = 0;
    unsigned periods = 0;
    if (!ask_late(&late, &overruns, &before)) {
        return false;
    }
    const uint32_t began = emulated_load(&board, TIM2_CNT);
    for (unsigned i = 0; i < times; i++) {
        emulated_set_line(&board, EXTI, i % 2, true);
        emulated_set_line(&board, EXTI, i % 2, false);
        if (i % BURST == BURST - 1) {
            emulated_wait(&board, 1); /* without pauses the emulator would stall */
        }
    }
    const uint32_t took = emulated_load(&board, TIM2_CNT) - began;
    const double per_s = 1e6 * times / took;
    if (!ask_late(&late, &overruns, &periods)) {
        return false;
    }
    printf("# %u edges, %.0f a second, %u told, latest wait %u ticks, %u overruns\n", times, per_s,
           told, late, overruns);
    return (late <= 200 || no("a period ended %u ticks late", late)) &&
           (periods - before + 3U >= took / 2000U ||
            no("%u periods in %u ticks", periods - before, (unsigned)took)) &&
           (per_s > 2000.0 || no("only %.0f edges a second: no storm", per_s)) &&
           (told > 100 || no("only %u of %u edges are told", told, times));
}

int main(int count, char **words) {
    static const board_test tests[] = {
        {"boot", boots, 1, "boots though no clock ever answers, converses, and refuses to arm"},
        {"console", converses, 40, "each line is answered, through the receive interrupt"},
        {"time", keeps_time, 3, "control periods are 2 ms of timer 2"},
        {"slots", sees_edges, 100, "each edge once, its sensor, its time between before and after"},
        {"storm", survives_storm, 2000, "a storm of edges does not hold up the control period"},
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
    emulated_start(&board, MACHINE, image, SERIALS_BEFORE,
                   asked.holds == survives_storm ? SHIFT_STORM : SHIFT);
    (void)snprintf(what, sizeof what, "%s, %u times, seed %s: %s", asked.name, asked.times,
                   count > 4 ? words[4] : "1", asked.what);
    const int failed = board_test_tell(starts_after(0) && asked.holds(asked.times), what);
    emulated_end(&board);
    return failed;
}
