/* test_replay.c: a tape in the plant's place (host/pil/taped.c), drawn: played to its end, or to the firmware's; ended at the
 * first answer that is not the tape's, which is said; refused where it is another firmware's, or none. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "drawn_talk.h"
#include "unity.h"

void suite_replay(void);

/* Plays it: ends so, after so many turns; returns what was said. */
static const char *replay(lockstep_end end, unsigned turns, bool with_hello) {
    static stream heard;
    char name[] = "/tmp/whirl-talk-XXXXXX";
    const int file = mkstemp(name);
    TEST_ASSERT_TRUE(file >= 0 && write(file, talk_on_tape.bytes, talk_on_tape.length) ==
                                      (ssize_t)talk_on_tape.length);
    close(file);
    talk_open_line(true);
    errors_catch();
    lockstep_replay(&talk_wish, name, &talk_report);
    const char *told = errors_caught();
    (void)remove(name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(end, talk_report.end, told);
    TEST_ASSERT_EQUAL_UINT64(turns, talk_report.exchanges);
    TEST_ASSERT_TRUE(!with_hello || strcmp(talk_report.program, "drawn") == 0);
    talk_close_line(&heard);
    return told;
}

static double time_of(unsigned turn) {
    return (double)(talk_drawn.ticks[turn] - talk_drawn.hello.start_ticks) / 1e6;
}

/* Until the tape's end; or the firmware's, which is the tape's, too; or the tape's last word, which nobody had answered. */
static void test_replayed(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(30, 12)); c++) {
        talk_draw();
        talk_tape_all(talk_drawn.turns - 1U);
        const unsigned all = talk_drawn.turns - 1U;
        const unsigned kind = c % 3;
        if (kind > 0) {
            talk_put_readings(&talk_on_tape, all);
        }
        talk_say_all(kind == 2 ? talk_drawn.turns : all);
        talk_put_end(&talk_line, 42, 4);
        const lockstep_end end = kind == 1 ? LOCKSTEP_DONE : LOCKSTEP_LET_GO;
        TEST_ASSERT_EQUAL_STRING("", replay(end, kind == 2 ? talk_drawn.turns : all, true));
        talk_expect_report(end, kind == 2 ? talk_drawn.turns : all);
        TEST_ASSERT_EQUAL_HEX64(talk_hash_of(all), talk_report.op_list_hash);
        TEST_ASSERT_TRUE(fabs(talk_report.time_s - time_of(kind == 0 ? all - 1U : all)) < 1e-9);
        TEST_ASSERT_EQUAL_INT(kind == 1 ? 42 : -1, talk_report.status.status);
    }
}

/* Another answer in one turn: there it ends, and says which outputs. What was counted is no matter. */
static void test_other_orders(void) {
    unsigned hints = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(50, 24)); c++) {
        char words[120];
        talk_draw();
        talk_tape_all(talk_drawn.turns);
        const unsigned turn = talk_one_of(talk_drawn.turns);
        const unsigned output = talk_one_of(talk_drawn.outputs);
        wh_orders *o = &talk_drawn.orders[turn];
        const float before = o->output[output];
        switch (c % 6) {
        case 0: o->output[output] += 1.0F; break;
        case 1: o->until_ticks++; break;
        case 2: o->watchdog_ticks++; break;
        case 3: o->flags ^= WH_ORDER_ALIVE; break;
        case 4: talk_drawn.remembers[turn] = talk_drawn.remembers[turn] == 99 ? 0 : 99; break;
        default:
            o->acted_timer++;
            o->busy_timer++;
            o->step_timer++;
        }
        talk_say_all(talk_drawn.turns);
        if (c % 6 == 5) {
            TEST_ASSERT_EQUAL_STRING("", replay(LOCKSTEP_LET_GO, talk_drawn.turns, true));
            continue;
        }
        const char *told = replay(LOCKSTEP_DIFFERENT, turn + 1U, true);
        snprintf(words, sizeof words,
                 "whirl pil: error: exchange %u, t = %.6f s: other orders than on the tape\n",
                 turn + 1U, time_of(turn));
        told = said_exactly(told, words);
        if (c % 6 == 0) {
            snprintf(words, sizeof words, "hint: output %u is %.9g, on the tape %.9g\n",
                     output + 1U, (double)o->output[output], (double)before);
            told = said_exactly(told, words);
            hints++;
        }
        TEST_ASSERT_EQUAL_STRING("", told);
    }
    TEST_ASSERT_TRUE(hints > 1);
}

static void test_not_replayed(void) {
    for (unsigned c = 0; c < 12; c++) {
        char words[120];
        talk_draw();
        talk_tape_all(talk_drawn.turns);
        const unsigned turns = talk_one_of(talk_drawn.turns);
        talk_say_all(turns);
        if (c % 4 == 0) { /* the firmware ends, and the tape goes on */
            talk_put_end(&talk_line, 0, 4);
            const char *told = replay(LOCKSTEP_DIFFERENT, turns, true);
            snprintf(words, sizeof words,
                     "exchange %u, t = %.6f s: the firmware ended, and the tape goes on\n", turns,
                     time_of(turns));
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, words), told);
        } else if (c % 4 == 1) { /* another firmware's */
            talk_drawn.hello.program = "another";
            talk_line.length = 0;
            talk_put_hello(&talk_line, &talk_drawn.hello);
            const char *told = replay(LOCKSTEP_BAD, 0, false);
            TEST_ASSERT_NOT_NULL_MESSAGE(
                strstr(
                    told,
                    "error: it is of 'drawn', whose signals are not those of the firmware 'another'\n"),
                told);
        } else if (c % 4 == 2) { /* a broken tape */
            talk_on_tape.length -= 3;
            talk_say_all(talk_drawn.turns);
            const char *told = replay(LOCKSTEP_BAD, talk_drawn.turns - 1U, true);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "error: it is broken after "), told);
        } else { /* none */
            talk_on_tape.length = 2;
            const char *told = replay(LOCKSTEP_BAD, 0, false);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "error: no tape of this version after 0"),
                                         told);
        }
    }
}

/* A tape on which the firmware was reset: over a line nobody can. */
static void test_reset_on_tape(void) {
    uint8_t payload[WH_RESET_BYTES];
    const wh_reset reset = {.cause = WH_RESET_WATCHDOG};
    talk_draw();
    talk_tape_all(2);
    talk_put_hello(&talk_on_tape, &talk_drawn.hello);
    talk_put(&talk_on_tape, WH_FRAME_RESET, 0, talk_drawn.ticks[1], payload,
             wh_reset_put(&reset, payload, sizeof payload));
    talk_say_all(2);
    const char *told = replay(LOCKSTEP_FAILED, 2, true);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "nothing that resets it"), told);
}

void suite_replay(void) {
    talk_die(dice_of("replay", 50));
    RUN_TEST(test_replayed);
    RUN_TEST(test_other_orders);
    RUN_TEST(test_not_replayed);
    RUN_TEST(test_reset_on_tape);
}
