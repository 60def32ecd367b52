/* test_rig_swing_pulses.c: the stored pulses of a swing, the first guess, the work per control step, and steps in which
 * the rotor reverses. The references are the drawn sequence of pulses, the rotor (rotor.c) and many small steps. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/free_swing.h"
#include "core/rig/rig.h"
#include "core/root.h"
#include "draw.h"
#include "rotor.h"

#include "tests/suites.h"

static uint64_t seed;
static wh_swing swing;

static bool near(wh_real found, wh_real wanted, wh_real most) {
    return WH_ABS(found - wanted) <= most;
}

/* The pulses of a rotor that turns and then swings, in order. `first` is the index of the first pulse that passes
 * sensor 1 backwards. `passed` counts the passages of sensor 1 from then on. */
#define STORY_MOST 120U
typedef struct story {
    uint32_t ticks[STORY_MOST];
    uint8_t sensor[STORY_MOST];
    unsigned pulses;
    unsigned first;
    unsigned passed;
} story;

static void tell(story *of, unsigned sensor) {
    const uint32_t before = of->pulses > 0 ? of->ticks[of->pulses - 1U]
                                           : UINT32_MAX - 2000000U + draw_one_of(&seed, 60000);
    of->sensor[of->pulses] = (uint8_t)sensor;
    of->ticks[of->pulses++] = before + 40000U + draw_one_of(&seed, 60000);
}

/* Draws the pulses: full turns, then swings. Each swing passes sensor 1; while it is wide enough, it also passes sensor
 * 2 and returns. */
static void draw_story(story *of, unsigned turns) {
    *of = (story){.pulses = 0};
    for (unsigned i = 0; i < turns; i++) {
        tell(of, 0);
        tell(of, 1);
    }
    const unsigned swings = 1U + draw_one_of(&seed, 12);
    unsigned wide = draw_one_of(&seed, 4);
    for (unsigned i = 0; i < swings; i++) {
        tell(of, 0);
        of->passed += i > 0 ? 1U : 0U;
        if (wide > 0) {
            wide--;
            tell(of, 1);
            tell(of, 1);
        }
        tell(of, 0);
        of->first = i == 0 ? of->pulses - 1U : of->first;
        of->passed++;
    }
}

static void give(const story *of, unsigned lost) {
    const wh_rig_config *config = &wh_rig_standard;
    swing = (wh_swing){.free = false};
    wh_swing_step(&config->swing, &config->measure.rotor, &swing, true, false);
    for (unsigned i = 0; i < of->pulses; i++) {
        if (i != lost) {
            wh_swing_pulse(&swing, of->sensor[i], of->ticks[i]);
        }
    }
}

/* Checks the stored pulses: the last ones before the first return, the first return, as many later ones as there is
 * room for, and the last pulses of sensor 1. */
static void check_kept(const story *of) {
    const unsigned turning = of->first < WH_SWING_TURNING ? of->first : WH_SWING_TURNING;
    const unsigned from = of->first - turning;
    const unsigned all = of->pulses - from;
    TEST_ASSERT_TRUE(swing.swings);
    TEST_ASSERT_EQUAL_UINT(turning, swing.first);
    TEST_ASSERT_EQUAL_UINT(of->passed, swing.passed);
    TEST_ASSERT_EQUAL_UINT(all < WH_SWING_PULSES ? all : WH_SWING_PULSES, swing.kept);
    for (unsigned i = 0; i < swing.kept; i++) {
        TEST_ASSERT_EQUAL_UINT32(of->ticks[from + i], swing.kept_ticks[i]);
        TEST_ASSERT_EQUAL_UINT(of->sensor[from + i], swing.kept_sensor[i]);
    }
    unsigned last = 0;
    for (unsigned i = of->pulses; i-- > of->first && last < WH_SWING_LAST;) {
        if (of->sensor[i] == 0) {
            TEST_ASSERT_EQUAL_UINT32(of->ticks[i], swing.last_ticks[last++]);
        }
    }
}

TEST(rig_swing_pulses, stored_pulses_of_a_swing) {
    static story told;
    seed = 1;
    for (unsigned i = 0; i < 300U; i++) {
        draw_story(&told, draw_one_of(&seed, 20));
        give(&told, STORY_MOST);
        check_kept(&told);
    }
}

