/* test_rig_motor.c: motors of any torque line on an imitated rotor. If the settings are those of the motor, a run ends
 * with a good result. With other settings, or a wrong supply reading, the result is good or a trip names the cause. */
#include <string.h>

#include "core/angle.h"
#include "core/rig/polar.h"
#include "core/station/conf.h"
#include "draw.h"
#include "even_rig.h"
#include "rotor.h"
#include "tests/suites.h"

#define COUNTS_PER_N WH_R(147.0)
#define RPM WH_RIG_RADPS_PER_RPM

static wh_rig rig;
static wh_rig_config config;
static wh_conf conf;
static wh_rig_motor motor; /* the true motor */
static rotor_kind kind;
static rotor_state rotor;
static wh_real supply_V;            /* the true supply voltage */
static wh_real reads;               /* the reading of the supply, as a factor */
extern const wh_scene rig_observed; /* the observer's model, as in the firmware */
static wh_pulse pulse[4];           /* the last pulses */
static uint64_t seed;

static wh_real between(wh_real least, wh_real most) {
    return least + (most - least) * draw_whole(&seed, 0, 1024) / WH_R(1024.0);
}

static void own(wh_rig_config *c) {
    *c = wh_rig_standard;
    c->measure.cell = (wh_cell_config){.newton_per_count = WH_R(1.0) / COUNTS_PER_N,
                                       .period_ticks = EVEN_STEP_TICKS,
                                       .raw_max = INT32_C(32767)};
    wh_rig_slots(c, WH_R(1.0) / WH_RIG_DEG_PER_RAD);
    c->observer.scene = &rig_observed;
}

static bool is_entered(const wh_rig_motor *typed) {
    bool fine = true;
    const wh_conf_id ids[] = {WH_CONF_no_load_speed, WH_CONF_stall_torque, WH_CONF_rated_voltage};
    const wh_real values[] = {typed->no_load_radps / RPM, typed->stall_Nm, typed->rated_V};
    for (unsigned i = 0; i < 3U; i++) {
        fine = fine && wh_conf_set(&conf, ids[i], values[i]) == WH_STATION_FINE;
    }
    return fine;
}

static void enter(const wh_rig_motor *typed) {
    wh_conf_start(&conf, own, NULL, &config);
    TEST_ASSERT_TRUE(is_entered(typed));
}

static void step(void) {
    const wh_real drive = rig.command.volts / reads / motor.rated_V;
    kind.freewheels = rig.command.way == WH_MOTOR_COASTS;
    rotor_turn(&kind, &rotor, drive, EVEN_STEP_TICKS);
    for (unsigned i = 0; i < rotor.pulses; i++) {
        pulse[0] = pulse[1];
        pulse[1] = pulse[2];
        pulse[2] = pulse[3];
        pulse[3] = (wh_pulse){.ticks = rotor.pulse_ticks[i], .sensor = rotor.pulse_sensor[i]};
        wh_rig_pulse(&config, &rig, rotor.pulse_sensor[i], rotor.pulse_ticks[i]);
    }
    const wh_wave wave = wh_wave_of(rotor.angle_rad);
    const wh_real w = rotor.speed_radps;
    const wh_real force_N =
        kind.weight_Nm / WH_RIG_GRAVITY_MPS2 *
        (w * w * wave.cosine + rotor_acceleration_radps2(&kind, &rotor, drive) * wave.sine);
    const wh_real counts = force_N * COUNTS_PER_N + draw_whole(&seed, -10, 10);
    wh_rig_load(&config, &rig, rotor.ticks, (int32_t)counts, WH_LOAD_OK);
    const wh_rig_inputs inputs = {.now_ticks = rotor.ticks, .supply_V = reads * supply_V};
    (void)wh_rig_step(&config, &rig, &inputs);
}

