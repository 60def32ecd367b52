/* test_lockin_late.c: the lock-in's result does not depend on the delay of samples, on the begin of a turn between
 * samples, or on earlier data. */
#include "core/angle.h"
#include "core/rig/lockin.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "draw.h"

#include "tests/suites.h"

#define PERIOD_TICKS UINT32_C(2000)
#define TURN_TICKS UINT32_C(181818) /* 330 rpm */
#define TURNS 5U

static uint64_t seed;
static wh_rotor_config rotor;
static const wh_cell_config cell = {
    .newton_per_count = WH_R(0.01), .period_ticks = PERIOD_TICKS, .raw_max = INT32_C(32767)};
static wh_lockin lockin;
static wh_lockin fresh;

/* Samples of a rotor with constant speed. Turn 0 begins `lead` samples after the first sample, or before it if `lead`
 * is negative. */
typedef struct stream {
    uint32_t ticks; /* time of the first sample */
    int lead;
    int32_t behind_ticks; /* the turn begins this long before that sample */
    wh_real mean_N;
    wh_real cosine_N;
    wh_real sine_N;
    wh_real ripple_N; /* amplitude of the third order */
    /* Number of steps without samples, after which all waiting samples come at once. */
    unsigned held;
    unsigned hold_more; /* one of this many steps begins a delay of up to 12 steps; 0: none */
} stream;

static stream draw_stream(void) {
    return (stream){.ticks = (uint32_t)draw_bits(&seed) * 2U,
                    .lead = (int)draw_one_of(&seed, 30),
                    .behind_ticks = 777,
                    .mean_N = draw_broken(&seed, -60, 60),
                    .cosine_N = draw_broken(&seed, -40, 40),
                    .sine_N = draw_broken(&seed, -40, 40),
                    .ripple_N = draw_broken(&seed, -1, 1)};
}

static wh_real load_of(const stream *from, int32_t since_pulse) {
    const wh_real turns = (wh_real)since_pulse / (wh_real)TURN_TICKS;
    wh_real third;
    wh_real unused;
    const wh_wave wave = wh_wave_of(WH_RIG_TWO_PI * turns);
    wh_sincos(wh_phase_from_rad(WH_R(3.0) * WH_RIG_TWO_PI * turns), &third, &unused);
    return from->mean_N + from->cosine_N * wave.cosine + from->sine_N * wave.sine +
           from->ripple_N * third;
}

/* Runs control steps. Returns the number of finished turns, at most TURNS. */
static unsigned play(const stream *from, wh_lockin *to, unsigned steps, wh_lockin_turn *turns) {
    /* as in the rig, a step without samples does more work */
    const unsigned halves = from->held + from->hold_more == 0 ? WH_LOCKIN_HALVES_AT_ONCE
                                                              : WH_LOCKIN_HALVES_AT_ONCE + 1U;
    const int32_t pulse = (int32_t)from->lead * (int32_t)PERIOD_TICKS - from->behind_ticks;
    unsigned done = 0;
    unsigned given = 0;
    unsigned hold = from->held;
    uint32_t quarter = 0;
    for (unsigned i = 0; i < steps; i++) {
        const int32_t now =
            ((int32_t)i + (from->lead < 0 ? from->lead : 0)) * (int32_t)PERIOD_TICKS;
        for (; now >= pulse + (int32_t)(quarter * (TURN_TICKS / 4U) + quarter / 4U * 2U);
             quarter++) {
            const uint32_t at =
                from->ticks + (uint32_t)pulse + quarter * (TURN_TICKS / 4U) + quarter / 4U * 2U;
            if (quarter % 4U < 2U) {
                wh_lockin_pulse(to, quarter % 4U, at, quarter);
            }
        }
        hold -= hold > 0 ? 1U : 0U;
        if (hold == 0 && from->hold_more > 0 && draw_one_in(&seed, from->hold_more)) {
            hold = 1U + draw_one_of(&seed, 12);
        }
        for (; hold == 0 && (int32_t)given * (int32_t)PERIOD_TICKS <= now; given++) {
            const int32_t since = (int32_t)given * (int32_t)PERIOD_TICKS;
            const wh_load load = {.ticks = from->ticks + (uint32_t)since,
                                  .force_N = load_of(from, since - pulse),
                                  .status = WH_LOAD_OK};
            wh_lockin_load(to, &load);
        }
        if (wh_lockin_work(&rotor, &cell, to, halves) && done < TURNS) {
            turns[done++] = to->turn;
        }
    }
    return done;
}

static void check_near(wh_real wanted, wh_real found, wh_real most) {
    TEST_ASSERT_TRUE(WH_ABS(wanted - found) <= most);
}

static void check_same(const wh_lockin_turn *wanted, const wh_lockin_turn *turn, wh_real most_N) {
    TEST_ASSERT_EQUAL_UINT32(wanted->begin_ticks, turn->begin_ticks);
    TEST_ASSERT_EQUAL_UINT32(wanted->turn_ticks, turn->turn_ticks);
    TEST_ASSERT_EQUAL_UINT(wanted->samples, turn->samples);
    TEST_ASSERT_EQUAL_UINT(wanted->outliers, turn->outliers);
    for (unsigned k = 0; k < WH_LOCKIN_ORDERS; k++) {
        check_near(wanted->force_N.at[k], turn->force_N.at[k], most_N);
    }
    check_near(wanted->mean_N, turn->mean_N, most_N);
    check_near(wanted->residual_N, turn->residual_N, most_N);
    for (unsigned k = 0; k < 2U; k++) {
        check_near(wanted->at_pulse_N[k], turn->at_pulse_N[k], most_N);
    }
}

