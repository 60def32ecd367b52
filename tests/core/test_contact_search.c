/* test_contact_search.c: the search of core/contact/contact_locate.h. Bodies on parabolas have events of every kind at
 * times known in closed form. The search must find the earliest event, within a number of evaluations. */
#include "bench.h"

#include "tests/suites.h"

enum { ROUNDS = __STDC_HOSTED__ ? 1500 : 30 };

#define FINE (WH_DOUBLE ? 1e-12 : 2e-5)

/* Draws a number between 0 and 1 in steps of 1/1024, without the ends. */
static wh_real share_of(uint64_t *seed) {
    return (wh_real)(draw_bits(seed) % 1023U + 1U) / WH_R(1024.0);
}

/* Returns the motion of coordinate i after the time t: v t + a t^2/2. Its rate does not change sign. */
static wh_real place_at(const wh_contact_state *from, unsigned i, wh_real t) {
    return t * (from->real[bench_now.system.coordinates + i] + bench_now.free[i] / 2 * t);
}

/* Draws up to three uncoupled coordinates, each with its own motion, forward or backward. */
static void draw_ways(uint64_t *seed, unsigned n, wh_contact_state *from) {
    bench_build(seed, n, 0);
    bench_now.moves = true;
    for (unsigned i = 0; i < n; i++) {
        const wh_real v = (WH_R(0.25) + share_of(seed)) * (draw_one_in(seed, 2) ? 1 : -1);
        bench_now.free[i] = WH_R(0.875) * (2 * share_of(seed) - 1) * v;
        from->real[i] = WH_R(0.0);
        from->real[n + i] = v;
        for (unsigned j = 0; j < n; j++) {
            bench_now.inverse[i][j] = i == j ? WH_R(1.0) : WH_R(0.0);
        }
    }
}

/* Adds a contact that depends on coordinate i alone. */
static unsigned add_along(uint64_t *seed, wh_contact_kind kind, unsigned i, wh_real factor) {
    const unsigned k = bench_add(seed, kind, -1);
    for (unsigned c = 0; c < bench_now.system.coordinates; c++) {
        bench_now.row[k][c] = c == i ? factor : WH_R(0.0);
    }
    bench_now.signal[2 * k] = WH_R(0.0);
    bench_now.signal[2 * k + 1] = WH_R(0.0);
    return k;
}

/* Adds no, one or two stops that are far from any event. Returns their number. */
static unsigned add_far(uint64_t *seed) {
    if (draw_one_in(seed, 2)) {
        return 0;
    }
    const unsigned k = add_along(seed, WH_STOP, 0, WH_R(1.0));
    bench_now.signal[2 * k] = WH_R(1024.0);
    return 1;
}

static void run_out(wh_contact_work *w, const wh_contact_state *from, wh_contact_state *to,
                    wh_margins *m) {
    const unsigned n = bench_now.system.coordinates;
    wh_contact_point at;
    *to = *from;
    for (unsigned i = 0; i < n; i++) {
        to->real[i] = from->real[i] + from->real[n + i] + bench_now.free[i] / 2;
        to->real[n + i] = from->real[n + i] + bench_now.free[i];
    }
    wh_contact_point_of(&bench_now.system, to, &at);
    wh_contact_margins(&bench_now.system, w, &at, NULL, m);
}

static wh_real locate(wh_contact_work *w, wh_contact_state *from, wh_real h, unsigned *events) {
    wh_contact_state to;
    wh_margins m;
    run_out(w, from, &to, &m);
    bench_now.looks = 0;
    return wh_contact_locate(&bench_now.system, w, from, &to, h, NULL, &m, events);
}

/* Statistics of searches: their number, the number that is accurate to round-off, and the evaluations. */
typedef struct tally {
    unsigned searches;
    unsigned fine;
    unsigned looks;
    unsigned most;
} tally;

/* Adds a search to the statistics. Its error `off` must be within its bound. */
static void enter(wh_real off, tally *sum) {
    sum->searches++;
    sum->fine += (double)WH_ABS(off) <= FINE;
    sum->looks += bench_now.looks;
    sum->most = bench_now.looks > sum->most ? bench_now.looks : sum->most;
    TEST_ASSERT_TRUE(WH_ABS(off) <= WH_BRACKET);
}

/* Checks the statistics: the mean number of evaluations (in hundredths), and the maximum `most`. At least 13 of 16
 * searches are accurate, on a board half. */
