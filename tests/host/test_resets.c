/* test_resets.c: `reset` and `watchdog-resets` of a plant without firmware: begin and length of a reset, no outputs
 * during a reset, and losses. */
#include "host/pil/fault.h"
#include "motion.h"

#define TICKS_PER_S 1000000U
#define PERIOD_TICKS 2000U
#define READS 500 /* one second, at PERIOD_TICKS */
#define WATCHDOG_TICKS 5077U
enum { RESETS_MAX = 600, EDGES_MAX = 100 };

/* The rotor gives four pulses in a second. */
static const char *const text = "mechanism bench \"a rotor of two turns a second\"\n"
                                "coordinate a [rad]\ninput push = 0\n"
                                "T = 1 [kg*m^2]*a'^2/2\n"
                                "scene s { start a' = 2 [rev/s]; step 1 [ms]; until 10 [s] }\n";
static const wh_signal signals[] = {
    {.kind = WH_SIGNAL_OUTPUT, .name = "push", .unit = "1", .high = 1000.0F},
    {.kind = WH_SIGNAL_EDGE, .name = "a", .unit = "rad", .low = 1.0F, .high = 1.1F},
    {.kind = WH_SIGNAL_EDGE, .name = "a", .unit = "rad", .low = 2.5F, .high = 2.6F},
    {.kind = WH_SIGNAL_NOTE, .name = "state", .unit = "1"},
};
static const wh_hello hello = {.program = "bench",
                               .board = "here",
                               .ticks_per_s = TICKS_PER_S,
                               .start_ticks = 0xFFFFF000U, /* the timer wraps soon */
                               .signal = signals,
                               .signals = sizeof signals / sizeof signals[0]};

typedef struct heard {
    double edge_s[EDGES_MAX]; /* reported times of the edges */
    /* time stamps of the edges, from a timer that restarts at 0 with the processor */
    double stamp_s[EDGES_MAX];
    int edges;
    double reset_s[RESETS_MAX];
    double again_s[RESETS_MAX];
    bool starved[RESETS_MAX];
    int resets;
    double push[READS + 1]; /* the plant's input at each reading */
} heard;

static heard h;
static heard well;

/* Advances to until_ticks, with restarts. During a reset, outputs must be zero. */
static void go_on(plant *on, double until_ticks) {
    do {
        TEST_ASSERT_TRUE(plant_advance(on, until_ticks));
        if (on->reset.now) {
            h.reset_s[h.resets] = on->reset.last_ticks / TICKS_PER_S;
            h.starved[h.resets] = on->reset.starved;
            TEST_ASSERT_TRUE(on->in_effect[0] == 0.0);
            TEST_ASSERT_TRUE(plant_advance(on, on->reset.last_ticks + on->reset.takes_ticks));
            TEST_ASSERT_TRUE(on->in_effect[0] == 0.0);
            h.again_s[h.resets++] = plant_now(on) / TICKS_PER_S;
            plant_restart(on);
            TEST_ASSERT_EQUAL_UINT32(hello.start_ticks, plant_ticks(on));
        }
    } while (!plant_has_reached(on, until_ticks));
}

/* Runs the bench with the faults `words`. Orders number i push with the force i. The note `state` becomes 1 with
 * orders number 100, 2 with number 200, and so on. */
static void run_with(const char *words) {
    motion bench;
    plant on;
    binding b;
    fault_plan plan = {.seed = 7};
    const plant_request request = {.seed = 1};
    h = (heard){.edges = 0};
    TEST_ASSERT_TRUE_MESSAGE(words == NULL || fault_read(&plan, words), words);
    const tap t = fault_tap(&plan);
    motion_open_text(&bench, text, IN_DOUBLE);
    TEST_ASSERT_TRUE(bind_signals(&b, &hello, bench.image, NULL));
    plant_start(&on, bench.image, &b, &hello, &request);
    TEST_ASSERT_TRUE(t.start(t.of, &hello, &on));
    for (int i = 1; i <= READS; i++) {
        const int hundreds = i / 100;
        wh_orders o = {.outputs = 2,
                       .flags = WH_ORDER_ALIVE,
                       .watchdog_ticks = WATCHDOG_TICKS,
                       .output = {(float)i, (float)hundreds}};
        wh_readings r;
        double late_s = 0.0;
        t.orders(t.of, plant_now(&on) / TICKS_PER_S, &o, &late_s);
        plant_order(&on, &o, late_s * TICKS_PER_S);
        go_on(&on, i * (double)PERIOD_TICKS);
        plant_read(&on, &r);
        t.readings(t.of, plant_now(&on) / TICKS_PER_S, &r);
        for (unsigned e = 0; e < r.edges; e++) {
            h.edge_s[h.edges] = i * 2e-3;
            h.stamp_s[h.edges++] = (double)(int32_t)(r.edge[e].ticks - hello.start_ticks) / 1e6;
        }
        h.push[i] = on.in_effect[0];
    }
    plant_stop(&on);
    motion_close(&bench);
}

