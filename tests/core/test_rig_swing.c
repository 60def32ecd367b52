/* test_rig_swing.c: sensor positions from the free swing of an imitated rotor (rotor.c) that comes to rest; also
 * refusals, false pulses, the equation of motion and the regression. */
#include "core/rig/free_swing.h"

#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "core/root.h"
#include "draw.h"
#include "even_rig.h"
#include "rotor.h"

#include "tests/suites.h"

#define DEG (WH_R(1.0) / WH_RIG_DEG_PER_RAD)
#define STEP_TICKS UINT32_C(2000)
#define REST_TICKS UINT32_C(1500000)

static wh_swing swing;
static uint64_t seed;

typedef struct drawn {
    rotor_kind kind;
    wh_real place_rad[2];
    unsigned lose; /* every nth pulse is lost; 0: none */
    unsigned add;  /* a false pulse comes after every nth pulse */
} drawn;

/* Passages of sensor 1 since the rotor began to swing, with the speed of each. */
#define PASSED_MOST 64U
static uint32_t passed_ticks[PASSED_MOST];
static wh_real passed_radps[PASSED_MOST];
static unsigned passed;

static drawn draw_rotor(wh_real friction_least_Nm, wh_real friction_most_Nm) {
    drawn rotor = {.kind = rotor_nominal()};
    rotor.kind.stall_Nm = WH_R(0.0);
    rotor.kind.inertia_kgm2 *= draw_between(&seed, WH_R(0.5), WH_R(2.0));
    rotor.kind.drag_Nms = draw_between(&seed, WH_R(0.0), WH_R(0.002));
    rotor.kind.friction_Nm = draw_between(&seed, friction_least_Nm, friction_most_Nm);
    rotor.kind.slot_rad = WH_R(2.0) * DEG;
    rotor.kind.jitter_s = WH_R(104e-6);
    for (unsigned i = 0; i < 2; i++) {
        rotor.place_rad[i] = draw_between(&seed, WH_R(-3.0), WH_R(3.0)) * DEG;
        rotor.kind.pulse_rad[i] += rotor.place_rad[i];
    }
    return rotor;
}

static wh_rig_config standard(void) {
    wh_rig_config config = wh_rig_standard;
    wh_rig_slots(&config, DEG);
    return config;
}

static void give(const wh_rig_config *config, const drawn *rotor, rotor_state *state,
                 unsigned *pulses, uint32_t *quiet_ticks) {
    rotor_turn(&rotor->kind, state, WH_R(0.0), STEP_TICKS);
    *quiet_ticks += STEP_TICKS;
    for (unsigned i = 0; i < state->pulses; i++) {
        *quiet_ticks = 0;
        ++*pulses;
        if (rotor->lose == 0 || *pulses % rotor->lose != 0) {
            wh_swing_pulse(&swing, state->pulse_sensor[i], state->pulse_ticks[i]);
        }
        if (swing.swings && state->pulse_sensor[i] == 0 && passed < PASSED_MOST) {
            passed_ticks[passed] = state->pulse_ticks[i];
            passed_radps[passed++] = WH_ABS(state->speed_radps);
        }
        if (rotor->add > 0 && *pulses % rotor->add == 0) {
            wh_swing_pulse(&swing, draw_one_of(&seed, 2), state->pulse_ticks[i] + 20000U);
        }
    }
    wh_swing_step(&config->swing, &config->measure.rotor, &swing, true, false);
}

/* Lets the rotor turn, then swing until it rests; evaluates the swing. */
static wh_swung swing_out(const wh_rig_config *config, const drawn *rotor, bool rests) {
    rotor_state state = {.ticks = UINT32_MAX - 3000000U,
                         .seed = seed,
                         .angle_rad = draw_between(&seed, WH_R(0.0), WH_RIG_TWO_PI),
                         .speed_radps = draw_between(&seed, WH_R(19.0), WH_R(24.0))};
    unsigned pulses = 0;
    uint32_t quiet = 0;
    swing = (wh_swing){.free = false};
    passed = 0;
    wh_swing_step(&config->swing, &config->measure.rotor, &swing, true, false);
    for (unsigned i = 0; i < 30000U && quiet < REST_TICKS; i++) {
        give(config, rotor, &state, &pulses, &quiet);
    }
    TEST_ASSERT_TRUE(quiet >= REST_TICKS);
    wh_swing_step(&config->swing, &config->measure.rotor, &swing, false, rests);
    unsigned pass = 0;
    wh_real soft_rad2 = WH_R(1.0);
    for (uint32_t i = 0; i < 100000U && wh_swing_works(&swing); i++) {
        wh_swing_step(&config->swing, &config->measure.rotor, &swing, false, rests);
        if (swing.piece == WH_SWING_GOES &&
            swing.pass != pass) { /* each pass gives the pulses more weight */
            TEST_ASSERT_TRUE(swing.pass == 0 || swing.soft_rad2 <= WH_R(0.5) * soft_rad2);
            pass = swing.pass;
            soft_rad2 = swing.soft_rad2;
        }
    }
    TEST_ASSERT_FALSE(wh_swing_works(&swing));
    return swing.result;
}

