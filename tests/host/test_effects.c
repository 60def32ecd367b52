/* test_effects.c: the additive effects of the built-in models, compared with closed forms or with the same motion in
 * other coordinates, and checked by their work.
 *
 * For smooth motions with values of about one, RK4 has errors below 1e-10 with these steps. The bound is 1e-9 unless
 * stated otherwise. */
#include "motion.h"
#include <complex.h>

#define PI 3.14159265358979323846
#define SMALL 1e-9

/* --- decay of a speed: exponential under viscous drag, hyperbolic under quadratic drag --------------------- */

typedef struct decay {
    const char *file;
    const char *says; /* statements of a scene in which only the carriage moves */
    double mass_kg;
    double start_mps[2]; /* start values of X' and Y' */
    double viscous_Nspm;
    double quadratic_kgpm;
} decay;

/* Mass of the eccentric carriage: (1 + 1/ratio) times two arms of 0.152 lb, each with a disc of 0.15 lb. */
#define ECCENTRIC_KG (4.0 * 2.0 * 0.302 * 0.45359237)

static void follow_decay(const decay *d) {
    motion m;
    char text[200];
    snprintf(text, sizeof text, "scene t { %s; start X' = %g [m/s]%s }\n", d->says, d->start_mps[0],
             d->start_mps[1] < 0.0 ? ", Y' = -3 [m/s]" : "");
    motion_open_more(&m, d->file, text, IN_DOUBLE_STEP(1e-3));
    for (int half = 1; half <= 8; half++) {
        const double t = 0.5 * half;
        motion_to(&m, t);
        for (int k = 0; k < 2; k++) {
            const double v0 = d->start_mps[k];
            if (k == 1 && v0 == 0.0) {
                continue;
            }
            double v = v0 * exp(-d->viscous_Nspm * t / d->mass_kg);
            double x = v0 == v ? v0 * t : (v0 - v) * d->mass_kg / d->viscous_Nspm;
            if (d->quadratic_kgpm > 0.0) {
                const double part = d->quadratic_kgpm * fabs(v0) / d->mass_kg;
                v = v0 / (1.0 + part * t);
                x = v0 / part * log(1.0 + part * t);
            }
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(SMALL, v, motion_value(&m, k == 0 ? "X'" : "Y'"),
                                              d->says);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(SMALL, x, motion_value(&m, k == 0 ? "X" : "Y"),
                                              d->says);
        }
    }
    motion_close(&m);
}

TEST(effects, drag_decays) {
    static const decay decays[] = {
        {"eccentric.whirl", "use eccentric; with rail_drag", ECCENTRIC_KG, {2.0}, 0.5, 0.0},
        {"laskowitz.whirl", "use laskowitz; with ground_drag; set torque = 0", 9, {2, -3}, 0.5, 0},
        {"cuff.whirl", "with ground_drag; set torque = 0", 7.0, {2.0, -3.0}, 0.5, 0.0},
        {"epicyclic.whirl", "with air_drag; set M = 0", 4.0, {2.0}, 0.0, 0.2},
        {"eccentric.whirl", "use eccentric; with air_drag", ECCENTRIC_KG, {-2.0}, 0.0, 0.2}};
    for (size_t i = 0; i < sizeof decays / sizeof decays[0]; i++) {
        follow_decay(&decays[i]);
    }
}

/* A fall from rest: z' = -v tanh(g t/v), with the terminal velocity v = sqrt(m g/c). */
TEST(effects, fall_reaches_the_terminal_velocity) {
    motion m;
    const double terminal_mps = sqrt(9.81 / 0.1);
    motion_open_more(&m, "cartesian_particle.whirl",
                     "scene t { with air_drag; set c = 0.1 [kg/m] }\n", IN_DOUBLE_STEP(1e-3));
    for (int k = 1; k <= 32; k *= 2) {
        const double t = 0.25 * k;
        motion_to(&m, t);
        const double reach = 9.81 * t / terminal_mps;
        TEST_ASSERT_DOUBLE_WITHIN(SMALL, -terminal_mps * tanh(reach), motion_value(&m, "z'"));
        TEST_ASSERT_DOUBLE_WITHIN(SMALL, -terminal_mps * terminal_mps / 9.81 * log(cosh(reach)),
                                  motion_value(&m, "z"));
    }
    motion_close(&m);
}

