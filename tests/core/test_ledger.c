/* test_ledger.c: the ledger of energy and momentum: changed inputs, angles with their turns, corrections.
 * test_contact_exact.c compares the entries of contacts with a reference. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

TEST(ledger, ledger_changes_no_bit) {
    uint64_t hash[2];
    for (unsigned k = 0; k < 2; k++) {
        hand_build_ball(WH_R(0.5));
        hand_now.spring[0] = WH_R(3.0);
        hand_start(k == 1);
        hand_steps(3000);
        hash[k] = wh_scene_hash(&hand_now.scene, &hand_state);
    }
    TEST_ASSERT_TRUE(hash[0] == hash[1]);
}

/* Computes the acceleration of a body of 1 kg on a spring whose stiffness is the input. */
static void spring_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *accel) {
    (void)model;
    (void)phase;
    (void)rate;
    accel[0] = -input[0] * linear[0]; /* the momentum changes by this number per second, too */
}

static void spring_levels(const void *model, const wh_angle *angle, const wh_real *linear,
                          const wh_real *rate, const wh_real *input, wh_real *level) {
    (void)model;
    (void)angle;
    level[0] = WH_R(0.5) * (rate[0] * rate[0] + input[0] * linear[0] * linear[0]);
    level[1] = rate[0];
}

static const uint8_t spring_account[] = {1};
static const uint8_t spring_input[] = {0};
static const wh_ledger_form spring_books = {.powers = spring_accel,
                                            .levels = spring_levels,
                                            .account = spring_account,
                                            .input = spring_input,
                                            .smooth = 1,
                                            .entries = 2,
                                            .accounts = 3,
                                            .coordinates = 1,
                                            .inputs = 1};

static wh_status spring_advance(const wh_scene *scene, wh_state *state) {
    return wh_step_counted(wh_step_ledger(&spring_books, NULL, spring_accel, WH_RK4, false,
                                          (wh_two_part){scene->step_s, WH_R(0.0)}, state),
                           state);
}

/* The spring becomes stiffer, then softer. Each change adds the energy (k2 - k1) x^2/2, which the next step enters;
 * until then the residual stays 0. */
TEST(ledger, changed_spring_enters_its_energy) {
    static uint64_t memory[WH_STATE_WORDS(0, 2, 1) + WH_LEDGER_WORDS(2, 3)];
    static const wh_real start[2] = {WH_R(0.5), WH_R(1.0)};
    static const wh_real rates[4] = {WH_R(4.0), WH_R(25.0), WH_R(1.0), WH_R(9.0)}; /* N/m */
    const wh_scene scene = {.name = "spring",
                            .form = WH_SECOND_ORDER,
                            .reals = 2,
                            .inputs = 1,
                            .step_s = WH_R(0.001),
                            .start_real = start,
                            .start_input = rates,
                            .ledger = &spring_books,
                            .advance = spring_advance};
    wh_state state;
    wh_real level[2];
    wh_real gave = WH_R(0.0);
    TEST_ASSERT_TRUE(wh_scene_start(&scene, &state, memory, sizeof memory) == WH_OK);
    for (unsigned k = 0; k < 4; k++) {
        const wh_real change = k > 0 ? rates[k] - rates[k - 1] : WH_R(0.0);
        gave += WH_R(0.5) * change * state.real[0] * state.real[0];
        state.input[0] = rates[k];
        TEST_ASSERT_TRUE(
            hand_near(wh_ledger_error(&spring_books, &state, 0, level), WH_R(0.0), 1e-11, 2e-4));
        for (unsigned step = 0; step < 300; step++) {
            TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_OK);
        }
        TEST_ASSERT_TRUE(hand_near(state.ledger[1], gave, 1e-14, 1e-5));
        TEST_ASSERT_TRUE(k == 0 || WH_ABS(change * state.real[0]) > WH_R(0.1));
        for (unsigned account = 0; account < 2; account++) {
            const wh_real error = wh_ledger_error(&spring_books, &state, account, level);
            TEST_ASSERT_TRUE(hand_near(error, WH_R(0.0), 1e-11, 2e-4));
        }
    }
}