TEST(rig_swing, sensor_positions_of_random_rotors) {
    const wh_rig_config config = standard();
    const unsigned runs = 24;
    unsigned covered = 0;
    unsigned found = 0;
    seed = 1;
    for (unsigned i = 0; i < runs; i++) {
        const drawn rotor = draw_rotor(WH_R(0.005), WH_R(0.04));
        const wh_swung swung = swing_out(&config, &rotor, true);
        if (swung.why != WH_SWING_FOUND) {
            TEST_ASSERT_TRUE(swung.why >= WH_SWING_FEW);
            continue;
        }
        found++;
        const wh_real off = swung.place_rad[0] - rotor.place_rad[0];
        CHECK_NEAR(0.3f, 0.0f, off / DEG);
        TEST_ASSERT_TRUE(swung.half_rad[0] >= config.swing.floor_rad &&
                         swung.half_rad[0] <= config.swing.wide_rad);
        covered += WH_ABS(off) <= swung.half_rad[0] ? 1U : 0U;
        CHECK_NEAR(1.0f, 0.0f, (swung.place_rad[1] - rotor.place_rad[1]) / DEG);
    }
    TEST_ASSERT_TRUE(found * 10U >= runs * 8U);
    TEST_ASSERT_TRUE(covered * 20U >= found * 18U);
}

