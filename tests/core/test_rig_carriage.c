/* test_rig_carriage.c: the angle within a turn on a carriage that moves, compared with the rotor integrated over its
 * angle; and the effect of the mount on the controller's numbers. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"

#include "tests/suites.h"

#define STEPS 720U
#define TURNS 16U

static wh_rotor_config rotor;
/* At STEPS equal angles from sensor 1's pulse: the part of the turn's time that has passed. */
static wh_real part_at[STEPS + 1U];
static wh_real turn_s;

static wh_real sine_of(wh_real rad) { return wh_wave_of(rad).sine; }

/* Returns the slope of the speed, per rad: (I - D sin^2) w dw/dtheta = D w^2 sin cos + c (omega - w). */
static wh_real slope(wh_real theta, wh_real speed, wh_real omega) {
    const wh_real sine = sine_of(theta);
    const wh_real inertia = rotor.inertia_kgm2 - rotor.yields_kgm2 * sine * sine;
    const wh_real torque = WH_R(0.5) * rotor.yields_kgm2 * speed * speed * sine_of(theta + theta) +
                           rotor.damping_Nms * (omega - speed);
    return torque / (inertia * speed);
}

/* Integrates turns until the motion is periodic. Stores the last turn. */
static void integrate(wh_real omega) {
    const wh_real step = WH_RIG_TWO_PI / (wh_real)STEPS;
    wh_real speed = omega;
    for (unsigned turn = 0; turn < TURNS; turn++) {
        wh_real time = WH_R(0.0);
        for (unsigned i = 0; i < STEPS; i++) {
            const wh_real theta = rotor.pulse_rad[0] + step * (wh_real)i;
            const wh_real half = WH_R(0.5) * step;
            const wh_real middle = speed + half * slope(theta, speed, omega);
            const wh_real next = speed + step * slope(theta + half, middle, omega);
            part_at[i] = time;
            time += step / middle;
            speed = next;
        }
        turn_s = time;
    }
    for (unsigned i = 0; i < STEPS; i++) {
        part_at[i] /= turn_s;
    }
    part_at[STEPS] = WH_R(1.0);
}

static wh_real off(const wh_rotor_config *config, wh_turn_angle *angle) {
    wh_turn_angle_start(config, angle);
    for (unsigned round = 0; round < 4U; round++) {
        wh_turn_angle_shape(config, angle, WH_RIG_TWO_PI / turn_s);
    }
    wh_real most = WH_R(0.0);
    for (unsigned i = 0; i <= STEPS; i++) {
        const wh_real theta = config->pulse_rad[0] + WH_RIG_TWO_PI / (wh_real)STEPS * (wh_real)i;
        const wh_real far = WH_ABS(wh_turn_angle_at(angle, part_at[i]) - theta);
        most = far > most ? far : most;
    }
    return most;
}

static void mount(wh_real ratio) {
    wh_rig_config config = wh_rig_standard;
    const wh_carriage carriage = {.disc_m = WH_RIG_DISC_RADIUS_M, .ratio = ratio};
    wh_rig_slots(&config, WH_R(1.0) / WH_RIG_DEG_PER_RAD);
    wh_carriage_mount(&config, &carriage);
    rotor = config.measure.rotor;
}

TEST(rig_carriage, angle_on_a_carriage) {
    static const wh_real ratios[] = {WH_R(0.05), WH_R(0.2), WH_R(0.33333333), WH_R(0.6)};
    static const wh_real speeds[] = {WH_R(18.0), WH_R(34.557519), WH_R(38.0)};
    wh_turn_angle angle;
    for (unsigned r = 0; r < sizeof ratios / sizeof ratios[0]; r++) {
        for (unsigned s = 0; s < sizeof speeds / sizeof speeds[0]; s++) {
            for (unsigned drag = 1; drag <= 4U; drag *= 2U) {
                /* a steeper torque line; it shifts the phase of twice_rad */
                mount(ratios[r]);
                rotor.damping_Nms *= (wh_real)drag;
                integrate(speeds[s]);
                wh_rotor_config even = rotor;
                even.yields_kgm2 = WH_R(0.0);
                wh_turn_angle unshaped;
                const wh_real left = off(&rotor, &angle);
                const wh_real even_off = off(&even, &unshaped);
                const wh_real wave = angle.twice_rad;
                TEST_ASSERT_TRUE(unshaped.twice_rad == WH_R(0.0));
                TEST_ASSERT_TRUE(wave > WH_R(0.0) && wave < WH_R(0.06));
                /* even_off is the largest error of an angle of constant speed. The error is the term of twice the
                 * angle, minus that term's value at the pulse. */
                TEST_ASSERT_TRUE(even_off > WH_R(0.9) * wave && even_off < WH_R(2.1) * wave);
                TEST_ASSERT_TRUE(left < WH_R(2.5) * wave * wave + WH_R(6e-5));
            }
        }
    }
}

