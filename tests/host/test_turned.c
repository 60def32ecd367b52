/* test_turned.c: which scenes turn their sines, and that turning them moves like looking them up: over generated
 * mechanisms, and for every built-in scene. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/image/turned.h"
#include "host/run/engine.h"
#include "motion.h"

#include "unity.h"

void suite_turned(void);

/* A pendulum that starts with so much of a half step's turn, its sine's argument as often; its step is 1 ms. */
static bool turns_at(double half_step_rad, int times, const char *more, image_settings settings) {
    char text[600];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\n"
             "T = 1 [kg*m^2]*a'^2/2 + 1 [kg*m^2]*b'^2/2 + 1 [kg]*x'^2/2\nV = 1 [J]*cos(%d*a)%s\n"
             "scene s { start a' = %.17g [rad/s], b' = 3000 [rad/s]; step 1 [ms]; until 1 [s] }\n",
             times, more, half_step_rad / 0.5e-3 / times);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    d.image->settings = settings;
    const bool turns = image_turns(d.image);
    derived_free(&d);
    return turns;
}

static void test_the_start_chooses(void) {
    const image_settings rk38 = {WH_RK38, false, ANGLES_TURNED};
    const image_settings lookup = {WH_RK4, false, ANGLES_LOOKUP};
    const image_settings euler = {WH_EULER, false, ANGLES_TURNED};
    for (int times = 1; times <= 7; times += 3) {
        TEST_ASSERT_TRUE(turns_at(0.24, times, "", plainly));
        TEST_ASSERT_TRUE(turns_at(-0.24, times, "", plainly));
        TEST_ASSERT_FALSE(turns_at(0.26, times, "", plainly));
        TEST_ASSERT_FALSE(turns_at(-0.26, times, "", plainly));
        TEST_ASSERT_TRUE(turns_at(0.36, times, "", rk38)); /* whose first turn is of a third */
        TEST_ASSERT_FALSE(turns_at(0.39, times, "", rk38));
        TEST_ASSERT_FALSE(turns_at(0.01, times, "", lookup));
        TEST_ASSERT_TRUE(turns_at(1.0, times, "", euler)); /* which has no stage to turn to */
    }
    /* what is in no sine counts for nothing: b does not, but here */
    TEST_ASSERT_FALSE(turns_at(0.01, 1, " + 1 [J]*cos(b)", plainly));
    /* a sine of an angle and a length is no sum of angles, and is looked up */
    TEST_ASSERT_TRUE(turns_at(0.01, 1, " + 0.01 [N/m]*x^2", plainly));
    TEST_ASSERT_FALSE(turns_at(0.01, 1, " + 0.01 [J]*cos(a + x/(1 [m]))", plainly));
}

/* --- both forms move alike --------------------------------------------------------------------------- */

enum { VALUES = 3 * IMAGE_COMPONENTS_MAX };

/* The state after `steps`; 0 when a step is refused. */
static int after(image *im, const engine_kind *kind, image_angles angles, uint64_t steps,
                 double value[VALUES]) {
    im->settings.angles = angles;
    void *run = kind->start(im);
    wh_status status = WH_OK;
    while (status == WH_OK && steps-- > 0) {
        status = kind->step(run);
    }
    kind->state(run, value, value + im->angles);
    kind->stop(run);
    return status == WH_OK ? im->angles + im->reals : 0;
}

/* The same for a step that is `parts` times shorter. */
static int after_parts(image *im, const engine_kind *kind, image_angles angles, uint64_t steps,
                       int parts, double value[VALUES]) {
    const double step_s = im->step_s;
    im->step_s = step_s / parts;
    const int count = after(im, kind, angles, steps * (uint64_t)parts, value);
    im->step_s = step_s;
    return count;
}

static double distance(int count, const double *x, const double *y) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum = hypot(sum, x[i] - y[i]);
    }
    return sum;
}

/* What both forms are apart, over the error of the one that looks up; -1: one of them is refused, or both are exact. */
static double apart(image *im) {
    double turned[VALUES];
    double looked_up[VALUES];
    double fine[VALUES];
    const uint64_t steps = 32;
    double size = 1.0;
    const int count = after(im, &engine_double, ANGLES_TURNED, steps, turned);
    if (count == 0 || after(im, &engine_double, ANGLES_LOOKUP, steps, looked_up) == 0 ||
        after_parts(im, &engine_double, ANGLES_LOOKUP, steps, 16, fine) == 0) {
        return -1.0;
    }
    for (int i = 0; i < count; i++) {
        size = fmax(size, fabs(fine[i]));
    }
    const double error = distance(count, looked_up, fine);
    return error > 1e-11 * size ? distance(count, turned, looked_up) / error : -1.0;
}

/* A scene `s` whose angles stand in sines only: pendulums and masses that carry each other, swung by sums, differences
 * and multiples of angles; every third a system of equations of first and second order. */
