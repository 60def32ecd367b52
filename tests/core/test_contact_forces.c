/* test_contact_forces.c: the forces and impulses of core/contact/contact_forces.h and their elimination, compared with
 * dense solves. For redundant contacts the reference is wh_contact_lcp(), which test_contact_pivot.c tests. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 4000 : 100 };

static void draw(uint64_t *seed, bool some, wh_contact_work *w) {
    bench_draw(seed, true);
    bench_work(seed, some, w);
}

/* The load of a contact includes the effect of the other contacts' forces. A contact that is redundant or at a limit
 * gets no force here. */
TEST(contact_forces, a_load_is_what_a_dense_solve_says) {
    uint64_t seed = 101;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        uint8_t member[BENCH_CONTACTS] = {0};
        int8_t at[BENCH_CONTACTS] = {0};
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real right[BENCH_CONTACTS];
        unsigned out;
        draw(&seed, false, &w);
        const unsigned count = bench_members(&seed, member);
        const bool some = count > 1 && draw_one_in(&seed, 2);
        for (unsigned i = 0; i < count; i++) {
            wanted[i] = draw_whole(&seed, -4, 4);
        }
        for (unsigned i = 0; i < count && some; i++) {
            at[i] = (int8_t)(draw_one_in(&seed, 3) ? (draw_one_in(&seed, 2) ? 1 : -1) : 0);
        }
        out = bench_repeats(member, count, at);
        TEST_ASSERT_EQUAL_UINT(out, wh_delassus_solve(&bench_now.system, &w, member, count,
                                                      some ? at : NULL, wanted, lambda));
        for (unsigned i = 0; i < count; i++) {
            out |= at[i] != 0 ? 1U << i : 0U;
        }
        bench_solve(member, count, out, wanted, right);
        for (unsigned i = 0; i < count; i++) {
            TEST_ASSERT_TRUE(bench_near(lambda[i], right[i]));
            TEST_ASSERT_TRUE((out >> i & 1U) == 0 || lambda[i] == WH_R(0.0));
        }
    }
    wh_real none = BENCH_SENTINEL;
    TEST_ASSERT_EQUAL_UINT(0,
                           wh_delassus_solve(&bench_now.system, NULL, NULL, 0, NULL, NULL, &none));
    TEST_ASSERT_TRUE(none == WH_R(0.0));
}

/* --- forces -------------------------------------------------------------------------------------------------- */

/* A sliding contact pushes against its motion; the others keep J q'' + J' q' at zero. Writes the targets and returns the
 * number of members. */
static unsigned draw_wanted(const wh_contact_work *w, wh_real *accel, uint8_t *member,
                            wh_real *wanted, wh_real *force) {
    unsigned count = 0;
    for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
        accel[i] = bench_now.free[i];
    }
    for (unsigned k = 0; k < bench_now.system.forced; k++) {
        force[k] = WH_R(0.0);
        if (bench_keeps(w, k)) {
            member[count++] = (uint8_t)k;
        } else if (bench_now.contact[k].kind == WH_FRICTION) {
            force[k] = (wh_real)-w->mode[k] * bench_now.second[k];
            for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
                accel[i] += bench_way(k, i) * force[k];
            }
        }
    }
    for (unsigned i = 0; i < count; i++) {
        wanted[i] = -(bench_now.bias[member[i]] + bench_along(member[i], accel));
    }
    return count;
}

static bool is_pinned(const uint8_t *member, unsigned count, unsigned c) {
    bool pinned = false;
    for (unsigned i = 0; i < count; i++) {
        pinned = pinned || bench_now.contact[member[i]].pin == (int)c;
    }
    return pinned;
}