/* A carriage too heavy to move is a fixed mount; a rotor without masses moves no carriage. */
TEST(rig_carriage, no_wave) {
    wh_turn_angle angle;
    mount(WH_R(0.0));
    integrate(WH_R(34.557519));
    TEST_ASSERT_TRUE(off(&rotor, &angle) < WH_R(6e-5) && angle.twice_rad == WH_R(0.0));
    rotor.yields_kgm2 = rotor.inertia_kgm2;
    wh_turn_angle_shape(&rotor, &angle, WH_R(34.557519));
    TEST_ASSERT_TRUE(angle.twice_rad == WH_R(0.0));
    rotor.yields_kgm2 = WH_R(-1.0);
    wh_turn_angle_shape(&rotor, &angle, WH_R(34.557519));
    TEST_ASSERT_TRUE(angle.twice_rad == WH_R(0.0));
}

TEST(rig_carriage, mount) {
    const wh_carriage carriage = {.disc_m = WH_RIG_DISC_RADIUS_M, .ratio = WH_R(0.33333333)};
    wh_rig_config config = wh_rig_standard;
    wh_carriage_mount(&config, &carriage);
    const wh_rotor_config *turns = &config.measure.rotor;
    CHECK_NEAR(4e-9f, WH_RIG_UNBALANCE_KGM, turns->unbalance_kgm);
    CHECK_NEAR(1e-9f, WH_RIG_INERTIA_KGM2, turns->inertia_kgm2);
    CHECK_NEAR(1e-6f, 0.75f, config.measure.result.mount_factor);
    /* unbalance squared, divided by the mass of carriage and masses, four times 0.274 kg */
    CHECK_NEAR(3e-8f, 0.0351631f * 0.0351631f / (4.0f * 0.2739698f), turns->yields_kgm2);
    CHECK_NEAR(1e-8f, 0.75f * (float)wh_rig_standard.guard.load_still_kgm,
               config.guard.load_still_kgm);
    TEST_ASSERT_TRUE(turns->gravity_mps2 == WH_R(0.0) &&
                     config.compensation_when == WH_COMPENSATION_NEVER &&
                     config.observer.scene == NULL);

    /* Without discs, only the arms have unbalance, and the carriage's model neglects it. */
    const wh_carriage bare = {.disc_m = WH_R(0.0), .ratio = WH_R(0.0)};
    wh_carriage_mount(&config, &bare);
    CHECK_NEAR(1e-8f, 2.0f * 0.152f * 3.625f * 0.45359237f * 0.0254f, turns->unbalance_kgm);
    TEST_ASSERT_TRUE(turns->yields_kgm2 == WH_R(0.0) &&
                     config.measure.result.mount_factor == WH_R(1.0));
}

TEST(rig_carriage, swing) {
    static const wh_real radii[] = {WH_R(0.05), WH_R(0.1), WH_R(0.1651)};
    static const wh_real ratios[] = {WH_R(0.1), WH_R(0.33333333), WH_R(1.0)};
    for (unsigned r = 0; r < sizeof radii / sizeof radii[0]; r++) {
        for (unsigned q = 0; q < sizeof ratios / sizeof ratios[0]; q++) {
            const wh_carriage carriage = {.disc_m = radii[r], .ratio = ratios[q]};
            wh_rig_config config = wh_rig_standard;
            wh_carriage_mount(&config, &carriage);
            const wh_real part = config.measure.result.mount_factor;
            const wh_real moment = config.measure.rotor.unbalance_kgm;
            /* without the discs of 0.136 kg, the inertia is smaller */
            CHECK_NEAR(1e-8f, 0.136077711f * (float)(radii[r] * radii[r] - WH_R(0.02725801)),
                       config.measure.rotor.inertia_kgm2 - WH_RIG_INERTIA_KGM2);
            /* if the force is 10 % above the expected one, so is the motion of the carriage */
            const wh_measured force = {.amplitude_N = WH_R(1.1) * part * moment * WH_R(900.0),
                                       .expected_N = part * moment * WH_R(900.0)};
            const wh_real due = WH_R(1.1) * moment * (WH_R(1.0) - part) / WH_RIG_ECCENTRIC_KG;
            const wh_real off_m = wh_carriage_displacement_m(&config, &carriage, &force) - due;
            TEST_ASSERT_TRUE(WH_ABS(off_m) < WH_R(1e-5) * due);
            const wh_measured none = {.amplitude_N = WH_R(0.0)};
            TEST_ASSERT_TRUE(wh_carriage_displacement_m(&config, &carriage, &none) == WH_R(0.0));
        }
    }
}
