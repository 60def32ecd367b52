/* test_turned.c: which scenes rotate their sines, and whether rotation and lookup agree, for generated mechanisms
 * and every built-in scene. */
#include "test.h"

#include "core/step/stage_turn.h"

#include "command.h"
#include "derived.h"
#include "host/engine/engine.h"
#include "host/image/image.h"
#include "motion.h"

static bool turns(const char *more, const char *start, image_settings settings) {
    char text[600];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\n"
             "T = 1 [kg*m^2]*a'^2/2 + 1 [kg*m^2]*b'^2/2 + 1 [kg]*x'^2/2\nV = 1 [J]*cos(3*a)%s\n"
             "scene s { start %s; step 1 [ms]; until 1 [s] }\n",
             more, start);
    derived d = derived_surely(derived_scene(text, "s"), text);
    d.image->settings = settings;
    const bool turned = image_turns(d.image);
    derived_free(&d);
    return turned;
}

TEST(turned, settings_and_lists_choose) {
    for (int m = 0; m < WH_METHODS; m++) {
        const image_settings turned = {.method = (wh_method)m, .angles = ANGLES_TURNED};
        const image_settings lookup = {.method = (wh_method)m, .angles = ANGLES_LOOKUP};
        TEST_ASSERT_TRUE(turns("", "a = 1", turned) == wh_method_turns((wh_method)m));
        TEST_ASSERT_FALSE(turns("", "a = 1", lookup));
        TEST_ASSERT_TRUE(turns("", "a' = 3000 [rad/s]", turned) ==
                         wh_method_turns((wh_method)m)); /* some methods rotate at any speed */
    }
    /* a sine of an angle plus a length is looked up, because its argument is not a sum of angles */
    TEST_ASSERT_TRUE(turns(" + 0.01 [N/m]*x^2", "a = 1", plainly));
    TEST_ASSERT_FALSE(turns(" + 0.01 [J]*cos(a + x/(1 [m]))", "a = 1", plainly));
}

enum { VALUES = 3 * IMAGE_COMPONENTS_MAX };

/* Computes the state after `steps` steps. Returns the number of values, 0 if a step is refused. */
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

/* Difference between rotation and lookup, relative to the error of lookup. -1: lookup is refused, or both are exact. */
static double apart(image *im, const char *text) {
    double turned[VALUES];
    double looked_up[VALUES];
    double fine[VALUES];
    const uint64_t steps = 32;
    double size = 1.0;
    const int count = after(im, &engine_double, ANGLES_LOOKUP, steps, looked_up);
    if (count == 0 || after_parts(im, &engine_double, ANGLES_LOOKUP, steps, 16, fine) == 0) {
        return -1.0;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(count, after(im, &engine_double, ANGLES_TURNED, steps, turned),
                                  text);
    for (int i = 0; i < count; i++) {
        size = fmax(size, fabs(fine[i]));
    }
    const double error = distance(count, looked_up, fine);
    return error > 1e-11 * size ? distance(count, turned, looked_up) / error : -1.0;
}

/* Writes a scene `s` with angles only in sines: coupled pendulums and masses, with sums, differences and multiples
 * of angles. Every third scene is a system of equations of first and second order. Drives reach `drive` rad/s^2,
 * initial rates `speed` rad/s. */
static void write_mechanism(unsigned number, double drive, double speed, uint64_t *seed, char *text,
                            size_t size) {
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
                    random_between(seed, -speed, speed), random_between(seed, -3.0, 3.0), wave, si);
        } else if (system) {
            fprintf(out, "equation q%d'' = (%.3f + %.3f*%s - 0.2 [s]*q%d')%s/(1 [s^2])\n", i,
                    random_between(seed, -drive, drive), random_between(seed, -9.0, 9.0), wave, j,
                    si);
        } else if (i < angles) {
            fprintf(out, "T += %.3f [kg*m^2]*q%d'^2/2 + 0.1 [kg*m^2]*cos(q%d - q%d)*q%d'*q%d'\n",
                    random_between(seed, 1.0, 2.0), i, i, j, i, j);
            fprintf(out,
                    "V += %.3f [J]*%s\nF += 0.05 [N*m*s]*q%d'^2/2\n"
                    "Q(q%d) += u*1 [N*m]*cos(q%d) + %.3f [N*m]\n",
                    random_between(seed, -9.0, 9.0), wave, i, i, k,
                    random_between(seed, -drive, drive));
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
            fprintf(out, "start q%d' = %.3f [%s/s]\n", i,
                    random_between(seed, -1.0, 1.0) * (i < angles ? speed : 3.0),
                    i < angles ? "rad" : "m");
        }
    }
    fprintf(out, "step 10 [ms]; until 1 [s] }\n");
    fclose(out);
}