/* If a pulse is lost while the rotor still turns, this looks like the first return. Later turns correct it: the stored
 * swing is the same. */
TEST(rig_swing_pulses, early_lost_pulse_changes_no_swing) {
    static story told;
    seed = 2;
    for (unsigned i = 0; i < 300U; i++) {
        draw_story(&told, 8U + draw_one_of(&seed, 16));
        give(&told, 1U + draw_one_of(&seed, told.first - WH_SWING_TURNING - 6U));
        check_kept(&told);
    }
}

/* A rotor with open motor leads turns some more times, and swings until it rests. Returns its speed when it first
 * returns past sensor 1. */
static wh_real swing_out(const rotor_kind *kind) {
    const wh_rig_config *config = &wh_rig_standard;
    const wh_real over_radps = WH_R(2.0) * WH_SQRT(kind->weight_Nm / kind->inertia_kgm2);
    rotor_state state = {.ticks = UINT32_MAX - 3000000U,
                         .seed = seed,
                         .speed_radps = over_radps * draw_between(&seed, WH_R(1.15), WH_R(1.4))};
    uint32_t quiet = 0;
    wh_real first_radps = WH_R(0.0);
    swing = (wh_swing){.free = false};
    wh_swing_step(&config->swing, &config->measure.rotor, &swing, true, false);
    while (quiet < 1500000U) {
        rotor_turn(kind, &state, WH_R(0.0), 2000U);
        quiet += 2000U;
        for (unsigned i = 0; i < state.pulses; i++) {
            quiet = 0;
            wh_swing_pulse(&swing, state.pulse_sensor[i], state.pulse_ticks[i]);
            first_radps = swing.swings && swing.passed == 1U && state.pulse_sensor[i] == 0
                              ? state.speed_radps
                              : first_radps;
        }
    }
    return first_radps;
}

/* The guess has the rate at the first return, and gravity and friction divided by the inertia. Each error is within the
 * stated uncertainty; the first two errors are within some 10 %. */
TEST(rig_swing_pulses, guess_is_within_its_uncertainty) {
    unsigned told = 0;
    unsigned near_it = 0;
    seed = 3;
    for (unsigned i = 0; i < draw_cases(60); i++) {
        rotor_kind kind = rotor_nominal();
        kind.stall_Nm = WH_R(0.0);
        kind.slot_rad = WH_R(2.0) / WH_RIG_DEG_PER_RAD;
        kind.inertia_kgm2 *= draw_between(&seed, WH_R(0.5), WH_R(2.0));
        kind.drag_Nms = draw_between(&seed, WH_R(0.0), WH_R(0.001));
        kind.friction_Nm = draw_between(&seed, WH_R(0.002), WH_R(0.05));
        const wh_real first_radps = swing_out(&kind);
        if (!swing.swings || swing.passed < 4U) {
            continue;
        }
        told++;
        wh_swing_guess(&wh_rig_standard.swing, &swing);
        const wh_real gravity = kind.weight_Nm / kind.inertia_kgm2;
        const wh_real friction = kind.friction_Nm / kind.inertia_kgm2;
        const wh_real truth[] = {first_radps, gravity, friction};
        for (unsigned k = 0; k < 3U; k++) {
            const unsigned at = WH_FREE_RATE + k;
            TEST_ASSERT_TRUE(WH_ABS(swing.guess[at] - truth[k]) <= swing.within[at]);
            TEST_ASSERT_TRUE(swing.x[at] == swing.guess[at]);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.2f * (float)gravity, (float)gravity,
                                 (float)swing.guess[WH_FREE_GRAVITY]);
        near_it += near(swing.guess[WH_FREE_GRAVITY], gravity, WH_R(0.1) * gravity) ? 1U : 0U;
        TEST_ASSERT_FLOAT_WITHIN(-0.08f * (float)first_radps, (float)first_radps,
                                 (float)swing.guess[WH_FREE_RATE]);
    }
    TEST_ASSERT_TRUE(told * 2U > draw_cases(60) && near_it * 10U > told * 7U);
}

