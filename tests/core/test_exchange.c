/* test_exchange.c: messages between controller and plant are read back as written; invalid ones are refused. */
#include "core/exchange.h"

#include "draw.h"
#include "tests/suites.h"

static uint8_t bytes[WH_READINGS_BYTES + 8U];
static uint64_t seed;

static uint32_t draw_word(void) { return (uint32_t)(draw_bits(&seed) << 16 ^ draw_bits(&seed)); }

static float draw_float(void) { return (float)(int32_t)draw_word() * 1e-3f; }

/* Every wrong length is refused, even if the missing bytes are zeros. */
static void expect_length(unsigned length, bool (*get)(unsigned length)) {
    TEST_ASSERT_TRUE(get(length));
    for (unsigned wrong = 0; wrong < length; wrong++) {
        TEST_ASSERT_FALSE(get(wrong));
    }
    TEST_ASSERT_FALSE(get(length + 1U));
}

static wh_orders orders_in;
static wh_orders orders_out;
static bool get_orders(unsigned length) { return wh_orders_get(&orders_out, bytes, length); }

TEST(exchange, orders) {
    seed = 1;
    for (unsigned outputs = 0; outputs <= WH_SIGNALS_MAX; outputs++) {
        orders_in = (wh_orders){.until_ticks = draw_word(),
                                .acted_timer = draw_word(),
                                .busy_timer = draw_word(),
                                .watchdog_ticks = draw_word(),
                                .flags = (uint8_t)draw_word(),
                                .outputs = outputs};
        for (unsigned i = 0; i < outputs; i++) {
            orders_in.output[i] = draw_float();
        }
        const unsigned length = wh_orders_put(&orders_in, bytes, WH_ORDERS_BYTES);
        TEST_ASSERT_EQUAL_UINT(22U + 4U * outputs, length);
        expect_length(length, get_orders);
        TEST_ASSERT_TRUE(get_orders(length));
        TEST_ASSERT_EQUAL_UINT32(orders_in.until_ticks, orders_out.until_ticks);
        TEST_ASSERT_EQUAL_UINT32(orders_in.acted_timer, orders_out.acted_timer);
        TEST_ASSERT_EQUAL_UINT32(orders_in.busy_timer, orders_out.busy_timer);
        TEST_ASSERT_EQUAL_UINT32(orders_in.watchdog_ticks, orders_out.watchdog_ticks);
        TEST_ASSERT_EQUAL_UINT(orders_in.flags, orders_out.flags);
        TEST_ASSERT_EQUAL_UINT(outputs, orders_out.outputs);
        TEST_ASSERT_EQUAL_INT(
            0, __builtin_memcmp(orders_in.output, orders_out.output, outputs * sizeof(float)));
        TEST_ASSERT_EQUAL_UINT(0, wh_orders_put(&orders_in, bytes, length - 1U));
    }
    bytes[17] = WH_SIGNALS_MAX + 1U; /* the number of readings */
    TEST_ASSERT_FALSE(wh_orders_get(&orders_out, bytes, 22U + 4U * (WH_SIGNALS_MAX + 1U)));
}

static wh_readings readings_in;
static wh_readings readings_out;
static bool get_readings(unsigned length) { return wh_readings_get(&readings_out, bytes, length); }

TEST(exchange, readings) {
    seed = 2;
    for (unsigned round = 0; round < 40; round++) {
        readings_in = (wh_readings){.flags = (uint8_t)draw_word(),
                                    .edges = draw_one_of(&seed, WH_EDGES_MAX + 1U),
                                    .samples = draw_one_of(&seed, WH_SAMPLES_MAX + 1U)};
        if (round == 0) { /* the longest payload */
            readings_in.edges = WH_EDGES_MAX;
            readings_in.samples = WH_SAMPLES_MAX;
        }
        for (unsigned i = 0; i < readings_in.edges; i++) {
            readings_in.edge[i] = (wh_edge){draw_word(), (uint8_t)draw_word()};
        }
        for (unsigned i = 0; i < readings_in.samples; i++) {
            readings_in.sample[i] = (wh_sample){draw_word(), (int32_t)draw_word(),
                                                (uint8_t)draw_word(), (uint8_t)draw_word()};
        }
        const unsigned length = wh_readings_put(&readings_in, bytes, WH_READINGS_BYTES);
        TEST_ASSERT_TRUE(length > 0);
        expect_length(length, get_readings);
        TEST_ASSERT_TRUE(get_readings(length));
        TEST_ASSERT_EQUAL_UINT(readings_in.flags, readings_out.flags);
        TEST_ASSERT_EQUAL_UINT(readings_in.edges, readings_out.edges);
        TEST_ASSERT_EQUAL_UINT(readings_in.samples, readings_out.samples);
        for (unsigned i = 0; i < readings_in.edges; i++) {
            TEST_ASSERT_EQUAL_UINT32(readings_in.edge[i].ticks, readings_out.edge[i].ticks);
            TEST_ASSERT_EQUAL_UINT(readings_in.edge[i].channel, readings_out.edge[i].channel);
        }
        for (unsigned i = 0; i < readings_in.samples; i++) {
            TEST_ASSERT_EQUAL_UINT32(readings_in.sample[i].ticks, readings_out.sample[i].ticks);
            TEST_ASSERT_EQUAL_INT32(readings_in.sample[i].raw, readings_out.sample[i].raw);
            TEST_ASSERT_EQUAL_UINT(readings_in.sample[i].channel, readings_out.sample[i].channel);
            TEST_ASSERT_EQUAL_UINT(readings_in.sample[i].status, readings_out.sample[i].status);
        }
    }
    bytes[1] = WH_EDGES_MAX + 1U;
    TEST_ASSERT_FALSE(get_readings(sizeof bytes));
}

