/* test_arm.c: arms of six joints, derived, against the recursion of Newton and Euler (Luh, Walker and Paul 1980) in world
 * coordinates, which knows neither energies nor their derivatives. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/base/alloc.h"
#include "unity.h"

void suite_arm(void);

enum { JOINTS = 6 };
#define G 9.81

typedef struct arm {
    int axis[JOINTS];          /* of its joint, in its own frame */
    double offset[JOINTS];     /* of its joint from the one before, along z there, m */
    double centre[JOINTS];     /* of mass, along z, m */
    double mass[JOINTS];       /* kg */
    double inertia[JOINTS][3]; /* about the centre, kg m^2 */
} arm;

static arm draw_arm(dice *d) {
    static const int axes[3][JOINTS] = {{2, 1, 1, 2, 1, 2}, {2, 1, 1, 0, 1, 0}, {2, 0, 1, 2, 0, 2}};
    const int *axis = axes[dice_one_of(d, 3)];
    arm a;
    for (int i = 0; i < JOINTS; i++) {
        a.axis[i] = axis[i];
        a.offset[i] = dice_one_of(d, 3) == 0 ? 0.0 : dice_between(d, 0.05, 0.5);
        a.centre[i] = dice_between(d, 0.02, 0.3);
        a.mass[i] = dice_between(d, 0.3, 8.0);
        for (int k = 0; k < 3; k++) {
            a.inertia[i][k] = a.mass[i] * dice_between(d, 0.001, 0.02);
        }
    }
    return a;
}

/* The entry of the matrix that takes from frame i to the one before: "cos(q1)", "-sin(q1)", "1" or "0". */
static const char *entry(const arm *a, int i, int row, int column, char text[20]) {
    const int k = a->axis[i];
    if (row == k || column == k) {
        return row == column ? "1" : "0";
    }
    const bool minus = column == (row + 1) % 3;
    snprintf(text, 20, "%s%s(q%d)", minus ? "-" : "", row == column ? "cos" : "sin", i);
    return text;
}

/* As people write it who come from SymPy: turned frames, places of the centres in the world, and their derivatives. */
static char *text_of(const arm *a) {
    char *text;
    size_t length;
    char e[20];
    FILE *out = alloc_text(&text, &length);
    fputs("mechanism arm\n", out);
    for (int i = 0; i < JOINTS; i++) {
        fprintf(out, "coordinate q%d [rad]\n", i);
    }
    for (int i = 0; i < JOINTS; i++) {
        for (int row = 0; row < 3;
             row++) { /* R: axes of link i in the world, p: its joint, c: its centre */
            for (int k = 0; k < 3; k++) {
                fprintf(out, "let R%d_%d%d = 0", i, row, k);
                for (int j = 0; j < 3 && i > 0; j++) {
                    fprintf(out, " + R%d_%d%d*(%s)", i - 1, row, j, entry(a, i, j, k, e));
                }
                fprintf(out, " + (%s)\n", i == 0 ? entry(a, i, row, k, e) : "0");
            }
            fprintf(out, "let p%d_%d = 0 [m]", i, row);
            if (i > 0) {
                fprintf(out, " + p%d_%d + %.17g [m]*R%d_%d2", i - 1, row, a->offset[i], i - 1, row);
            }
            fprintf(out, "\nlet c%d_%d = p%d_%d + %.17g [m]*R%d_%d2\n", i, row, i, row,
                    a->centre[i], i, row);
        }
    }
    fputs("T = (0 [J]", out);
    for (int i = 0; i < JOINTS; i++) {
        fprintf(out, "\n  + %.17g [kg]*(c%d_0'^2 + c%d_1'^2 + c%d_2'^2)/2", a->mass[i], i, i, i);
        for (int k = 0; k < 3; k++) { /* the rate of axis b along axis c: about axis k */
            const int b = (k + 1) % 3;
            const int c = (k + 2) % 3;
            fprintf(
                out,
                " + %.17g [kg*m^2]/2*(R%d_0%d'*R%d_0%d + R%d_1%d'*R%d_1%d + R%d_2%d'*R%d_2%d)^2",
                a->inertia[i][k], i, b, i, c, i, b, i, c, i, b, i, c);
        }
    }
    fputs(")\nV = (0 [J]", out);
    for (int i = 0; i < JOINTS; i++) {
        fprintf(out, " + %.17g [N]*c%d_2", a->mass[i] * G, i);
    }
    fputs(")\n", out);
    alloc_text_end(out);
    return text;
}

/* --- Newton and Euler ------------------------------------------------------------------------------------------- */

typedef struct vector {
    double x[3];
} vector;

static vector plus(vector a, double scale, vector b) {
    return (vector){{a.x[0] + scale * b.x[0], a.x[1] + scale * b.x[1], a.x[2] + scale * b.x[2]}};
}

