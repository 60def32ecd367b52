/* test_contact_together.c: several contacts at one moment: what happens does not depend on the order of the file, an
 * impact never gives energy, and what is symmetric stays so. */
#include "command.h"
#include "contacts.h"
#include "derived.h"
#include "tangled.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

void suite_contact_together(void);

static long wanted_runs(long usual) {
    const char *wanted = getenv("WHIRL_TANGLED_RUNS");
    const long count = wanted != NULL ? strtol(wanted, NULL, 10) : 0;
    return count > 0 ? count : usual;
}

enum { STATES = 16, BALLS = 5 };

/* The state at the end, and how many of its steps had too many events. */
static int run(const tangle *of, double *state, uint64_t *overruns) {
    char text[4000];
    motion m;
    (void)tangled_text(of, text, sizeof text);
    motion_open_text(&m, text, IN_DOUBLE);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, contacts_steps(&m)));
    const int n = tangled_bodies(of->seed);
    for (int i = 0; i < n; i++) {
        char name[16];
        snprintf(name, sizeof name, "x%d", i + 1);
        state[i] = motion_value(&m, name);
        snprintf(name, sizeof name, "x%d'", i + 1);
        state[n + i] = motion_value(&m, name);
    }
    *overruns = contacts_overruns(&m);
    motion_close(&m);
    return 2 * n;
}

/* Bodies that touch and are thrown at each other, alone and with friction, loads, holds and a crossing: from any order
 * of the statements comes the same motion, but for rounding. A step with too many events has no such promise. */
static void test_the_order_of_the_file_does_not_matter(void) {
    const long runs = wanted_runs(130);
    int over = 0;
    double worst = 0.0;
    for (long i = 0; i < 2 * runs; i++) {
        const uint64_t seed = 1U + (uint64_t)(i / 2);
        double first[STATES] = {0.0};
        double other[STATES] = {0.0};
        uint64_t overruns[2];
        const tangle drawn = {seed, 0, i % 2 == 0, 1e-3, 0.3};
        const tangle shuffled = {seed, 1U + seed % 3U, i % 2 == 0, 1e-3, 0.3};
        const int n = run(&drawn, first, &overruns[0]);
        (void)run(&shuffled, other, &overruns[1]);
        if (overruns[0] + overruns[1] > 0) {
            over++;
            continue;
        }
        for (int k = 0; k < n; k++) {
            const double apart = fabs(first[k] - other[k]);
            if (!(apart <= 1e-9)) {
                printf("  seed %llu, %s: apart by %.1e\n", (unsigned long long)seed,
                       i % 2 == 0 ? "stops alone" : "all contacts", apart);
            }
            worst = fmax(worst, apart);
        }
    }
    printf("seeds 1 to %ld: apart by at most %.1e; %d with overruns\n", runs, worst, over);
    TEST_ASSERT_TRUE(worst <= 1e-9);
    TEST_ASSERT_TRUE(over <= runs / 5);
}

/* No stop, friction or hold ever gives energy, whatever happens together (but in a step that cannot hold all). */
static void test_no_contact_gives_energy(void) {
    const long runs = wanted_runs((long)few_or_all(usual_or(15, 5), 130));
    double worst = 0.0;
    for (long i = 0; i < 2 * runs; i++) {
        char text[4000];
        motion m;
        double total[256] = {0.0};
        double left[STATES] = {0.0};
        const tangle of = {1U + (uint64_t)(i / 2), 0, i % 2 == 0, 1e-3, 0.3};
        const double energy_J = tangled_text(&of, text, sizeof text);
        motion_open_text(&m, text, IN_DOUBLE);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, contacts_steps(&m)));
        m.kind->ledger(m.run, total, left);
        for (int k = 0; k < m.image->forced; k++) {
            const double gave_J = total[m.image->ledger.smooth + k * (1 + m.image->coordinates)];
            const double gave =
                contacts_overruns(&m) == 0 ? (gave_J - fabs(left[0])) / energy_J : 0.0;
            worst = fmax(worst, gave);
        }
        motion_close(&m);
    }
    printf("seeds 1 to %ld: a contact gave at most %.1e of the energy\n", runs, worst);
    TEST_ASSERT_TRUE(worst <= 1e-11);
}

/* Equal balls in a row, 10 cm each, that touch (gap 0) or nearly so; `speed` of each, m/s. */
static void open_cradle(motion *m, double restitution, const double *speed, stepping how) {
    char text[2000];
    size_t at = 0;
#define PUT(...) at += (size_t)snprintf(text + at, sizeof text - at, __VA_ARGS__)
    PUT("mechanism cradle\n");
    for (int i = 1; i <= BALLS; i++) {
        PUT("coordinate x%d [m]\n", i);
    }
    PUT("T = 1 [kg]*(x1'^2 + x2'^2 + x3'^2 + x4'^2 + x5'^2)/2\n");
    for (int i = 1; i < BALLS; i++) {
        PUT("stop x%d - x%d >= 0.125 [m] restitution %.17g\n", i + 1, i, restitution);
    }
    PUT("scene s {\n  step 1 [ms]\n  until 1 [s]\n");
    for (int i = 1; i <= BALLS; i++) {
        PUT("  start x%d = %.17g [m], x%d' = %.17g [m/s]\n", i, 0.125 * i, i, speed[i - 1]);
    }
    PUT("}\n");
#undef PUT
    motion_open_text(m, text, how);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(m, 10));
}

