/* test_contact.c: stops, friction, holds and crossings on mechanisms with closed forms (hand.h). */
#include "hand.h"

#include "tests/suites.h"

/* From 1 m, restitution 1/2: the bounces end at 3 sqrt(2 h / g), and the ball then rests for a minute. */
TEST(contact, ball_comes_to_rest_and_stays) {
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

/* The first impact is at sqrt(2 h / g), with -(1 + e) times the speed. */
TEST(contact, first_impact_is_where_and_what_it_must_be) {
    const wh_real fall_s = WH_SQRT(WH_R(2.0) / HAND_G);
    hand_build_ball(WH_R(0.5));
    hand_start(false);
    while (hand_state.contacts->events == 0) {
        hand_steps(1);
    }
    const wh_event event = hand_state.contacts->log[0];
    const wh_real at_s = (wh_real)(hand_state.steps - 1) * WH_R(0.001) + event.at_s;
    TEST_ASSERT_TRUE(hand_near(at_s, fall_s, 1e-12, 2e-6));
    TEST_ASSERT_TRUE(hand_near(event.impulse, WH_R(1.5) * HAND_G * fall_s, 1e-11, 5e-5));
    TEST_ASSERT_TRUE(event.contact == 0 && event.mode == WH_FREE);
}

TEST(contact, perfect_bounces_keep_the_height) {
    hand_build_ball(WH_R(1.0));
    hand_start(false);
    wh_real highest = WH_R(0.0);
    for (unsigned i = 0; i < 20000; i++) {
        hand_steps(1);
        highest = i > 19000 && hand_state.real[0] > highest ? hand_state.real[0] : highest;
    }
    TEST_ASSERT_TRUE(
        hand_near(highest, WH_R(1.0), 2e-6, 2e-4)); /* a step misses the top by g (h/2)^2/2 */
    TEST_ASSERT_TRUE(highest <= WH_R(1.0) + (WH_DOUBLE ? WH_R(1e-9) : WH_R(2e-4)));
}

/* A spring presses the body onto the stop, then a load lifts it off. */
TEST(contact, resting_stop_lets_go_when_the_force_turns) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_now.load[0] = WH_R(-1.0);
    hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.25), WH_R(0.0), WH_R(0.0));
    hand_now.start[0] = WH_R(0.25);
    hand_start(false);
    hand_steps(100);
    TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_ACTIVE);
    TEST_ASSERT_TRUE(hand_state.real[0] == WH_R(0.25) && hand_state.real[1] == WH_R(0.0));
    hand_now.load[0] = WH_R(2.0);
    hand_steps(500);
    TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_FREE);
    TEST_ASSERT_TRUE(hand_near(hand_state.real[1], WH_R(1.0), 1e-12, 1e-5)); /* 2 t */
}

/* M = (2 1; 1 2), v = (-3, 1), a stop on the first coordinate with e = 0.4. The impulse is (1 + e) 3 / (M^-1)_00 = 6.3. Then v+
 * = v + M^-1 (6.3, 0), and the second momentum does not change. */
TEST(contact, coupled_impact_goes_through_the_mass_matrix) {
    hand_build(2, WH_R(2.0), WH_R(1.0), WH_R(2.0));
    hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(0.4), WH_R(0.0));
    hand_now.start[0] = WH_R(0.0015);
    hand_now.start[2] = WH_R(-3.0);
    hand_now.start[3] = WH_R(1.0);
    hand_start(false);
    hand_steps(1);
    TEST_ASSERT_TRUE(hand_state.contacts->events == 1);
    TEST_ASSERT_TRUE(hand_near(hand_state.contacts->log[0].impulse, WH_R(6.3), 1e-12, 5e-6));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[2], WH_R(1.2), 1e-12, 5e-6));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[3], WH_R(-1.1), 1e-12, 5e-6));
    TEST_ASSERT_TRUE(
        hand_near(hand_state.real[2] + WH_R(2.0) * hand_state.real[3], WH_R(-1.0), 1e-15, 5e-7));
}

/* Two stops a micrometre apart and a fast body: far more bounces than a step can hold. */
TEST(contact, too_many_bounces_are_counted_and_end) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
    hand_add(WH_STOP, 0, WH_R(-1.0), WH_R(0.0), WH_R(-1e-6), WH_R(1.0), WH_R(0.0));
    hand_now.start[0] = WH_R(5e-7);
    hand_now.start[1] = WH_R(1.0);
    hand_start(false);
    hand_steps(1);
    TEST_ASSERT_TRUE(hand_state.contacts->overruns == 1);
    TEST_ASSERT_TRUE(hand_state.contacts->events >= WH_EVENTS_MAX);
    hand_steps(100);
    TEST_ASSERT_TRUE(WH_ABS(hand_state.real[1]) <= WH_R(1.0));
}

