/* test_choice.c: what `whirl choose` chooses, against trying everything: nothing cheaper keeps the error, and where
 * nothing fits, nothing does. Requests are drawn. */
#include "derived.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/pricing_scene.h"
#include "host/price/choice.h"
#include "unity.h"

void suite_choice(void);

static const char *const texts[] = {
    "mechanism spring\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 90 [N/m]*x^2/2\n"
    "F = 0.3 [N*s/m]*x'^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
    "mechanism pendulum\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -20 [J]*cos(a)\n"
    "scene s { start a = 2.5 [rad]; step 1 [ms]; until 1 [s] }\n",
    "mechanism cart\ncoordinate x [m]\ncoordinate a [rad]\ninput u = 2 [N]\n"
    "T = 2 [kg]*x'^2/2 + 0.5 [kg]*((x' + 0.4 [m]*a'*cos(a))^2 + (0.4 [m]*a'*sin(a))^2)/2\n"
    "V = -0.5 [kg]*9.81 [m/s^2]*0.4 [m]*cos(a)\nQ(x) = u\n"
    "scene s { start a = 1 [rad]; step 1 [ms]; until 1 [s] }\n",
    "mechanism decay\nstate y\nequation y' + 4 [1/s]*y + 1 [1/s]*y^3 = 1 [1/s]\n"
    "scene s { start y = 3; step 1 [ms]; until 1 [s] }\n"};
enum { TEXTS = sizeof texts / sizeof texts[0] };

static const char *const boards[] = {"mps2-an386", "atmega328p", "mps2-an385"};

typedef struct request {
    derived d;
    overrides changes;
    grid grid;
    diags *errors;
    pricing_scene *scene;
    trials trial;
    choice_wish wish;
} request;

static void open_request(request *q, const char *text, const char *board, double rate_Hz) {
    *q = (request){.d = derived_scene(text, "s"), .errors = diags_new()};
    derived_expect(&q->d, text);
    q->scene = pricing_scene_new(q->d.model->mechanisms[0], q->d.model->scenes[0], &q->changes,
                                 &q->grid, q->errors);
    const trial_wish wish = {.source = &q->scene->source,
                             .board = cost_board_named(board),
                             .spacing = ratio_of(1.0 / rate_Hz),
                             .records = (int)(rate_Hz + 0.5)};
    TEST_ASSERT_TRUE(trial_begin(&q->trial, &wish));
    TEST_ASSERT_TRUE(q->trial.reliable);
    q->wish = (choice_wish){.rate_Hz = rate_Hz, .periods = 1, .operations = 2e8};
}

static void close_request(request *q) {
    trial_end(&q->trial);
    pricing_scene_free(q->scene);
    diags_free(q->errors);
    derived_free(&q->d);
}

/* Does this setting keep everything with so many steps in a period? Its price in *worst: the longest steps' cycles a
 * second, the most promised. By itself: nothing of host/price/choice.c takes part. */
static bool keeps(request *q, const setting *s, uint64_t substeps, double *worst) {
    bool own;
    const deviation_pace pace = {substeps, 1};
    const cost c = trial_cost(&q->trial, s, pace, &own);
    const cost_figure *f =
        c.cycles_worst.basis != COST_NOT_KNOWN ? &c.cycles_worst : &c.instructions_worst;
    *worst = f->most * (double)substeps * q->wish.rate_Hz;
    if (!own || c.instructions_worst.basis == COST_NOT_KNOWN ||
        (q->wish.clock_Hz > 0.0 && *worst > q->wish.clock_Hz) ||
        (q->wish.flash_bytes > 0.0 && c.flash_bytes.most > q->wish.flash_bytes) ||
        (q->wish.ram_bytes > 0.0 && c.ram_bytes.most + c.stack_bytes.most > q->wish.ram_bytes)) {
        return false;
    }
    const trial_result r = trial_run(&q->trial, s, pace);
    return r.ran && r.usable && 2.0 * r.error <= q->wish.error;
}

enum { SUBSTEPS_MOST = 40 };

/* All settings and substeps below a price: how many keep everything? */
static int kept_below(request *q, double price) {
    int kept = 0;
    for (int i = 0; i < setting_count(); i++) {
        const setting s = setting_at(i);
        for (int k = 0; k < CHOICE_SUBSTEPS && choice_substeps(k) <= SUBSTEPS_MOST; k++) {
            bool own;
            double worst;
            const deviation_pace pace = {choice_substeps(k), 1};
            const cost c = trial_cost(&q->trial, &s, pace, &own);
            const cost_figure *f =
                c.cycles_worst.basis != COST_NOT_KNOWN ? &c.cycles_worst : &c.instructions_worst;
            if (!own || f->most * (double)pace.steps * q->wish.rate_Hz >= price * (1.0 - 1e-12)) {
                break;
            }
            kept += keeps(q, &s, choice_substeps(k), &worst) ? 1 : 0;
        }
    }
    return kept;
}