/* Reference: returns the duration of half a swing divided by that of a small one, 2/pi K(k), by the
 * arithmetic-geometric mean; k2 is k^2. */
static wh_real longer_by(wh_real k2) {
    wh_real a = WH_R(1.0);
    wh_real b = WH_SQRT(WH_R(1.0) - k2);
    for (unsigned i = 0; i < 8U; i++) {
        const wh_real mean = WH_R(0.5) * (a + b);
        b = WH_SQRT(a * b);
        a = mean;
    }
    return WH_R(1.0) / a;
}

/* The first swing has any amplitude almost up to the top, the others are small. The duration of the first swing alone
 * must give its amplitude. */
TEST(rig_swing_pulses, first_amplitude_from_its_duration) {
    seed = 6;
    for (unsigned i = 0; i < 300U; i++) {
        const wh_real near_top = draw_between(&seed, WH_R(0.03), WH_R(0.2));
        const wh_real sine = i % 2U == 0 ? draw_between(&seed, WH_R(0.42), WH_R(0.96))
                                         : WH_R(1.0) - near_top * near_top;
        /* The table has eight points, with linear interpolation. */
        const wh_real part = sine > WH_R(0.96)   ? WH_R(0.009)
                             : sine > WH_R(0.55) ? WH_R(0.017)
                                                 : WH_R(0.045);
        const wh_real root = draw_between(&seed, WH_R(5.0), WH_R(10.0));
        const wh_real half_s = WH_R(0.5) * WH_RIG_TWO_PI / root;
        swing = (wh_swing){.swings = true, .passed = 20, .kept = 20};
        wh_real passed_s = WH_R(0.0);
        const uint32_t begin = (uint32_t)draw_bits(&seed) * 2U;
        for (unsigned k = 0; k < 20U; k++) {
            swing.kept_ticks[k] = begin + (uint32_t)(passed_s * (wh_real)WH_RIG_TICKS_PER_S);
            passed_s += k == 0 ? half_s * longer_by(sine * sine) : half_s;
        }
        for (unsigned k = 0; k < WH_SWING_LAST; k++) {
            swing.last_ticks[k] = swing.kept_ticks[19U - k];
        }
        wh_swing_guess(&wh_rig_standard.swing, &swing);
        const wh_real wanted_radps = WH_R(-2.0) * root * sine;
        TEST_ASSERT_FLOAT_WITHIN((float)(-part * wanted_radps), (float)wanted_radps,
                                 (float)swing.guess[WH_FREE_RATE]);
    }
}

/* Maximum number of steps of the equation of motion in one control step. */
#define EQUATION_STEPS 3
#define EQUATION_TICKS 8000

/* Returns, as bits, the pieces of work that may follow this piece. */
static unsigned may_follow(wh_swing_piece piece) {
    switch (piece) {
    case WH_SWING_GOES: return 1U << WH_SWING_GOES | 1U << WH_SWING_FACTORS;
    case WH_SWING_FACTORS: return 1U << WH_SWING_SOLVES;
    case WH_SWING_SOLVES:
        return 1U << WH_SWING_PASSES | 1U << WH_SWING_GUESSES | 1U << WH_SWING_ENDS;
    case WH_SWING_PASSES: return 1U << WH_SWING_GOES;
    case WH_SWING_GUESSES: return 1U << WH_SWING_PASSES;
    case WH_SWING_ENDS: return 1U << WH_SWING_ENDS;
    }
    return 0;
}

