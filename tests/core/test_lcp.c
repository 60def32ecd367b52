/* test_lcp.c: the box LCP of core/contact/contact_lcp.h, also with dependent rows: its conditions hold within the cap on
 * rounds. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

enum { PROBLEMS = __STDC_HOSTED__ ? 20000 : 500, CONTACTS = 3 };

/* A problem of up to three contacts on two coordinates, in whole numbers, so that rows are often exactly dependent. A solution
 * always exists: stops push, frictions slide, and no two holds contradict each other. */
static void random_problem(uint64_t *seed, bool holds, bool forces, wh_contact_work *w) {
    static const wh_contact_kind kinds[] = {WH_STOP, WH_FRICTION, WH_HOLD};
    hand_build(2, draw_whole(seed, 2, 4), draw_whole(seed, -1, 1), draw_whole(seed, 2, 4));
    for (unsigned k = 0; k < CONTACTS; k++) {
        const wh_contact_kind drawn = kinds[draw_bits(seed) % (holds && k == 0 ? 3U : 2U)];
        const wh_contact_kind kind = drawn == WH_FRICTION && !forces ? WH_STOP : drawn;
        wh_real row[2] = {draw_whole(seed, -1, 1), draw_whole(seed, -1, 1)};
        if (kind == WH_FRICTION || (row[0] == WH_R(0.0) && row[1] == WH_R(0.0))) {
            row[0] = WH_R(1.0);
            row[1] = WH_R(0.0);
        }
        hand_add(kind, -1, row[0], row[1], WH_R(0.0), draw_whole(seed, 0, 3), WH_R(0.0));
    }
    hand_start(false);
    hand_now.system.forces(&hand_now, NULL, NULL, NULL, NULL, w->law);
    for (unsigned k = 0; k < CONTACTS; k++) {
        w->rough[k] = WH_R(10.0);
        w->force[k] = WH_R(0.0);
        w->mode[k] = (int8_t)(hand_now.contact[k].kind == WH_FRICTION ? WH_STUCK : WH_ACTIVE);
    }
    w->capped = false;
}

static void turn(wh_contact_work *w, unsigned k) {
    for (unsigned i = 0; i < 2; i++) {
        hand_now.law[k].row[i] = -hand_now.law[k].row[i];
    }
    hand_now.system.forces(&hand_now, NULL, NULL, NULL, NULL, w->law);
}

/* The conditions' allowance for round-off. */
#define SLACK (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-3))

/* The members' forces are within their limits, with one-way motion at a limit. left[] is the residual; giving way is reported. */
static bool meets_its_conditions(const wh_contact_work *w, const uint8_t *member, unsigned count,
                                 const wh_real *wanted, const wh_real *lambda, const wh_real *left,
                                 unsigned giving) {
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = member[i];
        const wh_real low = wh_contact_low(&hand_now.system, w, k);
        const wh_real high = wh_contact_high(&hand_now.system, w, k);
        wh_real leaves = -wanted[i];
        for (unsigned l = 0; l < count; l++) {
            leaves += wh_delassus(&hand_now.system, w, k, member[l]) * lambda[l];
        }
        const bool gives = (giving >> k & 1U) != 0;
        const bool within = lambda[i] >= low - SLACK && lambda[i] <= high + SLACK;
        const bool at_low = lambda[i] <= low + SLACK;
        const bool at_high = lambda[i] >= high - SLACK;
        const bool off = WH_ABS(leaves) > SLACK;
        if (!within || (off && !(leaves > WH_R(0.0) ? at_low : at_high)) || (off && !gives) ||
            (gives && !at_low && !at_high) || WH_ABS(leaves - left[i]) > SLACK) {
            return false;
        }
        giving &= ~(1U << k);
    }
    return giving == 0;
}

static unsigned draw_members(uint64_t *seed, uint8_t *member) {
    const unsigned first = (unsigned)draw_bits(seed) % CONTACTS;
    const unsigned step = 1U + (unsigned)draw_bits(seed) % 2U;
    for (unsigned i = 0; i < CONTACTS; i++) {
        member[i] = (uint8_t)((first + i * step) % CONTACTS);
    }
    return 1U + (unsigned)draw_bits(seed) % CONTACTS;
}

static void check(bool holds, bool forces) {
    uint64_t seed = 20240611;
    unsigned wrong = 0;
    unsigned capped = 0;
    for (unsigned i = 0; i < PROBLEMS; i++) {
        wh_contact_work w = {.capped = false};
        uint8_t member[CONTACTS];
        wh_real accel[2];
        wh_real wanted[CONTACTS];
        wh_real lambda[CONTACTS];
        wh_real left[CONTACTS];
        random_problem(&seed, holds, forces, &w);
        const unsigned count = draw_members(&seed, member);
        /* of possible accelerations, or of impacts */
        accel[0] = draw_whole(&seed, -4, 4);
        accel[1] = draw_whole(&seed, -4, 4);
        for (unsigned m = 0; m < count; m++) {
            const unsigned k = member[m];
            const wh_real bounce =
                forces || holds ? WH_R(0.0) : draw_whole(&seed, 0, 2) / WH_R(2.0);
            wanted[m] = -wh_jacobian_times(&hand_now.system, &w, k, accel);
            if (!forces && wanted[m] < WH_R(0.0)) { /* an opening stop takes no part */
                turn(&w, k);
                wanted[m] = -wanted[m];
            }
            wanted[m] *= WH_R(1.0) + (hand_now.contact[k].kind == WH_STOP ? bounce : WH_R(0.0));
        }
        const unsigned giving =
            wh_contact_lcp(&hand_now.system, &w, member, count, wanted, forces, lambda, left);
        capped += w.capped;
        wrong +=
            !w.capped && !meets_its_conditions(&w, member, count, wanted, lambda, left, giving);
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_EQUAL_UINT(0, capped);
}

TEST(lcp, forces_meet_their_conditions) { check(false, true); }
TEST(lcp, forces_beside_holds_do) { check(true, true); }
/* Stops at the same place may bounce differently: their targets contradict each other. */
TEST(lcp, impulses_meet_their_conditions) { check(false, false); }
TEST(lcp, impulses_beside_holds_do) { check(true, false); }
