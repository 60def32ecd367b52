/* test_contact_places.c: each function of core/contact/contact_project.h, compared with dense solves in the mass
 * metric. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 3000 : 60 };

/* Draws contacts of some kinds in some modes, with straight or curved holds, each with its stored value. */
static void draw(uint64_t *seed, bool some, wh_contact_work *w) {
    bench_draw(seed, true);
    for (unsigned k = 0; k < bench_now.system.forced; k++) {
        wh_contact *c = &bench_now.contact[k];
        if (c->kind == WH_HOLD) {
            c->direction = (int8_t)draw_whole(seed, -1, 1);
            c->first_set = c->pin < 0 ? bench_now.system.held++ : BENCH_CONTACTS - 1;
        }
    }
    bench_work(seed, some, w);
    for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
        w->held[k] = draw_whole(seed, -4, 4);
    }
}

TEST(contact_places, only_one_coordinate_moves) {
    uint64_t seed = 141;
    for (unsigned round = 0; round < ROUNDS / 4; round++) {
        wh_contact_work w;
        wh_contact_state from;
        wh_contact_state to;
        draw(&seed, true, &w);
        bench_state(&seed, &from);
        to = from;
        const unsigned moved = draw_one_of(&seed, bench_now.system.coordinates);
        const wh_real by = draw_whole(&seed, -8, 8) / 4;
        wh_contact_move(&bench_now.system, moved, by, &to);
        for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
            TEST_ASSERT_TRUE(bench_near(bench_moved(&from, &to, i), i == moved ? by : WH_R(0.0)));
            TEST_ASSERT_TRUE(i == moved || bench_moved(&from, &to, i) == WH_R(0.0));
        }
        for (unsigned i = 0; i < bench_now.system.coordinates; i++) { /* no rate changes */
            const wh_real *was = wh_contact_rates(&bench_now.system, &from);
            TEST_ASSERT_TRUE(wh_contact_rates(&bench_now.system, &to)[i] == was[i]);
        }
    }
}

/* wh_contact_add_product() keeps all bits of a product: as many as a 64-bit integer has. A plain sum would lose the
 * last bits. */
TEST(contact_places, products_have_all_bits) {
    uint64_t seed = 142;
    const uint64_t size = WH_DOUBLE ? 0x7fffffff : 0xfffff;
    for (unsigned round = 0; round < ROUNDS; round++) {
        const int64_t a = (int64_t)(draw_bits(&seed) & size) - (int64_t)(size / 2U);
        const int64_t b = (int64_t)(draw_bits(&seed) & size) - (int64_t)(size / 2U);
        const int64_t was = (int64_t)(draw_bits(&seed) % 16U);
        wh_real sum = WH_R(0.0);
        wh_real rest = (wh_real)was;
        wh_contact_add_product((wh_real)a, (wh_real)b, &sum, &rest);
        TEST_ASSERT_TRUE(sum == (wh_real)a * (wh_real)b);
        TEST_ASSERT_TRUE((int64_t)sum + (int64_t)rest == a * b + was);
        wh_contact_add_product((wh_real)-a, (wh_real)b, &sum, &rest);
        TEST_ASSERT_TRUE(sum == WH_R(0.0) && rest == (wh_real)was);
    }
}

/* wh_contact_moved() returns J times the motion of positions and angles, at any distance from zero. */
TEST(contact_places, straight_motion_has_no_round_off) {
    uint64_t seed = 143;
    const uint64_t most = WH_DOUBLE ? 0x3fffffff : 0x7ffff;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from;
        wh_contact_state to;
        const bool far = draw_one_in(&seed, 2);
        const unsigned n = far ? 2U : 1U + draw_one_of(&seed, BENCH_COORDS);
        const unsigned angles =
            (unsigned)draw_bits(&seed) % (n + 1U) / (far ? 2U : 1U) * (far ? 2U : 1U);
        bench_build(&seed, n, angles);
        (void)bench_add(&seed, WH_HOLD, -1);
        (void)bench_add(&seed, WH_HOLD, -1);
        const unsigned k = draw_one_of(&seed, 2U);
        const int64_t way = (int64_t)(draw_bits(&seed) & most);
        const wh_real factor = (wh_real)(draw_bits(&seed) & most);
        int64_t sums[2] = {0, 0}; /* sums of the angles and of the positions */
        bench_state(&seed, &from);
        for (unsigned i = 0; far && i < n; i++) {
            bench_now.row[k][i] = factor;
            from.real[i] = WH_R(0.0);
        }
        to = from;
        for (unsigned i = 0; i < n; i++) {
            const int64_t by = (int64_t)draw_whole(&seed, -300, 300) + (!far     ? 0
                                                                        : i == 0 ? way
                                                                                 : -way);
            sums[i < angles ? 0 : 1] += (int64_t)bench_now.row[k][i] * by;
            if (i < angles) {
                to.angle[i] += (wh_angle)by;
            } else {
                to.real[i - angles] += (wh_real)by;
            }
        }
        bench_work(&seed, false, &w);
        const double turns = (double)sums[0] / (double)WH_PHASE_PER_RAD;
        const double ways = (double)sums[1];
        /* float: the product with the last eight bits of an angle's motion is rounded */
        const double last = far ? 512.0 * (double)factor / (double)WH_PHASE_PER_RAD : 0.0;
        const double size = last + (turns < 0.0 ? -turns : turns) + (ways < 0.0 ? -ways : ways);
        const double off =
            (double)wh_contact_moved(&bench_now.system, &w, k, &from, &to) - turns - ways;
        TEST_ASSERT_TRUE((off < 0.0 ? -off : off) <= (WH_DOUBLE ? 0.0 : 3e-7) * size);
    }
}

