/* test_contact_load.c: decisions of core/contact/contact_lcp.h next to the limit of round-off, compared with explicit
 * sums. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 4000 : 100 };

static void draw_places(uint64_t *seed, unsigned count, int8_t *at) {
    for (unsigned i = 0; i < BENCH_CONTACTS; i++) {
        at[i] = (int8_t)(i >= count || draw_one_in(seed, 3) ? (draw_one_in(seed, 2) ? 1 : -1) : 0);
    }
}

/* Returns the sum of the magnitudes of the terms of a contact's acceleration. The terms are its bias and, for each
 * coordinate, the parts of the acceleration and of each force. */
static wh_real terms_of(const wh_contact_work *w, unsigned k, const wh_real *accel) {
    wh_real size = WH_ABS(bench_now.bias[k]);
    for (unsigned c = 0; c < bench_now.system.coordinates; c++) {
        size += WH_ABS(bench_now.row[k][c] * accel[c]);
        for (unsigned l = 0; l < bench_now.system.forced; l++) {
            size += WH_ABS(bench_now.row[k][c] * bench_way(l, c) * w->force[l]);
        }
    }
    return size;
}

/* Adds the largest effect that another contact has along any chain of contacts without repetition. */
static wh_real size_of(const wh_contact_work *w, const uint8_t *member, unsigned count, unsigned i,
                       unsigned passed, const wh_real *accel) {
    wh_real most = terms_of(w, member[i], accel);
    for (unsigned l = 0; l < count; l++) {
        if (l != i && (passed >> l & 1U) == 0) {
            const wh_real there = size_of(w, member, count, l, passed | 1U << i, accel);
            const wh_real share =
                WH_ABS(bench_delassus(member[i], member[l])) / bench_delassus(member[l], member[l]);
            most = share * there > most ? share * there : most;
        }
    }
    return most;
}

TEST(contact_load, magnitudes_for_round_off) {
    uint64_t seed = 103;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real accel[WH_COORDS];
        bench_plain(&seed, &w);
        const unsigned count = bench_members(&seed, member);
        bench_vector(&seed, accel);
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            w.rough[k] = BENCH_SENTINEL;
        }
        wh_contact_magnitudes(&bench_now.system, &w, member, count, accel);
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = member[i];
            TEST_ASSERT_TRUE(bench_near(w.rough[k], size_of(&w, member, count, i, 0, accel)));
        }
        for (unsigned i = 0; i < count; i++) {
            w.rough[member[i]] = BENCH_SENTINEL;
        }
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) { /* other entries must not be written */
            TEST_ASSERT_TRUE(w.rough[k] == BENCH_SENTINEL);
        }
    }
    const wh_real share = WH_CONTACT_ROUNDING;
    TEST_ASSERT_TRUE(wh_contact_rounding(-1, 2, -4) == share * 7);
    TEST_ASSERT_TRUE(wh_contact_rounding(1, -2, 4) == share * 7);
}

/* Reference: the sign of the force that is missing, for the accelerations or for the curvature alone; 0: none. */
static int8_t pushed(wh_real missing, wh_real made, wh_real size, wh_real bend, wh_real bent,
                     wh_real bends_by) {
    const wh_real limit = WH_CONTACT_ROUNDING * (WH_ABS(size) + WH_ABS(made));
    const wh_real bend_limit = WH_CONTACT_ROUNDING * (WH_ABS(bend) + WH_ABS(bent) + bends_by);
    const wh_real more = bend - bent;
    if (WH_ABS(missing) > limit) {
        return missing > WH_R(0.0) ? 1 : -1;
    }
    if (WH_ABS(more) > bend_limit && WH_ABS(more) > WH_CONTACT_CREEP * size) {
        return more > WH_R(0.0) ? 1 : -1;
    }
    return 0;
}

