/* test_faults.c: the verdicts of the fault campaign. Random cases must be reproducible, the true force and speed
 * must equal closed forms, and the judge must find every violation of a rule and nothing else. Also taps, tapes and
 * replay. */
#include "test.h"

#include <unistd.h>

#include "host/os/system.h"
#include "host/pil/fault.h"
#include "host/pil/lockstep.h"

#include "drawn_talk.h"
#include "faults.h"
#include "motion.h"

/* === suite faults ============================================================================= */

#define AMPLITUDE_N 42.0
#define PHASE_RAD 0.3

/* A rotor whose speed varies by a twentieth within a turn. Its force has a second harmonic and a mean, which the
 * firmware's model does not have. */
static const char *const text =
    "mechanism bench \"a rotor with a known force\"\n"
    "coordinate theta [rad]\ninput duty = 0\ninput enable = 0\n"
    "input runaway = 0\ninput enable_stuck = 0\ninput stop_pressed = 0\n"
    "T = 1 [kg*m^2]*theta'^2/2\nV = -%g [J]*cos(theta)\n"
    "Q(theta) = 8 [N*m]*enable_stuck\n"
    "output pin_force [N] = 42 [N]*cos(theta + 0.3) + 7 [N]*cos(2*theta) + 3 [N]\n"
    "scene s { start theta' = %g [rpm]; step 200 [us]; until 10 [s] }\n";

static const wh_signal signals[] = {
    {.kind = WH_SIGNAL_OUTPUT, .name = "duty", .unit = "1", .high = 1.0F},
    {.kind = WH_SIGNAL_OUTPUT, .name = "enable", .unit = "1", .high = 1.0F},
#define NOTE(name_, word, si) {.kind = WH_SIGNAL_NOTE, .name = (word), .unit = (si)},
    HAL_NOTE_ROWS(NOTE)
#undef NOTE
};
static const wh_hello hello_faults = {.program = "bench",
                                      .board = "here",
                                      .ticks_per_s = 1000000U,
                                      .signal = signals,
                                      .signals = sizeof signals / sizeof signals[0]};
enum { NOTES_AT = 2 };

/* A made-up controller: its messages from the time said_s on, and how it ends. */
typedef struct made_up {
    double rpm;
    double swing_J;
    double said_s;
    double amplitude_N;
    double half_N;
    double phase_rad;
    double phase_half_rad;
    int quality;
    int turns;
    const char *fault;
    double on_s;  /* time at which the enable line goes on */
    double off_s; /* time at which the drive goes off */
    bool drives;
    bool calibration;
    bool runs_away;
    int state; /* the state that the controller reports */
    int trip;
    int state_after; /* the state that the controller reports after a reset */
    int trip_after;
    int cause;
    bool delays;
    bool cut;
    lockstep_end end;
} made_up;

static const made_up honest = {.rpm = 330.0,
                               .swing_J = 30.0,
                               .said_s = 2.5,
                               .amplitude_N = AMPLITUDE_N,
                               .half_N = 0.01,
                               .phase_rad = PHASE_RAD,
                               .phase_half_rad = 1e-4,
                               .turns = 10,
                               .fault = "runaway@9",
                               .state = 13, /* state 13 records the measurement */
                               .off_s = 2.9,
                               .cause = 2,
                               .end = LOCKSTEP_DONE};

/* Restarts the processor if it is in reset. Returns true if it has restarted and has sent nothing yet. */
static bool starts_again(plant *on) {
    if (on->reset.now) {
        TEST_ASSERT_TRUE(plant_advance(on, on->reset.last_ticks + on->reset.takes_ticks));
        plant_restart(on);
        return true;
    }
    return false;
}

