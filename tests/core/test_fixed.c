/* test_fixed.c: the integers of core/fixed.h, compared with 64-bit integers: products, rounding, reciprocals, sines,
 * conversions of reals. */
#include <math.h>

#include "core/angle.h"
#include "core/fixed_scene.h"

#include "tests/suites.h"

#define CASES (WH_TEST_SMALL ? 2000L : 400000L)

static uint64_t drawn = UINT64_C(88172645463325252);

static uint32_t draw(void) {
    drawn ^= drawn << 13;
    drawn ^= drawn >> 7;
    drawn ^= drawn << 17;
    return (uint32_t)(drawn >> 16);
}

/* Draws a number of any size, including the ends of the range. */
static int32_t draw_number(void) {
    static const int32_t edges[] = {0,         1,          -1,         0x7fff,     0x8000,
                                    -0x8000,   0x10000,    -0x10000,   0xffff,     -0xffff,
                                    INT32_MAX, -INT32_MAX, 0x7fff8000, 0x7fff7fff, -0x7fff8000};
    const uint32_t which = draw() % 40U;
    if (which < sizeof edges / sizeof edges[0]) {
        return edges[which];
    }
    return (int32_t)draw() >> (draw() % 31U);
}

static int64_t floor_shift(int64_t x, int by) {
    const int64_t unit = (int64_t)1 << by;
    const int64_t rest = x % unit;
    return (x - (rest < 0 ? rest + unit : rest)) / unit;
}

TEST(fixed, products) {
    for (long i = 0; i < CASES; i++) {
        const int32_t a = draw_number();
        const int32_t b = draw_number();
        const int32_t expected = (int32_t)floor_shift((int64_t)a * b, 32);
        TEST_ASSERT_EQUAL_INT32(expected, wh_fixed_high_wide(a, b));
        TEST_ASSERT_EQUAL_INT32(expected, wh_fixed_high_narrow(a, b));
        TEST_ASSERT_EQUAL_INT32(expected, wh_fixed_high_called(a, b));
        TEST_ASSERT_EQUAL_INT32(expected, wh_fixed_high(a, b));
    }
}

TEST(fixed, short_products) {
    for (long i = 0; i < CASES; i++) {
        const int16_t a = (int16_t)draw_number();
        const int16_t b = (int16_t)draw_number();
        TEST_ASSERT_EQUAL_INT32((int32_t)((int64_t)a * b), wh_fixed_ss(a, b));
        TEST_ASSERT_EQUAL_INT32((int32_t)((int64_t)a * (uint16_t)b), wh_fixed_su(a, (uint16_t)b));
        TEST_ASSERT_EQUAL_UINT32((uint32_t)((uint64_t)(uint16_t)a * (uint16_t)b),
                                 wh_fixed_uu((uint16_t)a, (uint16_t)b));
    }
}

TEST(fixed, rounding) {
    for (long i = 0; i < CASES; i++) {
        const int32_t a = draw_number() / 2;
        const int32_t b = draw_number();
        const int by = (int)(draw() % 30U) + 1;
        const int64_t half = (int64_t)1 << (by - 1);
        TEST_ASSERT_EQUAL_INT32((int32_t)floor_shift((int64_t)a + half, by), wh_fixed_round(a, by));
        TEST_ASSERT_EQUAL_INT32((int32_t)floor_shift(floor_shift((int64_t)a * b, 32) + half, by),
                                wh_fixed_mul(a, b, by));
    }
    TEST_ASSERT_EQUAL_INT32(5, wh_fixed_round(5, 0));
    TEST_ASSERT_EQUAL_INT32(-40, wh_fixed_round(-5, -3));
    TEST_ASSERT_EQUAL_INT32(0, wh_fixed_round(INT32_C(0x40000000), 31));
    TEST_ASSERT_EQUAL_INT32(0, wh_fixed_round(-INT32_C(0x3fffffff), 60));
}

