/* test_contact_squeeze.c: steps with too many events. Bodies beyond stops are moved back by the smallest move in the
 * mass metric. Stops that close are hit without a bounce. exact.h is the reference of random mechanisms. */

/* The rows of longer methods are left out: an ATmega2560 has no memory for them. */
#define WH_STAGES 4

#include "draw.h"
#include "exact.h"

#include "tests/suites.h"

enum { MECHANISMS = __STDC_HOSTED__ ? 4000 : 100 };

#define CLOSE (WH_DOUBLE ? 1e-9 : 2e-4)

/* Draws stops; the last contact may be a hold or a friction. Positions are random. Resting and held contacts have zero
 * rate. */
static void draw(uint64_t *seed, wh_contact_work *w, wh_contact_state *s, exact *e) {
    const unsigned n = draw_one_in(seed, 4) ? 1 : 2;
    const unsigned count = 1 + (unsigned)(draw_bits(seed) % HAND_CONTACTS);
    hand_build(n, draw_broken(seed, 1, 4), n == 1 ? WH_R(0.0) : draw_broken(seed, -1, 1),
               draw_broken(seed, 2, 4));
    for (unsigned i = 0; i < n; i++) {
        hand_now.start[i] = draw_broken(seed, -1, 1);
        hand_now.start[n + i] = draw_broken(seed, -1, 1);
        hand_now.spring[i] = draw_broken(seed, 0, 4);
    }
    for (unsigned k = 0; k < count; k++) {
        const bool last = k > 0 && k + 1 == count;
        const bool hold = last && draw_one_in(seed, 3);
        const bool friction = last && !hold && draw_one_in(seed, 3);
        wh_real row[2] = {draw_whole(seed, -2, 2), n == 1 ? WH_R(0.0) : draw_whole(seed, -2, 2)};
        if (friction || (row[0] == WH_R(0.0) && row[1] == WH_R(0.0))) {
            row[0] = WH_R(1.0);
            row[1] = WH_R(0.0);
        }
        const int pin = row[1] == WH_R(0.0) ? 0 : row[0] == WH_R(0.0) ? 1 : -1;
        const wh_real at = row[0] * hand_now.start[0] + row[1] * hand_now.start[1];
        const wh_real gap = draw_broken(seed, -1, 1);
        (void)hand_add(hold       ? WH_HOLD
                       : friction ? WH_FRICTION
                                  : WH_STOP,
                       pin, row[0], row[1], at - gap, draw_one_in(seed, 2) ? WH_R(0.5) : WH_R(0.0),
                       WH_R(0.5));
        if (hold) {
            hand_now.contact[k].direction = 1;
            hand_now.system.held = pin < 0;
        }
    }
    hand_start(true);
    *e = (exact){.pushed = 0.0};
    for (unsigned i = 0; i < n; i++) {
        e->x[i] = (double)hand_now.start[i];
        e->v[i] = (double)hand_now.start[n + i];
    }
    wh_contact_work_begin(&hand_now.system, &hand_state, w);
    wh_contact_copy(&hand_now.system, hand_state.angle, hand_state.real, hand_state.carry, s);
    for (unsigned k = 0; k < count; k++) {
        const bool friction = hand_now.contact[k].kind == WH_FRICTION;
        const bool acts = draw_one_in(seed, 3) && (hand_now.contact[k].kind == WH_HOLD || k == 0);
        e->mode[k] = friction ? (int)(draw_bits(seed) % 3) - 1 : acts ? WH_ACTIVE : WH_FREE;
        w->mode[k] = (int8_t)e->mode[k];
        w->held[k] = WH_R(0.0);
    }
}

static bool near(double value, double wanted) {
    const double off = value - wanted;
    return off <= CLOSE && -off <= CLOSE;
}

TEST(contact_squeeze, projection_is_the_least_that_suffices) {
    EXACT_NEEDS_DOUBLE();
    uint64_t seed = 21;
    unsigned wrong = 0;
    unsigned compared = 0;
    for (unsigned i = 0; i < MECHANISMS; i++) {
        wh_contact_work w;
        wh_contact_state s;
        wh_ledger_work books;
        exact e;
        draw(&seed, &w, &s, &e);
        w.books = &books;
        wh_ledger_open(&hand_books, &hand_state, &books);
        exact_squeeze(&e);
        if (e.vague) {
            continue;
        }
        wh_contact_squeeze(&hand_now.system, &w, hand_state.input, &s);
        bool good = true;
        for (unsigned c = 0; c < hand_now.n; c++) {
            good = good && near((double)s.real[c], e.x[c]) &&
                   near((double)s.real[hand_now.n + c], e.v[c]);
        }
        for (unsigned k = 0; k < hand_now.system.contacts; k++) {
            const wh_real *entry = books.step + wh_ledger_of_contact(&hand_books, k);
            good = good && w.mode[k] == e.mode[k];
            good = good && (e.shared || near((double)entry[0], e.energy[k]));
        }
        compared++;
        wrong += !good;
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_TRUE(compared >= MECHANISMS / 2U);
}

/* A body is beyond two stops. The projection onto the first moves it away from the second. The second stop is hit
 * nevertheless, because the body slides along the first. */
TEST(contact_squeeze, second_stop_is_hit_while_sliding) {
    for (int slope = -3; slope <= 3; slope++) {
        for (int beyond = 1; beyond <= 3; beyond++) {
            wh_contact_work w;
            wh_contact_state s = {.real = {WH_R(0.0)}};
            const wh_real row[2] = {WH_R(1.0), (wh_real)slope};
            /* the rate towards the second stop */
            const wh_real speed = slope > 0 ? WH_R(-2.0) : WH_R(2.0);
            hand_build(2, WH_R(1.0), WH_R(0.0), WH_R(1.0));
            hand_now.start[3] = speed;
            (void)hand_add(WH_STOP, 0, row[0], WH_R(0.0), (wh_real)beyond, WH_R(0.5), WH_R(0.0));
            (void)hand_add(WH_STOP, slope == 0 ? 0 : -1, row[0], row[1], (wh_real)beyond, WH_R(0.5),
                           WH_R(0.0));
            hand_start(false);
            wh_contact_work_begin(&hand_now.system, &hand_state, &w);
            w.books = NULL;
            wh_contact_copy(&hand_now.system, hand_state.angle, hand_state.real, hand_state.carry,
                            &s);
            w.mode[0] = WH_FREE;
            w.mode[1] = WH_FREE;
            wh_contact_squeeze(&hand_now.system, &w, hand_state.input, &s);
            const double push = (double)(-row[1] * speed / (1 + row[1] * row[1]));
            TEST_ASSERT_TRUE(near((double)s.real[0], beyond) && near((double)s.real[1], 0.0));
            TEST_ASSERT_TRUE(near((double)s.real[2], push));
            TEST_ASSERT_TRUE(near((double)s.real[3], (double)speed + (double)row[1] * push));
        }
    }
}
