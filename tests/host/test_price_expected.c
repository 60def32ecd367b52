/* test_price_expected.c: what a setting is taken to cost while one is chosen and others are counted (host/price/choice_price.h):
 * no more than is likely, by what was counted before. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/price/choice_price.h"
#include "priced.h"
#include "unity.h"

void suite_price_expected(void);

static const char *const spring[] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 40 [N/m]*x^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 20};
enum { RECORDS = 10, MANY = 40 };

static bool near(double a, double b) { return fabs(a - b) <= 1e-12 * (fabs(a) + fabs(b)); }

static measured_price counted_price(const setting *s, deviation_pace pace, double value) {
    measured_price p = {.pace = pace};
    setting_options(s, true, p.options);
    p.cost.instructions = cost_known(value, COST_MEASURED);
    p.cost.instructions_worst = cost_known(value, COST_MEASURED);
    p.cost.flash_bytes = cost_known(10.0 * value, COST_MEASURED);
    p.cost.ram_bytes = cost_known(2.0 * value, COST_MEASURED);
    p.cost.stack_bytes = cost_known(3.0 * value, COST_MEASURED);
    p.cost.why = "";
    return p;
}

/* Without counting it is what is predicted; what was counted is that; and the rest, until many were, is the best number of
 * a step and the least bytes. */
static void test_what_is_expected_of_a_step(void) {
    static const char *const boards[] = {"mps2-an386", "mps2-an500", "atmega328p"};
    const deviation_pace pace = {2, 1};
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    const setting heun = priced_setting(WH_HEUN, &engine_float);
    for (int b = 0; b < 3; b++) {
        priced p;
        priced_open(&p, spring, 1);
        TEST_ASSERT_TRUE(priced_begin(&p, boards[b], spacing, RECORDS, NULL));
        measured_price counted[MANY];
        for (int i = 0; i < MANY; i++) {
            counted[i] = counted_price(&heun, pace, 777.0);
        }
        measured_prices m = {.price = counted, .count = 1};
        choice_wish w = {.counted = NULL};
        bool own;
        const cost plain = trial_cost(&p.trial, &rk4, pace, &own);
        cost c = choice_price(&p.trial, &w, &rk4, pace, false, &own);
        TEST_ASSERT_TRUE(own && c.instructions_worst.most == plain.instructions_worst.most);
        TEST_ASSERT_TRUE(c.flash_bytes.most == plain.flash_bytes.most);
        w.counted = &m;
        c = choice_price(&p.trial, &w, &heun, pace, true, &own);
        TEST_ASSERT_TRUE(own && c.instructions_worst.most == 777.0 && c.ram_bytes.value == 1554.0);
        c = choice_price(&p.trial, &w, &rk4, pace, false, &own);
        const bool range = p.wish.board->cycles == COST_RANGE;
        const double each = p.wish.board->cycles_most;
        TEST_ASSERT_TRUE(c.instructions.most == plain.instructions.value);
        TEST_ASSERT_TRUE(c.instructions_worst.most == plain.instructions_worst.value);
        TEST_ASSERT_TRUE(
            near(c.cycles.most, range ? each * plain.instructions.value : plain.cycles.value));
        TEST_ASSERT_TRUE(near(c.cycles_worst.most, range ? each * plain.instructions_worst.value
                                                         : plain.cycles_worst.value));
        TEST_ASSERT_TRUE(c.flash_bytes.most == plain.flash_bytes.least);
        TEST_ASSERT_TRUE(c.ram_bytes.most == plain.ram_bytes.least);
        TEST_ASSERT_TRUE(c.stack_bytes.most == plain.stack_bytes.least);
        TEST_ASSERT_TRUE(c.instructions.value == plain.instructions.value);
        m.count = MANY;
        c = choice_price(&p.trial, &w, &rk4, pace, false, &own);
        TEST_ASSERT_TRUE(c.instructions_worst.most == plain.instructions_worst.most);
        TEST_ASSERT_TRUE(c.flash_bytes.most == plain.flash_bytes.most);
        /* of runs, bytes as the last one's had more of them */
        m.by_run = true;
        m.lesson[COST_FLOAT] = (measured_lesson){1.5, 100.0, 20.0, 3.0};
        c = choice_price(&p.trial, &w, &rk4, pace, false, &own);
        TEST_ASSERT_TRUE(near(c.flash_bytes.value, plain.flash_bytes.value + 100.0));
        TEST_ASSERT_TRUE(near(c.flash_bytes.most, plain.flash_bytes.value + 100.0));
        TEST_ASSERT_TRUE(near(c.ram_bytes.most, plain.ram_bytes.value + 20.0));
        TEST_ASSERT_TRUE(near(c.stack_bytes.most, plain.stack_bytes.value + 3.0));
        m.count = 3;
        c = choice_price(&p.trial, &w, &rk4, pace, false, &own);
        TEST_ASSERT_TRUE(near(c.flash_bytes.most, 0.95 * (plain.flash_bytes.value + 100.0)));
        m.count = 4;
        c = choice_price(&p.trial, &w, &rk4, pace, false, &own);
        TEST_ASSERT_TRUE(near(c.flash_bytes.most, plain.flash_bytes.value + 100.0));
        TEST_ASSERT_TRUE(choice_prices_runs(&w));
        m.by_run = false;
        TEST_ASSERT_FALSE(choice_prices_runs(&w));
        w.counted = NULL;
        TEST_ASSERT_FALSE(choice_prices_runs(&w));
        priced_close(&p);
    }
}

