/* test_pil.c: processor in the loop: the dialogue with a rig before a recording, and faults. */
#include "host/monitor/wire.h"
#include "host/pil/fault.h"

#include "command.h"
#include "derived.h"
#include "motion.h"

/* === suite dialogue =========================================================================== */
/* Questions to a rig before a recording. The line may have answers for another program, half a line, half a frame,
 * an echo, or late and repeated answers. The test's rig answers each complete line in sequence. */

enum { LINES = 64 };

typedef struct rig {
    char said[LINES][128];
    int begin;
    int end;
    bool echoes;
    bool refuses_rate;
    int heard;     /* number of questions received */
    char half[16]; /* a line typed in part */
    char junk[16]; /* the end of a frame before the rig's first answer */
} rig;

static void say(rig *r, const char *line) {
    TEST_ASSERT_TRUE(r->end < LINES);
    snprintf(r->said[r->end++], sizeof r->said[0], "%s%s", r->junk, line);
    r->junk[0] = '\0';
}

static const char *answer_of(const rig *r, const char *line) {
    static const char *const answers[][2] = {
        {"id\n", "OK program=rig board=none dialogue=1"},
        {"talk off\n", "OK"},
        {"tel list\n", "OK rate=0 fmt=frames dropped=0 channels=run,event,ring"},
        {"tel off\n", "OK"},
        {"tel fmt frames\n", "OK fmt=frames"},
        {"tel schema run\n", "OK channel=0 name=run period_ticks=2000 once= each="},
        {"tel schema event\n", "OK channel=1 name=event period_ticks=0 once= each="},
        {"tel schema ring\n", "OK channel=2 name=ring period_ticks=0 once= each="},
        {"tel schema states\n", "OK 0=idle 1=armed"},
        {"tel rate 125\n", "OK rate=125 period_ticks=8000"}};
    for (size_t i = 0; i < sizeof answers / sizeof answers[0]; i++) {
        if (strcmp(line, answers[i][0]) == 0) {
            return r->refuses_rate && strncmp(line, "tel rate", 8) == 0 ? "ERR 116 not so many"
                                                                        : answers[i][1];
        }
    }
    return "ERR 100 no such command";
}

static void hear(rig *r, const char *line) {
    char whole[96];
    snprintf(whole, sizeof whole, "%s%s", r->half, line);
    r->half[0] = '\0';
    if (r->echoes) {
        whole[strcspn(whole, "\n")] = '\0';
        say(r, whole);
        snprintf(whole, sizeof whole, "%s", line);
    }
    r->echoes = r->echoes && strcmp(line, "talk off\n") != 0;
    if (strcmp(whole, "\n") != 0 && whole[0] != '\0') {
        say(r, answer_of(r, whole));
    }
    r->heard++;
}

static void leave(rig *r, dice *d) {
    static const char *const left[] = {"OK",
                                       "ERR 101 the line is too long",
                                       "ERR 116 not so many",
                                       "OK rate=500 period_ticks=2000",
                                       "OK state=idle speed_rpm=0.00",
                                       ">load_N:56.064",
                                       "# idle",
                                       "OK rate=500 fmt=frames dropped=0 channels=run",
                                       "D D \x07\x1b[2J",
                                       "K fmt=frames",
                                       ""};
    for (unsigned i = dice_one_of(d, 5); i > 0; i--) {
        say(r, left[dice_one_of(d, sizeof left / sizeof left[0])]);
    }
    if (dice_one_of(d, 2) == 0) {
        snprintf(r->half, sizeof r->half, "%s", dice_one_of(d, 2) == 0 ? "sta" : "start 330");
    }
    snprintf(r->junk, sizeof r->junk, "%s", dice_one_of(d, 3) == 0 ? "D \x9b\x02`" : "");
    r->echoes = dice_one_of(d, 3) == 0;
}

static void question(const dialogue *d, rig *r) {
    char line[DIALOGUE_LINE];
    const char *asked = dialogue_question(d, line);
    if (asked != NULL) {
        hear(r, asked);
    }
}

