/* test_rig_parts.c: the smaller functions of the rig, as their headers describe them: angles and polar form, least
 * squares, the angle within a turn, pulses, turns of a record, and the outcome of a swing. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/free_swing.h"
#include "core/rig/phases.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"
#include "draw.h"

#include "tests/suites.h"

#define TURN WH_RIG_TWO_PI
#define N WH_NORMAL_UNKNOWNS

static uint64_t seed;

/* An angle less than a turn outside is wrapped into -pi ... pi. An angle further away becomes 0. */
TEST(rig_parts, free_angles) {
    seed = 1;
    for (unsigned i = 0; i < 2000U; i++) {
        const wh_real turns = draw_broken(&seed, -4, 4);
        const wh_real size = WH_ABS(turns);
        const wh_real sign = turns < WH_R(0.0) ? WH_R(-1.0) : WH_R(1.0);
        const wh_real wanted = size > WH_R(1.5)   ? WH_R(0.0)
                               : size > WH_R(0.5) ? turns - sign
                                                  : turns;
        CHECK_NEAR(2e-6f, wanted * TURN, wh_free_angle(turns * TURN));
    }
    TEST_ASSERT_TRUE(wh_free_angle((wh_real)__builtin_nanf("")) == WH_R(0.0));
}

TEST(rig_parts, polar_of_every_size) {
    seed = 2;
    for (unsigned i = 0; i < 2000U; i++) {
        const wh_real angle = draw_between(&seed, WH_R(-3.1), WH_R(3.1));
        wh_real size = draw_between(&seed, WH_R(1.0), WH_R(10.0));
        for (unsigned k = draw_one_of(&seed, 7); k > 0; k--) {
            size *= WH_R(0.1);
        }
        for (unsigned k = draw_one_of(&seed, 4); k > 0; k--) {
            size *= WH_R(10.0);
        }
        const wh_wave wave = wh_wave_of(angle);
        wh_real radius;
        wh_real found;
        wh_polar(size * wave.cosine, size * wave.sine, &radius, &found);
        CHECK_NEAR(1e-6f, 1.0f, radius / size);
        CHECK_NEAR(2e-6f, angle, found);
    }
    for (unsigned i = 0; i < 2U; i++) { /* the origin, and the angle of half a turn */
        wh_real radius;
        wh_real angle;
        wh_polar(-(wh_real)i, WH_R(0.0), &radius, &angle);
        TEST_ASSERT_TRUE(radius == (wh_real)i);
        CHECK_NEAR(1e-6f, i == 0 ? 0.0f : 3.14159265f, angle);
    }
}

/* wh_turn_angle_by_ratio() returns the error that the angle at sensor 2's pulse had before the correction, whichever
 * parameter it corrects. */
TEST(rig_parts, angle_error_at_pulse_2) {
    seed = 3;
    for (unsigned i = 0; i < 300U; i++) {
        wh_rotor_config rotor = wh_rig_standard.measure.rotor;
        rotor.inertia_kgm2 *= draw_between(&seed, WH_R(0.5), WH_R(2.0));
        rotor.gravity_mps2 *=
            draw_one_in(&seed, 5) ? WH_R(0.0) : draw_between(&seed, WH_R(0.5), WH_R(1.0));
        rotor.pulse_rad[0] = draw_between(&seed, WH_R(-0.1), WH_R(0.1));
        rotor.pulse_rad[1] = rotor.pulse_rad[0] + draw_between(&seed, WH_R(1.4), WH_R(1.7));
        wh_turn_angle angle;
        wh_turn_angle_start(&rotor, &angle);
        wh_turn_angle_compensate(&angle, draw_one_in(&seed, 2), WH_R(0.0625));
        angle.drive_V = WH_R(24.0);
        for (unsigned turn = 0; turn < 3U; turn++) {
            wh_turn_angle_shape(&rotor, &angle, draw_between(&seed, WH_R(25.0), WH_R(40.0)));
            const wh_real ratio = draw_between(&seed, WH_R(0.22), WH_R(0.28));
            const wh_real off = rotor.pulse_rad[1] - wh_turn_angle_at(&angle, ratio);
            CHECK_NEAR(1e-6f, off, wh_turn_angle_by_ratio(&rotor, &angle, ratio));
        }
    }
}

