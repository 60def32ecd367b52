/* test_locate.c: event location within a step: a body under a constant load crosses places at times known in closed form.
 * Checks the accuracy, the number of evaluations, and the order. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

enum { CASES = __STDC_HOSTED__ ? 3000 : 200 };

#define STEP_S WH_R(0.001)

/* From 0 to 1, in steps of 1/1024. */
static wh_real share_of(uint64_t *seed) {
    return (wh_real)(draw_bits(seed) % 1023U + 1U) / WH_R(1024.0);
}

/* x = v t + a t^2/2, monotone over the step: the speed changes by up to nine tenths. */
typedef struct path {
    wh_real v;
    wh_real a;
} path;

static wh_real place_at(path p, wh_real t) { return t * (p.v + WH_R(0.5) * p.a * t); }

static path random_path(uint64_t *seed) {
    const wh_real v = WH_R(0.25) + share_of(seed);
    const wh_real bend = WH_R(0.9) * (WH_R(2.0) * share_of(seed) - WH_R(1.0));
    const bool backward = draw_bits(seed) % 2U != 0;
    const path p = {backward ? -v : v, (backward ? -bend : bend) * v / STEP_S};
    return p;
}

static void start(path p) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_now.load[0] = p.a;
    hand_now.start[0] = WH_R(0.0);
    hand_now.start[1] = p.v;
}

static unsigned add_crossing(wh_real at, int direction) {
    const unsigned k = hand_add(WH_WHEN, -1, WH_R(1.0), WH_R(0.0), at, WH_R(0.0), WH_R(0.0));
    hand_now.contact[k].direction = (int8_t)direction;
    hand_now.contact[k].sets = 0;
    return k;
}

/* One crossing that reverses and halves the rate: located in time, then the other motion. */
TEST(locate, a_crossing_is_found_where_it_is) {
    uint64_t seed = 411;
    wh_real worst = WH_R(0.0);
    for (unsigned i = 0; i < CASES; i++) {
        const path p = random_path(&seed);
        const wh_real t = STEP_S * share_of(&seed);
        start(p);
        hand_now.contact[add_crossing(place_at(p, t), p.v > WH_R(0.0) ? 1 : -1)].sets = 1;
        hand_start(false);
        hand_steps(1);
        TEST_ASSERT_TRUE(hand_state.contacts->events == 1 && hand_state.contacts->logged == 1);
        const wh_real off = WH_ABS(hand_state.contacts->log[0].at_s - t) / STEP_S;
        worst = off > worst ? off : worst;
        const wh_real rest = STEP_S - t;
        const wh_real turned = WH_R(-0.5) * (p.v + p.a * t);
        const wh_real end = place_at(p, t) + rest * (turned + WH_R(0.5) * p.a * rest);
        const wh_real scale = WH_ABS(p.v) * STEP_S;
        TEST_ASSERT_TRUE(hand_near(hand_state.real[0] / scale, end / scale, 1e-12, 2e-5));
        TEST_ASSERT_TRUE(
            hand_near(hand_state.real[1] / p.v, (turned + p.a * rest) / p.v, 1e-12, 2e-5));
    }
    TEST_ASSERT_TRUE((double)worst <= (WH_DOUBLE ? 1e-14 : 2e-6));
}

/* The number of evaluations is a bracketing search's, far below halving, its fallback. The others are the step's own. */
TEST(locate, a_crossing_is_found_with_few_looks) {
    uint64_t seed = 412;
    unsigned all = 0;
    unsigned most = 0;
    for (unsigned i = 0; i < CASES; i++) {
        const path p = random_path(&seed);
        start(p);
        (void)add_crossing(place_at(p, STEP_S * share_of(&seed)), 0);
        hand_start(false);
        hand_looks = 0;
        hand_steps(1);
        all += hand_looks;
        most = hand_looks > most ? hand_looks : most;
    }
    TEST_ASSERT_TRUE(all <= CASES * (WH_DOUBLE ? 14U : 12U));
    TEST_ASSERT_TRUE(most <= (WH_DOUBLE ? 20U : 18U));
}

/* Flat or steep crossings do not exhaust the evaluations before the accuracy is reached. */
TEST(locate, flat_and_steep_crossings_are_found) {
    uint64_t seed = 415;
    for (unsigned i = 0; i < CASES; i++) {
        const path p = random_path(&seed);
        const wh_real t = STEP_S * share_of(&seed);
        start(p);
        (void)add_crossing(place_at(p, t), 0);
        hand_now.bent =
            i % (WH_DOUBLE ? 4U : 3U); /* powers 1, 3, 9, 27; each vanishes at the place only */
        hand_start(false);
        hand_looks = 0;
        hand_steps(1);
        TEST_ASSERT_TRUE(hand_state.contacts->events == 1 && hand_looks <= WH_PROBES + 8U);
        TEST_ASSERT_TRUE(WH_ABS(hand_state.contacts->log[0].at_s - t) <= WH_BRACKET * STEP_S);
    }
}