static verdict judged(const made_up *m) {
    static char words[1500];
    motion bench;
    plant on;
    binding b;
    judge j;
    double until_s = 100.0;
    fault_plan plan = {.seed = 1};
    const campaign_case of = {.breaks = m->fault != NULL,
                              .drives = m->drives,
                              .calibration = m->calibration,
                              .runs_away = m->runs_away,
                              .delays = m->delays};
    const plant_request request = {.seed = 1};
    TEST_ASSERT_TRUE(fault_read(&plan, "unwatched"));
    TEST_ASSERT_TRUE(fault_read(&plan, m->fault));
    snprintf(words, sizeof words, text, m->swing_J, m->rpm);
    motion_open_text(&bench, words, IN_DOUBLE);
    TEST_ASSERT_TRUE(bind_signals(&b, &hello_faults, bench.image, NULL));
    plant_start(&on, bench.image, &b, &hello_faults, &request);
    const tap taps[] = {fault_tap(&plan), judge_tap(&j, &of, &plan, &until_s)};
    TEST_ASSERT_TRUE(taps[0].start(taps[0].of, &hello_faults, &on) &&
                     taps[1].start(taps[1].of, &hello_faults, &on));
    for (int ms = 0; ms < 3000; ms++) {
        const double now_s = ms * 1e-3;
        wh_orders orders = {.outputs = NOTES_AT + HAL_NOTES,
                            .output = {0.5F, now_s >= m->on_s && now_s < m->off_s ? 1.0F : 0.0F}};
        if (now_s >= m->said_s) {
            float *note = orders.output + NOTES_AT;
            note[HAL_NOTE_QUALITY] = (float)m->quality;
            note[HAL_NOTE_AMPLITUDE] = (float)m->amplitude_N;
            note[HAL_NOTE_AMPLITUDE_HALF] = (float)m->half_N;
            note[HAL_NOTE_PHASE] = (float)m->phase_rad;
            note[HAL_NOTE_PHASE_HALF] = (float)m->phase_half_rad;
            note[HAL_NOTE_TURNS] = (float)m->turns;
        }
        const bool again = on.reset.count > 0;
        orders.output[NOTES_AT + HAL_NOTE_STATE] = (float)(again ? m->state_after : m->state);
        orders.output[NOTES_AT + HAL_NOTE_TRIP] = (float)(again ? m->trip_after : m->trip);
        orders.output[NOTES_AT + HAL_NOTE_RESET] = (float)(again ? m->cause : 0);
        double late_s = 0.0;
        for (int t = 0; t < 2 && ms % 2 == 0; t++) {
            taps[t].orders(taps[t].of, now_s, &orders, &late_s);
        }
        if (ms % 2 == 0) {
            plant_order(&on, &orders, 0.0);
        }
        do {
            TEST_ASSERT_TRUE(plant_advance(&on, (ms + 1) * 1e3));
        } while (starts_again(&on));
        taps[1].watch(taps[1].of, (ms + 1) * 1e-3, &on);
    }
    const lockstep_report report = {.end = m->end, .time_s = 3.0, .cut = m->cut};
    judge_end(&j, &report);
    plant_stop(&on);
    motion_close(&bench);
    return j.verdict;
}

/* An error beyond the interval plus 1 % is a lie of that size. */
TEST(faults, truth) {
    for (int i = -6; i <= 6; i++) {
        for (int which = 0; which < 2; which++) {
            made_up m = honest;
            const double off = i * 0.005;
            m.amplitude_N *= which == 0 ? 1.0 + off : 1.0;
            m.phase_rad += which == 1 ? off : 0.0;
            const double half = which == 0 ? m.half_N / AMPLITUDE_N : m.phase_half_rad;
            const double lie = fabs(off) - half - 0.01;
            const verdict v = judged(&m);
            TEST_ASSERT_TRUE(fabs(v.lie - (lie > 0.0 ? lie : 0.0)) < 5e-4);
            TEST_ASSERT_EQUAL_INT(OUTCOME_GOOD, v.outcome);
            TEST_ASSERT_FALSE(v.runs_on || v.overspeed || v.lasting);
        }
    }
}

/* A wrong result is no lie if its quality is not good, if it has no turns, if its interval contains the true value,
 * or if only a calibration could show the error. */
