/* test_contact_assign.c: a crossing's assignments (contact_resolve.h), on random mechanisms (bench.h). All values are
 * evaluated before any is set. The low parts of the assigned components become zero. If a component gets an invalid
 * value, the fault names it. */
#include "bench.h"

#include "tests/suites.h"

static wh_real values[WH_SETS_MAX];
static uint8_t target[WH_SETS_MAX];

static void give(const void *model, const wh_phase *phase, const wh_real *linear,
                 const wh_real *rate, const wh_real *input, wh_real *result) {
    (void)model;
    (void)phase;
    (void)linear;
    (void)rate;
    (void)input;
    result[0] = values[0];
}

/* Draws a mechanism of `angles` angles with one crossing that sets component `to`. Returns the crossing's number. */
static unsigned draw_crossing(uint64_t *seed, unsigned n, unsigned angles, unsigned to,
                              wh_contact_work *w, wh_contact_state *s) {
    bench_build(seed, n, angles);
    bench_add_some(seed, WH_KIND_BIT(WH_STOP) | WH_KIND_BIT(WH_HOLD));
    while (bench_now.system.forced > BENCH_FORCED - 1U) { /* keeps room for one more contact */
        bench_build(seed, n, angles);
        bench_add_some(seed, WH_KIND_BIT(WH_STOP));
    }
    const unsigned k = bench_add(seed, WH_WHEN, -1);
    bench_now.contact[k].sets = 1;
    bench_now.system.sets = give;
    bench_now.system.target = target;
    bench_now.system.ledger = NULL;
    bench_now.system.compensated = draw_one_in(seed, 2);
    target[0] = (uint8_t)to;
    bench_work(seed, true, w);
    bench_state(seed, s);
    for (unsigned i = 0; i < 2U * WH_COORDS; i++) {
        s->carry[i] = WH_R(0.125);
    }
    w->mode[k] = draw_one_in(seed, 2) ? 1 : -1;
    w->books = NULL;
    w->fault = -1;
    w->moved = 0;
    return k;
}

TEST(contact_assign, each_component_can_be_assigned) {
    uint64_t seed = 2311;
    for (unsigned round = 0; round < 300; round++) {
        wh_contact_work w;
        wh_contact_state s;
        const unsigned n = 1U + draw_one_of(&seed, BENCH_COORDS);
        const unsigned angles = draw_one_of(&seed, n + 1U);
        const unsigned components = 2U * n;
        const unsigned to = draw_one_of(&seed, components);
        const unsigned k = draw_crossing(&seed, n, angles, to, &w, &s);
        const wh_contact_state before = s;
        const int8_t side = w.mode[k];
        values[0] = draw_broken(&seed, -1000, 1000);
        wh_contact_assign(&bench_now.system, &w, k, NULL, &s);
        TEST_ASSERT_EQUAL_INT(-side, w.mode[k]); /* the crossing has changed sides */
        TEST_ASSERT_EQUAL_INT(-1, w.fault);
        for (unsigned i = 0; i < components; i++) {
            const wh_real carry = bench_now.system.compensated && i == to ? WH_R(0.0) : WH_R(0.125);
            TEST_ASSERT_TRUE(s.carry[i] == carry);
            if (i < angles) {
                TEST_ASSERT_TRUE(s.angle[i] ==
                                 (i == to ? wh_angle_from_rad(values[0]) : before.angle[i]));
            } else {
                TEST_ASSERT_TRUE(s.real[i - angles] ==
                                 (i == to ? values[0] : before.real[i - angles]));
            }
        }
        TEST_ASSERT_EQUAL_UINT(k, w.mover);
    }
}

/* A crossing that turned back, and is still near zero at the end of a trial step, becomes undecided. It has a sign
 * again when its value has changed by more than this value. */
TEST(contact_assign, an_undecided_crossing_saves_its_value) {
    uint64_t seed = 3011;
    for (unsigned round = 0; round < 300; round++) {
        wh_contact_work w;
        wh_contact_state s;
        wh_margins m;
        const unsigned n = 1U + draw_one_of(&seed, BENCH_COORDS);
        const unsigned k = draw_crossing(&seed, n, draw_one_of(&seed, n + 1U), 0, &w, &s);
        const wh_real value = w.mode[k] * draw_broken(&seed, 1, 1000);
        const wh_real factor = draw_one_in(&seed, 2) ? WH_R(1.75) : WH_R(2.25);
        for (unsigned i = 0; i < WH_CONTACTS_MAX; i++) {
            m.value[i] = WH_R(1.0);
            w.slack[i] = WH_R(0.0);
            w.stood[i] = (wh_real)__builtin_nan("");
        }
        w.slack[k] = WH_R(0.5) * WH_ABS(value);
        w.due[k] = WH_ABS(value);
        m.signal[2 * k] = value;
        wh_contact_pass(&bench_now.system, &m, &w);
        TEST_ASSERT_EQUAL_INT(0, w.mode[k]);
        TEST_ASSERT_TRUE(w.stood[k] == value);
        w.slack[k] = WH_R(0.0);
        m.signal[2 * k] = factor * value;
        wh_contact_pass(&bench_now.system, &m, &w);
        TEST_ASSERT_EQUAL_INT(factor < WH_R(2.0) ? 0 : value > WH_R(0.0) ? 1 : -1, w.mode[k]);
    }
}

/* A turn angle must be below 1e9 rad, any other component below 1e15; NaN is invalid. The fault names the component. */
TEST(contact_assign, invalid_values_are_refused_by_name) {
    uint64_t seed = 1123;
    for (unsigned round = 0; round < 200; round++) {
        wh_contact_work w;
        wh_contact_state s;
        const unsigned n = 1U + draw_one_of(&seed, BENCH_COORDS);
        const unsigned angles = draw_one_of(&seed, n + 1U);
        const unsigned to = draw_one_of(&seed, 2U * n);
        const wh_real most = to < angles ? WH_R(1e9) : WH_R(1e15);
        const wh_real sizes[] = {WH_R(0.99), WH_R(1.01), WH_R(1e10), (wh_real)__builtin_nan("")};
        const unsigned which = draw_one_of(&seed, 4);
        const unsigned k = draw_crossing(&seed, n, angles, to, &w, &s);
        values[0] = (draw_one_in(&seed, 2) ? most : -most) * sizes[which];
        wh_contact_assign(&bench_now.system, &w, k, NULL, &s);
        TEST_ASSERT_EQUAL_INT(which == 0 ? -1 : (int)to, w.fault);
    }
}
