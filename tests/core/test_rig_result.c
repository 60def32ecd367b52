/* test_rig_result.c: merged turns, compared with sums computed in the test; the condition of each doubt; and the
 * tare. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"

#include "tests/scattered.h"
#include "tests/suites.h"

#define DEG WH_R(0.017453292519943295)
#define TURN_TICKS UINT32_C(181818)

static wh_merge merge;
static wh_turn_angle angle;
static wh_measured measured;
static wh_rotor_config rotor;
static wh_result_config bench; /* a calibrated configuration */

/* Draws a number, uniform about 0, with standard deviation 1. */
static wh_real scatter(void) {
    return ((wh_real)(scattered() >> 40) / WH_R(16777216.0) - WH_R(0.5)) * WH_R(3.4641016);
}

/* Sets the second order of a rotor's force, for a speed ripple of this size and direction. By energy, a rotor without
 * losses has w^2 = A + B cos(theta + lag), and F = S (w^2 cos theta + w' sin theta), with the unbalance S. */
static void put_second(wh_lockin_turn *turn, wh_real ripple_rad, wh_real lag_rad) {
    wh_real size_N;
    wh_real phase_rad;
    wh_polar(turn->force_N.at[1], -turn->force_N.at[2], &size_N, &phase_rad);
    const wh_real per =
        WH_R(2.0) * ripple_rad / (WH_R(1.0) + WH_R(1.5) * ripple_rad * ripple_rad); /* B/A */
    const wh_wave wave = wh_wave_of(lag_rad + WH_R(2.0) * phase_rad);
    turn->force_N.at[3] = WH_R(0.75) * per * size_N * wave.cosine;
    turn->force_N.at[4] = WH_R(-0.75) * per * size_N * wave.sine;
}

static wh_lockin_turn turn_of(wh_real in_phase, wh_real quadrature, unsigned number) {
    wh_lockin_turn turn = {.begin_ticks = UINT32_MAX - 300000U + number * TURN_TICKS,
                           .turn_ticks = TURN_TICKS,
                           .samples = 91,
                           .second_seen = true};
    turn.force_N.at[1] = in_phase;
    turn.force_N.at[2] = quadrature;
    put_second(&turn, angle.ripple_rad, angle.lag_rad);
    turn.mean_N = WH_R(56.0);
    turn.residual_N = WH_R(0.1);
    turn.at_pulse_N[0] = WH_R(98.0);
    turn.at_pulse_N[1] = WH_R(55.0);
    turn.second_ticks = turn.begin_ticks + TURN_TICKS / 4U;
    return turn;
}

static void begin(void) {
    merge = (wh_merge){.turns = 0};
    bench = wh_rig_standard.measure.result;
    bench.amplitude_floor = WH_R(1e-4);
    bench.phase_floor_rad = WH_R(0.01) * DEG;
    rotor = wh_rig_standard.measure.rotor;
    wh_turn_angle_start(&rotor, &angle);
    wh_turn_angle_shape(&rotor, &angle, WH_R(330.0) * WH_RIG_RADPS_PER_RPM);
}

static void add(const wh_lockin_turn *turn) { wh_merge_add(&bench, &rotor, &merge, turn, &angle); }

static void conclude(const wh_result_config *config) {
    for (unsigned i = 0; i < WH_MERGE_MEAN_PIECES; i++) {
        wh_merge_mean_piece(config, &rotor, &merge, &angle, WH_R(56.0), &measured, i);
    }
    wh_merge_compare(&rotor, &merge, &angle, &measured);
    wh_merge_judge(config, &rotor, &merge, &angle, &measured);
}