/* Some lines come after the timeout, when the question has been repeated. */
static void converse(dialogue *link, rig *r, dice *d) {
    hear(r, "\n");
    question(link, r);
    for (int turns = 0; !link->done && turns < 4 * LINES; turns++) {
        if (r->begin == r->end || (!r->refuses_rate && dice_one_of(d, 6) == 0)) {
            question(link, r);
            continue;
        }
        const int asked = link->asked;
        (void)dialogue_answer(link, r->said[r->begin++]);
        TEST_ASSERT_TRUE(link->asked == asked || link->asked == asked + 1);
        if (link->asked > asked) {
            question(link, r);
        }
    }
}

static void one_case(dice *d) {
    static rig r;
    r = (rig){.refuses_rate = dice_one_of(d, 4) == 0};
    dialogue link = {.rate = 125};
    leave(&r, d);
    converse(&link, &r, d);
    TEST_ASSERT_TRUE(link.done);
    /* the rig's own answer says that the motor is off; older answers have another state */
    TEST_ASSERT_TRUE(link.was_off);
    TEST_ASSERT_EQUAL(r.refuses_rate, link.rate_refused);
    TEST_ASSERT_EQUAL_STRING(r.refuses_rate ? "tel rate 125: ERR 116 not so many" : "",
                             link.refused);
    TEST_ASSERT_EQUAL(10, link.asked);
    TEST_ASSERT_FALSE(dialogue_answer(&link, "OK")); /* an answer to another program */
}

TEST(dialogue, dialogue_ends_for_any_line) {
    dice d = dice_of("dialogue", 1);
    for (unsigned i = dice_cases(few_or_all(2000, 100000)); i > 0; i--) {
        one_case(&d);
    }
}

TEST(dialogue, answers_of_no_rig_are_ignored) {
    dialogue d = {.rate = 500};
    const char *const lines[] = {"OK", "ERR 100 no such command", "hello", "talk off",
                                 "OK rate=0 "};
    for (int i = 0; i < 100; i++) {
        (void)dialogue_answer(&d, lines[i % 5]);
    }
    TEST_ASSERT_EQUAL(0, d.asked);
    TEST_ASSERT_FALSE(d.done);
    TEST_ASSERT_EQUAL_STRING("", d.refused);
}

/* === suite fault ============================================================================== */
/* Faults in the loop must do what their words say: missing and extra pulses and samples, the plant's inputs during a
 * fault and after it, and times of orders. Also refused words. */

#define TICKS_PER_S 1000000U
#define PERIOD_TICKS 2000U
#define READS 500 /* one second, at PERIOD_TICKS */
#define EVENTS_MAX 9000

/* A rotor with two turns a second. Every input that a fault can change is also an output. */
static const char *const text =
    "mechanism bench \"what may break\"\n"
    "coordinate a [rad]\n"
    "T = 1 [kg*m^2]*a'^2/2\n"
    "input push = 0 [V]\ninput volts = 24 [V]\ninput freewheel = 0\ninput runaway = 0\ninput enable_stuck = 0\n"
    "input stall = 1.5 [N*m]\ninput bearing_friction = 0.01 [N*m]\ninput k = 20 [N*m/rad]\n"
    "input cell_gain = 1\ninput cell_offset = 0 [N]\ninput stop_pressed = 0\n"
    "output force [N] = 40 [N] + cell_offset + 10 [N]*sin(a)\n"
    "output o0 [V] = volts\noutput o1 = freewheel\noutput o2 = runaway\noutput o3 = enable_stuck\n"
    "output o4 [N*m] = stall\noutput o5 [N*m] = bearing_friction\noutput o6 [N*m] = k\n"
    "output o7 = cell_gain\noutput o8 [N] = cell_offset\noutput o9 = stop_pressed\n"
    "scene s { start a' = 2 [rev/s]; step 1 [ms]; until 10 [s] }\n";
