/* test_rig_bounds.c: bounds in the rig's controller: work per control step, duration of the ramp, validity of the tare
 * with its limits included, and the name of the stage. */
#include "build/gen/scenes.h"
#include "core/rig/observer.h"
#include "draw.h"
#include "even_rig.h"

#include "tests/suites.h"

static even_rig even;
static uint64_t seed;

/* Arms the rig. If `trusted`, the observer trusts every pulse, otherwise none. */
static void arm(bool trusted) {
    even_arm(&even);
    wh_observer_config *observing = &even.config.observer;
    observing->scene = &rig_fixed;
    observing->trusted_rad = observing->lost_rad = trusted ? WH_R(3.2) : WH_R(0.0);
    observing->trusted_pulses = 1000000U;
    even.config.compensation_when = WH_COMPENSATION_ALWAYS;
    TEST_ASSERT_TRUE(wh_observer_start(observing, &even.rig.observer, even.inputs.now_ticks) ==
                     WH_OK);
}

/* As many confirmed pulses wait as there is room for. Each step processes one; the last waits for a step without a new
 * pulse. */
TEST(rig_bounds, last_pulse_waits_for_free_step) {
    static even_rig twin;
    even_reach(&even, WH_PHASE_SETTLE);
    while (even.rig.pulses.waits || even.rig.pulses.confirmed_count > 0) {
        even_step(&even); /* processes the confirmed pulse before the last */
    }
    twin = even;
    for (unsigned confirmed = 0; confirmed <= WH_PULSES_CONFIRMED; confirmed++) {
        for (unsigned pulse = 0; pulse < 2U; pulse++) {
            even = twin;
            for (unsigned i = 0; i < confirmed; i++) {
                even.rig.pulses.confirmed[i] = even.rig.pulses.last;
            }
            even.rig.pulses.confirmed_count = confirmed;
            even.rig.busy = pulse == 1U;
            const uint32_t ever = even.rig.pulses_ever;
            even_step(&even);
            TEST_ASSERT_EQUAL_UINT32(ever, even.rig.pulses_ever);
            const unsigned taken = confirmed == 0 || (confirmed == 1U && pulse == 1U) ? 0U : 1U;
            TEST_ASSERT_EQUAL_UINT(confirmed - taken, even.rig.pulses.confirmed_count);
        }
    }
}

/* Returns the number of half nodes by which the sums of the turn have advanced since `before`, or -1 if unknown. */
static int halves_since(const wh_lockin *before) {
    const wh_lockin *now = &even.rig.measure.lockin;
    if (before->stage != WH_LOCKIN_SUMS || now->stage != WH_LOCKIN_SUMS || now->count < 4U ||
        before->place == WH_LOCKIN_BEGIN || now->place == WH_LOCKIN_END ||
        before->next.begin_ticks != now->next.begin_ticks) {
        return -1;
    }
    const int nodes = (int)now->next.samples + (int)now->next.outliers - (int)before->next.samples -
                      (int)before->next.outliers;
    return 2 * nodes + (now->place != WH_LOCKIN_NOWHERE ? 1 : 0) -
           (before->place != WH_LOCKIN_NOWHERE ? 1 : 0);
}

/* The controller is up to three steps late and then gets all samples of that time. A step without a sample adds four
 * half nodes to the turn's sums. A step with one sample adds three, or two while a pulse is unconfirmed and gravity is
 * compensated. A step with more samples, or with two observer steps, adds one. A step with a pulse may add none. */
TEST(rig_bounds, work_of_a_step_is_limited) {
    static wh_lockin before;
    unsigned times[5] = {0};
    for (unsigned compensated = 0; compensated < 2U; compensated++) {
        seed = 1U + compensated;
        arm(true);
        even.config.compensation_when =
            compensated == 1U ? WH_COMPENSATION_ALWAYS : WH_COMPENSATION_NEVER;
        even.config.measure.record_s = WH_R(8.0);
        even_obeys(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM);
        even_go_on_until(&even, WH_PHASE_RECORD);
        for (unsigned i = 0; i < 3000U && even.rig.run.phase == WH_PHASE_RECORD; i++) {
            const unsigned late = draw_one_in(&seed, 4) ? draw_one_of(&seed, 3) : 0U;
            unsigned samples = 1;
            if (draw_one_in(&seed, 4)) {
                even.fails = (even_failure){.in = WH_PHASE_RECORD, .lose_samples = 1};
                samples = 0;
            }
            for (unsigned k = 0; k < late; k++) { /* the samples of the missed steps */
                even.inputs.now_ticks += EVEN_STEP_TICKS;
                if (draw_one_in(&seed, 2)) {
                    wh_rig_load(&even.config, &even.rig, even.inputs.now_ticks - 500U,
                                EVEN_TARE_RAW, WH_LOAD_OK);
                    samples++;
                }
            }
            before = even.rig.measure.lockin;
            const uint32_t observed = even.rig.observer.ticks;
            const uint32_t ever = even.rig.pulses_ever;
            const bool waited = even.rig.pulses.waits;
            even_step(&even);
            const bool two = even.rig.compensated &&
                             even.rig.observer.ticks - observed > even.rig.observer.step_ticks;
            const unsigned work = samples + (two ? 1U : 0U);
            const bool unsure = even.rig.compensated && even.rig.pulses.waits;
            const int most = work == 0 ? 4 : work > 1U ? 1 : unsure ? 2 : 3;
            const int done = halves_since(&before);
            if (done >= 0) {
                const bool changed =
                    waited != even.rig.pulses.waits || ever != even.rig.pulses_ever;
                TEST_ASSERT_TRUE(done == most || (done == 0 && (changed || unsure)));
                times[done]++;
            }
        }
    }
    for (unsigned k = 0; k < 5U; k++) {
        TEST_ASSERT_TRUE(times[k] > 20U);
    }
}