static void write_mechanism(unsigned number, uint64_t *seed, char *text, size_t size) {
    const int angles = 1 + (int)(random_bits(seed) % 3);
    const int lengths = (int)(random_bits(seed) % 2);
    const bool system = number % 3 == 2;
    FILE *out = fmemopen(text, size, "w");
    TEST_ASSERT_NOT_NULL(out);
    fprintf(out, "mechanism m\n");
    for (int i = 0; i < angles + lengths; i++) {
        fprintf(out, "%s q%d [%s]\n", system ? "state" : "coordinate", i, i < angles ? "rad" : "m");
    }
    fprintf(out, "input u = %.3f\n", random_between(seed, -1.0, 1.0));
    fputs(system ? "" : "effect e {\n", out);
    for (int i = 0; i < angles + lengths; i++) {
        const int j = (int)(random_bits(seed) % (uint64_t)angles);
        const int k = (int)(random_bits(seed) % (uint64_t)angles);
        const char *si = i < angles ? "" : "*1 [m]";
        char wave[80];
        snprintf(wave, sizeof wave, "sin(%d*q%d %+d*q%d + %.2f)", 1 + (int)(random_bits(seed) % 3),
                 j, (int)(random_bits(seed) % 5) - 2, k, random_between(seed, -3.0, 3.0));
        if (system && (random_bits(seed) & 1U) != 0) {
            fprintf(out, "equation q%d' = (%.3f + %.3f*%s*u)%s/(1 [s])\n", i,
                    random_between(seed, -1.0, 1.0), random_between(seed, -3.0, 3.0), wave, si);
        } else if (system) {
            fprintf(out, "equation q%d'' = (%.3f*%s - 0.2 [s]*q%d')%s/(1 [s^2])\n", i,
                    random_between(seed, -9.0, 9.0), wave, j, si);
        } else if (i < angles) {
            fprintf(out, "T += %.3f [kg*m^2]*q%d'^2/2 + 0.1 [kg*m^2]*cos(q%d - q%d)*q%d'*q%d'\n",
                    random_between(seed, 1.0, 2.0), i, i, j, i, j);
            fprintf(out,
                    "V += %.3f [J]*%s\nF += 0.05 [N*m*s]*q%d'^2/2\nQ(q%d) += u*1 [N*m]*cos(q%d)\n",
                    random_between(seed, -9.0, 9.0), wave, i, i, k);
        } else {
            fprintf(out,
                    "T += %.3f [kg]*q%d'^2/2 + 0.1 [kg*m]*cos(q%d)*q%d'*q%d'\nV += 5 [N/m]*q%d^2\n",
                    random_between(seed, 1.0, 2.0), i, j, i, j, i);
        }
    }
    fputs(system ? "scene s {\n" : "}\nscene s {\nwith e\n", out);
    for (int i = 0; i < angles + lengths; i++) {
        fprintf(out, "start q%d = %.3f%s\n", i, random_between(seed, -3.0, 3.0),
                i < angles ? "" : " [m]");
        if (!system) {
            fprintf(out, "start q%d' = %.3f [%s/s]\n", i, random_between(seed, -3.0, 3.0),
                    i < angles ? "rad" : "m");
        }
    }
    fprintf(out, "step 10 [ms]; until 1 [s] }\n");
    fclose(out);
}

static void test_generated_mechanisms_move_alike(void) {
    const char *asked = getenv("WHIRL_CASES");
    const unsigned cases = asked != NULL ? (unsigned)atoi(asked) : 200;
    uint64_t seed = 20261122;
    char text[4096];
    unsigned compared = 0;
    double worst = 0.0;
    for (unsigned n = 0; n < cases; n++) {
        write_mechanism(n, &seed, text, sizeof text);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        TEST_ASSERT_TRUE_MESSAGE(image_turns(d.image) || d.image->angles == 0, text);
        const double off = apart(d.image);
        compared += off >= 0.0;
        worst = fmax(worst, off);
        derived_free(&d);
    }
    printf("  seed 20261122: %u of %u mechanisms compared: apart by at most %.2g of the error\n",
           compared, cases, worst);
    TEST_ASSERT_TRUE(compared > cases / 2);
    TEST_ASSERT_TRUE(worst < 0.02);
}

/* --- what is refused --------------------------------------------------------------------------------- */

/* A wheel that is driven until it is too fast: refused at the bound, taken on by looking up. */
static void test_a_wheel_that_becomes_too_fast_is_refused_at_its_bound(void) {
    static const char text[] = "mechanism m\ncoordinate b [rad]\ncoordinate a [rad]\n"
                               "T = 1 [kg*m^2]*(a'^2 + b'^2)/2\nV = 0.001 [J]*cos(a)\n"
                               "Q(a) = 1 [kN*m]\nscene s { start b' = 2900 [rad/s]; step 1 [ms]; "
                               "until 2 [s] }\n";
    for (int k = 0; k < 2; k++) {
        motion m;
        stepping how = k == 0 ? IN_DOUBLE : IN_FLOAT;
        motion_open_text(&m, text, how);
        TEST_ASSERT_EQUAL_INT(WH_E_TURN, motion_step(&m, 2000));
        TEST_ASSERT_DOUBLE_WITHIN(1.5, 1000.0, motion_value(&m, "a'"));
        TEST_ASSERT_EQUAL_STRING(
            "a", m.image->unknown[m.image->angle[m.kind->fault(m.run)].unknown].name);
        motion_close(&m);
        how.angles = ANGLES_LOOKUP;
        motion_open_text(&m, text, how);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 2000));
        motion_close(&m);
    }
}

void suite_turned(void) {
    RUN_TEST(test_the_start_chooses);
    RUN_TEST(test_generated_mechanisms_move_alike);
    RUN_TEST(test_a_wheel_that_becomes_too_fast_is_refused_at_its_bound);
}
