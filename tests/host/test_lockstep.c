/* test_lockstep.c: a firmware and a plant in turns, with somebody who listens to them: what taps see and change, and the
 * tape. The firmware is build/pil_cart, a process of its own. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/base/interrupts.h"
#include "host/pil/fault.h"
#include "host/pil/lockstep.h"
#include "motion.h"
#include "unity.h"

void suite_lockstep(void);

static char firmware[512];
static motion cart;
static lockstep_report report;

/* Beside the folder of this program. */
static void find_firmware(void) {
    const ssize_t length = readlink("/proc/self/exe", firmware, sizeof firmware - 20);
    firmware[length > 0 ? length : 0] = '\0';
    for (int up = 0; up < 2; up++) {
        char *slash = strrchr(firmware, '/');
        TEST_ASSERT_NOT_NULL(slash);
        *slash = '\0';
    }
    strcat(firmware, "/pil_cart");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, access(firmware, X_OK), "make build/pil_cart");
}

static lockstep_wish wish_until(double until_s) {
    return (lockstep_wish){.guest = {.image = firmware, .board = "", .patience_s = 20.0},
                           .plant = {.seed = 1},
                           .until_s = until_s};
}

static void run(const lockstep_wish *wish) {
    lockstep_run(wish, cart.image, &report);
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_LET_GO);
}

typedef struct listener {
    uint64_t orders;
    uint64_t readings;
    uint64_t samples;
    double last_s;
    float most_N;
} listener;

static void hear_orders(void *of, double time_s, wh_orders *orders, double *late_s) {
    listener *l = of;
    l->orders++;
    TEST_ASSERT_TRUE(*late_s == 0.0);
    TEST_ASSERT_TRUE(time_s >= l->last_s);
    l->last_s = time_s;
    l->most_N = fmaxf(l->most_N, fabsf(orders->output[0]));
}

static void hear_readings(void *of, double time_s, wh_readings *readings) {
    listener *l = of;
    l->readings++;
    l->samples += readings->samples;
    TEST_ASSERT_TRUE(time_s >= l->last_s);
    l->last_s = time_s;
}

static void forget_orders(void *of, double time_s, wh_orders *orders, double *late_s) {
    (void)of;
    (void)time_s;
    (void)late_s;
    orders->output[0] = 0.0F;
}

static void lose_samples(void *of, double time_s, wh_readings *readings) {
    (void)of;
    (void)time_s;
    readings->samples = 0;
}

static void take_ten_ms(void *of, double time_s, wh_orders *orders, double *late_s) {
    (void)of;
    (void)time_s;
    (void)orders;
    *late_s += 10e-3;
}

static bool see_start(void *of, const wh_hello *hello, plant *on) {
    listener *l = of;
    l->last_s = plant_now(on);
    return strcmp(hello->program, "cart") == 0;
}

static bool refuse_start(void *of, const wh_hello *hello, plant *on) {
    (void)of;
    return hello == NULL || on == NULL;
}

/* Every millisecond, and no step between. */
static void see_plant(void *of, double time_s, const plant *on) {
    listener *l = of;
    l->readings++;
    TEST_ASSERT_TRUE(time_s > l->last_s && time_s < l->last_s + 1.1e-3);
    TEST_ASSERT_TRUE(fabs(plant_now(on) - time_s * 1e6) < 1e-3);
    l->last_s = time_s;
}

/* Who only listens hears all of it, and changes nothing. */
static void test_listening(void) {
    lockstep_wish wish = wish_until(1.5);
    run(&wish);
    const lockstep_report without = report;
    listener heard = {.orders = 0};
    const tap taps[] = {{.name = "orders", .of = &heard, .orders = hear_orders},
                        {.name = "readings", .of = &heard, .readings = hear_readings}};
    wish.taps = taps;
    wish.tap_count = 2;
    run(&wish);
    TEST_ASSERT_TRUE(report.hash == without.hash && report.plant_hash == without.plant_hash);
    TEST_ASSERT_EQUAL_UINT64(1500, report.exchanges);
    TEST_ASSERT_EQUAL_UINT64(1500, heard.orders);
    TEST_ASSERT_EQUAL_UINT64(1500, heard.readings);
    TEST_ASSERT_EQUAL_UINT64(2 * 1499, heard.samples); /* the first reading is of the start */
    TEST_ASSERT_TRUE(heard.most_N > 1.0F && heard.most_N <= 20.0F);
}

/* Who watches the plant sees it go on and changes nothing, also while the firmware computes for ten milliseconds. */
static void test_watching(void) {
    for (int late = 0; late < 2; late++) {
        lockstep_wish wish = wish_until(1.5);
        listener seen = {.orders = 0};
        const tap taps[] = {{.name = "late", .orders = late ? take_ten_ms : NULL},
                            {.name = "watch", .of = &seen, .start = see_start, .watch = see_plant}};
        wish.taps = taps;
        wish.tap_count = 1;
        run(&wish);
        const lockstep_report without = report;
        wish.tap_count = 2;
        run(&wish);
        TEST_ASSERT_TRUE(report.hash == without.hash && report.plant_hash == without.plant_hash);
        TEST_ASSERT_EQUAL_UINT64(1500, seen.readings);
        TEST_ASSERT_EQUAL_UINT64(late ? 150 : 1500, report.exchanges);
        TEST_ASSERT_EQUAL_UINT64(late ? 150 : 0, report.overruns);
    }
}

