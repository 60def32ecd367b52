/* test_effect_records.c: noise is on the records alone, the same everywhere; inputs of effects. */
#include "motion.h"

#include <math.h>
#include <stdio.h>

#include "core/noise.h"

#include "unity.h"

#define SMALL 1e-9 /* far above what a parabola's rounding is in 1000 steps of RK4 */

void suite_effect_records(void);

/* --- noise ------------------------------------------------------------------------------------------------------ */

/* FNV-1a, 32 bits: the published parameters. */
static uint32_t seed_of(const char *output, uint32_t seed) {
    uint32_t hash = 2166136261U;
    for (; *output != '\0'; output++) {
        hash = (hash ^ (unsigned char)*output) * 16777619U;
    }
    return hash ^ seed;
}

/* An output with and without its noise, step by step: the state does not know of it. */
static void compare_noise(const char *use, const char *with, const char *output, uint32_t seed,
                          double deviation) {
    char text[200];
    motion clean;
    motion noisy;
    snprintf(text, sizeof text, "scene t { use %s; set duty = 0.6 }\n", use);
    motion_open_more(&clean, "eccentric.whirl", text, IN_DOUBLE_STEP(1e-3));
    snprintf(text, sizeof text, "scene t { use %s; with %s; set duty = 0.6 }\n", use, with);
    motion_open_more(&noisy, "eccentric.whirl", text, IN_DOUBLE_STEP(1e-3));
    TEST_ASSERT_EQUAL_UINT64(clean.image->hash, noisy.image->hash);
    double sum = 0.0;
    double squares = 0.0;
    for (unsigned i = 0; i < 4096; i++) {
        const double is = motion_value(&noisy, output);
        const double pure = motion_value(&clean, output);
        const double want = deviation * wh_noise_raw(seed_of(output, seed), i) * 0x1p-16;
        TEST_ASSERT_DOUBLE_WITHIN(1e-13 * (fabs(pure) + deviation), pure + want, is);
        sum += is - pure;
        squares += (is - pure) * (is - pure);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&clean, 1));
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&noisy, 1));
        TEST_ASSERT_EQUAL_UINT64(clean.kind->hash(clean.run), noisy.kind->hash(noisy.run));
    }
    /* four standard errors of 4096 draws: 4/64 of the deviation, and sqrt(2) times that of its square */
    TEST_ASSERT_DOUBLE_WITHIN(deviation / 16.0, 0.0, sum / 4096.0);
    TEST_ASSERT_DOUBLE_WITHIN(deviation * deviation / 11.0, deviation * deviation,
                              squares / 4096.0);
    motion_close(&clean);
    motion_close(&noisy);
}

static void test_noise_is_on_the_records_only(void) {
    compare_noise("eccentric_fixed", "cell_noise", "cell_force", 1, 0.07);
    compare_noise("eccentric", "cell_noise", "pin_force", 2, 0.07);
    compare_noise("eccentric_coupled", "sensor_noise", "cell_force", 1, 0.07);
    compare_noise("eccentric_coupled", "sensor_noise", "speed", 1, 0.05);
}

/* The interpreter's float numbers are the generated C's, to the bit. */
extern const wh_scene rig_coupled;

static void test_noise_is_the_same_in_generated_code(void) {
    uint64_t memory[64];
    wh_state state;
    wh_real output[8];
    motion m;
    TEST_ASSERT_EQUAL_INT(WH_OK, wh_scene_start(&rig_coupled, &state, memory, sizeof memory));
    motion_open(&m, "rig_coupled", IN_FLOAT);
    TEST_ASSERT_EQUAL_UINT(3, rig_coupled.outputs);
    for (unsigned i = 0; i < 2000; i++) {
        double interpreted[8];
        m.kind->outputs(m.run, interpreted);
        rig_coupled.observe(&rig_coupled, &state, output);
        for (unsigned k = 0; k < 3; k++) {
            TEST_ASSERT_TRUE((double)output[k] == interpreted[k]);
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_EQUAL_INT(WH_OK, wh_scene_step(&rig_coupled, &state));
    }
    motion_close(&m);
}

/* --- an effect's input ------------------------------------------------------------------------------------------- */

/* An effect not called for leaves nothing behind, its input neither; called for, its input counts. */
static void test_inputs_of_effects(void) {
    static const char start[] = "mechanism t\ncoordinate X [m]\nT = 2 [kg]*X'^2/2\n"
                                "effect push { input f = 6 [N]; Q(X) += f }\n"
                                "input h = 1 [N]\nQ(X) = h\n";
    char with[sizeof start + 40];
    motion m;
    snprintf(with, sizeof with, "%sscene t { until 1 [s] }\n", start);
    motion_open_text(&m, with, IN_DOUBLE_STEP(1e-3));
    TEST_ASSERT_EQUAL_INT(1, m.image->inputs);
    motion_to(&m, 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(SMALL, 0.25, motion_value(&m, "X"));
    motion_close(&m);
    snprintf(with, sizeof with, "%sscene t { with push }\n", start);
    motion_open_text(&m, with, IN_DOUBLE_STEP(1e-3));
    TEST_ASSERT_EQUAL_INT(2, m.image->inputs);
    motion_to(&m, 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(SMALL, 1.75, motion_value(&m, "X"));
    motion_close(&m);
}

void suite_effect_records(void) {
    RUN_TEST(test_inputs_of_effects);
    RUN_TEST(test_noise_is_on_the_records_only);
    RUN_TEST(test_noise_is_the_same_in_generated_code);
}
