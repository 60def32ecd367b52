/* test_rig_guard.c: the guard's reasons to stop the rig, one by one. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "core/root.h"

#include "tests/suites.h"

#define RPM WH_RIG_RADPS_PER_RPM

static double root(double x) { return (double)WH_SQRT((wh_real)x); }

/* The limit follows from reversed bending at the bearing, 1 in from the arm, with notch factor 2 and safety factor 2
 * (docs/rig.md). The stress may reach the corrected endurance limit of steel with 440 MPa tensile strength. */
TEST(rig_guard, speed_limit_follows_from_the_shaft) {
    const wh_real pi = WH_R(3.14159265);
    const wh_real endurance_Pa = WH_R(220e6) * WH_R(0.899) * WH_R(0.753);
    const wh_real d_m = WH_R(0.25) * WH_R(0.0254);
    const wh_real section_m3 = pi * d_m * d_m * d_m / WH_R(32.0);
    const wh_real carried_N = endurance_Pa / (WH_R(2.0) * WH_R(2.0)) * section_m3 / WH_R(0.0254);
    const wh_real others_N =
        WH_R(1.34) + WH_R(2.10); /* one set's weight, and its part of the ripple */
    const wh_real limit = wh_rig_standard.guard.limit_radps;
    const wh_real at_limit_N = WH_RIG_UNBALANCE_KGM / WH_R(2.0) * limit * limit + others_N;
    TEST_ASSERT_TRUE(at_limit_N < carried_N);
    /* The limit is not lower than necessary, either. */
    TEST_ASSERT_TRUE(at_limit_N > WH_R(0.85) * carried_N);
    TEST_ASSERT_TRUE(wh_rig_standard.guard.target_max_radps < limit);
    TEST_ASSERT_TRUE(WH_RIG_NOMINAL_RPM * RPM < wh_rig_standard.guard.target_max_radps);
}

TEST(rig_guard, guard_refuses_set_points) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    TEST_ASSERT_TRUE(wh_guard_allows(config, WH_R(330.0) * RPM, false));
    TEST_ASSERT_TRUE(wh_guard_allows(config, config->target_min_radps, false));
    TEST_ASSERT_TRUE(wh_guard_allows(config, config->target_max_radps, false));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(361.0) * RPM, false));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(169.0) * RPM, false));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(0.0), false));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(-1.0), false));
    TEST_ASSERT_FALSE(wh_guard_allows(config, (wh_real)__builtin_nanf(""), false));
}

static wh_trip trip_at(wh_real turn_rpm, unsigned fast) {
    wh_guard guard;
    wh_guard_start(&guard, 0);
    wh_pulses pulses;
    wh_pulses_start(&pulses, WH_R(800.0) * RPM);
    pulses.speed.known = true;
    pulses.speed.turn_radps = turn_rpm * RPM;
    pulses.fast = fast;
    wh_guard_speed(&wh_rig_standard.guard, &guard, &pulses, WH_TRIP_RUNS_ON, 0);
    wh_guard_speed(&wh_rig_standard.guard, &guard, &pulses, WH_TRIP_OVERSPEED, 0);
    return guard.trip;
}

TEST(rig_guard, over_speed_trips) {
    TEST_ASSERT_TRUE(trip_at(WH_R(399.0), 1) ==
                     WH_TRIP_NONE); /* a single interval may be a disturbance */
    TEST_ASSERT_TRUE(trip_at(wh_rig_standard.guard.limit_radps / RPM, 0) ==
                     WH_TRIP_NONE); /* the limit itself is allowed */
    TEST_ASSERT_TRUE(trip_at(WH_R(401.0), 0) == WH_TRIP_RUNS_ON);
    TEST_ASSERT_TRUE(trip_at(WH_R(200.0), 2) == WH_TRIP_RUNS_ON);
}

/* Over-speed trips for a turn that is too fast, unless a later pulse may still contradict it, or after two short
 * intervals in succession. */
TEST(rig_guard, over_speed_trips_when_confirmed) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    for (unsigned i = 0; i < 96U; i++) {
        const bool known = i % 2U == 1U;
        const bool waits = i / 2U % 2U == 1U;
        const bool too_fast = i / 4U % 2U == 1U;
        const bool driven = i / 8U % 2U == 1U;
        const unsigned alternate = i / 16U % 2U == 1U ? WH_GUARD_COASTS : WH_GUARD_COASTS - 1U;
        const unsigned fast = i / 32U;
        const wh_pulses pulses = {
            .speed = {.known = known,
                      .turn_radps = config->limit_radps + (too_fast ? WH_R(0.01) : WH_R(-0.01))},
            .waits = waits,
            .fast = fast,
            .alternate = alternate};
        wh_guard guard = {.trip = WH_TRIP_NONE};
        wh_guard_speed(config, &guard, &pulses, WH_TRIP_OVERSPEED, driven ? 0 : WH_GUARD_COASTS);
        const bool turns = driven || alternate >= WH_GUARD_COASTS;
        const bool sure = known && too_fast && (!waits || fast > 0);
        TEST_ASSERT_EQUAL_INT(turns && (sure || fast > 1U) ? WH_TRIP_OVERSPEED : WH_TRIP_NONE,
                              guard.trip);
    }
}