/* Sums modulo 2^32, signs, limits, shifts by all digits, and the upper half of a product. */
TEST(fixed, small_operations) {
    for (long i = 0; i < CASES; i++) {
        const int32_t a = draw_number();
        const int32_t b = draw_number();
        const int by = (int)(draw() % 31U);
        const int16_t number = (int16_t)draw_number();
        const int32_t x = a / 8; /* up to 2^28 */
        const int64_t half = by > 0 ? (int64_t)1 << (by - 1) : 0;
        TEST_ASSERT_EQUAL_UINT32((uint32_t)((int64_t)a + b), (uint32_t)wh_fixed_add(a, b));
        TEST_ASSERT_EQUAL_UINT32((uint32_t)((int64_t)a - b), (uint32_t)wh_fixed_sub(a, b));
        TEST_ASSERT_EQUAL_UINT32((uint32_t)((uint64_t)(int64_t)a << by),
                                 (uint32_t)wh_fixed_left(a, by));
        TEST_ASSERT_EQUAL_INT32(a < 0 ? -a : a, wh_fixed_size(a));
        TEST_ASSERT_EQUAL_INT32((int32_t)floor_shift(floor_shift(x, 14) * number + half, by),
                                wh_fixed_mul_short(x, number, by));
        if (by <= 30) {
            TEST_ASSERT_EQUAL_INT32((a > 0) * (INT32_C(1) << by) - (a < 0) * (INT32_C(1) << by),
                                    wh_fixed_sign(a, by));
        }
    }
    for (int by = 31; by < 70; by++) {
        TEST_ASSERT_EQUAL_INT32(0, wh_fixed_round(-INT32_C(0x40000000), by));
        TEST_ASSERT_EQUAL_INT32(0, wh_fixed_round(3, -by - 1));
    }
}

static void check_reciprocal(uint32_t d) {
    /* The error of x d, which is nearly 2^61. It must be below 2^61/2^27.3. */
    const int64_t off =
        (int64_t)((uint64_t)(uint32_t)wh_fixed_reciprocal(d) * d) - ((int64_t)1 << 61);
    TEST_ASSERT_TRUE_MESSAGE(off < INT64_C(14000000000) && off > -INT64_C(14000000000),
                             "a reciprocal is off");
}

TEST(fixed, reciprocals) {
    check_reciprocal(UINT32_C(0x80000000));
    check_reciprocal(UINT32_MAX);
    for (uint32_t i = 0; i < 128; i++) { /* both ends of each cell */
        check_reciprocal(UINT32_C(0x80000000) + (i << 24));
        check_reciprocal(UINT32_C(0x80ffffff) + (i << 24));
    }
    for (long i = 0; i < CASES; i++) {
        check_reciprocal(draw() | UINT32_C(0x80000000));
    }
}

TEST(fixed, zeros) {
    for (int i = 0; i < 32; i++) {
        TEST_ASSERT_EQUAL_INT(31 - i, wh_fixed_zeros(UINT32_C(1) << i));
        TEST_ASSERT_EQUAL_INT(31 - i, wh_fixed_zeros((UINT32_C(2) << i) - 1U));
    }
}

static wh_phase real_phase(uint32_t phase) {
#if WH_DOUBLE
    return (double)phase * (6.283185307179586477 / 4294967296.0);
#else
    return phase;
#endif
}

static void check_sine(uint32_t phase) {
    int32_t s;
    int32_t c;
    int32_t s_here;
    int32_t c_here;
    wh_real sine;
    wh_real cosine;
    /* The method's own error, 3.4e-8, plus the error of a real. */
    const wh_real most = (WH_DOUBLE ? WH_R(3.5e-8) : WH_R(1.3e-7));
    wh_fixed_sincos_called(phase, &s, &c);
    wh_fixed_sincos_shared(phase, &s_here, &c_here);
    TEST_ASSERT_TRUE(s == s_here && c == c_here);
    wh_fixed_sincos_here(phase, &s_here, &c_here);
    wh_sincos(real_phase(phase), &sine, &cosine);
    TEST_ASSERT_EQUAL_INT32(s, s_here);
    TEST_ASSERT_EQUAL_INT32(c, c_here);
    TEST_ASSERT_TRUE(WH_ABS((wh_real)s * WH_R(0x1p-30) - sine) < most);
    TEST_ASSERT_TRUE(WH_ABS((wh_real)c * WH_R(0x1p-30) - cosine) < most);
}

TEST(fixed, sines) {
    int32_t s;
    int32_t c;
    for (uint32_t i = 0; i < 4; i++) { /* quarter turns are exact */
        wh_fixed_sincos(i << 30, &s, &c);
        TEST_ASSERT_EQUAL_INT32(i == 1 ? INT32_C(1) << 30 : i == 3 ? -(INT32_C(1) << 30) : 0, s);
        TEST_ASSERT_EQUAL_INT32(i == 0 ? INT32_C(1) << 30 : i == 2 ? -(INT32_C(1) << 30) : 0, c);
    }
    for (uint32_t i = 0; i < 256; i++) { /* both sides of each edge of a sector */
        check_sine(i << 24);
        check_sine((i << 24) - 1U);
    }
    for (long i = 0; i < CASES; i++) {
        check_sine(draw());
    }
}

TEST(fixed, limits) {
    uint32_t held = 0;
    for (long i = 0; i < CASES; i++) {
        const int32_t a = draw_number() / 2;
        const int32_t b = draw_number() / 2;
        const int32_t low = wh_fixed_least(a, b);
        const int32_t high = wh_fixed_most(a, b);
        const int32_t x = draw_number();
        const uint32_t before = held;
        const int32_t y = wh_fixed_limit(x, low, high, &held);
        TEST_ASSERT_EQUAL_INT32(x < low ? low : x > high ? high : x, y);
        TEST_ASSERT_EQUAL_UINT32(before + (x < low || x > high), held);
    }
}

