/* test_contact_project.c: projection of positions onto the constraints (core/contact/contact_project.h). The
 * reference is a dense solve in the mass metric. The ledger gets the energy. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 3000 : 60 };

/* Draws contacts of some kinds in some modes; the holds are curved. */
static void draw(uint64_t *seed, bool some, wh_contact_work *w, wh_ledger_work *books) {
    bench_draw(seed, true);
    for (unsigned k = 0; k < bench_now.system.forced; k++) {
        wh_contact *c = &bench_now.contact[k];
        if (c->kind == WH_HOLD) {
            c->first_set = c->pin < 0 ? bench_now.system.held++ : BENCH_CONTACTS - 1;
        }
        bench_now.signal[2 * k] *= draw_one_in(seed, 3) ? WH_R(0.0) : WH_R(0.03125);
        bench_now.first[k] /= 32; /* each angle moves by less than half a turn */
    }
    bench_work(seed, some, w);
    w->books = draw_one_in(seed, 2) ? books : NULL;
    *books = (wh_ledger_work){.span = WH_R(0.0)};
    for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
        w->held[k] = draw_whole(seed, 1, 4) / 32;
    }
}

/* Returns the error of contact k's constraint: a stop's gap, or a curved hold's slip. Otherwise 0. */
static wh_real off_of(const wh_contact_work *w, unsigned k) {
    const wh_contact *c = &bench_now.contact[k];
    const wh_real slipped = c->pin < 0 ? bench_now.first[k] - w->held[c->first_set] : WH_R(0.0);
    return c->kind == WH_STOP ? bench_now.signal[2 * k] : c->kind == WH_HOLD ? slipped : WH_R(0.0);
}

static unsigned members_of(const wh_contact_work *w, unsigned but, uint8_t *member) {
    unsigned count = 0;
    for (unsigned k = 0; k < bench_now.system.forced; k++) {
        if ((but >> k & 1U) == 0 && bench_keeps(w, k)) {
            member[count++] = (uint8_t)k;
        }
    }
    return count;
}

/* Does x += M^-1 J^T lambda. lambda solves the members' equations for `wanted`; a pinned contact gets nothing. */
static void add_least(const uint8_t *member, unsigned count, const wh_real *wanted, wh_real *lambda,
                      wh_real *x) {
    bench_solve(member, count, bench_repeats(member, count, NULL), wanted, lambda);
    for (unsigned c = 0; c < bench_now.system.coordinates; c++) {
        for (unsigned i = 0; i < count && !bench_pins(member, count, c); i++) {
            x[c] += bench_way(member[i], c) * lambda[i];
        }
    }
}

/* Moves the coordinate of each pinned contact to the constraint, if the contact is the first on this coordinate, or is
 * still beyond the constraint. */
static void go_back(const uint8_t *member, unsigned count, const wh_real *off, wh_real *way) {
    bool first[BENCH_COORDS];
    for (unsigned c = 0; c < BENCH_COORDS; c++) {
        first[c] = true;
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = bench_now.contact[member[i]].pin;
        if (pin < 0 || off[i] == WH_R(0.0)) {
            continue;
        }
        const wh_real row = bench_now.row[member[i]][pin];
        const wh_real left = off[i] + row * way[pin];
        way[pin] -= first[pin] || left < WH_R(0.0) ? left / row : WH_R(0.0);
        first[pin] = false;
    }
}

/* Pinned contacts move their coordinate directly. Then the pinned coordinates stay, and the other contacts are
 * projected together by the smallest move in the mass metric. A second projection is requested if the error exceeds its
 * share of the motion. */