TEST(faults, no_lies) {
    made_up wrong = honest;
    wrong.amplitude_N = 21.0;
    TEST_ASSERT_TRUE(judged(&wrong).lie > 0.4);
    made_up m = wrong;
    m.quality = 1;
    verdict v = judged(&m);
    TEST_ASSERT_TRUE(v.lie == 0.0 && v.outcome == OUTCOME_DOUBTFUL);
    m.quality = 2;
    v = judged(&m);
    TEST_ASSERT_TRUE(v.lie == 0.0 && v.outcome == OUTCOME_REFUSED);
    m = wrong;
    m.turns = 0;
    v = judged(&m);
    TEST_ASSERT_TRUE(v.lie == 0.0 && v.outcome == OUTCOME_NONE);
    m = wrong;
    m.calibration = true;
    TEST_ASSERT_TRUE(judged(&m).lie == 0.0);
    m = wrong;
    m.half_N = 25.0;
    TEST_ASSERT_TRUE(judged(&m).lie == 0.0);
    m = honest; /* a result with more turns than were recorded */
    m.turns = 40;
    TEST_ASSERT_TRUE(judged(&m).lie > 0.5);
    m = honest;
    m.said_s = 0.3;
    TEST_ASSERT_TRUE(judged(&m).lie > 0.5);
}

/* In these states the motor must not drive, but the turns show a drive. The judge must report an enable line that
 * stays on, and a missing trip. */
TEST(faults, motor_off_must_not_drive) {
    static const int states[] = {0, 1, 4, 9, 15}; /* idle, armed, tripped, tare, coast */
    made_up m = honest;
    m.off_s = 99.0;
    TEST_ASSERT_FALSE(judged(&m).stays_on || judged(&m).runs_on);
    for (int i = 0; i < 5; i++) {
        m = honest;
        m.state = states[i];
        m.swing_J = 0.0;
        m.fault = "stuck@0.5"; /* from here on, each turn is faster */
        m.off_s = 99.0;
        verdict v = judged(&m);
        TEST_ASSERT_TRUE(v.stays_on && v.runs_on && v.untold == (states[i] != 4));
        m.off_s = 1.2; /* the second turn ends after 0.86 s */
        v = judged(&m);
        TEST_ASSERT_TRUE(!v.stays_on && !v.runs_on && v.untold == (states[i] != 4));
        m.fault = "stuck@2.9";
        TEST_ASSERT_FALSE(judged(&m).untold);
    }
}

/* Stop is pressed at 1 s. The motor must be off with the next orders, and stay off. */
TEST(faults, stops) {
    made_up m = honest;
    m.fault = "stop@1+0.5";
    m.off_s = 1.001;
    verdict v = judged(&m);
    TEST_ASSERT_TRUE(v.halted && fabs(v.halted_s - 2e-3) < 3e-4);
    m.off_s = 0.5; /* the drive was off already */
    v = judged(&m);
    TEST_ASSERT_TRUE(v.halted && v.halted_s == 0.0);
    m.off_s = 1.003; /* the drive ends too late */
    TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    m.off_s = 99.0; /* the drive never ends */
    TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    for (int when = 0; when < 12; when++) { /* drives again while stop is pressed, or later */
        m.on_s = 1.02 + when * 0.13;
        m.off_s = m.on_s + 0.02;
        TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    }
    m.fault = "runaway@9";
    TEST_ASSERT_FALSE(judged(&m).halted);
}

/* After a reset the motor must be off at once and stay off. The controller must still know its trip and must record
 * the reset. */