/* The two-sided factor for 95 %, from tables of the distribution. */
TEST(rig_result, students_factor) {
    static const struct {
        uint32_t freedom;
        wh_real factor;
    } rows[] = {{1, WH_R(12.706)}, {2, WH_R(4.303)},  {3, WH_R(3.182)},   {4, WH_R(2.776)},
                {5, WH_R(2.571)},  {6, WH_R(2.447)},  {7, WH_R(2.365)},   {8, WH_R(2.306)},
                {9, WH_R(2.262)},  {10, WH_R(2.228)}, {15, WH_R(2.131)},  {19, WH_R(2.093)},
                {30, WH_R(2.042)}, {60, WH_R(2.000)}, {120, WH_R(1.980)}, {100000, WH_R(1.960)}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        CHECK_NEAR(6e-4f, rows[i].factor, wh_student(rows[i].freedom));
    }
    CHECK_NEAR(0.0f, 0.0f, wh_student(0));
}

/* Without floors, tolerances and jitter, the interval is Student's for the components along the mean and across it. */
TEST(rig_result, the_interval_is_students) {
    scattered_state = UINT64_C(0x5eed0031);
    for (unsigned k = 0; k < 12; k++) {
        const unsigned turns = 3U + k;
        static wh_real x[16];
        static wh_real y[16];
        begin();
        wh_real sums[2] = {WH_R(0.0), WH_R(0.0)};
        for (unsigned i = 0; i < turns; i++) {
            x[i] = WH_R(40.0) + WH_R(0.5) * scatter();
            y[i] = WH_R(12.0) + WH_R(0.2) * scatter() + WH_R(0.3) * (x[i] - WH_R(40.0));
            const wh_lockin_turn turn = turn_of(x[i], -y[i], i);
            add(&turn);
            sums[0] += x[i];
            sums[1] += y[i];
        }
        wh_result_config config = bench;
        config.amplitude_floor = config.phase_floor_rad = WH_R(1e-9);
        rotor.damping_tolerance = WH_R(0.0);
        merge.ripple_rad = WH_R(0.0);
        conclude(&config);
        const wh_real n = (wh_real)turns;
        const wh_real mx = sums[0] / n;
        const wh_real my = sums[1] / n;
        wh_real size;
        wh_real phase;
        wh_polar(mx, my, &size, &phase);
        CHECK_NEAR(1e-4f, size, measured.amplitude_N);
        CHECK_NEAR(1e-6f, phase, measured.phase_rad);
        wh_real squares[2] = {WH_R(0.0), WH_R(0.0)};
        for (unsigned i = 0; i < turns; i++) {
            const wh_real along = ((x[i] - mx) * mx + (y[i] - my) * my) / size;
            const wh_real across = ((y[i] - my) * mx - (x[i] - mx) * my) / size;
            squares[0] += along * along;
            squares[1] += across * across;
        }
        for (unsigned i = 0; i < 2; i++) {
            const wh_real half =
                i == 0 ? measured.amplitude_half_N : measured.phase_half_rad * size;
            const wh_real t = wh_student(turns - 1U);
            const wh_real wanted2 = t * t * squares[i] / (n * (n - WH_R(1.0)));
            CHECK_NEAR(2e-3f, 1.0f, half * half / wanted2);
        }
        TEST_ASSERT_EQUAL_UINT32(turns, measured.turns);
        CHECK_NEAR(1e-4f, 0.0f, measured.mean_N);
        CHECK_NEAR(1e-4f, 42.0f, measured.at_pulse_N[0]);
        CHECK_NEAR(1e-4f, -1.0f, measured.at_pulse_N[1]);
        CHECK_NEAR(1e-6f, 0.1f, measured.residual_N);
        CHECK_NEAR(1e-4f, 330.0003f, measured.speed_radps / WH_RIG_RADPS_PER_RPM);
    }
}

/* If only the calibration uncertainties are not zero, the intervals equal them. The defaults are 0.5 % and 0.5
 * degrees. */
