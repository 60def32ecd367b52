/* test_price_choices.c: what is chosen (host/price/choice.h) and tabled (price_table.h) of few settings of small scenes, by
 * predicted prices, against trying all of them by every step. tests/host/test_choice.c asks the same of all settings. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "host/price/choice.h"
#include "priced.h"
#include "unity.h"

void suite_price_choices(void);

enum { RECORDS = 10, SETTINGS = PRICED_TRIED };
static const double rate_Hz = 20.0;

static void begin(priced *p, const char *board) {
    priced_open(p, priced_spring, 1);
    p->takes = priced_is_tried;
    TEST_ASSERT_TRUE(priced_begin(p, board, (whole_ratio){1, 20}, RECORDS, NULL));
    TEST_ASSERT_TRUE(p->trial.reliable);
}

/* --- by trying all ---------------------------------------------------------------------------------------*/

/* A setting by ever finer steps, until it keeps the error. */
typedef struct kept_row {
    bool known;
    uint64_t substeps; /* 0: none keeps it */
    uint64_t coarser;  /* 0: none was tried before */
    double error, coarser_error;
    double weaker; /* least error of those that keep the other limits; infinite: none */
    double worst, load, flash, ram;
} kept_row;

enum { SUBSTEPS = 30 };
typedef struct errors {
    trial_result r[SETTINGS][SUBSTEPS]; /* by entry of choice_substeps() */
    cost c[SETTINGS][SUBSTEPS];
    bool has[SETTINGS][SUBSTEPS];
} errors;