static wh_reset reset_out;

/* Any number of remembered bytes, including zero, and each known cause. */
TEST(exchange, reset) {
    seed = 3;
    for (unsigned count = 0; count <= WH_REMEMBER_MAX; count++) {
        wh_reset reset = {.cause = count % 2U ? WH_RESET_WATCHDOG : WH_RESET_OTHER, .count = count};
        for (unsigned i = 0; i < count; i++) {
            reset.remembered[i] = (uint8_t)draw_word();
        }
        const unsigned length = wh_reset_put(&reset, bytes, WH_RESET_BYTES);
        TEST_ASSERT_EQUAL_UINT(1U + count, length);
        TEST_ASSERT_TRUE(wh_reset_get(&reset_out, bytes, length));
        TEST_ASSERT_EQUAL_UINT(reset.cause, reset_out.cause);
        TEST_ASSERT_EQUAL_UINT(count, reset_out.count);
        TEST_ASSERT_EQUAL_INT(0, __builtin_memcmp(reset.remembered, reset_out.remembered, count));
        TEST_ASSERT_EQUAL_UINT(0, wh_reset_put(&reset, bytes, length - 1U));
    }
    TEST_ASSERT_FALSE(wh_reset_get(&reset_out, bytes, 0));
    TEST_ASSERT_FALSE(wh_reset_get(&reset_out, bytes, WH_RESET_BYTES + 1U));
    for (unsigned cause = 0; cause < 256; cause++) {
        bytes[0] = (uint8_t)cause;
        TEST_ASSERT_TRUE(wh_reset_get(&reset_out, bytes, 5) ==
                         (cause == WH_RESET_WATCHDOG || cause == WH_RESET_OTHER));
    }
}

static const wh_signal signals[] = {
    {WH_SIGNAL_OUTPUT, "duty", "1", 0.0f, 1.0f, 0.0f, 0},
    {WH_SIGNAL_SAMPLE, "cell_force", "N", -222.0f, 222.0f, 0.0068f, 2000},
    {WH_SIGNAL_EDGE, "theta", "rad", -0.017f, 0.017f, 0.0f, 0},
    {WH_SIGNAL_NOTE, "state", "1", 0.0f, 0.0f, 0.0f, 0},
};
static wh_hello hello_out;
static wh_signal signals_out[WH_SIGNALS_MAX];
static bool get_hello(unsigned length) {
    return wh_hello_get(&hello_out, signals_out, bytes, length);
}

TEST(exchange, hello) {
    const wh_hello hello = {"rig", "mps2", 1000000U, 25000000U, 0xFFB3B4C0U, signals, 4};
    const unsigned length = wh_hello_put(&hello, bytes, sizeof bytes);
    TEST_ASSERT_EQUAL_UINT(15U + 19U * 4U + (3U + 4U + 4U + 1U + 10U + 1U + 5U + 3U + 5U + 1U),
                           length);
    expect_length(length, get_hello);
    TEST_ASSERT_TRUE(get_hello(length));
    TEST_ASSERT_EQUAL_STRING("rig", hello_out.program);
    TEST_ASSERT_EQUAL_STRING("mps2", hello_out.board);
    TEST_ASSERT_EQUAL_UINT32(1000000U, hello_out.ticks_per_s);
    TEST_ASSERT_EQUAL_UINT32(25000000U, hello_out.timer_per_s);
    TEST_ASSERT_EQUAL_UINT32(0xFFB3B4C0U, hello_out.start_ticks);
    TEST_ASSERT_EQUAL_UINT(4, hello_out.signals);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(signals[i].kind, signals_out[i].kind);
        TEST_ASSERT_EQUAL_STRING(signals[i].name, signals_out[i].name);
        TEST_ASSERT_EQUAL_STRING(signals[i].unit, signals_out[i].unit);
        TEST_ASSERT_EQUAL_INT(
            0, __builtin_memcmp(&signals[i].low, &signals_out[i].low, 3U * sizeof(float)));
        TEST_ASSERT_EQUAL_UINT32(signals[i].period_ticks, signals_out[i].period_ticks);
    }
    bytes[22] = WH_SIGNAL_NOTE + 1U; /* the kind of the first signal, after 4 + 5 + 12 + 1 bytes */
    TEST_ASSERT_FALSE(get_hello(length));
    bytes[22] = WH_SIGNAL_OUTPUT;
    TEST_ASSERT_TRUE(get_hello(length));
    bytes[21] = WH_SIGNALS_MAX + 1U; /* the number of signals */
    TEST_ASSERT_FALSE(get_hello(length));
}

/* In random bytes, no count exceeds its array, and no string leaves the bytes. */
TEST(exchange, noise) {
    seed = 4;
    for (unsigned round = 0; round < 3000; round++) {
        const unsigned length = draw_one_of(&seed, WH_READINGS_BYTES + 1U);
        for (unsigned i = 0; i < length; i++) {
            bytes[i] = (uint8_t)(draw_bits(&seed) & (round % 2U ? 0xFFU : 0x0FU));
        }
        if (wh_orders_get(&orders_out, bytes, length)) {
            TEST_ASSERT_TRUE(orders_out.outputs <= WH_SIGNALS_MAX);
        }
        if (wh_readings_get(&readings_out, bytes, length)) {
            TEST_ASSERT_TRUE(readings_out.edges <= WH_EDGES_MAX);
            TEST_ASSERT_TRUE(readings_out.samples <= WH_SAMPLES_MAX);
        }
        if (get_hello(length)) {
            TEST_ASSERT_TRUE(hello_out.signals <= WH_SIGNALS_MAX);
        }
    }
}
