/* test_contact_begin.c: the begin of a step (contact_step.h) sets all values that the contacts' laws read, and copies
 * the holds' values from the state. */
#include <stddef.h>

#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

static union {
    wh_contact_work work;
    unsigned char byte[sizeof(wh_contact_work)];
} soiled;

TEST(contact_begin, nothing_is_left_of_what_was_there) {
    uint64_t seed = 2324;
    for (unsigned round = 0; round < 200; round++) {
        static const wh_contact_kind kinds[] = {WH_STOP, WH_HOLD, WH_FRICTION};
        const unsigned count = 1U + draw_one_of(&seed, 3);
        hand_build(2, WH_R(3.0), WH_R(1.0), WH_R(2.0));
        for (unsigned k = 0; k < count; k++) {
            const wh_contact_kind kind = kinds[draw_one_of(&seed, 3)];
            hand_add(kind, -1, WH_R(1.0), WH_R(0.5), WH_R(0.0), WH_R(0.5), WH_R(0.25));
            if (kind == WH_HOLD && hand_now.system.held == 0) {
                hand_now.system.held = 1; /* the state has memory for the value of one hold */
            }
        }
        hand_start(false);
        if (hand_now.system.held > 0) {
            hand_state.held[0] = draw_broken(&seed, -9, 9);
        }
        for (unsigned i = 0; i < sizeof soiled; i++) {
            soiled.byte[i] = (unsigned char)(0x55U + round % 3U * 0x2bU);
        }
        wh_contact_work_begin(&hand_now.system, &hand_state, &soiled.work);
        TEST_ASSERT_EQUAL_INT(-1, soiled.work.undefined);
        TEST_ASSERT_TRUE(count == 1 || soiled.byte[offsetof(wh_contact_work, capped)] == 0);
        TEST_ASSERT_TRUE(soiled.work.books == NULL);
        TEST_ASSERT_TRUE(hand_now.system.held == 0 || soiled.work.held[0] == hand_state.held[0]);
        for (unsigned k = 0; k < count; k++) {
            TEST_ASSERT_TRUE(hand_now.contact[k].kind != WH_FRICTION ||
                             soiled.work.slack[k] == WH_R(0.0));
        }
    }
}