static wh_refusal run(wh_real target_rpm) {
    rotor = (rotor_state){.ticks = (uint32_t)draw_bits(&seed) * 2U, .seed = draw_bits(&seed)};
    wh_rig_start(&config, &rig, rotor.ticks, NULL);
    for (unsigned i = 0; i < 800U; i++) {
        step();
    }
    const wh_rig_event orders[] = {WH_EVENT_ARM, WH_EVENT_START};
    for (unsigned i = 0; i < 2U; i++) {
        TEST_ASSERT_TRUE(wh_rig_post(&rig, orders[i], target_rpm * RPM));
        step();
        if (rig.answer != WH_ALLOWED) {
            return rig.answer;
        }
    }
    for (uint32_t i = 0; i < 40000U && rig.state == WH_RIG_RUNNING; i++) {
        step();
    }
    return WH_ALLOWED;
}

/* Draws a motor: no-load speed from 400 to 900 rpm, stall torque from half to twice the standard's, rated for 12 to 36
 * V. */
static void draw_motor(void) {
    motor = (wh_rig_motor){.stall_Nm = WH_RIG_STALL_NM * between(WH_R(0.5), WH_R(2.0)),
                           .no_load_radps = between(WH_R(400.0), WH_R(900.0)) * RPM,
                           .rated_V = between(WH_R(12.0), WH_R(36.0))};
    reads = between(WH_R(0.98), WH_R(1.02));
    supply_V = motor.rated_V * between(WH_R(0.95), WH_R(1.3));
    kind = rotor_nominal();
    kind.stall_Nm = motor.stall_Nm;
    kind.no_load_radps = motor.no_load_radps;
}

/* No motor with its own settings trips. A steep torque line at a low speed may have a larger effect than a third of the
 * rotor's inertia. Then the model of the angle is less accurate, and the result may be doubtful. */
