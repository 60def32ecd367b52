/* test_plant.c: sensors and actuators of a scene, compared with closed forms: times of edges, samples, effect of
 * orders, watchdog. Also the binding of signals to quantities. */
#include "derived.h"
#include "host/pil/lockstep.h"
#include "host/pil/plant.h"
#include "motion.h"

#define TICKS_PER_S 1000000U
#define TURN_RAD 6.283185307179586477

/* A free rotor, a spring, and a mass that an input pushes. */
static const char *const text =
    "mechanism bench \"three of them\"\n"
    "coordinate a [rad]\ncoordinate x [m]\ncoordinate y [m]\n"
    "input push = 0 [N]\n"
    "parameter k = 100 [N/m]\n"
    "T = 1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2\n"
    "V = k*x^2/2\n"
    "Q(y) = push\n"
    "output twice [m] = 2*x\n"
    "scene s { start a = %.17g, a' = %.17g [rad/s], x = 1 [m], x' = 0; step %.17g [s]; until 10 [s] }\n";

static motion bench;
static plant on;
static binding bound_to;
static wh_hello hello;
static wh_signal signals[WH_SIGNALS_MAX];

static void open_bench(double a_rad, double a_radps, double step_s, const plant_request *request) {
    char words[1000];
    snprintf(words, sizeof words, text, a_rad, a_radps, step_s);
    motion_open_text(&bench, words, IN_DOUBLE);
    hello.program = "bench";
    hello.board = "here";
    hello.ticks_per_s = TICKS_PER_S;
    hello.start_ticks = 0xFFFFFF00U; /* the timer wraps soon */
    hello.signal = signals;
    TEST_ASSERT_TRUE(bind_signals(&bound_to, &hello, bench.image, NULL));
    plant_start(&on, bench.image, &bound_to, &hello, request);
}

static void close_bench(void) {
    plant_stop(&on);
    motion_close(&bench);
    hello.signals = 0;
}

static void add(wh_signal signal) { signals[hello.signals++] = signal; }

static wh_signal edge(const char *name, const char *unit, float low, float high) {
    return (wh_signal){
        .kind = WH_SIGNAL_EDGE, .name = name, .unit = unit, .low = low, .high = high};
}

/* Reads every 2 ms until until_s. at_s[]: times of the edges of channel 0, in s. Returns the number of edges. */
static int edges_until(double until_s, double *at_s, int most) {
    int count = 0;
    const int reads = (int)(until_s * TICKS_PER_S / 2000.0 + 0.5);
    for (int read = 1; read <= reads; read++) {
        const double t = 2000.0 * read;
        wh_readings r;
        TEST_ASSERT_TRUE(plant_advance(&on, t));
        plant_read(&on, &r);
        uint32_t last = 0;
        for (unsigned i = 0; i < r.edges; i++) {
            const uint32_t since = r.edge[i].ticks - hello.start_ticks;
            TEST_ASSERT_TRUE(since >= last && since <= (uint32_t)t);
            last = since;
            if (r.edge[i].channel == 0 && count < most) {
                at_s[count++] = (double)since / TICKS_PER_S;
            }
        }
    }
    return count;
}