TEST(contact_forces, forces_keep_what_is_kept) {
    uint64_t seed = 221;
    unsigned regular = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state s;
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real force[BENCH_CONTACTS];
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real right[WH_COORDS] = {WH_R(0.0)};
        wh_real accel[WH_COORDS] = {WH_R(0.0)};
        wh_real signal[2 * BENCH_CONTACTS];
        wh_contact_point at;
        const wh_real input = WH_R(0.0);
        draw(&seed, true, &w);
        bench_state(&seed, &s);
        const wh_contact_work was = w;
        const wh_contact_system *of = &bench_now.system;
        const unsigned count = draw_wanted(&w, right, member, wanted, force);
        bool acts = count > 0;
        for (unsigned k = 0; k < of->forced; k++) {
            acts = acts || bench_now.contact[k].kind == WH_FRICTION;
        }
        if (bench_repeats(member, count, NULL) != 0) {
            continue;
        }
        bench_solve(member, count, 0, wanted, lambda);
        for (unsigned i = 0; i < count; i++) {
            force[member[i]] = lambda[i];
            for (unsigned c = 0; c < of->coordinates; c++) {
                right[c] += bench_way(member[i], c) * lambda[i];
            }
        }
        bench_now.looks = 0;
        bench_now.laws = 0;
        w.law[0] = BENCH_SENTINEL;
        wh_contact_point_of(of, &s, &at);
        bench_now.at = &at;
        bench_now.input = &input;
        wh_contact_look(of, &w, &s, &input, accel, signal);
        TEST_ASSERT_TRUE(!bench_now.astray);
        TEST_ASSERT_TRUE(bench_now.looks == 1U && bench_now.laws == 1U && w.law[0] == was.law[0]);
        for (unsigned c = 0; c < of->coordinates; c++) {
            TEST_ASSERT_TRUE(bench_near(accel[c], right[c]));
            TEST_ASSERT_TRUE(!is_pinned(member, count, c) || accel[c] == WH_R(0.0));
        }
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            const bool its = acts && k < of->forced;
            TEST_ASSERT_TRUE(bench_near(w.force[k], its ? force[k] : was.force[k]));
        }
        for (unsigned i = 0; i < count; i++) {
            TEST_ASSERT_TRUE(bench_near(w.wanted[i], wanted[i]));
        }
        regular += count > 1;
    }
    TEST_ASSERT_TRUE(regular > ROUNDS / 32);
}

/* Do the redundant contacts reach their targets by the forces of the others? */
static bool agrees(const uint8_t *member, unsigned count, unsigned repeats, const wh_real *wanted,
                   wh_real *lambda) {
    bool good = true;
    bench_solve(member, count, repeats, wanted, lambda);
    for (unsigned i = 0; i < count; i++) {
        wh_real made = WH_R(0.0);
        for (unsigned j = 0; j < count; j++) {
            made += bench_delassus(member[i], member[j]) * lambda[j];
        }
        good = good && bench_near(made, wanted[i]);
    }
    return good;
}

/* Redundant contacts get no force if they agree with the others and no limit is exceeded. Otherwise they share the
 * load, and a contact that cannot take its share reports a force beyond its limit. The motion changes only if contacts
 * contradict each other. */
