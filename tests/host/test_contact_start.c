/* test_contact_start.c: impacts at t = 0, contacts at the same moment in any sequence, and random linkages with
 * contacts compared with an independent program. */
#include "command.h"
#include "contacts.h"
#include "derived.h"
#include "hybrid.h"
#include "motion.h"
#include "scattered.h"
#include "tangled.h"

/* === suite contact_start ====================================================================== */

/* Body x hits body y, which is pressed onto a floor. y must not move, even if its position has round-off. */
#define ROW "stop y >= 0.3 [m] restitution 0.5\nstop x - y >= 0 [m] restitution 0.5"

/* An impact at t = 0 counts like a later one, in float and double. Contacts at rest do not count. */
TEST(contact_start, events_at_the_start_are_counted) {
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
        {ROW, "y = 0.3 [m], x = 0.3 [m], x' = -2 [m/s]", 1},
        {ROW, "y = 0.3000000000000001 [m], x = 0.3000000000000001 [m], x' = -2 [m/s]", 1},
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
            const bool row = strncmp(cases[i].statement, ROW, sizeof ROW) == 0;
            const double off = motion_value(&m, "x'") - (1.0 - 9.81e-4);
            TEST_ASSERT_TRUE_MESSAGE(!row || fabs(off) < 1e-6, text);
            motion_close(&m);
        }
    }
}

/* === suite contact_together =================================================================== */
/* Several contacts at one moment. The result must not depend on the sequence in the file, an impact must not add
 * energy, and symmetric cases must stay symmetric. */

enum { STATES = 16, BALLS = 5 };

/* Runs a tangle. state[]: the positions, then the rates at the end. *overruns: number of steps with too many events.
 * Returns the number of states. */
static int run(const tangle *of, double *state, uint64_t *overruns) {
    char text[4000];
    motion m;
    (void)tangled_text(of, text, sizeof text);
    motion_open_text(&m, text, IN_DOUBLE);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, m.instance->steps));
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

/* Touching bodies are thrown at each other, some with friction, loads, holds and a crossing. Every sequence of the
 * statements must give the same motion within round-off. Steps with too many events are excepted. */
