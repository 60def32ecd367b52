/* test_effect_work.c: additive effects of the built-in models by their work. The energies of the bodies, written here
 * in complex numbers, must change by the integral of the effect's power. */
#include "motion.h"

#include <complex.h>

#define J ((double complex)_Complex_I)

#define M_KG 2.0
#define R_M 0.3
#define I_KGM2 (M_KG * R_M * R_M / 2.0)

static double square(double complex v) { return creal(v) * creal(v) + cimag(v) * cimag(v); }

/* One unit of Thomson's device with the carriage's velocity `rail`: bodies 30, 26 and 33. */
static double unit_energy_J(double arm, double arm_rate, double disc, double disc_rate,
                            double complex rail, bool spins, double g_mps2) {
    const double complex arm_at = 2.0 * R_M * cexp(J * arm);
    const double complex hinge = R_M * cexp(2.0 * J * arm);
    const double complex rim = R_M * cexp(J * disc);
    const double complex v26 = rail + J * arm_rate * arm_at;
    const double complex v33 = v26 + 2.0 * J * arm_rate * hinge + J * disc_rate * rim;
    const double height = cimag(arm_at) + cimag(arm_at + hinge + rim);
    return M_KG / 2.0 * (square(rail) + square(v26) + square(v33)) +
           I_KGM2 / 2.0 * 4.0 * arm_rate * arm_rate + M_KG * g_mps2 * height +
           (spins ? I_KGM2 / 2.0 * disc_rate * disc_rate : 0.0);
}

static double thomson_J(const motion *m, bool spins, double g_mps2) {
    return unit_energy_J(motion_value(m, "theta1"), motion_value(m, "theta1'"),
                         motion_value(m, "theta2"), motion_value(m, "theta2'"),
                         motion_value(m, "X'"), spins, g_mps2);
}

static double thomson_plain_J(const motion *m) { return thomson_J(m, false, 0.0); }
static double thomson_spin_J(const motion *m) { return thomson_J(m, true, 0.0); }
static double thomson_gravity_J(const motion *m) { return thomson_J(m, false, 9.81); }

static double complex carriage(const motion *m) {
    return motion_value(m, "X'") + J * motion_value(m, "Y'");
}

static double plane_spin_J(const motion *m) {
    return unit_energy_J(motion_value(m, "theta1"), motion_value(m, "theta1'"),
                         motion_value(m, "theta2"), motion_value(m, "theta2'"), carriage(m), true,
                         0.0);
}

static double pair_spin_J(const motion *m) {
    return unit_energy_J(motion_value(m, "theta1a"), motion_value(m, "theta1a'"),
                         motion_value(m, "theta2a"), motion_value(m, "theta2a'"), carriage(m), true,
                         0.0) +
           unit_energy_J(motion_value(m, "theta1b"), motion_value(m, "theta1b'"),
                         motion_value(m, "theta2b"), motion_value(m, "theta2b'"), carriage(m), true,
                         0.0);
}

static double epicyclic_energy_J(const motion *m, double g_mps2) {
    const double complex arm = 2.0 * R_M * cexp(J * motion_value(m, "theta"));
    const double rate = motion_value(m, "theta'");
    const double rail = motion_value(m, "X'");
    return M_KG / 2.0 * (rail * rail + square(rail + J * rate * arm)) +
           I_KGM2 / 2.0 * 4.0 * rate * rate + M_KG * g_mps2 * cimag(arm);
}

static double epicyclic_J(const motion *m) { return epicyclic_energy_J(m, 0.0); }
static double epicyclic_gravity_J(const motion *m) { return epicyclic_energy_J(m, 9.81); }

static double hinge_energy_J(const motion *m, double g_mps2) {
    const double rate1 = motion_value(m, "theta1'");
    const double rate2 = motion_value(m, "theta2'");
    const double complex at1 = R_M * cexp(J * motion_value(m, "theta1"));
    const double complex at2 = R_M * cexp(J * motion_value(m, "theta2"));
    return M_KG / 2.0 * square(J * rate1 * at1 + J * rate2 * at2) + I_KGM2 / 2.0 * rate2 * rate2 +
           M_KG * g_mps2 * cimag(at1 + at2);
}

static double hinge_J(const motion *m) { return hinge_energy_J(m, 0.0); }
static double hinge_gravity_J(const motion *m) { return hinge_energy_J(m, 9.81); }

static double no_power_W(const motion *m) {
    (void)m;
    return 0.0;
}

/* A motor of -2 N*m whose torque vanishes at -20 rad/s. */
static double line_W(double rate) { return -2.0 * (1.0 - rate / -20.0) * rate; }
static double motor_W(const motion *m) { return line_W(motion_value(m, "theta1'")); }

static double epicyclic_motor_W(const motion *m) {
    const double rate = motion_value(m, "theta'");
    return 2.0 * (1.0 - rate / 20.0) * rate;
}