TEST(contact_forces, what_repeats_others_shares_their_load) {
    uint64_t seed = 222;
    unsigned seen[2][2] = {{0}};
    for (unsigned round = 0; round < 4U * ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_point at = {.rate = {WH_R(0.0)}};
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real force[BENCH_CONTACTS];
        wh_real wanted[BENCH_CONTACTS];
        wh_real bend[BENCH_CONTACTS];
        wh_real plain[BENCH_CONTACTS];
        wh_real unshared[WH_COORDS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real left[BENCH_CONTACTS];
        wh_real right[WH_COORDS] = {WH_R(0.0)};
        wh_real accel[WH_COORDS] = {WH_R(0.0)};
        bool contradicts = false;
        bool exceeds = false;
        bool open = false;
        unsigned giving = 0;
        draw(&seed, true, &w);
        const wh_contact_system *of = &bench_now.system;
        const bool straight = draw_one_in(&seed, 2);
        for (unsigned k = 0; k < of->forced; k++) {
            bench_now.bias[k] *= straight ? 0 : 1;
            bench_now.first[k] = draw_whole(&seed, 1, 8) * WH_R(1.03125);
        }
        of->forces(NULL, NULL, NULL, NULL, NULL, w.law);
        wh_contact_work other = w;
        const wh_contact_model model = {of, &w};
        const unsigned count = draw_wanted(&w, right, member, wanted, force);
        for (unsigned c = 0; c < WH_COORDS; c++) {
            unshared[c] = right[c];
        }
        const unsigned repeats = bench_repeats(member, count, NULL);
        if (repeats == 0) {
            continue;
        }
        for (unsigned i = 0; i < count; i++) {
            /* sizes of the terms: of the path's curvature alone, and of all terms */
            bend[i] = -bench_now.bias[member[i]];
        }
        contradicts = !agrees(member, count, repeats, bend, lambda);
        contradicts = !agrees(member, count, repeats, wanted, lambda) || contradicts;
        for (unsigned i = 0; i < count; i++) {
            const bool stop = bench_now.contact[member[i]].kind == WH_STOP;
            exceeds = exceeds || wh_contact_exceeds(of, &w, member[i], lambda[i]);
            open = open || (stop && (repeats >> i & 1U) == 0 && bench_near(lambda[i], WH_R(0.0)));
        }
        if (open) { /* the force is zero up to round-off, so it may or may not exceed its limit */
            continue;
        }
        wh_contact_accel(&model, at.phase, at.linear, at.rate, NULL, accel);
        if (exceeds || contradicts) {
            for (unsigned k = 0; k < of->forced; k++) {
                other.rough[k] = w.rough[k];
            }
            giving = wh_contact_lcp(of, &other, member, count, wanted, true, lambda, left);
        }
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = member[i];
            wh_real force_of = lambda[i];
            if ((giving >> k & 1U) != 0) {
                /* the excess of the force that it reports: at least a thousandth of the limit */
                force_of -= left[i] / bench_delassus(k, k);
                if (!wh_contact_exceeds(of, &w, k, force_of)) {
                    force_of +=
                        (left[i] < WH_R(0.0) ? WH_R(0.001) : WH_R(-0.001)) * WH_ABS(lambda[i]);
                }
            }
            TEST_ASSERT_TRUE(bench_near(w.force[k], force_of));
        }
        if (!contradicts) { /* the same bits as without sharing */
            (void)wh_delassus_solve(of, &w, member, count, NULL, w.wanted, plain);
            for (unsigned i = 0; i < count; i++) {
                wh_contact_apply(of, &w, member[i], plain[i], unshared);
            }
            for (unsigned c = 0; c < of->coordinates; c++) {
                TEST_ASSERT_TRUE(accel[c] ==
                                 (is_pinned(member, count, c) ? WH_R(0.0) : unshared[c]));
            }
        }
        bool disturbed = false;
        for (unsigned c = 0; c < of->coordinates; c++) {
            for (unsigned i = 0; i < count; i++) {
                right[c] += bench_way(member[i], c) * lambda[i];
            }
            if (!is_pinned(member, count, c)) {
                disturbed = disturbed || !bench_near(accel[c], right[c]);
            }
        }
        TEST_ASSERT_TRUE(!disturbed || (giving != 0 && !contradicts));
        seen[exceeds][contradicts]++;
    }
    TEST_ASSERT_TRUE(seen[0][0] > ROUNDS / 32 && seen[1][0] > ROUNDS / 32);
    TEST_ASSERT_TRUE(seen[0][1] > ROUNDS / 32 && seen[1][1] > ROUNDS / 32);
}

/* A coordinate that is pinned and held has zero acceleration, unless its unconstrained acceleration is NaN. */
TEST(contact_forces, no_number_stays_none_where_it_is_pinned) {
    uint64_t seed = 223;
    for (unsigned round = 0; round < ROUNDS / 8; round++) {
        wh_contact_work w;
        wh_contact_point at = {.rate = {WH_R(0.0)}};
        wh_real accel[WH_COORDS];
        bench_build(&seed, 2, 0);
        (void)bench_add(&seed, WH_STOP, 0);
        (void)bench_add(&seed, WH_HOLD, 1);
        const bool none = draw_one_in(&seed, 2);
        const wh_real zero = bench_now.free[0] - bench_now.free[0];
        bench_now.free[draw_bits(&seed) % 2U] += none ? zero / zero : zero;
        bench_work(&seed, false, &w);
        const wh_contact_model model = {&bench_now.system, &w};
        wh_contact_accel(&model, at.phase, at.linear, at.rate, NULL, accel);
        const bool zeros = accel[0] == WH_R(0.0) && accel[1] == WH_R(0.0);
        const bool any = accel[0] != accel[0] || accel[1] != accel[1];
        TEST_ASSERT_TRUE(none ? any : zeros);
    }
}