TEST(rig_motor, any_motor_with_its_settings) {
    seed = 61;
    unsigned good = 0;
    unsigned refused = 0;
    unsigned compensated = 0;
    const unsigned cases = draw_cases(120);
    for (unsigned i = 0; i < cases; i++) {
        draw_motor();
        enter(&motor);
        const wh_real target_rpm = between(WH_R(100.0), WH_R(360.0));
        const wh_refusal refusal = run(target_rpm);
        if (refusal != WH_ALLOWED) {
            TEST_ASSERT_TRUE(refusal == WH_REFUSED_TARGET || refusal == WH_REFUSED_VOLTAGE);
            refused++;
            continue;
        }
        TEST_ASSERT_EQUAL_UINT(WH_TRIP_NONE, rig.guard.trip);
        TEST_ASSERT_TRUE(rig.has_result && rig.ended == WH_END_DONE);
        const bool held =
            config.measure.rotor.damping_Nms > WH_R(0.35) * WH_RIG_INERTIA_KGM2 * target_rpm * RPM;
        TEST_ASSERT_TRUE(rig.result.force.quality == WH_GOOD ||
                         (held && rig.result.force.quality == WH_DOUBTFUL));
        good += rig.result.force.quality == WH_GOOD ? 1U : 0U;
        compensated += rig.compensated ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(good * 10U > cases * 8U && compensated * 10U > cases && refused * 5U < cases);
}

/* The supply's divider, or the motor's settings, are wrong by factors of 0.7 to 1.3. The run ends with a result, or
 * with a trip that names the cause. */
TEST(rig_motor, wrong_settings_are_named) {
    seed = 62;
    unsigned named = 0;
    unsigned done = 0;
    const unsigned cases = draw_cases(160);
    for (unsigned i = 0; i < cases; i++) {
        draw_motor();
        wh_rig_motor typed = motor;
        const wh_real off = between(WH_R(0.7), WH_R(1.3));
        switch (i % 4U) {
        case 0: reads = off; break;
        case 1: typed.no_load_radps = motor.no_load_radps * off; break;
        case 2: typed.rated_V = motor.rated_V * off; break;
        default: typed.stall_Nm = motor.stall_Nm * off; break;
        }
        wh_conf_start(&conf, own, NULL, &config);
        if (!is_entered(&typed) || run(between(WH_R(170.0), WH_R(360.0))) != WH_ALLOWED) {
            continue;
        }
        const bool faster = rig.guard.trip == WH_TRIP_FASTER;
        TEST_ASSERT_TRUE(faster || rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(rig.has_result == !faster);
        named += faster ? 1U : 0U;
        done += faster ? 0U : 1U;
    }
    TEST_ASSERT_TRUE(named * 20U >= cases && done * 2U > cases);
}

/* A reversed motor, or swapped sensors, with any motor: the trip names the wrong order. */
TEST(rig_motor, a_wrong_order_is_named) {
    seed = 63;
    for (unsigned i = 0; i < draw_cases(60); i++) {
        draw_motor();
        enter(&motor);
        if (i % 2U == 0) { /* mirrored, sensor 2 is at three quarters of a turn */
            kind.pulse_rad[1] = WH_R(0.75) * WH_RIG_TWO_PI + kind.pulse_rad[0];
        } else {
            const wh_real one = kind.pulse_rad[0];
            kind.pulse_rad[0] = kind.pulse_rad[1];
            kind.pulse_rad[1] = one;
        }
        if (run(between(WH_R(170.0), WH_R(360.0))) == WH_ALLOWED) {
            TEST_ASSERT_EQUAL_UINT(WH_TRIP_ORDER, rig.guard.trip);
        }
    }
}

/* The speed of a coasting rotor, including that of the last turn, is known while the sensors' pulses alternate. If a
 * sensor fires twice in succession, the rotor swings. */
TEST(rig_motor, the_speed_of_a_rotor_that_coasts) {
    seed = 65;
    unsigned known_steps = 0;
    unsigned unknown_steps = 0;
    for (unsigned i = 0; i < draw_cases(8); i++) {
        draw_motor();
        kind.friction_Nm = between(WH_R(0.0), WH_R(0.03));
        kind.slot_rad = WH_R(2.0) / WH_RIG_DEG_PER_RAD;
        enter(&motor);
        TEST_ASSERT_TRUE(wh_conf_set(&conf, WH_CONF_stop_brakes, WH_R(0.0)) == WH_STATION_FINE);
        if (run(between(WH_R(170.0), WH_R(300.0))) != WH_ALLOWED) {
            continue;
        }
        while (rig.run.phase == WH_PHASE_RAMP_DOWN) {
            step();
        }
        step(); /* the step that tests for rest */
        while (rig.run.phase == WH_PHASE_OFF && !rig.guard.quiet) {
            step();
            wh_real speed_radps;
            const bool known = wh_rig_speed(&rig, rotor.ticks, &speed_radps);
            const bool alternate = pulse[0].sensor != pulse[1].sensor &&
                                   pulse[1].sensor != pulse[2].sensor &&
                                   pulse[2].sensor != pulse[3].sensor;
            const wh_real turn_s = (wh_real)(pulse[3].ticks - pulse[1].ticks) * WH_R(1e-6);
            if (alternate && !rig.guard.quiet) {
                TEST_ASSERT_TRUE(known);
                CHECK_NEAR(1e-3f, 1.0f, speed_radps * turn_s / WH_RIG_TWO_PI);
            } else if (pulse[2].sensor == pulse[3].sensor && !rig.guard.quiet) {
                TEST_ASSERT_FALSE(known);
            }
            known_steps += known ? 1U : 0U;
            unknown_steps += known ? 0U : 1U;
        }
    }
    TEST_ASSERT_TRUE(known_steps > 1000U && unknown_steps > 100U);
}

TEST(rig_motor, settings_that_cannot_go_together) {
    seed = 64;
    unsigned against = 0;
    for (unsigned i = 0; i < 300U; i++) {
        draw_motor();
        if (draw_one_in(&seed, 3)) { /* the default motor */
            wh_conf_start(&conf, own, NULL, &config);
        } else {
            enter(&motor);
        }
        const wh_conf before = conf;
        const wh_rig_config then = config;
        static const wh_conf_id ids[] = {
            WH_CONF_no_load_speed, WH_CONF_rated_voltage, WH_CONF_stall_torque,
            WH_CONF_mass_moment,   WH_CONF_damping,       WH_CONF_supply_least,
            WH_CONF_supply_most,   WH_CONF_speed_most,    WH_CONF_spin_up};
        const wh_conf_id id = ids[draw_one_of(&seed, sizeof ids / sizeof ids[0])];
        const wh_real value = conf.value[id] * between(WH_R(0.1), WH_R(4.0));
        const wh_station_error error = wh_conf_set(&conf, id, value);
        if (error != WH_STATION_FINE) {
            against += error == WH_STATION_CONF_AGAINST ? 1U : 0U;
            TEST_ASSERT_TRUE(memcmp(&before, &conf, sizeof conf) == 0);
            TEST_ASSERT_TRUE(memcmp(&then, &config, sizeof config) == 0);
            continue;
        }
        const wh_rig_config *c = &config;
        TEST_ASSERT_TRUE(wh_run_needs_V(&c->run, c->guard.target_max_radps) <=
                         c->run.rated_V * WH_R(1.00001));
        TEST_ASSERT_TRUE(c->compensation.stall_Nm >
                         c->measure.rotor.unbalance_kgm * c->measure.rotor.gravity_mps2);
        TEST_ASSERT_TRUE(c->guard.supply_min_V < c->run.rated_V &&
                         c->run.rated_V < c->guard.supply_max_V &&
                         c->run.spin_up_V <= c->run.rated_V);
        TEST_ASSERT_TRUE(c->measure.rotor.damping_Nms >=
                         WH_R(0.899) * c->compensation.stall_Nm / c->run.no_load_radps);
        TEST_ASSERT_TRUE(c->impossible_radps * WH_R(1.00001) >=
                         c->run.no_load_radps * c->guard.supply_max_V / c->run.rated_V);
    }
    TEST_ASSERT_TRUE(against >= 40U);
}

/* The order in which settings are given does not matter. A setting that is given its default keeps it. */
TEST(rig_motor, any_order_of_settings) {
    enum { GIVEN = 8 };
    static const wh_conf_id ids[GIVEN] = {
        WH_CONF_no_load_speed, WH_CONF_rated_voltage, WH_CONF_stall_torque, WH_CONF_damping,
        WH_CONF_gain,          WH_CONF_spin_up,       WH_CONF_supply_most,  WH_CONF_inertia};
    seed = 66;
    unsigned compared = 0;
    const unsigned cases = draw_cases(200);
    for (unsigned i = 0; i < cases; i++) {
        wh_real values[GIVEN];
        wh_rig_config first;
        bool fine = true;
        draw_motor();
        wh_conf_start(&conf, own, NULL, &config);
        for (unsigned k = 0; k < GIVEN; k++) {
            const wh_real other =
                draw_one_in(&seed, 3) ? WH_R(1.0) : between(WH_R(0.95), WH_R(1.3));
            values[k] = conf.standard[ids[k]] * other;
        }
        for (unsigned round = 0; round < 2U; round++) {
            const unsigned stride =
                2U * draw_one_of(&seed, GIVEN / 2) + 1U; /* odd: visits each setting once */
            const unsigned from = draw_one_of(&seed, GIVEN);
            wh_conf_start(&conf, own, NULL, &config);
            for (unsigned k = 0; k < GIVEN; k++) {
                const unsigned at = (from + k * stride) % GIVEN;
                fine = wh_conf_set(&conf, ids[at], values[at]) == WH_STATION_FINE && fine;
            }
            if (round == 0) {
                first = config;
            }
        }
        for (unsigned k = 0; k < GIVEN && fine; k++) {
            TEST_ASSERT_TRUE(conf.value[ids[k]] == (wh_real)(float)values[k]);
        }
        if (fine) {
            compared++;
            TEST_ASSERT_TRUE(memcmp(&first, &config, sizeof config) == 0);
        }
    }
    TEST_ASSERT_TRUE(compared >= cases / 4U);
}
