/* test_scenes.c: the generated scenes: end states compared with the reference, ledgers, outputs, and equal bits in a
 * second run.
 *
 * The same source runs in double and float, on the PC and on boards. Tolerances in double are the method's errors
 * (tests/host/test_trajectory.c has their digits). In float, round-off is added. After N steps, a sum that is below 2^k
 * has a random error of sqrt(N/3) U 2^k, with U = 2^-24. */
#include "build/gen/scenes.h"
#include "core/scene.h"

#include "tests/suites.h"

#define U WH_R(0x1p-24)

/* Boards with float arithmetic in software do a tenth of the longest runs. */
#if !__STDC_HOSTED__ && !defined(__ARM_FP)
#define SLOW 1
#else
#define SLOW 0
#endif

/* Room for any scene of up to 16 angles, 48 reals and 16 inputs, compensated or not. */
static uint64_t memory[WH_STATE_WORDS(16, 48, 16) + WH_CONTACT_WORDS(16) + WH_HELD_WORDS(16) +
                       WH_LEDGER_WORDS(128, 34)];
static wh_state state;
static wh_real output[32];

static void start(const wh_scene *scene) {
    TEST_ASSERT_TRUE(wh_scene_start(scene, &state, memory, sizeof memory) == WH_OK);
}

static void step_to(const wh_scene *scene, uint64_t steps) {
    while (state.steps < steps) {
        TEST_ASSERT_TRUE_MESSAGE(wh_scene_step(scene, &state) == WH_OK, scene->name);
    }
}

static wh_real larger(wh_real a, wh_real b) { return a > b ? a : b; }

static wh_real sine(wh_angle angle) {
    wh_real s;
    wh_real c;
    wh_sincos(wh_phase_of(angle), &s, &c);
    return s;
}

static wh_real cosine(wh_angle angle) {
    wh_real s;
    wh_real c;
    wh_sincos(wh_phase_of(angle), &s, &c);
    return c;
}

/* The reference of an angle. The compiler multiplies it by 2^32 / (2 pi), the phase units per radian. */
#define ANGLE(rad) WH_TURN((rad), (int64_t)((rad)*683565275.57643159))

/* Numbers from tests/reference/trajectory.txt; the compiler rounds them. */
typedef struct end_state {
    const wh_scene *scene;
    uint32_t steps;
    wh_real in_double; /* largest allowed error of any state, SI */
    wh_real in_float;
    wh_angle angle[2];
    wh_real real[4];
} end_state;

static const end_state end_states[] = {
    /* Float: the round-off of 9000 steps of theta' (below 32 rad/s) is integrated for 9 s. */
    {&epicyclic_from_rest,
     9000,
     WH_R(5e-8),
     WH_R(5.4e-4),
     {ANGLE(89.6342558331565748)},
     {WH_R(0.329611268310012897), WH_R(22.2610447620456337), WH_R(6.64570198844706309)}},
    {&epicyclic_rail_drag,
     9000,
     WH_R(5e-8),
     WH_R(5.4e-4),
     {ANGLE(82.9231758223298337)},
     {WH_R(0.0102819576585898491), WH_R(19.3703034162092484), WH_R(5.49807783552139774)}},
    /* Float: the round-off of 5000 steps of rates below 32 rad/s. With theta2'' = 1e3 rad/s^2, errors of time matter,
     * too. */
    {&driven_hinge_from_rest,
     5000,
     WH_R(3e-5),
     WH_R(1e-2),
     {ANGLE(-48.3378303235600124), ANGLE(-47.1025341932366345)},
     {WH_R(-8.99645871096406409), WH_R(-23.8334242067059670)}},
    /* Float: the round-off of 25000 steps of rates below 8 rad/s. The motion amplifies it by a factor of 6e3. */
    {&thomson_a,
     25000,
     WH_R(8e-9),
     WH_R(6e-2),
     {ANGLE(-10.6144740124010441), ANGLE(-17.0959717050394372)},
     {WH_R(0.839285809779478438), WH_R(-5.06295906952996249), WH_R(1.20577040594969357),
      WH_R(-1.06211080436277226)}},
    /* Float: the round-off of 5000 steps of positions (below 0.125 m) and of their rates. */
    {&two_mass_absolute,
     5000,
     WH_R(2e-11),
     WH_R(6e-7),
     {0},
     {WH_R(0.0601982502180750091), WH_R(0.111537876494626772), WH_R(-0.00333257506812323036),
      WH_R(-0.00571925567576755449)}},
    {&two_mass_relative,
     5000,
     WH_R(2e-11),
     WH_R(1e-7),
     {0},
     {WH_R(0.000508250218075009113), WH_R(0.000539626276551762863), WH_R(-0.00333257506812323036),
      WH_R(-0.00238668060764432413)}},
    /* Float: the round-off of 2000 steps of r' (below 16 m/s) is integrated for 2 s. */
    {&spherical_flight,
     2000,
     WH_R(2e-11),
     WH_R(5e-5),
     {ANGLE(1.88343603890459318), ANGLE(0.763855538621619197)},
     {WH_R(19.1202584242418245), WH_R(0.564270644456289021), WH_R(0.0340095159802488842),
      WH_R(10.6405360858669460)}},
};