static vector cross(vector a, vector b) {
    return (vector){{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
                     a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

static double dot(vector a, vector b) {
    return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/* The torque that each joint must give, N m, with *size what its terms add up to in size. */
static void torques(const arm *a, const state_values *s, double *torque, double *size) {
    vector frame[JOINTS][3]; /* axes of each link, in the world */
    vector joint[JOINTS];
    vector force[JOINTS]; /* that moves link i, and its moment about the centre */
    vector moment[JOINTS];
    vector at[JOINTS]; /* the centre */
    vector axes[3] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    vector w = {{0}};
    vector turn = {{0}}; /* angular acceleration */
    vector p = {{0}};
    vector lift = {{0, 0, G}}; /* acceleration of the joint, gravity in it */
    for (int i = 0; i < JOINTS; i++) {
        const int k = a->axis[i];
        const double q = s->value[i][0];
        if (i > 0) {
            const vector arm_to = plus((vector){{0}}, a->offset[i], axes[2]);
            lift = plus(plus(lift, 1.0, cross(turn, arm_to)), 1.0, cross(w, cross(w, arm_to)));
            p = plus(p, 1.0, arm_to);
        }
        const vector one = axes[(k + 1) % 3];
        const vector two = axes[(k + 2) % 3];
        axes[(k + 1) % 3] = plus(plus((vector){{0}}, cos(q), one), sin(q), two);
        axes[(k + 2) % 3] = plus(plus((vector){{0}}, cos(q), two), -sin(q), one);
        turn = plus(plus(turn, s->value[i][2], axes[k]), s->value[i][1], cross(w, axes[k]));
        w = plus(w, s->value[i][1], axes[k]);
        memcpy(frame[i], axes, sizeof axes);
        joint[i] = p;
        const vector out = plus((vector){{0}}, a->centre[i], axes[2]);
        const vector accel = plus(plus(lift, 1.0, cross(turn, out)), 1.0, cross(w, cross(w, out)));
        at[i] = plus(p, 1.0, out);
        force[i] = plus((vector){{0}}, a->mass[i], accel);
        vector spin = {{0}};
        moment[i] = (vector){{0}};
        for (int j = 0; j < 3; j++) {
            spin = plus(spin, a->inertia[i][j] * dot(w, axes[j]), axes[j]);
            moment[i] = plus(moment[i], a->inertia[i][j] * dot(turn, axes[j]), axes[j]);
        }
        moment[i] = plus(moment[i], 1.0, cross(w, spin));
    }
    for (int i = 0; i < JOINTS; i++) {
        torque[i] = 0.0;
        size[i] = 0.0;
        for (int j = i; j < JOINTS; j++) {
            const vector about = plus(moment[j], 1.0, cross(plus(at[j], -1.0, joint[i]), force[j]));
            torque[i] += dot(about, frame[i][a->axis[i]]);
            size[i] += fabs(dot(about, frame[i][a->axis[i]]));
        }
    }
}

static void test_arms_of_six_joints_move_as_newton_and_euler_say(void) {
    dice d = dice_of("arm", 4701);
    double worst = 0.0;
    for (unsigned c = 0; c < few_or_all(1, 4); c++) {
        const arm a = draw_arm(&d);
        char *text = text_of(&a);
        diags *errors = diags_new();
        derived made = {.model = model_parse("arm.whirl", text, strlen(text), errors)};
        TEST_ASSERT_NOT_NULL_MESSAGE(made.model, text);
        made.instance = instance_make(made.model->mechanisms[0], NULL, NULL, errors);
        made.equations = equations_derive(made.instance, errors);
        diags_flush(errors, stdout);
        TEST_ASSERT_NOT_NULL(made.equations);
        for (unsigned long k = 0; k < 5; k++) {
            state_values s = {.instance = made.instance};
            double torque[JOINTS];
            double size[JOINTS];
            double accel[JOINTS];
            for (int i = 0; i < JOINTS; i++) {
                for (int primes = 0; primes < 3; primes++) {
                    s.value[i][primes] = dice_between(&d, -3.0, 3.0);
                }
                accel[i] = s.value[i][2];
            }
            torques(&a, &s, torque, size);
            for (int i = 0; i < JOINTS; i++) {
                double of_terms;
                const double is = derived_rest(&made, &s, accel, i, &of_terms);
                worst = fmax(worst, fabs(is - torque[i]) / (1.0 + size[i] + of_terms));
            }
        }
        derived_free(&made);
        diags_free(errors);
        free(text);
    }
    printf("  off by at most %.2g of the terms\n", worst);
    TEST_ASSERT_TRUE(worst < 1e-13);
}

void suite_arm(void) { RUN_TEST(test_arms_of_six_joints_move_as_newton_and_euler_say); }