/* Once in a turn, the angle enters the range: at its lower end if the angle increases, else at its upper end. */
TEST(plant, edges_of_an_angle) {
    uint64_t seed = 1;
    for (int round = 0; round < 60; round++) {
        const double speed =
            (random_bits(&seed) % 2 == 0 ? 1.0 : -1.0) * pow(10.0, random_between(&seed, 0.5, 2.0));
        const double start = random_between(&seed, -10.0, 10.0);
        const double middle = random_between(&seed, -3.0, 3.0);
        const float low = (float)(middle - 0.02);
        const float high = (float)(middle + 0.02);
        const plant_request request = {.place = {random_between(&seed, -5.0, 5.0)}};
        add(edge("a", "rad", low, high));
        open_bench(start, speed, 50e-6, &request);
        double at_s[64];
        const int count = edges_until(1.0, at_s, 64);
        close_bench();
        const double level =
            (double)(speed > 0.0 ? low : high) + request.place[0] * TURN_RAD / 360.0;
        double turns = (level - start) / TURN_RAD * (speed > 0.0 ? 1.0 : -1.0);
        turns -= floor(turns); /* part of a turn before the first edge */
        const int wanted = (int)(fabs(speed) / TURN_RAD - turns + 1.0); /* edges in 1 s */
        TEST_ASSERT_INT_WITHIN(1, wanted, count); /* one more or less at the end of the second */
        for (int i = 0; i < count; i++) {
            const double t = (turns + i) * TURN_RAD / fabs(speed);
            /* the timer drops fractions of a tick */
            TEST_ASSERT_TRUE(at_s[i] <= t + 1e-9 && at_s[i] > t - 1e-6 - 1e-9);
        }
    }
}

/* x = cos(10 t) enters a range twice in a period. So does an output that is 2 x and has no rate. */
TEST(plant, edges_of_a_length) {
    for (int output = 0; output < 2; output++) {
        const float low = 0.2F;
        const float high = 0.4F;
        const float scale = output == 1 ? 2.0F : 1.0F;
        const plant_request request = {.seed = 1};
        add(edge(output == 1 ? "twice" : "x", "m", scale * low, scale * high));
        open_bench(0.0, 0.0, 50e-6, &request);
        double at_s[32];
        const int count = edges_until(2.0, at_s, 32);
        close_bench();
        int wanted = 0;
        for (int turn = 0; turn < 3; turn++) {
            const double down = (acos((double)high) + turn * TURN_RAD) / 10.0;
            const double up = (TURN_RAD - acos((double)low) + turn * TURN_RAD) / 10.0;
            const double both[2] = {down, up};
            for (int i = 0; i < 2; i++) {
                TEST_ASSERT_TRUE(wanted < count);
                TEST_ASSERT_TRUE(fabs(at_s[wanted++] + 0.5e-6 - both[i]) < 0.6e-6);
            }
        }
    }
}

/* Jitter must have the requested deviation, and no edge may come before its time. */
TEST(plant, jitter) {
    const plant_request request = {.jitter_s = 20e-6, .seed = 5};
    const double speed = 100.0;
    add(edge("a", "rad", -0.01F, 0.01F));
    open_bench(1.0, speed, 50e-6, &request);
    double at_s[200];
    const int count = edges_until(10.0, at_s, 200);
    close_bench();
    TEST_ASSERT_INT_WITHIN(1, 159, count);
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < count; i++) {
        const double off = at_s[i] + 0.5e-6 - ((double)-0.01F - 1.0 + (i + 1) * TURN_RAD) / speed;
        sum += off;
        squares += off * off;
    }
    /* for 159 edges: four standard errors of the mean, and three and a half of the deviation */
    TEST_ASSERT_TRUE(fabs(sum / count) < 4.0 * 20e-6 / sqrt(count));
    TEST_ASSERT_TRUE(fabs(sqrt(squares / count) / 20e-6 - 1.0) < 0.2);
}

static wh_signal sample(float per_count, float most, uint32_t period_ticks) {
    return (wh_signal){.kind = WH_SIGNAL_SAMPLE,
                       .name = "x",
                       .unit = "m",
                       .low = -most,
                       .high = most,
                       .per_count = per_count,
                       .period_ticks = period_ticks};
}

