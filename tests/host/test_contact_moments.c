/* test_contact_moments.c: events that come thick: hops shorter than a step, and impacts that an impact of the same
 * moment causes. */
#include "contacts.h"
#include "derived.h"

#include <math.h>
#include <stdio.h>

#include "unity.h"

void suite_contact_moments(void);

static const engine_kind *const KINDS[] = {&engine_double, &engine_float};

/* --- hops shorter than a step -------------------------------------------------------------------------------- */

/* A ball, or one on a spring, that bounces for ever with hops of `share` of a step: every hop must be counted, and
 * its energy kept. On a floor at 0: a higher one has no digits left for hops of 1e-7 m in float. */
static void hop(double share, double mass, double gravity, const engine_kind *kind) {
    char text[600];
    motion m;
    double total[16] = {0.0};
    double left[4] = {0.0};
    const double h = 1e-3;
    const double speed = 0.5 * gravity * share * h;
    snprintf(
        text, sizeof text,
        "mechanism ball\ncoordinate y [m]\nT = %.17g [kg]*y'^2/2\nV = %.17g [N]*y\n"
        "stop y >= 0 restitution 1\n"
        "scene s {\n  with ledger\n  start y' = %.17g [m/s]\n  step 1 [ms]\n  until 5 [s]\n}\n",
        mass, mass * gravity, speed);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, 5.0);
    const double hops = 5.0 / (share * h);
    const bool fine = kind == &engine_double;
    expect_between("impacts less hops", fine ? -1.5 : -1e-3 * hops, fine ? 1.0 : 1e-3 * hops,
                   (double)contacts_events(&m) - hops);
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    m.kind->ledger(m.run, total, left);
    const double energy = 0.5 * mass * speed * speed;
    expect_between("left over, of the energy", fine ? -1e-11 : -2e-3, fine ? 1e-11 : 2e-3,
                   left[0] / energy);
    motion_close(&m);
}

static void test_hops_shorter_than_a_step(void) {
    uint64_t seed = 5;
    for (int i = 0; i < 12; i++) {
        const double share = random_between(&seed, 0.145, 1.2);
        const double mass = exp(random_between(&seed, -3.0, 3.0));
        const double gravity = exp(random_between(&seed, 0.0, 4.0));
        printf("  hops of %.3f h, %.3f kg, %.3f m/s2\n", share, mass, gravity);
        hop(share, mass, gravity, KINDS[i % 2]);
    }
}

/* What the last hop leaves of the gap is closed, and booked: from a bounce with restitution to rest nothing is left
 * over, beside the energy that is still there then. */
static void test_the_last_gap_is_booked(void) {
    uint64_t seed = 6;
    for (int i = 0; i < 20; i++) {
        char text[600];
        motion m;
        double total[16] = {0.0};
        double left[4] = {0.0};
        const double slope = i % 2 ? random_between(&seed, -0.8, 0.8) : 0.0;
        snprintf(text, sizeof text,
                 "mechanism ball\ncoordinate y [m]\ncoordinate x [m]\nT = 1 [kg]*(y'^2 + x'^2)/2\n"
                 "V = 9.81 [N]*y\nstop y + %.17g*x >= 0 restitution %.17g\n"
                 "scene s {\n  with ledger\n  start y = %.17g [m], x' = %.17g [m/s]\n"
                 "  step %.17g [ms]\n  until 2 [s]\n}\n",
                 slope, random_between(&seed, 0.1, 0.6), random_between(&seed, 1e-4, 0.3),
                 random_between(&seed, -1.0, 1.0), random_between(&seed, 0.3, 8.0));
        motion_open_text(&m, text, IN_DOUBLE);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, contacts_steps(&m)));
        m.kind->ledger(m.run, total, left);
        expect_between("left over, J, of up to 100", -1e-11, 1e-11, left[0]);
        motion_close(&m);
    }
}

/* --- one impact makes another --------------------------------------------------------------------------------- */

enum { BODIES = 4 };

typedef struct chain {
    double mass[BODIES], speed[BODIES], restitution;
    int order[BODIES - 1]; /* in which its stops are declared */
} chain;