/* The solution satisfies (1 + sum w r r') x = guess + sum w r off, for any number of rows, including none. */
TEST(rig_parts, normal_equations_hold) {
    seed = 4;
    for (unsigned i = 0; i < 200U; i++) {
        static wh_real row[12][N];
        wh_real guess[N];
        wh_real off[12];
        wh_real weight[12];
        const unsigned rows = draw_one_of(&seed, 12);
        wh_normal normal;
        for (unsigned k = 0; k < N; k++) {
            guess[k] = draw_broken(&seed, -2, 2);
        }
        wh_normal_start(&normal, guess);
        wh_real misfit = WH_R(0.0);
        for (unsigned j = 0; j < rows; j++) {
            off[j] = draw_broken(&seed, -2, 2);
            weight[j] = draw_between(&seed, WH_R(0.1), WH_R(4.0));
            for (unsigned k = 0; k < N; k++) {
                row[j][k] = draw_broken(&seed, -1, 1);
            }
            wh_normal_add(&normal, row[j], off[j], weight[j]);
            misfit += weight[j] * off[j] * off[j];
        }
        CHECK_NEAR(1e-3f, misfit, normal.misfit);
        wh_normal_factor(&normal);
        wh_normal_solve(&normal);
        const wh_real *x = normal.right;
        for (unsigned k = 0; k < N; k++) {
            wh_real left = x[k] - guess[k];
            for (unsigned j = 0; j < rows; j++) {
                wh_real sum = -off[j];
                for (unsigned m = 0; m < N; m++) {
                    sum += row[j][m] * x[m];
                }
                left += weight[j] * row[j][k] * sum;
            }
            CHECK_NEAR(1e-3f, 0.0f, left);
        }
    }
}

/* The square of an unknown's deviation is the unknown's component of the solution for the unit vector, for measurements
 * of small and large weight. */
TEST(rig_parts, a_deviation_is_the_inverses_diagonal) {
    seed = 14;
    for (unsigned i = 0; i < 100U; i++) {
        const wh_real zero[N] = {WH_R(0.0)};
        wh_normal normal;
        wh_normal_start(&normal, zero);
        const unsigned rows = draw_one_of(&seed, 12);
        for (unsigned j = 0; j < rows; j++) {
            wh_real row[N];
            for (unsigned k = 0; k < N; k++) {
                row[k] = draw_broken(&seed, -1, 1);
            }
            wh_normal_add(&normal, row, WH_R(0.0), draw_between(&seed, WH_R(0.1), WH_R(20.0)));
        }
        wh_normal_factor(&normal);
        for (unsigned which = 0; which < N; which++) {
            for (unsigned k = 0; k < N; k++) {
                normal.right[k] = k == which ? WH_R(1.0) : WH_R(0.0);
            }
            wh_normal_solve(&normal);
            const wh_real deviation = wh_normal_deviation(&normal, which);
            CHECK_NEAR(1e-4f, normal.right[which], deviation * deviation);
        }
    }
}

/* With the motor off, a rotor is at most as fast as its mean over the last interval without drive. Such an interval
 * must have begun after the switch-off. */
