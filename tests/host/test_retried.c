/* test_retried.c: which step a run with too many events would have needed (host/run/retrial.h), of runs that are made up:
 * they overrun, and are off, down to a known step. Every part of a step that is tried is found where it is the coarsest
 * that will do, and no more is spent on looking than it may be. */
#include <math.h>
#include <signal.h>
#include <stdlib.h>

#include "command.h"
#include "core/contact.h"
#include "derived.h"
#include "host/base/room.h"
#include "host/run/retrial.h"
#include "unity.h"

void suite_retried(void);

enum { STEPS = 64, FINEST = 1000 };
#define STEP_S 1e-2

static const char *const ball =
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nstop x >= -9 [m] restitution 0.5\n"
    "scene s {\n  start x = 1 [m]\n  step 10 [ms]\n  until 0.64 [s]\n}\n";

/* What all made-up runs have in common. */
static struct {
    uint64_t needs;    /* parts of the step; in coarser ones each step overruns, */
    double off;        /* and x is off by this at the end */
    uint64_t chatters; /* in coarser parts the stop takes hold and lets go in each step */
    bool agree;        /* those that are fine enough; else each ends elsewhere */
    uint64_t evaluations_a_step;
    uint64_t spent; /* evaluations, by all runs that there were */
    uint64_t runs;
} world;

typedef struct made_up {
    uint64_t parts;
    uint64_t steps;
} made_up;

static void *start(const image *im) {
    made_up *m = room(1, sizeof *m);
    m->parts = (uint64_t)llround(STEP_S / im->step_s);
    world.runs++;
    return m;
}

static void stop(void *run) { free(run); }

static wh_status step(void *run) {
    made_up *m = run;
    TEST_ASSERT_TRUE(m->steps < STEPS * m->parts); /* to the end, and no further */
    m->steps++;
    world.spent += world.evaluations_a_step;
    return WH_OK;
}

static void state(const void *run, double *angle_rad, double *real) {
    const made_up *m = run;
    const double part = (double)m->steps / (double)(STEPS * m->parts);
    (void)angle_rad;
    const double off = world.agree ? (m->parts < world.needs ? world.off : 0.0)
                                   : world.off * sqrt((double)m->parts);
    real[0] = part + off * part * part;
    real[1] = 1.0;
}

static uint64_t steps(const void *run) { return ((const made_up *)run)->steps; }

static uint64_t events(const void *run, uint64_t *overruns) {
    const made_up *m = run;
    *overruns = m->parts < world.needs ? m->steps : 0;
    return *overruns;
}

static int happened(const void *run, engine_event *list) {
    const made_up *m = run;
    list[0] = (engine_event){.contact = 0, .mode = m->steps % 2 == 0 ? WH_FREE : WH_ACTIVE};
    return m->parts < world.chatters ? 1 : 0;
}

static uint64_t evaluations(const void *run, uint64_t *most) {
    *most = world.evaluations_a_step;
    return ((const made_up *)run)->steps * world.evaluations_a_step;
}

static const engine_kind kind = {.name = "made up",
                                 .start = start,
                                 .stop = stop,
                                 .step = step,
                                 .state = state,
                                 .steps = steps,
                                 .events = events,
                                 .happened = happened,
                                 .evaluations = evaluations};

/* The run itself, and what would have done. */
static retrial tried(const image *im) {
    busy *b = busy_open(im, 1);
    void *run = start(im);
    busy_enter(b, &kind, run, 0.0);
    for (int i = 0; i < STEPS; i++) {
        step(run);
        busy_enter(b, &kind, run, 0.0);
    }
    stop(run);
    world.spent = 0;
    world.runs = 0;
    const retrial made = retrial_of(b, &kind, 0.0, NULL);
    busy_close(b);
    return made;
}

/* 2, 5, 10, 20, 50, ...: the least of them that is no less; 0 beyond the finest. */
static uint64_t part_for(uint64_t needs) {
    static const uint64_t leading[] = {1, 2, 5};
    for (uint64_t ten = 1; ten <= FINEST; ten *= 10) {
        for (int i = 0; i < 3; i++) {
            const uint64_t part = leading[i] * ten;
            if (part > 1 && part <= FINEST && part >= needs) {
                return part;
            }
        }
    }
    return 0;
}

static void test_the_coarsest_that_will_do_is_found(void) {
    derived d = derived_scene(ball, "s");
    world.agree = true;
    dice draws = dice_of("retried", 26);
    derived_expect(&d, ball);
    for (int i = 0; i < 60; i++) {
        const double drawn = exp(dice_between(&draws, log(2.0), log(1.3 * FINEST)));
        world.needs = i < 9 ? part_for((uint64_t)exp(0.75 * i) + 2) : (uint64_t)drawn;
        world.needs += i % 3 == 2 ? 1 : 0; /* and the one that is just too coarse */
        world.off = dice_between(&draws, 0.05, 0.5);
        world.evaluations_a_step = 1;
        const uint64_t wanted = part_for(world.needs);
        const retrial found = tried(d.image);
        TEST_ASSERT_TRUE(found.told);
        TEST_ASSERT_EQUAL_UINT64(wanted, found.parts);
        TEST_ASSERT_TRUE(found.known == (wanted > 0));
        TEST_ASSERT_TRUE(found.agreed == (wanted > 0 && wanted < FINEST));
        TEST_ASSERT_EQUAL_UINT64(wanted > 0 && wanted < FINEST ? part_for(wanted + 1) : FINEST,
                                 found.finest);
        TEST_ASSERT_TRUE(!found.known || fabs(found.off - world.off) < 0.02 * world.off + 1e-9);
    }
    derived_free(&d);
}

