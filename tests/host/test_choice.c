/* test_choice.c: what `whirl choose` chooses, against trying everything: nothing cheaper keeps the error, and where
 * nothing fits, nothing does. Requests are drawn. */
#include "derived.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/base/room.h"
#include "host/commands/pricing_scene.h"
#include "host/emit/emit.h"
#include "host/price/choice.h"
#include "host/run/start.h"
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
enum { SPRING, PENDULUM, CART, TEXTS = sizeof texts / sizeof texts[0] };

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
    q->wish = (choice_wish){.rate_Hz = rate_Hz, .periods = 1, .operations = 8e8};
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

/* All settings and substeps below a price (some settings, but for WHIRL_FULL): how many keep everything? */
static int kept_below(request *q, double price) {
    int kept = 0;
    for (int i = 0; i < setting_count(); i += (int)few_or_all(14, 1)) {
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
    const unsigned cases = dice_cases(few_or_all(3, 20));
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

/* --- what was tried, and what was not ------------------------------------------------------------------*/

/* How many settings keep everything by some number of substeps? By trying all; with fewer cases some, which are no more. */
static int fitting(request *q) {
    int count = 0;
    for (int i = 0; i < setting_count(); i += (int)few_or_all(12, 1)) {
        const setting s = setting_at(i);
        bool fits = false;
        for (int k = 0; k < CHOICE_SUBSTEPS && choice_substeps(k) <= SUBSTEPS_MOST && !fits; k++) {
            double worst;
            fits = keeps(q, &s, choice_substeps(k), &worst);
        }
        count += fits;
    }
    return count;
}

static int left_of(const choice *c) {
    int count = 0;
    for (int i = 0; i < CHOICE_LEFTS; i++) {
        count += c->left[i];
    }
    return count;
}

/* Prices that are predicted are those of the step that is told: constants of one length of it may be alike, and those of
 * another not. */
static void test_a_price_is_that_of_its_own_step(void) {
    dice d = dice_of("choice own steps", 505);
    const unsigned cases = dice_cases(few_or_all(2, 20));
    int others = 0; /* cost something else by the coarsest step */
    for (unsigned n = 0; n < cases; n++) {
        request q;
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism decay\nstate y\nequation y' + %u [1/s]*y + %u [1/s]*y^3 = %u [1/s]\n"
                 "scene s { start y = 3; step 1 [ms]; until 1 [s] }\n",
                 1 + dice_one_of(&d, 5), 1 + dice_one_of(&d, 2), 1 + dice_one_of(&d, 2));
        open_request(&q, text, boards[dice_one_of(&d, 3)], 10.0 * (1 + dice_one_of(&d, 10)));
        q.wish.error = pow(10.0, dice_between(&d, -5.0, -1.0));
        const choice c = choice_make(&q.trial, &q.wish);
        if (c.found) {
            double worst;
            double coarsest;
            (void)keeps(&q, &c.best.setting, 1, &coarsest);
            TEST_ASSERT_TRUE_MESSAGE(keeps(&q, &c.best.setting, c.best.substeps, &worst), text);
            TEST_ASSERT_TRUE_MESSAGE(fabs(worst / c.best.worst - 1.0) < 1e-9, text);
            others += !setting_price_varies(&c.best.setting) &&
                      fabs(coarsest * (double)c.best.substeps / worst - 1.0) > 1e-9;
        }
        close_request(&q);
    }
    printf("  %u requests, %d of another price by the coarsest step\n", cases, others);
    TEST_ASSERT_TRUE(others > 0);
}

/* With whatever effort, each setting is without a price, tried or left, and what fits and was not found is among those left: so
 * nothing is left where it is said that nothing fits. */
static void test_what_fits_and_is_not_found_was_left(void) {
    dice d = dice_of("choice efforts", 504);
    const unsigned cases = dice_cases(few_or_all(3, 8));
    int missed = 0; /* nothing found, though something fits */
    int proved = 0;
    int some = 0; /* nothing found of some that were tried, and others left */
    for (unsigned n = 0; n < cases; n++) {
        request q;
        const char *text = texts[dice_one_of(&d, TEXTS)];
        open_request(&q, text, boards[dice_one_of(&d, 3)], 20.0);
        q.wish.error = pow(10.0, dice_between(&d, -4.0, -1.5));
        static const double decade[] = {6.0, 3.5, 4.5};
        q.wish.clock_Hz = pow(10.0, decade[n % 3] + dice_between(&d, 0.0, 1.0));
        q.wish.flash_bytes = n % 4 == 3 ? dice_between(&d, 3000.0, 9000.0) : 0.0;
        const int fit = fitting(&q);
        for (int power = 0; power < 10; power++) {
            const double operations = 1e3 * pow(4.0, power);
            q.wish.operations = operations;
            const choice c = choice_make(&q.trial, &q.wish);
            const int left = left_of(&c);
            char what[200];
            snprintf(what, sizeof what, "case %u, %g operations: %d settings fit, %d are left", n,
                     operations, fit, left);
            TEST_ASSERT_EQUAL_INT_MESSAGE(c.settings, c.unpriced + c.tried + left, what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(c.unpriced + left, choice_not_tried(&c), what);
            TEST_ASSERT_TRUE_MESSAGE(c.found || fit <= left, what);
            missed += !c.found && fit > 0;
            proved += !c.found && left == 0;
            some += !c.found && left > 0 && c.tried > 0;
        }
        close_request(&q);
    }
    printf("  %d answers missed what fits, and said what they left; %d proved that nothing fits; "
           "%d by some of the settings\n",
           missed, proved, some);
    TEST_ASSERT_TRUE(missed > 0 && proved > 0 && some > 0); /* all happen */
}

/* What would fit, does: a weaker error, a faster chip. */
static void test_what_would_fit_does(void) {
    request q;
    open_request(&q, texts[1], "atmega328p", 100.0);
    q.wish.error = 1e-5;
    q.wish.clock_Hz = 2e5;
    trial_memo memo = {.count = 0}; /* the same trials, judged anew */
    q.wish.memo = &memo;
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
    trial_memo_free(&memo);
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

/* --- which settings a scene has ------------------------------------------------------------------------*/

/* The code that a setting of this scene becomes; NULL: it does not take it. To be freed. */
static char *code_of(const request *q, const setting *s, bool *own) {
    char *text;
    size_t length;
    image *im = q->scene->source.make(q->scene, 0, s, NULL, NULL);
    *own = im != NULL && setting_is_own(s, im);
    if (im == NULL) {
        return NULL;
    }
    FILE *out = room_text(&text, &length);
    emit_c(out, im, "a file");
    room_text_end(out);
    image_free(im);
    return text;
}

/* Of what a scene takes, a setting is its own where no other makes the same code, and one of each that do. */
static void test_settings_of_a_scene_are_those_that_differ(void) {
    for (int n = 0; n < TEXTS; n++) {
        request q;
        open_request(&q, texts[n], "mps2-an386", 20.0);
        const int count = setting_count();
        char **code = room(count, sizeof *code);
        bool *own = room(count, sizeof *own);
        int kinds[3] = {0};
        for (int i = 0; i < count; i++) {
            const setting s = setting_at(i);
            code[i] = code_of(&q, &s, &own[i]);
            kinds[0] += own[i];
            kinds[1] += own[i] && s.image.matrix != MATRIX_NONE;
            kinds[2] += own[i] && s.image.tables != TABLES_NONE;
        }
        for (int i = 0; i < count; i++) {
            const setting s = setting_at(i);
            int same = 0;
            for (int k = 0; k < count && code[i] != NULL; k++) {
                const setting other = setting_at(k);
                same +=
                    k != i && own[k] && other.number == s.number && strcmp(code[i], code[k]) == 0;
            }
            char options[SETTING_TEXT];
            setting_options(&s, true, options);
            diags *unsaid = diags_new();
            image *im = code[i] == NULL ? NULL : q.scene->source.make(q.scene, 0, &s, NULL, NULL);
            const bool takes = im != NULL && start_has_method(im, s.image.method, unsaid);
            TEST_ASSERT_EQUAL_INT_MESSAGE(own[i] || !takes ? 0 : 1, same, options);
            TEST_ASSERT_TRUE_MESSAGE(takes || !own[i], options);
            image_free(im);
            diags_free(unsaid);
        }
        for (int i = 0; i < count; i++) {
            free(code[i]);
        }
        free(code);
        free(own);
        printf("  %.20s: %d settings, %d matrices, %d with tables\n", texts[n], kinds[0], kinds[1],
               kinds[2]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(n == SPRING ? 2 * 3 : 0, kinds[1], texts[n]);
        TEST_ASSERT_TRUE_MESSAGE((n == PENDULUM || n == CART) == (kinds[2] > 0), texts[n]);
        close_request(&q);
    }
}

/* --- matrices and tables on the front ------------------------------------------------------------------*/

/* Is another row in the table as cheap as this one, and errs no more? */
static bool is_beaten(const table *made, const table_row *row) {
    for (int i = 0; i < made->count; i++) {
        const table_row *other = &made->row[i];
        if (other != row && other->price.value <= row->price.value &&
            other->result.error <= row->result.error) {
            return true;
        }
    }
    return false;
}

/* Springs and dampers at random. The exact matrix errs by rounding alone, by any step: the cheapest row that errs by less than
 * 1e-4 is one, and wherever no other row beats one it is on the front. */
static void test_linear_scenes_have_the_matrix_on_their_front(void) {
    dice d = dice_of("choice linear", 503);
    for (unsigned n = 0; n < dice_cases(few_or_all(1, 10)); n++) {
        char text[700];
        snprintf(text, sizeof text,
                 "mechanism row\ncoordinate x [m]\ncoordinate y [m]\n"
                 "T = %.3f [kg]*x'^2/2 + %.3f [kg]*y'^2/2\n"
                 "V = %.3f [N/m]*x^2/2 + %.3f [N/m]*(x - y)^2/2 - 1 [N]*y\n"
                 "F = %.3f [N*s/m]*y'^2/2\n"
                 "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
                 dice_between(&d, 0.5, 4.0), dice_between(&d, 0.5, 4.0), dice_between(&d, 20, 90),
                 dice_between(&d, 20, 90), dice_between(&d, 0.0, 1.0));
        request q;
        open_request(&q, text, boards[dice_one_of(&d, 3)], 500.0);
        const table_wish wish = {.operations = 3e6};
        table *made = table_new(&q.trial, &wish);
        const table_row *cheapest = NULL;
        int matrices = 0;
        int on_front = 0;
        TEST_ASSERT_FALSE_MESSAGE(made->counted, text);
        for (int i = 0; i < made->count; i++) {
            const table_row *row = &made->row[i];
            const bool matrix = row->setting.image.matrix == MATRIX_EXACT;
            matrices += matrix;
            on_front += matrix && row->on_front;
            TEST_ASSERT_TRUE_MESSAGE(row->setting.image.tables == TABLES_NONE, text);
            TEST_ASSERT_TRUE_MESSAGE(!matrix || row->on_front || is_beaten(made, row), text);
            TEST_ASSERT_TRUE_MESSAGE(!matrix || row->result.error < 1e-3, text);
            /* in fixed point a step without an FPU may cost a third of a matrix' */
            if (row->result.error < 1e-4 && !setting_is_fixed(&row->setting) &&
                (cheapest == NULL || row->price.value < cheapest->price.value)) {
                cheapest = row;
            }
        }
        printf("  %d rows, %d of the exact matrix, %d of them on the front\n", made->count,
               matrices, on_front);
        TEST_ASSERT_TRUE_MESSAGE(matrices >= 3 && on_front > 0, text);
        TEST_ASSERT_NOT_NULL_MESSAGE(cheapest, text);
        TEST_ASSERT_TRUE_MESSAGE(cheapest->setting.image.matrix == MATRIX_EXACT, text);
        table_free(made);
        close_request(&q);
    }
}

void suite_choice(void) {
    RUN_TEST(test_settings_of_a_scene_are_those_that_differ);
    RUN_TEST(test_linear_scenes_have_the_matrix_on_their_front);
    RUN_TEST(test_settings_are_all_others);
    RUN_TEST(test_times_come_back);
    RUN_TEST(test_drawn_requests);
    RUN_TEST(test_a_price_is_that_of_its_own_step);
    RUN_TEST(test_what_fits_and_is_not_found_was_left);
    if (few_or_all(0, 1) != 0) { /* the same calls are in the tests above */
        RUN_TEST(test_what_would_fit_does);
    }
}