TEST(rig_parts, last_interval_bounds_coasting_speed) {
    seed = 5;
    for (unsigned i = 0; i < 600U; i++) {
        const wh_real speed = draw_between(&seed, WH_R(5.0), WH_R(40.0));
        const uint32_t quarter =
            (uint32_t)(WH_R(0.25) * TURN / speed * (wh_real)WH_RIG_TICKS_PER_S);
        const unsigned sensor = draw_one_of(&seed, 2);
        const uint32_t last = (uint32_t)draw_bits(&seed) * 2U;
        const uint32_t next = last + (sensor == 1U ? quarter : 3U * quarter);
        wh_pulses pulses;
        wh_pulses_start(&pulses, wh_rig_standard.impossible_radps);
        wh_pulses_take(&pulses, 1U - sensor, last);
        const int32_t after = i % 3U == 0 ? 0 : (int32_t)draw_whole(&seed, -3, 3) * (int32_t)i;
        const wh_real before_radps = draw_between(&seed, WH_R(1.0), WH_R(60.0));
        wh_run run = {.phase = WH_PHASE_OFF,
                      .off_radps = before_radps,
                      .since_ticks = last + (uint32_t)after};
        wh_pulse_window_off(&run, &pulses, false, sensor, next);
        const wh_real wanted = after <= 0 && speed < before_radps ? speed : before_radps;
        CHECK_NEAR(2e-3f * (float)wanted, wanted, run.off_radps);
    }
}

TEST(rig_parts, doubt_counter) {
    unsigned grown = 0;
    unsigned shrunk = 0;
    seed = 6;
    for (unsigned run = 0; run < 100U; run++) {
        wh_pulses pulses;
        wh_pulses_start(&pulses, wh_rig_standard.impossible_radps);
        uint32_t ticks = (uint32_t)draw_bits(&seed) * 2U;
        unsigned due = 0;
        for (unsigned i = 0; i < 200U; i++) {
            unsigned sensor = due;
            if (draw_one_in(&seed, 8)) { /* a false pulse */
                ticks += 1000U + draw_one_of(&seed, 40000);
                sensor = draw_one_of(&seed, 2);
            } else {
                ticks += due == 1U ? 45000U : 135000U;
                due = 1U - due;
            }
            const unsigned doubt = pulses.doubt;
            const uint32_t rejected = pulses.rejected;
            wh_pulses_take(&pulses, sensor, ticks);
            const unsigned less = doubt > 0 ? doubt - 1U : 0U;
            if (pulses.doubt != doubt) {
                TEST_ASSERT_TRUE(pulses.doubt == less || pulses.doubt == doubt + 2U);
                grown += pulses.doubt > doubt ? 1U : 0U;
                shrunk += pulses.doubt < doubt ? 1U : 0U;
                TEST_ASSERT_TRUE(pulses.doubt < doubt || pulses.rejected == rejected + 1U);
            }
        }
    }
    TEST_ASSERT_TRUE(grown > 100U && shrunk > 100U);
}

/* Before a speed is known, a pulse that comes too early is a suspect. Any other pulse is accepted. */
TEST(rig_parts, early_second_pulse_is_suspected) {
    seed = 9;
    for (unsigned i = 0; i < 500U; i++) {
        const unsigned sensor = draw_one_of(&seed, 2);
        const wh_real part = sensor == 0 ? WH_R(0.25) : WH_R(0.75);
        const wh_real bound_radps = draw_between(&seed, WH_R(10.0), WH_R(30.0));
        const wh_real times = draw_between(&seed, WH_R(0.5), WH_R(1.5));
        const wh_real passed_s = part * TURN / (bound_radps * times);
        const uint32_t ticks = (uint32_t)draw_bits(&seed) * 2U;
        wh_pulses pulses;
        wh_pulses_start(&pulses, wh_rig_standard.impossible_radps);
        pulses.bound_radps = bound_radps;
        wh_pulses_take(&pulses, sensor, ticks);
        TEST_ASSERT_FALSE(pulses.suspects);
        wh_pulses_take(&pulses, 1U - sensor,
                       ticks + (uint32_t)(passed_s * (wh_real)WH_RIG_TICKS_PER_S));
        TEST_ASSERT_TRUE(WH_ABS(times - WH_R(1.0)) < WH_R(0.01) ||
                         pulses.suspects == (times > WH_R(1.0)));
    }
}

/* The drift of a record is measured from the first turn that counts to the last one, whichever turns between them are
 * not used. */