/* Between two walls 1 m apart, n of them hit in each 1 ms step. All hits are counted; the first eight are reported. */
TEST(contact, a_step_has_room_for_so_many_moments) {
    for (unsigned each = 0; each <= 2U * WH_EVENTS_MAX + 4U; each++) {
        const unsigned n = each / 2U;
        hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
        hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
        hand_add(WH_STOP, 0, WH_R(-1.0), WH_R(0.0), WH_R(-1.0), WH_R(1.0), WH_R(0.0));
        hand_now.start[0] = WH_R(0.5);
        hand_start(false);
        hand_steps(each % 2U); /* the first one, or a later one */
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

/* A pressed body hits a wall at the eighth moment, from which it would have separated. It rests there. */
TEST(contact, a_rest_at_the_last_moment_is_counted) {
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

/* 10 degrees: sin 0.17364818, cos 0.98480775. */
static void build_block(wh_real coefficient) {
    const wh_real normal = HAND_G * WH_R(0.984807753);
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_now.load[0] = HAND_G * WH_R(0.173648178);
    hand_add(WH_FRICTION, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), coefficient * normal,
             coefficient * normal);
}

TEST(contact, block_sticks_on_the_incline) {
    build_block(WH_R(0.5));
    hand_start(false);
    hand_steps(60000);
    TEST_ASSERT_TRUE(hand_state.real[0] == WH_R(0.0) && hand_state.real[1] == WH_R(0.0));
}

TEST(contact, block_slides_when_friction_is_too_small) {
    build_block(WH_R(0.15));
    hand_start(false);
    hand_steps(1000);
    const wh_real slope = HAND_G * (WH_R(0.173648178) - WH_R(0.15) * WH_R(0.984807753));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[1], slope, 1e-12, 2e-5));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[0], WH_R(0.5) * slope, 1e-12, 2e-5));
}

/* Thrown at 1 m/s on a level table, mu g = 2: stops after 1/2 s and 1/4 m. */
TEST(contact, thrown_block_stops_and_sticks) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_add(WH_FRICTION, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(2.0), WH_R(2.0));
    hand_now.start[1] = WH_R(1.0);
    hand_start(false);
    hand_steps(502);
    TEST_ASSERT_TRUE(hand_state.contacts->mode[0] == WH_STUCK);
    const wh_real where = hand_state.real[0];
    TEST_ASSERT_TRUE(hand_near(where, WH_R(0.25), 1e-12, 1.5e-5));
    hand_steps(1000);
    TEST_ASSERT_TRUE(hand_state.real[0] == where && hand_state.real[1] == WH_R(0.0));
}

/* Two bodies of 1 kg at 1 and 3 m/s with a held difference go on at 2 m/s. After release, a load moves only the first. */
TEST(contact, hold_captures_and_lets_go) {
    hand_build(2, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_add(WH_HOLD, -1, WH_R(1.0), WH_R(-1.0), WH_R(0.0), WH_R(0.0), WH_R(0.0));
    hand_now.start[2] = WH_R(1.0);
    hand_now.start[3] = WH_R(3.0);
    hand_pushed = WH_R(1.0);
    hand_start(false);
    hand_steps(100);
    TEST_ASSERT_TRUE(hand_near(hand_state.real[2], WH_R(2.0), 1e-14, 1e-6));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[3], WH_R(2.0), 1e-14, 1e-6));
    hand_now.load[0] = WH_R(4.0);
    hand_steps(100); /* together: 2 m/s^2 */
    TEST_ASSERT_TRUE(hand_near(hand_state.real[3], WH_R(2.2), 1e-12, 2e-5));
    hand_state.input[0] = WH_R(-1.0);
    hand_steps(100); /* the first alone: 4 m/s^2 */
    TEST_ASSERT_TRUE(hand_near(hand_state.real[3], WH_R(2.2), 1e-12, 2e-5));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[2], WH_R(2.6), 1e-12, 2e-5));
    hand_pushed = WH_R(0.0);
}

/* At x = 0.1 the rate goes from 1 to -1/2: at 0.2 s the body is at 0.05 m. */
TEST(contact, crossing_sets_the_rate) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_add(WH_WHEN, -1, WH_R(1.0), WH_R(0.0), WH_R(0.1), WH_R(0.0), WH_R(0.0));
    hand_now.contact[0].direction = 1;
    hand_now.start[1] = WH_R(1.0);
    hand_start(false);
    hand_steps(200);
    TEST_ASSERT_TRUE(hand_state.contacts->events == 1);
    TEST_ASSERT_TRUE(hand_state.real[1] == WH_R(-0.5));
    TEST_ASSERT_TRUE(hand_near(hand_state.real[0], WH_R(0.05), 1e-12, 1e-6));
}

/* A load beyond all bounds: the step is refused; state, modes and books stay unchanged. */
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

/* A load drives a component out of bounds. It is named at a run's first step, after an event within a step, and later. */
TEST(contact, the_component_that_diverged_is_told) {
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
