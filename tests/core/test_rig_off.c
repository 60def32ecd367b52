/* test_rig_off.c: rotors with the motor off, which coast, swing, or are driven by a fault. Supply, inertia, friction,
 * dead sensors, and stuck drive stages are random. So is the controller's state, one in which the motor is off. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "draw.h"
#include "rotor.h"

#include "tests/suites.h"

#define RPM WH_RIG_RADPS_PER_RPM
#define STEP_TICKS UINT32_C(2000)
#define STEPS_PER_S 500U
#define COUNTS_PER_N WH_R(100.0)

typedef struct bench {
    wh_rig rig;
    wh_rig_config config;
    wh_rig_inputs inputs;
    wh_rig_command command;
    rotor_kind kind;
    rotor_kind open; /* the same rotor with open motor leads */
    rotor_state rotor;
    bool stuck; /* the drive stage ignores its voltage */
    bool deaf;  /* a stuck stage also ignores its enable */
    wh_real share;
    unsigned dead; /* number of the dead sensor; 2: none */
    /* From here on: true turns of the rotor while the motor must not drive. */
    unsigned step;
    unsigned begun;   /* step in which the current turn began */
    unsigned turns;   /* number of turns since the motor went off */
    unsigned powered; /* number of turns since the enable last changed */
    wh_real before_s; /* durations of the last two turns */
    wh_real last_s;
    unsigned rises;
    wh_real first_s;      /* duration of the turn before the turns got faster */
    unsigned undriven_at; /* first step in which turns with the enable on showed a drive; 0: none */
    unsigned faster_at;   /* first step in which turns with the enable off got faster; 0: none */
} bench;

static bench b;
static uint64_t seed;

static wh_real between(wh_real least, wh_real most) {
    return least + (most - least) * (wh_real)draw_one_of(&seed, 10001) / WH_R(10000.0);
}

/* Draws a factor of the inertia from 0.5 to 6, roughly log-uniform. */
static wh_real drawn_inertia(void) {
    static const wh_real parts[] = {WH_R(0.5), WH_R(0.7), WH_R(1.0), WH_R(1.4),
                                    WH_R(2.0), WH_R(2.8), WH_R(4.0), WH_R(6.0)};
    const unsigned part = draw_one_of(&seed, 7);
    return between(parts[part], parts[part + 1U]);
}

static bool may_drive(void) {
    return wh_run_drives(&b.rig.run) && b.rig.guard.trip == WH_TRIP_NONE;
}

/* Counts whole forward turns, when the rotor passes the bottom. */
static void see_turn(wh_real from_rad) {
    const bool around =
        from_rad > WH_R(0.75) * WH_RIG_TWO_PI && b.rotor.angle_rad < WH_R(0.25) * WH_RIG_TWO_PI;
    if (may_drive() || b.rotor.speed_radps < WH_R(0.0)) {
        b.turns = 0;
        b.powered = 0;
        b.rises = 0;
        return;
    }
    if (!around) {
        return;
    }
    const wh_real turn_s = (wh_real)(b.step - b.begun) / (wh_real)STEPS_PER_S;
    b.before_s = b.last_s;
    b.last_s = turn_s;
    b.begun = b.step;
    b.turns++;
    b.powered++;
    const bool faster = b.turns > 2U && turn_s < b.before_s;
    b.first_s = faster ? b.first_s : turn_s;
    b.rises = faster ? b.rises + 1U : 0U;
    if (b.powered > 2U && b.undriven_at == 0 && !(turn_s > b.before_s)) {
        b.undriven_at = b.step;
    }
    const wh_real seen_rpm = b.dead == 2U ? WH_R(61.0) : WH_R(225.0);
    if (b.rises >= (b.dead == 2U ? 2U : 3U) && b.faster_at == 0 &&
        b.first_s > WH_R(1.05) * turn_s && WH_R(60.0) / b.before_s > seen_rpm) {
        b.faster_at = b.step;
    }
}