TEST(faults, resets) {
    made_up m = honest;
    for (int when = 0; when < 10; when++) {
        char words[40];
        snprintf(words, sizeof words, "reset=0.013@%.4f", 1.0 + when * 0.0137);
        m.fault = words;
        m.on_s = 0.0;
        m.off_s = 1.0 + when * 0.0137;
        verdict v = judged(&m);
        TEST_ASSERT_TRUE(v.halted && v.happened && v.halted_s < 1e-9 && v.halted_s >= 0.0);
        TEST_ASSERT_FALSE(v.forgets || v.latched);
        m.off_s = 99.0; /* the controller stays in its state */
        v = judged(&m);
        TEST_ASSERT_TRUE(v.halted_s < 0.0);
        m.on_s = 2.0;
        TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    }
    m = honest;
    m.fault = "reset@1";
    m.off_s = 0.5;
    m.cause = 0;
    TEST_ASSERT_TRUE(judged(&m).forgets);
    m.cause = 1;
    m.state_after = 1; /* the state `armed` */
    TEST_ASSERT_TRUE(judged(&m).forgets);
    for (int trip = 2; trip < 12; trip++) {
        m.state = 4;
        m.trip = trip;
        m.state_after = 0;
        m.trip_after = 0;
        verdict v = judged(&m);
        TEST_ASSERT_TRUE(v.forgets && !v.latched);
        m.state_after = 4;
        m.trip_after = trip == 11 ? 2 : trip + 1;
        TEST_ASSERT_TRUE(judged(&m).forgets);
        m.trip_after = trip;
        v = judged(&m);
        TEST_ASSERT_TRUE(!v.forgets && v.latched);
    }
}

/* === suite lockstep =========================================================================== */
/* A firmware and a plant exchange messages by turns. Taps listen or change the messages, and a tape records them.
 * The firmware is build/pil_cart, in its own process. */

static char firmware[512];
static motion cart;
static lockstep_report report;

/* Finds build/pil_cart, one folder above that of this program. */
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

static lockstep_request wish_until(double until_s) {
    return (lockstep_request){.guest = {.image = firmware, .board = "", .patience_s = 20.0},
                              .plant = {.seed = 1},
                              .until_s = until_s};
}

static void run(const lockstep_request *request) {
    lockstep_run(request, cart.image, &report);
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

/* Must be called every millisecond. */
static void see_plant(void *of, double time_s, const plant *on) {
    listener *l = of;
    l->readings++;
    TEST_ASSERT_TRUE(time_s > l->last_s && time_s < l->last_s + 1.1e-3);
    TEST_ASSERT_TRUE(fabs(plant_now(on) - time_s * 1e6) < 1e-3);
    l->last_s = time_s;
}

/* A tap that listens must receive every message and change nothing. */
static void test_listening(void) {
    lockstep_request request = wish_until(1.5);
    run(&request);
    const lockstep_report without = report;
    listener heard = {.orders = 0};
    const tap taps[] = {{.of = &heard, .orders = hear_orders},
                        {.of = &heard, .readings = hear_readings}};
    request.taps = taps;
    request.tap_count = 2;
    run(&request);
    TEST_ASSERT_TRUE(report.hash == without.hash && report.plant_hash == without.plant_hash);
    TEST_ASSERT_EQUAL_UINT64(1500, report.exchanges);
    TEST_ASSERT_EQUAL_UINT64(1500, heard.orders);
    TEST_ASSERT_EQUAL_UINT64(1500, heard.readings);
    TEST_ASSERT_EQUAL_UINT64(2 * 1499, heard.samples); /* the first reading has no sample */
    TEST_ASSERT_TRUE(heard.most_N > 1.0F && heard.most_N <= 20.0F);
}

/* A tap that watches must receive the states of the plant and change nothing, even if the firmware computes for ten
 * milliseconds. */
static void test_watching(void) {
    for (int late = 0; late < 2; late++) {
        lockstep_request request = wish_until(1.5);
        listener seen = {.orders = 0};
        const tap taps[] = {{.orders = late ? take_ten_ms : NULL},
                            {.of = &seen, .start = see_start, .watch = see_plant}};
        request.taps = taps;
        request.tap_count = 1;
        run(&request);
        const lockstep_report without = report;
        request.tap_count = 2;
        run(&request);
        TEST_ASSERT_TRUE(report.hash == without.hash && report.plant_hash == without.plant_hash);
        TEST_ASSERT_EQUAL_UINT64(1500, seen.readings);
        TEST_ASSERT_EQUAL_UINT64(late ? 150 : 1500, report.exchanges);
        TEST_ASSERT_EQUAL_UINT64(late ? 150 : 0, report.overruns);
    }
}

static void test_refused_start(void) {
    lockstep_request request = wish_until(1.0);
    const tap taps[] = {{.start = refuse_start}};
    request.taps = taps;
    request.tap_count = 1;
    lockstep_run(&request, cart.image, &report);
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_BAD);
    TEST_ASSERT_EQUAL_UINT64(0, report.exchanges);
}