/* wh_contact_contradicts(): each term in turn is at its threshold, below it and above it; the other terms are zero. */
TEST(contact_load, contradictions_exceed_round_off) {
    uint64_t seed = 104;
    unsigned seen[3] = {0};
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        wh_contact_work w;
        uint8_t member[BENCH_CONTACTS] = {0};
        int8_t at[BENCH_CONTACTS] = {0};
        int8_t push[BENCH_CONTACTS];
        wh_real impulse[BENCH_CONTACTS];
        wh_real wanted[BENCH_CONTACTS];
        wh_real need[BENCH_CONTACTS];
        wh_real hold[BENCH_CONTACTS];
        wh_real way[WH_COORDS];
        unsigned out;
        bench_plain(&seed, &w);
        const unsigned count = bench_members(&seed, member);
        const bool rates = draw_one_in(&seed, 2);
        const wh_real scale[3] = {WH_R(1.0), WH_R(1.0) / WH_CONTACT_ROUNDING,
                                  WH_R(1.0) / WH_CONTACT_CREEP};
        const wh_real big = scale[draw_bits(&seed) % (rates ? 2U : 3U)];
        const wh_real small = draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(0.0);
        const wh_real more =
            /* an inexact curvature shall not be near its threshold */
            big == scale[2] ? WH_R(0.53) : WH_R(0.0);
        draw_places(&seed, count, at);
        bench_vector(&seed, way);
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = member[i];
            bench_now.bias[k] *= small;
            w.rough[k] = (draw_whole(&seed, 0, 4) + more) * big;
            impulse[i] = draw_whole(&seed, -4, 4) * (rates ? big : WH_R(1.0));
            wanted[i] = bench_along(k, way) + draw_whole(&seed, -8, 8);
            /* just within the limit of round-off, or just beyond */
            if (rates && draw_one_in(&seed, 2)) {
                const wh_real made = bench_along(k, way);
                const wh_real part = draw_one_in(&seed, 2) ? WH_R(1.75) : WH_R(2.25);
                wanted[i] = made + part * WH_CONTACT_ROUNDING * made;
                impulse[i] = WH_R(0.0);
            }
        }
        bench_now.system.forces(NULL, NULL, NULL, NULL, NULL, w.law);
        const unsigned repeats = bench_repeats(member, count, at);
        /* With curvature, only redundant contacts are tested. */
        const unsigned any = small == WH_R(0.0) || rates ? (1U << count) - 1U : repeats;
        const unsigned asked = any & (unsigned)draw_bits(&seed);
        out = repeats;
        for (unsigned i = 0; i < count; i++) {
            out |= at[i] != 0 ? 1U << i : 0U;
            need[i] = -bench_now.bias[member[i]];
            push[i] = 9;
        }
        push[count] = 9;
        bench_solve(member, count, out, need, hold);
        const wh_contact_set set = {member, count, at};
        wh_contact_contradicts(&bench_now.system, &w, &set, asked, rates ? impulse : NULL, wanted,
                               way, push);
        TEST_ASSERT_EQUAL_INT(9, push[count]);
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = member[i];
            const wh_real made = bench_along(k, way);
            wh_real size = rates ? WH_ABS(wanted[i]) : w.rough[k];
            wh_real bent = WH_R(0.0);
            wh_real bends_by = WH_R(0.0);
            for (unsigned l = 0; l < count; l++) {
                size += rates ? WH_ABS(bench_delassus(k, member[l]) * impulse[l]) : WH_R(0.0);
                bent += rates ? WH_R(0.0) : bench_delassus(k, member[l]) * hold[l];
                bends_by += rates ? WH_R(0.0) : WH_ABS(bench_delassus(k, member[l]) * hold[l]);
            }
            if ((asked >> i & 1U) == 0) {
                TEST_ASSERT_EQUAL_INT(0, push[i]);
                continue;
            }
            const int8_t right =
                pushed(wanted[i] - made, made, size, rates ? WH_R(0.0) : need[i], bent, bends_by);
            TEST_ASSERT_EQUAL_INT(right, push[i]);
            seen[right + 1]++;
        }
    }
    TEST_ASSERT_TRUE(seen[0] > ROUNDS / 8 && seen[1] > ROUNDS / 8 && seen[2] > ROUNDS / 8);
}

/* Two contacts with the same row and nearly equal curvature. The difference is compared with both curvatures and with
 * the terms of one contact. */
TEST(contact_load, small_differences_of_curvature_are_zero) {
    uint64_t seed = 107;
    for (unsigned round = 0; round < ROUNDS / 4; round++) {
        static const uint8_t member[2] = {0, 1};
        wh_contact_work w;
        const wh_real wanted[2] = {WH_R(0.0), WH_R(0.0)};
        const wh_real way[WH_COORDS] = {WH_R(0.0)};
        int8_t push[BENCH_CONTACTS];
        bench_build(&seed, 2, 0);
        (void)bench_add(&seed, WH_HOLD, -1);
        (void)bench_add(&seed, WH_HOLD, -1);
        const wh_real size =
            draw_whole(&seed, 1, 8) * (draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(-1.0));
        const bool more = draw_one_in(&seed, 2);
        const bool up = draw_one_in(&seed, 2);
        const wh_real least = WH_CONTACT_ROUNDING * 3 * WH_ABS(size);
        const wh_real off = least * (more ? WH_R(1.125) : WH_R(0.875));
        for (unsigned c = 0; c < 2; c++) {
            bench_now.row[1][c] = bench_now.row[0][c];
        }
        bench_now.bias[0] = size;
        bench_now.bias[1] = up ? size - off : size + off;
        bench_work(&seed, false, &w);
        const wh_contact_set set = {member, 2, NULL};
        wh_contact_contradicts(&bench_now.system, &w, &set, 2U, NULL, wanted, way, push);
        TEST_ASSERT_EQUAL_INT(0, push[0]);
        TEST_ASSERT_EQUAL_INT(!more ? 0 : up ? 1 : -1, push[1]);
    }
}