/* Where nobody predicts double, it is float's, by software so many times as much; four fifths of its bytes are sure. */
static void test_what_stands_in_for_what_nobody_predicts(void) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385", "atmega328p", "mps2-an505"};
    int stood_in = 0;
    for (int b = 0; b < 4; b++) {
        priced q;
        priced_open(&q, spring, 1);
        TEST_ASSERT_TRUE(priced_begin(&q, boards[b], spacing, RECORDS, NULL));
        const deviation_pace pace = {2, 1};
        measured_prices m = {.count = 0};
        const choice_wish w = {.counted = &m};
        for (int i = 0; i < 3; i++) {
            static const wh_method methods[] = {WH_RK4, WH_HEUN, WH_RK38};
            const setting in_float = priced_setting(methods[i], &engine_float);
            const setting in_double = priced_setting(methods[i], &engine_double);
            bool own;
            const cost f = trial_cost(&q.trial, &in_float, pace, &own);
            const cost d = trial_cost(&q.trial, &in_double, pace, &own);
            const cost c = choice_price(&q.trial, &w, &in_double, pace, false, &own);
            if (d.instructions_worst.basis != COST_NOT_KNOWN ||
                f.instructions_worst.basis == COST_NOT_KNOWN) {
                continue;
            }
            if (b == 2) { /* no double there */
                TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, c.instructions_worst.basis);
                continue;
            }
            const double times = q.wish.board->fpu ? 4.0 : 1.3;
            TEST_ASSERT_TRUE(near(c.instructions.value, times * f.instructions.value));
            TEST_ASSERT_TRUE(near(c.instructions_worst.most, times * f.instructions_worst.value));
            TEST_ASSERT_TRUE(near(c.instructions.least, times * f.instructions.least));
            TEST_ASSERT_TRUE(near(c.cycles.value, times * f.cycles.value));
            TEST_ASSERT_TRUE(near(c.cycles.least, times * f.cycles.least));
            TEST_ASSERT_TRUE(near(c.cycles_worst.value, times * f.cycles_worst.value));
            TEST_ASSERT_TRUE(near(c.flash_bytes.value, 0.8 * f.flash_bytes.value));
            TEST_ASSERT_TRUE(near(c.stack_bytes.least, 0.8 * f.stack_bytes.least));
            TEST_ASSERT_TRUE(near(c.flash_bytes.most, 0.8 * f.flash_bytes.least));
            TEST_ASSERT_TRUE(near(c.ram_bytes.most, 0.8 * f.ram_bytes.least));
            TEST_ASSERT_TRUE(near(c.stack_bytes.most, 0.8 * f.stack_bytes.least));
            TEST_ASSERT_TRUE(c.state_bytes.value == d.state_bytes.value);
            stood_in++;
        }
        priced_close(&q);
    }
    printf("  %d stood in\n", stood_in);
    TEST_ASSERT_TRUE(stood_in > 0);
}

/* Where a board has none of a method, the classic one's, by how many stages each has. */
static void test_the_classic_method_stands_in(void) {
    static const char *const swings[] = {
        "mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -8 [J]*cos(a)\n"
        "scene s { start a = 1 [rad]; step 1 [ms]; until 1 [s] }\n"};
    int stood_in = 0;
    for (int i = 0; i < cost_board_count * WH_METHODS; i++) {
        priced q;
        priced_open(&q, swings, 1);
        TEST_ASSERT_TRUE(
            priced_begin(&q, cost_boards[i / WH_METHODS].name, spacing, RECORDS, NULL));
        const deviation_pace pace = {2, 1};
        const wh_method method = (wh_method)(i % WH_METHODS);
        const setting s = priced_setting(method, &engine_float);
        const setting rk4 = priced_setting(WH_RK4, &engine_float);
        measured_prices m = {.count = 0};
        const choice_wish w = {.counted = &m};
        bool own;
        const cost classic = trial_cost(&q.trial, &rk4, pace, &own);
        const cost plain = trial_cost(&q.trial, &s, pace, &own);
        const cost c = choice_price(&q.trial, &w, &s, pace, false, &own);
        if (own && plain.instructions_worst.basis == COST_NOT_KNOWN &&
            classic.instructions_worst.basis != COST_NOT_KNOWN) {
            const double times = wh_methods[method].stages / 4.0;
            TEST_ASSERT_TRUE(near(c.instructions.value, times * classic.instructions.value));
            TEST_ASSERT_TRUE(near(c.cycles.least, times * classic.cycles.least));
            TEST_ASSERT_TRUE(near(c.flash_bytes.value, 0.8 * classic.flash_bytes.value));
            stood_in++;
        }
        priced_close(&q);
    }
    printf("  rk4 stood in %d times\n", stood_in);
    TEST_ASSERT_TRUE(stood_in > 0);
}

