/* test_contact_impact.c: the conditions of an impact, function by function (core/contact/contact_impact.h): a stop
 * is pressed, is at rest, touches, or is hit in the same moment. The drawn numbers are just on either side of each
 * limit. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 3000 : 60 };

/* Draws a number just below 1 (*within is then true) or just above 1. */
static wh_real beside_one(uint64_t *seed, bool *within) {
    *within = draw_one_in(seed, 2);
    return *within ? WH_R(0.9375) : WH_R(1.0625);
}

static wh_real terms_of(unsigned k, const wh_real *x) {
    wh_real size = WH_R(0.0);
    for (unsigned i = 0; i < bench_now.system.coordinates; i++) {
        size += WH_ABS(bench_now.row[k][i] * x[i]);
    }
    return size;
}

static bool is_stop(unsigned k) { return bench_now.contact[k].kind == WH_STOP; }

/* An acceleration onto the stop within the round-off of its terms counts as zero. If the stop is the only contact, any
 * acceleration counts. */
TEST(contact_impact, pressed_stops) {
    uint64_t seed = 301;
    unsigned pressed = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_real accel[WH_COORDS];
        bool within;
        bench_draw(&seed, true);
        bench_vector(&seed, accel);
        const unsigned forced = bench_now.system.forced;
        const unsigned k = draw_one_of(&seed, forced);
        const wh_real size = terms_of(k, accel);
        const wh_real share = beside_one(&seed, &within);
        const wh_real way = draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(-1.0);
        const bool far = draw_one_in(&seed, 3);
        const wh_real along = bench_along(k, accel);
        const wh_real limit = WH_CONTACT_ROUNDING * (size + WH_ABS(along));
        bench_now.bias[k] = -along + (far ? way : way * share * limit);
        bench_work(&seed, true, &w);
        TEST_ASSERT_TRUE(wh_contact_terms(&bench_now.system, &w, k, accel) == size);
        const wh_real found = wh_contact_pressing(&bench_now.system, &w, k, accel);
        const wh_real wanted = -(along + bench_now.bias[k]);
        const bool none = forced > 1 && !far && within;
        TEST_ASSERT_TRUE(found == (none ? WH_R(0.0) : wanted));
        pressed += found != WH_R(0.0);
    }
    TEST_ASSERT_TRUE(pressed > ROUNDS / 3 && pressed < ROUNDS);
}

/* A flight shorter than WH_REST_SHARE of the step counts as rest. If nothing presses the body onto the stop, the body
 * rests only if its rate counts as zero. */
TEST(contact_impact, resting_stops) {
    uint64_t seed = 302;
    unsigned resting = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_real accel[WH_COORDS];
        wh_real rate[WH_COORDS];
        bool within;
        bench_draw(&seed, true);
        bench_vector(&seed, accel);
        bench_vector(&seed, rate);
        const unsigned k = draw_one_of(&seed, bench_now.system.forced);
        const wh_real share = beside_one(&seed, &within);
        const wh_real pressing = draw_whole(&seed, -1, 2);
        bench_now.bias[k] = -bench_along(k, accel) - pressing;
        bench_work(&seed, true, &w);
        const wh_contact_moment m = {0, 0, draw_whole(&seed, 1, 4), draw_one_in(&seed, 4)};
        const wh_real limit = pressing > WH_R(0.0) ? pressing * m.h * WH_REST_SHARE / 2
                              : bench_now.system.forced > 1
                                  ? WH_CONTACT_ROUNDING * terms_of(k, rate)
                                  : WH_R(0.0);
        const wh_real speed = limit * share;
        const bool still = limit == WH_R(0.0) || within;
        const bool wanted = pressing == WH_R(0.0)  ? still
                            : pressing > WH_R(0.0) ? m.last || within
                                                   : false;
        TEST_ASSERT_TRUE(wh_contact_rests(&bench_now.system, &w, k, &m, speed, accel, rate) ==
                         wanted);
        TEST_ASSERT_TRUE(pressing != WH_R(0.0) || /* a single stop: any acceleration counts */
                         !wh_contact_rests(&bench_now.system, &w, k, &m, 64, accel, rate));
        resting += wanted;
    }
    TEST_ASSERT_TRUE(resting > ROUNDS / 4 && resting < ROUNDS / 4 * 3);
}