TEST(contact_project, projection_is_the_shortest) {
    uint64_t seed = 161;
    unsigned coarse = 0;
    unsigned moves = 0;
    for (unsigned round = 0; round < 2U * ROUNDS; round++) {
        wh_contact_work w;
        wh_ledger_work books;
        wh_contact_state s;
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real off[BENCH_CONTACTS];
        wh_real way[WH_COORDS] = {WH_R(0.0)};
        wh_real input = WH_R(0.0);
        draw(&seed, true, &w, &books);
        bench_state(&seed, &s);
        const wh_contact_state was = s;
        const wh_contact_system *of = &bench_now.system;
        const unsigned n = of->coordinates;
        const wh_real *rate = wh_contact_rates(of, &s);
        wh_contact_place spot = {NULL, WH_R(0.0), 0, WH_CONTACTS_MAX};
        spot.but = draw_one_in(&seed, 2) ? 0U : draw_one_of(&seed, 16U);
        spot.mover = draw_one_in(&seed, 3) ? draw_one_of(&seed, of->forced) : spot.mover;
        const unsigned count = members_of(&w, spot.but, member);
        const unsigned asked =
            (unsigned)draw_bits(&seed) % (count + 1U); /* contact with an error near its limit */
        spot.h = draw_whole(&seed, 0, 4) / WH_SLIP_COARSE;
        for (unsigned i = 0; i < count; i++) {
            const wh_real size = WH_ABS(off_of(&w, member[i]));
            wh_real travel = WH_R(0.0);
            for (unsigned c = 0; c < n; c++) {
                travel += WH_ABS(bench_now.row[member[i]][c] * rate[c]);
            }
            if (i == asked && travel > WH_R(0.0)) {
                spot.h = size / (WH_SLIP_COARSE * travel) *
                         (draw_one_in(&seed, 2) ? WH_R(0.99) : WH_R(1.01));
            }
        }
        unsigned mover = spot.mover;
        bool more = false;
        bool together = false;
        for (unsigned i = 0; i < count; i++) {
            off[i] = off_of(&w, member[i]);
            mover = off[i] != WH_R(0.0) && mover == WH_CONTACTS_MAX ? member[i] : mover;
        }
        go_back(member, count, off, way);
        for (unsigned i = 0; i < count; i++) {
            const wh_real *row = bench_now.row[member[i]];
            wh_real travel = WH_R(0.0);
            wanted[i] = bench_now.contact[member[i]].pin < 0 ? -off[i] : WH_R(0.0);
            for (unsigned c = 0; c < n; c++) {
                travel += WH_ABS(row[c] * rate[c]);
                wanted[i] -= bench_now.contact[member[i]].pin < 0 ? row[c] * way[c] : WH_R(0.0);
            }
            together = together || wanted[i] != WH_R(0.0);
            more = more || WH_ABS(wanted[i]) > WH_SLIP_COARSE * spot.h * travel;
        }
        add_least(member, count, wanted, lambda, way);
        TEST_ASSERT_TRUE(wh_contact_project_places(of, &w, &spot, bench_now.signal, &input, &s) ==
                         (together && more));
        for (unsigned i = 0; i < n; i++) {
            TEST_ASSERT_TRUE(bench_near(bench_moved(&was, &s, i), way[i]));
            TEST_ASSERT_TRUE(rate[i] == wh_contact_rates(of, &s)[i]);
        }
        TEST_ASSERT_TRUE(w.undefined == -1);
        for (unsigned e = 0; e < of->ledger->entries;
             e++) { /* the first contact with an error gets the energy */
            const bool its = w.books != NULL && e == wh_ledger_of_contact(of->ledger, mover);
            const bool line = of->angles < n;
            TEST_ASSERT_TRUE(bench_near(books.step[e], its && line && mover < WH_CONTACTS_MAX
                                                           ? way[of->angles]
                                                           : WH_R(0.0)));
        }
        coarse += together && more;
        moves += together && !more;
    }
    TEST_ASSERT_TRUE(coarse > ROUNDS / 8 && moves > ROUNDS / 8);
}