/* Where a board has no figures of what a scene does, by whatever method: half of what another board of its kind takes, and no
 * bytes. */
static void test_other_boards_stand_in(void) {
    static const char *const calls[] = {"tanh(y)",      "asin(y/9)", "acos(y/9)",
                                        "log(2 + y^2)", "sinh(y)",   "atan2(y, 2)"};
    static const wh_method methods[] = {WH_RK4, WH_HEUN, WH_RK38};
    int stood_in = 0;
    for (size_t n = 0; n < sizeof calls / sizeof calls[0]; n++) {
        char text[300];
        snprintf(text, sizeof text,
                 "mechanism m\nstate y\nequation y' + 1 [1/s]*y*%s = 1 [1/s]\n"
                 "scene s { start y = 1; step 1 [ms]; until 1 [s] }\n",
                 calls[n]);
        const char *texts[] = {text};
        for (int i = 0; i < cost_board_count * 3; i++) {
            priced q;
            priced_open(&q, texts, 1);
            TEST_ASSERT_TRUE(priced_begin(&q, cost_boards[i / 3].name, spacing, RECORDS, NULL));
            const deviation_pace pace = {2, 1};
            const cost_board *b = q.wish.board;
            const setting s = priced_setting(methods[i % 3], &engine_float);
            const setting rk4 = priced_setting(WH_RK4, &engine_float);
            bool own;
            const cost plain = trial_cost(&q.trial, &s, pace, &own);
            const cost classic = trial_cost(&q.trial, &rk4, pace, &own);
            q.trial.wish.board = cost_board_named(b->fpu ? "mps2-an386" : "mps2-an385");
            const cost other = trial_cost(&q.trial, &s, pace, &own);
            q.trial.wish.board = b;
            if (plain.instructions_worst.basis == COST_NOT_KNOWN &&
                classic.instructions_worst.basis == COST_NOT_KNOWN &&
                other.instructions_worst.basis != COST_NOT_KNOWN) {
                measured_prices m = {.count = 0};
                const choice_wish w = {.counted = &m};
                const cost c = choice_price(&q.trial, &w, &s, pace, false, &own);
                const bool range = b->cycles == COST_RANGE;
                const double each = range ? b->cycles_most : 1.0;
                const double mean = 0.5 * other.instructions.value;
                const double worst = 0.5 * other.instructions_worst.value;
                TEST_ASSERT_TRUE(own && q.trial.wish.board == b);
                TEST_ASSERT_TRUE(near(c.instructions.value, mean));
                TEST_ASSERT_TRUE(near(c.instructions.most, mean));
                TEST_ASSERT_TRUE(near(c.instructions_worst.most, worst));
                TEST_ASSERT_TRUE(near(c.cycles.value, each * mean));
                TEST_ASSERT_TRUE(near(c.cycles.most, each * mean));
                TEST_ASSERT_TRUE(near(c.cycles_worst.value, each * worst));
                TEST_ASSERT_TRUE(near(c.cycles_worst.most, each * worst));
                TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, c.flash_bytes.basis);
                TEST_ASSERT_TRUE(c.ram_bytes.most == 0.0 && c.stack_bytes.most == 0.0);
                TEST_ASSERT_TRUE(c.state_bytes.value == plain.state_bytes.value);
                stood_in++;
            }
            priced_close(&q);
        }
    }
    printf("  %d boards stood in\n",
           stood_in); /* of AVR: the others were fitted to the same scenes */
    TEST_ASSERT_TRUE(stood_in > 3);
}