TEST(rig_parts, first_and_last_counted_turn) {
    const wh_result_config *config = &wh_rig_standard.measure.result;
    const wh_rotor_config *rotor = &wh_rig_standard.measure.rotor;
    wh_turn_angle angle;
    wh_turn_angle_start(rotor, &angle);
    wh_turn_angle_shape(rotor, &angle, WH_R(30.0));
    seed = 7;
    for (unsigned run = 0; run < 100U; run++) {
        wh_merge merge = {.turns = 0};
        uint32_t first = 0;
        uint32_t last = 0;
        uint32_t counted = 0;
        wh_lockin_turn turn = {.begin_ticks = (uint32_t)draw_bits(&seed) * 2U};
        for (unsigned i = 0; i < 12U; i++) {
            turn.turn_ticks = 200000U + draw_one_of(&seed, 1000);
            turn.fault = draw_one_in(&seed, 3) ? WH_TURN_GAP : WH_TURN_OK;
            turn.force_N.at[1] = draw_between(&seed, WH_R(40.0), WH_R(44.0));
            wh_merge_add(config, rotor, &merge, &turn, &angle);
            if (turn.fault == WH_TURN_OK) {
                first = counted++ == 0 ? turn.turn_ticks : first;
                last = turn.turn_ticks;
            }
            TEST_ASSERT_EQUAL_UINT32(counted, merge.turns);
            TEST_ASSERT_TRUE(counted == 0 || merge.first_ticks == first);
            TEST_ASSERT_TRUE(counted == 0 || merge.last_ticks == last);
            turn.begin_ticks += turn.turn_ticks;
        }
    }
}

/* A quantity exactly at its limit is accepted, and the next number beyond is refused. The other quantities have nominal
 * values. */
TEST(rig_parts, limits_of_a_verdict_are_allowed) {
    wh_result_config config = wh_rig_standard.measure.result;
    config.amplitude_wrong = WH_R(0.25); /* so that products with 64 N are exact */
    config.amplitude_off = WH_R(0.0625);
    config.residual_large = WH_R(0.25);
    config.mean_off = WH_R(0.125);
    config.inertia_off = WH_R(0.5);
    wh_rotor_config rotor = wh_rig_standard.measure.rotor;
    rotor.inertia_kgm2 = WH_R(0.25);
    /* Without ripple, the expected second order is zero. */
    const wh_turn_angle level = {.whole_rad = WH_R(0.0)};
    const wh_merge merge = {.samples = 1000, .ripple_rad = WH_R(0.01), .second_turns = 12};
    const wh_measured right = {.turns = 12,
                               .amplitude_N = WH_R(64.0),
                               .expected_N = WH_R(64.0),
                               .inertia_kgm2 = WH_R(0.25)};
    const wh_real above = WH_R(1.0) + WH_R(0x1p-20);
    for (unsigned beyond = 0; beyond < 2U; beyond++) {
        const wh_real by = beyond > 0 ? above : WH_R(1.0);
        struct {
            wh_measured measured;
            wh_why why;
        } rows[] = {
            {right, WH_WHY_AMPLITUDE}, {right, WH_WHY_PHASE},         {right, WH_WHY_UNSURE},
            {right, WH_WHY_UNSURE},    {right, WH_WHY_AMPLITUDE_OFF}, {right, WH_WHY_PHASE_OFF},
            {right, WH_WHY_LEFT_OUT},  {right, WH_WHY_OUTLIERS},      {right, WH_WHY_RESIDUAL},
            {right, WH_WHY_ROTOR},     {right, WH_WHY_MEAN},          {right, WH_WHY_WIDE},
            {right, WH_WHY_FEW_TURNS}, {right, WH_WHY_POLARITY}};
        rows[0].measured.amplitude_N = WH_R(64.0) + WH_R(16.0) * by;
        rows[1].measured.phase_rad = config.phase_wrong_rad * by;
        rows[2].measured.amplitude_half_N = WH_R(16.0) * by;
        rows[3].measured.phase_half_rad = WH_R(0.25) * by;
        rows[4].measured.amplitude_N = WH_R(64.0) - WH_R(4.0) * by;
        rows[5].measured.phase_rad = -config.phase_off_rad * by;
        rows[6].measured.left_out = 4U + beyond;
        rows[7].measured.outliers = 10U + beyond;
        rows[8].measured.residual_N = WH_R(16.0) * by;
        rows[9].measured.inertia_kgm2 = WH_R(0.375) * by;
        rows[10].measured.mean_N = WH_R(-8.0) * by;
        rows[11].measured.amplitude_half_N = WH_R(0.05) * rows[11].measured.amplitude_N * by;
        rows[12].measured.turns = 3U - beyond;
        rows[13].measured.phase_rad = WH_R(-0.5) * WH_R(3.141592653589793) * by;
        for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
            wh_merge_compare(&rotor, &merge, &level, &rows[i].measured);
            wh_merge_judge(&config, &rotor, &merge, &level, &rows[i].measured);
            TEST_ASSERT_TRUE((rows[i].measured.why == rows[i].why) == (beyond > 0));
        }
    }
}

