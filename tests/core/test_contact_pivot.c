/* test_contact_pivot.c: the pivoting of core/contact/contact_lcp.h, in parts and as a whole. The reference tries every
 * combination of limits. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 4000 : 60 };

static wh_real low_of(unsigned k) {
    const uint8_t kind = bench_now.contact[k].kind;
    return kind == WH_STOP ? WH_R(0.0) : kind == WH_FRICTION ? -bench_now.first[k] : -WH_LIMITLESS;
}

static wh_real high_of(unsigned k) {
    return bench_now.contact[k].kind == WH_FRICTION ? bench_now.first[k] : WH_LIMITLESS;
}

/* Returns a bound on the round-off of a residual. If `forces`, the bound includes the forces' terms. */
static wh_real noise_of(const wh_contact_work *w, unsigned k, bool forces, wh_real wanted,
                        wh_real made, wh_real lambda) {
    const wh_real sum = WH_ABS(wanted) + WH_ABS(made) + WH_ABS(lambda * bench_delassus(k, k));
    return WH_CONTACT_ROUNDING * sum + (forces ? WH_CONTACT_QUIET * w->rough[k] : WH_R(0.0));
}

/* Draws a bound on round-off: 0, or as large as the drawn numbers. */
static wh_real draw_rough(uint64_t *seed) {
    return draw_one_in(seed, 2) ? WH_R(0.0) : draw_whole(seed, 1, 8) / WH_CONTACT_QUIET;
}

/* The wanted force of a single contact is random, or differs from its limit by 0 to 1000 times the round-off. */
TEST(contact_pivot, force_of_one_contact_is_limited) {
    uint64_t seed = 121;
    unsigned gave = 0;
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        static const wh_real tenths[] = {WH_R(0.0), WH_R(0.9), WH_R(1.1), WH_R(1e3)};
        wh_contact_work w;
        wh_real lambda = BENCH_SENTINEL;
        wh_real left = BENCH_SENTINEL;
        bench_plain(&seed, &w);
        const unsigned k = draw_one_of(&seed, bench_now.system.forced);
        const bool forces = draw_one_in(&seed, 2);
        const bool up = draw_one_in(&seed, 2);
        const wh_real yield = bench_delassus(k, k);
        w.rough[k] = draw_rough(&seed);
        wh_real wanted = draw_whole(&seed, -8, 8);
        if (draw_one_in(&seed, 2) && (up ? high_of(k) : -low_of(k)) < WH_LIMITLESS) {
            wanted = (up ? high_of(k) : low_of(k)) * yield; /* the limit, times a factor near 1 */
            const wh_real off = tenths[draw_bits(&seed) % 4U] *
                                noise_of(&w, k, forces, wanted, wanted, wanted / yield);
            wanted += draw_one_in(&seed, 2) ? off : -off;
        }
        const uint8_t member[1] = {(uint8_t)k};
        const unsigned giving =
            draw_one_in(&seed, 2)
                ? wh_contact_lcp_one(&bench_now.system, &w, k, wanted, forces, &lambda, &left)
                : wh_contact_lcp(&bench_now.system, &w, member, 1, &wanted, forces, &lambda, &left);
        const wh_real alone = wanted / yield;
        const wh_real right = alone < low_of(k)    ? low_of(k)
                              : alone > high_of(k) ? high_of(k)
                                                   : alone;
        const wh_real made = yield * right;
        const wh_real off = right == alone ? WH_R(0.0) : made - wanted;
        const bool gives = WH_ABS(off) > noise_of(&w, k, forces, wanted, made, right);
        TEST_ASSERT_TRUE(lambda == right && left == off);
        TEST_ASSERT_EQUAL_UINT(gives ? 1U << k : 0U, giving);
        gave += gives;
    }
    TEST_ASSERT_TRUE(gave > ROUNDS / 8);
}

/* Some contacts are beyond a limit, others at a limit that they should leave. The one with the lowest number is chosen,
 * whatever its index. */