TEST(rig_result, intervals_include_calibration_uncertainties) {
    begin();
    for (unsigned i = 0; i < 10; i++) {
        const wh_lockin_turn turn = turn_of(WH_R(42.0), WH_R(0.0), i);
        add(&turn);
    }
    rotor.damping_tolerance = WH_R(0.0);
    merge.ripple_rad = WH_R(0.0);
    conclude(&bench);
    CHECK_NEAR(1e-5f, 0.0042f, measured.amplitude_half_N);
    CHECK_NEAR(1e-4f, 0.01f, measured.phase_half_rad / DEG);
    TEST_ASSERT_TRUE(wh_result_is_calibrated(&bench));
    bench.amplitude_floor = WH_R(0.0);
    TEST_ASSERT_FALSE(wh_result_is_calibrated(&bench));
    conclude(&bench);
    CHECK_NEAR(1e-4f, 0.21f, measured.amplitude_half_N);
    CHECK_NEAR(1e-4f, 0.01f, measured.phase_half_rad / DEG);
    conclude(&wh_rig_standard.measure.result);
    TEST_ASSERT_FALSE(wh_result_is_calibrated(&wh_rig_standard.measure.result));
    CHECK_NEAR(1e-3f, 0.5f, measured.phase_half_rad / DEG);
}

/* The standard deviation of the jitter follows from the second differences of both sensors' pulses. A turn that does
 * not count interrupts the series. */
TEST(rig_result, jitter_is_found) {
    scattered_state = UINT64_C(0x5eed0032);
    begin();
    wh_real late_us = WH_R(60.0) * scatter();
    for (unsigned i = 0; i < 400; i++) {
        const wh_real next_us = WH_R(60.0) * scatter();
        wh_lockin_turn turn = turn_of(WH_R(42.0), WH_R(0.0), i);
        turn.begin_ticks += (uint32_t)(int32_t)late_us;
        turn.turn_ticks += (uint32_t)((int32_t)next_us - (int32_t)late_us);
        turn.second_ticks += (uint32_t)(int32_t)(WH_R(60.0) * scatter());
        if (i == 200U) {
            turn.fault = WH_TURN_GAP;
            turn.turn_ticks += 50000U;
        }
        add(&turn);
        late_us = next_us;
    }
    conclude(&bench);
    TEST_ASSERT_EQUAL_UINT32(399, measured.turns);
    TEST_ASSERT_EQUAL_UINT32(1, measured.left_out);
    /* 399 turns in two series: 397 differences of one sensor's pulses, 395 of the other's */
    TEST_ASSERT_EQUAL_UINT32(397 + 395, merge.jitters);
    CHECK_NEAR(5.0f, 60.0f, measured.jitter_s * WH_R(1e6));
}

static wh_why why_of(wh_real in_phase, wh_lockin_turn like) {
    begin();
    for (unsigned i = 0; i < 10U; i++) {
        wh_lockin_turn turn = turn_of(in_phase, WH_R(0.0), i);
        turn.outliers = like.outliers;
        turn.second_seen = !like.second_seen;
        turn.fault = like.fault;
        add(&turn);
    }
    conclude(&bench);
    return measured.why;
}

/* Reasons that depend on the merged turns. limits_of_a_verdict_are_allowed in test_rig_parts.c tests the reasons with
 * a limit on a measured quantity. */