static void step_on(void) {
    const bool enabled = b.command.way != WH_MOTOR_COASTS || (b.stuck && b.deaf);
    const wh_real volts = b.stuck                            ? b.share * b.inputs.supply_V
                          : b.command.way == WH_MOTOR_DRIVES ? b.command.volts
                                                             : WH_R(0.0);
    const wh_real from_rad = b.rotor.angle_rad;
    rotor_turn(enabled ? &b.kind : &b.open, &b.rotor, volts / WH_RIG_RATED_V, STEP_TICKS);
    b.inputs.now_ticks = b.rotor.ticks;
    for (unsigned i = 0; i < b.rotor.pulses; i++) {
        if (b.rotor.pulse_sensor[i] != b.dead) {
            wh_rig_pulse(&b.config, &b.rig, b.rotor.pulse_sensor[i], b.rotor.pulse_ticks[i]);
        }
    }
    const wh_wave wave = wh_wave_of(b.rotor.angle_rad);
    const wh_real load_N =
        WH_RIG_UNBALANCE_KGM * b.rotor.speed_radps * b.rotor.speed_radps * wave.cosine;
    wh_rig_load(&b.config, &b.rig, b.rotor.ticks, (int32_t)(load_N * COUNTS_PER_N), WH_LOAD_OK);
    const wh_motor_way before = b.command.way;
    b.command = wh_rig_step(&b.config, &b.rig, &b.inputs);
    b.step++;
    if (b.command.way == WH_MOTOR_COASTS || b.command.way != before) {
        b.powered = 0;
    }
    see_turn(from_rad);
}

static void steps_on(unsigned steps) {
    for (unsigned i = 0; i < steps; i++) {
        step_on();
    }
}

static void draw_bench(void) {
    b = (bench){.config = wh_rig_standard, .kind = rotor_nominal(), .dead = 2U};
    b.config.measure.cell = (wh_cell_config){.newton_per_count = WH_R(1.0) / COUNTS_PER_N,
                                             .period_ticks = STEP_TICKS,
                                             .raw_max = INT32_C(32767)};
    wh_rig_slots(&b.config, WH_R(1.0) / WH_RIG_DEG_PER_RAD);
    b.config.stop_brakes = draw_one_in(&seed, 2);
    b.kind.inertia_kgm2 *= drawn_inertia();
    b.kind.friction_Nm = between(WH_R(0.004), WH_R(0.06));
    b.kind.slot_rad = WH_R(2.0) / WH_RIG_DEG_PER_RAD;
    b.kind.jitter_s = WH_R(100e-6);
    b.open = b.kind;
    b.open.stall_Nm = WH_R(0.0);
    b.rotor = (rotor_state){.ticks = UINT32_MAX - 5000000U, .seed = draw_bits(&seed)};
    b.inputs = (wh_rig_inputs){.now_ticks = b.rotor.ticks, .supply_V = between(12, 36)};
    wh_rig_start(&b.config, &b.rig, b.rotor.ticks, NULL);
}

static void order(wh_rig_event event, wh_real value) {
    TEST_ASSERT_TRUE(wh_rig_post(&b.rig, event, value));
    step_on();
    TEST_ASSERT_TRUE(b.rig.answer == WH_ALLOWED);
}

typedef enum place { IDLE, ARMED, TARE, STOPPED, COMMANDED, TRIPPED, RESET, PLACES } place;

/* Drives towards a set-point for a random time. */
static void drive(void) {
    const wh_real most_rpm = (b.inputs.supply_V - WH_R(1.0)) / WH_RIG_RATED_V * WH_R(600.0);
    order(WH_EVENT_START, between(170, most_rpm < WH_R(360.0) ? most_rpm : WH_R(360.0)) * RPM);
    while (!may_drive() && b.rig.guard.trip == WH_TRIP_NONE) {
        step_on();
    }
    steps_on(draw_one_of(&seed, 9U * STEPS_PER_S));
}

