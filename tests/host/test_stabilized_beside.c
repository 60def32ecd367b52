/* test_stabilized_beside.c: what --stabilized does to what is slow beside a swing: a wheel or a cart that goes on by itself with
 * a small part of the energy, which the swing loses to its step. By the closed form of what a step loses, (h w)^6/72 of a swing's
 * energy with Runge-Kutta 4, all rates are to get the same part; were more given where the swing turns back, the slow one, which
 * moves there alone, would get most of it. */
#include <math.h>
#include <stdio.h>

#include "command.h"
#include "motion.h"

#include "unity.h"

void suite_stabilized_beside(void);

typedef struct beside {
    double step_s;
    double angular_radps; /* of the swing */
    double slow;          /* its rate, in parts of the swing's fastest */
    double start_m;
    double start_mps;
    bool is_angle; /* the slow one */
} beside;

static beside drawn(dice *d) {
    beside b = {.step_s = pow(10.0, dice_between(d, -4.0, -1.0)),
                .slow = pow(10.0, dice_between(d, -4.0, -1.0)),
                .start_m = dice_between(d, 0.2, 1.0),
                .is_angle = dice_one_of(d, 2) == 0};
    b.angular_radps = dice_between(d, 0.06, 0.1) / b.step_s;
    b.start_mps = dice_between(d, -1.0, 1.0) * b.angular_radps * b.start_m;
    return b;
}

static double amplitude_m(const beside *b) {
    const double other_m = b->start_mps / b->angular_radps;
    return sqrt(b->start_m * b->start_m + other_m * other_m);
}

/* Largest part by which the slow rate has changed. */
static double slow_off(const beside *b, stepping how, uint64_t steps) {
    char text[900];
    motion m;
    const double slow = b->slow * b->angular_radps * amplitude_m(b);
    snprintf(text, sizeof text,
             "mechanism beside\ncoordinate x [m]\ncoordinate y [%s]\n"
             "T = 1 [kg]*x'^2/2 + 1 [%s]*y'^2/2\nV = %.17g [N/m]*x^2/2\n"
             "scene s { start x = %.17g [m], x' = %.17g [m/s], y' = %.17g [%s]\n"
             "step %.17g [s]\nuntil 1e9 [s] }\n",
             b->is_angle ? "rad" : "m", b->is_angle ? "kg*m^2" : "kg",
             b->angular_radps * b->angular_radps, b->start_m, b->start_mps, slow,
             b->is_angle ? "rad/s" : "m/s", b->step_s);
    how.step_s = b->step_s;
    how.stabilized = true;
    motion_open_text(&m, text, how);
    double most = 0.0;
    for (uint64_t k = 0; k < steps; k += 1000) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1000));
        most = fmax(most, fabs(motion_value(&m, "y'") / slow - 1.0));
    }
    motion_close(&m);
    return most;
}

static void test_what_is_slow_gets_its_part(void) {
    dice d = dice_of("stabilized beside", 20261204);
    const unsigned cases = usual_or(dice_cases(few_or_all(16, 100)), 4);
    const uint64_t steps = 200000;
    double least = (double)INFINITY;
    double most = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const beside b = drawn(&d);
        const bool is_float = i % 3 == 2;
        const double lost =
            (double)steps * pow(b.angular_radps * b.step_s, 6.0) / 72.0; /* of the swing's */
        const stepping how = {.kind = is_float ? &engine_float : &engine_double,
                              .method = WH_RK4,
                              .compensated = is_float};
        const double part = slow_off(&b, how, steps) / lost;
        char what[200];
        snprintf(what, sizeof what, "case %u, %s, slow %.2g: %.3g of the %.2e that is lost", i,
                 how.kind->name, b.slow, part, lost);
        TEST_ASSERT_TRUE_MESSAGE(part > 0.5 && part < 2.0, what);
        least = fmin(least, part);
        most = fmax(most, part);
    }
    printf("  %u pairs: the slow one's rate changes by %.2f to %.2f of the part that is lost\n",
           cases, least, most);
}

void suite_stabilized_beside(void) { RUN_TEST(test_what_is_slow_gets_its_part); }