TEST(contact_together, order_of_statements_changes_nothing) {
    const long runs = (long)dice_cases(130);
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

/* Opens a row of equal balls, 10 cm each, which touch within round-off; speed[] in m/s. */
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
        PUT("stop x%d - x%d >= 0.1 [m] restitution %.17g\n", i + 1, i, restitution);
    }
    PUT("scene s {\n  step 1 [ms]\n  until 1 [s]\n");
    for (int i = 1; i <= BALLS; i++) {
        PUT("  start x%d = %.17g [m], x%d' = %.17g [m/s]\n", i, 0.1 * i, i, speed[i - 1]);
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

/* Newton's cradle: as many balls leave as arrive, because a ball that is hit hits its neighbour at the same moment,
 * in the next round of impacts. If impacts at 2 and 1 m/s meet in the middle ball, both of its stops are hit at once,
 * which gives -4/3, 2/3 and 5/3 m/s. Without restitution, all touching balls move on together. */
TEST(contact_together, newtons_cradle) {
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

/* === suite hybrids ============================================================================ */
/* Random planar linkages with up to three stops and dry frictions, compared with an independent program (hybrid.h).
 * WHIRL_CASES=N and WHIRL_SEED=N choose other cases. */

#define STEP_S 0.25e-3
#define UNTIL_S 0.5

#define OFF_MOST 1e-6

/* Error of the program's motion at until_s. */
static double off_at(double until_s, const hybrid *h, const hybrid_motion *wanted, double step_s,
                     const char *text) {
    motion m;
    double most = 0.0;
    motion_open_text(&m, text,
                     (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s});
    motion_to(&m, until_s);
    for (int k = 0; k < h->of.bodies; k++) {
        char name[8];
        snprintf(name, sizeof name, "q%d", k);
        most = fmax(most, fabs(motion_value(&m, name) - (double)wanted->state[k]));
        snprintf(name, sizeof name, "q%d'", k);
        most = fmax(most, fabs(motion_value(&m, name) - (double)wanted->state[LINKAGE_BODIES + k]));
    }
    motion_close(&m);
    return most;
}

static double off_at_end(const hybrid *h, const hybrid_motion *wanted, double step_s,
                         const char *text) {
    return off_at(UNTIL_S, h, wanted, step_s, text);
}

/* The error with an eighth of the step. If a motion is too fast for the step, both programs have errors, which become
 * 4096 times smaller. The finer runs end slightly later than the first run: an impact exactly at its end may have
 * happened in one program only. */
static double off_in_finer(const hybrid *h, const char *text) {
    const double later_s = UNTIL_S + 8.0 * STEP_S;
    const hybrid_motion wanted = hybrid_move(h, HYBRID_STEP_S / 8.0, later_s, STEP_S);
    return wanted.aside ? 0.0 : off_at(later_s, h, &wanted, STEP_S / 8.0, text);
}

TEST(hybrids, random_hybrids) {
    dice d = dice_of("hybrids", 15);
    const unsigned cases = dice_cases(few_or_all(3, 40));
    uint64_t seed = d.state;
    double worst = 0.0;
    unsigned aside = 0;
    unsigned eventful = 0;
    unsigned beyond = 0;
    unsigned fast = 0;
    int impacts = 0;
    int rests = 0;
    for (unsigned k = 0; k < cases;) {
        char statements[HYBRID_TEXT];
        char text[LINKAGE_TEXT];
        const hybrid h = hybrid_draw(&seed);
        const hybrid_motion wanted = hybrid_move(&h, HYBRID_STEP_S, UNTIL_S, STEP_S);
        if (wanted.aside) {
            aside++;
            continue;
        }
        k++;
        hybrid_statements(&h, statements);
        linkage_write(&h.of, "hybrid", (linkage_writing){LINKAGE_INSIDE, .more = statements}, text);
        double off = off_at_end(&h, &wanted, STEP_S, text);
        if (!(off <= OFF_MOST)) {
            fast++;
            off = off_in_finer(&h, text);
        }
        if (!(off <= OFF_MOST)) {
            printf("%s# off by %.2e, with %d impacts, %d rests\n", text, off, wanted.impacts,
                   wanted.rests);
            beyond++;
        }
        worst = fmax(worst, off);
        eventful += wanted.impacts + wanted.rests > 0 ? 1U : 0U;
        impacts += wanted.impacts;
        rests += wanted.rests;
    }
    printf(
        "  %u hybrids, %u of them with events: %d impacts, %d rests; off by at most %.1e; %u beyond "
        "%.0e; %u too fast for the step, or with an impact at the end, and right in an eighth of it; %u aside\n",
        cases, eventful, impacts, rests, worst, beyond, OFF_MOST, fast - beyond, aside);
    TEST_ASSERT_EQUAL_UINT(0, beyond);
    TEST_ASSERT_TRUE(fast * 300 <= cases); /* fewer than 1 case in 300 is too fast */
    TEST_ASSERT_TRUE(cases < 8 || (eventful * 3 >= cases && aside <= cases));
}

/* Blocks on springs. Their friction depends on the load of a swinging mass. When the load becomes zero, the force
 * has a kink, which is located. So the error must fall with the fourth power of the step. */
TEST(hybrids, normal_forces_that_vanish) {
    dice d = dice_of("hybrids", 17);
    double least = 1e9;
    for (int k = 0; k < 6; k++) {
        hybrid h = {.of = {.bodies = 2}, .contacts = 1};
        char statements[HYBRID_TEXT];
        char text[LINKAGE_TEXT];
        for (int i = 0; i < 2; i++) {
            linkage_body *b = &h.of.body[i];
            *b = (linkage_body){
                .parent = -1, .slides = true, .mass_kg = 1.0, .inertia_kgm2 = 0.0625};
            b->stiffness = dice_between(&d, 80.0, 400.0);
            b->wave = 1.0;
            h.of.start[i] = dice_between(&d, 0.1, 0.4);
        }
        h.contact[0] = (hybrid_contact){.kind = HYBRID_FRICTION,
                                        .limit = dice_between(&d, 3.0, 6.0),
                                        .loaded_by = 1,
                                        .load = dice_between(&d, 80.0, 160.0)};
        const hybrid_motion wanted = hybrid_move(&h, HYBRID_STEP_S, UNTIL_S, 0.0);
        TEST_ASSERT_FALSE(wanted.aside);
        hybrid_statements(&h, statements);
        linkage_write(&h.of, "loaded", (linkage_writing){LINKAGE_INSIDE, .more = statements}, text);
        const double coarse = off_at_end(&h, &wanted, 5e-3, text);
        const double fine = off_at_end(&h, &wanted, 1.25e-3, text);
        printf("  off by %.2e at 5 ms, %.2e at 1.25 ms: order %.2f\n", coarse, fine,
               log2(coarse / fine) / 2.0);
        least = fmin(least, log2(coarse / fine) / 2.0);
    }
    TEST_ASSERT_TRUE(least > 3.5);
}
