/* test_price_dearest.c: what trials say that a setting costs (host/study/trial.h): the dearest of all places against each by
 * itself, finer steps where a scene takes no coarse one, and what there is no image of. */
#include <string.h>

#include "command.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "priced.h"
#include "unity.h"

void suite_price_dearest(void);

/* Three of one motion or another, of more and less work; the last is linear alone. */
static const char *const springs[] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2 + 2 [N/m^3]*x^4/4\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\nF = 1 [N*s/m]*x'^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n"};
static const whole_ratio spacing = {1, 500};
enum { RECORDS = 100 };

static cost cost_at(priced *p, int point, const setting *s, const char *step) {
    image *im = priced_image(p, point, s, step);
    TEST_ASSERT_NOT_NULL(im);
    diags *errors = diags_new();
    fixed_plan *plan = s->number == &engine_fixed ? fixed_plan_make(im, false, errors) : NULL;
    im->fixed = plan;
    const cost c = cost_of(im, p->wish.board, setting_cost_number(s));
    fixed_plan_free(plan);
    diags_free(errors);
    image_free(im);
    return c;
}

static void expect_same(const cost *want, const cost *have, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(have->instructions_worst.most == want->instructions_worst.most, what);
    TEST_ASSERT_TRUE_MESSAGE(have->cycles.value == want->cycles.value, what);
    TEST_ASSERT_TRUE_MESSAGE(have->flash_bytes.value == want->flash_bytes.value, what);
    TEST_ASSERT_TRUE_MESSAGE(have->state_bytes.value == want->state_bytes.value, what);
}

/* In each order of the places. */
static void test_the_dearest_of_all_places(void) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385"};
    for (int turn = 0; turn < 3; turn++) {
        const char *texts[3] = {springs[turn], springs[(turn + 1) % 3], springs[(turn + 2) % 3]};
        priced p;
        priced_open(&p, texts, 3);
        TEST_ASSERT_TRUE(priced_begin(&p, boards[turn % 2], spacing, RECORDS, NULL));
        const setting s[] = {priced_setting(WH_RK4, &engine_float),
                             priced_setting(WH_HEUN, &engine_double),
                             priced_setting(WH_RK4, &engine_fixed)};
        int known = 0;
        for (int i = 0; i < 3; i++) {
            cost dearest = {0};
            for (int k = 0; k < 3; k++) {
                const cost c = cost_at(&p, k, &s[i], "0.0004");
                if (k == 0 || c.instructions_worst.most > dearest.instructions_worst.most) {
                    dearest = c;
                }
            }
            bool own = false;
            const cost c = trial_cost(&p.trial, &s[i], (deviation_pace){5, 1}, &own);
            TEST_ASSERT_TRUE_MESSAGE(own, c.why);
            expect_same(&dearest, &c, wh_methods[s[i].image.method].word);
            known += c.instructions_worst.most > 0.0;
        }
        TEST_ASSERT_TRUE(known >= 2);
        /* with sines looked up it is no setting of its own: there are none */
        setting lookup = s[0];
        lookup.image.angles = ANGLES_LOOKUP;
        bool own = true;
        const cost none = trial_cost(&p.trial, &lookup, (deviation_pace){5, 1}, &own);
        TEST_ASSERT_TRUE(!own && none.instructions.basis == COST_NOT_KNOWN);
        /* nor leapfrog, where one of the places has a damper */
        const setting leapfrog = priced_setting(WH_LEAPFROG, &engine_float);
        (void)trial_cost(&p.trial, &leapfrog, (deviation_pace){5, 1}, &own);
        TEST_ASSERT_FALSE(own);
        priced_close(&p);
    }
}

/* --- finer steps -----------------------------------------------------------------------------------------*/

static double longest_s;
static bool none_longer(const setting *s, double step_s) {
    (void)s;
    return step_s <= longest_s;
}