static void told(const tally *sum, unsigned hundredths, unsigned hundredths_f, unsigned most) {
    const unsigned mean = 100U * sum->looks / sum->searches;
    const unsigned bound = WH_DOUBLE ? hundredths : hundredths_f;
    /* a board makes too few searches for an accurate mean */
    TEST_ASSERT_TRUE(mean <= (__STDC_HOSTED__ ? bound : 2U * bound));
    TEST_ASSERT_TRUE(sum->most <= most && sum->most <= WH_PROBES + 1U);
    TEST_ASSERT_TRUE(sum->fine * 16U >= sum->searches * (__STDC_HOSTED__ ? 13U : 8U));
}

/* Several stops, hold conditions and crossings have random event times; some are zero at the begin and have an event at
 * once. The search returns a time just after the first event, and all events of that moment. After the end of the step
 * there is no event. */
TEST(contact_search, the_first_of_several_is_found) {
    uint64_t seed = 201;
    tally sum = {0, 0, 0, 0};
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from = {.real = {WH_R(0.0)}};
        wh_real when[BENCH_CONTACTS];
        unsigned line[BENCH_CONTACTS];
        wh_real first = WH_R(2.0);
        const unsigned n = 1U + draw_one_of(&seed, BENCH_COORDS);
        const unsigned count = 1U + draw_one_of(&seed, BENCH_FORCED);
        const unsigned stops = (unsigned)draw_bits(&seed) % (count + 1U);
        draw_ways(&seed, n, &from);
        for (unsigned k = 0; k < count; k++) {
            const unsigned i = draw_one_of(&seed, n);
            const wh_real side = from.real[n + i] > WH_R(0.0) ? WH_R(-1.0) : WH_R(1.0);
            const wh_real size = draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(3.0);
            const bool again = k > 0 && draw_one_in(&seed, 8);
            line[k] = again ? line[k - 1] : i;
            when[k] = again                   ? when[k - 1]
                      : draw_one_in(&seed, 6) ? WH_R(0.0)
                                              : WH_R(1.5) * share_of(&seed);
            const wh_real turn = again ? bench_now.row[k - 1][line[k]] : side * size;
            (void)add_along(&seed, k < stops ? WH_STOP : WH_WHEN, line[k], turn);
            bench_now.signal[2 * k] = -turn * place_at(&from, line[k], when[k]);
            bench_now.contact[k].direction = k % 2U == 0 ? 0 : -1;
            first = when[k] < first ? when[k] : first;
        }
        bench_work(&seed, false, &w);
        for (unsigned k = 0; k < count; k++) {
            w.mode[k] = k < stops ? WH_FREE : 1;
        }
        if (first >= WH_R(1.0)) {
            continue;
        }
        unsigned events = 0;
        const wh_real found = locate(&w, &from, WH_R(1.0), &events);
        enter(found - first, &sum);
        TEST_ASSERT_TRUE(found > WH_R(0.0));
        for (unsigned k = 0; k < count; k++) { /* exactly the events of this moment */
            const bool its = (events >> k & 1U) != 0;
            TEST_ASSERT_TRUE(its ? (double)(when[k] - first) <= FINE
                                 : (double)(when[k] - first) >= -FINE);
        }
        TEST_ASSERT_TRUE(events != 0 && events >> count == 0);
    }
    told(&sum, 870, 645, 14);
}

/* A friction that slides against a force comes to rest at the time v/a. It begins with a nonzero rate; or with rate
 * zero, in a mode that ends at once. */
TEST(contact_search, sliding_ends_at_zero_rate) {
    uint64_t seed = 203;
    tally sum = {0, 0, 0, 0};
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from = {.real = {WH_R(0.0)}};
        draw_ways(&seed, 2, &from);
        const unsigned behind = add_far(&seed); /* number of the friction, after the stops */
        (void)bench_add(&seed, WH_FRICTION, 1);
        bench_now.signal[2 * behind] = WH_R(0.0);
        bench_now.moves = true;
        const wh_real when = share_of(&seed);
        const wh_real way = from.real[3] > WH_R(0.0) ? WH_R(1.0) : WH_R(-1.0);
        const bool second = draw_one_in(&seed, 2);
        if (second) { /* adds a crossing before or after the slide's end */
            (void)add_along(&seed, WH_WHEN, 0, WH_R(1.0));
            bench_now.signal[2 * behind + 2] =
                -place_at(&from, 0, when < WH_R(0.5) ? when + WH_R(0.25) : when / 2);
        }
        bench_now.free[1] = -from.real[3] / when;
        bench_work(&seed, false, &w);
        w.mode[0] = WH_FREE;
        w.mode[behind] = way > WH_R(0.0) ? 1 : -1;
        w.mode[behind + 1U] = from.real[2] > WH_R(0.0) ? -1 : 1;
        bench_now.second[behind] = WH_R(0.0);
        bench_now.system.forces(NULL, NULL, NULL, NULL, NULL, w.law);
        unsigned events = 0;
        const wh_real found = locate(&w, &from, WH_R(1.0), &events);
        const bool before = second && when >= WH_R(0.5);
        enter(found - (before ? when / 2 : when), &sum);
        TEST_ASSERT_EQUAL_UINT((before ? 2U : 1U) << behind, events);
    }
    told(&sum, 1025, 740, 25);
}