static const wh_fixed_format formats[] = {{24, -100 * (INT32_C(1) << 24), 100 * (INT32_C(1) << 24)},
                                          {-3, -1000, 1000}};
static const int64_t start_angle[] = {INT64_C(-3) * (INT64_C(1) << 32) + (INT64_C(1) << 31)};
static const int32_t start_number[] = {INT32_C(1) << 24};

static wh_status no_step(const wh_fixed_scene *scene, wh_fixed_state *state) {
    (void)scene;
    state->real[0]++;
    state->steps++;
    return WH_OK;
}

static const wh_fixed_scene scene = {.name = "none",
                                     .angles = 1,
                                     .reals = 1,
                                     .inputs = 1,
                                     .steps = 1,
                                     .format = formats,
                                     .start_angle = start_angle,
                                     .start_real = start_number,
                                     .start_input = start_number,
                                     .advance = no_step};

/* Every function that takes a state gets a state that was not started (zeroed or refused), and must refuse it. */
static void must_not_run(wh_fixed_state *state) {
    const uint64_t steps = state->steps;
    const uint32_t saturated = state->saturated;
    TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT, wh_fixed_step(&scene, state));
    TEST_ASSERT_TRUE(wh_fixed_hash(&scene, state) == 0);
    TEST_ASSERT_TRUE(wh_fixed_real(&scene, state, 0) == WH_R(0.0));
    TEST_ASSERT_TRUE(wh_fixed_angle(&scene, state, 0) == WH_R(0.0));
    wh_fixed_set_real(&scene, state, 0, WH_R(1e30));
    wh_fixed_set_input(&scene, state, 0, WH_R(1e30));
    TEST_ASSERT_TRUE(state->steps == steps && state->saturated == saturated && state->real == NULL);
}

TEST(fixed, states_that_were_not_started) {
    uint64_t memory[4];
    int32_t start_real[1];
    wh_fixed_state state = {.steps = 0};
    must_not_run(&state);
    for (unsigned bytes = 0; bytes < 24; bytes++) {
        for (unsigned at = 0; at < 8; at++) {
            state = (wh_fixed_state){.steps = 5, .saturated = 7, .real = start_real};
            if (wh_fixed_start(&scene, &state, (char *)memory + at, bytes) != WH_OK) {
                must_not_run(&state);
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(WH_E_MEMORY, wh_fixed_start(&scene, &state, NULL, 16));
    must_not_run(&state);
    TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT, wh_fixed_start(NULL, &state, memory, 16));
    must_not_run(&state);
}

TEST(fixed, scenes) {
    uint64_t memory[2];
    wh_fixed_state state;
    TEST_ASSERT_EQUAL_INT(16, (int)WH_FIXED_BYTES(1, 2));
    TEST_ASSERT_EQUAL_INT(WH_E_MEMORY, wh_fixed_start(&scene, &state, memory, 15));
    TEST_ASSERT_EQUAL_INT(WH_E_MEMORY, wh_fixed_start(&scene, &state, NULL, 16));
    TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT, wh_fixed_start(NULL, &state, memory, 16));
    TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT, wh_fixed_start(&scene, NULL, memory, 16));
    struct behind_a_byte {
        char byte;
        int64_t angle;
    };
    for (size_t off = 1; off < offsetof(struct behind_a_byte, angle); off++) { /* misaligned */
        TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT,
                              wh_fixed_start(&scene, &state, (char *)memory + off, 16));
    }
    TEST_ASSERT_EQUAL_INT(WH_OK, wh_fixed_start(&scene, &state, memory, sizeof memory));
    TEST_ASSERT_TRUE(wh_fixed_real(&scene, &state, 0) == WH_R(1.0));
    TEST_ASSERT_TRUE(WH_ABS(wh_fixed_angle(&scene, &state, 0) + WH_R(15.707963267948966)) <
                     WH_R(4e-6));
    const uint64_t before = wh_fixed_hash(&scene, &state);
    TEST_ASSERT_EQUAL_INT(WH_OK, wh_fixed_step(&scene, &state));
    TEST_ASSERT_TRUE(before != wh_fixed_hash(&scene, &state));
    TEST_ASSERT_EQUAL_INT32((INT32_C(1) << 24) + 1, state.real[0]);
}

