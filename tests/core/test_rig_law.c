/* test_rig_law.c: the rig's speed drive, compared with an independent implementation; and the time without pulses. */
#include <stddef.h>

#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#include "tests/scattered.h"
#include "tests/suites.h"

/* The time without a pulse is counted from the last pulse, even while the timer wraps. If the pulse is later than the
 * step's own time, the time without a pulse is 0. */
TEST(rig_law, silence_goes_on_over_the_wrap) {
    scattered_state = UINT64_C(0x5eed0017);
    for (unsigned i = 0; i < 1000U; i++) {
        const uint32_t then = (uint32_t)(scattered() >> 20) % 4000000U - 2000000U;
        const uint32_t passed = (uint32_t)(scattered() >> 20) % 4000000U;
        wh_speed speed;
        wh_speed_start(&speed, wh_rig_standard.impossible_radps);
        TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, then));
        CHECK_NEAR(1e-5f, (float)passed * 1e-6f, wh_speed_silence_s(&speed, then + passed));
        CHECK_NEAR(0.0f, 0.0f, wh_speed_silence_s(&speed, then - 1U - passed));
    }
}

/* Missing pulses freeze the voltage, and meanwhile the supply sags below it. */
TEST(rig_law, voltage_is_limited_by_the_supply) {
    scattered_state = UINT64_C(0x5eed0006);
    for (unsigned i = 0; i < 200U; i++) {
        static wh_rig rig;
        const wh_real supply_V = WH_R(11.0) + WH_R(0.1) * (wh_real)((scattered() >> 20) % 250U);
        const wh_real drive_V = WH_R(0.15) * (wh_real)((scattered() >> 20) % 250U);
        const wh_rig_inputs inputs = {.now_ticks = 2000U, .supply_V = supply_V};
        wh_rig_start(&wh_rig_standard, &rig, 0, NULL);
        wh_run_start(&rig.run, WH_RIG_NOMINAL_RPM * WH_RIG_RADPS_PER_RPM, 0);
        rig.state = WH_RIG_RUNNING;
        rig.run.phase = WH_PHASE_SETTLE;
        wh_drive_start(&rig.run.drive, rig.run.target_radps, drive_V);
        rig.run.volts = drive_V;
        const wh_rig_command command = wh_rig_step(&wh_rig_standard, &rig, &inputs);
        TEST_ASSERT_TRUE(command.way == WH_MOTOR_DRIVES);
        CHECK_NEAR(1e-5f, drive_V < supply_V ? drive_V : supply_V, command.volts);
    }
}

static double between(double low, double high) {
    return low + (high - low) * (double)(scattered() >> 11) * 0x1p-53;
}

static double limited(double value, double most) {
    return value < 0.0 ? 0.0 : value > most ? most : value;
}

TEST(rig_law, drive_follows_its_control_law) {
    scattered_state = UINT64_C(0x5eed0011);
    const wh_drive_config *law = &wh_rig_standard.run.drive;
    unsigned held = 0;
    for (unsigned i = 0; i < 2000U; i++) {
        wh_drive drive;
        const wh_real supply_V = (wh_real)between(10.8, 37.2);
        const double most = (double)supply_V;
        wh_drive_start(&drive, (wh_real)between(0.0, 40.0), (wh_real)between(-12.0, 48.0));
        TEST_ASSERT_TRUE(wh_drive_at_target(&drive));
        double setpoint = (double)drive.setpoint_radps;
        double integral = (double)drive.integral_V;
        /* less than the set-point's change in three steps; at low speed it changes a quarter as fast */
        const double far = setpoint < (double)law->gentle_radps + 0.1 ? 0.009 : 0.03;
        drive.target_radps = (wh_real)(setpoint + between(-far, far));
        const double target = (double)drive.target_radps;
        TEST_ASSERT_FALSE(wh_drive_at_target(&drive));
        for (unsigned step = 0; step < 4; step++) {
            const double speed = setpoint + between(-60.0, 60.0);
            const double rate = setpoint < (double)law->gentle_radps ? 0.25 : 1.0;
            const double way = rate * (double)law->ramp_radps2 * 0.002;
            setpoint = target > setpoint + way   ? setpoint + way
                       : target < setpoint - way ? setpoint - way
                                                 : target;
            const double error = setpoint - speed;
            const double wanted = 0.24 * error + integral;
            const bool further = (wanted > most && error > 0.0) || (wanted < 0.0 && error < 0.0);
            const wh_real volts = wh_drive_step(law, &drive, (wh_real)speed, supply_V, WH_R(0.002));
            integral = limited(further ? integral : integral + error * 0.002, most);
            held += further;
            CHECK_NEAR(4e-4f, limited(wanted, most), volts);
            CHECK_NEAR(4e-4f, integral, drive.integral_V);
            CHECK_NEAR(2e-5f, setpoint, drive.setpoint_radps);
        }
        TEST_ASSERT_TRUE(wh_drive_at_target(&drive));
    }
    TEST_ASSERT_GREATER_THAN_UINT(500, held);
}