enum { INPUTS = 10 };
static const double healthy[INPUTS] = {24.0, 0.0, 0.0, 0.0, 1.5, 0.01, 20.0, 1.0, 0.0, 0.0};

static const wh_signal signals[] = {
    {.kind = WH_SIGNAL_OUTPUT, .name = "push", .unit = "V", .high = 24.0F},
    {.kind = WH_SIGNAL_EDGE, .name = "a", .unit = "rad", .low = 1.0F, .high = 1.1F},
    {.kind = WH_SIGNAL_EDGE, .name = "a", .unit = "rad", .low = 2.5F, .high = 2.6F},
    {.kind = WH_SIGNAL_SAMPLE,
     .name = "force",
     .unit = "N",
     .low = -100.0F,
     .high = 100.0F,
     .per_count = 0.01F,
     .period_ticks = PERIOD_TICKS},
    {.kind = WH_SIGNAL_SAMPLE,
     .name = "a'",
     .unit = "rad/s",
     .low = -100.0F,
     .high = 100.0F,
     .per_count = 0.01F,
     .period_ticks = PERIOD_TICKS},
    {.kind = WH_SIGNAL_NOTE, .name = "state", .unit = "1"},
};
static const wh_hello hello = {.program = "bench",
                               .board = "here",
                               .ticks_per_s = TICKS_PER_S,
                               .start_ticks = 0xFFFFF000U, /* the timer wraps soon */
                               .signal = signals,
                               .signals = sizeof signals / sizeof signals[0]};

/* The pulses and samples of one second, and the plant's inputs at each reading. */
typedef struct heard {
    wh_edge edge[EVENTS_MAX];
    double edge_s[EVENTS_MAX]; /* reported times of the edges */
    int edges;
    wh_sample sample[EVENTS_MAX];
    double sample_s[EVENTS_MAX];
    int samples;
    double input[READS + 1][INPUTS];
    wh_orders orders[READS + 1];
    double late_s[READS + 1];
} heard;

static heard well;
static heard ill;

/* Runs the bench with the faults `words`. The note `state` becomes 1 with orders number 100, 2 with number 200, and
 * so on. */
static void run_with(const char *words, heard *h) {
    motion bench;
    plant on;
    binding b;
    fault_plan plan = {.seed = 7};
    const plant_request request = {.seed = 1};
    *h = (heard){.edges = 0};
    TEST_ASSERT_TRUE_MESSAGE(words == NULL || fault_read(&plan, words), words);
    const tap t = fault_tap(&plan);
    motion_open_text(&bench, text, IN_DOUBLE);
    TEST_ASSERT_TRUE(bind_signals(&b, &hello, bench.image, NULL));
    plant_start(&on, bench.image, &b, &hello, &request);
    TEST_ASSERT_TRUE(t.start(t.of, &hello, &on));
    for (int i = 1; i <= READS; i++) {
        const double before_s = (i - 1) * 2e-3;
        wh_orders *o = &h->orders[i];
        wh_readings r;
        double output[INPUTS + 1];
        const int state = i / 100;
        *o = (wh_orders){.outputs = 2,
                         .flags = WH_ORDER_ALIVE,
                         .watchdog_ticks = 77,
                         .acted_timer = 10,
                         .busy_timer = 20,
                         .until_ticks = (uint32_t)i,
                         .output = {(float)i, (float)state}};
        t.orders(t.of, before_s, o, &h->late_s[i]);
        TEST_ASSERT_TRUE(plant_advance(&on, i * (double)PERIOD_TICKS));
        plant_read(&on, &r);
        t.readings(t.of, i * 2e-3, &r);
        for (unsigned e = 0; e < r.edges; e++) {
            h->edge_s[h->edges] = i * 2e-3;
            h->edge[h->edges++] = r.edge[e];
        }
        for (unsigned s = 0; s < r.samples; s++) {
            h->sample_s[h->samples] = i * 2e-3;
            h->sample[h->samples++] = r.sample[s];
        }
        engine_double.outputs(on.run, output);
        memcpy(h->input[i], output + 1, sizeof h->input[i]);
    }
    plant_stop(&on);
    motion_close(&bench);
}