/* The first contact whose error is NaN is reported, and the others are corrected without it. */
TEST(contact_project, first_nan_error_is_reported) {
    uint64_t seed = 162;
    unsigned told = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_ledger_work books;
        wh_contact_state s;
        uint8_t member[BENCH_CONTACTS] = {0};
        wh_real wanted[BENCH_CONTACTS];
        wh_real lambda[BENCH_CONTACTS];
        wh_real off[BENCH_CONTACTS];
        wh_real way[WH_COORDS] = {WH_R(0.0)};
        int undefined = -1;
        draw(&seed, true, &w, &books);
        w.books = NULL;
        bench_state(&seed, &s);
        const wh_contact_state was = s;
        wh_contact_place spot = {NULL, WH_R(1.0), 0, WH_CONTACTS_MAX};
        const unsigned count = members_of(&w, 0, member);
        const unsigned none = draw_one_of(&seed, 16U);
        for (unsigned k = 0; k < bench_now.system.forced; k++) {
            if ((none >> k & 1U) != 0) {
                const wh_real zero = WH_R(0.0) * bench_now.free[0];
                bench_now.signal[2 * k] = zero / zero;
                bench_now.first[k] =
                    bench_now.contact[k].kind == WH_HOLD ? zero / zero : bench_now.first[k];
            }
        }
        bench_now.system.forces(NULL, NULL, NULL, NULL, NULL, w.law);
        for (unsigned i = 0; i < count; i++) {
            off[i] = off_of(&w, member[i]);
            const bool number = off[i] - off[i] == WH_R(0.0);
            undefined = !number && undefined < 0 ? (int)member[i] : undefined;
            off[i] = number ? off[i] : WH_R(0.0);
        }
        go_back(member, count, off, way);
        for (unsigned i = 0; i < count; i++) {
            const bool pinned = bench_now.contact[member[i]].pin >= 0;
            wanted[i] = pinned ? WH_R(0.0) : -off[i];
            for (unsigned c = 0; c < bench_now.system.coordinates && !pinned; c++) {
                wanted[i] -= bench_now.row[member[i]][c] * way[c];
            }
        }
        add_least(member, count, wanted, lambda, way);
        (void)wh_contact_project_places(&bench_now.system, &w, &spot, bench_now.signal, NULL, &s);
        TEST_ASSERT_EQUAL_INT(undefined, w.undefined);
        for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
            TEST_ASSERT_TRUE(bench_near(bench_moved(&was, &s, i), way[i]));
        }
        told += undefined >= 0;
    }
    TEST_ASSERT_TRUE(told > ROUNDS / 8);
}

/* A stop and a friction act on two coupled bodies. One body is slightly or far beyond the stop. If it is far beyond,
 * the friction does not hold its body. A corrected position is tested again, at most twice. */
TEST(contact_project, slipped_bodies_are_projected) {
    uint64_t seed = 164;
    unsigned far = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from;
        wh_contact_state s;
        wh_real input = WH_R(0.0);
        bench_build(&seed, 2, 0);
        const bool friction = draw_one_in(&seed, 2);
        const bool slides = draw_one_in(&seed, 4);
        const bool pinned = draw_one_in(&seed, 4);
        (void)bench_add(&seed, WH_STOP, pinned ? 0 : -1);
        (void)bench_add(&seed, WH_STOP, -1);
        if (friction) {
            (void)bench_add(&seed, WH_FRICTION, 1);
        }
        bench_state(&seed, &from);
        for (unsigned i = 0; i < 2; i++) {
            bench_now.free[i] = WH_R(0.0); /* no load on the friction */
            bench_now.row[0][i] = i == 0 ? WH_R(1.0) : pinned ? WH_R(0.0) : WH_R(2.0);
            from.real[i] = WH_R(1.0);
            bench_now.bias[i] = WH_R(0.0);
        }
        const bool breaks = friction && draw_one_in(&seed, 4);
        bench_now.bias[2] =
            breaks ? 2 * bench_now.first[2] * bench_now.inverse[1][1] + 64 : WH_R(0.0);
        bench_work(&seed, false, &w);
        w.mode[1] = WH_FREE;
        w.mode[2] = slides ? 1 : WH_STUCK;
        const wh_real size =
            WH_DOUBLE ? WH_R(0x1p-29) : WH_R(0x1p-16); /* an error of half this size is far */
        const wh_real off =
            draw_whole(&seed, -3, 3) * size * (draw_one_in(&seed, 2) ? 1 : WH_R(0.125));
        for (unsigned k = 0; k < 2; k++) {
            bench_now.signal[2 * k] = -bench_along(k, from.real) + (k == 0 ? off : -64);
            bench_now.signal[2 * k + 1] = WH_R(0.0);
        }
        bench_now.moves = true;
        s = from;
        const wh_real terms = pinned ? WH_R(1.0) : WH_R(3.0);
        const bool passed = off < -terms * (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-5));
        const bool sticks = friction && !slides && !passed && !breaks;
        const unsigned looks = bench_now.looks;
        const wh_real h = draw_one_in(&seed, 2) ? WH_R(0.0) : WH_R(1.0);
        const bool still = h * (WH_ABS(from.real[2]) + WH_ABS(from.real[3])) == WH_R(0.0);
        wh_contact_stabilise(&bench_now.system, &w, h, &input, &from, &s);
        if (pinned) { /* a pinned contact cannot slip, so it is not tested */
            TEST_ASSERT_TRUE(bench_now.looks == looks && s.real[0] == from.real[0]);
            continue;
        }
        const wh_real way = -off;
        const wh_real yield = bench_delassus(0, 0);
        for (unsigned i = 0; i < 2; i++) {
            const wh_real least = bench_way(0, i) / yield * way;
            const wh_real right = !sticks ? least : i == 0 ? way : WH_R(0.0);
            const wh_real moved = s.real[i] - from.real[i];
            TEST_ASSERT_TRUE(WH_ABS(moved - right) <= (WH_DOUBLE ? WH_R(1e-14) : WH_R(1e-6)));
        }
        TEST_ASSERT_TRUE(!sticks || (s.real[1] == from.real[1] && s.real[3] == WH_R(0.0)));
        const wh_real speed = bench_along(0, from.real + 2);
        for (unsigned i = 0; i < 2;
             i++) { /* the rates are zero, too; a contact that breaks loose keeps its rate */
            const wh_real free = from.real[2 + i] - bench_way(0, i) / yield * speed;
            const wh_real right = sticks ? WH_R(0.0) : free;
            TEST_ASSERT_TRUE(WH_ABS(s.real[2 + i] - right) <=
                             (WH_DOUBLE ? WH_R(1e-13) : WH_R(2e-5)));
        }
        TEST_ASSERT_TRUE(bench_now.looks - looks <= 3U);
        TEST_ASSERT_TRUE((still && off != WH_R(0.0)) == (bench_now.looks - looks > 1U));
        far += passed && friction && !slides;
    }
    TEST_ASSERT_TRUE(far > ROUNDS / 40);
}