TEST(contact_pivot, lowest_numbered_violation_is_chosen) {
    uint64_t seed = 123;
    unsigned none = 0;
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_pivot p = {.contradicted = draw_one_of(&seed, 16U), .giving = ~0U};
        wh_real way[WH_COORDS];
        int8_t to = 9;
        int8_t right_to = 9;
        unsigned giving = 0;
        bench_plain(&seed, &w);
        const unsigned count = bench_members(&seed, p.member);
        const bool forces = draw_one_in(&seed, 2);
        unsigned wrong = count;
        bench_vector(&seed, way);
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = p.member[i];
            const bool still = draw_one_in(&seed, 2);
            p.at[i] = (int8_t)(draw_one_in(&seed, 2) ? 0 : draw_one_in(&seed, 2) ? 1 : -1);
            p.wanted[i] = bench_along(k, way) + (still ? WH_R(0.0) : draw_whole(&seed, -8, 8));
            p.lambda[i] = draw_whole(&seed, -4, 4);
            if (bench_now.contact[k].kind != WH_HOLD && draw_one_in(&seed, 4)) {
                p.lambda[i] = p.at[i] > 0 && high_of(k) < WH_LIMITLESS ? high_of(k) : low_of(k);
            }
            p.left[i] = BENCH_SENTINEL;
            w.rough[k] = draw_rough(&seed);
        }
        TEST_ASSERT_TRUE(count <= BENCH_FORCED);
        const unsigned said =
            wh_contact_pivot_wrong(&bench_now.system, &w, &p, count, forces, way, &to);
        for (unsigned k = 0; k < bench_now.system.forced; k++) {
            /* sorted by the contacts' numbers */
            for (unsigned i = 0; i < count; i++) {
                if (p.member[i] != k) {
                    continue;
                }
                const wh_real made = bench_along(k, way);
                const wh_real noise = noise_of(&w, k, forces, p.wanted[i], made, p.lambda[i]);
                const wh_real away = (wh_real)-p.at[i] * (made - p.wanted[i]);
                const bool below = p.lambda[i] < low_of(k);
                const bool beyond = p.at[i] == 0 && (below || p.lambda[i] > high_of(k));
                const bool pulled = p.at[i] != 0 && away < -noise;
                const bool shows = p.at[i] != 0 && away > noise;
                const bool told =
                    p.at[i] != 0 && !pulled && !shows && (p.contradicted >> k & 1U) != 0;
                if (wrong == count && (beyond || pulled)) {
                    wrong = i;
                    right_to = (int8_t)(pulled ? 0 : below ? -1 : 1);
                }
                giving |= shows || told ? 1U << k : 0U;
                TEST_ASSERT_TRUE(p.left[i] == (p.at[i] == 0 ? WH_R(0.0)
                                               : told       ? (wh_real)-p.at[i] * noise
                                                            : made - p.wanted[i]));
            }
        }
        TEST_ASSERT_EQUAL_UINT(wrong, said);
        TEST_ASSERT_EQUAL_INT(right_to, to);
        TEST_ASSERT_EQUAL_UINT(giving, p.giving);
        none += wrong == count;
    }
    TEST_ASSERT_TRUE(none > ROUNDS / 10);
}

#define SLACK (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-3))

/* Digit k of `number` in base three says whether contact k is at its low limit, free, or at its high limit. Returns
 * true if this combination solves the problem. */