static wh_real apart_rad(wh_angle a, wh_angle b) {
    const wh_real units = (wh_real)(a - b);
    return WH_ABS(units / WH_PHASE_PER_RAD);
}

TEST(scenes, end_states) {
    for (unsigned i = 0; i < sizeof end_states / sizeof end_states[0]; i++) {
        const end_state *end = &end_states[i];
        wh_real worst = WH_R(0.0);
        start(end->scene);
        step_to(end->scene, end->steps);
        for (unsigned k = 0; k < end->scene->angles; k++) {
            worst = larger(worst, apart_rad(state.angle[k], end->angle[k]));
        }
        for (unsigned k = 0; k < end->scene->reals; k++) {
            worst = larger(worst, WH_ABS(state.real[k] - end->real[k]));
        }
        TEST_ASSERT_TRUE_MESSAGE(worst > WH_R(0.0), end->scene->name);
        TEST_ASSERT_TRUE_MESSAGE(worst <= (WH_DOUBLE ? end->in_double : end->in_float),
                                 end->scene->name);
    }
}

/* m = 2, r = 0.3, M = 2: the centre of mass X + r cos theta stays at 0.3 m, and T = M theta. */
TEST(scenes, ledger_of_the_epicyclic_gear) {
    wh_real off_centre = WH_R(0.0);
    wh_real off_work = WH_R(0.0);
    start(&epicyclic_from_rest);
    while (state.steps < 9000) {
        step_to(&epicyclic_from_rest, state.steps + 10);
        const wh_real s = sine(state.angle[0]);
        const wh_real c = cosine(state.angle[0]);
        const wh_real v = state.real[1];
        const wh_real vx = state.real[2] - WH_R(0.6) * v * s;
        const wh_real vy = WH_R(0.6) * v * c;
        const wh_real kinetic =
            state.real[2] * state.real[2] + (vx * vx + vy * vy) + WH_R(0.18) * (v * v);
        const wh_real work = WH_R(2.0) * wh_angle_to_rad(state.angle[0]);
        off_centre = larger(off_centre, WH_ABS(state.real[0] + WH_R(0.3) * c - WH_R(0.3)));
        off_work = larger(off_work, WH_ABS(kinetic - work));
    }
    /* The round-off of 9000 steps of X' (below 8 m/s) is integrated for 9 s. T = 179 J depends on the square of theta'
     * (22 rad/s), which doubles the relative error. */
    TEST_ASSERT_TRUE(off_centre > WH_R(0.0));
    TEST_ASSERT_TRUE(off_centre <= (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-4)));
    TEST_ASSERT_TRUE(off_work <= (WH_DOUBLE ? WH_R(1e-6) : WH_R(1.7e-3)));
}

/* Checks X = centre - r/3 (4 cos theta1 + cos 2 theta1 + cos theta2): the centre of mass stays at rest. */
static void expect_centre_of_mass(const wh_scene *scene, wh_real centre, wh_real in_float) {
    wh_real off = WH_R(0.0);
    start(scene);
    while (state.steps < scene->steps / (SLOW ? 10U : 1U)) {
        step_to(scene, state.steps + 20);
        const wh_real a = cosine(state.angle[0]);
        const wh_real twice = WH_R(2.0) * a * a - WH_R(1.0);
        const wh_real b = cosine(state.angle[1]);
        const wh_real mean = state.real[0] + WH_R(0.1) * (WH_R(4.0) * a + twice + b);
        off = larger(off, WH_ABS(mean - centre));
    }
    TEST_ASSERT_TRUE_MESSAGE(off > WH_R(0.0), scene->name);
    TEST_ASSERT_TRUE_MESSAGE(off <= (WH_DOUBLE ? WH_R(1e-8) : in_float), scene->name);
}

/* The centre of mass stays at rest for 10 s (1 s on a slow board), even in chaotic motions. In double, the bound is
 * that of every scene without external forces. In float, the error of X' (below 8 m/s, 16 in set B) is a random walk,
 * and X integrates it. For set B and 24 torques from 1.5 to 2.35 N m the RMS drift is 5.3e-4 and the largest 1.2e-3,
 * for either solver. */
TEST(scenes, centre_of_mass_of_thomson_device) {
    expect_centre_of_mass(&thomson_a, WH_R(0.6), WH_R(2e-4));
    expect_centre_of_mass(&thomson_b, WH_R(0.5), WH_R(1.2e-3));
    expect_centre_of_mass(&thomson_a_spin, WH_R(0.6), WH_R(2e-4));
    expect_centre_of_mass(&thomson_b_spin, WH_R(0.5), WH_R(8e-4));
}

/* Returns the round-off of a few numbers of about `size`. */
static wh_real roundings(wh_real size) {
    return size * (WH_DOUBLE ? WH_R(0x1p-51) : WH_R(4.0) * U);
}