static bool slips(const wh_contact_work *w, unsigned k) {
    const wh_contact *c = &bench_now.contact[k];
    return c->kind == WH_HOLD && c->pin < 0 && w->mode[k] == WH_ACTIVE;
}

static wh_real drift_of(const wh_contact_work *w, unsigned k, const wh_contact_state *from,
                        const wh_contact_state *to) {
    const wh_contact *c = &bench_now.contact[k];
    wh_real moved = w->held[c->first_set];
    if (c->kind == WH_STOP) {
        return bench_now.signal[2 * k];
    }
    if (!slips(w, k) || (c->direction > 0 && from == NULL)) {
        return WH_R(0.0);
    }
    for (unsigned i = 0; i < bench_now.system.coordinates && c->direction > 0; i++) {
        moved += bench_now.row[k][i] * bench_moved(from, to, i);
    }
    return c->direction > 0 ? moved : bench_now.first[k] - w->held[c->first_set];
}

TEST(contact_places, contacts_off_slipping_or_breaking_loose) {
    uint64_t seed = 144;
    unsigned seen[3] = {0};
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_work was;
        wh_contact_state from;
        wh_contact_state to;
        uint8_t member[BENCH_CONTACTS];
        uint8_t wanted[BENCH_CONTACTS];
        const wh_contact_system *of = &bench_now.system;
        draw(&seed, true, &w);
        bench_state(&seed, &from);
        bench_state(&seed, &to);
        const unsigned but = draw_one_of(&seed, 16U);
        unsigned stuck = 0;
        unsigned breaking = 0;
        unsigned count = 0;
        for (unsigned k = 0; k < of->forced; k++) {
            const bool friction = bench_now.contact[k].kind == WH_FRICTION;
            stuck |= friction && bench_keeps(&w, k) ? 1U << k : 0U;
            if (friction && bench_keeps(&w, k) && WH_ABS(w.force[k]) > bench_now.first[k]) {
                breaking |= 1U << k;
            }
            if ((but >> k & 1U) == 0 && bench_keeps(&w, k)) {
                wanted[count++] = (uint8_t)k;
            }
            TEST_ASSERT_TRUE(wh_contact_slips(of, &w, k) == slips(&w, k));
            const wh_contact_state *begin = draw_one_in(&seed, 2) ? &from : NULL;
            TEST_ASSERT_TRUE(bench_near(wh_contact_drift(of, &w, k, bench_now.signal, begin, &to),
                                        drift_of(&w, k, begin, &to)));
            seen[0] += slips(&w, k);
        }
        TEST_ASSERT_EQUAL_UINT(stuck, wh_contact_stuck(of, &w));
        TEST_ASSERT_EQUAL_UINT(breaking, wh_contact_breaking(of, &w));
        TEST_ASSERT_EQUAL_UINT(count, wh_contact_members(of, &w, but, member));
        for (unsigned i = 0; i < count; i++) {
            TEST_ASSERT_EQUAL_UINT(wanted[i], member[i]);
        }
        seen[1] += breaking != 0;
        seen[2] += stuck != breaking;
        was = w;
        const unsigned one = draw_one_of(&seed, of->forced);
        wh_contact_capture(of, &w, one);
        for (unsigned place = 0; place < BENCH_CONTACTS; place++) {
            /* index of the hold among the captured values */
            const wh_contact *c = &bench_now.contact[one];
            const bool its = slips(&w, one) && c->first_set == place;
            const wh_real kept = c->direction > 0 ? WH_R(0.0) : bench_now.first[one];
            TEST_ASSERT_TRUE(w.held[place] == (its ? kept : was.held[place]));
        }
        w = was;
        wh_contact_keep(of, &w, &from, &to);
        for (unsigned k = 0; k < of->forced; k++) {
            const wh_contact *c = &bench_now.contact[k];
            if (slips(&w, k)) { /* the hold's slip so far */
                const wh_real kept =
                    c->direction > 0 ? drift_of(&was, k, &from, &to) : was.held[c->first_set];
                TEST_ASSERT_TRUE(bench_near(w.held[c->first_set], kept));
            }
        }
        TEST_ASSERT_TRUE(w.held[BENCH_CONTACTS - 1] == was.held[BENCH_CONTACTS - 1]);
    }
    TEST_ASSERT_TRUE(seen[0] > ROUNDS / 16 && seen[1] > ROUNDS / 16 && seen[2] > ROUNDS / 16);
}