/* A plant that loses its orders must move as it would alone. */
static void test_deaf_plant(void) {
    lockstep_request request = wish_until(1.0);
    const tap taps[] = {{.orders = forget_orders}};
    request.taps = taps;
    request.tap_count = 1;
    run(&request);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&cart, 20000));
    TEST_ASSERT_TRUE(report.plant_hash == engine_double.hash(cart.run));
}

/* A firmware without inputs must not push. */
static void test_blind_firmware(void) {
    lockstep_request request = wish_until(0.2);
    listener heard = {.orders = 0};
    const tap taps[] = {{.readings = lose_samples}, {.of = &heard, .orders = hear_orders}};
    request.taps = taps;
    request.tap_count = 2;
    run(&request);
    TEST_ASSERT_EQUAL_UINT64(200, heard.orders);
    TEST_ASSERT_TRUE(heard.most_N == 0.0F);
}

/* A tape has the firmware's inputs and answers as they are after all taps. A replay must give the same answers. */
static void tape_of_a_tapped_run(const tap *only, uint64_t exchanges) {
    char name[] = "/tmp/whirl_tape_XXXXXX";
    const int file = mkstemp(name);
    TEST_ASSERT_TRUE(file >= 0);
    lockstep_request request = wish_until(0.3);
    request.taps = only;
    request.tap_count = 1;
    request.tape = fdopen(file, "wb");
    TEST_ASSERT_NOT_NULL(request.tape);
    run(&request);
    TEST_ASSERT_EQUAL_INT(0, fclose(request.tape));
    const uint64_t hash = report.hash;
    TEST_ASSERT_EQUAL_UINT64(exchanges, report.exchanges);
    const lockstep_request again = wish_until(0.3);
    lockstep_replay(&again, name, &report);
    TEST_ASSERT_EQUAL_INT(0, remove(name));
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_LET_GO);
    TEST_ASSERT_EQUAL_HEX64(hash, report.hash);
    TEST_ASSERT_EQUAL_UINT64(exchanges, report.exchanges);
    TEST_ASSERT_TRUE(report.time_s > 0.298 && report.time_s < 0.3);
}

static void test_tapes_of_tapped_runs(void) {
    const tap taps[] = {{.readings = lose_samples}, {.orders = forget_orders}};
    tape_of_a_tapped_run(&taps[0], 300);
    tape_of_a_tapped_run(&taps[1], 300);
}

/* After a reset the processor sends its hello again. Only the exchanges during the reset are missing. */
static void test_tapes_of_resets(void) {
    static const struct {
        const char *words;
        unsigned resets;
        uint64_t exchanges;
    } rows[] = {
        {"reset=0@0.1005", 1, 301}, /* exchanges at 0.1005 s and then every millisecond */
        {"reset=5ms@0.1005", 1, 296},
        {"reset=5ms@0.1005,reset=20ms@0.2001", 2, 276},
        {"reset=1ms@0.05,reset=1ms@0.0505,reset=1ms@0.0511", 3, 300}, /* one reset within another */
        {"reset=0@0", 1, 301},                                        /* before any orders */
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fault_plan plan = {.seed = 1};
        TEST_ASSERT_TRUE(fault_read(&plan, rows[i].words));
        const tap t = fault_tap(&plan);
        tape_of_a_tapped_run(&t, rows[i].exchanges);
        TEST_ASSERT_EQUAL_UINT(rows[i].resets, plan.resets);
    }
}

