/* test_contact_flat.c: finds the state in which holds lose rank (core/contact/contact_rank.h). test_contact_rank.c
 * tests the rows themselves. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 3000 : 60 };

/* Draws stops and holds on lines and angles, or holds alone. The mechanism's `held` is the number of holds that can
 * slip. */
static void draw(uint64_t *seed, unsigned angles, wh_contact_work *w) {
    const unsigned stops = draw_one_in(seed, 2) ? WH_KIND_BIT(WH_STOP) : 0U;
    bench_build(seed, BENCH_COORDS, angles);
    bench_add_some(seed, stops | WH_KIND_BIT(WH_HOLD));
    for (unsigned k = 0; k < bench_now.system.forced; k++) {
        wh_contact *c = &bench_now.contact[k];
        if (c->kind == WH_HOLD) {
            c->direction = (int8_t)draw_whole(seed, -1, 1);
            c->first_set = c->pin < 0 ? bench_now.system.held++ : BENCH_CONTACTS - 1;
        }
    }
    bench_work(seed, draw_one_in(seed, 2), w);
}

static bool holds(const wh_contact_work *w, unsigned k) {
    return bench_now.contact[k].kind == WH_HOLD && w->mode[k] == WH_ACTIVE;
}

/* The rows change with the position of the first coordinate. The core tests the state that the rates alone would
 * reach, then the step's end, if the step was made. It reports the first state in which rank is lost. If no curved
 * hold can slip, it tests nothing. */
TEST(contact_flat, rank_loss_at_either_state) {
    uint64_t seed = 242;
    unsigned seen[3] = {0};
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state place[3]; /* start, state that the rates alone reach, end */
        wh_contact_rows rows[3];
        bool any = false;
        draw(&seed, 0, &w);
        const wh_contact_system *of = &bench_now.system;
        for (unsigned k = 0; k < of->forced; k++) {
            bench_now.lean[k] = bench_now.contact[k].pin < 0 ? draw_whole(&seed, -2, 2) : WH_R(0.0);
            any = any || (holds(&w, k) && bench_now.contact[k].pin < 0 &&
                          bench_now.contact[k].direction <= 0);
        }
        const wh_real span = draw_whole(&seed, 1, 4) / 2;
        bench_state(&seed, &place[0]);
        place[1] = place[0];
        for (unsigned i = 0; i < of->coordinates; i++) {
            place[1].real[i] += span * place[0].real[of->coordinates + i];
        }
        bench_state(&seed, &place[2]);
        for (unsigned i = 0; i < 3; i++) {
            wh_contact_point at;
            wh_contact_point_of(of, &place[i], &at);
            wh_contact_rows_of(of, &w, &at, NULL, &rows[i]);
        }
        const unsigned ahead = wh_contact_fallen(of, &rows[0], &rows[1]);
        const unsigned there = wh_contact_fallen(of, &rows[0], &rows[2]);
        const bool made = draw_one_in(&seed, 2);
        const unsigned lost = ahead < of->contacts || !made ? ahead : there;
        wh_contact_state *to = made ? &place[2] : NULL;
        TEST_ASSERT_EQUAL_UINT(lost, wh_contact_lost(of, &w, span, &place[0], to, NULL));
        TEST_ASSERT_EQUAL_UINT(any ? lost : of->contacts,
                               wh_contact_flat(of, &w, span, &place[0], to, NULL));
        seen[ahead < of->contacts ? 0 : lost < of->contacts ? 1 : 2]++;
    }
    TEST_ASSERT_TRUE(seen[0] > ROUNDS / 64 && seen[1] > ROUNDS / 64 && seen[2] > ROUNDS / 64);
}

/* The state that the rates alone reach: angles and positions move by rate times time. */
TEST(contact_flat, state_that_rates_alone_reach) {
    uint64_t seed = 243;
    for (unsigned round = 0; round < ROUNDS / 4; round++) {
        wh_contact_work w;
        wh_contact_state s;
        wh_contact_state there;
        wh_contact_point at;
        wh_contact_point right;
        draw(&seed, (unsigned)draw_bits(&seed) % (BENCH_COORDS + 1U), &w);
        const wh_contact_system *of = &bench_now.system;
        const wh_real span = draw_whole(&seed, -2, 2) / 4;
        bench_state(&seed, &s);
        there = s;
        for (unsigned i = 0; i < of->coordinates; i++) {
            wh_contact_move(of, i, span * wh_contact_rates(of, &s)[i], &there);
        }
        wh_contact_point_of(of, &there, &right);
        wh_contact_point_ahead(of, &s, span, NULL, &at);
        for (unsigned i = 0; i < of->coordinates; i++) {
            const unsigned angles = of->angles;
            TEST_ASSERT_TRUE(at.rate[i] == wh_contact_rates(of, &s)[i]);
            TEST_ASSERT_TRUE(i < angles ? at.phase[i] == right.phase[i]
                                        : at.linear[i - angles] == right.linear[i - angles]);
        }
    }
}