/* Over-speed trips if the speed rises at two successive pulses, and one interval is beyond the bound. One of these
 * alone does not trip. */
TEST(rig_guard, rising_over_speed_trips) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    const wh_real turn = WH_R(345.0) * RPM;
    for (unsigned fast = 0; fast < 2U; fast++) {
        for (unsigned part = 0; part <= 10U; part++) { /* tenths of both rises in the last one */
            wh_guard guard;
            wh_guard_start(&guard, 0);
            wh_pulses pulses;
            wh_pulses_start(&pulses, WH_R(800.0) * RPM);
            pulses.fast = fast;
            pulses.speed.known = true;
            pulses.speed.turn_radps = turn;
            pulses.climb_radps = WH_R(2.2) * config->climb * turn * WH_R(0.1) * (wh_real)part;
            pulses.climb_before_radps = WH_R(2.2) * config->climb * turn - pulses.climb_radps;
            wh_guard_speed(config, &guard, &pulses, WH_TRIP_OVERSPEED, 0);
            const bool both = part > 0 && part < 10U;
            TEST_ASSERT_TRUE((guard.trip == WH_TRIP_OVERSPEED) == (both && fast > 0));
            guard.trip = WH_TRIP_NONE;
            pulses.climb_radps *= WH_R(0.4);
            pulses.climb_before_radps *= WH_R(0.4);
            wh_guard_speed(config, &guard, &pulses, WH_TRIP_OVERSPEED, 0);
            TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
        }
    }
    TEST_ASSERT_TRUE(wh_guard_climb_radps2(config, WH_R(20.0) * RPM, true) ==
                     config->climb_behind_radps2);
    TEST_ASSERT_TRUE(wh_guard_climb_radps2(config, WH_R(20.0) * RPM, false) ==
                     config->climb_there_radps2);
    TEST_ASSERT_TRUE(wh_guard_climb_radps2(config, WH_R(0.0), true) == config->climb_there_radps2);
    TEST_ASSERT_TRUE(wh_guard_climb_radps2(config, WH_R(-20.0) * RPM, true) < WH_R(0.0));
}

/* A rotor without drive passes the top at 1.03 times the set-point. At the bottom it has the speed that follows from
 * its energy. */
TEST(rig_guard, speed_bound_includes_gravity) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    const double falls2 =
        4.0 * (double)(WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2) / (double)WH_RIG_INERTIA_KGM2;
    CHECK_NEAR(0.05f, root(falls2), config->fall_radps);
    for (unsigned rpm_led = 0; rpm_led <= 340U; rpm_led += 20U) {
        const double base = (double)((wh_real)rpm_led * RPM);
        const float wanted = (float)root(1.03 * 1.03 * base * base + falls2);
        CHECK_NEAR(0.05f, wanted, wh_guard_bound_radps(config, (wh_real)base, true));
        CHECK_NEAR(0.001f, 1.03f * (float)base, wh_guard_bound_radps(config, (wh_real)base, false));
    }
    const float most = 1.1f * (float)config->limit_radps;
    CHECK_NEAR(1e-3f, most, wh_guard_bound_radps(config, WH_R(90.0), true));
    CHECK_NEAR(1e-3f, most, wh_guard_bound_radps(config, (wh_real)__builtin_nanf(""), true));
}

TEST(rig_guard, lost_pulses_and_silence_trip) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    const wh_real silence_s = WH_R(0.5);
    wh_guard guard;
    wh_guard_start(&guard, 0);
    wh_pulses pulses;
    wh_pulses_start(&pulses, WH_R(800.0) * RPM);
    pulses.speed.lost = 5;
    guard.lost_before = 2;
    wh_guard_pulses(config, &guard, &pulses, silence_s, 0);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
    pulses.speed.lost = 6;
    wh_guard_pulses(config, &guard, &pulses, silence_s, 0);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES);
    wh_guard_trip(&guard, WH_TRIP_OVERSPEED);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES); /* the first reason stays */

    wh_guard_start(&guard, 0);
    wh_pulses_start(&pulses, WH_R(800.0) * RPM);
    wh_pulses_take(&pulses, 0, 1000U);
    /* The step's time is before that of the last pulse. */
    wh_guard_pulses(config, &guard, &pulses, silence_s, 999U);
    wh_guard_pulses(config, &guard, &pulses, silence_s, 1000U + 499000U);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
    wh_guard_pulses(config, &guard, &pulses, silence_s, 1000U + 501000U);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES);

    wh_guard_start(&guard, 0);
    wh_pulses_start(&pulses, WH_R(800.0) * RPM);
    guard.rejected_before = 7;
    pulses.rejected = 7 + config->rejected_max;
    wh_guard_pulses(config, &guard, &pulses, silence_s, 0);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
    pulses.rejected++;
    wh_guard_pulses(config, &guard, &pulses, silence_s, 0);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES);
}

