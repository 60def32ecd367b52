/* test_dialogue.c: what a rig is asked before it is recorded, whatever stands in the line by then: answers to somebody
 * else, half a line, half a frame, an echo, answers that come late and twice.
 *
 * The rig is a few lines of its own: it answers each line that is whole, in order. */
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/monitor/wire.h"
#include "unity.h"

void suite_dialogue(void);

enum { LINES = 64 };

/* What stands in the line, in order, towards whoever asks. */
typedef struct rig {
    char said[LINES][128];
    int begin;
    int end;
    bool echoes;
    bool refuses_rate;
    int heard;     /* questions */
    char half[16]; /* that somebody has begun to type */
    char junk[16]; /* the end of a frame, in front of what it says first */
} rig;

static void say(rig *r, const char *line) {
    TEST_ASSERT_TRUE(r->end < LINES);
    snprintf(r->said[r->end++], sizeof r->said[0], "%s%s", r->junk, line);
    r->junk[0] = '\0';
}

/* As docs/console.md has them. */
static const char *answer_of(const rig *r, const char *line) {
    static const char *const answers[][2] = {
        {"id\n", "OK program=rig board=none dialogue=1"},
        {"talk off\n", "OK"},
        {"tel list\n", "OK rate=0 fmt=frames dropped=0 channels=run,event,ring"},
        {"tel off\n", "OK"},
        {"tel fmt frames\n", "OK fmt=frames"},
        {"tel schema run\n", "OK channel=0 name=run period_ticks=2000 once= each="},
        {"tel schema event\n", "OK channel=1 name=event period_ticks=0 once= each="},
        {"tel schema ring\n", "OK channel=2 name=ring period_ticks=0 once= each="},
        {"tel schema states\n", "OK 0=idle 1=armed"},
        {"tel rate 125\n", "OK rate=125 period_ticks=8000"}};
    for (size_t i = 0; i < sizeof answers / sizeof answers[0]; i++) {
        if (strcmp(line, answers[i][0]) == 0) {
            return r->refuses_rate && strncmp(line, "tel rate", 8) == 0 ? "ERR 116 not so many"
                                                                        : answers[i][1];
        }
    }
    return "ERR 100 no such command";
}

static void hear(rig *r, const char *line) {
    char whole[96];
    snprintf(whole, sizeof whole, "%s%s", r->half, line);
    r->half[0] = '\0';
    if (r->echoes) {
        whole[strcspn(whole, "\n")] = '\0';
        say(r, whole);
        snprintf(whole, sizeof whole, "%s", line);
    }
    r->echoes = r->echoes && strcmp(line, "talk off\n") != 0;
    if (strcmp(whole, "\n") != 0 && whole[0] != '\0') {
        say(r, answer_of(r, whole));
    }
    r->heard++;
}

/* What somebody before has left. */
static void leave(rig *r, dice *d) {
    static const char *const left[] = {"OK",
                                       "ERR 101 the line is too long",
                                       "ERR 116 not so many",
                                       "OK rate=500 period_ticks=2000",
                                       "OK state=idle speed_rpm=0.00",
                                       ">load_N:56.064",
                                       "# idle",
                                       "OK rate=500 fmt=frames dropped=0 channels=run",
                                       "D D \x07\x1b[2J",
                                       "K fmt=frames",
                                       ""};
    for (unsigned i = dice_one_of(d, 5); i > 0; i--) {
        say(r, left[dice_one_of(d, sizeof left / sizeof left[0])]);
    }
    if (dice_one_of(d, 2) == 0) {
        snprintf(r->half, sizeof r->half, "%s", dice_one_of(d, 2) == 0 ? "sta" : "start 330");
    }
    snprintf(r->junk, sizeof r->junk, "%s", dice_one_of(d, 3) == 0 ? "D \x9b\x02`" : "");
    r->echoes = dice_one_of(d, 3) == 0;
}

static void question(const dialogue *d, rig *r) {
    char line[DIALOGUE_LINE];
    const char *asked = dialogue_question(d, line);
    if (asked != NULL) {
        hear(r, asked);
    }
}

/* Each line comes, now and then after patience has ended and the question was asked once more. */
static void converse(dialogue *talk, rig *r, dice *d) {
    hear(r, "\n");
    question(talk, r);
    for (int turns = 0; !talk->done && turns < 4 * LINES; turns++) {
        if (r->begin == r->end || (!r->refuses_rate && dice_one_of(d, 6) == 0)) {
            question(talk, r);
            continue;
        }
        const int asked = talk->asked;
        (void)dialogue_answer(talk, r->said[r->begin++]);
        TEST_ASSERT_TRUE(talk->asked == asked || talk->asked == asked + 1);
        if (talk->asked > asked) {
            question(talk, r);
        }
    }
}

static void one_case(dice *d) {
    static rig r;
    r = (rig){.refuses_rate = dice_one_of(d, 4) == 0};
    dialogue talk = {.rate = 125};
    leave(&r, d);
    converse(&talk, &r, d);
    TEST_ASSERT_TRUE(talk.done);
    TEST_ASSERT_TRUE(talk.was_off); /* of the rig's own list: those left say otherwise */
    TEST_ASSERT_EQUAL(r.refuses_rate, talk.rate_refused);
    TEST_ASSERT_EQUAL_STRING(r.refuses_rate ? "tel rate 125: ERR 116 not so many" : "",
                             talk.refused);
    TEST_ASSERT_EQUAL(10, talk.asked);
    TEST_ASSERT_FALSE(dialogue_answer(&talk, "OK")); /* to somebody else */
}

static void test_it_comes_to_its_end_whatever_was_in_the_line(void) {
    dice d = dice_of("dialogue", 1);
    for (unsigned i = dice_cases(few_or_all(2000, 100000)); i > 0; i--) {
        one_case(&d);
    }
}

static void test_who_is_no_rig_is_not_met(void) {
    dialogue d = {.rate = 500};
    const char *const lines[] = {"OK", "ERR 100 no such command", "hello", "talk off",
                                 "OK rate=0 "};
    for (int i = 0; i < 100; i++) {
        (void)dialogue_answer(&d, lines[i % 5]);
    }
    TEST_ASSERT_EQUAL(0, d.asked);
    TEST_ASSERT_FALSE(d.done);
    TEST_ASSERT_EQUAL_STRING("", d.refused);
}

void suite_dialogue(void) {
    RUN_TEST(test_it_comes_to_its_end_whatever_was_in_the_line);
    RUN_TEST(test_who_is_no_rig_is_not_met);
}