/* If pulses scatter more than configured, their scatter gives the variance, and their number the interval's width. */
TEST(rig_swing, rough_pulses_have_wide_intervals) {
    const wh_rig_config config = standard();
    unsigned covered = 0;
    unsigned told = 0;
    const unsigned runs = draw_cases(120);
    seed = 21;
    for (unsigned i = 0; i < runs; i++) {
        drawn rotor = draw_rotor(WH_R(0.02), WH_R(0.06));
        rotor.kind.jitter_s = WH_R(2e-3);
        const wh_swung swung = swing_out(&config, &rotor, true);
        const wh_real off = swung.place_rad[0] - rotor.place_rad[0];
        const bool tells = swung.why == WH_SWING_FOUND || swung.why == WH_SWING_WIDE;
        told += tells ? 1U : 0U;
        covered += tells && WH_ABS(off) <= swung.half_rad[0] ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(told * 3U >= runs && covered * 100U >= told * 90U);
}

/* If enough swings follow, a pass omits swings near the top. There the times depend steeply on the amplitude, so the
 * guess is uncertain. */
TEST(rig_swing, swings_near_the_top_are_omitted) {
    const wh_rig_config config = standard();
    unsigned near_top = 0;
    seed = 6;
    const unsigned runs = draw_cases(60);
    for (unsigned i = 0; i < runs; i++) {
        const drawn rotor = draw_rotor(WH_R(0.004), WH_R(0.012));
        const wh_swung swung = swing_out(&config, &rotor, true);
        const wh_real root = WH_SQRT(rotor.kind.weight_Nm / rotor.kind.inertia_kgm2);
        /* If this is 2, the rotor reaches the top. */
        const wh_real first = passed_radps[0] / root;
        if (first > WH_R(1.92) && first < WH_R(2.0) && passed > 20U && passed < PASSED_MOST) {
            near_top++; /* 147 degrees or more */
            unsigned at = 0;
            while (at < passed && passed_ticks[at] != swing.kept_ticks[swing.first]) {
                at++;
            }
            TEST_ASSERT_TRUE(at > 0 && at < passed);
            TEST_ASSERT_TRUE(passed_radps[at] < WH_R(1.92) * root);
            TEST_ASSERT_EQUAL_UINT(passed - at, swing.passed);
        }
        TEST_ASSERT_TRUE(swung.why >= WH_SWING_FOUND);
    }
    TEST_ASSERT_TRUE(near_top * 15U > runs);
}

/* A lost or false pulse is not used, or makes the swing invalid. It never changes a found position. */
TEST(rig_swing, false_pulses_change_no_position) {
    const wh_rig_config config = standard();
    unsigned found = 0;
    seed = 2;
    for (unsigned i = 0; i < 20U; i++) {
        drawn rotor = draw_rotor(WH_R(0.005), WH_R(0.03));
        rotor.lose = i % 2U == 0 ? 13U : 0U;
        rotor.add = i % 2U == 0 ? 0U : 17U;
        const wh_swung swung = swing_out(&config, &rotor, true);
        if (swung.why == WH_SWING_FOUND) {
            found++;
            CHECK_NEAR(0.3f, 0.0f, (swung.place_rad[0] - rotor.place_rad[0]) / DEG);
        }
    }
    TEST_ASSERT_TRUE(found > 0);
}

TEST(rig_swing, unfree_swings_are_refused) {
    wh_rig_config config = standard();
    seed = 3;
    for (unsigned i = 0; i < 5U; i++) {
        drawn rotor = draw_rotor(WH_R(0.15), WH_R(0.2)); /* a large friction */
        TEST_ASSERT_TRUE(swing_out(&config, &rotor, true).why == WH_SWING_FEW);
        rotor = draw_rotor(WH_R(0.01), WH_R(0.02));
        TEST_ASSERT_TRUE(swing_out(&config, &rotor, false).why == WH_SWING_NOT_FREE);
        rotor.kind.stall_Nm = WH_RIG_STALL_NM; /* shorted leads */
        TEST_ASSERT_TRUE(swing_out(&config, &rotor, true).why == WH_SWING_FEW);
    }
    const drawn rotor = draw_rotor(WH_R(0.01), WH_R(0.02));
    config.measure.rotor.gravity_mps2 = WH_R(0.0);
    TEST_ASSERT_TRUE(swing_out(&config, &rotor, true).why == WH_SWING_NOT_FREE);
}

/* For random pulses no position is found, and the work ends. */
TEST(rig_swing, random_pulses_give_no_position) {
    const wh_rig_config config = standard();
    uint32_t works = 0;
    seed = 4;
    for (unsigned i = 0; i < 100U; i++) {
        uint32_t ticks = (uint32_t)draw_bits(&seed);
        swing = (wh_swing){.free = false};
        wh_swing_step(&config.swing, &config.measure.rotor, &swing, true, false);
        const unsigned pulses = draw_one_of(&seed, 80);
        const bool fast = draw_one_in(&seed, 2);
        for (unsigned k = 0; k < pulses; k++) {
            ticks += fast ? draw_one_of(&seed, 3) : 20U * (uint32_t)draw_one_of(&seed, 65535);
            wh_swing_pulse(&swing, draw_one_in(&seed, 4) ? 1U : 0U, ticks);
        }
        wh_swing_step(&config.swing, &config.measure.rotor, &swing, false, true);
        for (uint32_t k = 0; k < 200000U && wh_swing_works(&swing); k++) {
            works++;
            wh_swing_step(&config.swing, &config.measure.rotor, &swing, false, true);
        }
        TEST_ASSERT_TRUE(swing.result.why > WH_SWING_FOUND);
    }
    TEST_ASSERT_TRUE(works > 0);
}

static even_rig even;

/* If so configured, a run ends with the motor off. A later `stop` keeps the enable off, and the rotor keeps
 * swinging. */
TEST(rig_swing, a_run_that_ends_in_a_swing_coasts) {
    for (unsigned swings = 0; swings < 2U; swings++) {
        even_arm(&even);
        even.config.stop_brakes = true;
        even.config.swings = swings != 0;
        even_obeys(&even, WH_EVENT_START, WH_RIG_NOMINAL_RPM * EVEN_RPM);
        even_go_on_until(&even, WH_PHASE_OFF);
        const wh_motor_way way = swings != 0 ? WH_MOTOR_COASTS : WH_MOTOR_BRAKES;
        TEST_ASSERT_TRUE(even.command.way == way);
        TEST_ASSERT_TRUE(even.rig.swing.result.why ==
                         (swings != 0 ? WH_SWING_SWINGS : WH_SWING_NONE));
        even_steps(&even, 10);
        even_obeys(&even, WH_EVENT_STOP, WH_R(0.0));
        TEST_ASSERT_TRUE(even.command.way == way);
        TEST_ASSERT_TRUE(even.rig.swing.result.why ==
                         (swings != 0 ? WH_SWING_SWINGS : WH_SWING_NONE));
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even));
    }
}