/* A body is projected onto a stop with a curved surface. If the distance was large, it is projected a second time, but
 * never a third time. */
TEST(contact_project, curved_stops_are_projected_twice) {
    uint64_t seed = 165;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from;
        wh_contact_state s;
        wh_real input = WH_R(0.0);
        wh_real x[2];
        bench_build(&seed, 2, 0);
        (void)bench_add(&seed, WH_STOP, -1);
        bench_state(&seed, &from);
        for (unsigned i = 0; i < 2; i++) {
            from.real[i] = WH_R(0.0);
            from.real[2 + i] = WH_R(1.0);
            x[i] = WH_R(0.0);
        }
        const wh_real straight = draw_whole(&seed, 1, 2);
        bench_now.row[0][0] = straight;
        bench_now.row[0][1] = draw_whole(&seed, 0, 2);
        bench_now.signal[0] = draw_whole(&seed, 1, 4) / (draw_one_in(&seed, 2) ? -16 : 16);
        bench_now.signal[1] = WH_R(0.0);
        bench_work(&seed, false, &w);
        bench_now.moves = true;
        bench_now.lean[0] = draw_one_in(&seed, 2) ? WH_R(0.5) : WH_R(-0.5);
        const bool slow = draw_one_in(&seed, 2); /* the body has not moved */
        const unsigned passes = slow ? 2U : 1U;
        const unsigned looks = bench_now.looks;
        s = from;
        wh_contact_stabilise(&bench_now.system, &w, slow ? WH_R(0.0) : WH_R(0x1p40), &input, &from,
                             &s);
        for (unsigned pass = 0; pass < passes; pass++) {
            const wh_real bent = bench_now.lean[0] / 2 * x[0] * x[0];
            const wh_real gap = bench_now.signal[0] + bench_along(0, x) + bent;
            bench_now.row[0][0] = straight + bench_now.lean[0] * x[0];
            const wh_real push = -gap / bench_delassus(0, 0);
            x[0] += bench_way(0, 0) * push;
            x[1] += bench_way(0, 1) * push;
            bench_now.row[0][0] = straight;
        }
        TEST_ASSERT_TRUE(bench_near(s.real[0], x[0]) && bench_near(s.real[1], x[1]));
        /* the surface may be flat in the direction of the motion */
        TEST_ASSERT_EQUAL_UINT(!slow ? 1U : x[0] != WH_R(0.0) ? 3U : 2U, bench_now.looks - looks);
    }
}
