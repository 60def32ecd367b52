/* test_faults.c: the campaign of faults judges: what is drawn can be drawn again and read; the judge's truth is that of
 * closed forms, it finds what is wrong and nothing else. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "faults.h"
#include "motion.h"
#include "unity.h"

void suite_faults(void);

/* --- the judge -------------------------------------------------------------------------------------------------------*/

#define AMPLITUDE_N 42.0
#define PHASE_RAD 0.3

/* A rotor whose speed swings by a twentieth within a turn; of a second order and of a mean the first knows nothing. */
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
static const wh_hello hello = {.program = "bench",
                               .board = "here",
                               .ticks_per_s = 1000000U,
                               .signal = signals,
                               .signals = sizeof signals / sizeof signals[0]};
enum { NOTES_AT = 2 };

/* What a made-up controller says from said_s on, and how it ends. */
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
    double on_s;  /* the enable is on from here, */
    double off_s; /* to here */
    bool drives;
    bool calibration;
    bool runs_away;
    int state; /* that it tells, */
    int trip;
    int state_after; /* and after a reset */
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
                               .state = 13, /* the record */
                               .off_s = 2.9,
                               .cause = 2,
                               .end = LOCKSTEP_DONE};

/* A processor in reset is started again; true: it is, and has nothing to say yet. */
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
    const plant_wish wish = {.seed = 1};
    TEST_ASSERT_TRUE(fault_read(&plan, "unwatched"));
    TEST_ASSERT_TRUE(fault_read(&plan, m->fault));
    snprintf(words, sizeof words, text, m->swing_J, m->rpm);
    motion_open_text(&bench, words, IN_DOUBLE);
    TEST_ASSERT_TRUE(bind_signals(&b, &hello, bench.image, NULL));
    plant_start(&on, bench.image, &b, &hello, &wish);
    const tap taps[] = {fault_tap(&plan), judge_tap(&j, &of, &plan, &until_s)};
    TEST_ASSERT_TRUE(taps[0].start(taps[0].of, &hello, &on) &&
                     taps[1].start(taps[1].of, &hello, &on));
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