TEST(rig_result, reasons_from_the_turns) {
    const wh_lockin_turn plain = {.samples = 0};
    const wh_lockin_turn gap = {.fault = WH_TURN_GAP};
    const wh_real full_N = WH_R(42.146); /* unbalance times mean square of the speed, at 330 rpm */
    TEST_ASSERT_TRUE(why_of(full_N, plain) == WH_WHY_NONE);
    CHECK_NEAR(0.01f, full_N, measured.expected_N);
    TEST_ASSERT_TRUE(measured.quality == WH_GOOD);
    TEST_ASSERT_TRUE(why_of(full_N, gap) == WH_WHY_FEW_TURNS);
    wh_lockin_turn odd = plain;
    odd.outliers = 1; /* a turn has 91 samples */
    TEST_ASSERT_TRUE(why_of(full_N, odd) == WH_WHY_OUTLIERS);
    odd = plain;
    odd.second_seen = true; /* sensor 2's pulse was seen, at an unknown part of the turn */
    TEST_ASSERT_TRUE(why_of(full_N, odd) == WH_WHY_ROTOR);
    for (unsigned i = 0; i < 4; i++) { /* inertias that differ from the rotor's */
        static const wh_real times[] = {WH_R(1.45), WH_R(0.7), WH_R(1.55), WH_R(0.6)};
        TEST_ASSERT_TRUE(why_of(full_N, plain) == WH_WHY_NONE);
        angle.inertia_kgm2 = rotor.inertia_kgm2 * times[i];
        conclude(&bench);
        TEST_ASSERT_TRUE(measured.why == (i < 2U ? WH_WHY_NONE : WH_WHY_ROTOR));
    }
    for (int side = -1; side <= 1; side += 2) {
        /* Gravity is compensated, except for a remaining part. */
        for (unsigned i = 0; i < 2; i++) {
            TEST_ASSERT_TRUE(why_of(full_N, plain) == WH_WHY_NONE);
            const wh_real part = WH_ABS(merge.ripple_rad) / angle.whole_rad;
            angle.compensated = true;
            const wh_real left = (wh_real)side * (i == 0 ? WH_R(0.14) : WH_R(0.16)) / part;
            merge.ripple_rad *= left;
            merge.second_N[0] *= left;
            merge.second_N[1] *= left;
            conclude(&bench);
            TEST_ASSERT_TRUE(measured.why == (i == 0 ? WH_WHY_NONE : WH_WHY_FED));
            angle.compensated = false;
        }
    }
    for (unsigned i = 0; i < 8U;
         i++) { /* a second order that is off by 0.98 or 1.02 times the limit, in four directions */
        static const wh_real turns[] = {WH_R(0.0), WH_R(0.5), WH_R(0.25), WH_R(-0.25)};
        TEST_ASSERT_TRUE(why_of(full_N, plain) == WH_WHY_NONE);
        CHECK_NEAR(1e-5f, 0.0f, measured.ripple_off_rad);
        const wh_real off_rad =
            (i < 4U ? WH_R(0.98) : WH_R(1.02)) *
            (WH_R(0.01) + WH_SQRT(measured.phase_half_rad * measured.phase_half_rad -
                                  bench.phase_floor_rad * bench.phase_floor_rad));
        const wh_wave wave = wh_wave_of(WH_RIG_TWO_PI * turns[i % 4U]);
        const wh_real more_N = WH_R(2.0) * off_rad * full_N /
                               (WH_R(1.0) + WH_R(1.5) * merge.ripple_rad * merge.ripple_rad);
        merge.second_N[0] += more_N * wave.cosine;
        merge.second_N[1] += more_N * wave.sine;
        conclude(&bench);
        CHECK_NEAR(1e-5f, off_rad, measured.ripple_off_rad);
        TEST_ASSERT_TRUE(measured.why == (i < 4U ? WH_WHY_NONE : WH_WHY_SWING));
        TEST_ASSERT_TRUE(measured.quality == (i < 4U ? WH_GOOD : WH_DOUBTFUL));
    }
    for (unsigned i = 0; i < 2U; i++) { /* a repeating residual of 0.98 or 1.02 times its limit */
        TEST_ASSERT_TRUE(why_of(full_N, plain) == WH_WHY_NONE);
        merge.repeats.samples = 910;
        merge.repeats.changes_N2 = WH_R(2.0) * WH_R(910.0); /* noise of 1 N */
        conclude(&bench);
        merge.repeats_N2 = (i == 0 ? WH_R(0.98) : WH_R(1.02)) * measured.repeats_limit_N *
                           measured.repeats_limit_N;
        conclude(&bench);
        CHECK_NEAR(0.01f, 0.286f, measured.repeats_limit_N);
        TEST_ASSERT_TRUE(measured.why == (i == 0 ? WH_WHY_NONE : WH_WHY_REPEATS));
        merge.repeats_N2 = WH_R(0.0);
    }
    /* NaN is refused */
    const wh_real nan = (wh_real)__builtin_nanf("");
    TEST_ASSERT_TRUE(why_of(nan, plain) == WH_WHY_AMPLITUDE);
}