TEST(fixed, edges) {
    uint64_t memory[2];
    wh_fixed_state state;
    (void)wh_fixed_start(&scene, &state, memory, sizeof memory);
    wh_fixed_set_real(&scene, &state, 0, WH_R(-2.5));
    TEST_ASSERT_EQUAL_INT32(-5 * (INT32_C(1) << 23), state.real[0]);
    TEST_ASSERT_EQUAL_INT(WH_OK, wh_fixed_set_input(&scene, &state, 0, WH_R(804.0)));
    TEST_ASSERT_EQUAL_INT32(101, state.input[0]); /* 100.5 eighths: away from zero */
    TEST_ASSERT_EQUAL_INT(WH_OK, wh_fixed_set_input(&scene, &state, 0, WH_R(-804.0)));
    TEST_ASSERT_EQUAL_INT32(-101, state.input[0]);
    TEST_ASSERT_EQUAL_UINT32(0, state.saturated);
    wh_fixed_set_real(&scene, &state, 0, WH_R(1e30));
    TEST_ASSERT_EQUAL_INT32(formats[0].high, state.real[0]);
    wh_fixed_set_real(&scene, &state, 0, WH_R(-100.5));
    TEST_ASSERT_EQUAL_INT32(formats[0].low, state.real[0]);
    TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT, wh_fixed_set_input(&scene, &state, 0, WH_R(8009.0)));
    TEST_ASSERT_EQUAL_UINT32(3, state.saturated);
    TEST_ASSERT_EQUAL_INT32(1000, state.input[0]);
    for (long i = 0; i < CASES; i++) { /* ranges of 1 to 7 digits: the ends must be inside */
        double limit = 1.0 + draw() % 9999999U;
        int16_t bits = 0;
        for (unsigned places = draw() % 12U; places > 0; places--) {
            limit /= 10.0;
        }
        double end = limit; /* in units of 2^-bits */
        const double many = 1U << (14U + draw() % 17U);
        while (end < many) {
            end += end;
            bits++;
        }
        const wh_fixed_format format = {bits, -(int32_t)end, (int32_t)end};
        const wh_real most = (wh_real)limit;
        uint32_t held = 0;
        TEST_ASSERT_EQUAL_INT32(format.high, wh_fixed_of(&format, most, &held));
        TEST_ASSERT_EQUAL_INT32(format.low, wh_fixed_of(&format, -most, &held));
        TEST_ASSERT_EQUAL_UINT32(0, held);
        const wh_real more =
            wh_fixed_to(&format, 2) + (WH_DOUBLE ? WH_R(0.0) : most * WH_R(0x1p-21));
        TEST_ASSERT_EQUAL_INT32(format.high, wh_fixed_of(&format, most + more, &held));
        TEST_ASSERT_EQUAL_INT32(format.low, wh_fixed_of(&format, -most - more, &held));
        TEST_ASSERT_EQUAL_UINT32(2, held);
    }
    for (long i = 0; i < CASES; i++) {
        /* integers inside and outside the range, and an input that does not exist */
        const int32_t raw = draw_number() >> (draw() % 31U);
        const wh_fixed_format *format = &formats[1];
        const uint32_t before = state.saturated;
        const bool inside = raw >= format->low && raw <= format->high;
        TEST_ASSERT_EQUAL_INT(inside ? WH_OK : WH_E_ARGUMENT,
                              wh_fixed_set_raw_input(&scene, &state, 0, raw));
        TEST_ASSERT_EQUAL_UINT32(before + !inside, state.saturated);
        TEST_ASSERT_EQUAL_INT32(inside              ? raw
                                : raw > format->low ? format->high
                                                    : format->low,
                                state.input[0]);
        TEST_ASSERT_EQUAL_INT(WH_E_ARGUMENT, wh_fixed_set_raw_input(&scene, &state, 1, raw));
    }
#if WH_DOUBLE
    for (long i = 0; i < CASES; i++) { /* the nearest integer, for numbers of any size */
        const int32_t x = draw_number() >> (draw() % 30U);
        const wh_real off = WH_R(0.49) * ((wh_real)draw_number() / WH_R(0x1p31));
        uint32_t held = 0;
        const wh_fixed_format format = {0, INT32_MIN + 1, INT32_MAX};
        const int32_t within = wh_fixed_limit(x, format.low, format.high, &held);
        TEST_ASSERT_EQUAL_INT32(within, wh_fixed_of(&format, (wh_real)within + off, &held));
    }
#endif
    /* converted to fixed point and back, a number keeps the precision of a float */
    for (long i = 0; i < CASES; i++) {
        const int32_t x = draw_number() >> 8;
        uint32_t held = 0;
        const wh_fixed_format format = {(int16_t)(draw() % 50U), INT32_MIN / 2, INT32_MAX / 2};
        TEST_ASSERT_EQUAL_INT32(x, wh_fixed_of(&format, wh_fixed_to(&format, x), &held));
        TEST_ASSERT_EQUAL_UINT32(0, held);
    }
}