/* The share of mechanisms in which rotation and lookup differ by more than `within` times the error of lookup. */
static double share_apart(double within, double drive, double speed) {
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 24), 200));
    uint64_t seed = 20261122;
    char text[4096];
    unsigned compared = 0;
    unsigned beyond = 0;
    double worst = 0.0;
    for (unsigned n = 0; n < cases; n++) {
        write_mechanism(n, drive, speed, &seed, text, sizeof text);
        derived d = derived_surely(derived_scene(text, "s"), text);
        TEST_ASSERT_TRUE_MESSAGE(image_turns(d.image) || d.image->angles == 0, text);
        const double off = apart(d.image, text);
        compared += off >= 0.0;
        beyond += off > within;
        worst = fmax(worst, off);
        derived_free(&d);
    }
    printf(
        "  seed 20261122, up to %g rad/s: %u of %u mechanisms compared: apart by at most %.2g of the "
        "error, %u by more than %g\n",
        speed, compared, cases, worst, beyond, within);
    TEST_ASSERT_TRUE(compared > cases / 2);
    return beyond / (double)cases;
}

TEST(turned, generated_mechanisms_move_alike) {
    TEST_ASSERT_TRUE(share_apart(0.02, 0.1, 3.0) == 0.0);
}

/* Rates that exceed the limit of small rotations (up to 100 rad/s here) at the start or later. If lookup runs,
 * rotation must run, too. Both have large errors, because the steps do not resolve the motion. */
TEST(turned, fast_generated_mechanisms_go_on) {
    TEST_ASSERT_TRUE(share_apart(0.45, 300.0, 250.0) < 0.1);
}

/* Systems of first order whose rates depend strongly on the angles, near the limit of stability. The slopes at the
 * stages differ much from the slope at the begin, and after half a turn the system moves to another equilibrium. */
TEST(turned, stiff_angles_of_first_order_move_alike) {
    const unsigned cases = dice_cases(few_or_all(usual_or(100, 40), 300));
    uint64_t seed = 20261122;
    char text[400];
    unsigned compared = 0;
    double worst = 0.0;
    for (unsigned n = 0; n < cases; n++) {
        const int multiple = 1 + (int)(random_bits(&seed) % 5);
        const double reach = random_between(&seed, 0.3, 2.5) / (1e-3 * multiple);
        snprintf(text, sizeof text,
                 "mechanism m\nstate a [rad]\nequation a' = %.3f [1/s] + (%.3f [1/s])*sin(%d*a)\n"
                 "scene s {\nstart a = %.3f\nstep 1 [ms]; until 0.05 [s] }\n",
                 random_between(&seed, -1600.0, 1600.0), reach, multiple,
                 random_between(&seed, -3.0, 3.0));
        derived d = derived_surely(derived_scene(text, "s"), text);
        double value[2][VALUES];
        const int looked_up = after(d.image, &engine_double, ANGLES_LOOKUP, 50, value[0]);
        const int turned = after(d.image, &engine_double, ANGLES_TURNED, 50, value[1]);
        if (looked_up > 0) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(looked_up, turned, text);
            worst = fmax(worst, distance(looked_up, value[0], value[1]));
            compared++;
        }
        derived_free(&d);
    }
    printf("  seed 20261122, %u of %u stiff systems: apart by at most %.2g rad\n", compared, cases,
           worst);
    TEST_ASSERT_TRUE(compared > cases / 2);
    TEST_ASSERT_TRUE(worst < 1e-4);
}
