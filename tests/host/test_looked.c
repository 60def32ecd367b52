/* test_looked.c: a close look at the last steps of a run (host/run/look_close.h), of runs that are made up: where accurate steps lead,
 * how far the run's own are from there, which steps are fine enough, and what the inertia is on the way. */
#include <math.h>
#include <string.h>

#include "host/run/look_close.h"
#include "host/run/watch.h"
#include "made_run.h"
#include "unity.h"

void suite_looked(void);

static dice die;

static void expect_near(double wanted, double is, double size, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(wanted - is) <= 1e-11 * (fabs(wanted) + size), what);
}

static double larger(double a, double b) { return a > b ? a : b; }

/* How far apart two states are: places by how far each went, rates by the kinetic energy of their difference; whose it is. */
static double apart(const watch *w, const double *run, const double *truth, int *whose) {
    double most = 0.0;
    *whose = -1;
    for (int i = 0; i < 2; i++) {
        const double off = fabs(run[i] - truth[i]) / w->range[made_run_place(i)];
        if (off > most) {
            most = off;
            *whose = made_run_place(i);
        }
    }
    const double difference[N] = {0.0, 0.0, run[VX] - truth[VX], run[VY] - truth[VY]};
    const double rates = sqrt(made_run_kinetic(difference) / made_run_kinetic(truth));
    if (rates > most) {
        *whose = -1;
    }
    return larger(most, rates);
}

/* The last eight steps again, in steps four times as many until that makes no difference: where they end, and how far the run's
 * own are from there. The inertia's pivots are the same everywhere. */
static void expect_look(const watch *w, int ahead) {
    const watch_look *l = &w->worst;
    const uint64_t begin = made_run.at > WATCH_WINDOW ? made_run.at - WATCH_WINDOW : 0;
    const int count = (int)(made_run.at - begin) + ahead;
    double coarse[N];
    double fine[N];
    int parts = 4;
    int whose;
    memcpy(coarse, made_run.state[begin], sizeof coarse);
    for (int k = 0; k < count; k++) {
        made_run_go(coarse, parts);
    }
    for (;; parts *= 4) {
        memcpy(fine, made_run.state[begin], sizeof fine);
        for (int k = 0; k < count; k++) {
            made_run_go(fine, 4 * parts);
        }
        if (apart(w, coarse, fine, &whose) < 1e-5) {
            break;
        }
        memcpy(coarse, fine, sizeof coarse);
    }
    TEST_ASSERT_TRUE(l->done && l->resolved && l->failed == (ahead > 0));
    expect_near((double)begin * made_run.step_s, l->begin_s, 0.0, "a look's begin");
    expect_near((double)(made_run.at + (uint64_t)ahead) * made_run.step_s, l->end_s, 0.0,
                "a look's end");
    expect_near(made_run.step_s / parts, l->fine_step_s, 0.0, "a look's step");
    if (ahead > 0) {
        TEST_ASSERT_TRUE(l->off == 1.0);
    } else {
        const double off = apart(w, made_run.state[made_run.at], fine, &whose);
        TEST_ASSERT_TRUE(fabs(off - l->off) <= 1e-7 * off);
        TEST_ASSERT_EQUAL_INT(whose, l->component);
    }
    const double least = 1.0 - made_run.coupled * made_run.coupled / (made_run.mx * made_run.my);
    TEST_ASSERT_TRUE(fabs(l->inertia - least) < 1e-6);
    TEST_ASSERT_EQUAL_INT(made_run_place(VY), l->singular);
    TEST_ASSERT_FALSE(w->singular.done);
}

static void test_close_looks(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 10)); c++) {
        const uint64_t end = 1 + dice_one_of(&die, 30);
        made_run_draw(&die, c % 3U > 0, c % 4U == 3);
        made_run_states(&die, end);
        derived d = made_run_derive();
        made_run.image = d.image;
        watch *w = watch_open(made_run.image, &made_run_kind);
        w->balanced = false; /* without books */
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            watch_enter(w, &made_run_kind, NULL, NULL);
        }
        made_run.at = end;
        const int ahead = c % 5U == 0 ? 2 : 0;
        const uint64_t looked = w->looked;
        w->worst = (watch_look){.done = false};
        look_close(w, ahead);
        TEST_ASSERT_EQUAL_UINT64(looked + 1, w->looked);
        expect_look(w, ahead);
        /* what is less does not take its place */
        w->worst.off = 2.0 + w->worst.off;
        const watch_look kept = w->worst;
        look_close(w, ahead);
        TEST_ASSERT_TRUE(w->worst.off == kept.off);
        watch_close(w);
        derived_free(&d);
    }
}

void suite_looked(void) {
    die = dice_of("looked", 72);
    RUN_TEST(test_close_looks);
}