static void begin(uint64_t from) {
    seed = from;
    rotor = wh_rig_standard.measure.rotor;
    rotor.gravity_mps2 = WH_R(0.0);
    rotor.pulse_rad[0] = WH_R(0.0);
    rotor.pulse_rad[1] = WH_R(0.25) * WH_RIG_TWO_PI;
}

/* Samples come late, one by one, in groups, or after the turn. Each turn has the same bits. */
TEST(lockin_late, late_samples_give_equal_bits) {
    static wh_lockin_turn wanted[TURNS];
    static wh_lockin_turn found[TURNS];
    begin(1);
    for (unsigned i = 0; i < 40U; i++) {
        stream from = draw_stream();
        const unsigned steps = 6U * (TURN_TICKS / PERIOD_TICKS + 1U) + 80U;
        lockin = (wh_lockin){0};
        wh_lockin_forget(&rotor, &lockin);
        TEST_ASSERT_EQUAL_UINT(TURNS, play(&from, &lockin, steps, wanted));
        from.held = draw_one_of(&seed, (unsigned)from.lead + 110U);
        from.hold_more = i % 2U == 0 ? 0U : 15U;
        lockin = (wh_lockin){0};
        wh_lockin_forget(&rotor, &lockin);
        TEST_ASSERT_EQUAL_UINT(TURNS, play(&from, &lockin, steps, found));
        for (unsigned k = 0; k < TURNS; k++) {
            check_same(&wanted[k], &found[k], WH_R(0.0));
            TEST_ASSERT_TRUE(wanted[k].fault == found[k].fault);
        }
    }
}

/* After a reset at any point the results are those from the start. Only the first turn differs: its duration has no
 * previous one for comparison. */
TEST(lockin_late, results_after_a_reset_are_equal) {
    static wh_lockin_turn wanted[TURNS];
    static wh_lockin_turn found[TURNS];
    begin(2);
    for (unsigned i = 0; i < 40U; i++) {
        const stream before = draw_stream();
        stream from = draw_stream();
        from.lead = (int)draw_one_of(&seed, 12) - 6;
        const unsigned steps = 6U * (TURN_TICKS / PERIOD_TICKS + 1U) + 80U;
        fresh = (wh_lockin){0};
        wh_lockin_forget(&rotor, &fresh);
        TEST_ASSERT_EQUAL_UINT(TURNS, play(&from, &fresh, steps, wanted));
        wh_lockin_forget(&rotor, &lockin);
        (void)play(&before, &lockin, draw_one_of(&seed, 500), found);
        const uint32_t refused = lockin.refused;
        wh_lockin_forget(&rotor, &lockin);
        TEST_ASSERT_EQUAL_UINT(TURNS, play(&from, &lockin, steps, found));
        TEST_ASSERT_EQUAL_UINT32(refused, lockin.refused);
        for (unsigned k = 0; k < TURNS; k++) {
            check_same(&wanted[k], &found[k], k == 0 ? WH_R(0.0) : WH_R(0.05));
            TEST_ASSERT_TRUE(k < 2U || wanted[k].fault == found[k].fault);
        }
    }
}

/* A turn whose begin, end or quarter is at or near a sample is as accurate as any other. */
TEST(lockin_late, pulses_may_fall_on_samples) {
    static wh_lockin_turn found[TURNS];
    begin(3);
    for (int32_t beside = -3; beside <= 3; beside++) {
        for (int32_t turn = 0; turn <= (int32_t)TURNS; turn++) {
            for (int32_t split = 0; split < 2; split++) {
                stream from = draw_stream();
                from.lead = 6;
                from.ripple_N = WH_R(0.0);
                const int32_t into =
                    turn * (int32_t)TURN_TICKS + split * (int32_t)(TURN_TICKS / 4U);
                from.behind_ticks = (into + beside) % (int32_t)PERIOD_TICKS;
                const unsigned steps = 6U * (TURN_TICKS / PERIOD_TICKS + 1U) + 80U;
                wh_lockin_forget(&rotor, &lockin);
                TEST_ASSERT_EQUAL_UINT(TURNS, play(&from, &lockin, steps, found));
                for (unsigned k = 2; k < TURNS; k++) {
                    TEST_ASSERT_TRUE(found[k].fault == WH_TURN_OK);
                    TEST_ASSERT_TRUE(found[k].samples >= 90U && found[k].samples <= 91U);
                    check_near(from.mean_N, found[k].force_N.at[0], WH_R(0.01));
                    check_near(from.cosine_N, found[k].force_N.at[1], WH_R(0.01));
                    check_near(from.sine_N, found[k].force_N.at[2], WH_R(0.01));
                    check_near(from.mean_N + from.cosine_N, found[k].at_pulse_N[0], WH_R(0.05));
                    check_near(from.mean_N + from.sine_N, found[k].at_pulse_N[1], WH_R(0.05));
                }
            }
        }
    }
}