static double second_of(uint32_t ticks) {
    return (double)(int32_t)(ticks - hello.start_ticks) / TICKS_PER_S;
}

static int edges_of(const heard *h, int channel) {
    int count = 0;
    for (int i = 0; i < h->edges; i++) {
        count += h->edge[i].channel == channel;
    }
    return count;
}

/* A healthy rotor makes two turns, which give four alternating pulses. */
TEST(fault, edges) {
    run_with(NULL, &well);
    TEST_ASSERT_EQUAL_INT(4, well.edges);
    run_with("edge-dead", &ill);
    TEST_ASSERT_EQUAL_INT(0, ill.edges);
    run_with("edge-dead:2", &ill);
    TEST_ASSERT_TRUE(edges_of(&ill, 0) == 2 && edges_of(&ill, 1) == 0);
    run_with("edge-dead@0.3+500ms", &ill); /* pulses at 0.080, 0.199, 0.580, 0.699 s */
    TEST_ASSERT_TRUE(ill.edges == 2 && ill.edge[1].ticks == well.edge[1].ticks);
    run_with("edge-lost=3", &ill);
    TEST_ASSERT_TRUE(ill.edges == 1 && ill.edge[0].ticks == well.edge[3].ticks);
    run_with("edge-lost=1@0.1", &ill);
    TEST_ASSERT_TRUE(ill.edges == 3 && ill.edge[1].ticks == well.edge[2].ticks);
    run_with("edge-swapped", &ill);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(ill.edge[i].ticks == well.edge[i].ticks &&
                         ill.edge[i].channel == 1 - well.edge[i].channel);
    }
    run_with("edge-double=10ms", &ill);
    TEST_ASSERT_EQUAL_INT(8, ill.edges);
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_UINT32(well.edge[i / 2].ticks + (i % 2 ? 10000U : 0U), ill.edge[i].ticks);
        TEST_ASSERT_TRUE(ill.edge_s[i] >= second_of(ill.edge[i].ticks));
    }
    run_with("edge-late=50ms", &ill);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(ill.edge[i].ticks == well.edge[i].ticks &&
                         fabs(ill.edge_s[i] - well.edge_s[i] - 50e-3) < 1e-9);
    }
    run_with("edge-stamp=1us", &ill);
    TEST_ASSERT_EQUAL_UINT32(well.edge[2].ticks + 1U, ill.edge[2].ticks);
    run_with("edge-stamp:1=-0.01", &ill);
    TEST_ASSERT_EQUAL_UINT32(well.edge[2].ticks - 10000U, ill.edge[2].ticks);
    TEST_ASSERT_EQUAL_UINT32(well.edge[3].ticks, ill.edge[3].ticks);
    run_with("edge-place:2=36@state=3", &ill); /* from 0.6 s on, 50 ms late: a tenth of a turn */
    TEST_ASSERT_EQUAL_UINT32(well.edge[1].ticks, ill.edge[1].ticks);
    TEST_ASSERT_UINT32_WITHIN(1, well.edge[3].ticks + 50000U, ill.edge[3].ticks);
    run_with("edge-jitter=1ms", &ill);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(ill.edge[i].ticks != well.edge[i].ticks);
        TEST_ASSERT_UINT32_WITHIN(6000, well.edge[i].ticks, ill.edge[i].ticks);
    }
}