/* cos(10 t) in counts, at the requested times only, with the requested delay. */
TEST(plant, samples) {
    const double delays_s[] = {0.0, 150e-6, 1.3e-3};
    for (int d = 0; d < 3; d++) {
        const plant_request request = {.delay_s = delays_s[d]};
        unsigned seen = 0;
        unsigned saturated = 0;
        add(sample(1e-4F, 0.9F, 500));
        open_bench(0.0, 0.0, 50e-6, &request);
        for (int read = 1; read <= 500; read++) {
            wh_readings r;
            TEST_ASSERT_TRUE(plant_advance(&on, 2000.0 * read));
            plant_read(&on, &r);
            for (unsigned i = 0; i < r.samples; i++) {
                const double stamp_s = (r.sample[i].ticks - hello.start_ticks) / 1e6;
                const double at_s = ++seen * 500e-6;
                TEST_ASSERT_TRUE(fabs(stamp_s - at_s - delays_s[d]) < 1e-6);
                const double x = cos(10.0 * at_s);
                const double held = x > (double)0.9F    ? (double)0.9F
                                    : x < -(double)0.9F ? -(double)0.9F
                                                        : x;
                TEST_ASSERT_TRUE(fabs(r.sample[i].raw - held / (double)1e-4F) < 0.501);
                TEST_ASSERT_EQUAL_INT(held != x, r.sample[i].status == WH_SAMPLE_SATURATED);
                saturated += held != x;
            }
        }
        TEST_ASSERT_EQUAL_UINT((unsigned)((1.0 - delays_s[d]) / 500e-6 + 1e-6), seen);
        TEST_ASSERT_TRUE(saturated > 100 && saturated < seen - 100);
        TEST_ASSERT_EQUAL_UINT(0, on.lost);
        close_bench();
    }
}

/* Counts at both ends of a range must fit into 32 bits. If the range is accepted, samples must reach both ends
 * exactly. */
TEST(plant, ranges) {
    const plant_request request = {.seed = 1};
    uint64_t seed = 3;
    int taken = 0;
    fputs("(refusals of ranges follow)\n", stderr);
    for (int round = 0; round < 100; round++) {
        const wh_signal s = {.kind = WH_SIGNAL_SAMPLE,
                             .name = "x",
                             .unit = "m",
                             .low = (float)random_between(&seed, -0.9, 0.0),
                             .high = (float)random_between(&seed, 0.0, 0.9),
                             .per_count = (float)pow(10.0, random_between(&seed, -11.0, -8.5)),
                             .period_ticks = 1000};
        const double least = (double)s.low / (double)s.per_count;
        const double most = (double)s.high / (double)s.per_count;
        if (least < -2147483648.0 || most > 2147483647.0) {
            open_bench(0.0, 0.0, 1e-3, &request);
            binding b;
            const wh_hello of = {.program = "p", .ticks_per_s = 1000, .signal = &s, .signals = 1};
            TEST_ASSERT_FALSE(bind_signals(&b, &of, bench.image, NULL));
            close_bench();
            continue;
        }
        wh_readings r;
        taken++;
        add(s);
        open_bench(0.0, 0.0, 1e-3, &request); /* x = cos(10 t) */
        TEST_ASSERT_TRUE(plant_advance(&on, 1000.0));
        plant_read(&on, &r);
        TEST_ASSERT_EQUAL_UINT(1, r.samples);
        TEST_ASSERT_EQUAL_INT(WH_SAMPLE_SATURATED, r.sample[0].status);
        TEST_ASSERT_TRUE(fabs((double)r.sample[0].raw - most) <= 0.5);
        for (int read = 1; read <= 157; read++) {
            TEST_ASSERT_TRUE(plant_advance(&on, 1000.0 + 2000.0 * read));
            plant_read(&on, &r);
        }
        TEST_ASSERT_EQUAL_UINT(2, r.samples);
        TEST_ASSERT_EQUAL_INT(WH_SAMPLE_SATURATED, r.sample[0].status);
        TEST_ASSERT_TRUE(fabs((double)r.sample[0].raw - least) <= 0.5);
        close_bench();
    }
    TEST_ASSERT_TRUE(taken > 20 && taken < 80);
}