/* In fixed point a scene is asked for steps a tenth as long, three times. */
static void test_finer_steps_are_asked_for(void) {
    static const struct {
        deviation_pace from;
        double longest_s;
        deviation_pace at;
        int asked;
        bool own;
    } rows[] = {{{1, 50}, 2.0, {1, 50}, 1, true},      {{1, 50}, 0.011, {1, 5}, 2, true},
                {{1, 50}, 0.0011, {10, 5}, 3, true},   {{1, 50}, 0.00011, {100, 5}, 4, true},
                {{1, 50}, 0.000011, {1, 1}, 4, false}, {{2, 1}, 0.00015, {20, 1}, 2, true},
                {{1, 20}, 0.005, {1, 2}, 2, true}};
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        priced p;
        priced_open(&p, springs, 1);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
        longest_s = rows[i].longest_s;
        p.takes = none_longer;
        bool own;
        int asked = p.asked;
        const cost c = trial_any_cost(&p.trial, &in_fixed, rows[i].from, &own);
        TEST_ASSERT_EQUAL_INT(rows[i].asked, p.asked - asked);
        TEST_ASSERT_EQUAL_INT(rows[i].own, own);
        if (own) {
            /* it is kept for this step, and asked for anew for another */
            asked = p.asked;
            const trial_result r = trial_run(&p.trial, &in_fixed, rows[i].at);
            TEST_ASSERT_TRUE(r.ran);
            TEST_ASSERT_EQUAL_INT(asked, p.asked);
            const cost same = trial_cost(&p.trial, &in_fixed, rows[i].at, &own);
            TEST_ASSERT_EQUAL_INT(asked + 1, p.asked);
            expect_same(&same, &c, "by the step that it takes");
            (void)trial_run(&p.trial, &in_fixed,
                            (deviation_pace){rows[i].at.steps * 2, rows[i].at.records});
            TEST_ASSERT_EQUAL_INT(asked + 2, p.asked);
        }
        /* nothing else is asked for finer steps */
        const setting rk4 = priced_setting(WH_RK4, &engine_float);
        longest_s = 1e-9;
        asked = p.asked;
        const cost none = trial_any_cost(&p.trial, &rk4, rows[i].from, &own);
        TEST_ASSERT_EQUAL_INT(1, p.asked - asked);
        TEST_ASSERT_TRUE(own && none.instructions.basis == COST_NOT_KNOWN);
        TEST_ASSERT_EQUAL_STRING("there is no image of it", none.why);
        priced_close(&p);
    }
}

/* Looking for ranges takes a run: not where the finer step's takes too long. */
static void test_no_finer_step_than_may_be_planned(void) {
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    priced p;
    priced_open(&p, springs, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    longest_s = 1e-9;
    p.takes = none_longer;
    p.trial.planned_most = trial_operations(&p.trial, &in_fixed, (deviation_pace){10, 5});
    const int asked = p.asked;
    bool own;
    (void)trial_any_cost(&p.trial, &in_fixed, (deviation_pace){1, 50}, &own);
    TEST_ASSERT_FALSE(own);
    TEST_ASSERT_EQUAL_INT(4, p.asked - asked); /* the next is asked before it is seen to be slow */
    priced_close(&p);
}

/* A matrix of a step that is too long is priced by the scene's own; one that there is none of is no setting of the scene. */
static bool no_long_matrix(const setting *s, double step_s) {
    return s->image.matrix == MATRIX_NONE || step_s < longest_s;
}

static void test_matrices_are_priced_by_a_step_that_they_take(void) {
    priced p;
    priced_open(&p, springs, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    p.takes = no_long_matrix;
    setting matrix = priced_setting(WH_RK4, &engine_float);
    matrix.image.matrix = MATRIX_EXACT;
    longest_s = 0.001;
    bool own = false;
    int asked = p.asked;
    const cost c = trial_cost(&p.trial, &matrix, (deviation_pace){1, 1}, &own);
    const cost scenes = cost_at(&p, 0, &matrix, NULL);
    TEST_ASSERT_TRUE(own);
    TEST_ASSERT_EQUAL_INT(asked + 2, p.asked);
    expect_same(&scenes, &c, "a matrix by its own step");
    TEST_ASSERT_FALSE(trial_run(&p.trial, &matrix, (deviation_pace){1, 1}).ran);
    longest_s = 0.0;
    (void)trial_cost(&p.trial, &matrix, (deviation_pace){1, 1}, &own);
    TEST_ASSERT_FALSE(own);
    priced_close(&p);
}

/* What has contacts is priced by a step without an event where that is what is asked for. */
static void test_contacts_are_left_out_where_that_is_asked(void) {
    priced p;
    priced_open(&p, priced_ball, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 10, NULL));
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    image *im = priced_image(&p, 0, &rk4, "0.0004");
    TEST_ASSERT_TRUE(im->contacts > 0);
    bool own;
    const cost with = cost_of(im, p.wish.board, COST_FLOAT);
    im->contacts = 0;
    const cost without = cost_of(im, p.wish.board, COST_FLOAT);
    im->contacts = 1;
    cost c = trial_cost(&p.trial, &rk4, (deviation_pace){5, 1}, &own);
    expect_same(&with, &c, "with");
    TEST_ASSERT_TRUE(own && with.cycles.value != without.cycles.value);
    p.trial.without_events = true;
    c = trial_cost(&p.trial, &rk4, (deviation_pace){5, 1}, &own);
    expect_same(&without, &c, "without");
    image_free(im);
    priced_close(&p);
}

void suite_price_dearest(void) {
    RUN_TEST(test_the_dearest_of_all_places);
    RUN_TEST(test_finer_steps_are_asked_for);
    RUN_TEST(test_no_finer_step_than_may_be_planned);
    RUN_TEST(test_matrices_are_priced_by_a_step_that_they_take);
    RUN_TEST(test_contacts_are_left_out_where_that_is_asked);
}
