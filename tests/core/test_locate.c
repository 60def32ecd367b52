/* test_locate.c: crossings whose values are flat or steep where they vanish. test_contact_search.c checks the search of
 * straight and bent ones, test_contact_exact.c whole steps with crossings, stops and friction. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

enum { CASES = __STDC_HOSTED__ ? 3000 : 200 };

#define STEP_S WH_R(0.001)

/* Draws a number from 0 to 1 in steps of 1/1024. */
static wh_real share_of(uint64_t *seed) {
    return (wh_real)(draw_bits(seed) % 1023U + 1U) / WH_R(1024.0);
}

/* x = v t + a t^2/2, monotone over the step: the speed changes by at most nine tenths. */
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

/* Crossings with flat or steep values are located with full accuracy before the limit of evaluations is reached. */
TEST(locate, flat_and_steep_crossings_are_found) {
    uint64_t seed = 415;
    for (unsigned i = 0; i < CASES; i++) {
        const path p = random_path(&seed);
        const wh_real t = STEP_S * share_of(&seed);
        start(p);
        (void)add_crossing(place_at(p, t), 0);
        hand_now.bent =
            i % (WH_DOUBLE ? 4U : 3U); /* the value is power 1, 3, 5 or 7 of the distance */
        hand_start(false);
        hand_looks = 0;
        hand_steps(1);
        TEST_ASSERT_TRUE(hand_state.contacts->events == 1 && hand_looks <= WH_PROBES + 8U);
        TEST_ASSERT_TRUE(WH_ABS(hand_state.contacts->log[0].at_s - t) <= WH_BRACKET * STEP_S);
    }
}