/* Brings the rig to a state in which the motor is off, now or in the next step. */
static void go_to(place where) {
    steps_on(STEPS_PER_S * 8U / 5U);
    if (where == IDLE) {
        return;
    }
    order(WH_EVENT_ARM, WH_R(0.0));
    if (where == TARE) {
        order(WH_EVENT_START, WH_R(200.0) * RPM);
        steps_on(draw_one_of(&seed, 200));
    } else if (where >= STOPPED) {
        drive();
        switch (where) {
        case STOPPED: b.inputs.stop_pressed = true; break;
        case COMMANDED: (void)wh_rig_post(&b.rig, WH_EVENT_STOP, WH_R(0.0)); break;
        case TRIPPED: b.inputs.watchdog_has_cut = true; break;
        case RESET: wh_rig_start(&b.config, &b.rig, b.rotor.ticks, NULL); break;
        case IDLE:
        case ARMED:
        case TARE:
        case PLACES: break;
        }
        step_on();
    }
}

/* Number of random benches. On an emulated board each takes seconds. */
#ifndef OFF_BENCHES
#define OFF_BENCHES (__STDC_HOSTED__ && !WH_DOUBLE ? 360U : 24U)
#endif
#define OFF_ALL (OFF_BENCHES >= 360U) /* enough benches for some of each kind */