/* Bodies that touch, pair after pair until none closes. Returns how often; *first_Ns is what the first body got. */
static int collide(chain *c, double *first_Ns) {
    int count = 0;
    bool again = true;
    *first_Ns = 0.0;
    while (again && count < 50) {
        again = false;
        for (int i = 0; i + 1 < BODIES; i++) {
            const double closing = c->speed[i] - c->speed[i + 1];
            if (closing > 1e-12) {
                const double impulse =
                    (1.0 + c->restitution) * closing / (1.0 / c->mass[i] + 1.0 / c->mass[i + 1]);
                c->speed[i] -= impulse / c->mass[i];
                c->speed[i + 1] += impulse / c->mass[i + 1];
                *first_Ns += i == 0 ? impulse : 0.0;
                again = true;
                count++;
            }
        }
    }
    return count;
}

/* They touch when the clock passes 0.3 ms, in the middle of a step, or at the start. The first flies into the
 * others, which are about to part: no stop rests. */
static void write_chain(const chain *c, bool at_start, char *text, size_t size) {
    const char *const name = "abcd";
    int at =
        snprintf(text, size,
                 "mechanism row\ncoordinate a [m]\ncoordinate b [m]\ncoordinate c [m]\n"
                 "coordinate d [m]\ncoordinate clock [rad]\n"
                 "T = (%.17g [kg]*a'^2 + %.17g [kg]*b'^2 + %.17g [kg]*c'^2 + %.17g [kg]*d'^2)/2"
                 " + 1 [kg*m^2]*clock'^2/2\n",
                 c->mass[0], c->mass[1], c->mass[2], c->mass[3]);
    for (int i = 0; i + 1 < BODIES; i++) {
        const int k = c->order[i];
        at += snprintf(text + at, size - (size_t)at, "stop %c - %c >= 0.25 [m] restitution %.17g\n",
                       name[k + 1], name[k], c->restitution);
    }
    if (at_start) {
        snprintf(text + at, size - (size_t)at,
                 "scene s {\n  start b = 0.25 [m], c = 0.5 [m], d = 0.75 [m], a' = %.17g [m/s]\n"
                 "  start b' = %.17g [m/s], c' = %.17g [m/s], d' = %.17g [m/s]\n"
                 "  step 1 [ms]\n  until 1 [s]\n}\n",
                 c->speed[0], c->speed[1], c->speed[2], c->speed[3]);
    } else {
        snprintf(
            text + at, size - (size_t)at,
            "scene s {\n  start a = -1 [m], b = 0.25 [m], c = 0.5 [m], d = 0.75 [m], clock' = 1 "
            "[rad/s]\n  when clock crosses 0.0003 rising { set a = 0, b = 0.25 [m], c = 0.5 [m], "
            "d = 0.75 [m], a' = %.17g [m/s], b' = %.17g [m/s], c' = %.17g [m/s], d' = %.17g [m/s] }\n"
            "  step 1 [ms]\n  until 1 [s]\n}\n",
            c->speed[0], c->speed[1], c->speed[2], c->speed[3]);
    }
}