TEST(effects, drag_is_the_same_in_spherical_coordinates) {
    static const char *const names[] = {"x", "y", "z"};
    motion a;
    motion b;
    motion_open_more(&a, "spherical_particle.whirl",
                     "scene t { with air_drag; set c = 0.1 [kg/m]\n"
                     "start r = 5 [m], theta = pi/2, phi = 0\n"
                     "start r' = 2 [m/s], theta' = -0.75 [rad/s], phi' = 0.5 [rad/s] }\n",
                     IN_DOUBLE_STEP(1e-3));
    motion_open_more(&b, "cartesian_particle.whirl",
                     "scene t { with air_drag; set c = 0.1 [kg/m]\n"
                     "start x = 5 [m], x' = 2 [m/s], y' = 2.5 [m/s], z' = 3.75 [m/s] }\n",
                     IN_DOUBLE_STEP(1e-3));
    motion_to(&a, 1.0);
    motion_to(&b, 1.0);
    for (int k = 0; k < 3; k++) {
        TEST_ASSERT_DOUBLE_WITHIN(SMALL, motion_value(&b, names[k]), motion_value(&a, names[k]));
    }
    motion_close(&a);
    motion_close(&b);
}

/* A wheel of constant inertia J spins up to the no-load speed w0 by w0 (1 - exp(-t M/(J w0))), with the stall torque
 * M. */
static void follow_spin_up(const char *file, const char *text, double torque_Nm,
                           double inertia_kgm2, double until_s) {
    motion m;
    motion_open_more(&m, file, text, IN_DOUBLE_STEP(1e-3));
    for (int k = 1; k <= 8; k++) {
        const double t = until_s * k / 8.0;
        motion_to(&m, t);
        const double want =
            copysign(20.0, torque_Nm) * (1.0 - exp(-t * fabs(torque_Nm) / (inertia_kgm2 * 20.0)));
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(SMALL * 20.0, want, motion_value(&m, "theta'"), text);
    }
    motion_close(&m);
}

TEST(effects, motor_line_ends_at_the_no_load_speed) {
    /* with a centred ring, J is I_w + 6 m R^2, or I_r + 8 m R^2 */
    follow_spin_up("laskowitz.whirl",
                   "scene t { use laskowitz; with motor_line; set e = 0, torque = 5 [N*m] }\n", 5.0,
                   0.02 + 6.0 * 0.5 * 0.04, 16.0);
    follow_spin_up("laskowitz.whirl",
                   "scene t { use laskowitz; with motor_line; set e = 0, torque = -0.5 [N*m] }\n",
                   -0.5, 0.02 + 6.0 * 0.5 * 0.04, 16.0);
    follow_spin_up("cuff.whirl", "scene t { with motor_line; set e = 0, torque = 5 [N*m] }\n", 5.0,
                   0.5 * 0.0225 + 8.0 * 0.25 * 0.0225, 16.0);
}