/* wh_contact_far(): a stop counts as far passed if its error exceeds a share of the gap's terms. A term is an entry
 * of the row times the position of a coordinate, or, for an angle, times one radian. */
TEST(contact_places, how_far_a_stop_is_passed) {
    uint64_t seed = 145;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state s;
        draw(&seed, true, &w);
        bench_state(&seed, &s);
        const unsigned k = draw_one_of(&seed, bench_now.system.forced);
        wh_real size = WH_R(0.0);
        for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
            const unsigned angles = bench_now.system.angles;
            size +=
                WH_ABS(bench_now.row[k][i]) * (i < angles ? WH_R(1.0) : WH_ABS(s.real[i - angles]));
        }
        TEST_ASSERT_TRUE(wh_contact_extent(&bench_now.system, &w, k, &s) == size);
        for (unsigned part = 0; part < 4; part++) {
            static const wh_real parts[] = {-3, WH_R(-1.01), WH_R(-0.99), 2};
            wh_real signal[2 * BENCH_CONTACTS];
            for (unsigned i = 0; i < 2 * BENCH_CONTACTS; i++) {
                signal[i] = i == 2 * k ? WH_R(0.0) : part < 2 ? WH_R(1.0) : WH_R(-1.0);
            }
            signal[2 * k] = parts[part] * (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-5)) * size;
            TEST_ASSERT_TRUE(wh_contact_far(&bench_now.system, &w, k, signal, &s) ==
                             (part < 2 && size > WH_R(0.0)));
        }
    }
}

/* The end of a step is copied to the state completely, and nothing beyond it changes. Copied back, it is the same. */
TEST(contact_places, step_is_stored_and_restored) {
    uint64_t seed = 146;
    for (unsigned round = 0; round < ROUNDS / 4; round++) {
        wh_contact_work w;
        wh_contact_state now;
        wh_contact_state then;
        wh_angle angle[WH_COORDS];
        wh_real real[2 * WH_COORDS];
        wh_real carry[2 * WH_COORDS];
        wh_real held[BENCH_CONTACTS];
        wh_state state = {.angle = angle, .real = real, .carry = carry, .held = held};
        draw(&seed, true, &w);
        wh_contact_system *of = &bench_now.system;
        const unsigned reals = 2U * of->coordinates - of->angles;
        of->compensated = draw_one_in(&seed, 2);
        of->held = (uint8_t)draw_one_of(&seed, BENCH_CONTACTS);
        bench_state(&seed, &now);
        for (unsigned i = 0; i < 2U * WH_COORDS; i++) {
            now.carry[i] = draw_broken(&seed, 1, 4);
            real[i] = carry[i] = BENCH_SENTINEL;
            angle[i % WH_COORDS] = 0;
            held[i % BENCH_CONTACTS] = BENCH_SENTINEL;
        }
        wh_contact_commit(of, &w, &now, &state);
        then = (wh_contact_state){.real = {WH_R(0.0)}};
        wh_contact_copy(of, angle, real, carry, &then);
        for (unsigned i = 0; i < WH_COORDS; i++) {
            TEST_ASSERT_TRUE(angle[i] == (i < of->angles ? now.angle[i] : 0));
            TEST_ASSERT_TRUE(i >= of->angles || then.angle[i] == now.angle[i]);
        }
        for (unsigned i = 0; i < 2U * WH_COORDS; i++) {
            TEST_ASSERT_TRUE(real[i] == (i < reals ? now.real[i] : BENCH_SENTINEL));
            TEST_ASSERT_TRUE(then.real[i] == (i < reals ? now.real[i] : WH_R(0.0)));
            const bool carried = of->compensated && i < of->angles + reals;
            TEST_ASSERT_TRUE(carry[i] == (carried ? now.carry[i] : BENCH_SENTINEL));
            TEST_ASSERT_TRUE(then.carry[i] == (carried ? now.carry[i] : WH_R(0.0)));
        }
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            TEST_ASSERT_TRUE(held[k] == (k < of->held ? w.held[k] : BENCH_SENTINEL));
        }
    }
}