/* Healthy rotors brake or coast; some reverse near the top, some swing about the bottom. The rig must not trip. */
TEST(rig_off, healthy_rotors_run_out) {
    unsigned brakes = 0;
    unsigned swings = 0;
    seed = 31;
    for (unsigned i = 0; i < draw_cases(OFF_BENCHES / 3U); i++) {
        draw_bench();
        go_to(draw_one_in(&seed, 3) ? STOPPED : COMMANDED);
        TEST_ASSERT_TRUE(b.rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(!b.inputs.stop_pressed || b.command.way == WH_MOTOR_COASTS);
        bool back = false;
        for (unsigned k = 0; k < 130U * STEPS_PER_S && b.rig.state != WH_RIG_IDLE; k++) {
            brakes += b.command.way == WH_MOTOR_BRAKES;
            b.inputs.stop_pressed = b.inputs.stop_pressed && k < 100U;
            step_on();
            back = back || b.rotor.speed_radps < WH_R(-1.0);
            TEST_ASSERT_TRUE(b.rig.guard.trip == WH_TRIP_NONE);
        }
        TEST_ASSERT_TRUE(b.rig.state == WH_RIG_IDLE);
        swings += back;
    }
    TEST_ASSERT_TRUE(!OFF_ALL || (brakes > 0 && 2U * swings > draw_cases(OFF_BENCHES / 3U)));
}

/* One false pulse of either sensor while a rotor coasts causes no trip, except for some rotors that are about to
 * reverse at the top. */
TEST(rig_off, one_invented_pulse_is_no_drive) {
    unsigned benches = 0;
    unsigned trips = 0;
    seed = 34;
    for (unsigned i = 0; i < draw_cases(OFF_BENCHES / 3U); i++) {
        draw_bench();
        b.config.stop_brakes = false;
        go_to(COMMANDED);
        if (b.rig.guard.trip != WH_TRIP_NONE) {
            continue; /* this bench cannot run at this set-point */
        }
        steps_on(draw_one_of(&seed, 2U * STEPS_PER_S));
        wh_rig_pulse(&b.config, &b.rig, draw_one_of(&seed, 2),
                     b.rotor.ticks - draw_one_of(&seed, STEP_TICKS));
        for (unsigned k = 0; k < 130U * STEPS_PER_S && b.rig.guard.trip == WH_TRIP_NONE &&
                             b.rig.state != WH_RIG_IDLE;
             k++) {
            step_on();
        }
        benches++;
        trips += b.rig.guard.trip != WH_TRIP_NONE;
    }
    TEST_ASSERT_TRUE(!OFF_ALL || 30U * trips < benches);
}

TEST(rig_off, a_hand_may_turn_the_rotor) {
    seed = 32;
    for (unsigned i = 0; i < draw_cases(OFF_BENCHES / 6U); i++) {
        draw_bench();
        go_to(draw_one_in(&seed, 2) ? IDLE : ARMED);
        for (unsigned k = 0; k < 10U; k++) {
            const wh_real rpm = between(10, 58);
            b.kind.weight_Nm = WH_R(0.0); /* a hand stops the rotor */
            b.kind.stall_Nm = WH_R(50.0);
            b.stuck = b.deaf = true;
            b.share = rpm / WH_R(600.0) * WH_RIG_RATED_V / b.inputs.supply_V;
            steps_on(draw_one_of(&seed, 3U * STEPS_PER_S));
        }
        b.share = WH_R(0.0);
        steps_on(STEPS_PER_S);
        b.stuck =
            false; /* the hand lets go: the drive stage, which stood for the hand, obeys the controller again */
        steps_on(30U * STEPS_PER_S);
        TEST_ASSERT_TRUE(b.rig.guard.trip == WH_TRIP_NONE);
    }
}

/* The drive stage is stuck, in any state with the motor off. If the enable is on, the rig switches it off and trips
 * within a second of the first turn that does not slow down. If the enable is off, the rig trips after three turns that
 * are each faster than the one before. */
TEST(rig_off, a_stage_that_drives_is_found) {
    unsigned shown[PLACES] = {0};
    unsigned told =
        /* Number of tripped runs with the enable on, excluding stages that ignore the enable while a sensor is dead. */
        0;
    unsigned untold = 0;
    unsigned on_shown[3] = {0};
    unsigned off_shown[3] = {0};
    seed = 33;
    for (unsigned i = 0; i < draw_cases(OFF_BENCHES); i++) {
        draw_bench();
        const unsigned drawn = draw_one_of(&seed, 2U * PLACES);
        /* COMMANDED, where the motor brakes, is drawn as often as all other places together. */
        const place where = drawn < PLACES ? (place)drawn : COMMANDED;
        go_to(where);
        if (where != TRIPPED && b.rig.guard.trip != WH_TRIP_NONE) {
            continue; /* this bench cannot run at this set-point */
        }
        steps_on(draw_one_in(&seed, 2) ? 0U : draw_one_of(&seed, STEPS_PER_S));
        b.dead = draw_one_of(&seed, 3);
        b.share = between(WH_R(0.2), WH_R(1.0));
        b.deaf = draw_one_in(&seed, 2);
        b.stuck = true;
        for (unsigned k = 0; k < 20U * STEPS_PER_S; k++) {
            step_on();
            if (may_drive()) {
                break; /* the tare is over */
            }
            TEST_ASSERT_TRUE(b.undriven_at == 0 || b.command.way == WH_MOTOR_COASTS ||
                             b.step < b.undriven_at + STEPS_PER_S);
            TEST_ASSERT_TRUE(b.faster_at == 0 || b.rig.guard.trip != WH_TRIP_NONE ||
                             b.step < b.faster_at + STEPS_PER_S);
        }
        on_shown[b.dead] += b.undriven_at != 0;
        off_shown[b.dead] += b.faster_at != 0;
        shown[where] += b.undriven_at != 0 || b.faster_at != 0;
        if (b.undriven_at != 0 && (b.dead == 2U || !b.deaf)) {
            told += b.rig.guard.trip != WH_TRIP_NONE;
            untold += b.rig.guard.trip == WH_TRIP_NONE;
            TEST_ASSERT_TRUE(b.dead != 2U || b.rig.guard.trip != WH_TRIP_NONE);
        }
        TEST_ASSERT_TRUE(b.command.way == WH_MOTOR_COASTS || may_drive());
    }
    for (unsigned i = 0; i < PLACES && OFF_ALL; i++) {
        TEST_ASSERT_TRUE(shown[i] > 0 || i == TARE);
    }
    for (unsigned i = 0; i < 3U && OFF_ALL; i++) {
        TEST_ASSERT_TRUE(off_shown[i] > 0);
    }
    TEST_ASSERT_TRUE(!OFF_ALL || on_shown[2] > 0);
    TEST_ASSERT_TRUE(!OFF_ALL || told > 9U * untold);
}