static void expect_speeds(const motion *m, const double *speed, double bound) {
    static const char *const names[BALLS] = {"x1'", "x2'", "x3'", "x4'", "x5'"};
    for (int i = 0; i < BALLS; i++) {
        const double got = motion_value(m, names[i]);
        printf(" %.9g", got);
        TEST_ASSERT_TRUE_MESSAGE(fabs(got - speed[i]) <= bound, names[i]);
    }
    printf("\n");
}

/* Newton's cradle: as many balls fly off as have come; a stop that is touched is hit in the next round of the moment.
 * Where two impacts of 2 and 1 m/s meet in the middle ball, both stops are hit at once: -4/3, 2/3 and 5/3 m/s.
 * Without restitution all that is touched goes on together. */
static void test_newtons_cradle(void) {
    static const struct {
        double restitution;
        double before[BALLS];
        double after[BALLS];
    } cases[] = {
        {1.0, {1, 0, 0, 0, 0}, {0, 0, 0, 0, 1}},
        {1.0, {1, 1, 0, 0, 0}, {0, 0, 0, 1, 1}},
        {1.0, {1, 0, 0, 0, -1}, {-1, 0, 0, 0, 1}},
        {1.0, {2, 0, 0, 0, -1}, {-4. / 3, 0, 0, 2. / 3, 5. / 3}},
        {0.0, {1, 0, 0, 0, 0}, {.2, .2, .2, .2, .2}},
        {0.0, {1, 0, 0, 0, -1}, {0, 0, 0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        motion m;
        open_cradle(&m, cases[i].restitution, cases[i].before, IN_DOUBLE);
        expect_speeds(&m, cases[i].after, 1e-12);
        motion_close(&m);
        open_cradle(&m, cases[i].restitution, cases[i].before, IN_FLOAT);
        expect_speeds(&m, cases[i].after, 1e-6);
        motion_close(&m);
    }
}

/* A ball falls into the corner of two planes that lean at 30 degrees to either side of x = 0 and touches both at once.
 * Each of its two normal speeds comes back times its own restitution: (n1, n2) v+ = -(e1 n1, e2 n2) v-. */
static void corner(double e1, double e2, bool swapped, stepping how, double bound) {
    static const char left[] = "stop x/2 + y*sqrt(3)/2 >= 0 [m] restitution %.17g\n";
    static const char right[] = "stop y*sqrt(3)/2 - x/2 >= 0 [m] restitution %.17g\n";
    char one[100];
    char two[100];
    char text[1000];
    motion m;
    snprintf(one, sizeof one, left, e1);
    snprintf(two, sizeof two, right, e2);
    snprintf(text, sizeof text,
             "mechanism corner\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
             "V = 0 [J]\n%s%sscene s {\n  start x = 0, y = 1 [m], y' = -1 [m/s]\n"
             "  step 1 [ms]\n  until 2 [s]\n}\n",
             swapped ? two : one, swapped ? one : two);
    motion_open_text(&m, text, how);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1010));
    /* n1 = (1/2, s), n2 = (-1/2, s), s = sqrt(3)/2; n v- = -s */
    const double s = sqrt(3.0) / 2.0;
    const double x_rate = s * (e1 - e2);
    const double y_rate = (e1 + e2) / 2.0;
    printf("  e = %g and %g: x' = %.15g, y' = %.15g\n", e1, e2, motion_value(&m, "x'"),
           motion_value(&m, "y'"));
    TEST_ASSERT_TRUE(fabs(motion_value(&m, "x'") - x_rate) <= bound);
    TEST_ASSERT_TRUE(fabs(motion_value(&m, "y'") - y_rate) <= bound);
    motion_close(&m);
}

static void test_a_corner_is_hit_at_once(void) {
    for (int i = 0; i < 2; i++) {
        corner(0.5, 0.5, i != 0, IN_DOUBLE, 1e-12);
        corner(0.25, 0.75, i != 0, IN_DOUBLE, 1e-12);
        corner(1.0, 1.0, i != 0, IN_FLOAT, 1e-6);
        corner(1.0, 0.0, i != 0, IN_DOUBLE, 1e-12);
    }
}

void suite_contact_together(void) {
    RUN_TEST(test_the_order_of_the_file_does_not_matter);
    RUN_TEST(test_no_contact_gives_energy);
    RUN_TEST(test_newtons_cradle);
    RUN_TEST(test_a_corner_is_hit_at_once);
}
