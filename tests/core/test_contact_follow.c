/* test_contact_follow.c: contacts that an input moves between steps (a stop with a resting body, a hold), and recorded
 * accelerations with contact forces, on mechanisms with closed forms (hand.h). */
#include "hand.h"
#include "tests/suites.h"

#define STEP_S WH_R(0.001)
/* Distance that a body falls in a step. */
#define REACH_M (WH_R(0.5) * HAND_G * STEP_S * STEP_S)

/* A ball of 1 kg at rest on a stop that the input moves. */
static void rest_on_a_stop(bool books) {
    hand_build_ball(WH_R(0.5));
    hand_now.weighs = true;
    hand_now.start[0] = WH_R(0.0);
    hand_now.contact[0].direction = 1;
    hand_start(books);
    hand_steps(3);
    TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_ACTIVE && hand_state.real[0] == WH_R(0.0));
}

/* The stop is raised, or lowered by at most the ball's fall in a step, and the ball stays on it. The stop's ledger
 * entry gets the energy m g s. */
TEST(contact_follow, moved_stop_carries_a_resting_ball) {
    const wh_real moves[] = {WH_R(1e-3), WH_R(3e-5), WH_R(0.25), WH_R(-0.5) * REACH_M,
                             WH_R(-0.9) * REACH_M};
    for (unsigned i = 0; i < sizeof moves / sizeof moves[0]; i++) {
        rest_on_a_stop(true);
        hand_now.law[0].offset = moves[i];
        hand_steps(1);
        TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_ACTIVE);
        TEST_ASSERT_TRUE(hand_near(hand_state.real[0], moves[i], 1e-18, 1e-9));
        TEST_ASSERT_TRUE(hand_state.real[1] == WH_R(0.0));
        const wh_real work = hand_state.ledger[wh_ledger_of_contact(&hand_books, 0)];
        TEST_ASSERT_TRUE(hand_near(work, HAND_G * moves[i], 1e-15, 4e-7));
        hand_steps(5);
        TEST_ASSERT_TRUE(hand_near(hand_state.real[0], moves[i], 1e-18, 1e-9));
    }
}

/* If the stop is lowered by more than the ball's fall in a step, the ball falls freely. */
TEST(contact_follow, ball_falls_from_a_lowered_stop) {
    const wh_real moves[] = {WH_R(-1.2) * REACH_M, WH_R(-2.0) * REACH_M, WH_R(-1e-3), WH_R(-2.0)};
    for (unsigned i = 0; i < sizeof moves / sizeof moves[0]; i++) {
        rest_on_a_stop(true);
        hand_now.law[0].offset = moves[i];
        hand_steps(1);
        TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_FREE);
        TEST_ASSERT_TRUE(hand_near(hand_state.real[0], -REACH_M, 1e-18, 1e-12));
        TEST_ASSERT_TRUE(hand_near(hand_state.real[1], -HAND_G * STEP_S, 1e-16, 1e-9));
        TEST_ASSERT_TRUE(hand_state.ledger[wh_ledger_of_contact(&hand_books, 0)] == WH_R(0.0));
        /* the ball falls onto the stop, if that is near, and bounces with half the speed */
        hand_steps(40);
        TEST_ASSERT_TRUE(i == 3 || hand_state.contacts->events > 0);
        TEST_ASSERT_TRUE(hand_state.real[0] >= moves[i] - WH_R(1e-9));
    }
}

/* A stop that no input moves (direction 0) stays where it is. Two bodies rest on two stops: only the body on the moved
 * stop follows. */
TEST(contact_follow, unmoved_stops_carry_no_body) {
    for (unsigned moved = 0; moved < 2; moved++) {
        hand_build(2, WH_R(1.0), WH_R(0.0), WH_R(2.0));
        hand_now.load[0] = -HAND_G;
        hand_now.load[1] = WH_R(-2.0) * HAND_G;
        hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(0.0), WH_R(0.0));
        hand_add(WH_STOP, 1, WH_R(0.0), WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(0.0));
        hand_now.contact[moved].direction = 1;
        hand_start(false);
        hand_steps(3);
        hand_now.law[moved].offset = WH_R(0.125);
        hand_steps(2);
        TEST_ASSERT_TRUE(hand_state.real[moved] == WH_R(0.125));
        TEST_ASSERT_TRUE(hand_state.real[1 - moved] == WH_R(0.0));
        hand_now.law[moved].offset = WH_R(-0.25);
        hand_steps(2);
        TEST_ASSERT_TRUE(hand_state.contacts->mode[moved] == WH_FREE);
        TEST_ASSERT_TRUE(hand_state.contacts->mode[1 - moved] == WH_ACTIVE);
        TEST_ASSERT_TRUE(hand_state.real[1 - moved] == WH_R(0.0));
    }
}