/* An interrupt must stop the run and end the firmware's process. */
static void test_interrupt(void) {
    lockstep_request request = wish_until(100.0);
    interrupted = 1;
    lockstep_run(&request, cart.image, &report);
    interrupted = 0;
    TEST_ASSERT_TRUE(report.end == LOCKSTEP_STOPPED);
    TEST_ASSERT_FALSE(report.status.killed);
    TEST_ASSERT_EQUAL_INT(3, report.status.status); /* HAL_LINK_GONE */
}

SUITE(lockstep) {
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

/* === suite replay ============================================================================= */
/* A random tape replaces the plant (host/pil/taped.c). A replay ends with the tape or with the firmware. It ends
 * with a message at the first answer that differs. The tape of another firmware or an invalid tape is refused. */

/* Replays the tape. Fails the test if the end differs or comes after another number of turns. Returns the message. */
static const char *replay(lockstep_end end, unsigned turns, bool with_hello) {
    static stream heard;
    char name[] = "/tmp/whirl-talk-XXXXXX";
    const int file = mkstemp(name);
    TEST_ASSERT_TRUE(file >= 0 && write(file, talk_on_tape.bytes, talk_on_tape.length) ==
                                      (ssize_t)talk_on_tape.length);
    close(file);
    talk_open_line(true);
    errors_catch();
    lockstep_replay(&talk_request, name, &talk_report);
    const char *told = errors_caught();
    (void)remove(name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(end, talk_report.end, told);
    TEST_ASSERT_EQUAL_UINT64(turns, talk_report.exchanges);
    TEST_ASSERT_TRUE(!with_hello || strcmp(talk_report.program, "drawn") == 0);
    talk_close_line(&heard);
    return told;
}

static double time_of(unsigned turn) {
    return (double)(talk_drawn.ticks[turn] - talk_drawn.hello.start_ticks) / 1e6;
}

/* The replay ends when the tape ends, when the firmware ends, or after the tape's last readings, to which the tape
 * has no answer. */
TEST(replay, replayed) {
    for (unsigned c = 0; c < dice_cases(usual_or(30, 12)); c++) {
        talk_draw();
        talk_tape_all(talk_drawn.turns - 1U);
        const unsigned all = talk_drawn.turns - 1U;
        const unsigned kind = c % 3;
        if (kind > 0) {
            talk_put_readings(&talk_on_tape, all);
        }
        talk_say_all(kind == 2 ? talk_drawn.turns : all);
        talk_put_end(&talk_line, 42, 4);
        const lockstep_end end = kind == 1 ? LOCKSTEP_DONE : LOCKSTEP_LET_GO;
        TEST_ASSERT_EQUAL_STRING("", replay(end, kind == 2 ? talk_drawn.turns : all, true));
        talk_expect_report(end, kind == 2 ? talk_drawn.turns : all);
        TEST_ASSERT_EQUAL_HEX64(talk_hash_of(kind == 2 ? talk_drawn.turns : all), talk_report.hash);
        TEST_ASSERT_TRUE(fabs(talk_report.time_s - time_of(kind == 0 ? all - 1U : all)) < 1e-9);
        TEST_ASSERT_EQUAL_INT(kind == 1 ? 42 : -1, talk_report.status.status);
    }
}

/* An answer of one turn differs: the replay must end there and name the outputs. Counts may differ. */
TEST(replay, differing_answers_end_the_replay) {
    unsigned hints = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(50, 24)); c++) {
        char words[120];
        talk_draw();
        talk_tape_all(talk_drawn.turns);
        const unsigned turn = talk_one_of(talk_drawn.turns);
        const unsigned output = talk_one_of(talk_drawn.outputs);
        wh_orders *o = &talk_drawn.orders[turn];
        const float before = o->output[output];
        switch (c % 6) {
        case 0: o->output[output] += 1.0F; break;
        case 1: o->until_ticks++; break;
        case 2: o->watchdog_ticks++; break;
        case 3: o->flags ^= WH_ORDER_ALIVE; break;
        case 4: talk_drawn.remembers[turn] = talk_drawn.remembers[turn] == 99 ? 0 : 99; break;
        default:
            o->acted_timer++;
            o->busy_timer++;
            o->step_timer++;
        }
        talk_say_all(talk_drawn.turns);
        if (c % 6 == 5) {
            TEST_ASSERT_EQUAL_STRING("", replay(LOCKSTEP_LET_GO, talk_drawn.turns, true));
            continue;
        }
        const char *told = replay(LOCKSTEP_DIFFERENT, turn + 1U, true);
        snprintf(words, sizeof words,
                 "whirl pil: error: exchange %u, t = %.6f s: the firmware's outputs differ from "
                 "the tape\n",
                 turn + 1U, time_of(turn));
        told = said_exactly(told, words);
        if (c % 6 == 0) {
            snprintf(words, sizeof words, "output %u is %.9g now, and %.9g on the tape\n",
                     output + 1U, (double)o->output[output], (double)before);
            told = said_exactly(told, words);
            hints++;
        }
        TEST_ASSERT_EQUAL_STRING("", told);
    }
    TEST_ASSERT_TRUE(hints > 1);
}