static kept_row kept_of(priced *p, errors *known, int i, const choice_wish *w) {
    const setting s = priced_tried(i);
    kept_row k = {.weaker = (double)INFINITY};
    for (int e = 0; e < SUBSTEPS && k.substeps == 0; e++) {
        const deviation_pace pace = {choice_substeps(e), 1};
        if (!known->has[i][e]) {
            bool own;
            known->c[i][e] = trial_cost(&p->trial, &s, pace, &own);
            known->r[i][e] = trial_run(&p->trial, &s, pace);
            known->has[i][e] = true;
        }
        const cost c = known->c[i][e];
        k.known = c.instructions_worst.basis != COST_NOT_KNOWN;
        if (!k.known) {
            return k;
        }
        const trial_result *r = &known->r[i][e];
        const bool cycles = c.cycles_worst.basis != COST_NOT_KNOWN;
        k.worst = (cycles ? c.cycles_worst.most : c.instructions_worst.most) * rate_Hz *
                  (double)choice_substeps(e);
        k.load = w->clock_Hz > 0.0 ? k.worst / w->clock_Hz : 0.0;
        k.flash = c.flash_bytes.most;
        k.ram = c.ram_bytes.most + c.stack_bytes.most;
        const bool others = k.load <= 1.0 && (w->flash_bytes <= 0.0 || k.flash <= w->flash_bytes) &&
                            (w->ram_bytes <= 0.0 || k.ram <= w->ram_bytes);
        k.weaker = r->usable && others ? fmin(k.weaker, r->error) : k.weaker;
        if (r->usable && 2.0 * r->error <= w->error) {
            k.substeps = choice_substeps(e);
            k.error = r->error;
        } else {
            k.coarser = choice_substeps(e);
            k.coarser_error = r->error;
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(k.substeps > 0, "a finer step is needed than is looked at");
    return k;
}

static bool near(double a, double b) { return fabs(a - b) <= 1e-9 * fabs(b); }

static void expect_row(const choice_row *row, const kept_row *k, int i) {
    const setting s = priced_tried(i);
    TEST_ASSERT_TRUE(row->setting.image.method == s.image.method &&
                     row->setting.number == s.number);
    TEST_ASSERT_EQUAL_UINT64(k->substeps, row->substeps);
    TEST_ASSERT_TRUE(row->pace.steps == k->substeps && row->pace.records == 1);
    TEST_ASSERT_TRUE(near(row->worst, k->worst) && row->result.error == k->error);
    TEST_ASSERT_TRUE(near(row->load_most + 1.0, k->load + 1.0));
}

/* The least of `by` among those that do, or -1. */
static int least_of(const double by[SETTINGS], const bool does[SETTINGS], int but) {
    int least = -1;
    for (int i = 0; i < SETTINGS; i++) {
        if (does[i] && i != but && (least < 0 || by[i] < by[least])) {
            least = i;
        }
    }
    return least;
}

static void test_drawn_requests_are_answered_as_by_trying_all(void) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385", "atmega328p"};
    dice d = dice_of("price_choices", 71);
    int found = 0;
    int none = 0;
    for (int b = 0; b < 3; b++) {
        priced p;
        begin(&p, boards[b]);
        static errors known;
        known = (errors){.has = {{false}}};
        trial_memo memo = {.count = 0};
        for (unsigned n = 0; n < dice_cases(few_or_all(14, 1000)); n++) {
            kept_row k[SETTINGS];
            double by[5][SETTINGS];
            bool does[5][SETTINGS] = {{false}};
            const choice_wish w = {
                .error = pow(10.0, dice_between(&d, -3.7, -1.0)),
                .rate_Hz = rate_Hz,
                .periods = 1,
                .operations = 1e9,
                .clock_Hz = dice_one_of(&d, 3) ? pow(10.0, dice_between(&d, 3.0, 7.0)) : 0.0,
                .flash_bytes = dice_one_of(&d, 2) ? dice_between(&d, 3000.0, 9000.0) : 0.0,
                .ram_bytes = dice_one_of(&d, 2) ? dice_between(&d, 100.0, 900.0) : 0.0,
                .memo = &memo};
            int failed[CHOICE_LIMITS] = {0};
            int priced_count = 0;
            double weaker = (double)INFINITY;
            for (int i = 0; i < SETTINGS; i++) {
                k[i] = kept_of(&p, &known, i, &w);
                const bool load = k[i].load > 1.0;
                const bool flash = w.flash_bytes > 0.0 && k[i].flash > w.flash_bytes;
                const bool ram = w.ram_bytes > 0.0 && k[i].ram > w.ram_bytes;
                does[0][i] = k[i].known && !load && !flash && !ram;
                does[1][i] = k[i].known && !flash && !ram;
                does[2][i] = k[i].known && !load;
                does[3][i] = k[i].known;
                by[0][i] = by[3][i] = k[i].worst;
                by[1][i] = k[i].load;
                by[2][i] = k[i].flash;
                priced_count += k[i].known;
                failed[CHOICE_LOAD] += k[i].known && load;
                failed[CHOICE_FLASH] += k[i].known && flash;
                failed[CHOICE_RAM] += k[i].known && ram;
                weaker = fmin(weaker, k[i].known ? k[i].weaker : weaker);
            }
            const choice c = choice_make(&p.trial, &w);
            const int best = least_of(by[0], does[0], -1);
            TEST_ASSERT_EQUAL_INT(best >= 0, c.found);
            TEST_ASSERT_EQUAL_INT(c.settings,
                                  c.unpriced + c.tried + choice_not_tried(&c) - c.unpriced);
            TEST_ASSERT_EQUAL_INT(priced_count, c.tried);
            if (c.found) {
                const int second = least_of(by[0], does[0], best);
                expect_row(&c.best, &k[best], best);
                TEST_ASSERT_EQUAL_INT(second >= 0, c.has_second);
                if (second >= 0) {
                    expect_row(&c.second, &k[second], second);
                }
                TEST_ASSERT_EQUAL_INT(k[best].coarser > 0, c.has_coarser);
                if (c.has_coarser) {
                    TEST_ASSERT_EQUAL_UINT64(k[best].coarser, c.coarser.substeps);
                    TEST_ASSERT_TRUE(c.coarser.result.error == k[best].coarser_error);
                }
                found++;
                continue;
            }
            none++;
            const int dearer = least_of(by[1], does[1], -1);
            const int larger = least_of(by[2], does[2], -1);
            const int any = least_of(by[3], does[3], -1);
            TEST_ASSERT_EQUAL_INT(dearer >= 0, c.has_dearer);
            TEST_ASSERT_EQUAL_INT(larger >= 0, c.has_larger);
            TEST_ASSERT_EQUAL_INT(any >= 0, c.has_any);
            TEST_ASSERT_EQUAL_INT(isfinite(weaker), c.has_weaker);
            if (w.clock_Hz > 0.0 && c.has_dearer) {
                expect_row(&c.dearer, &k[dearer], dearer);
            }
            if (c.has_larger) {
                TEST_ASSERT_TRUE(c.larger.cost.flash_bytes.most == k[larger].flash);
            }
            if (c.has_any) {
                expect_row(&c.any, &k[any], any);
            }
            if (c.has_weaker) {
                TEST_ASSERT_TRUE(c.weaker.result.error == weaker);
            }
            for (int i = CHOICE_LOAD; i < CHOICE_LIMITS; i++) {
                TEST_ASSERT_EQUAL_INT(failed[i], c.failed[i]);
            }
            TEST_ASSERT_EQUAL_INT(0, c.failed[CHOICE_ERROR]);
            TEST_ASSERT_EQUAL_INT(0, c.refused);
        }
        trial_memo_free(&memo);
        priced_close(&p);
    }
    printf("  %d found, %d where nothing fits\n", found, none);
    TEST_ASSERT_TRUE(found > 5 && none > 5);
}

static void test_substeps_rise_as_they_are_told(void) {
    for (int i = 0; i < CHOICE_SUBSTEPS; i++) {
        static const uint64_t tens[] = {12, 15, 20, 25, 30, 40, 50, 60, 80};
        uint64_t want = i < 10 ? (uint64_t)i + 1 : tens[(i - 10) % 9];
        for (int k = 10; k + 9 <= i; k += 9) {
            want *= 10;
        }
        TEST_ASSERT_EQUAL_UINT64(want, choice_substeps(i));
    }
    static const char *const limit_words[] = {"error", "load", "flash", "RAM"};
    for (int i = 0; i < CHOICE_LIMITS; i++) {
        TEST_ASSERT_EQUAL_STRING(limit_words[i], choice_limit_words[i]);
    }
}

/* With little effort, what was not tried is said to be left; with none, all is. Without prices, why. */
static void test_little_effort_leaves_settings(void) {
    priced p;
    begin(&p, "mps2-an386");
    int before = setting_count();
    for (int power = 0; power < 6; power++) {
        const double operations = pow(30.0, power);
        const choice_wish w = {
            .error = 1e-4, .rate_Hz = rate_Hz, .periods = 1, .operations = operations};
        const choice c = choice_make(&p.trial, &w);
        const int left = choice_not_tried(&c) - c.unpriced;
        TEST_ASSERT_EQUAL_INT(c.settings, c.unpriced + c.tried + left);
        TEST_ASSERT_TRUE(left <= before);
        TEST_ASSERT_TRUE(power > 0 || (c.tried == 0 && !c.found && left > 0));
        TEST_ASSERT_EQUAL_STRING("there is no image of it", c.reason[0].why);
        int reasons = 0;
        for (int i = 0; i < CHOICE_REASONS; i++) {
            reasons += c.reason[i].settings;
            for (int k = 0; k < i && c.reason[i].why != NULL && c.reason[k].why != NULL; k++) {
                TEST_ASSERT_TRUE(strcmp(c.reason[k].why, c.reason[i].why) != 0);
            }
        }
        TEST_ASSERT_EQUAL_INT(c.unpriced, reasons);
        before = left;
    }
    TEST_ASSERT_EQUAL_INT(0, before);
    /* what keeps the flash by no step needs no effort to be refused */
    const choice_wish tiny = {
        .error = 1e-4, .rate_Hz = rate_Hz, .periods = 1, .operations = 1.0, .flash_bytes = 1.0};
    const choice c = choice_make(&p.trial, &tiny);
    TEST_ASSERT_TRUE(c.refused > 0 && c.tried == c.refused && !c.found);
    TEST_ASSERT_EQUAL_INT(c.settings, c.unpriced + c.tried + c.left[CHOICE_LEFT_WHOLE]);
    priced_close(&p);
}

/* A rate that is a whole part of the wished one, at which one step a period keeps the load and the error. */
static void test_a_lower_rate_keeps_what_it_says(void) {
    dice d = dice_of("price_choices rates", 72);
    priced p;
    begin(&p, "mps2-an386");
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    int some = 0;
    for (int n = 0; n < 60; n++) {
        choice c = {.has_dearer = n % 10 != 0};
        c.dearer.setting = rk4;
        c.dearer.substeps = n % 10 == 1 ? 2 : 1;
        c.dearer.load_most = dice_between(&d, 0.5, 12.5);
        const choice_wish w = {.error = pow(10.0, dice_between(&d, -3.0, 0.0)),
                               .rate_Hz = n % 10 == 2 ? 0.0 : 40.0,
                               .periods = 2};
        choice_row row;
        const double lower_Hz = choice_lower_rate(&p.trial, &w, &c, &row);
        const double slower = ceil(c.dearer.load_most);
        double want = 0.0;
        if (n % 10 > 2 && slower >= 2.0 && (int)slower % 2 == 0 && slower / 2.0 <= RECORDS) {
            const deviation_pace pace = {1, (uint64_t)slower / 2};
            const trial_result r = trial_run(&p.trial, &rk4, pace);
            want = r.usable && 2.0 * r.error <= w.error ? 40.0 / slower : 0.0;
            if (want > 0.0) {
                TEST_ASSERT_TRUE(row.pace.steps == 1 && row.pace.records == pace.records);
                TEST_ASSERT_TRUE(row.result.error == r.error);
                some++;
            }
        }
        TEST_ASSERT_TRUE(lower_Hz == want);
    }
    TEST_ASSERT_TRUE(some > 3);
    priced_close(&p);
}

/* --- tables ----------------------------------------------------------------------------------------------*/

static int progress_told;
static void tell_progress(void *context, int done, int of) {
    (void)context;
    TEST_ASSERT_EQUAL_INT(progress_told, done);
    TEST_ASSERT_TRUE(done < of);
    progress_told++;
}

/* Each setting by the steps of the ladder until two in a row took off less than three tenths of the error. */
static void test_tables_have_all_steps_that_help(void) {
    priced p;
    begin(&p, "mps2-an385");
    const table_wish w = {.operations = 3e7, .progress = tell_progress};
    progress_told = 0;
    table *made = table_new(&p.trial, &w);
    TEST_ASSERT_FALSE(made->counted);
    int rows = 0;
    int coarse = 0;
    int known_settings = 0;
    for (int i = 0; i < SETTINGS; i++) {
        const setting s = priced_tried(i);
        int stalled = 0;
        double before = (double)INFINITY;
        for (int rung = 0; rung < TABLE_LADDER && stalled < 2; rung++) {
            const deviation_pace pace = table_ladder(rung);
            if (pace.records > RECORDS) {
                continue;
            }
            bool own;
            bool known;
            const cost c = trial_cost(&p.trial, &s, table_ladder(TABLE_COARSEST), &own);
            const table_price price =
                table_price_of(&c, ratio_times(1, trial_step(&p.trial, pace)), &known);
            if (!known) {
                break;
            }
            known_settings += rung == TABLE_COARSEST;
            const double started = p.trial.operations;
            const trial_result r = trial_run(&p.trial, &s, pace);
            coarse += !r.usable;
            int found = 0;
            for (int k = 0; k < made->count; k++) {
                const table_row *row = &made->row[k];
                found += row->setting.image.method == s.image.method &&
                         row->setting.number == s.number && row->pace.steps == pace.steps &&
                         row->pace.records == pace.records && row->result.error == r.error &&
                         row->price.value == price.value && row->price.unit == price.unit;
            }
            TEST_ASSERT_EQUAL_INT(r.usable, found);
            rows += found;
            if (r.usable) {
                stalled = r.error > 0.7 * before ? stalled + 1 : 0;
                before = fmin(before, r.error);
            }
            if ((p.trial.operations - started) * 2.5 > w.operations / (2.0 * made->settings)) {
                break;
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(rows, made->count);
    TEST_ASSERT_EQUAL_INT(coarse, made->coarse);
    TEST_ASSERT_TRUE(known_settings >= 3 && made->unpriced == made->settings - known_settings);
    TEST_ASSERT_EQUAL_INT(made->settings, progress_told);
    TEST_ASSERT_EQUAL_STRING("there is no image of it", made->why);
    for (int i = 1; i < made->count; i++) {
        TEST_ASSERT_TRUE(made->row[i - 1].price.value <= made->row[i].price.value);
    }
    /* numbered as they were tried */
    bool numbered[SETTINGS * TABLE_LADDER] = {false};
    for (int i = 0; i < made->count; i++) {
        const int order = made->row[i].order;
        TEST_ASSERT_TRUE(order >= 0 && order < made->count && !numbered[order]);
        numbered[order] = true;
    }
    table_free(made);
    table_free(NULL);
    priced_close(&p);
}

/* What has contacts has no price: its rows are by the evaluations of their runs. */
static void test_tables_without_a_price_are_by_evaluations(void) {
    priced p;
    priced_open(&p, priced_ball, 1);
    p.takes = priced_is_tried;
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", (whole_ratio){1, 20}, RECORDS, NULL));
    const table_wish w = {.operations = 1e5};
    table *made = table_new(&p.trial, &w);
    if (made->counted) {
        for (int i = 0; i < made->count; i++) {
            const table_row *row = &made->row[i];
            const trial_result r = trial_run(&p.trial, &row->setting, row->pace);
            TEST_ASSERT_EQUAL_INT(PRICE_EVALUATIONS, row->price.unit);
            TEST_ASSERT_EQUAL_INT(COST_MEASURED, row->price.basis);
            TEST_ASSERT_TRUE(row->price.value == r.evaluations && r.error == row->result.error);
            TEST_ASSERT_TRUE(row->price.least == r.evaluations && row->price.most == r.evaluations);
        }
        TEST_ASSERT_TRUE(made->count > 6);
    }
    printf("  a ball: %d rows%s\n", made->count, made->counted ? ", by evaluations" : "");
    TEST_ASSERT_TRUE(made->count > 0);
    table_free(made);
    priced_close(&p);
}

static bool is_fixed_and_fine(const setting *s, double step_s) {
    return setting_is_fixed(s) && (step_s == 0.0 || step_s < 0.02);
}

/* In fixed point a step may be too long: each of these is one of those that were too coarse, and no more is tried of it. */
static void test_steps_too_long_for_fixed_point_are_left_out(void) {
    static const char *const texts[] = {
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 40 [N/m]*x^2/2 + 9 [N/m^3]*x^4/4\n"
        "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
        "range x = -2 .. 2 [m], x' = -20 .. 20 [m/s] }\n"};
    priced p;
    priced_open(&p, texts, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an385", (whole_ratio){1, 20}, RECORDS, NULL));
    p.takes = is_fixed_and_fine;
    const table_wish w = {.operations = 1e8};
    table_free(table_new(&p.trial, &w)); /* images that were made are kept */
    const long before = blocks_in_use();
    table_free(table_new(&p.trial, &w));
    TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
    table *made = table_new(&p.trial, &w);
    int refused = 0;
    int coarsest = 1000;
    for (int rung = 0; rung < TABLE_LADDER; rung++) {
        const deviation_pace pace = table_ladder(rung);
        const double step_s = ratio_times(1, trial_step(&p.trial, pace));
        refused += pace.records <= RECORDS && step_s >= 0.02;
        coarsest = step_s < 0.02 && rung < coarsest ? rung : coarsest;
    }
    TEST_ASSERT_TRUE(refused > 3 && made->count > 1);
    TEST_ASSERT_EQUAL_INT(refused, made->coarse);
    double step_s = 0.0;
    for (int i = 0; i < made->count; i++) {
        TEST_ASSERT_TRUE(setting_is_fixed(&made->row[i].setting));
        const double own_s = ratio_times(1, trial_step(&p.trial, made->row[i].pace));
        step_s = fmax(step_s, own_s);
        /* its price is that of its own step */
        bool own;
        const cost c = trial_cost(&p.trial, &made->row[i].setting, made->row[i].pace, &own);
        TEST_ASSERT_TRUE(own && near(made->row[i].cost.cycles.value, c.cycles.value));
        TEST_ASSERT_TRUE(near(made->row[i].price.value, c.cycles.value / own_s));
    }
    TEST_ASSERT_TRUE(step_s == ratio_times(1, trial_step(&p.trial, table_ladder(coarsest))));
    table_free(made);
    priced_close(&p);
}

void suite_price_choices(void) {
    RUN_TEST(test_steps_too_long_for_fixed_point_are_left_out);
    RUN_TEST(test_drawn_requests_are_answered_as_by_trying_all);
    RUN_TEST(test_substeps_rise_as_they_are_told);
    RUN_TEST(test_little_effort_leaves_settings);
    RUN_TEST(test_a_lower_rate_keeps_what_it_says);
    RUN_TEST(test_tables_have_all_steps_that_help);
    RUN_TEST(test_tables_without_a_price_are_by_evaluations);
}