/* A tenth of the stall torque must hold the arms at the angle at which gravity has the same torque. */
TEST(effects, motor_holds_the_arms_against_gravity) {
    const double S_kgm =
        /* this product is 0.035163 in the model's header */
        2.0 * 0.45359237 * 0.0254 * (0.152 * 7.25 / 2.0 + 0.15 * 6.5);
    const double rise = asin(0.1 * 1.5 / (S_kgm * 9.80665));
    static const char *const mechanisms[] = {"eccentric_fixed", "eccentric", "eccentric_coupled"};
    for (int i = 0; i < 3; i++) {
        motion m;
        char text[200];
        /* on the carriage, theta counts from the level rail */
        const double at = i == 1 ? rise - PI / 2.0 : rise;
        int length = snprintf(text, sizeof text,
                              "scene t { use %s; with gravity; set duty = 0.1; start theta = %.17g",
                              mechanisms[i], at);
        if (i == 2) { /* the coupling is twisted by torque over stiffness */
            length += snprintf(text + length, sizeof text - (size_t)length, ", motor = %.17g",
                               at + 0.1 * 1.5 / 20.0);
        }
        snprintf(text + length, sizeof text - (size_t)length, " }\n");
        motion_open_more(&m, "eccentric.whirl", text, IN_DOUBLE_STEP(1e-3));
        motion_to(&m, 5.0);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12, at, motion_value(&m, "theta"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-12, 0.0, motion_value(&m, "theta'"), text);
        motion_close(&m);
    }
}

#define LB 0.45359237
#define IN 0.0254

/* Without damping, motor and arms swing against each other with w^2 = k (1/I_arms + 1/J_rotor) and without drift.
 * With 0.1 ms, RK4 lags by (w h)^4/120 of the phase: 1e-7 of the amplitude in 0.2 s. */
TEST(effects, coupling_swings) {
    const double arms = 2.0 * LB * IN * IN * (0.152 * 7.25 * 7.25 / 3.0 + 0.15 * 6.5 * 6.5) + 1e-4;
    const double rotor = 4e-4;
    const double w = sqrt(20.0 * (1.0 / arms + 1.0 / rotor));
    motion m;
    motion_open_more(
        &m, "eccentric.whirl",
        "scene t { use eccentric_coupled; set b = 0, c = 0, stall = 0; start motor = 0.01 }\n",
        IN_DOUBLE_STEP(1e-4));
    for (int k = 1; k <= 20; k++) {
        const double t = 0.01 * k;
        motion_to(&m, t);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 * 2e-7, 0.01 * cos(w * t), motion_value(&m, "twist"));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, rotor * 0.01,
                                  arms * motion_value(&m, "theta") +
                                      rotor * motion_value(&m, "motor"));
    }
    motion_close(&m);
}

/* At the end, the motor's torque equals the bearing's drag, stall (duty - w/w0) = b w, and twists the coupling. */
TEST(effects, coupled_motor_ends_at_its_load_speed) {
    motion m;
    motion_open_more(&m, "eccentric.whirl", "scene t { use eccentric_coupled; set duty = 0.6 }\n",
                     IN_DOUBLE_STEP(1e-3));
    motion_to(&m, 20.0);
    const double no_load = 600.0 * 2.0 * PI / 60.0;
    const double speed = 0.6 * 1.5 / (1e-3 + 1.5 / no_load);
    TEST_ASSERT_DOUBLE_WITHIN(SMALL, speed, motion_value(&m, "speed"));
    TEST_ASSERT_DOUBLE_WITHIN(SMALL, speed, motion_value(&m, "theta'"));
    TEST_ASSERT_DOUBLE_WITHIN(SMALL, 1e-3 * speed / 20.0, motion_value(&m, "twist"));
    motion_close(&m);
}

/* === suite effect_work ========================================================================= */
/* The work of the additive effects in the built-in models. The energies of the bodies, which are written in complex
 * numbers here, must change by the integral of the effect's power. */

#define J ((double complex)_Complex_I)

#define M_KG 2.0
#define R_M 0.3
#define I_KGM2 (M_KG * R_M * R_M / 2.0)

static double square(double complex v) { return creal(v) * creal(v) + cimag(v) * cimag(v); }

/* Energy of one unit of Thomson's device, with the bodies 30, 26 and 33. `rail` is the velocity of its carriage. */
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

/* Power of a motor with a stall torque of -2 N m and a no-load speed of -20 rad/s. */
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

/* E(t) - E(0) must be the work, which Simpson's rule integrates over every step. With steps of 0.125 ms for 1 s, the
 * error of Simpson's rule and RK4, both of order 4, is a tenth of the bound. */
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