/* A contact slides from rest, and a force reverses it. Its rate is zero at the begin, which is no event, and zero again
 * at the end, which is one. */
TEST(contact_search, slide_starts_and_ends_at_rest) {
    uint64_t seed = 204;
    tally sum = {0, 0, 0, 0};
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from = {.real = {WH_R(0.0)}};
        wh_contact_state to;
        wh_margins m;
        draw_ways(&seed, 2, &from);
        const unsigned behind = add_far(&seed); /* number of the friction, after the stops */
        (void)bench_add(&seed, WH_FRICTION, 1);
        bench_now.signal[2 * behind] = WH_R(0.0);
        /* a = a0 (1 - 2 t/when), a function of the first coordinate, which moves at a constant rate: v = a0 t (1 -
         * t/when) */
        const wh_real when = WH_R(0.25) + WH_R(0.74) * share_of(&seed);
        const wh_real a0 = draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(-1.0);
        from.real[2] = WH_R(1.0);
        from.real[3] = WH_R(0.0);
        bench_now.free[0] = WH_R(0.0);
        bench_now.free[1] = a0;
        bench_now.ramp[1] = -2 * a0 / when;
        bench_work(&seed, false, &w);
        w.mode[0] = WH_FREE;
        w.mode[behind] = a0 > WH_R(0.0) ? 1 : -1;
        bench_now.second[behind] = WH_R(0.0);
        bench_now.system.forces(NULL, NULL, NULL, NULL, NULL, w.law);
        run_out(&w, &from, &to, &m);
        to.real[3] = a0 * (1 - 1 / when);
        m.value[behind] = -WH_ABS(to.real[3]);
        unsigned events = 0;
        bench_now.looks = 0;
        const wh_real found =
            wh_contact_locate(&bench_now.system, &w, &from, &to, WH_R(1.0), NULL, &m, &events);
        enter(found - when, &sum);
        TEST_ASSERT_EQUAL_UINT(1U << behind, events);
    }
    told(&sum, 1340, 1085, 15);
}

/* A sticking friction slides when its load reaches the limit, and a stop opens when its force reaches zero. If a load
 * is at its limit at the begin, it exceeds the limit at once. */
TEST(contact_search, a_load_meets_its_limit) {
    uint64_t seed = 205;
    tally sum = {0, 0, 0, 0};
    for (unsigned round = 0; round < ROUNDS; round++) {
        wh_contact_work w;
        wh_contact_state from = {.real = {WH_R(0.0)}};
        wh_contact_state to;
        wh_margins m;
        draw_ways(&seed, 2, &from);
        const bool stop = draw_one_in(&seed, 2);
        (void)bench_add(&seed, stop ? WH_STOP : WH_FRICTION, 1);
        const wh_real when = draw_one_in(&seed, 4) ? WH_R(0.0) : share_of(&seed);
        const wh_real row = bench_now.row[0][1];
        const wh_real up = stop || draw_one_in(&seed, 2) ? WH_R(1.0) : WH_R(-1.0);
        /* The contact's force is -free/row. For a stop it falls to zero. For a friction it rises to its limit, in
         * either direction. */
        const wh_real limit = stop ? WH_R(0.0) : up * bench_now.first[0];
        from.real[3] = WH_R(0.0);
        bench_now.bias[0] = WH_R(0.0);
        bench_now.ramp[1] = (stop ? 1 : -up) * row / (from.real[2] > WH_R(0.0) ? 1 : -1);
        bench_now.free[1] = -limit * row - bench_now.ramp[1] * place_at(&from, 0, when);
        bench_work(&seed, false, &w);
        run_out(&w, &from, &to, &m);
        to.real[1] = WH_R(0.0);
        to.real[3] = WH_R(0.0);
        wh_contact_point at;
        wh_contact_point_of(&bench_now.system, &to, &at);
        wh_contact_margins(&bench_now.system, &w, &at, NULL, &m);
        unsigned events = 0;
        bench_now.looks = 0;
        const wh_real found =
            wh_contact_locate(&bench_now.system, &w, &from, &to, WH_R(1.0), NULL, &m, &events);
        enter(found - when, &sum);
        TEST_ASSERT_EQUAL_UINT(1U, events);
    }
    told(&sum, 1410, 955, 25);
}