/* Two bodies of 1 and 3 kg are held at a distance that is an input with a rate, and a load pulls them. When the input
 * jumps, both bodies move at once, in inverse ratio of their masses; then they move on as one body of 4 kg. */
TEST(contact_follow, moved_hold_moves_both_bodies) {
    hand_build(2, WH_R(1.0), WH_R(0.0), WH_R(3.0));
    hand_add(WH_HOLD, -1, WH_R(1.0), WH_R(-1.0), WH_R(0.0), WH_R(0.0), WH_R(0.0));
    hand_now.contact[0].direction = -1;
    hand_now.system.held = 1;
    hand_now.load[0] = WH_R(4.0);
    hand_now.start[0] = WH_R(0.5);
    hand_pushed = WH_R(1.0);
    hand_start(false);
    for (unsigned i = 0; i < 100; i++) {
        hand_now.law[0].offset = WH_R(0.01) * (wh_real)(i % 7U);
        hand_steps(1);
    }
    const wh_real way = WH_R(0.005); /* distance after 0.1 s at 1 m/s^2 */
    TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_ACTIVE);
    const wh_real longer = WH_R(0.01) * WH_R(1.0);
    TEST_ASSERT_TRUE(
        hand_near(hand_state.real[0], WH_R(0.5) + way + WH_R(0.75) * longer, 1e-13, 3e-6));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[1], way - WH_R(0.25) * longer, 1e-13, 3e-6));
    hand_pushed = WH_R(0.0);
}

static wh_real shown(unsigned i) {
    wh_real accel[WH_COORDS];
    const uint64_t before = wh_scene_hash(&hand_now.scene, &hand_state);
    wh_contact_observe(&hand_now.system, &hand_state, accel);
    TEST_ASSERT_TRUE(wh_scene_hash(&hand_now.scene, &hand_state) == before);
    return accel[i];
}

/* Recorded accelerations before and after the first step: zero on a stop, free fall above it. Friction balances the
 * load up to its limit, then slows the slide. */
TEST(contact_follow, accelerations_with_their_contacts) {
    for (unsigned k = 0; k < 2; k++) {
        hand_build_ball(WH_R(0.5));
        hand_now.start[0] = WH_R(0.25) * (wh_real)k;
        hand_start(false);
        for (unsigned i = 0; i < 2; i++) {
            TEST_ASSERT_TRUE(shown(0) == (k == 0 ? WH_R(0.0) : -HAND_G));
            hand_steps(1);
        }
    }
    const wh_real loads[] = {WH_R(0.0), WH_R(1.0), WH_R(-1.9), WH_R(2.1), WH_R(-6.0)};
    for (unsigned k = 0; k < 3 * sizeof loads / sizeof loads[0]; k++) {
        const wh_real load = loads[k / 3];
        hand_build(1, WH_R(2.0), WH_R(0.0), WH_R(1.0));
        hand_add(WH_FRICTION, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(2.0), WH_R(1.0));
        hand_now.load[0] = load;
        hand_now.start[1] = WH_R(1.0) - (wh_real)(k % 3U); /* forward, at rest, backward */
        hand_start(false);
        const wh_real way = k % 3U != 1        ? hand_now.start[1]
                            : load > WH_R(0.0) ? WH_R(1.0)
                                               : WH_R(-1.0);
        const bool sticks = k % 3U == 1 && WH_ABS(load) < WH_R(2.0);
        for (unsigned i = 0; i < 2; i++) {
            TEST_ASSERT_TRUE(
                hand_near(shown(0), sticks ? WH_R(0.0) : (load - way) / 2, 1e-15, 3e-7));
            hand_steps(1);
        }
    }
}
