/* test_contact.c: long rest, steps with many events, and refused steps, on mechanisms with closed forms (hand.h).
 * test_contact_exact.c compares random mechanisms with a reference. */
#include "hand.h"

#include "tests/suites.h"

/* A ball falls from 1 m with restitution 1/2. Its bounces end at 3 sqrt(2 h / g). Then it rests for a minute. */
TEST(contact, ball_stays_at_rest) {
    const wh_real rest_s = WH_R(3.0) * WH_SQRT(WH_R(2.0) / HAND_G);
    hand_build_ball(WH_R(0.5));
    hand_start(false);
    unsigned at = 0;
    while (hand_state.steps < 2000 && at == 0) {
        hand_steps(1);
        at = hand_state.contacts->mode[0] == WH_ACTIVE ? (unsigned)hand_state.steps : 0;
    }
    TEST_ASSERT_TRUE(hand_near((wh_real)at * WH_R(0.001), rest_s, 1e-3, 1e-3));
    hand_steps(60000U - at);
    TEST_ASSERT_TRUE(hand_state.real[0] == WH_R(0.0));
    TEST_ASSERT_TRUE(hand_state.real[1] == WH_R(0.0));
    TEST_ASSERT_TRUE(hand_state.contacts->overruns == 0);
}

/* A body bounces between two walls 1 m apart, n times in each step of 1 ms. All events are counted, and the first eight
 * are logged. */
TEST(contact, all_events_of_a_step_count) {
    for (unsigned each = 0; each <= 2U * WH_EVENTS_MAX + 4U; each++) {
        const unsigned n = each / 2U;
        hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
        hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
        hand_add(WH_STOP, 0, WH_R(-1.0), WH_R(0.0), WH_R(-1.0), WH_R(1.0), WH_R(0.0));
        hand_now.start[0] = WH_R(0.5);
        hand_start(false);
        hand_steps(each % 2U); /* the first step of a run, or a later one */
        hand_state.real[1] = WH_R(1000.0) * (wh_real)n;
        hand_steps(1);
        const bool many = n > WH_EVENTS_MAX;
        TEST_ASSERT_EQUAL_UINT(many ? WH_EVENTS_MAX : n, hand_state.contacts->events);
        TEST_ASSERT_EQUAL_UINT(many ? WH_EVENTS_MAX : n, hand_state.contacts->logged);
        TEST_ASSERT_EQUAL_UINT(many, hand_state.contacts->overruns);
        for (unsigned i = 0; i < hand_state.contacts->logged; i++) {
            const wh_event event = hand_state.contacts->log[i];
            const wh_real at_ms = ((wh_real)i + WH_R(0.5)) / (wh_real)n;
            TEST_ASSERT_TRUE(event.contact == (i + 1) % 2 && event.mode == WH_FREE);
            TEST_ASSERT_TRUE(hand_near(event.at_s * WH_R(1000.0), at_ms, 1e-14, 1e-5));
        }
        TEST_ASSERT_TRUE(many || hand_near(hand_state.real[0], WH_R(0.5), 1e-13, 1e-4));
        const wh_real way = n % 2 == 0 ? WH_R(1000.0) : WH_R(-1000.0);
        TEST_ASSERT_TRUE(many || hand_state.real[1] == way * (wh_real)n);
    }
}

/* A step has at most eight moments with events. At the eighth, a body that would bounce from a wall comes to rest
 * instead, which counts as an overrun. */
TEST(contact, rest_at_the_eighth_moment_counts) {
    for (unsigned n = WH_EVENTS_MAX - 1U; n <= WH_EVENTS_MAX; n++) {
        hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
        hand_now.load[0] = WH_R(-10.0);
        hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
        hand_add(WH_STOP, 0, WH_R(-1.0), WH_R(0.0), WH_R(-1.0), WH_R(1.0), WH_R(0.0));
        hand_now.start[0] = WH_R(0.5);
        hand_now.start[1] = WH_R(1000.0) * (wh_real)n;
        hand_start(false);
        hand_steps(1);
        TEST_ASSERT_EQUAL_UINT(n == WH_EVENTS_MAX, hand_state.contacts->overruns);
    }
}

/* A load that moves the body out of bounds: the step is refused, and state, modes and ledger stay unchanged. */
TEST(contact, a_refused_step_changes_nothing) {
    hand_build_ball(WH_R(0.5));
    hand_start(true);
    hand_steps(500);
    const uint64_t hash = wh_scene_hash(&hand_now.scene, &hand_state);
    const wh_real entry = hand_state.ledger[0];
    const uint64_t events = hand_state.contacts->events;
    hand_now.load[0] = WH_R(1e30);
    TEST_ASSERT_TRUE(wh_scene_step(&hand_now.scene, &hand_state) == WH_E_DIVERGED);
    TEST_ASSERT_TRUE(wh_scene_hash(&hand_now.scene, &hand_state) == hash);
    TEST_ASSERT_TRUE(hand_state.ledger[0] == entry);
    TEST_ASSERT_TRUE(hand_state.contacts->events == events);
    TEST_ASSERT_TRUE(hand_state.fault >= 0);
}

/* A load drives a component out of bounds: at a run's first step, after an event within a step, and later. The fault
 * names this component. */
TEST(contact, diverged_component_is_named) {
    for (unsigned where = 0; where < 3; where++) {
        for (unsigned c = 0; c < 2; c++) {
            hand_build(2, WH_R(2.0), WH_R(0.0), WH_R(3.0));
            hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
            hand_now.start[0] = where == 1 ? WH_R(0.0) : WH_R(1.0);
            hand_now.start[2] = WH_R(-1.0);
            hand_now.eventful = where == 2;
            hand_start(true);
            if (where == 2) {
                hand_steps(3);
            }
            hand_now.load[c] = WH_R(1e30);
            const wh_status status = wh_scene_step(&hand_now.scene, &hand_state);
            TEST_ASSERT_TRUE(status == WH_E_DIVERGED);
            TEST_ASSERT_TRUE(hand_state.fault == (int)c || hand_state.fault == (int)(2 + c));
        }
    }
}
