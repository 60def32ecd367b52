/* test_contact_start.c: what is pressed at the start of a run takes part in an impact of that very moment: a body that
 * touches a row at rest at t = 0 does what one does that meets it a little later, and counts as that. */
#include "command.h"
#include "contacts.h"
#include "derived.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scattered.h"
#include "unity.h"

void suite_contact_start(void);

enum { MOST = 5 };

/* Bodies in a row on a floor, one upon the other, which their weights or loads press or not, and the uppermost comes
 * down on them from `gap_m` above. The stops stand in any order. */
typedef struct row {
    uint64_t seed;
    double offset_m; /* of the places, so that gaps are known to rounding only */
    double gap_m;
} row;

static int row_text(const row *of, char *text, size_t size) {
    static const double restitutions[] = {0.0, 0.25, 0.5, 1.0};
    uint64_t seed = of->seed;
    const int n = 2 + (int)(random_bits(&seed) % (MOST - 1));
    const int turn = (int)(random_bits(&seed) % (uint64_t)n);
    const double common = restitutions[random_bits(&seed) % 4U];
    const bool same = random_bits(&seed) % 2U == 0;
    const bool heavy = random_bits(&seed) % 2U == 0;
    double restitution[MOST];
    size_t at = 0;
#define PUT(...) at += (size_t)snprintf(text + at, size - at, __VA_ARGS__)
    PUT("mechanism row\n");
    for (int i = 0; i < n; i++) {
        restitution[i] = same ? common : random_between(&seed, 0.0, 1.0);
        PUT("coordinate x%d [m]\n", i);
    }
    char energy[1000];
    size_t end = 0;
    for (int i = 0; i < n; i++) {
        const double m = random_bits(&seed) % 2U == 0 ? 1.0 : random_between(&seed, 0.3, 3.0);
        const double load = heavy ? 9.81 * m : random_between(&seed, -5.0, 10.0);
        PUT("%s %.17g [kg]*x%d'^2/2", i == 0 ? "T =" : " +", m, i);
        end += (size_t)snprintf(energy + end, sizeof energy - end, "%s %.17g [N]*x%d",
                                i == 0 ? "V =" : " +", load, i);
    }
    PUT("\n%s\n", energy);
    for (int j = 0; j < n; j++) {
        const int i = (j + turn) % n;
        if (i == 0) {
            PUT("stop x0 >= %.17g [m]", of->offset_m);
        } else {
            PUT("stop x%d - x%d >= %.17g [m]", i, i - 1, of->offset_m);
        }
        PUT(" restitution %.17g\n", restitution[i]);
    }
    PUT("scene s {\n  step 0.1 [ms]\n  until 1 [ms]\n");
    for (int i = 0; i < n; i++) {
        const bool last = i == n - 1;
        PUT("  start x%d = %.17g [m], x%d' = %g [m/s]\n", i,
            (i + 1) * of->offset_m + (last ? of->gap_m : 0.0), i, last ? -1.0 : 0.0);
    }
    PUT("}\n");
#undef PUT
    return n;
}

/* The rates after one step, and its events. Returns whether it had too many. */
static bool after_a_step(const row *of, double *rate, uint64_t *events) {
    char text[4000];
    motion m;
    const int n = row_text(of, text, sizeof text);
    motion_open_text(&m, text, IN_DOUBLE);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    for (int i = 0; i < n; i++) {
        char name[16];
        snprintf(name, sizeof name, "x%d'", i);
        rate[i] = motion_value(&m, name);
    }
    const bool overran = contacts_overruns(&m) > 0;
    *events = contacts_events(&m);
    motion_close(&m);
    return overran;
}

static void test_an_impact_at_the_start_is_as_one_just_after(void) {
    const char *wanted = getenv("WHIRL_START_ROWS");
    const long runs = wanted != NULL ? strtol(wanted, NULL, 10) : (long)usual_or(150, 50);
    double worst = 0.0;
    int over = 0;
    int bad = 0;
    for (long i = 1; i <= runs; i++) {
        for (int lifted = 0; lifted < 2; lifted++) {
            double now[MOST] = {0.0};
            double later[MOST] = {0.0};
            uint64_t events = 0;
            uint64_t events_later = 0;
            const row touching = {(uint64_t)i, lifted ? 0.1 : 0.0, 0.0};
            const row apart = {(uint64_t)i, lifted ? 0.1 : 0.0, 1e-9};
            const bool overran = after_a_step(&touching, now, &events);
            if (after_a_step(&apart, later, &events_later) || overran) {
                over++;
                continue;
            }
            double differs = 0.0;
            for (int k = 0; k < MOST; k++) {
                differs = fmax(differs, fabs(now[k] - later[k]));
            }
            if (!(differs <= 1e-6)) {
                printf("  seed %ld%s: rates differ by %.1e m/s\n", i, lifted ? ", lifted" : "",
                       differs);
                bad++;
            }
            if (events != events_later) {
                printf("  seed %ld%s: %d events, not %d\n", i, lifted ? ", lifted" : "",
                       (int)events, (int)events_later);
                bad++;
            }
            worst = fmax(worst, differs);
        }
    }
    printf("seeds 1 to %ld, twice: rates differ by at most %.1e m/s; %d differ, %d with overruns\n",
           runs, worst, bad, over);
    TEST_ASSERT_EQUAL_INT(0, bad);
    TEST_ASSERT_TRUE(over <= runs / 5);
}

/* What happens at t = 0 counts as it would later, in either number; what rests there, or is held, does not happen. */
static void test_what_happens_at_the_start_is_counted(void) {
    static const struct {
        const char *statement;
        const char *start;
        uint64_t events;
    } cases[] = {
        {"stop x >= 0 restitution 0.5", "x' = -2 [m/s]", 1},
        {"stop x >= 0 restitution 0", "x' = -2 [m/s]", 1},
        {"stop x >= 0 restitution 0.5", "x' = 2 [m/s]", 0},
        {"stop x >= 0 restitution 0.5", "x' = 0 [m/s]", 0},
        {"stop x >= 0 restitution 0.5\nstop x <= 0 restitution 0.5", "x' = 0 [m/s]", 0},
        {"stop x >= 0 restitution 0.5\nstop y >= 0 restitution 0.2", "x' = -1 [m/s], y' = -1 [m/s]",
         2},
        {"stop x >= 0 restitution 0.5\nstop y >= 0 restitution 0.2", "x' = -1 [m/s]", 1},
        {"hold x while y > -1 [m]", "x' = 2 [m/s]", 1},
        {"hold x while y > -1 [m]", "x' = 0 [m/s]", 0},
        {"friction x static 0.3 kinetic 0.2 normal 9 [N]", "x' = 2 [m/s]", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int k = 0; k < 2; k++) {
            char text[800];
            motion m;
            snprintf(text, sizeof text,
                     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"
                     "T = 1 [kg]*(x'^2 + y'^2)/2\nV = 9.81 [N]*(x + y)\n%s\n"
                     "scene s { start %s\nstep 0.1 [ms]\nuntil 1 [ms] }\n",
                     cases[i].statement, cases[i].start);
            motion_open_text(&m, text, k == 0 ? IN_DOUBLE : IN_FLOAT);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            TEST_ASSERT_EQUAL_UINT64_MESSAGE(cases[i].events, contacts_events(&m), text);
            motion_close(&m);
        }
    }
}

void suite_contact_start(void) {
    RUN_TEST(test_an_impact_at_the_start_is_as_one_just_after);
    RUN_TEST(test_what_happens_at_the_start_is_counted);
}