/* 1e8 operations at most, and what an evaluation is beside its own forty more; what would be dearer is not begun. */
static void test_no_more_is_spent_than_may_be(void) {
    derived d = derived_scene(ball, "s");
    dice draws = dice_of("retried", 27);
    derived_expect(&d, ball);
    world.agree = true;
    const double each = d.image->list[IMAGE_STEP]->count + 40.0;
    unsigned cut = 0;
    for (int i = 0; i < 30; i++) {
        world.needs = FINEST + 1;
        world.off = 0.1;
        world.evaluations_a_step =
            (uint64_t)(1e8 / each / STEPS * exp(dice_between(&draws, log(1e-5), log(1.0))));
        double whole = 0.0; /* all of them */
        for (uint64_t part = 2; part > 0; part = part_for(part + 1)) {
            whole += (double)(STEPS * part * world.evaluations_a_step) * each;
        }
        const retrial found = tried(d.image);
        const double stride = 256.0 * (double)world.evaluations_a_step * each;
        TEST_ASSERT_TRUE((double)world.spent * each <= 1e8 + stride);
        TEST_ASSERT_TRUE(whole > 0.9e8 || found.finest == FINEST);
        TEST_ASSERT_TRUE(whole < 1e8 || found.finest < FINEST);
        TEST_ASSERT_TRUE(found.told && !found.known && found.parts == 0);
        cut += found.finest < FINEST ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(cut > 5 && cut < 25);
    derived_free(&d);
}

/* Where finer runs never agree, the coarsest is named that neither overruns nor chatters, as one of which no more is known. Where
 * the first that is tried is where the run is, there is nothing to tell. */
static void test_the_coarsest_that_is_calm_is_named(void) {
    derived d = derived_scene(ball, "s");
    dice draws = dice_of("retried", 28);
    derived_expect(&d, ball);
    world.evaluations_a_step = 1;
    for (int i = 0; i < 60; i++) {
        world.agree = i % 4 == 3;
        world.needs = i % 3 == 0 ? 1 : (uint64_t)exp(dice_between(&draws, 0.0, log(700.0)));
        world.chatters = 2U + (uint64_t)exp(dice_between(&draws, 0.0, log(1.3 * FINEST)));
        world.off = world.agree ? 0.0 : dice_between(&draws, 0.02, 0.1);
        const uint64_t least = world.needs > world.chatters ? world.needs : world.chatters;
        const retrial found = tried(d.image);
        if (world.agree) {
            TEST_ASSERT_TRUE(found.known && !found.told && found.off < 1e-9);
            const uint64_t next = part_for(part_for(world.needs) + 1);
            TEST_ASSERT_EQUAL_UINT64(world.needs <= 1 ? 2 : next > 0 ? next : FINEST, found.finest);
            continue;
        }
        TEST_ASSERT_TRUE(found.told && found.known && !found.agreed);
        TEST_ASSERT_EQUAL_UINT64(FINEST, found.finest);
        TEST_ASSERT_EQUAL_UINT64(part_for(least), found.parts);
    }
    world.chatters = 0;
    world.agree = true;
    derived_free(&d);
}

/* Broken off, nothing finer is known: then overruns are told, but for a few last bounces that took next to nothing. */
static void test_broken_off(void) {
    static const volatile sig_atomic_t stop_now = 1;
    derived d = derived_scene(ball, "s");
    dice draws = dice_of("retried", 29);
    derived_expect(&d, ball);
    world.evaluations_a_step = 1;
    for (int i = 0; i < 100; i++) {
        busy *b = busy_open(d.image, 1);
        const double largest_J = dice_between(&draws, 0.1, 9.0);
        world.needs = 2;
        world.spent = 0;
        b->steps = i % 9 == 8 ? STEPS - 1 : STEPS;
        b->overruns = dice_one_of(&draws, 4);
        b->taken_J = 1e-3 * largest_J * exp(dice_between(&draws, -1.0, 1.0));
        b->chatters = dice_one_of(&draws, 3) == 0 ? 0 : -1;
        const bool few = (double)b->overruns <= 1.0 + 0.01 * STEPS;
        const bool little = few && b->chatters < 0 && b->taken_J * 1e3 <= largest_J;
        const retrial found = retrial_of(b, &kind, largest_J, &stop_now);
        TEST_ASSERT_EQUAL(b->steps == STEPS && b->overruns > 0 && !little, found.told);
        TEST_ASSERT_TRUE(!found.known && !found.agreed && found.parts == 0 && found.finest == 1);
        TEST_ASSERT_TRUE(found.off == 0.0);
        TEST_ASSERT_TRUE(world.spent <= 1);
        busy_close(b);
    }
    const retrial none = retrial_of(NULL, &kind, 1.0, NULL);
    TEST_ASSERT_TRUE(!none.told && none.finest == 1);
    derived_free(&d);
}

void suite_retried(void) {
    RUN_TEST(test_the_coarsest_that_will_do_is_found);
    RUN_TEST(test_no_more_is_spent_than_may_be);
    RUN_TEST(test_the_coarsest_that_is_calm_is_named);
    RUN_TEST(test_broken_off);
}
