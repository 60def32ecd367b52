/* test_hybrid_rest.c: bodies that come to rest together, pressed upon each other by nothing but their braking: what
 * static friction can keep stays at rest, whatever rounding leaves of forces and rates there. */
#include "contacts.h"
#include "derived.h"

#include <math.h>
#include <stdio.h>

#include "unity.h"

void suite_hybrid_rest(void);

static const engine_kind *const KINDS[] = {&engine_double, &engine_float};

/* x brakes, y pushes it from behind through a straight or curved buffer; the push on one of them is less than that
 * one's static friction. With `both`, y rubs, too. */
static void write_wagons(uint64_t *seed, bool curved, bool both, char *text, size_t size) {
    const double mass[2] = {exp(random_between(seed, -1.0, 1.0)),
                            exp(random_between(seed, -1.0, 1.0))};
    const double bend = curved ? random_between(seed, 0.02, 0.3) : 0.0;
    const double slope = curved ? random_between(seed, 0.5, 1.0) : 1.0;
    const double speed = random_between(seed, 0.4, 2.0);
    const double normal = random_between(seed, 8.0, 40.0) * (mass[0] + mass[1]);
    const double mu = random_between(seed, 0.2, 0.5);
    const double ratio = random_bits(seed) % 3U != 0 ? random_between(seed, 0.5, 1.0) : 1.0;
    const double push = random_between(seed, -0.5, 0.5) * mu * ratio * normal;
    char second[160] = "";
    if (both) { /* gently: y goes on pushing */
        const double own = 0.05 * normal * slope * mass[1] / mass[0];
        snprintf(second, sizeof second, "friction y static %.17g kinetic %.17g normal %.17g [N]\n",
                 mu, mu * ratio, own);
    }
    snprintf(text, size,
             "mechanism wagons\ncoordinate x [m]\ncoordinate y [m]\n"
             "T = %.17g [kg]*x'^2/2 + %.17g [kg]*y'^2/2\nV = %.17g [N]*x\n"
             "stop y <= %.17g*x + %.17g [1/m]*x^2 restitution 0\n"
             "friction x static %.17g kinetic %.17g normal %.17g [N]\n%s"
             "scene s {\n  start x' = %.17g [m/s], y' = %.17g [m/s]\n  until 6 [s]\n}\n",
             mass[0], mass[1], push, slope, bend, mu, mu * ratio, normal, second, speed,
             slope * speed);
}

static void check_wagons(bool curved, bool both, const char *words) {
    static const double steps_s[] = {5e-3, 2e-3, 1e-3, 0.5e-3};
    uint64_t seed = 31;
    for (int i = 0; i < 60; i++) {
        char text[1200];
        double rests[4];
        write_wagons(&seed, curved, both, text, sizeof text);
        for (int n = 0; n < 2; n++) {
            for (int k = 0; k < 4; k++) {
                motion m;
                motion_open_text(
                    &m, text, (stepping){.kind = KINDS[n], .method = WH_RK4, .step_s = steps_s[k]});
                motion_to(&m, 6.0);
                const double moves = fabs(motion_value(&m, "x'")) + fabs(motion_value(&m, "y'"));
                const uint64_t events = contacts_events(&m);
                rests[k] = motion_value(&m, "x");
                const double off = fabs(rests[k] - rests[0]);
                if (moves > 1e-9 || events > 6 || off > (n ? 1e-4 : 1e-6)) {
                    printf("%sh = %g s, %s: moves with %.2e m/s, %llu events, off by %.1e m\n",
                           text, steps_s[k], KINDS[n]->name, moves, (unsigned long long)events,
                           off);
                }
                TEST_ASSERT_TRUE_MESSAGE(moves <= 1e-9 && events <= 6 && off <= (n ? 1e-4 : 1e-6),
                                         words);
                TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, contacts_overruns(&m), words);
                motion_close(&m);
            }
        }
    }
}

static void test_wagons_with_a_straight_buffer(void) { check_wagons(false, false, "straight"); }
static void test_wagons_with_a_curved_buffer(void) { check_wagons(true, false, "curved"); }
static void test_wagons_that_both_brake(void) { check_wagons(true, true, "curved, both brake"); }

void suite_hybrid_rest(void) {
    RUN_TEST(test_wagons_with_a_straight_buffer);
    RUN_TEST(test_wagons_with_a_curved_buffer);
    RUN_TEST(test_wagons_that_both_brake);
}