/* A reset must begin once, at the end of the step that contains its time, also between two exchanges. The reset must
 * have the requested length. */
TEST(resets, instants) {
    for (int i = 0; i < 40; i++) {
        const double at_s = 0.2 + i * 0.01037;
        const double takes_s = 0.0005 + i * 0.0007;
        char words[80];
        snprintf(words, sizeof words, "reset=%.6f@%.6f", takes_s, at_s);
        run_with(words);
        TEST_ASSERT_EQUAL_INT(1, h.resets);
        TEST_ASSERT_TRUE(h.reset_s[0] >= at_s - 1e-9 && h.reset_s[0] < at_s + 1e-3);
        const double took_s = h.again_s[0] - h.reset_s[0];
        TEST_ASSERT_TRUE(took_s >= takes_s - 1e-9 && took_s < takes_s + 1e-3);
        TEST_ASSERT_FALSE(h.starved[0]);
    }
    run_with("reset@state=2~101ms,reset@0.7,reset@0.9");
    TEST_ASSERT_EQUAL_INT(3, h.resets);
    TEST_ASSERT_TRUE(fabs(h.reset_s[0] - 0.499) < 1.1e-3 && fabs(h.reset_s[1] - 0.7) < 1.1e-3 &&
                     fabs(h.reset_s[2] - 0.9) < 1.1e-3);
    run_with("reset=0.1@0.5,reset=0.1@0.55"); /* the second begins after the first */
    TEST_ASSERT_TRUE(h.resets == 2 && h.reset_s[1] >= 0.6);
}

/* Data on their way to the processor are lost, and the timer restarts. */
TEST(resets, reset_loses_incoming_data) {
    run_with(NULL);
    well = h;
    TEST_ASSERT_EQUAL_INT(4, well.edges);
    run_with("edge-late=0.3,reset@0.3"); /* two edges are on their way */
    TEST_ASSERT_EQUAL_INT(2, h.edges);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE(fabs(h.stamp_s[i] + h.again_s[0] - well.stamp_s[2 + i]) < 1.1e-6);
        TEST_ASSERT_TRUE(fabs(h.edge_s[i] - well.edge_s[2 + i] - 0.3) < 1e-9);
    }
    run_with("reset=0.15@0.07"); /* two edges arrive during the reset */
    TEST_ASSERT_EQUAL_INT(2, h.edges);
    run_with("orders-lost=1@0.397,reset@0.4"); /* the orders before the reset are lost, too */
    TEST_ASSERT_TRUE(h.push[200] > 0.0 && h.push[210] == 0.0);
    run_with("late=1.5ms@0.3,reset=10ms@0.401"); /* orders that are not yet in effect are lost */
    TEST_ASSERT_TRUE(h.resets == 1 && h.push[200] > 0.0 && h.push[201] == 0.0);
}

/* Without kicks the watchdog cuts the power, or resets the processor, which must then be restarted. */
TEST(resets, watchdog) {
    run_with("unkicked@0.5");
    TEST_ASSERT_TRUE(h.resets == 0 && h.push[240] > 0.0 && h.push[260] == 0.0);
    run_with("watchdog-resets@0.6"); /* no reset while the firmware kicks */
    TEST_ASSERT_TRUE(h.resets == 0 && h.push[READS] == (double)READS);
    run_with("watchdog-resets=3ms,unkicked@0.5+5ms");
    TEST_ASSERT_TRUE(h.resets == 1 && h.starved[0]);
    TEST_ASSERT_TRUE(h.reset_s[0] > 0.503 && h.reset_s[0] < 0.506);
    TEST_ASSERT_TRUE(fabs(h.again_s[0] - h.reset_s[0] - 3e-3) < 1e-9);
    TEST_ASSERT_TRUE(h.push[READS] == (double)READS); /* the power is not cut permanently */
    run_with("watchdog-resets@0+0.4,unkicked@0.5");   /* no reset after 0.4 s: power cut */
    TEST_ASSERT_TRUE(h.resets == 0 && h.push[READS] == 0.0);
    run_with("watchdog-resets=0,unkicked@0.5"); /* a reset after each restart */
    TEST_ASSERT_TRUE(h.resets > 50);
}