/* What is beyond the interval and 1 % is a lie, by so much. */
static void test_truth(void) {
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

/* Whom nobody believes does not lie: not good, no turns, or what only calibration can tell; who states it does not either. */
static void test_no_lies(void) {
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
    m = honest; /* more turns than there were */
    m.turns = 40;
    TEST_ASSERT_TRUE(judged(&m).lie > 0.5);
    m = honest;
    m.said_s = 0.3;
    TEST_ASSERT_TRUE(judged(&m).lie > 0.5);
}

/* The mean speed of a turn counts, not the swing within it. */
static void test_speeds(void) {
    made_up m = honest;
    m.swing_J = 0.0;
    for (int over = -15; over <= 15; over += 10) {
        const double rpm = 400.0 + over;
        m.rpm = rpm;
        m.off_s = 99.0;
        const verdict v = judged(&m);
        TEST_ASSERT_TRUE(fabs(v.turn_rpm - rpm) < 0.1 && fabs(v.peak_rpm - rpm) < 0.1);
        TEST_ASSERT_TRUE(v.overspeed == (rpm > 400.0) && v.runs_on == (rpm > 400.0));
        m.drives = true;
        TEST_ASSERT_FALSE(judged(&m).overspeed);
        m.drives = false;
        m.off_s = 2.0; /* commanded off is enough, where the drive obeys */
        TEST_ASSERT_FALSE(judged(&m).runs_on);
    }
    m = honest;
    m.rpm = 410.0; /* fastest, at the bottom */
    m.swing_J = 60.0;
    const verdict v = judged(&m);
    TEST_ASSERT_TRUE(v.turn_rpm < 400.0 && v.peak_rpm > 409.0 && !v.overspeed);
}

static void test_runaways(void) {
    made_up m = honest;
    m.runs_away = true;
    m.fault = "runaway@2";
    m.off_s = 2.25;
    verdict v = judged(&m);
    TEST_ASSERT_TRUE(v.lasting && fabs(v.off_s - 0.25) < 2.1e-3 && v.happened);
    TEST_ASSERT_TRUE(fabs(v.began_rpm - 330.0) < 0.1 * 330.0);
    m.off_s = 99.0;
    v = judged(&m);
    TEST_ASSERT_TRUE(v.lasting && v.off_s < 0.0 && !v.runs_on);
    m.on_s = 2.4; /* from when it is on */
    m.off_s = 2.55;
    v = judged(&m);
    TEST_ASSERT_TRUE(v.lasting && fabs(v.off_s - 0.15) < 2.1e-3);
    m.on_s = 0.0;
    m.off_s = 99.0;
    m.rpm = 420.0; /* such a drive is on with whatever duty */
    TEST_ASSERT_TRUE(judged(&m).runs_on);
    m.fault = "runaway@2+0.3";
    TEST_ASSERT_FALSE(judged(&m).lasting);
    m.fault = "runaway@9";
    v = judged(&m);
    TEST_ASSERT_FALSE(v.lasting || v.happened);
}

/* The motor must not drive, and turns show that something does: off, and tripped, within a second. */
static void test_off_is_off(void) {
    static const int states[] = {0, 1, 4, 9, 15}; /* idle, armed, tripped, tare, coast */
    made_up m = honest;
    m.off_s = 99.0;
    TEST_ASSERT_FALSE(judged(&m).stays_on || judged(&m).runs_on);
    for (int i = 0; i < 5; i++) {
        m = honest;
        m.state = states[i];
        m.swing_J = 0.0;
        m.fault = "stuck@0.5"; /* from then on it gets faster */
        m.off_s = 99.0;
        verdict v = judged(&m);
        TEST_ASSERT_TRUE(v.stays_on && v.runs_on && v.untold == (states[i] != 4));
        m.off_s = 1.2; /* the second turn is over after 0.86 s */
        v = judged(&m);
        TEST_ASSERT_TRUE(!v.stays_on && !v.runs_on && v.untold == (states[i] != 4));
        m.fault = "stuck@2.9";
        TEST_ASSERT_FALSE(judged(&m).untold);
    }
}

/* Pressed at 1 s: off by the next orders, and for good. */
static void test_stops(void) {
    made_up m = honest;
    m.fault = "stop@1+0.5";
    m.off_s = 1.001;
    verdict v = judged(&m);
    TEST_ASSERT_TRUE(v.halted && fabs(v.halted_s - 2e-3) < 3e-4);
    m.off_s = 0.5; /* it was off already */
    v = judged(&m);
    TEST_ASSERT_TRUE(v.halted && v.halted_s == 0.0);
    m.off_s = 1.003; /* an order too late, */
    TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    m.off_s = 99.0; /* or never */
    TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    for (int when = 0; when < 12; when++) { /* again, while it is pressed or afterwards */
        m.on_s = 1.02 + when * 0.13;
        m.off_s = m.on_s + 0.02;
        TEST_ASSERT_TRUE(judged(&m).halted_s < 0.0);
    }
    m.fault = "runaway@9";
    TEST_ASSERT_FALSE(judged(&m).halted);
}

/* Off in that very instant, for good; what tripped is known afterwards, and so is the reset. */
static void test_resets(void) {
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
        m.off_s = 99.0; /* it goes on where it was */
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
    m.state_after = 1; /* armed */
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

/* A watchdog that cuts says that something was late; where nothing was it is the controller's doing. */
static void test_cuts(void) {
    for (int i = 0; i < 4; i++) {
        made_up m = honest;
        m.cut = i % 2 == 1;
        m.delays = i >= 2;
        TEST_ASSERT_TRUE(judged(&m).cut == (i == 1));
    }
}

static void test_hangs(void) {
    made_up m = honest;
    m.end = LOCKSTEP_FAILED;
    TEST_ASSERT_EQUAL_INT(OUTCOME_HANG, judged(&m).outcome);
    m.end = LOCKSTEP_LET_GO; /* it is still there, and the motor is off */
    TEST_ASSERT_EQUAL_INT(OUTCOME_GOOD, judged(&m).outcome);
    m.off_s = 99.0;
    TEST_ASSERT_EQUAL_INT(OUTCOME_HANG, judged(&m).outcome);
}

void suite_faults(void) {
    RUN_TEST(test_truth);
    RUN_TEST(test_no_lies);
    RUN_TEST(test_speeds);
    RUN_TEST(test_runaways);
    RUN_TEST(test_off_is_off);
    RUN_TEST(test_stops);
    RUN_TEST(test_resets);
    RUN_TEST(test_cuts);
    RUN_TEST(test_hangs);
}