/* A shaft of 1 kg m^2 under a torque of 1/2 N m. Its energy account is 1/2 r^2 + a th + b: it contains the angle, whole
 * turns included, and the two inputs a and b. */
static void shaft_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                        const wh_real *rate, const wh_real *input, wh_real *accel) {
    (void)model;
    (void)phase;
    (void)linear;
    (void)rate;
    accel[0] = WH_R(0.5) - input[0];
}

/* Computes the power of the torque, and of another entry that cancels in the sum. The other entry's power contains
 * the angle. */
static void shaft_powers(const void *model, const wh_angle *angle, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *power) {
    (void)model;
    (void)linear;
    (void)input;
    power[0] = WH_R(0.5) * rate[0];
    power[1] = wh_angle_to_rad(angle[0]);
}

static void shaft_levels(const void *model, const wh_angle *angle, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *level) {
    (void)model;
    (void)linear;
    level[0] = WH_R(0.5) * rate[0] * rate[0] + input[0] * wh_angle_to_rad(angle[0]) + input[1];
    level[1] = rate[0];
}

static const uint8_t shaft_account[] = {0, 1};
static const uint8_t shaft_input[] = {0, 1};
static const wh_ledger_form shaft_books = {.powers = NULL,
                                           .turned = shaft_powers,
                                           .levels = shaft_levels,
                                           .account = shaft_account,
                                           .input = shaft_input,
                                           .smooth = 2,
                                           .entries = 4,
                                           .accounts = 6,
                                           .coordinates = 1,
                                           .angles = 1,
                                           .inputs = 2};

static wh_status shaft_advance(const wh_scene *scene, wh_state *state) {
    return wh_step_counted(wh_step_ledger(&shaft_books, NULL, shaft_accel, WH_RK4, false,
                                          (wh_two_part){scene->step_s, WH_R(0.0)}, state),
                           state);
}

/* Entry 1 is the integral of the angle, 1/12 t^3 + r t^2/2 + th t. It must use the shaft's unwrapped angle, not its
 * phase. Each input has its own entry. */
TEST(ledger, entries_use_unwrapped_angles) {
    static uint64_t memory[WH_STATE_WORDS(1, 1, 2) + WH_LEDGER_WORDS(4, 6)];
    static const wh_real start_real[1] = {WH_R(3.0)};
    static const wh_real start_input[2] = {WH_R(0.0), WH_R(0.0)};
    for (unsigned which = 0; which < 3; which++) {
        const wh_angle start_angle[1] = {wh_angle_from_rad(WH_R(20.0))};
        const wh_scene scene = {.name = "shaft",
                                .form = WH_SECOND_ORDER,
                                .angles = 1,
                                .reals = 1,
                                .inputs = 2,
                                .step_s = WH_R(0.0078125),
                                .start_angle = start_angle,
                                .start_real = start_real,
                                .start_input = start_input,
                                .ledger = &shaft_books,
                                .advance = shaft_advance};
        wh_state state;
        wh_real level[2];
        TEST_ASSERT_TRUE(wh_scene_start(&scene, &state, memory, sizeof memory) == WH_OK);
        TEST_ASSERT_TRUE(wh_ledger_sum(&shaft_books, &state, 0) == WH_R(0.0));
        for (unsigned i = 0; i < 256; i++) { /* two seconds */
            TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_OK);
        }
        TEST_ASSERT_TRUE(hand_near(state.ledger[0], WH_R(3.5), 1e-12, 3e-5)); /* (4^2 - 3^2)/2 */
        TEST_ASSERT_TRUE(hand_near(state.ledger[1], WH_R(8.0) / 12 + WH_R(46.0), 1e-11, 4e-4));
        TEST_ASSERT_TRUE(
            hand_near(wh_ledger_error(&shaft_books, &state, 0, level), WH_R(0.0), 1e-12, 3e-5));
        state.input[0] = which != 1 ? WH_R(0.25) : WH_R(0.0);
        state.input[1] = which != 0 ? WH_R(0.75) : WH_R(0.0);
        const wh_real rad = wh_angle_to_rad(state.angle[0]);
        TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_OK);
        TEST_ASSERT_TRUE(hand_near(state.ledger[2], which != 1 ? rad / 4 : WH_R(0.0), 1e-13, 1e-6));
        TEST_ASSERT_TRUE(
            hand_near(state.ledger[3], which != 0 ? WH_R(0.75) : WH_R(0.0), 1e-13, 2e-6));
        /* a refused change makes no entry */
        const wh_real before[4] = {state.ledger[0], state.ledger[1], state.ledger[2],
                                   state.ledger[3]};
        state.input[0] = WH_R(-1e16);
        TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_E_DIVERGED);
        for (unsigned i = 0; i < 4; i++) {
            TEST_ASSERT_TRUE(state.ledger[i] == before[i]);
        }
    }
}