/* A rotor without a pulse for 1.5 s is at rest, and stays so until a pulse comes, also after the timer's wrap. */
TEST(rig_guard, rest_is_remembered) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    wh_guard guard;
    wh_guard_start(&guard, UINT32_MAX - 1000U);
    wh_guard_quiet(config, &guard, 0, UINT32_MAX - 1000U + 1499000U);
    TEST_ASSERT_FALSE(guard.quiet);
    wh_guard_quiet(config, &guard, 0, UINT32_MAX - 1000U + 1501000U);
    TEST_ASSERT_TRUE(guard.quiet);
    wh_guard_quiet(config, &guard, 0, UINT32_MAX - 1000U); /* 71.6 minutes later */
    TEST_ASSERT_TRUE(guard.quiet);
    wh_guard_quiet(config, &guard, 1, 5000U);
    TEST_ASSERT_FALSE(guard.quiet);
    wh_guard_quiet(config, &guard, 1, 5000U + 1501000U);
    TEST_ASSERT_TRUE(guard.quiet);
}

/* Returns the trip if load samples vary by `swing_N` about 50 N, with a slot pulse at every 20th sample, at 330 rpm. */
static wh_trip trip_on_swing(wh_real swing_N, bool turning, unsigned samples) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    wh_guard guard;
    wh_guard_start(&guard, 0);
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    speed.turn_radps = WH_R(330.0) * RPM;
    for (unsigned i = 0; i < samples; i++) {
        speed.taken = i / 20U;
        const wh_load load = {.ticks = i * UINT32_C(2000),
                              .force_N = WH_R(50.0) + (i % 2U == 0 ? swing_N : -swing_N)};
        wh_guard_load(config, &guard, &speed, &load, turning, true);
    }
    return guard.trip;
}

TEST(rig_guard, a_stuck_load_cell_trips) {
    const unsigned enough = (unsigned)(20U * wh_rig_standard.guard.stuck_pulses + 1U);
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(0.0), false, 1000) ==
                     WH_TRIP_NONE); /* at rest the load may be constant */
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(0.0), true, enough - 1U) == WH_TRIP_NONE);
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(0.0), true, enough) == WH_TRIP_LOAD_CELL);
    /* The samples of a dead cell vary only by noise. With a live cell the load varies by at least a tenth of the
     * masses' 42 N. */
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(2.0), true, enough) == WH_TRIP_LOAD_CELL);
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(2.2), true, 1000) == WH_TRIP_NONE);
}

TEST(rig_guard, overloaded_or_disconnected_cell_trips) {
    const wh_speed speed = {.taken = 7};
    for (wh_load_status status = WH_LOAD_OK; status < WH_LOAD_STATUSES; status++) {
        wh_guard guard;
        wh_guard_start(&guard, 0);
        const wh_load load = {.status = status};
        wh_guard_load(&wh_rig_standard.guard, &guard, &speed, &load, false, true);
        const bool fails = status == WH_LOAD_SATURATED || status == WH_LOAD_DISCONNECTED;
        TEST_ASSERT_TRUE(guard.trip == (fails ? WH_TRIP_LOAD_CELL : WH_TRIP_NONE));
        wh_guard_start(&guard, 0);
        wh_guard_load(&wh_rig_standard.guard, &guard, &speed, &load, false, false);
        TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE); /* the cell is not needed now */
    }
}

/* If a load cell gives no samples for more than load_silence_max_s, ten periods of 2 ms, the rig trips, even while
 * the timer wraps. A repeated sample does not count as new. */
TEST(rig_guard, a_silent_load_cell_trips) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    const uint32_t last = UINT32_MAX - 4000U;
    const wh_speed speed = {.taken = 7};
    for (unsigned sampled = 0; sampled < 2; sampled++) {
        wh_guard guard;
        wh_guard_start(&guard, sampled == 0 ? last : 0);
        if (sampled == 1) {
            wh_load load = {.ticks = last, .force_N = WH_R(1.0)};
            wh_guard_load(config, &guard, &speed, &load, false, true);
            load.ticks += 10000U;
            load.status = WH_LOAD_REPEATED;
            wh_guard_load(config, &guard, &speed, &load, false, true);
        }
        /* The step's time is before that of the last sample. */
        TEST_ASSERT_TRUE(wh_guard_load_comes(config, &guard, last - 100U));
        TEST_ASSERT_TRUE(wh_guard_load_comes(config, &guard, last + 19900U));
        TEST_ASSERT_FALSE(wh_guard_load_comes(config, &guard, last + 20100U));
    }
}
