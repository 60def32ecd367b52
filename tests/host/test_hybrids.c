/* test_hybrids.c: random planar linkages with up to three stops and dry frictions, against a program of another kind
 * (hybrid.h). WHIRL_CASES=10000 WHIRL_SEED=...: so many, others. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "hybrid.h"
#include "motion.h"
#include "unity.h"

void suite_hybrids(void);

#define STEP_S 0.25e-3
#define UNTIL_S 0.5

/* What is asked of every one of them. */
#define OFF_MOST 1e-6

/* How far the program's motion is off at `until_s`. */
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

/* A motion too fast for the step: both programs' steps an eighth, and their errors 4096 times less. And a little later,
 * for an impact of drawn numbers may come at the end itself, where one of the two has had it and the other has not. */
static double off_in_finer(const hybrid *h, const char *text) {
    const double later_s = UNTIL_S + 8.0 * STEP_S;
    const hybrid_motion wanted = hybrid_move(h, HYBRID_STEP_S / 8.0, later_s, STEP_S);
    return wanted.aside ? 0.0 : off_at(later_s, h, &wanted, STEP_S / 8.0, text);
}

static void test_random_hybrids(void) {
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
    TEST_ASSERT_TRUE(fast * 300 <= cases); /* of 300 none */
    TEST_ASSERT_TRUE(cases < 8 || (eventful * 3 >= cases && aside <= cases));
}

/* Blocks on springs, whose friction comes and goes with the load of a mass that swings: the moments at which it vanishes
 * are kinks of the force, and found, so that the error falls with the fourth power of the step. */
static void test_normal_forces_that_vanish(void) {
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

void suite_hybrids(void) {
    RUN_TEST(test_random_hybrids);
    RUN_TEST(test_normal_forces_that_vanish);
}