static void test_drawn_requests(void) {
    dice d = dice_of("choice", 501);
    const unsigned cases = dice_cases(few_or_all(4, 60));
    int found = 0;
    int limited[CHOICE_LIMITS] = {0};
    for (unsigned n = 0; n < cases; n++) {
        static const double rates[] = {20.0, 50.0, 80.0, 100.0};
        request q;
        const char *text = texts[dice_one_of(&d, TEXTS)];
        const char *board = boards[dice_one_of(&d, 3)];
        open_request(&q, text, board, rates[dice_one_of(&d, 4)]);
        q.wish.error = pow(10.0, dice_between(&d, -5.0, -1.0));
        q.wish.clock_Hz = dice_one_of(&d, 3) == 0 ? 0.0 : pow(10.0, dice_between(&d, 3.5, 7.0));
        q.wish.flash_bytes = dice_one_of(&d, 3) == 0 ? dice_between(&d, 4000.0, 9000.0) : 0.0;
        q.wish.ram_bytes = dice_one_of(&d, 4) == 0 ? dice_between(&d, 200.0, 700.0) : 0.0;
        const choice c = choice_make(&q.trial, &q.wish);
        char what[200];
        snprintf(what, sizeof what, "case %u: %.20s on %s, error %.3g, %g Hz, clock %g, flash %g",
                 n, text, board, q.wish.error, q.wish.rate_Hz, q.wish.clock_Hz, q.wish.flash_bytes);
        if (c.found) {
            double worst;
            found++;
            TEST_ASSERT_TRUE_MESSAGE(keeps(&q, &c.best.setting, c.best.substeps, &worst), what);
            TEST_ASSERT_TRUE_MESSAGE(worst == c.best.worst || fabs(worst / c.best.worst - 1) < 1e-9,
                                     what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, kept_below(&q, c.best.worst), what);
            if (c.has_second) {
                TEST_ASSERT_TRUE_MESSAGE(keeps(&q, &c.second.setting, c.second.substeps, &worst),
                                         what);
                TEST_ASSERT_TRUE_MESSAGE(c.second.worst >= c.best.worst, what);
            }
        } else if (q.wish.clock_Hz > 0.0) { /* without a clock, any number of substeps would do */
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, kept_below(&q, q.wish.clock_Hz), what);
            for (int i = 0; i < CHOICE_LIMITS; i++) {
                limited[i] += c.failed[i] > 0 ? 1 : 0;
            }
        }
        close_request(&q);
    }
    printf("  %u requests, %d with an answer; none by: error %d, load %d, flash %d, RAM %d\n",
           cases, found, limited[CHOICE_ERROR], limited[CHOICE_LOAD], limited[CHOICE_FLASH],
           limited[CHOICE_RAM]);
    TEST_ASSERT_TRUE(found > 0 && found < (int)cases); /* both happen */
}

/* What would fit, does: a weaker error, a faster chip. */
static void test_what_would_fit_does(void) {
    request q;
    open_request(&q, texts[1], "atmega328p", 100.0);
    q.wish.error = 1e-5;
    q.wish.clock_Hz = 1e6;
    choice c = choice_make(&q.trial, &q.wish);
    TEST_ASSERT_FALSE(c.found);
    TEST_ASSERT_TRUE(c.failed[CHOICE_LOAD] > 0 || c.failed[CHOICE_ERROR] > 0);
    if (c.has_weaker) {
        choice_wish w = q.wish;
        w.error = CHOICE_MARGIN * c.weaker.result.error * (1.0 + 1e-9);
        TEST_ASSERT_TRUE_MESSAGE(choice_make(&q.trial, &w).found, "a weaker error");
        w.error *= 0.98;
        TEST_ASSERT_FALSE_MESSAGE(choice_make(&q.trial, &w).found, "and none that is less weak");
    }
    TEST_ASSERT_TRUE(c.has_dearer);
    choice_wish w = q.wish;
    w.clock_Hz = q.wish.clock_Hz * c.dearer.load_most * (1.0 + 1e-9);
    TEST_ASSERT_TRUE_MESSAGE(choice_make(&q.trial, &w).found, "a faster chip");
    w.clock_Hz *= 0.98;
    TEST_ASSERT_FALSE_MESSAGE(choice_make(&q.trial, &w).found, "and none that is less fast");
    close_request(&q);
}

static void test_settings_are_all_others(void) {
    for (int i = 0; i < setting_count(); i++) {
        char one[SETTING_TEXT];
        char other[SETTING_TEXT];
        const setting s = setting_at(i);
        setting_options(&s, true, one);
        for (int k = 0; k < i; k++) {
            const setting before = setting_at(k);
            TEST_ASSERT_TRUE_MESSAGE(strcmp(one, setting_options(&before, true, other)) != 0, one);
        }
        for (int k = 0; k < AXES; k++) {
            TEST_ASSERT_NOT_NULL(setting_word(&s, (setting_axis)k));
            TEST_ASSERT_NOT_NULL(setting_heading((setting_axis)k));
        }
    }
    for (int i = 1; i < CHOICE_SUBSTEPS; i++) {
        TEST_ASSERT_TRUE(choice_substeps(i) > choice_substeps(i - 1));
    }
}

/* Steps as text come back as the same fraction, whatever the rate. */
static void test_times_come_back(void) {
    dice d = dice_of("choice times", 502);
    for (int i = 0; i < 3000; i++) {
        whole_ratio time = {1 + dice_one_of(&d, 500), 1 + dice_one_of(&d, 100000)};
        char text[TRIAL_TIME];
        time = ratio_of((double)time.numerator / (double)time.denominator);
        const whole_ratio again = ratio_of(strtod(trial_time(time, text), NULL));
        TEST_ASSERT_TRUE_MESSAGE(
            again.numerator == time.numerator && again.denominator == time.denominator, text);
    }
}

void suite_choice(void) {
    RUN_TEST(test_settings_are_all_others);
    RUN_TEST(test_times_come_back);
    RUN_TEST(test_drawn_requests);
    RUN_TEST(test_what_would_fit_does);
}