/* An angle is set, whole turns included, or moved exactly after many turns. An input that was changed just before has
 * its own entry. */
TEST(ledger, corrected_angles_are_booked) {
    static uint64_t memory[WH_STATE_WORDS(1, 1, 2) + WH_LEDGER_WORDS(4, 6)];
    static const wh_real start_real[1] = {WH_R(3.0)};
    static const wh_real start_input[2] = {WH_R(0.25), WH_R(0.0)};
    uint64_t seed = 46;
    for (unsigned i = 0; i < 100; i++) {
        const wh_angle start_angle[1] = {wh_angle_from_rad(draw_broken(&seed, -90, 90))};
        const wh_real turns = draw_whole(&seed, 0, 1000000);
        const wh_scene scene = {.name = "shaft",
                                .form = WH_SECOND_ORDER,
                                .angles = 1,
                                .reals = 1,
                                .inputs = 2,
                                .compensated = true,
                                .step_s = WH_R(0.0078125),
                                .start_angle = start_angle,
                                .start_real = start_real,
                                .start_input = start_input,
                                .ledger = &shaft_books,
                                .advance = shaft_advance};
        wh_state state;
        wh_real level[2];
        TEST_ASSERT_TRUE(wh_scene_start(&scene, &state, memory, sizeof memory) == WH_OK);
        TEST_ASSERT_TRUE(wh_scene_steps(&scene, &state, 7) == WH_OK);
        const wh_real was = wh_angle_to_rad(state.angle[0]);
        const wh_real rad = draw_broken(&seed, -90, 90);
        state.carry[0] = WH_R(0.25);
        state.input[0] = WH_R(0.5);
        TEST_ASSERT_TRUE(wh_scene_set_angle(&scene, &state, 0, rad) == WH_OK);
        TEST_ASSERT_TRUE(hand_near(wh_angle_to_rad(state.angle[0]), rad, 0.0, 1e-5));
        TEST_ASSERT_TRUE(state.carry[0] == WH_R(0.0) && state.input[0] == WH_R(0.5));
        TEST_ASSERT_TRUE(hand_near(wh_ledger_corrected(&shaft_books, &state)[0],
                                   WH_R(0.25) * (rad - was), 1e-12, 1e-5));
        TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_OK);
        TEST_ASSERT_TRUE(hand_near(state.ledger[2], WH_R(0.25) * rad, 1e-12, 1e-5));
        TEST_ASSERT_TRUE(
            hand_near(wh_ledger_error(&shaft_books, &state, 0, level), WH_R(0.0), 1e-11, 1e-4));
        /* after many turns, a change by a thousandth of a radian */
        TEST_ASSERT_TRUE(wh_scene_set_angle(&scene, &state, 0, turns) == WH_OK);
        const wh_angle far = state.angle[0];
        TEST_ASSERT_TRUE(wh_scene_move_angle(&scene, &state, 0, WH_R(0.001)) == WH_OK);
        TEST_ASSERT_TRUE(hand_near((wh_real)(state.angle[0] - far),
                                   WH_DOUBLE ? WH_R(0.001) : WH_R(683565.3), 1e-9, 1.0));
        TEST_ASSERT_TRUE(wh_scene_move_angle(&scene, &state, 0, WH_R(1e9)) == WH_E_ARGUMENT);
        TEST_ASSERT_TRUE(wh_scene_set_angle(&scene, &state, 1, WH_R(1.0)) == WH_E_ARGUMENT);
        TEST_ASSERT_TRUE(wh_scene_set_real(&scene, &state, 1, WH_R(1.0)) == WH_E_ARGUMENT);
    }
}