TEST(fault, invented_pulses) {
    run_with(NULL, &well);
    for (int count = 1; count <= 5; count++) {
        char words[40];
        snprintf(words, sizeof words, "edge-invented=%d@0.1", count);
        run_with(words, &ill);
        TEST_ASSERT_EQUAL_INT(4 + count, ill.edges);
    }
    run_with("edge-storm:1=1000@0.2+500ms", &ill);
    TEST_ASSERT_INT_WITHIN(3, 502, edges_of(&ill, 0));
    TEST_ASSERT_EQUAL_INT(2, edges_of(&ill, 1));
    for (int i = 1; i < ill.edges; i++) {
        TEST_ASSERT_TRUE((int32_t)(ill.edge[i].ticks - ill.edge[i - 1].ticks) >= 0);
        TEST_ASSERT_TRUE(ill.edge_s[i] >= second_of(ill.edge[i].ticks));
    }
    run_with("edge-storm=1e6", &ill); /* the buffer limits the number of edges */
    TEST_ASSERT_TRUE(ill.edges > 4000 && ill.edges <= READS * (int)WH_EDGES_MAX);
}

static int samples_of(const heard *h, int channel, const wh_sample **first) {
    int count = 0;
    *first = &h->sample[0];
    for (int i = h->samples - 1; i >= 0; i--) {
        if (h->sample[i].channel == channel) {
            *first = &h->sample[i];
            count++;
        }
    }
    return count;
}

static void raws_of(const heard *h, double *least, double *most, double *mean) {
    int count = 0;
    *least = (double)INFINITY;
    *most = -(double)INFINITY;
    *mean = 0.0;
    for (int i = 0; i < h->samples; i++) {
        if (h->sample[i].channel == 0) {
            const double raw = h->sample[i].raw;
            *least = raw < *least ? raw : *least;
            *most = raw > *most ? raw : *most;
            *mean += raw;
            count++;
        }
    }
    *mean /= count;
}

static void expect_raws(const char *words, double least, double most, double within) {
    double a;
    double b;
    double mean;
    const wh_sample *other;
    run_with(words, &ill);
    raws_of(&ill, &a, &b, &mean);
    TEST_ASSERT_TRUE_MESSAGE(fabs(a - least) <= within && fabs(b - most) <= within, words);
    TEST_ASSERT_EQUAL_INT_MESSAGE(READS, samples_of(&ill, 1, &other), words);
    TEST_ASSERT_EQUAL_INT32_MESSAGE(1257, other->raw, words);
}

/* A healthy cell shows 40 N, plus or minus 10 N. */
TEST(fault, samples) {
    const wh_sample *s;
    expect_raws(NULL, 3000, 5000, 1);
    expect_raws("cell-frozen@0.1", 4025, 4951, 10);
    TEST_ASSERT_EQUAL_INT32(ill.sample[2 * 60].raw, ill.sample[2 * 400].raw);
    expect_raws("cell-pickup=5", -500, 500, 3);
    expect_raws("cell-hum=5", 2500, 5500, 60);
    expect_raws("reads=12", 1200, 1200, 0);
    expect_raws("cell-offset=-20", 1000, 3000, 1);
    expect_raws("cell-offset=-20@0.6+100ms", 2588, 5000, 60);
    run_with("cell-saturated@0.5", &ill);
    TEST_ASSERT_TRUE(ill.sample[2 * 300].raw == 10000 &&
                     ill.sample[2 * 300].status == WH_SAMPLE_SATURATED &&
                     ill.sample[2 * 200].status == WH_SAMPLE_GOOD);
    run_with("cell-open", &ill);
    TEST_ASSERT_TRUE(ill.sample[0].status == WH_SAMPLE_DISCONNECTED &&
                     ill.sample[1].status == WH_SAMPLE_GOOD);
    run_with("cell-dead", &ill);
    TEST_ASSERT_TRUE(samples_of(&ill, 0, &s) == 0 && samples_of(&ill, 1, &s) == READS);
    run_with("cell-dead:2", &ill);
    TEST_ASSERT_TRUE(samples_of(&ill, 0, &s) == READS && samples_of(&ill, 1, &s) == 0);
    run_with("cell-lost=0.3", &ill);
    TEST_ASSERT_INT_WITHIN(50, 350, samples_of(&ill, 0, &s));
    run_with("cell-repeated", &ill);
    TEST_ASSERT_TRUE(samples_of(&ill, 0, &s) == 2 * READS && s[0].ticks == s[1].ticks);
    run_with("cell-late=20ms", &ill);
    TEST_ASSERT_EQUAL_INT(READS - 10, samples_of(&ill, 0, &s));
    TEST_ASSERT_EQUAL_UINT32(hello.start_ticks + PERIOD_TICKS, s->ticks);
}

