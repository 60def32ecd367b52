/* test_contact_revise.c: effects of a crossing's assignments on other contacts (contact_resolve.h), on two coupled bodies with
 * a stop and a hold, in closed form. A passed stop is put back by the least move in the mass metric and no longer rests. A hold
 * that is still on captures its new place and stops its rate; one that is off lets go. Anything that did not move stays. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

typedef struct revised {
    bool stop_moved, hold_moved, keeps;
    int8_t stop_mode;
    int stop_pin;     /* 0, or -1: put back like a general row */
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

/* The hold's place: for a curved or moved one its expression, for a straight one its motion, which is zero at first. */
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

/* Passed by g and put back: x0 by g, alone if it is the stop's pin. Else a free x1 moves by (1/M)_01/(1/M)_00 = -1/2 of that. */
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
        /* its held place is its present one, unless nothing reads it */
        r.kept_before = captured(&r) + (passed ? WH_R(0.0) : WH_R(0.0078125));
        revise(&r);
        TEST_ASSERT_TRUE(w.moved == 0);
        TEST_ASSERT_EQUAL_INT(WH_FREE, w.mode[0]);
        expect_hold(&r);
        expect_places(&r);
    }
}
