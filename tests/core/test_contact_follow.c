/* test_contact_follow.c: resting contacts that inputs move, and what assignments change. */
#include "draw.h"
#include "hand.h"
#include "tests/suites.h"

/* === contact follow ========================================================================== */
/* Contacts moved by an input between steps (a stop with a resting body, a hold), and recorded
 * accelerations with contact forces. Mechanisms with closed forms (hand.h). */

#define STEP_S WH_R(0.001)
#define REACH_M (WH_R(0.5) * HAND_G * STEP_S * STEP_S) /* a body's fall in a step */

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

/* The stop is raised, or lowered by at most the ball's fall in a step, and takes the ball along. The energy m g s is booked
 * to the stop. */
TEST(contact_follow, a_stop_takes_along_what_rests_on_it) {
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

/* If the stop is lowered by more, the ball falls freely. */
TEST(contact_follow, a_stop_that_drops_away_leaves_the_ball) {
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

/* A stop that no input moves (direction 0) is checked too. Of two bodies on two stops only the one on the moved stop follows. */
TEST(contact_follow, others_stay_where_they_are) {
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

/* Two bodies of 1 and 3 kg held at a distance from an input with a rate, drawn by a load. A jump of the input is corrected at
 * once by both bodies in the ratio of their masses; both continue as one body of 4 kg. */
TEST(contact_follow, a_hold_takes_along_what_it_holds) {
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
    const wh_real way = WH_R(0.005); /* 1 m/s^2 for 0.1 s */
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

/* Accelerations before and after the first step: zero on a stop, free fall above it. Friction holds up to its limit, then
 * slows the slide. */
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
        hand_now.start[1] = WH_R(1.0) - (wh_real)(k % 3U); /* forward, still, backward */
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

/* === contact revise ========================================================================== */
/* Effects of a crossing's assignments on other contacts (contact_resolve.h), on two coupled
 * bodies with a stop and a hold, in closed form. A passed stop is put back by the least move in
 * the mass metric and no longer rests. A hold that is still on captures its new place and stops
 * its rate; one that is off lets go. Anything that did not move stays. */

typedef struct revised {
    bool stop_moved, hold_moved, keeps;
    int8_t stop_mode;
    int stop_pin;     /* coordinate of the stop's pin; -1: none */
    int pin;          /* of the hold; -1: it slips */
    int8_t direction; /* this kind */
    wh_real gap;      /* of the stop, x0 >= 0.25 */
    wh_real rate[2];
    wh_real kept_before;
} revised;

#define OFFSET WH_R(0.125) /* offset of the hold's expression from x1, moved by an input */
#define PLACE WH_R(0.5)    /* x1 */

static wh_contact_work w;
static wh_contact_state s;

static void revise(const revised *r) {
    wh_real pushed[1];
    hand_build(2, WH_R(2.0), WH_R(0.5), WH_R(1.0));
    hand_add(WH_STOP, r->stop_pin, WH_R(1.0), WH_R(0.0), WH_R(0.25), WH_R(0.5), WH_R(0.0));
    hand_add(WH_HOLD, r->pin, WH_R(0.0), WH_R(1.0), OFFSET, WH_R(0.0), WH_R(0.0));
    hand_now.contact[1].direction = r->direction;
    hand_now.system.held = r->pin < 0;
    hand_start(false);
    wh_contact_work_begin(&hand_now.system, &hand_state, &w);
    w.mode[0] = r->stop_mode;
    w.mode[1] = WH_ACTIVE;
    w.held[0] = r->kept_before;
    w.moved = (r->stop_moved ? 1U : 0U) | (r->hold_moved ? 2U : 0U);
    w.mover = 2;
    w.fault = -1;
    w.hit_next = w.turned = w.inside = 0;
    for (unsigned i = 0; i < 2U * WH_COORDS; i++) {
        s.carry[i] = WH_R(0.0);
    }
    s.real[0] = WH_R(0.25) + r->gap;
    s.real[1] = PLACE;
    s.real[2] = r->rate[0];
    s.real[3] = r->rate[1];
    pushed[0] = r->keeps ? WH_R(1.0) : WH_R(-1.0);
    wh_contact_revise(&hand_now.system, &w, pushed, &s);
}

static void expect_near(wh_real wanted, wh_real got) {
    TEST_ASSERT_TRUE(hand_near(got, wanted, 1e-12, 3e-4));
}

/* A hold's place is its expression if it is curved or moved; if it is straight, its motion, which is zero at first. */
static wh_real captured(const revised *r) {
    return r->direction > 0 ? WH_R(0.0) : r->direction < 0 ? PLACE - OFFSET : PLACE;
}

static void expect_hold(const revised *r) {
    const bool lets_go = r->hold_moved && !r->keeps;
    TEST_ASSERT_EQUAL_INT(lets_go ? WH_FREE : WH_ACTIVE, w.mode[1]);
    if (r->pin < 0) {
        const bool anew = r->hold_moved && r->keeps;
        TEST_ASSERT_TRUE(w.held[0] == (anew ? captured(r) : r->kept_before));
    }
    /* M (v+ - v) = (0, lambda), v1+ = 0: v0 gains (1/M)_01/(1/M)_11 of v1, -1/4 */
    const bool stops = r->hold_moved && r->keeps;
    expect_near(stops ? WH_R(0.0) : r->rate[1], s.real[3]);
    expect_near(stops ? r->rate[0] + WH_R(0.25) * r->rate[1] : r->rate[0], s.real[2]);
}

/* x0 passed the stop by g and is put back by g. If the stop is pinned to x0, only x0 moves. Otherwise a free x1 moves by
 * (1/M)_01/(1/M)_00 = -1/2 of that. */
static void expect_places(const revised *r) {
    const bool passed = r->stop_moved && r->gap < WH_R(0.0);
    const bool held = !(r->hold_moved && !r->keeps);
    expect_near(passed ? WH_R(0.25) : WH_R(0.25) + r->gap, s.real[0]);
    expect_near(passed && !held && r->stop_pin < 0 ? PLACE + WH_R(0.5) * r->gap : PLACE, s.real[1]);
}

TEST(contact_revise, each_way_to_be_moved) {
    static const int pins[] = {1, -1, -1, -1};
    static const int8_t directions[] = {0, 0, 1, -1};
    uint64_t seed = 2321;
    for (unsigned n = 0; n < 256; n++) {
        revised r = {.stop_moved = (n & 1U) != 0,
                     .hold_moved = (n & 2U) != 0,
                     .keeps = (n & 4U) != 0,
                     .stop_mode =
                         (n & 9U) == 9U ? WH_ACTIVE : WH_FREE, /* a resting one, if it is moved */
                     .gap = (n & 16U) != 0 ? WH_R(-0.03125) : WH_R(0.0625),
                     .stop_pin = (n & 128U) != 0 ? 0 : -1,
                     .pin = pins[n >> 5 & 3U],
                     .direction = directions[n >> 5 & 3U]};
        r.rate[0] = (wh_real)draw_broken(&seed, -1000, 1000);
        r.rate[1] = (wh_real)draw_broken(&seed, -1000, 1000);
        const bool passed = r.stop_moved && r.gap < WH_R(0.0);
        /* its held place becomes the present one, unless nothing reads that */
        r.kept_before = captured(&r) + (passed ? WH_R(0.0) : WH_R(0.0078125));
        revise(&r);
        TEST_ASSERT_TRUE(w.moved == 0);
        TEST_ASSERT_EQUAL_INT(WH_FREE, w.mode[0]);
        expect_hold(&r);
        expect_places(&r);
    }
}