/* A sensor that is not at its configured position makes a good result doubtful, and changes nothing else. */
TEST(rig_swing, displaced_sensor_makes_results_doubtful) {
    const wh_rig_config config = standard();
    for (int deg10 = -30; deg10 <= 30; deg10++) {
        swing.result = (wh_swung){.why = WH_SWING_FOUND, .half_rad = {WH_R(0.25) * DEG}};
        swing.result.place_rad[0] = (wh_real)deg10 / WH_R(10.0) * DEG;
        wh_measured measured = {.quality = WH_GOOD, .turns = 10};
        wh_measured refused = {.quality = WH_REFUSED, .why = WH_WHY_PHASE, .turns = 10};
        wh_measured none = {.quality = WH_GOOD};
        wh_swing_doubt(&config.swing, &swing, &measured);
        wh_swing_doubt(&config.swing, &swing, &refused);
        wh_swing_doubt(&config.swing, &swing, &none);
        const bool off = deg10 > 5 || deg10 < -5;
        TEST_ASSERT_TRUE(measured.quality == (off ? WH_DOUBTFUL : WH_GOOD));
        TEST_ASSERT_TRUE(measured.why == (off ? WH_WHY_PLACE : WH_WHY_NONE));
        TEST_ASSERT_TRUE(refused.quality == WH_REFUSED && refused.why == WH_WHY_PHASE);
        TEST_ASSERT_TRUE(none.quality == WH_GOOD);
        swing.result.why = WH_SWING_WIDE;
        measured = (wh_measured){.quality = WH_GOOD, .turns = 10};
        wh_swing_doubt(&config.swing, &swing, &measured);
        TEST_ASSERT_TRUE(measured.quality == WH_GOOD);
    }
}

static wh_free_rotor go(const wh_real *cause, unsigned steps, wh_real h) {
    wh_free_rotor rotor;
    wh_free_rotor_start(&rotor, cause[WH_FREE_Q], cause[WH_FREE_RATE]);
    for (unsigned i = 0; i < steps; i++) {
        wh_free_rotor_step(cause, &rotor, h);
    }
    return rotor;
}

/* The derivatives with respect to each parameter equal difference quotients, forwards and backwards, through several
 * reversals. */
TEST(rig_swing, derivatives_equal_difference_quotients) {
    const wh_real little[WH_FREE_CAUSES] = {WH_R(1e-3), WH_R(1e-2), WH_R(3e-2), WH_R(1e-2),
                                            WH_R(3e-3)};
    for (unsigned way = 0; way < 2U; way++) {
        const wh_real h = way == 0 ? WH_R(0.004) : WH_R(-0.004);
        const wh_real cause[WH_FREE_CAUSES] = {WH_R(0.1), WH_R(-9.0), WH_R(50.0), WH_R(4.0),
                                               WH_R(0.2)};
        const unsigned steps = way == 0 ? 400U : 130U;
        const wh_free_rotor plain = go(cause, steps, h);
        for (unsigned i = 0; i < WH_FREE_CAUSES; i++) {
            wh_real more[WH_FREE_CAUSES];
            wh_real less[WH_FREE_CAUSES];
            for (unsigned k = 0; k < WH_FREE_CAUSES; k++) {
                more[k] = cause[k] + (k == i ? little[k] : WH_R(0.0));
                less[k] = cause[k] - (k == i ? little[k] : WH_R(0.0));
            }
            const wh_free_rotor up = go(more, steps, h);
            const wh_free_rotor down = go(less, steps, h);
            const wh_real q_by = (up.q_rad - down.q_rad) / (WH_R(2.0) * little[i]);
            const wh_real rate_by = (up.rate_radps - down.rate_radps) / (WH_R(2.0) * little[i]);
            const wh_real size = WH_ABS(plain.q_by[i]) + WH_ABS(plain.rate_by[i]) / WH_R(7.0);
            CHECK_NEAR(0.05f * (float)size, q_by, plain.q_by[i]);
            CHECK_NEAR(0.35f * (float)size, rate_by, plain.rate_by[i]);
        }
    }
}

/* Without viscous friction, the energy falls by the work of Coulomb friction; steps backwards restore it. */
TEST(rig_swing, steps_back_undo_steps) {
    const wh_real cause[WH_FREE_CAUSES] = {WH_R(0.0), WH_R(-11.0), WH_R(60.0), WH_R(5.0),
                                           WH_R(0.1)};
    wh_free_rotor rotor = go(cause, 500, WH_R(0.002));
    TEST_ASSERT_TRUE(WH_ABS(rotor.rate_radps) < WH_R(9.0));
    for (unsigned i = 0; i < 500; i++) {
        wh_free_rotor_step(cause, &rotor, WH_R(-0.002));
    }
    CHECK_NEAR(2e-2f, 0.0f, rotor.q_rad);
    CHECK_NEAR(2e-2f, -11.0f, rotor.rate_radps);
}