/* A run's mean by all its evaluations, its longest step by the one that took most, and by what the last run taught. */
static void test_runs_are_expected_by_their_evaluations(void) {
    dice d = dice_of("price_expected runs", 101);
    priced p;
    priced_open(&p, spring, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    for (int n = 0; n < 200; n++) {
        const wh_method method = n % 2 ? WH_RK4 : WH_HEUN;
        const double stages = n % 2 ? 4.0 : 2.0;
        const setting s = priced_setting(method, n % 3 ? &engine_float : &engine_double);
        const deviation_pace pace = {1 + dice_one_of(&d, 9), 1};
        const double each_s = 1.0 / (20.0 * (double)pace.steps);
        measured_price counted[8];
        const setting other = priced_setting(WH_EULER, &engine_float);
        for (int i = 0; i < 8; i++) {
            counted[i] = counted_price(&other, pace, 1.0);
        }
        measured_prices m = {.price = counted, .count = (int)dice_one_of(&d, 8), .by_run = true};
        const double in_float = dice_one_of(&d, 2) * dice_between(&d, 0.5, 2.0);
        const double own = dice_one_of(&d, 2) * dice_between(&d, 0.5, 2.0);
        m.lesson[COST_FLOAT].share = in_float;
        m.lesson[COST_DOUBLE].share = own;
        const double learnt = n % 3 ? in_float : own;
        const double share = learnt > 0.0 ? learnt : 1.0;
        const choice_wish w = {.counted = &m};
        const trial_result r = {.evaluations = dice_between(&d, 0.5, 3.0) * stages / each_s,
                                .evaluations_most = dice_between(&d, 0.5, 9.0) * stages};
        cost step = {.why = ""};
        step.instructions = (cost_figure){COST_PREDICTED, COST_MEASURED, 100, 80, 130, 1.3};
        step.instructions_worst = step.cycles = step.cycles_worst = step.flash_bytes =
            step.instructions;
        const double mean = fmax(1.0, r.evaluations * each_s / stages);
        const double worst =
            fmax(1.0, (m.count < 4 ? 0.85 : 1.0) * share * r.evaluations_most / stages);
        const cost c = choice_price_of_run(&p.trial, &w, &s, pace, &step, &r);
        TEST_ASSERT_TRUE(near(c.instructions.value, 100 * mean) && near(c.cycles.most, 130 * mean));
        TEST_ASSERT_TRUE(near(c.instructions_worst.value, 100 * worst));
        TEST_ASSERT_TRUE(near(c.instructions_worst.least, 80 * worst));
        TEST_ASSERT_TRUE(near(c.cycles_worst.most, 130 * worst) && c.flash_bytes.most == 130);
        const double steps = 0.5 / each_s;
        step.instructions.value = 1e9 / steps * (n % 2 ? 0.999 : 1.001);
        TEST_ASSERT_EQUAL_INT(n % 2 == 0, choice_run_is_long(&p.trial, pace, &step));
        /* a billion is not too many */
        const deviation_pace coarsest = {1, 1};
        step.instructions.value = 1e9 / RECORDS;
        TEST_ASSERT_FALSE(choice_run_is_long(&p.trial, coarsest, &step));
        step.instructions.value += 1.0;
        TEST_ASSERT_TRUE(choice_run_is_long(&p.trial, coarsest, &step));
        /* what was counted is that */
        counted[7] = counted_price(&s, pace, 55.0);
        m.count = 8;
        const cost known = choice_price_of_run(&p.trial, &w, &s, pace, &step, &r);
        TEST_ASSERT_TRUE(known.instructions_worst.value == 55.0);
        /* and teaches: it took 55 of what was expected without a margin */
        choice_row row = {.setting = s, .pace = pace};
        row.cost.instructions_worst = cost_known(dice_between(&d, 20.0, 90.0), COST_PREDICTED);
        row.cost.flash_bytes = cost_known(500.0, COST_PREDICTED);
        row.cost.ram_bytes = cost_known(100.0, COST_PREDICTED);
        row.cost.stack_bytes = cost_known(150.0, COST_PREDICTED);
        choice_learn_run(&m, &row);
        const measured_lesson *l = &m.lesson[n % 3 ? COST_FLOAT : COST_DOUBLE];
        TEST_ASSERT_TRUE(near(l->share, share * 55.0 / row.cost.instructions_worst.value));
        TEST_ASSERT_TRUE(near(l->flash_bytes, 50.0) && near(l->ram_bytes, 10.0));
        TEST_ASSERT_TRUE(near(l->stack_bytes, 15.0));
        const measured_lesson before = *l;
        m.by_run = false;
        choice_learn_run(&m, &row);
        TEST_ASSERT_EQUAL_MEMORY(&before, l, sizeof before);
    }
    priced_close(&p);
}

void suite_price_expected(void) {
    RUN_TEST(test_what_is_expected_of_a_step);
    RUN_TEST(test_what_stands_in_for_what_nobody_predicts);
    RUN_TEST(test_the_classic_method_stands_in);
    RUN_TEST(test_other_boards_stand_in);
    RUN_TEST(test_runs_are_expected_by_their_evaluations);
}