/* The set-point needs gravity compensation, but the observer never becomes valid. The rig trips when the ramp's longest
 * time is over. */
TEST(rig_bounds, ramp_timeout_trips) {
    for (unsigned i = 0; i < 3U; i++) {
        arm(false);
        even.config.run.ramp_max_s = WH_R(6.0) + WH_R(2.0) * (wh_real)i;
        even_obeys(&even, WH_EVENT_START, WH_R(120.0) * EVEN_RPM);
        even_go_on_until(&even, WH_PHASE_RAMP);
        unsigned steps = 0;
        for (; even.rig.run.phase == WH_PHASE_RAMP && steps < 10000U; steps++) {
            even_step(&even);
        }
        TEST_ASSERT_EQUAL_UINT((6U + 2U * i) * 500U + 1U, steps);
        TEST_ASSERT_TRUE(even.rig.guard.trip == WH_TRIP_UNSETTLED);
    }
}

/* The rotor hangs at sensor 1 and gives pulses by jitter during the tare. These pulses begin no turn. */
TEST(rig_bounds, pulses_at_rest_begin_no_turn) {
    seed = 4;
    for (unsigned i = 0; i < 60U; i++) {
        even_begin(&even, WH_RIG_NOMINAL_RPM, &(even_failure){.in = EVEN_NEVER});
        for (unsigned pulses = 0; pulses < i % 3U; pulses++) {
            even_steps(&even, 1U + draw_one_of(&seed, 110));
            wh_rig_pulse(&even.config, &even.rig, 0, even.inputs.now_ticks + 500U);
        }
        even_steps(&even, 20);
        TEST_ASSERT_TRUE(even.rig.run.phase == WH_PHASE_TARE);
        even_go_on_until(&even, WH_PHASE_SPIN_UP);
        TEST_ASSERT_TRUE(even.rig.run.phase == WH_PHASE_SPIN_UP);
        TEST_ASSERT_FALSE(even.rig.measure.lockin.open || even.rig.pulses.speed.running);
    }
}

/* A scatter exactly at the limit is accepted, and the next larger number is refused. The same is true for the error of
 * the mean. */
TEST(rig_bounds, limits_of_the_tare_are_allowed) {
    seed = 3;
    for (unsigned i = 0; i < 200U; i++) {
        /* a number that divides exactly */
        const uint32_t spare = UINT32_C(1) << (1U + draw_one_of(&seed, 7));
        const wh_real noise_N2 = draw_one_in(&seed, 3) ? WH_R(0.0) : draw_whole(&seed, 1, 64);
        const wh_real still_N = draw_whole(&seed, 0, 8);
        const wh_real most_N2 = noise_N2 + still_N * still_N;
        wh_tare tare = {.count = spare + 1U,
                        .means = 3U,
                        .changes_N2 = WH_R(15.0) * noise_N2 * (wh_real)spare,
                        .slow_N2 = WH_R(2.0) * most_N2};
        wh_tare_config config = {.samples = 250, .still_N = still_N, .most_N = WH_R(1e9)};
        tare.square_N2 = most_N2 * (wh_real)spare;
        TEST_ASSERT_TRUE(wh_tare_is_still(&config, &tare));
        config.most_N = wh_tare_error_N(&tare);
        TEST_ASSERT_TRUE(wh_tare_is_still(&config, &tare));
        config.most_N *= WH_R(1.0) - WH_R(0x1p-20);
        TEST_ASSERT_TRUE(wh_tare_is_still(&config, &tare) == !(most_N2 > WH_R(0.0)));
        config.most_N = WH_R(1e9);
        tare.slow_N2 = tare.slow_N2 * (WH_R(1.0) + WH_R(0x1p-20)) + WH_R(0x1p-40);
        TEST_ASSERT_FALSE(wh_tare_is_still(&config, &tare));
    }
}

TEST(rig_bounds, stage_is_state_or_phase) {
    for (unsigned stage = 0; stage < 2U * WH_RIG_STAGE_OF_PHASE; stage++) {
        const bool state = stage < WH_RIG_STAGE_OF_PHASE;
        const char *words = state ? wh_rig_state_text((wh_rig_state)stage)
                                  : wh_phase_text((wh_rig_phase)(stage - WH_RIG_STAGE_OF_PHASE));
        TEST_ASSERT_TRUE(wh_rig_stage_text(stage) == words);
    }
    for (wh_rig_state state = WH_RIG_IDLE; state < WH_RIG_STATES; state++) {
        for (wh_rig_phase phase = WH_PHASE_NONE; phase < WH_PHASES; phase++) {
            const wh_rig rig = {.state = state, .run = {.phase = phase}};
            const char *words =
                phase == WH_PHASE_NONE ? wh_rig_state_text(state) : wh_phase_text(phase);
            TEST_ASSERT_TRUE(wh_rig_stage_text(wh_rig_stage(&rig)) == words);
        }
    }
}