/* The last pass decides on the outcome of a swing. It needs enough half swings, at most a quarter of them impossible,
 * passages of sensor 2, and a narrow interval. */
TEST(rig_parts, verdict_of_a_swing) {
    const wh_rotor_config *rotor = &wh_rig_standard.measure.rotor;
    unsigned times[WH_SWING_WHYS] = {0};
    seed = 8;
    for (unsigned i = 0; i < 2000U; i++) {
        wh_swing_config config = wh_rig_standard.swing;
        const wh_real zero[N] = {WH_R(0.0)};
        wh_swing swing = {.result = {.why = WH_SWING_WORKS}, .piece = WH_SWING_ENDS};
        /* Without a measurement, the deviations are those of the guess. */
        wh_normal_start(&swing.normal, zero);
        swing.fits = 8U + draw_one_of(&seed, 20);
        swing.strays = draw_one_of(&seed, 2) * (swing.fits / 4U + draw_one_of(&seed, 2));
        swing.fits_of[1] = draw_one_of(&seed, 3);
        swing.fits_of[0] = config.swings_least - 1U + draw_one_of(&seed, 3);
        const bool wide = draw_one_in(&seed, 2);
        swing.within[WH_SWING_PLACE] = config.wide_rad * (wide ? WH_R(0.52) : WH_R(0.4));
        swing.within[WH_SWING_PLACE + 1] = config.wide_rad;
        swing.x[WH_SWING_PLACE] = draw_broken(&seed, -1, 1);
        swing.x[WH_SWING_PLACE + 1] = draw_broken(&seed, -1, 1);
        wh_swing_step(&config, rotor, &swing, false, true);
        const wh_swing_why wanted = swing.strays * 4U > swing.fits           ? WH_SWING_MISFIT
                                    : swing.fits_of[0] < config.swings_least ? WH_SWING_FEW
                                    : swing.fits_of[1] == 0                  ? WH_SWING_SIDES
                                    : wide                                   ? WH_SWING_WIDE
                                                                             : WH_SWING_FOUND;
        TEST_ASSERT_TRUE(swing.result.why == wanted);
        TEST_ASSERT_EQUAL_UINT(swing.fits_of[0], swing.result.swings);
        for (unsigned k = 0; k < WH_RIG_SENSORS;
             k++) { /* without misfit, the factor of the normal distribution */
            const wh_real deviation = WH_R(1.96) * swing.within[WH_SWING_PLACE + k];
            const wh_real half =
                WH_SQRT(deviation * deviation + config.floor_rad * config.floor_rad);
            CHECK_NEAR(1e-5f * (float)half, half, swing.result.half_rad[k]);
            TEST_ASSERT_TRUE(swing.result.place_rad[k] == swing.x[WH_SWING_PLACE + k]);
        }
        times[wanted]++;
    }
    TEST_ASSERT_TRUE(times[WH_SWING_MISFIT] > 50U && times[WH_SWING_FEW] > 50U);
    TEST_ASSERT_TRUE(times[WH_SWING_SIDES] > 50U && times[WH_SWING_WIDE] > 50U);
    TEST_ASSERT_TRUE(times[WH_SWING_FOUND] > 50U);
}