/* If there are more samples than a reading can hold, the newest must be lost and counted. */
TEST(plant, too_many) {
    const plant_request request = {.seed = 1};
    wh_readings r;
    add(sample(1e-4F, 2.0F, 50));
    open_bench(0.0, 0.0, 50e-6, &request);
    TEST_ASSERT_TRUE(plant_advance(&on, 2000.0));
    plant_read(&on, &r);
    TEST_ASSERT_EQUAL_UINT(WH_SAMPLES_MAX, r.samples);
    TEST_ASSERT_EQUAL_UINT32(50, r.sample[0].ticks - hello.start_ticks);
    TEST_ASSERT_EQUAL_UINT(40 - WH_SAMPLES_MAX, on.lost);
    plant_read(&on, &r);
    TEST_ASSERT_EQUAL_UINT(0, r.samples);
    close_bench();
}

static double speed_of_y(void) {
    double angle[8];
    double real[16];
    engine_double.state(on.run, angle, real);
    const component last =
        image_component(bench.image, bench.image->angles + bench.image->reals - 1);
    TEST_ASSERT_TRUE(last.unknown == 2 && last.primes == 1);
    return real[bench.image->reals - 1];
}

static void add_push(void) {
    add((wh_signal){
        .kind = WH_SIGNAL_OUTPUT, .name = "push", .unit = "N", .low = -2.0F, .high = 2.0F});
}

/* A push of 1 N on 1 kg acts from the first step that does not begin before its delay. The speed at the end is
 * 1 m/s^2 times the time since then. */
TEST(plant, late_orders) {
    for (int late = 0; late <= 1000; late += 125) {
        const plant_request request = {.seed = 1};
        add_push();
        open_bench(0.0, 0.0, 50e-6, &request);
        const wh_orders orders = {.outputs = 1, .output = {1.0F}};
        plant_order(&on, &orders, late);
        TEST_ASSERT_TRUE(plant_advance(&on, 4000.0));
        const double begins_s = ceil(late / 50.0 - 1e-9) * 50e-6;
        TEST_ASSERT_TRUE(fabs(speed_of_y() - (4e-3 - begins_s)) < 1e-12);
        close_bench();
    }
}

/* A note belongs to no quantity of the plant and must change nothing. Outputs must keep their channels. */
TEST(plant, notes) {
    const plant_request request = {.seed = 1};
    add((wh_signal){.kind = WH_SIGNAL_NOTE, .name = "state", .unit = "1"});
    add_push();
    add((wh_signal){.kind = WH_SIGNAL_NOTE, .name = "x", .unit = "kg"});
    open_bench(0.0, 0.0, 50e-6, &request);
    TEST_ASSERT_EQUAL_UINT(1, bound_to.bound[2].channel);
    TEST_ASSERT_EQUAL_UINT(0, bound_to.bound[1].channel);
    const wh_orders orders = {.outputs = 3, .output = {1.0F, NAN, -7.0F}};
    plant_order(&on, &orders, 0.0);
    TEST_ASSERT_TRUE(plant_advance(&on, 4000.0));
    TEST_ASSERT_TRUE(fabs(speed_of_y() - 4e-3) < 1e-12);
    close_bench();
}

/* The plant limits outputs to the declared range. A NaN, which ends a run (lockstep.c), counts as the lower limit. */
TEST(plant, outputs_are_limited_to_their_ranges) {
    const float asked[] = {5.0F, -5.0F, 0.5F, NAN};
    const double taken[] = {2.0, -2.0, 0.5, -2.0};
    for (int i = 0; i < 4; i++) {
        const plant_request request = {.seed = 1};
        add_push();
        open_bench(0.0, 0.0, 50e-6, &request);
        const wh_orders orders = {.outputs = 1, .output = {asked[i]}};
        plant_order(&on, &orders, 0.0);
        TEST_ASSERT_TRUE(plant_advance(&on, 1000.0));
        TEST_ASSERT_TRUE(fabs(speed_of_y() - taken[i] * 1e-3) < 1e-12);
        close_bench();
    }
}