/* --- impulses ------------------------------------------------------------------------------------------------- */

/* Each contact in the set reaches its target rate; active holds, and the stops in `beside`, reach zero; stops only
 * push. A pinned contact whose target is zero gets exactly zero. Impulses are added to the earlier ones; the ledger
 * gets the work at the mean speed. */
TEST(contact_forces, impulses_lead_to_their_targets) {
    uint64_t seed = 224;
    unsigned given = 0;
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        wh_contact_work w;
        wh_ledger_work books = {.span = WH_R(0.0)};
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real target[BENCH_CONTACTS];
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real left[BENCH_CONTACTS];
        wh_real impulse[BENCH_CONTACTS];
        wh_real total[BENCH_CONTACTS];
        wh_real entry[WH_LEDGER_MAX] = {WH_R(0.0)};
        wh_real rate[WH_COORDS];
        wh_real right[WH_COORDS];
        unsigned count = 0;
        unsigned stops = 0;
        draw(&seed, true, &w);
        const wh_contact_system *of = &bench_now.system;
        w.books = draw_one_in(&seed, 2) ? &books : NULL;
        bench_vector(&seed, rate);
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            stops |= k < of->forced && bench_now.contact[k].kind != WH_FRICTION ? 1U << k : 0U;
            target[k] = draw_one_in(&seed, 2) ? WH_R(0.0) : draw_whole(&seed, -4, 4);
            impulse[k] = draw_whole(&seed, 0, 4);
            total[k] = impulse[k];
        }
        const unsigned set = stops & (unsigned)draw_bits(&seed);
        const unsigned beside = stops & (unsigned)draw_bits(&seed) & (unsigned)draw_bits(&seed);
        for (unsigned c = 0; c < WH_COORDS; c++) {
            right[c] = rate[c];
        }
        for (unsigned k = 0; k < of->forced; k++) {
            const bool holds = bench_now.contact[k].kind != WH_FRICTION && bench_keeps(&w, k);
            if (holds || ((set | beside) >> k & 1U) != 0) {
                wanted[count] =
                    ((set >> k & 1U) != 0 ? target[k] : WH_R(0.0)) - bench_along(k, rate);
                member[count++] = (uint8_t)k;
            }
        }
        if (count == 0) {
            continue;
        }
        const wh_contact_work was = w;
        const unsigned giving = wh_contact_lcp(of, &w, member, count, wanted, false, lambda, left);
        for (unsigned i = 0; i < count; i++) {
            total[member[i]] += lambda[i];
            for (unsigned c = 0; c < of->coordinates; c++) {
                right[c] += bench_way(member[i], c) * lambda[i];
            }
        }
        bool exact[WH_COORDS] = {false};
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = member[i];
            const unsigned first = wh_ledger_of_contact(of->ledger, k);
            const int pin = bench_now.contact[k].pin;
            const bool goes = (set >> k & 1U) != 0 && target[k] != WH_R(0.0);
            if (pin >= 0 && (giving >> k & 1U) == 0 && !goes) {
                right[pin] = WH_R(0.0);
                exact[pin] = true;
            }
            const wh_real mean = (bench_along(k, rate) + bench_along(k, right)) / 2;
            entry[first] = w.books != NULL ? lambda[i] * mean : WH_R(0.0);
            for (unsigned c = 0; c < of->coordinates && w.books != NULL; c++) {
                entry[first + 1U + c] = lambda[i] * bench_now.row[k][c];
            }
        }
        w = was;
        TEST_ASSERT_EQUAL_UINT(giving,
                               wh_contact_impulses(of, &w, set, beside, target, rate, impulse));
        for (unsigned c = 0; c < WH_COORDS; c++) {
            TEST_ASSERT_TRUE(bench_near(rate[c], right[c]));
            TEST_ASSERT_TRUE(!exact[c] || rate[c] == WH_R(0.0));
        }
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            TEST_ASSERT_TRUE(bench_near(impulse[k], total[k]));
        }
        for (unsigned e = 0; e < of->ledger->entries; e++) {
            TEST_ASSERT_TRUE(bench_near(books.step[e], entry[e]));
        }
        given += giving != 0;
    }
    TEST_ASSERT_TRUE(given > ROUNDS / 8);
}
