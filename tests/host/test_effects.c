/* test_effects.c: additive effects of the built-in models, against closed forms or the same motion in other
 * coordinates; test_effect_work.c checks their work.
 *
 * For smooth motions RK4 at these steps is accurate to 1e-10 relative or better (values have order one). The bound is
 * 1e-9 unless stated otherwise. */
#include "motion.h"

#define PI 3.14159265358979323846
#define SMALL 1e-9

/* --- decay of a speed: exponential under viscous drag, hyperbolic under quadratic drag --------------------- */

typedef struct decay {
    const char *file;
    const char *says; /* nothing else moves in it, so the carriage's equation stands alone */
    double mass_kg;
    double start_mps[2]; /* X', Y' */
    double viscous_Nspm;
    double quadratic_kgpm;
} decay;

/* Eccentric carriage: (1 + 1/ratio) times two arms of 0.152 lb with discs of 0.15 lb each. */
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

/* Falling from rest: z' = -v tanh(g t/v), with the terminal velocity v = sqrt(m g/c). */
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

/* A wheel of constant inertia J spins up as w0 (1 - exp(-t M/(J w0))) to the no-load speed. */
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
    /* with the ring centred: J = I_w + 6 m R^2 and I_r + 8 m R^2 */
    follow_spin_up("laskowitz.whirl",
                   "scene t { use laskowitz; with motor_line; set e = 0, torque = 5 [N*m] }\n", 5.0,
                   0.02 + 6.0 * 0.5 * 0.04, 16.0);
    follow_spin_up("laskowitz.whirl",
                   "scene t { use laskowitz; with motor_line; set e = 0, torque = -0.5 [N*m] }\n",
                   -0.5, 0.02 + 6.0 * 0.5 * 0.04, 16.0);
    follow_spin_up("cuff.whirl", "scene t { with motor_line; set e = 0, torque = 5 [N*m] }\n", 5.0,
                   0.5 * 0.0225 + 8.0 * 0.25 * 0.0225, 16.0);
}

/* A tenth of the stall torque holds the arms at the angle of equal gravity torque S g. */
TEST(effects, motor_holds_the_arms_against_gravity) {
    const double S_kgm =
        2.0 * 0.45359237 * 0.0254 * (0.152 * 7.25 / 2.0 + 0.15 * 6.5); /* the header's 0.035163 */
    const double rise = asin(0.1 * 1.5 / (S_kgm * 9.80665));
    static const char *const mechanisms[] = {"eccentric_fixed", "eccentric", "eccentric_coupled"};
    for (int i = 0; i < 3; i++) {
        motion m;
        char text[200];
        /* on the carriage theta counts from the level rail */
        const double at = i == 1 ? rise - PI / 2.0 : rise;
        int length = snprintf(text, sizeof text,
                              "scene t { use %s; with gravity; set duty = 0.1; start theta = %.17g",
                              mechanisms[i], at);
        if (i == 2) { /* the coupling's twist is torque over stiffness */
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

/* Undamped, motor and arms swing against each other with w^2 = k (1/I_arms + 1/J_rotor) and have no mean drift. RK4 at
 * 0.1 ms is late by (w h)^4/120 of the phase: 1e-7 of the amplitude in 0.2 s. */
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

/* At the end the motor's line meets the bearing's drag: stall (duty - w/w0) = b w, and that torque twists the
 * coupling. */
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