/* If gravity is compensated and the plane is not level, the remaining part of gravity is reported; otherwise 0. */
TEST(rig_result, remaining_gravity_is_reported) {
    for (unsigned i = 0; i < 4U; i++) {
        begin();
        rotor.gravity_mps2 = i < 2U ? rotor.gravity_mps2 : WH_R(0.0);
        wh_turn_angle_start(&rotor, &angle);
        wh_turn_angle_compensate(&angle, i % 2U == 0, WH_R(0.0625));
        angle.drive_V = WH_R(24.0);
        wh_turn_angle_shape(&rotor, &angle, WH_R(330.0) * WH_RIG_RADPS_PER_RPM);
        for (unsigned k = 0; k < 10U; k++) {
            const wh_lockin_turn turn = turn_of(WH_R(42.0), WH_R(0.0), k);
            add(&turn);
        }
        merge.ripple_rad = WH_R(-0.125) * angle.whole_rad;
        conclude(&bench);
        CHECK_NEAR(1e-6f, i == 0 ? 0.125f : 0.0f, measured.uncompensated_part);
    }
}

/* A single turn has no scatter, and a zero load has no phase. Then the result has no interval, and no number in it is
 * NaN. */
TEST(rig_result, no_interval_without_scatter_or_load) {
    for (unsigned turns = 0; turns <= 3U; turns++) {
        for (unsigned loads = 0; loads < 2U; loads++) {
            begin();
            for (unsigned i = 0; i < turns; i++) {
                const wh_lockin_turn turn =
                    turn_of(loads == 1U ? WH_R(42.0) : WH_R(0.0), WH_R(0.0), i);
                add(&turn);
            }
            conclude(&bench);
            const bool tells = turns >= 2U && loads == 1U;
            TEST_ASSERT_TRUE((measured.amplitude_half_N > WH_R(0.0)) == tells);
            TEST_ASSERT_TRUE((measured.phase_half_rad > WH_R(0.0)) == tells);
            TEST_ASSERT_TRUE(measured.amplitude_half_N < WH_R(42.0));
            TEST_ASSERT_TRUE(measured.phase_half_rad < WH_R(1.0));
        }
    }
}

/* If the carriage weighs three times the masses, the force is a quarter smaller. */
TEST(rig_result, expected_force_depends_on_the_mount) {
    begin();
    wh_result_config config = bench;
    config.mount_factor = WH_R(0.75);
    for (unsigned i = 0; i < 10; i++) {
        const wh_lockin_turn turn = turn_of(WH_R(0.75) * WH_R(42.146), WH_R(0.0), i);
        wh_merge_add(&config, &rotor, &merge, &turn, &angle);
    }
    conclude(&config);
    TEST_ASSERT_TRUE(measured.why == WH_WHY_NONE);
    CHECK_NEAR(0.01f, 31.61f, measured.expected_N);
}

/* Returns a tare of 250 samples with white noise, mains hum, and motion. */
static wh_tare tare_of(wh_real noise_N, wh_real hum_N, wh_real hum_Hz, wh_real swing_N,
                       wh_real swing_Hz, wh_real drift_N) {
    wh_tare tare = {.count = 0};
    const wh_real begins[] = {scatter(), scatter()}; /* initial phases, rad */
    for (unsigned i = 0; i < 250; i++) {
        const wh_real part = (wh_real)i / WH_R(250.0);
        wh_real hum;
        wh_real swing;
        wh_real unused;
        const wh_real turn = WH_R(0.5) * WH_RIG_TWO_PI * part; /* 1 Hz over half a second */
        wh_sincos(wh_phase_from_rad(hum_Hz * turn + begins[0]), &hum, &unused);
        wh_sincos(wh_phase_from_rad(swing_Hz * turn + begins[1]), &swing, &unused);
        wh_tare_add(&tare, WH_R(56.0) + noise_N * scatter() + hum_N * hum + swing_N * swing +
                               drift_N * part);
    }
    return tare;
}