TEST(fault, noise_of_samples) {
    double squares = 0.0;
    run_with(NULL, &well);
    run_with("cell-noise=0.5", &ill);
    for (int i = 0; i < 2 * READS; i += 2) {
        const double off = (ill.sample[i].raw - well.sample[i].raw) * 0.01;
        squares += off * off;
    }
    TEST_ASSERT_TRUE(fabs(sqrt(squares / READS) - 0.5) < 0.06);
}

TEST(fault, spikes) {
    int spikes = 0;
    run_with(NULL, &well);
    run_with("cell-spikes=30", &ill);
    for (int i = 0; i < 2 * READS; i++) {
        const int off = ill.sample[i].raw - well.sample[i].raw;
        TEST_ASSERT_TRUE(off == 0 || (ill.sample[i].channel == 0 && abs(off) == 3000));
        spikes += off != 0;
    }
    TEST_ASSERT_INT_WITHIN(9, READS / 50, spikes);
}

/* During a fault, its input must have the fault's value, and before and after the fault the healthy value. No other
 * input may change. */
TEST(fault, inputs) {
    static const struct {
        const char *words;
        int input[2];
        double value[2];
    } rows[] = {
        {"supply=0.5", {0, -1}, {12.0, 0}},
        {"supply=1.5", {0, -1}, {36.0, 0}},
        {"freewheel", {1, -1}, {1.0, 0}},
        {"runaway", {2, -1}, {1.0, 0}},
        {"stuck", {2, 3}, {1.0, 1.0}},
        {"motor=0.2", {4, -1}, {0.3, 0}},
        {"friction=0.15", {5, -1}, {0.15, 0}},
        {"jam", {5, -1}, {20.0, 0}},
        {"coupling=0.5", {6, -1}, {10.0, 0}},
        {"cell-turned", {7, -1}, {-1.0, 0}},
        {"cell-gain=1.25", {7, -1}, {1.25, 0}},
        {"cell-offset=-3", {8, -1}, {-3.0, 0}},
        {"stop", {9, -1}, {1.0, 0}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char words[80];
        snprintf(words, sizeof words, "%s@state=2~101ms+0.201", rows[i].words);
        run_with(words, &ill);
        for (int read = 1; read <= READS; read++) {
            /* orders number 200 are sent at 0.398 s; the fault acts from the reading at 0.500 s to that at 0.702 s */
            const double at_s = read * 2e-3;
            const bool broken = at_s > 0.499 && at_s < 0.701;
            for (int in = 0; in < INPUTS; in++) {
                double wanted = healthy[in];
                for (int n = 0; n < 2; n++) {
                    wanted = broken && rows[i].input[n] == in ? rows[i].value[n] : wanted;
                }
                TEST_ASSERT_TRUE_MESSAGE(fabs(ill.input[read][in] - wanted) < 1e-12, words);
            }
        }
    }
}

TEST(fault, orders) {
    run_with("slow=20@0.5", &ill);
    TEST_ASSERT_TRUE(ill.orders[200].busy_timer == 20 && ill.orders[300].busy_timer == 400 &&
                     ill.orders[300].acted_timer == 200);
    run_with("late=3ms@0.5+100ms", &ill);
    TEST_ASSERT_TRUE(ill.late_s[200] == 0.0 && fabs(ill.late_s[270] - 3e-3) < 1e-12 &&
                     ill.late_s[400] == 0.0);
    run_with("hang=0.1@0.5", &ill);
    double sum = 0.0;
    for (int i = 1; i <= READS; i++) {
        sum += ill.late_s[i];
    }
    TEST_ASSERT_TRUE(fabs(sum - 0.1) < 1e-12 && ill.late_s[251] > 0.09);
    run_with("unkicked@0.5,unwatched@0.8", &ill);
    TEST_ASSERT_TRUE(ill.orders[200].flags == WH_ORDER_ALIVE && ill.orders[300].flags == 0 &&
                     ill.orders[300].watchdog_ticks == 77 && ill.orders[450].watchdog_ticks == 0);
}

/* If orders are lost on the line, the outputs must keep their values, and the next request must come at its usual
 * time. */
TEST(fault, line) {
    int lost = 0;
    run_with("orders-lost=0.5", &ill);
    for (int i = 2; i <= READS; i++) {
        TEST_ASSERT_EQUAL_UINT32((uint32_t)i, ill.orders[i].until_ticks);
        const float now = ill.orders[i].output[0];
        const bool stays = now == ill.orders[i - 1].output[0];
        TEST_ASSERT_TRUE(stays || now == (float)i);
        TEST_ASSERT_TRUE(stays ? ill.orders[i].flags == 0 : ill.orders[i].flags == WH_ORDER_ALIVE);
        lost += stays;
    }
    TEST_ASSERT_INT_WITHIN(60, READS / 2, lost);
    run_with("orders-lost=1", &ill); /* all orders are lost, so no output was ever set */
    for (int i = 1; i <= READS; i++) {
        TEST_ASSERT_EQUAL_UINT(2, ill.orders[i].outputs);
        TEST_ASSERT_TRUE(ill.orders[i].output[0] == 0.0f && ill.orders[i].output[1] == 0.0f);
    }
    run_with("readings-lost=0.5", &ill);
    TEST_ASSERT_INT_WITHIN(120, READS, ill.samples);
    run_with("readings-lost=1@0.5", &ill);
    TEST_ASSERT_EQUAL_INT(2 * 249, ill.samples);
}

TEST(fault, parameters) {
    fault_plan plan = {.count = 0};
    TEST_ASSERT_TRUE(fault_read(&plan, "jam,inertia=1.5"));
    char *none = fault_parameter(&plan, 0);
    char *one = fault_parameter(&plan, 1);
    TEST_ASSERT_NULL(none);
    TEST_ASSERT_EQUAL_STRING("inertia=1.5", one);
    free(one);
}

TEST(fault, words) {
    static const char *const none[] = {
        "",
        "jamm",
        "jam=",
        "jam=x",
        "jam=1e9",
        "jam:1",
        "edge-dead=1",
        "edge-dead:0",
        "edge-dead:1.5",
        "edge-dead:",
        "jam@",
        "jam@x",
        "jam@-1",
        "jam@=3",
        "jam@state=",
        "jam@state=3~",
        "jam+",
        "jam+x",
        "inertia@1",
        "inertia+1",
        "reset+1",
        "reset=-1",
        "reset:1",
        "stop=1",
        "jam,",
        "jam@1 2",
        "jam@1kg",
        "supply=nan",
        "jam@abcdefghijklmnopqrstuvwxyzabcdefghijklm=1",
    };
    fputs("(refusals follow)\n", stderr);
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        fault_plan plan = {.count = 0};
        TEST_ASSERT_FALSE_MESSAGE(fault_read(&plan, none[i]), none[i]);
    }
    fault_plan plan = {.count = 0};
    for (int i = 0; i < FAULTS_MAX; i++) {
        TEST_ASSERT_TRUE(fault_read(&plan, "jam"));
    }
    TEST_ASSERT_FALSE(fault_read(&plan, "jam"));
    for (int i = 0; i < FAULT_KINDS; i++) { /* each fault must have its word and bounds */
        fault_plan one = {.count = 0};
        TEST_ASSERT_TRUE(fault_read(&one, fault_rows[i].word));
        TEST_ASSERT_EQUAL_INT(i, (int)one.fault[0].kind);
        TEST_ASSERT_TRUE(one.fault[0].size >= fault_rows[i].least &&
                         one.fault[0].size <= fault_rows[i].most);
    }
}
