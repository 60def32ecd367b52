/* test_contact_rest.c: bodies that come to rest together, pressed upon each other by nothing but their braking: what
 * static friction can keep stays at rest, whatever rounding leaves of forces and rates there. */
#include "command.h"
#include "contacts.h"
#include "derived.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

void suite_contact_rest(void);

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
    const int pairs = (int)few_or_all(usual_or(4, 2), 60);
    for (int i = 0; i < pairs; i++) {
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

/* --- rows of wagons ---------------------------------------------------------------------------------------- */

/* Wagons with brakes and plastic buffers, in a row before a wall or without one, pushed by less than static friction
 * holds: they come to rest, in few events, in the same place for every step, and none beyond another. */
static void write_row(uint64_t *seed, int wagons, bool wall, char *text, size_t size) {
    int at = snprintf(text, size, "mechanism row\n");
    char T[400] = "0";
    char rest[1200] = "";
    char start[500] = "start ";
    double speed = random_between(seed, 0.5, 2.5);
    for (int i = 0; i < wagons; i++) {
        const double normal = 10.0 * (double)(1 + random_bits(seed) % 5U);
        const double mu = 0.05 * (double)(1 + random_bits(seed) % 6U);
        char more[300];
        at += snprintf(text + at, size - (size_t)at, "coordinate x%d [m]\n", i);
        snprintf(more, sizeof more, " + %d [kg]*x%d'^2/2", 1 + (int)(random_bits(seed) % 4U), i);
        strncat(T, more, sizeof T - strlen(T) - 1);
        snprintf(more, sizeof more, "friction x%d static %.17g kinetic %.17g normal %.17g [N]\n", i,
                 1.2 * mu, mu, normal);
        strncat(rest, more, sizeof rest - strlen(rest) - 1);
        if (i > 0) {
            snprintf(more, sizeof more, "stop x%d >= x%d restitution 0\n", i, i - 1);
            strncat(rest, more, sizeof rest - strlen(rest) - 1);
        } else {
            snprintf(more, sizeof more, "Q(x0) = %.17g [N]\n",
                     random_between(seed, 0.0, 0.9) * mu * normal);
            strncat(rest, more, sizeof rest - strlen(rest) - 1);
        }
        snprintf(more, sizeof more, "%sx%d = %.17g [m], x%d' = %.17g [m/s]", i > 0 ? ", " : "", i,
                 0.1 * i, i, speed);
        strncat(start, more, sizeof start - strlen(start) - 1);
        speed *= random_between(seed, 0.0, 1.0);
    }
    if (wall) {
        char more[100];
        snprintf(more, sizeof more, "stop %.17g [m] >= x%d restitution 0\n",
                 0.1 * (wagons - 1) + random_between(seed, 0.0, 0.2), wagons - 1);
        strncat(rest, more, sizeof rest - strlen(rest) - 1);
    }
    snprintf(text + at, size - (size_t)at, "T = 0 [J]*0%s\n%sscene s {\n  %s\n  until 30 [s]\n}\n",
             T + 1, rest, start);
}

static void test_rows_of_wagons(void) {
    uint64_t seed = 41;
    uint64_t most = 0;
    int overran = 0;
    int runs = 0;
    const int rows = (int)dice_cases(few_or_all(usual_or(3, 2), 18));
    for (int i = 0; i < rows; i++) {
        char text[3000];
        const int wagons = 2 + i % 3;
        double rests[8] = {0.0};
        write_row(&seed, wagons, i % 2 != 0, text, sizeof text);
        for (int n = 0; n < 4; n++) {
            static const double steps_s[] = {1e-3, 5e-3};
            motion m;
            motion_open_text(
                &m, text,
                (stepping){.kind = KINDS[n / 2], .method = WH_RK4, .step_s = steps_s[n % 2]});
            motion_to(&m, 30.0);
            const bool over = contacts_overruns(&m) > 0;
            bool good = contacts_events(&m) <= 60;
            overran += over;
            double before = -1.0;
            for (int k = 0; k < wagons; k++) {
                char name[16];
                snprintf(name, sizeof name, "x%d", k);
                const double x = motion_value(&m, name);
                good = good && x - before >= (n < 2 ? -1e-12 : -1e-6);
                before = x;
                rests[k] = n == 0 ? x : rests[k];
                good = good && fabs(x - rests[k]) < (over ? 1e-2 : 2e-3);
                snprintf(name, sizeof name, "x%d'", k);
                good = good && fabs(motion_value(&m, name)) < 1e-12;
            }
            runs++;
            most = contacts_events(&m) > most ? contacts_events(&m) : most;
            if (!good) {
                printf("%s%s, h = %g s: %llu events, %llu overruns; ends at", text,
                       KINDS[n / 2]->name, steps_s[n % 2], (unsigned long long)contacts_events(&m),
                       (unsigned long long)contacts_overruns(&m));
                for (int k = 0; k < wagons; k++) {
                    char name[16];
                    snprintf(name, sizeof name, "x%d", k);
                    printf(" %.12g (%.12g)", motion_value(&m, name), rests[k]);
                }
                puts("");
            }
            TEST_ASSERT_TRUE(good);
            motion_close(&m);
        }
    }
    printf("  at most %llu events; %d of %d runs overran\n", (unsigned long long)most, overran,
           runs);
    TEST_ASSERT_TRUE(overran <= runs / 20);
}

/* --- a force elsewhere ------------------------------------------------------------------------------------------ */

/* A small body that a growing force pulls off, or along, beside a large force on another that has nothing to do with
 * it: neither number may mistake the one for the other's rounding. */
static void test_a_force_elsewhere_holds_nothing(void) {
    for (int i = 0; i < 8; i++) {
        char text[700];
        const int digits = 2 + i / 2;
        const double large = pow(10.0, digits);
        snprintf(text, sizeof text,
                 "mechanism beside\ncoordinate y [m]\ncoordinate z [m]\ncoordinate c [rad]\n"
                 "T = 0.5 [kg]*y'^2/2 + 2 [kg]*z'^2/2 + 1e6 [kg*m^2]*c'^2/2\n"
                 "Q(y) = %s\nQ(z) = -%.17g [N]\nstop z >= 0 [m] restitution 0\n%s"
                 "scene s {\n  start c' = 0.1 [rad/s]\n  until 6 [s]\n}\n",
                 i % 2 ? "2 [N]*sin(c)" : "2 [N]*sin(c) - 0.5 [N]", large,
                 i % 2 ? "friction y static 0.5 kinetic 0.5 normal 1 [N]\n"
                       : "stop y >= 0 [m] restitution 0\n");
        for (int n = 0; n < 2; n++) {
            motion m;
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            motion_to(&m, 6.0);
            /* from sin(0.1 t0) = 1/4: m y'' = 2 (sin(0.1 t) - 1/4) */
            const double c0 = asin(0.25);
            const double c1 = 0.6;
            const double y =
                4.0 * 100.0 *
                (-sin(c1) + sin(c0) + cos(c0) * (c1 - c0) - 0.25 * (c1 - c0) * (c1 - c0) / 2.0);
            expect_between("y over the closed form", n ? 0.999 : 1.0 - 1e-9, n ? 1.001 : 1.0 + 1e-9,
                           motion_value(&m, "y") / y);
            motion_close(&m);
        }
    }
}

void suite_contact_rest(void) {
    RUN_TEST(test_rows_of_wagons);
    RUN_TEST(test_a_force_elsewhere_holds_nothing);
    RUN_TEST(test_wagons_with_a_straight_buffer);
    RUN_TEST(test_wagons_with_a_curved_buffer);
    RUN_TEST(test_wagons_that_both_brake);
}