TEST(replay, not_replayed) {
    for (unsigned c = 0; c < 12; c++) {
        char words[120];
        talk_draw();
        talk_tape_all(talk_drawn.turns);
        const unsigned turns = talk_one_of(talk_drawn.turns);
        talk_say_all(turns);
        if (c % 4 == 0) { /* the firmware ends before the tape does */
            talk_put_end(&talk_line, 0, 4);
            const char *told = replay(LOCKSTEP_DIFFERENT, turns, true);
            snprintf(words, sizeof words,
                     "exchange %u, t = %.6f s: the firmware ended, but the tape continues\n", turns,
                     time_of(turns));
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, words), told);
        } else if (c % 4 == 1) { /* the tape of another firmware */
            talk_drawn.hello.program = "another";
            talk_line.length = 0;
            talk_put_hello(&talk_line, &talk_drawn.hello);
            const char *told = replay(LOCKSTEP_BAD, 0, false);
            TEST_ASSERT_NOT_NULL_MESSAGE(
                strstr(
                    told,
                    "error: the firmware 'drawn' on this tape differs from the running firmware 'another' in name, ticks or signals\n"),
                told);
        } else if (c % 4 == 2) { /* a broken tape */
            talk_on_tape.length -= 3;
            talk_say_all(talk_drawn.turns);
            const char *told = replay(LOCKSTEP_BAD, talk_drawn.turns - 1U, true);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "error: the tape is damaged after "), told);
        } else { /* no tape */
            talk_on_tape.length = 2;
            const char *told = replay(LOCKSTEP_BAD, 0, false);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "error: this is not a tape of this version "
                                                      "after 0"),
                                         told);
        }
    }
}

/* A line cannot replay a tape on which the firmware was reset. */
TEST(replay, reset_on_tape) {
    uint8_t payload[WH_RESET_BYTES];
    const wh_reset reset = {.cause = WH_RESET_WATCHDOG};
    talk_draw();
    talk_tape_all(2);
    talk_put_hello(&talk_on_tape, &talk_drawn.hello);
    talk_put(&talk_on_tape, WH_FRAME_RESET, 0, talk_drawn.ticks[1], payload,
             wh_reset_put(&reset, payload, sizeof payload));
    talk_say_all(2);
    const char *told = replay(LOCKSTEP_FAILED, 2, true);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "a reset, which is not possible over a serial line"),
                                 told);
}

SUITE(replay) { talk_die(dice_of("replay", 50)); }