/* Stops that merely touch: they are at rest, have a restitution, and their force is zero relative to the accelerations
 * and the other forces. */
TEST(contact_impact, stops_that_touch_without_force) {
    uint64_t seed = 303;
    unsigned loose = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_real accel[WH_COORDS];
        bool within;
        bench_draw(&seed, true);
        bench_vector(&seed, accel);
        const unsigned forced = bench_now.system.forced;
        const unsigned k = draw_one_of(&seed, forced);
        const bool bounces = draw_one_in(&seed, 2);
        bench_now.first[k] = bounces ? WH_R(0.5) : WH_R(0.0);
        bench_work(&seed, true, &w);
        const wh_real share = beside_one(&seed, &within);
        wh_real size = terms_of(k, accel);
        for (unsigned l = 0; l < forced; l++) {
            size += l != k ? WH_ABS(bench_delassus(k, l) * w.force[l]) : WH_R(0.0);
        }
        const bool pulls = draw_one_in(&seed, 4);
        w.force[k] = pulls ? WH_R(-1.0) : WH_CONTACT_ROUNDING * size * share / bench_delassus(k, k);
        const unsigned resting = draw_one_of(&seed, 1U << forced);
        const unsigned found = wh_contact_loose(&bench_now.system, &w, resting, accel);
        const bool wanted = forced > 1 && bounces && (resting >> k & 1U) != 0 &&
                            (pulls || within || size == WH_R(0.0));
        TEST_ASSERT_EQUAL_UINT(wanted, found >> k & 1U);
        TEST_ASSERT_EQUAL_UINT(0, found & ~resting);
        loose += wanted;
    }
    TEST_ASSERT_TRUE(loose > ROUNDS / 32);
}

/* A free stop is hit in the same moment if the body approaches, and the gap is smaller than the error of location. */
TEST(contact_impact, stops_hit_at_the_same_time) {
    uint64_t seed = 304;
    unsigned tied = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state s;
        bool within;
        bench_draw(&seed, true);
        bench_state(&seed, &s);
        const unsigned forced = bench_now.system.forced;
        const unsigned k = draw_one_of(&seed, forced);
        wh_real signal[2 * BENCH_CONTACTS];
        bench_work(&seed, true, &w);
        for (unsigned i = 0; i < 2 * BENCH_CONTACTS; i++) {
            signal[i] = draw_whole(&seed, 1, 4); /* the stop is open and opens further */
        }
        const wh_real h = draw_whole(&seed, 0, 4);
        const wh_real *rate = wh_contact_rates(&bench_now.system, &s);
        const wh_real least = WH_CONTACT_ROUNDING * terms_of(k, rate);
        const bool slow = draw_one_in(&seed, 3);
        const wh_real share = beside_one(&seed, &within);
        signal[2 * k + 1] = slow ? -least * share : WH_R(-8.0);
        const bool closes = slow ? least > WH_R(0.0) && !within : true;
        const wh_real extent = wh_contact_extent(&bench_now.system, &w, k, &s);
        const wh_real way = -signal[2 * k + 1] * (h * WH_BRACKET_FINE) + WH_CONTACT_TIE * extent;
        const bool near = draw_one_in(&seed, 2);
        signal[2 * k] = way * (near ? WH_R(0.875) : WH_R(1.125));
        const bool touched = near || way == WH_R(0.0);
        const bool wanted = forced > 1 && is_stop(k) && w.mode[k] == WH_FREE && closes && touched;
        TEST_ASSERT_EQUAL_UINT(wanted ? 1U << k : 0U,
                               wh_contact_tied(&bench_now.system, &w, h, signal, &s));
        tied += wanted;
    }
    TEST_ASSERT_TRUE(tied > ROUNDS / 32);
}

/* An impact is passed on to a free stop that touches, if it makes the body approach, or approach more than twice as
 * fast. */