static double pair_motor_W(const motion *m) {
    return line_W(motion_value(m, "theta1a'")) + line_W(-motion_value(m, "theta1b'"));
}

static double ground_W(const motion *m) { return -0.5 * square(carriage(m)); }
static double rail_W(const motion *m) { return -0.5 * square(motion_value(m, "X'")); }
static double air_W(const motion *m) { return -0.2 * pow(fabs(motion_value(m, "X'")), 3.0); }

static double hinge_W(const motion *m) {
    return -0.01 * square(motion_value(m, "theta2'") - motion_value(m, "theta1'"));
}

typedef double quantity(const motion *m);

typedef struct balance {
    const char *file;
    const char *use;
    const char *effect;
    const char *rest;
    quantity *energy_J;
    quantity *power_W;
} balance;

#define FAST "start theta1' = -8.5 [rad/s], theta2 = -pi/2, theta2' = 1 [rad/s], X' = 0.5 [m/s]"
#define PAIR \
    "start theta1a' = -8.5 [rad/s], theta1b' = 5 [rad/s], theta2a = -1, theta2b = 2, X' = 1 [m/s]"

static const balance balances[] = {
    {"thomson.whirl", "thomson", "spin_33", "set M = 0; " FAST, thomson_spin_J, no_power_W},
    {"thomson.whirl", "thomson", "gravity", "set M = 0; " FAST, thomson_gravity_J, no_power_W},
    {"thomson.whirl", "thomson", "rail_drag", "set M = 0; " FAST, thomson_plain_J, rail_W},
    {"thomson.whirl", "thomson", "air_drag", "set M = 0; " FAST, thomson_plain_J, air_W},
    {"thomson.whirl", "thomson", "motor_line", FAST, thomson_plain_J, motor_W},
    {"thomson_plane.whirl", "thomson_plane", "spin_33", "set M = 0; " FAST, plane_spin_J,
     no_power_W},
    {"thomson_plane.whirl", "thomson_plane", "spin_33, ground_drag", "set M = 0; " FAST,
     plane_spin_J, ground_W},
    {"thomson_plane.whirl", "thomson_plane", "spin_33, motor_line", FAST, plane_spin_J, motor_W},
    {"thomson_plane.whirl", "thomson_pair", "spin_33", "set M = 0; " PAIR, pair_spin_J, no_power_W},
    {"thomson_plane.whirl", "thomson_pair", "spin_33, ground_drag", "set M = 0; " PAIR, pair_spin_J,
     ground_W},
    {"thomson_plane.whirl", "thomson_pair", "spin_33, motor_line", PAIR, pair_spin_J, pair_motor_W},
    {"epicyclic.whirl", "epicyclic", "gravity", "set M = 0; start theta' = 3 [rad/s]",
     epicyclic_gravity_J, no_power_W},
    {"epicyclic.whirl", "epicyclic", "motor_line", "start theta' = 3 [rad/s]", epicyclic_J,
     epicyclic_motor_W},
    {"driven_hinge.whirl", "driven_hinge", "gravity", "set M = 0; start theta1' = 3 [rad/s]",
     hinge_gravity_J, no_power_W},
    {"driven_hinge.whirl", "driven_hinge", "hinge_drag", "set M = 0; start theta1' = 3 [rad/s]",
     hinge_J, hinge_W},
    {"driven_hinge.whirl", "driven_hinge", "motor_line", "start theta1' = 3 [rad/s]", hinge_J,
     motor_W}};

/* E(t) - E(0) is the work, by Simpson's rule over every step. Simpson and RK4 both have order 4: the bound holds at
 * 0.125 ms for 1 s with a margin of ten. */
TEST(effect_work, energy_changes_by_the_work_of_the_effect) {
    for (size_t i = 0; i < sizeof balances / sizeof balances[0]; i++) {
        const balance *b = &balances[i];
        char text[300];
        motion m;
        snprintf(text, sizeof text, "scene t { use %s; with %s; %s }\n", b->use, b->effect,
                 b->rest);
        motion_open_more(&m, b->file, text, IN_DOUBLE_STEP(0.125e-3));
        const double start_J = b->energy_J(&m);
        double work_J = 0.0;
        double before = b->power_W(&m);
        double loss_or_gain = 0.0;
        for (int pair = 0; pair < 4000; pair++) {
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            const double middle = b->power_W(&m);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            const double after = b->power_W(&m);
            work_J += 0.125e-3 / 3.0 * (before + 4.0 * middle + after);
            loss_or_gain += fabs(after);
            before = after;
        }
        TEST_ASSERT_TRUE_MESSAGE(b->power_W == no_power_W || loss_or_gain > 1.0, text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-8, start_J + work_J, b->energy_J(&m), text);
        motion_close(&m);
    }
}