static bool solves(unsigned number, const uint8_t *member, unsigned count, const wh_real *wanted,
                   wh_real *lambda, wh_real *left) {
    int8_t at[BENCH_CONTACTS];
    wh_real need[BENCH_CONTACTS];
    unsigned out = 0;
    for (unsigned i = 0; i < count; i++, number /= 3U) {
        at[i] = (int8_t)((int)(number % 3U) - 1);
        left[i] = at[i] < 0 ? low_of(member[i]) : at[i] > 0 ? high_of(member[i]) : WH_R(0.0);
        out |= at[i] != 0 ? 1U << i : 0U;
        if (WH_ABS(left[i]) >= WH_LIMITLESS) {
            return false;
        }
    }
    for (unsigned i = 0; i < count; i++) {
        need[i] = wanted[i];
        for (unsigned j = 0; j < count; j++) {
            need[i] -= bench_delassus(member[i], member[j]) * left[j];
        }
    }
    bench_solve(member, count, out | bench_repeats(member, count, at), need, lambda);
    for (unsigned i = 0; i < count; i++) {
        lambda[i] = at[i] != 0 ? left[i] : lambda[i];
    }
    for (unsigned i = 0; i < count; i++) {
        left[i] = -wanted[i];
        for (unsigned j = 0; j < count; j++) {
            left[i] += bench_delassus(member[i], member[j]) * lambda[j];
        }
        if ((at[i] == 0 && WH_ABS(left[i]) > SLACK) || (wh_real)at[i] * left[i] > SLACK ||
            lambda[i] < low_of(member[i]) - SLACK || lambda[i] > high_of(member[i]) + SLACK) {
            return false;
        }
    }
    return true;
}

/* The accelerations equal those of every combination that solves the problem. So do the forces, if no rows are
 * dependent. */
TEST(contact_pivot, solution_equals_every_valid_combination) {
    uint64_t seed = 124;
    unsigned solved = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real left[BENCH_CONTACTS];
        wh_real right[BENCH_CONTACTS];
        wh_real rest[BENCH_CONTACTS];
        bench_plain(&seed, &w);
        const unsigned count = bench_members(&seed, member);
        unsigned number = 0;
        unsigned cases = 1;
        for (unsigned i = 0; i < count; i++) {
            wanted[i] = draw_whole(&seed, -8, 8);
            cases *= 3U;
        }
        while (number < cases && !solves(number, member, count, wanted, right, rest)) {
            number++;
        }
        w.capped = draw_one_in(&seed, 2);
        const bool was_capped = w.capped;
        const bool forces = draw_one_in(&seed, 2); /* otherwise impulses */
        const unsigned giving =
            wh_contact_lcp(&bench_now.system, &w, member, count, wanted, forces, lambda, left);
        if (number == cases) { /* no combination solves it: the holds contradict each other */
            continue;
        }
        solved++;
        const bool unique = bench_repeats(member, count, NULL) == 0;
        unsigned gives = 0;
        for (unsigned i = 0; i < count; i++) {
            gives |= WH_ABS(rest[i]) > SLACK ? 1U << member[i] : 0U;
            TEST_ASSERT_TRUE(WH_ABS(left[i] - rest[i]) <= SLACK);
            TEST_ASSERT_TRUE(!unique || WH_ABS(lambda[i] - right[i]) <= SLACK);
        }
        TEST_ASSERT_TRUE(w.capped == was_capped);
        TEST_ASSERT_TRUE(!unique || giving == gives);
    }
    TEST_ASSERT_TRUE(solved > ROUNDS / 2);
}

/* A problem that would cycle, because no residual counts as small here. The pivoting ends after 4 n + 1 rounds,
 * including the last round's release. */
TEST(contact_pivot, cycling_ends_after_limited_rounds) {
    uint64_t seed = 125;
    for (unsigned count = 2; count <= BENCH_COORDS; count++) {
        wh_contact_work w;
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real left[BENCH_CONTACTS];
        bench_build(&seed, BENCH_COORDS, 0);
        for (unsigned i = 0; i < count; i++) {
            (void)bench_add(&seed, WH_FRICTION, (int)i);
            bench_now.inverse[i][i] += WH_R(8.0);
            member[i] = (uint8_t)i;
        }
        bench_work(&seed, false, &w);
        for (unsigned i = 0; i < count; i++) {
            wanted[i] =
                /* so that only lambda[0] is nonzero in the solution */
                bench_delassus(i, 0) * 2 * bench_now.first[0];
            w.rough[i] = -BENCH_SENTINEL / WH_CONTACT_QUIET;
        }
        (void)wh_contact_lcp(&bench_now.system, &w, member, count, wanted, true, lambda, left);
        TEST_ASSERT_TRUE(w.capped);
        TEST_ASSERT_TRUE(bench_near(lambda[0], 2 * bench_now.first[0]));
    }
}