TEST(contact_impact, impacts_are_passed_on) {
    uint64_t seed = 305;
    unsigned passed = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_real before[2 * BENCH_CONTACTS];
        wh_real after[2 * BENCH_CONTACTS];
        unsigned wanted = draw_one_in(&seed, 2) ? 1U : 0U; /* stops that are already in hit_next */
        bench_draw(&seed, true);
        bench_work(&seed, true, &w);
        w.hit_next = wanted;
        const unsigned hits = draw_one_of(&seed, 16U);
        const wh_real h = draw_whole(&seed, 1, 2);
        for (unsigned k = 0; k < BENCH_CONTACTS; k++) {
            before[2 * k] = after[2 * k] = WH_R(0.0);
            before[2 * k + 1] = draw_whole(&seed, -2, 2);
            after[2 * k + 1] = draw_whole(&seed, -5, 1);
            const wh_real speed = after[2 * k + 1];
            const bool near = draw_one_in(&seed, 2);
            after[2 * k] = WH_ABS(speed) * h * WH_BRACKET * (near ? 1 : WH_R(1.0625));
            const bool asked = bench_now.system.forced > 1 && k < bench_now.system.forced &&
                               is_stop(k) && w.mode[k] == WH_FREE && (hits >> k & 1U) == 0;
            const bool closes = speed < WH_R(0.0) && speed < 2 * before[2 * k + 1];
            wanted |= asked && closes && near ? 1U << k : 0U;
        }
        passed += wanted != w.hit_next;
        wh_contact_passed_on(&bench_now.system, &w, hits, h, before, after);
        TEST_ASSERT_EQUAL_UINT(wanted, w.hit_next);
    }
    TEST_ASSERT_TRUE(passed > ROUNDS / 64);
}

/* Stops that take part in an impact although they are not hit: they are free, have no restitution, touch, and are at
 * rest relative to the rate that the hit causes. */
TEST(contact_impact, touching_stops_join_an_impact) {
    uint64_t seed = 306;
    unsigned beside = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_real was[BENCH_CONTACTS];
        wh_real target[BENCH_CONTACTS];
        wh_real signal[2 * BENCH_CONTACTS];
        wh_real rate[WH_COORDS];
        bool still;
        bool touched;
        bench_draw(&seed, true);
        const unsigned forced = bench_now.system.forced;
        const unsigned n = bench_now.system.coordinates;
        const unsigned l = draw_one_of(&seed, forced);
        const unsigned k = draw_one_of(&seed, forced);
        const bool bounces = draw_one_in(&seed, 4);
        bench_now.first[l] = bounces ? WH_R(0.5) : WH_R(0.0);
        bench_work(&seed, true, &w);
        for (unsigned i = 0; i < BENCH_CONTACTS; i++) {
            was[i] = draw_whole(&seed, -4, 0);
            target[i] = draw_whole(&seed, 0, 4);
            signal[2 * i] = signal[2 * i + 1] = BENCH_SENTINEL; /* only stop l may touch */
        }
        const wh_real passed_on =
            WH_ABS(bench_delassus(l, k) * (target[k] - was[k])) / bench_delassus(k, k);
        const wh_real h = draw_whole(&seed, 1, 2);
        signal[2 * l] = passed_on * (h * WH_BRACKET) * beside_one(&seed, &touched);
        const wh_real share = beside_one(&seed, &still);
        bench_vector(&seed, rate);
        for (unsigned i = 0; i < n; i++) { /* gives contact l a rate of `share` times the limit */
            const wh_real size = bench_delassus(l, l);
            rate[i] = bench_way(l, i) / size * (WH_CONTACT_STILL * passed_on * share);
        }
        const unsigned found =
            wh_contact_beside(&bench_now.system, &w, 1U << k, h, was, target, signal, rate);
        const bool wanted = forced > 1 && k != l && is_stop(l) && w.mode[l] == WH_FREE &&
                            !bounces && passed_on > WH_R(0.0) && touched && still;
        TEST_ASSERT_EQUAL_UINT(wanted ? 1U << l : 0U, found);
        beside += wanted;
    }
    TEST_ASSERT_TRUE(beside > ROUNDS / 128);
}