static void expect_output(const wh_scene *scene, unsigned i, wh_real wanted, wh_real size) {
    TEST_ASSERT_TRUE_MESSAGE(i < scene->outputs, scene->name);
    TEST_ASSERT_TRUE_MESSAGE(WH_ABS(output[i] - wanted) <= roundings(size), scene->name);
}

TEST(scenes, outputs_of_the_epicyclic_gear) {
    const wh_scene *scene = &epicyclic_from_rest;
    start(scene);
    for (unsigned i = 1; i <= 20; i++) {
        step_to(scene, 450 * i);
        const uint64_t before = wh_scene_hash(scene, &state);
        scene->observe(scene, &state, output);
        TEST_ASSERT_TRUE(wh_scene_hash(scene, &state) == before);
        const wh_real X = state.real[0];
        const wh_real c = cosine(state.angle[0]);
        expect_output(scene, 0, WH_R(0.6) * c, WH_R(0.6));
        expect_output(scene, 1, X + WH_R(0.6) * c, WH_R(1.2));
        expect_output(scene, 2, X + WH_R(0.3) * c, WH_R(0.9));
    }
}

TEST(scenes, outputs_of_the_driven_hinge) {
    const wh_scene *scene = &driven_hinge_from_rest;
    start(scene);
    for (unsigned i = 1; i <= 20; i++) {
        step_to(scene, 250 * i);
        scene->observe(scene, &state, output);
        const wh_real a = wh_angle_to_rad(state.angle[0]);
        const wh_real b = wh_angle_to_rad(state.angle[1]);
        expect_output(scene, 0, a - b, WH_ABS(a) + WH_R(1.0));
        expect_output(scene, 1, WH_R(0.3) * (cosine(state.angle[0]) + cosine(state.angle[1])),
                      WH_R(0.6));
        expect_output(scene, 2, WH_R(0.3) * (sine(state.angle[0]) + sine(state.angle[1])),
                      WH_R(0.6));
    }
}

TEST(scenes, outputs_of_the_particle) {
    const wh_scene *scene = &spherical_flight;
    start(scene);
    for (unsigned i = 1; i <= 20; i++) {
        step_to(scene, 100 * i);
        scene->observe(scene, &state, output);
        const wh_real r = state.real[0];
        const wh_real s = sine(state.angle[0]);
        expect_output(scene, 0, r * s * cosine(state.angle[1]), r);
        expect_output(scene, 1, r * s * sine(state.angle[1]), r);
        expect_output(scene, 2, r * cosine(state.angle[0]), r);
    }
}

/* Number of steps of every scene: enough to show a difference, few enough for a board. */
#define STEPS_COMPARED (SLOW ? 200U : 2500U)

static uint64_t hash_of_run(const wh_scene *scene, wh_real *seen) {
    start(scene);
    *seen = WH_R(0.0);
    while (state.steps < scene->steps && state.steps < STEPS_COMPARED) {
        TEST_ASSERT_TRUE_MESSAGE(wh_scene_step(scene, &state) == WH_OK, scene->name);
        if (scene->outputs > 0 && state.steps % 100 == 0) {
            scene->observe(scene, &state, output);
            *seen += output[0];
        }
    }
    return wh_scene_hash(scene, &state);
}

/* Between the runs the memory is filled with bytes that expose a missing initialization. */
TEST(scenes, a_second_run_gives_the_same_bits) {
    TEST_ASSERT_TRUE(wh_scene_count > 0);
    for (unsigned i = 0; i < wh_scene_count; i++) {
        const wh_scene *scene = wh_scenes[i];
        wh_real seen;
        wh_real seen_again;
        TEST_ASSERT_TRUE_MESSAGE(scene->outputs <= sizeof output / sizeof output[0], scene->name);
        const uint64_t first = hash_of_run(scene, &seen);
        for (unsigned k = 0; k < sizeof memory / sizeof memory[0]; k++) {
            memory[k] = UINT64_C(0x7ff7a5a5ffc5a5a5);
        }
        const uint64_t second = hash_of_run(scene, &seen_again);
        TEST_ASSERT_TRUE_MESSAGE(first == second, scene->name);
        TEST_ASSERT_TRUE_MESSAGE(seen == seen_again, scene->name);
    }
}

/* If an input is not finite, a generated scene refuses the step and keeps its state. */
TEST(scenes, a_refused_step_keeps_the_state) {
    const wh_scene *scene = &thomson_a;
    start(scene);
    step_to(scene, 1000);
    const uint64_t before = wh_scene_hash(scene, &state);
    state.input[0] = WH_R(1e30);
    TEST_ASSERT_TRUE(wh_scene_step(scene, &state) == WH_E_DIVERGED);
    TEST_ASSERT_TRUE(state.fault >= 0 && state.fault < scene->angles + scene->reals);
    TEST_ASSERT_TRUE(wh_scene_hash(scene, &state) == before);
    state.input[0] = scene->start_input[0];
    step_to(scene, 2000);
    const uint64_t resumed = wh_scene_hash(scene, &state);
    start(scene);
    step_to(scene, 2000);
    TEST_ASSERT_TRUE(wh_scene_hash(scene, &state) == resumed);
}