static void test_refused_start(void) {
    lockstep_wish wish = wish_until(1.0);
    const tap taps[] = {{.name = "no", .start = refuse_start}};
    wish.taps = taps;
    wish.tap_count = 1;
    lockstep_run(&wish, cart.image, &report);
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_BAD);
    TEST_ASSERT_EQUAL_UINT64(0, report.exchanges);
}

/* Whose orders are lost on the way has a plant that moves as if it were alone. */
static void test_deaf_plant(void) {
    lockstep_wish wish = wish_until(1.0);
    const tap taps[] = {{.name = "deaf", .orders = forget_orders}};
    wish.taps = taps;
    wish.tap_count = 1;
    run(&wish);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&cart, 20000));
    TEST_ASSERT_TRUE(report.plant_hash == engine_double.hash(cart.run));
}

/* A firmware that sees nothing pushes nothing. */
static void test_blind_firmware(void) {
    lockstep_wish wish = wish_until(0.2);
    listener heard = {.orders = 0};
    const tap taps[] = {{.name = "blind", .readings = lose_samples},
                        {.name = "orders", .of = &heard, .orders = hear_orders}};
    wish.taps = taps;
    wish.tap_count = 2;
    run(&wish);
    TEST_ASSERT_EQUAL_UINT64(200, heard.orders);
    TEST_ASSERT_TRUE(heard.most_N == 0.0F);
}

/* A tape has what the firmware heard and said, whatever taps made of it: it answers the same again. */
static void tape_of_a_tapped_run(const tap *only, uint64_t exchanges) {
    char name[] = "/tmp/whirl_tape_XXXXXX";
    const int file = mkstemp(name);
    TEST_ASSERT_TRUE(file >= 0);
    lockstep_wish wish = wish_until(0.3);
    wish.taps = only;
    wish.tap_count = 1;
    wish.tape = fdopen(file, "wb");
    TEST_ASSERT_NOT_NULL(wish.tape);
    run(&wish);
    TEST_ASSERT_EQUAL_INT(0, fclose(wish.tape));
    const uint64_t hash = report.hash;
    TEST_ASSERT_EQUAL_UINT64(exchanges, report.exchanges);
    const lockstep_wish again = wish_until(0.3);
    lockstep_replay(&again, name, &report);
    TEST_ASSERT_EQUAL_INT(0, remove(name));
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_LET_GO);
    TEST_ASSERT_TRUE(report.hash == hash && report.op_list_hash == hash);
    TEST_ASSERT_EQUAL_UINT64(exchanges, report.exchanges);
    TEST_ASSERT_TRUE(report.time_s > 0.298 && report.time_s < 0.3);
}

static void test_tapes_of_tapped_runs(void) {
    const tap taps[] = {{.name = "blind", .readings = lose_samples},
                        {.name = "deaf", .orders = forget_orders}};
    tape_of_a_tapped_run(&taps[0], 300);
    tape_of_a_tapped_run(&taps[1], 300);
}

/* A processor that is reset says hello again; of the time that it takes no exchange is missed but those in it. */
static void test_tapes_of_resets(void) {
    static const struct {
        const char *words;
        unsigned resets;
        uint64_t exchanges;
    } rows[] = {
        {"reset=0@0.1005", 1, 301}, /* one at 0.1005 s, and then every millisecond from there */
        {"reset=5ms@0.1005", 1, 296},
        {"reset=5ms@0.1005,reset=20ms@0.2001", 2, 276},
        {"reset=1ms@0.05,reset=1ms@0.0505,reset=1ms@0.0511", 3, 300}, /* one is in another's */
        {"reset=0@0", 1, 301},                                        /* before its first orders */
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fault_plan plan = {.seed = 1};
        TEST_ASSERT_TRUE(fault_read(&plan, rows[i].words));
        const tap t = fault_tap(&plan);
        tape_of_a_tapped_run(&t, rows[i].exchanges);
        TEST_ASSERT_EQUAL_UINT(rows[i].resets, plan.resets);
    }
}

/* Somebody asks it to stop: it does, and the process is gone. */
static void test_interrupt(void) {
    lockstep_wish wish = wish_until(100.0);
    interrupted = 1;
    lockstep_run(&wish, cart.image, &report);
    interrupted = 0;
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_STOPPED);
    TEST_ASSERT_FALSE(report.status.killed);
    TEST_ASSERT_EQUAL_INT(3, report.status.status); /* HAL_LINK_GONE */
}

void suite_lockstep(void) {
    find_firmware();
    motion_open_file(&cart, "docs/plants/cart.whirl", "", "leaning", IN_DOUBLE_STEP(50e-6));
    RUN_TEST(test_listening);
    RUN_TEST(test_watching);
    RUN_TEST(test_refused_start);
    RUN_TEST(test_deaf_plant);
    RUN_TEST(test_blind_firmware);
    RUN_TEST(test_tapes_of_tapped_runs);
    RUN_TEST(test_tapes_of_resets);
    RUN_TEST(test_interrupt);
    motion_close(&cart);
}