/* Two crossings and one against its direction, declared in any order: each is located in time, the earliest first. */
TEST(locate, crossings_of_one_step_come_in_their_order) {
    uint64_t seed = 413;
    for (unsigned i = 0; i < CASES; i++) {
        const path p = random_path(&seed);
        const int along = p.v > WH_R(0.0) ? 1 : -1;
        const unsigned kept = draw_one_of(&seed, 3U); /* it has no effect */
        wh_real at_s[3];
        start(p);
        for (unsigned k = 0; k < 3; k++) {
            at_s[k] = STEP_S * share_of(&seed);
            (void)add_crossing(place_at(p, at_s[k]), k == kept ? -along : k % 2U == 0 ? along : 0);
        }
        const unsigned one = kept == 0 ? 1 : 0;
        const unsigned other = kept == 2 ? 1 : 2;
        if (WH_ABS(at_s[one] - at_s[other]) < STEP_S / 64) {
            continue;
        }
        const unsigned first = at_s[one] < at_s[other] ? one : other;
        hand_start(false);
        hand_steps(1);
        const wh_contacts *c = hand_state.contacts;
        TEST_ASSERT_TRUE(c->events == 2 && c->logged == 2 && c->overruns == 0);
        TEST_ASSERT_TRUE(c->log[0].contact == first && c->log[1].contact == one + other - first);
        for (unsigned e = 0; e < 2; e++) {
            TEST_ASSERT_TRUE(c->log[e].mode == along);
            TEST_ASSERT_TRUE(
                hand_near(c->log[e].at_s / STEP_S, at_s[c->log[e].contact] / STEP_S, 1e-13, 5e-6));
        }
        for (unsigned k = 0; k < 3; k++) { /* all three are on the other side, event or not */
            TEST_ASSERT_TRUE(c->mode[k] == along);
        }
        TEST_ASSERT_TRUE(
            hand_near(hand_state.real[0] / STEP_S, place_at(p, STEP_S) / STEP_S, 1e-12, 5e-6));
    }
}

/* A stop in the way of the same motion, and one beyond it: the body bounces with v + a t and is where it must be. */
TEST(locate, a_stop_is_hit_where_it_is) {
    uint64_t seed = 414;
    for (unsigned i = 0; i < CASES; i++) {
        const path p = random_path(&seed);
        const wh_real t = STEP_S * share_of(&seed);
        const wh_real e = share_of(&seed);
        const wh_real side = p.v > WH_R(0.0) ? WH_R(-1.0) : WH_R(1.0);
        const wh_real place = place_at(p, t);
        start(p);
        (void)hand_add(WH_STOP, 0, -side, WH_R(0.0), WH_R(-10.0) * WH_ABS(p.v) * STEP_S, e,
                       WH_R(0.0));
        (void)hand_add(WH_STOP, 0, side, WH_R(0.0), side * place, e, WH_R(0.0));
        hand_start(false);
        hand_steps(1);
        const wh_real speed = p.v + p.a * t;
        const wh_real rest = STEP_S - t;
        const wh_real end = place + rest * (WH_R(0.5) * p.a * rest - e * speed);
        const wh_event event = hand_state.contacts->log[0];
        const bool pressed =
            p.a * side < WH_R(0.0); /* later it may return within the step, or rest */
        TEST_ASSERT_TRUE(event.contact == 1 && hand_state.contacts->mode[0] == WH_FREE);
        TEST_ASSERT_TRUE(hand_near(event.at_s / STEP_S, t / STEP_S, 1e-13, 5e-6));
        if (!pressed) {
            TEST_ASSERT_TRUE(hand_state.contacts->events == 1 && event.mode == WH_FREE);
            TEST_ASSERT_TRUE(hand_near(event.impulse / WH_ABS(speed), WH_R(1.0) + e, 1e-12, 1e-5));
            TEST_ASSERT_TRUE(hand_near(hand_state.real[0] / STEP_S, end / STEP_S, 1e-12, 1e-5));
            TEST_ASSERT_TRUE(
                hand_near(hand_state.real[1] / speed, p.a * rest / speed - e, 1e-12, 1e-5));
        } else {
            TEST_ASSERT_TRUE(side * (hand_state.real[0] - place) >=
                             -STEP_S * (WH_DOUBLE ? WH_R(1e-13) : WH_R(1e-5)));
        }
    }
}