static void test_touching_bodies_pass_an_impact_on(void) {
    uint64_t seed = 7;
    int done = 0;
    int most = 0;
    double worst[2] = {0.0, 0.0};
    for (int i = 0; i < 200; i++) {
        chain c = {.restitution = random_bits(&seed) % 2U ? 1.0 : random_between(&seed, 0.3, 1.0)};
        for (int k = 0; k < BODIES; k++) {
            c.mass[k] = exp(random_between(&seed, -1.5, 1.5));
        }
        c.speed[0] = random_between(&seed, 0.5, 3.0);
        c.speed[1] = random_between(&seed, -0.1, 0.1);
        c.speed[2] = c.speed[1] + random_between(&seed, 1e-3, 0.1);
        c.speed[3] = c.speed[2] + random_between(&seed, 1e-3, 0.1);
        const int first = (int)(random_bits(&seed) % 3U);
        const int step = 1 + (int)(random_bits(&seed) % 2U);
        for (int k = 0; k + 1 < BODIES; k++) {
            c.order[k] = (first + step * k) % 3;
        }
        chain after = c;
        double first_Ns;
        const int impacts = collide(&after, &first_Ns);
        if (impacts > 6) {
            continue; /* a step takes eight moments */
        }
        done++;
        most = impacts > most ? impacts : most;
        for (int n = 0; n < 2; n++) {
            char text[1500];
            motion m;
            write_chain(&c, i % 2 == 0, text, sizeof text);
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            motion_to(&m, 0.01);
            static const char *const rates[] = {"a'", "b'", "c'", "d'"};
            for (int k = 0; k < BODIES; k++) {
                const double off = fabs(motion_value(&m, rates[k]) - after.speed[k]);
                worst[n] = fmax(worst[n], off);
                if (off > (n ? 1e-5 : 1e-12)) {
                    printf("%s%s: %s off by %g\n", text, KINDS[n]->name, rates[k], off);
                }
            }
            motion_close(&m);
        }
    }
    printf("  %d rows, up to %d impacts at a moment: off by %.1e m/s, float %.1e\n", done, most,
           worst[0], worst[1]);
    TEST_ASSERT_TRUE(done > 100 && most > 3);
    TEST_ASSERT_TRUE(worst[0] < 1e-12 && worst[1] < 1e-5);
}

/* The lower body stands at the very floor, free, and is pulled off it so hard that, hit by the upper one, it is on its
 * way out again before the step ends: the floor is hit all the same. */
static void test_an_impact_that_is_over_within_the_step(void) {
    uint64_t seed = 8;
    for (int i = 0; i < 40; i++) {
        const double u = random_between(&seed, 0.2, 1.0);
        const double e = random_between(&seed, 0.2, 0.9);
        double mass[2] = {exp(random_between(&seed, -1.0, 1.0)), 0.0};
        mass[1] = random_between(&seed, 0.05, 0.3) * e *
                  mass[0]; /* it flies off, and does not come back */
        chain c = {{1e300, mass[0], mass[1], 1.0}, {0.0, 0.0, -u, 1e300}, e, {0}};
        double floor_Ns;
        if (collide(&c, &floor_Ns) > 6) {
            continue;
        }
        /* out of the floor within the step; but weak enough that the two fly apart for more than a rest */
        const double down = (1.0 + e) * u * mass[1] / (mass[0] + mass[1]);
        const double pull = random_between(&seed, 4.0, 10.0) * mass[0] * down / 1e-3;
        const char *const stops[] = {"stop low >= 0 restitution %.17g\n",
                                     "stop high - low >= 0.25 [m] restitution %.17g\n"};
        char text[900];
        int at = snprintf(text, sizeof text,
                          "mechanism pair\ncoordinate low [m]\ncoordinate high [m]\n"
                          "T = (%.17g [kg]*low'^2 + %.17g [kg]*high'^2)/2\nQ(low) = %.17g [N]\n",
                          mass[0], mass[1], pull);
        for (int k = 0; k < 2; k++) {
            at += snprintf(text + at, sizeof text - (size_t)at, stops[(k + i) % 2], e);
        }
        snprintf(text + at, sizeof text - (size_t)at,
                 "scene s {\n  with ledger\n  start high = 0.25 [m], high' = %.17g [m/s]\n"
                 "  step 1 [ms]\n  until 1 [s]\n}\n",
                 -u);
        for (int n = 0; n < 2; n++) {
            double total[32] = {0.0};
            double left[8] = {0.0};
            motion m;
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            m.kind->ledger(m.run, total, left);
            double booked = 0.0;
            for (int k = 0; k < 32; k++) {
                booked = fabs(total[k] - floor_Ns) < fabs(booked - floor_Ns) ? total[k] : booked;
            }
            expect_between("floor's impulse over what it must be", n ? 0.9999 : 1.0 - 1e-9,
                           n ? 1.0001 : 1.0 + 1e-9, booked / floor_Ns);
            motion_close(&m);
        }
    }
}

void suite_contact_moments(void) {
    RUN_TEST(test_hops_shorter_than_a_step);
    RUN_TEST(test_the_last_gap_is_booked);
    RUN_TEST(test_touching_bodies_pass_an_impact_on);
    RUN_TEST(test_an_impact_that_is_over_within_the_step);
}