static wh_real between(wh_real least, wh_real most) {
    return least + (most - least) * (WH_R(0.5) + scatter() / WH_R(3.4641016));
}

/* If the error of the mean is small enough, noise (up to 3 N) and hum (up to 5 N, 45 to 65 Hz) do not count as
 * motion. */
TEST(rig_result, noise_and_hum_are_no_motion) {
    static const wh_real noise_N[] = {WH_R(0.0), WH_R(0.007), WH_R(0.07), WH_R(1.0), WH_R(3.0)};
    scattered_state = UINT64_C(0x5eed0033);
    for (unsigned k = 0; k < 2000; k++) {
        const wh_real size = k < 1000U ? noise_N[k % 5U] : between(WH_R(0.007), WH_R(0.3));
        const wh_real hum_N = k < 1000U ? WH_R(0.0) : between(WH_R(0.0), WH_R(5.0));
        const wh_tare tare =
            tare_of(size, hum_N, between(WH_R(45.0), WH_R(65.0)), WH_R(0.0), WH_R(1.0), WH_R(0.0));
        TEST_ASSERT_TRUE(wh_tare_is_still(&wh_rig_standard.measure.tare, &tare));
        const wh_real error = WH_SQRT(size * size + WH_R(0.5) * hum_N * hum_N) / WH_R(15.811);
        CHECK_NEAR(0.15f * (float)error + 1e-5f, error, wh_tare_error_N(&tare));
        CHECK_NEAR(5.0f * (float)error + 1e-4f, 56.0f, tare.mean_N);
    }
}

/* Motion is detected through noise and hum: a drift of 0.4 N, or a swing of 0.3 N plus twice the noise. The swing is that of
 * a rotor (from 1 Hz) or a frame (up to 8 Hz). */
TEST(rig_result, motion_is_detected_in_noise) {
    scattered_state = UINT64_C(0x5eed0034);
    for (unsigned k = 0; k < 2000; k++) {
        const wh_real side = k % 4U < 2U ? WH_R(1.0) : WH_R(-1.0);
        const bool drifts = k % 2U == 0;
        const wh_real noise_N = between(WH_R(0.007), WH_R(0.3));
        const wh_real more_N = WH_R(2.0) * noise_N + between(WH_R(0.0), WH_R(2.0));
        const wh_tare tare =
            tare_of(noise_N, between(WH_R(0.0), WH_R(0.3)), between(WH_R(45.0), WH_R(65.0)),
                    drifts ? WH_R(0.0) : WH_R(0.3) + more_N, between(WH_R(1.2), WH_R(8.0)),
                    drifts ? side * (WH_R(0.4) + more_N) : WH_R(0.0));
        TEST_ASSERT_FALSE(wh_tare_is_still(&wh_rig_standard.measure.tare, &tare));
    }
}

/* If noise makes the mean uncertain by 0.25 N, the tare is refused. Too few samples are refused, too. */
TEST(rig_result, a_tare_that_is_not_known) {
    scattered_state = UINT64_C(0x5eed0036);
    wh_tare tare = {.count = 0};
    for (unsigned i = 0; i < 4U * WH_TARE_BLOCK; i++) {
        TEST_ASSERT_FALSE(wh_tare_is_still(&wh_rig_standard.measure.tare, &tare));
        wh_tare_add(&tare, WH_R(1.0));
        CHECK_NEAR(0.0f, 0.0f, wh_tare_error_N(&tare));
    }
    TEST_ASSERT_TRUE(wh_tare_is_still(&wh_rig_standard.measure.tare, &tare));
    tare = tare_of(WH_R(8.0), WH_R(0.0), WH_R(50.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
    TEST_ASSERT_FALSE(wh_tare_is_still(&wh_rig_standard.measure.tare, &tare));
}
