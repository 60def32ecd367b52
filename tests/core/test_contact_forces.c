/* test_contact_forces.c: the forces of redundant contacts (core/contact/contact_forces.h). The reference is
 * wh_contact_lcp(), which test_contact_pivot.c tests. test_contact_exact.c compares forces and impulses of whole runs. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 4000 : 100 };

static void draw(uint64_t *seed, bool some, wh_contact_work *w) {
    bench_draw(seed, true);
    bench_work(seed, some, w);
}

/* Writes the members' targets and returns their number. A sliding contact pushes against its motion; the others keep J
 * q'' + J' q' at zero. */
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

/* True if the redundant contacts reach their targets by the forces of the others alone. */
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
TEST(contact_forces, redundant_contacts_share_the_load) {
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
            /* Contacts must agree in the path's curvature alone, and in all terms. */
            bend[i] = -bench_now.bias[member[i]];
        }
        contradicts = !agrees(member, count, repeats, bend, lambda);
        contradicts = !agrees(member, count, repeats, wanted, lambda) || contradicts;
        for (unsigned i = 0; i < count; i++) {
            const bool stop = bench_now.contact[member[i]].kind == WH_STOP;
            exceeds = exceeds || wh_contact_exceeds(of, &w, member[i], lambda[i]);
            open = open || (stop && (repeats >> i & 1U) == 0 && bench_near(lambda[i], WH_R(0.0)));
        }
        if (open) { /* The force is zero within round-off, so it may or may not exceed its limit. */
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
                /* The contact reports a force beyond its limit: the excess is at least a thousandth of the limit. */
                force_of -= left[i] / bench_delassus(k, k);
                if (!wh_contact_exceeds(of, &w, k, force_of)) {
                    force_of +=
                        (left[i] < WH_R(0.0) ? WH_R(0.001) : WH_R(-0.001)) * WH_ABS(lambda[i]);
                }
            }
            TEST_ASSERT_TRUE(bench_near(w.force[k], force_of));
        }
        if (!contradicts) { /* the bits must be those without sharing */
            (void)wh_delassus_solve(of, &w, member, count, NULL, w.wanted, plain);
            for (unsigned i = 0; i < count; i++) {
                wh_contact_apply(of, &w, member[i], plain[i], unshared);
            }
            for (unsigned c = 0; c < of->coordinates; c++) {
                TEST_ASSERT_TRUE(accel[c] ==
                                 (bench_pins(member, count, c) ? WH_R(0.0) : unshared[c]));
            }
        }
        bool disturbed = false;
        for (unsigned c = 0; c < of->coordinates; c++) {
            for (unsigned i = 0; i < count; i++) {
                right[c] += bench_way(member[i], c) * lambda[i];
            }
            if (!bench_pins(member, count, c)) {
                disturbed = disturbed || !bench_near(accel[c], right[c]);
            }
        }
        TEST_ASSERT_TRUE(!disturbed || (giving != 0 && !contradicts));
        seen[exceeds][contradicts]++;
    }
    TEST_ASSERT_TRUE(seen[0][0] > ROUNDS / 32 && seen[1][0] > ROUNDS / 32);
    TEST_ASSERT_TRUE(seen[0][1] > ROUNDS / 32 && seen[1][1] > ROUNDS / 32);
}

/* If a coordinate is pinned and held, its acceleration is zero, unless its unconstrained acceleration is NaN. */
TEST(contact_forces, pinned_accelerations_are_zero_or_nan) {
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