TEST(contact_impact, a_restitution) {
    uint64_t seed = 307;
    for (unsigned round = 0; round < ROUNDS / 4; round++) {
        wh_contact_work w;
        bench_draw(&seed, true);
        const unsigned k = draw_one_of(&seed, bench_now.system.forced);
        const wh_real given = draw_whole(&seed, -4, 12) / 8;
        const wh_real zero = WH_R(0.0) * bench_now.free[0];
        const bool number = !draw_one_in(&seed, 4);
        bench_now.first[k] = number ? given : zero / zero;
        bench_work(&seed, true, &w);
        const wh_real found = wh_contact_restitution(&bench_now.system, &w, k);
        const wh_real wanted = given < WH_R(0.0)   ? WH_R(0.0)
                               : given > WH_R(1.0) ? WH_R(1.0)
                                                   : given;
        TEST_ASSERT_TRUE(!number || found == wanted);
        TEST_ASSERT_EQUAL_INT(number ? -1 : (int)k, w.undefined);
    }
}

/* Newton's method projects a body onto a curved surface in a limited number of steps. After the last evaluation the
 * body does not move. */
TEST(contact_impact, a_squeeze_ends) {
    uint64_t seed = 308;
    for (unsigned round = 0; round < ROUNDS / 4; round++) {
        wh_contact_work w;
        wh_contact_state s;
        const wh_real h = draw_whole(&seed, 1, 8) / 4;
        wh_real x = draw_whole(&seed, 1, 4);
        bench_build(&seed, 1, 0);
        (void)bench_add(&seed, WH_STOP, -1);
        bench_state(&seed, &s);
        s.real[0] = x;
        bench_now.row[0][0] = WH_R(0.0);
        /* The gap is h - x^2/2. No real number of the build is its root. */
        bench_now.signal[0] = h;
        bench_work(&seed, false, &w);
        w.mode[0] = WH_FREE;
        bench_now.moves = true;
        bench_now.lean[0] = WH_R(-1.0);
        const unsigned looks = bench_now.looks;
        unsigned wanted = 0;
        for (bool beyond = true; beyond && wanted < WH_SQUEEZE_LOOKS;) {
            const wh_real gap = h - x * x / 2;
            wanted++;
            beyond = gap < WH_R(0.0);
            x += beyond && wanted < WH_SQUEEZE_LOOKS ? gap / x : WH_R(0.0);
        }
        wh_contact_squeeze(&bench_now.system, &w, NULL, &s);
        TEST_ASSERT_TRUE(bench_near(s.real[0], x));
        TEST_ASSERT_EQUAL_UINT(wanted, bench_now.looks - looks);
    }
}

/* A body is beyond a surface that curves away from it. The first projection moves it too far, and the next ones bring
 * it back to the surface. */
TEST(contact_impact, projection_beyond_the_surface_is_corrected) {
    uint64_t seed = 309;
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state s;
        wh_real signal[2 * WH_CONTACTS_MAX];
        unsigned pushed;
        const wh_real radius = draw_whole(&seed, 1, 8) / 4;
        const wh_real side = draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(-1.0);
        const wh_real depth = draw_whole(&seed, 2, 98) / 100;
        bench_build(&seed, 1, 0);
        (void)bench_add(&seed, WH_STOP, -1);
        bench_state(&seed, &s);
        s.real[0] = side * radius * depth;
        bench_now.row[0][0] = WH_R(0.0);
        bench_now.signal[0] = -radius * radius / 2; /* the gap is x^2/2 - radius^2/2 */
        bench_work(&seed, false, &w);
        w.mode[0] = WH_FREE;
        bench_now.moves = true;
        bench_now.lean[0] = WH_R(1.0);
        const unsigned looks = bench_now.looks;
        TEST_ASSERT_TRUE(
            wh_contact_push_out(&bench_now.system, &w, true, NULL, &s, signal, &pushed) == 1U);
        TEST_ASSERT_TRUE(WH_ABS(s.real[0] * side - radius) <= 2 * WH_CONTACT_FAR * radius);
        TEST_ASSERT_TRUE(bench_now.looks - looks <= WH_PUSH_LOOKS);
    }
}