/* The watchdog is kicked at time 0 only. After 10 ms and one step, the push must end for good, and the report must
 * say so. */
TEST(plant, watchdog) {
    const plant_request request = {.seed = 1};
    wh_readings r;
    add_push();
    open_bench(0.0, 0.0, 50e-6, &request);
    wh_orders orders = {
        .outputs = 1, .output = {1.0F}, .watchdog_ticks = 10000, .flags = WH_ORDER_ALIVE};
    for (int turn = 0; turn < 10; turn++) {
        plant_order(&on, &orders, 0.0);
        TEST_ASSERT_TRUE(plant_advance(&on, (turn + 1) * 2000.0));
        plant_read(&on, &r);
        TEST_ASSERT_EQUAL_INT(turn < 5 ? 0 : WH_READING_CUT, r.flags);
        orders.flags = turn == 7 ? WH_ORDER_ALIVE : 0; /* the watchdog has cut the power before */
    }
    TEST_ASSERT_TRUE(fabs(speed_of_y() - 10.05e-3) < 1e-12);
    TEST_ASSERT_TRUE(fabs(on.cut_ticks - 10050.0) < 1e-6);
    close_bench();
}

static bool binds(const char *name, const char *unit, wh_signal_kind kind, const char *renames) {
    binding b;
    const wh_signal one = {.kind = kind,
                           .name = name,
                           .unit = unit,
                           .high = 1.0F,
                           .per_count = 1.0F,
                           .period_ticks = 1};
    const wh_hello of = {
        .program = "p", .board = "b", .ticks_per_s = 1, .signal = &one, .signals = 1};
    return bind_signals(&b, &of, bench.image, renames);
}

TEST(plant, names) {
    const plant_request request = {.seed = 1};
    open_bench(0.0, 0.0, 1e-3, &request);
    TEST_ASSERT_TRUE(binds("x'", "m/s", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_TRUE(binds("a'", "1/s", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_TRUE(binds("twice", "m", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_TRUE(binds("other", "m", WH_SIGNAL_EDGE, "other=x"));
    TEST_ASSERT_TRUE(binds("x", "rad", WH_SIGNAL_EDGE, "x=a"));
    fputs("(seven refusals follow)\n", stderr);
    TEST_ASSERT_FALSE(binds("x'", "m", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_FALSE(binds("x''", "m/s^2", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_FALSE(binds("push", "N", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_FALSE(binds("x", "m", WH_SIGNAL_OUTPUT, NULL));
    TEST_ASSERT_FALSE(binds("", "m", WH_SIGNAL_SAMPLE, NULL));
    TEST_ASSERT_FALSE(binds("x", "m", WH_SIGNAL_SAMPLE, "y=x"));
    TEST_ASSERT_FALSE(binds("x", "m", WH_SIGNAL_SAMPLE, "x"));
    close_bench();
}

/* Equal orders with different counts must have equal hashes. A change in any other field must change the hash. */
TEST(plant, hash) {
    const wh_orders base = {
        .until_ticks = 1, .watchdog_ticks = 2, .flags = 1, .outputs = 2, .output = {1.0F, 2.0F}};
    wh_orders other = base;
    const uint64_t hash = talk_hash(7, &base);
    other.acted_timer = 5;
    other.busy_timer = 6;
    TEST_ASSERT_TRUE(talk_hash(7, &other) == hash);
    TEST_ASSERT_TRUE(talk_hash(8, &base) != hash);
    for (int i = 0; i < 5; i++) {
        other = base;
        other.until_ticks += i == 0;
        other.watchdog_ticks += i == 1;
        other.flags = (uint8_t)(other.flags + (i == 2));
        other.outputs -= i == 3;
        other.output[1] = i == 4 ? -2.0F : other.output[1];
        TEST_ASSERT_TRUE(talk_hash(7, &other) != hash);
    }
}