/* Also checks that a piece integrates the equation of motion over at most EQUATION_STEPS steps. */
TEST(rig_swing_pulses, control_steps_share_the_work) {
    const wh_rig_config *config = &wh_rig_standard;
    unsigned times[WH_SWING_ENDS + 1] = {0};
    seed = 5;
    for (unsigned i = 0; i < 4U; i++) {
        rotor_kind kind = rotor_nominal();
        kind.stall_Nm = WH_R(0.0);
        kind.slot_rad = WH_R(2.0) / WH_RIG_DEG_PER_RAD;
        kind.inertia_kgm2 *= draw_between(&seed, WH_R(0.5), WH_R(2.0));
        kind.friction_Nm = draw_between(&seed, WH_R(0.01), WH_R(0.03));
        (void)swing_out(&kind);
        wh_swing_step(&config->swing, &config->measure.rotor, &swing, false, true);
        for (uint32_t k = 0; k < 100000U && wh_swing_works(&swing); k++) {
            const wh_swing_piece piece = swing.piece;
            const uint32_t ticks = swing.ticks;
            const unsigned at = swing.at;
            wh_swing_step(&config->swing, &config->measure.rotor, &swing, false, true);
            times[piece]++;
            TEST_ASSERT_TRUE((may_follow(piece) >> swing.piece & 1U) != 0);
            if (piece == WH_SWING_PASSES) {
                /* Each pass starts at the first passage and integrates to the next pulse. */
                TEST_ASSERT_TRUE(swing.at == swing.first + 1U);
                TEST_ASSERT_TRUE(swing.ticks == swing.kept_ticks[swing.first]);
            }
            if (piece == WH_SWING_GOES && swing.at == at && swing.piece == piece) {
                const int32_t moved = (int32_t)(swing.ticks - ticks);
                TEST_ASSERT_TRUE(moved <= EQUATION_STEPS * EQUATION_TICKS &&
                                 moved >= -EQUATION_STEPS * EQUATION_TICKS);
            }
        }
        TEST_ASSERT_TRUE(swing.result.why >= WH_SWING_FOUND);
    }
    for (unsigned k = 0; k <= WH_SWING_ENDS; k++) {
        TEST_ASSERT_TRUE(times[k] >= 4U);
    }
}

/* Steps in which the rotor reverses, or in which friction keeps it at rest. Each step and its derivatives are compared
 * with many small steps, in both directions. */
TEST(rig_swing_pulses, reversing_step_equals_small_steps) {
    const unsigned pieces = 64U;
    const wh_real most[WH_FREE_CAUSES] = {WH_R(2e-3), WH_R(5e-3), WH_R(1e-4), WH_R(2e-4),
                                          WH_R(1e-3)};
    unsigned turned = 0;
    unsigned held = 0;
    seed = 4;
    for (unsigned i = 0; i < 400U; i++) {
        const wh_real h = i % 2U == 0 ? WH_R(0.004) : WH_R(-0.004);
        const wh_real way = i % 4U < 2U ? WH_R(1.0) : WH_R(-1.0);
        const wh_real cause[WH_FREE_CAUSES] = {way * draw_between(&seed, WH_R(0.0), WH_R(1.5)),
                                               way * h * draw_between(&seed, WH_R(2.0), WH_R(30.0)),
                                               draw_between(&seed, WH_R(40.0), WH_R(80.0)),
                                               draw_between(&seed, WH_R(0.0), WH_R(24.0)),
                                               draw_between(&seed, WH_R(0.0), WH_R(0.5))};
        wh_free_rotor one;
        wh_free_rotor many;
        wh_free_rotor_start(&one, cause[WH_FREE_Q], cause[WH_FREE_RATE]);
        many = one;
        wh_free_rotor_step(cause, &one, h);
        for (unsigned k = 0; k < pieces; k++) {
            wh_free_rotor_step(cause, &many, h / (wh_real)pieces);
        }
        turned += one.rate_radps * cause[WH_FREE_RATE] < WH_R(0.0) ? 1U : 0U;
        const bool holds = WH_ABS(one.rate_radps) < WH_R(1e-6);
        held += holds ? 1U : 0U;
        TEST_ASSERT_TRUE(near(one.q_rad, many.q_rad, WH_R(1e-3)));
        TEST_ASSERT_TRUE(near(one.rate_radps, many.rate_radps, WH_R(1e-3)));
        for (unsigned k = 0; k < WH_FREE_CAUSES; k++) {
            const bool same = near(one.rate_by[k], many.rate_by[k], most[k]);
            /* Near the limit at which friction holds the rotor, the last bit decides. */
            TEST_ASSERT_TRUE(same || (holds && WH_ABS(many.rate_radps) < WH_R(1e-3)));
        }
    }
    TEST_ASSERT_TRUE(turned > 100U && held > 10U);
}
