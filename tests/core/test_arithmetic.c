/* test_arithmetic.c: wh_scene_start() detects wrong arithmetic of this build, of a file compiled with other flags
 * (imitated by functions that compute differently), and of a processor in another mode. tests/flags.sh tests the flags
 * of real compilers. */
#include "core/number/arithmetic.h"
#include "core/scene.h"

#include "tests/suites.h"

static wh_state state;
static uint64_t memory[WH_STATE_WORDS(1, 1, 1)];
static wh_probed spoilt;
static wh_real spoilt_to;

static void compute_otherwise(wh_real *result) {
    wh_arithmetic(result);
    if (spoilt != WH_PROBED_COUNT) {
        result[spoilt] = spoilt_to;
    }
}

static wh_status no_step(const wh_scene *scene, wh_state *of) {
    (void)scene;
    (void)of;
    return WH_OK;
}

static const wh_real start_real[1] = {WH_R(0.25)};
static const wh_scene scene = {.name = "still",
                               .form = WH_FIRST_ORDER,
                               .method = WH_RK4,
                               .reals = 1,
                               .step_s = WH_R(1e-3),
                               .start_real = start_real,
                               .advance = no_step,
                               .arithmetic = compute_otherwise};

static wh_status start(void) { return wh_scene_start(&scene, &state, memory, sizeof memory); }

TEST(arithmetic, this_build_is_sound) {
    TEST_ASSERT_TRUE(wh_arithmetic_wrong(wh_arithmetic) == WH_PROBED_COUNT);
    spoilt = WH_PROBED_COUNT;
    TEST_ASSERT_TRUE(start() == WH_OK);
}

TEST(arithmetic, unsound_arithmetic_is_refused) {
    /* The probes' results under contraction, reordering, truncation, flushing, reciprocals and lost signs. */
#if WH_DOUBLE
    static const wh_real made[WH_PROBED_COUNT] = {0x1p-54,
                                                  0x1p-54,
                                                  0.0,
                                                  0.0,
                                                  0x1.aaaaaaaaaaaaap0,
                                                  0x1.2aaaaaaaaaaaap1,
                                                  0x1.aaaaaaaaaaaaap1,
                                                  0x1.2aaaaaaaaaaaap1,
                                                  -0.0};
#else
    static const wh_real made[WH_PROBED_COUNT] = {0x1p-24f,      0x1p-25f,      0.0f,
                                                  0.0f,          0x1.aaaaacp0f, 0x1.2aaaacp1f,
                                                  0x1.aaaaacp1f, 0x1.2aaaacp1f, -0.0f};
#endif
    spoilt = WH_PROBED_COUNT;
    TEST_ASSERT_TRUE(start() == WH_OK);
    state.steps = 5;
    for (unsigned i = 0; i < WH_PROBED_COUNT; i++) {
        spoilt = (wh_probed)i;
        spoilt_to = made[i];
        TEST_ASSERT_TRUE(start() == WH_E_ARITHMETIC);
        TEST_ASSERT_TRUE(state.fault == (int)i);
        TEST_ASSERT_TRUE(state.steps == 5); /* the earlier run is unchanged */
    }
}

#if defined(__SSE2_MATH__)
#define MODES 1
/* flush results, flush arguments, both */
static const uint32_t flushing[] = {0x8000U, 0x40U, 0x8040U};
static const uint32_t rounding[] = {0x2000U, 0x4000U, 0x6000U};
static uint32_t modes(void) { return __builtin_ia32_stmxcsr(); }
static void set_modes(uint32_t to) { __builtin_ia32_ldmxcsr(to); }
#elif defined(__ARM_FP) && !defined(__aarch64__) && !defined(__clang__)
#define MODES 1
static const uint32_t flushing[] = {UINT32_C(1) << 24};
static const uint32_t rounding[] = {UINT32_C(1) << 22, UINT32_C(2) << 22, UINT32_C(3) << 22};
static uint32_t modes(void) { return __builtin_arm_get_fpscr(); }
static void set_modes(uint32_t to) { __builtin_arm_set_fpscr(to); }
#endif

#ifdef MODES
static void expect_refused(uint32_t more) {
    const uint32_t before = modes();
    spoilt = WH_PROBED_COUNT;
    set_modes(before | more);
    const wh_status status = start();
    set_modes(before);
    TEST_ASSERT_TRUE(status == WH_E_ARITHMETIC);
    TEST_ASSERT_TRUE(start() == WH_OK);
}

static void test_flush_to_zero_is_refused(void) {
    for (unsigned i = 0; i < sizeof flushing / sizeof flushing[0]; i++) {
        expect_refused(flushing[i]);
    }
}

static void test_other_roundings_are_refused(void) {
    for (unsigned i = 0; i < sizeof rounding / sizeof rounding[0]; i++) {
        expect_refused(rounding[i]);
    }
}
#endif

SUITE(arithmetic) {
#ifdef MODES
    RUN_TEST(test_flush_to_zero_is_refused);
    RUN_TEST(test_other_roundings_are_refused);
#endif
}
