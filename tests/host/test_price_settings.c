/* test_price_settings.c: the settings that have a price (host/study/trial.h): their number, sequence and options. Also references and trials. */
#include "host/cli/options.h"
#include "host/fixed/engine_fixed.h"
#include "host/os/system.h"
#include "host/study/reference_run.h"

#include "command.h"
#include "derived.h"
#include "priced.h"

/* === suite price_settings ===================================================================== */

/* Every method with three number types: sines are rotated, looked up, or in one of six tables, or the step is one of
 * two matrices. In addition fixed point. */
TEST(price_settings, every_setting_exists_once) {
    const int count = setting_count();
    TEST_ASSERT_EQUAL_INT(3 * (WH_METHODS * (2 + 6) + 2) + 1, count);
    int before = -1;
    int matrices = 0;
    int in_fixed = 0;
    int looked_up = 0;
    for (int i = 0; i < count; i++) {
        const setting s = setting_at(i);
        const image_settings *m = &s.image;
        const bool plain = m->angles == ANGLES_TURNED && m->tables == TABLES_NONE;
        TEST_ASSERT_GREATER_THAN_INT(before, setting_order(&s));
        before = setting_order(&s);
        TEST_ASSERT_TRUE(m->matrix == MATRIX_NONE || (m->method == WH_RK4 && plain));
        TEST_ASSERT_TRUE(m->tables == TABLES_NONE || m->angles == ANGLES_TURNED);
        matrices += m->matrix != MATRIX_NONE;
        looked_up += m->angles == ANGLES_LOOKUP;
        in_fixed += s.number == &engine_fixed;
        TEST_ASSERT_TRUE(s.number != &engine_fixed ||
                         (m->method == WH_RK4 && plain && m->matrix == MATRIX_NONE));
        TEST_ASSERT_EQUAL_INT(s.number == &engine_fixed, setting_is_fixed(&s));
        TEST_ASSERT_EQUAL_INT(s.number == &engine_fixed || m->matrix != MATRIX_NONE,
                              setting_price_varies(&s));
        TEST_ASSERT_EQUAL_INT(m->matrix != MATRIX_NONE || m->tables != TABLES_NONE,
                              setting_may_be_refused(m));
    }
    TEST_ASSERT_EQUAL_INT(6, matrices);
    TEST_ASSERT_EQUAL_INT(1, in_fixed);
    TEST_ASSERT_EQUAL_INT(3 * WH_METHODS, looked_up);
}

/* Reads a setting in the way that `whirl run` reads its command line. */
static setting read_back(const char *text, int *count) {
    char copy[SETTING_TEXT];
    char *words[16];
    common_options o = options_defaults();
    bool bad = false;
    *count = 0;
    snprintf(copy, sizeof copy, "%s", text);
    for (char *word = strtok(copy, " "); word != NULL; word = strtok(NULL, " ")) {
        words[(*count)++] = word;
    }
    for (int at = 0; at < *count;) {
        const bool taken =
            options_take("run", OPTIONS_ENGINE | OPTIONS_NUMBER, *count, words, &at, &o, &bad);
        TEST_ASSERT_TRUE_MESSAGE(taken && !bad, text);
    }
    const setting s = {o.integration, o.number};
    options_forget(&o);
    return s;
}

TEST(price_settings, options_describe_the_setting_exactly) {
    for (int i = 0; i < setting_count(); i++) {
        const setting s = setting_at(i);
        const image_settings *m = &s.image;
        char text[SETTING_TEXT];
        int words;
        /* number of words without the number type, as for `whirl derive` */
        const int least = 2 + (m->compensated ? 1 : 0) + 2 * (m->angles != ANGLES_TURNED) +
                          2 * (m->tables != TABLES_NONE) + 2 * (m->cells > 0);
        TEST_ASSERT_EQUAL_PTR(text, setting_options(&s, true, text));
        const setting again = read_back(text, &words);
        TEST_ASSERT_EQUAL_INT_MESSAGE(setting_order(&s), setting_order(&again), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(least + 2 * (s.number != &engine_double), words, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(m->matrix == MATRIX_NONE, strstr(text, "--method") != NULL,
                                      text);
        setting derived_so = read_back(setting_options(&s, false, text), &words);
        derived_so.number = s.number;
        TEST_ASSERT_EQUAL_INT_MESSAGE(setting_order(&s), setting_order(&derived_so), text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(least, words, text);
        TEST_ASSERT_EQUAL_STRING(s.number == &engine_fixed ? " --number fixed" : "",
                                 setting_form(&s));
    }
}

/* === suite price_states ======================================================================= */
/* The columns and the horizon of a reference (host/study/reference_run.h), and their report. */

/* Largest values by a loop. Outputs and columns that stay zero do not count. */
static void expect_columns(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        double largest = 0.0;
        for (int i = 0; i <= r->records; i++) {
            largest = fmax(largest, fabs(r->row[(size_t)i * (size_t)r->columns + (size_t)k]));
        }
        const reference_column *c = &r->column[k];
        TEST_ASSERT_TRUE(c->largest == largest);
        TEST_ASSERT_TRUE(c->off >= 0.0);
        TEST_ASSERT_TRUE(!c->counts || (largest > 0.0 && r->shape->column[k].unknown >= 0));
        TEST_ASSERT_TRUE(!c->counts || c->off <= r->limit * largest);
    }
}

static reference *reference_to(const image *im, int count, double operations) {
    const reference_request w = {
        .image = im, .spacing = {1, 20}, .records = count, .operations = operations};
    return reference_new(&w);
}

typedef struct kind_row {
    const char *text;
    double operations;
    bool reliable;
    int least, most; /* least and greatest number of records */
    const char *why; /* words in the reason for an early end; NULL: no reason */
} kind_row;

#define SCENE(start) "scene s { " start "step 1 [ms]; until 1 [s] }\n"
static const kind_row kind_rows[] = {
    {"mechanism m\ncoordinate x [m]\noutput twice [m] = 2*x\nT = 1 [kg]*x'^2/2\n"
     "V = 40 [N/m]*x^2/2\n" SCENE("start x = 0.02 [m];"),
     1e8, true, 20, 20, NULL},
    /* a solution with a pole at 0.52 s */
    {"mechanism m\nstate y\nequation y' = 1 [1/s]*y^2\n" SCENE("start y = 1.923076923;"), 1e8, true,
     9, 10, " after 0."},
    /* rest at zero, and rest at another position */
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 40 [N/m]*x^2/2\n" SCENE(""), 1e8, false,
     0, 20, "nothing moves"},
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n" SCENE("start x = 2 [m];"), 1e8, true, 20,
     20, NULL},
    /* a scene with a contact, and one with a jump */
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [kg]*9.81 [m/s^2]*x\n"
     "stop x >= 0 [m] restitution 0.5\n" SCENE("start x = 0.5 [m];"),
     1e8, true, 1, 20, ""},
    {"mechanism m\nstate y\nstate z\nequation y' = 1 [1/s]*atan2(z - 0.47, -1)\n"
     "equation z' = 1 [1/s]\n" SCENE("start y = 1000;"),
     1e8, true, 9, 20, ""},
    /* the allowed operations do not suffice for steps that are short enough */
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 4000 [N/m]*x^2/2\n" SCENE(
         "start x = 0.02 [m];"),
     1500.0, false, 0, 20, "the two references differ by more than"}};

TEST(price_states, references_have_their_trusted_time) {
    for (size_t n = 0; n < sizeof kind_rows / sizeof kind_rows[0]; n++) {
        const kind_row *row = &kind_rows[n];
        derived d = derived_surely(derived_scene(row->text, "s"), row->text);
        reference *r = reference_to(d.image, 20, row->operations);
        TEST_ASSERT_EQUAL_INT_MESSAGE(row->reliable, r->reliable, row->text);
        TEST_ASSERT_TRUE_MESSAGE(r->records >= row->least && r->records <= row->most, row->text);
        TEST_ASSERT_EQUAL_INT(20, r->wanted);
        TEST_ASSERT_FALSE(r->stopped);
        TEST_ASSERT_NOT_NULL(
            strstr(r->how, "nystroem5 in double with compensated sums and steps of "));
        TEST_ASSERT_TRUE_MESSAGE(row->why != NULL || r->why == NULL, row->text);
        TEST_ASSERT_TRUE_MESSAGE(
            row->why == NULL || row->why[0] == '\0' || strstr(r->why, row->why) != NULL, row->text);
        expect_columns(r);
        reference_cut(r, r->records + 1); /* cuts nothing */
        expect_columns(r);
        reference_cut(r, r->records / 2);
        expect_columns(r);
        reference_free(r);
        derived_free(&d);
    }
    reference_free(NULL);
}

TEST(price_states, references_are_stopped) {
    derived d = derived_surely(derived_scene(kind_rows[0].text, "s"), "a scene");
    interrupted = 1;
    reference *r = reference_to(d.image, 20, 1e7);
    interrupted = 0;
    TEST_ASSERT_TRUE(r->stopped);
    TEST_ASSERT_EQUAL_INT(0, r->records);
    reference_free(r);
    derived_free(&d);
}

/* === suite price_trials ======================================================================= */
/* Trials of settings (host/study/trial.h): steps as exact fractions, and the worst error and highest cost over all
 * places, compared with each place alone. */

typedef unsigned __int128 wide;

/* Have a and b no common divisor? Euclid's algorithm by subtraction, because the program uses remainders. */
static bool have_no_divisor(uint64_t a, uint64_t b) {
    while (a != b && a != 0 && b != 0) {
        while (a > b && b != 0) {
            const uint64_t times = a / b;
            a -= times > 1 ? (times - 1) * b : b;
        }
        while (b > a && a != 0) {
            const uint64_t times = b / a;
            b -= times > 1 ? (times - 1) * a : a;
        }
    }
    return (a > b ? a : b) == 1;
}

static uint64_t drawn_up_to(dice *d, unsigned bits) {
    return 1 + ((uint64_t)dice_one_of(d, 1U << 30U) << 30U | dice_one_of(d, 1U << 30U)) %
                   ((UINT64_C(1) << (1U + dice_one_of(d, bits))) - 1U);
}

/* The step must be spacing * records / steps in lowest terms. If 64 bits are too few, it must be the nearest double. */
TEST(price_trials, steps_are_exact) {
    dice d = dice_of("price_trials steps", 11);
    int exact = 0;
    int rounded = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(3000, 300000)); n++) {
        trials t = {.request.spacing = {drawn_up_to(&d, 50), drawn_up_to(&d, 59)}};
        const deviation_pace pace =
            dice_one_of(&d, 2) == 0 ? (deviation_pace){1, drawn_up_to(&d, 30)}
                                    : (deviation_pace){drawn_up_to(&d, n % 2 == 0 ? 10 : 40), 1};
        const whole_ratio s = t.request.spacing;
        if (!have_no_divisor(s.numerator, s.denominator)) {
            continue;
        }
        const wide left = (wide)s.numerator * pace.records;
        const wide right = (wide)s.denominator * pace.steps;
        const bool fits = left >> 64U == 0 && right >> 64U == 0;
        const double value = (double)left / (double)right;
        if (value < 1e-12 || value > 1e12) {
            continue; /* no steps: not tested */
        }
        const whole_ratio step = trial_step(&t, pace);
        if (fits) {
            TEST_ASSERT_TRUE(left % step.numerator == 0 && right % step.denominator == 0 &&
                             left / step.numerator == right / step.denominator);
            TEST_ASSERT_TRUE(have_no_divisor(step.numerator, step.denominator));
            exact++;
        } else {
            rounded++;
        }
        TEST_ASSERT_TRUE(fabs(ratio_times(1, step) / value - 1.0) < 1e-14);
    }
    printf("  %d steps exact, %d that may be rounded\n", exact, rounded);
    TEST_ASSERT_TRUE(exact > 300 && rounded > 30);
}

/* The text of a step must bring back the same fraction. */
TEST(price_trials, steps_are_read_back) {
    dice d = dice_of("price_trials times", 12);
    for (unsigned n = 0; n < dice_cases(few_or_all(400, 100000)); n++) {
        const whole_ratio time = ratio_of((double)(1 + dice_one_of(&d, 500)) /
                                          (double)(1 + dice_one_of(&d, n % 2 == 0 ? 40 : 99999)));
        const trials t = {.request.spacing = time};
        char text[NUMBER_SIZE];
        TEST_ASSERT_EQUAL_PTR(text, trial_step_text(&t, (deviation_pace){1, 1}, text));
        const whole_ratio back = ratio_of(strtod(text, NULL));
        TEST_ASSERT_EQUAL_UINT64(time.numerator, back.numerator);
        TEST_ASSERT_EQUAL_UINT64(time.denominator, back.denominator);
    }
}

/* A spring and a pendulum in mm and degrees. The places differ in numbers and operations. */
static const char *const places[] = {
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\noutput twice [mm] = 2*x\n"
    "output heard [mm] = x\nnoise heard deviation 1 [mm] seed 1\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\nV = 9 [N/m]*x^2/2 - 8 [J]*cos(a)\n"
    "scene s { start x = 100 [mm], a = 60 [deg]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\noutput twice [mm] = 2*x\n"
    "output heard [mm] = x\nnoise heard deviation 1 [mm] seed 1\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n"
    "V = 90 [N/m]*x^2/2 + 900 [N/m^3]*x^4/4 + 3 [N/m^2]*x^3 - 20 [J]*cos(a)\n"
    "scene s { start x = 100 [mm], a = 60 [deg]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\noutput twice [mm] = 2*x\n"
    "output heard [mm] = x\nnoise heard deviation 1 [mm] seed 1\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\nV = 30 [N/m]*x^2/2 - 4 [J]*cos(a)\n"
    "scene s { start x = 20 [mm], a = 60 [deg]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 50};
enum { RECORDS = 25 };

TEST(price_trials, operations_are_summed_over_places) {
    priced p;
    priced_open(&p, places, 3);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    const double each = p.trial.image[0]->list[IMAGE_STEP]->count + 1.0;
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    const setting heun = priced_setting(WH_HEUN, &engine_float);
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    const deviation_pace fine = {7, 1};
    const deviation_pace coarse = {1, 5};
    TEST_ASSERT_TRUE(trial_operations(&p.trial, &rk4, fine) == 25.0 * 7.0 * each * 4.0 * 3.0);
    TEST_ASSERT_TRUE(trial_operations(&p.trial, &heun, coarse) == 5.0 * each * 2.0 * 3.0);
    TEST_ASSERT_TRUE(trial_operations(&p.trial, &in_fixed, coarse) == 2 * 5.0 * each * 4.0 * 3.0);
    TEST_ASSERT_TRUE(fabs(trial_horizon_s(&p.trial) - 0.5) < 1e-15);
    char text[NUMBER_SIZE];
    TEST_ASSERT_EQUAL_STRING("0.5", trial_until(&p.trial, text));
    priced_close(&p);
}

TEST(price_trials, errors_have_their_quantitys_unit) {
    static const struct {
        const char *of;
        const char *unit;
        double si; /* an error of 1 `unit` in SI units */
    } rows[] = {{NULL, "", 1.0},       {"x", "mm", 1e-3},
                {"x'", "mm/s", 1e-3},  {"a", "deg", 0.017453292519943295},
                {"twice", "mm", 1e-3}, {"a'", "deg/s", 0.017453292519943295}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        priced p;
        priced_open(&p, places, 1);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, rows[i].of));
        TEST_ASSERT_EQUAL_STRING(rows[i].unit, trial_unit(&p.trial));
        TEST_ASSERT_TRUE(fabs(trial_error_si(&p.trial, 3.0) / (3.0 * rows[i].si) - 1.0) < 1e-14);
        TEST_ASSERT_TRUE(p.trial.what.give_up == 1.0);
        TEST_ASSERT_EQUAL_INT(rows[i].of == NULL, p.trial.what.column < 0);
        if (rows[i].of != NULL) {
            char text[TRIAL_NAME];
            TEST_ASSERT_EQUAL_STRING(rows[i].of, trial_column(&p.trial, p.trial.what.column, text));
        }
        priced_close(&p);
    }
}

/* y' = y^2 becomes infinite at 1/y(0). */
TEST(price_trials, shortest_horizon_counts) {
    static const double from[] = {0.5, 1.25, 0.8};
    for (int turn = 0; turn < 3; turn++) {
        char text[3][200];
        const char *texts[3];
        for (int k = 0; k < 3; k++) {
            snprintf(text[k], sizeof text[k],
                     "mechanism m\nstate y\nequation y' - 1 [1/s]*y^2 = 0 [1/s]\n"
                     "scene s { start y = %g; step 1 [ms]; until 3 [s] }\n",
                     from[(k + turn) % 3]);
            texts[k] = text[k];
        }
        priced p;
        priced_open(&p, texts, 3);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 150, NULL));
        TEST_ASSERT_TRUE(p.trial.reliable);
        TEST_ASSERT_EQUAL_INT((4 - turn) % 3, p.trial.worst);
        /* the pole at 0.8 s is at record 40 */
        TEST_ASSERT_TRUE(p.trial.records >= 37 && p.trial.records < 40);
        for (int k = 0; k < 3; k++) {
            TEST_ASSERT_EQUAL_INT(p.trial.records, p.trial.reference[k]->records);
        }
        priced_close(&p);
    }
}

TEST(price_trials, equally_long_places_least_agreement_counts) {
    priced p;
    priced_open(&p, places, 3);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    TEST_ASSERT_EQUAL_INT(RECORDS, p.trial.records);
    TEST_ASSERT_TRUE(p.trial.reliable && !p.trial.stopped);
    for (int k = 0; k < 3; k++) {
        TEST_ASSERT_TRUE(reference_agreement(p.trial.reference[k], -1) <=
                         reference_agreement(p.trial.reference[p.trial.worst], -1));
    }
    priced_close(&p);
}

static trial_result each_by_itself(priced *p, const setting *s, deviation_pace pace,
                                   double tolerated, int *looked_at) {
    trial_result r = {.ran = true, .usable = true, .error = -1.0};
    for (int k = 0; k < 3 && r.usable; k++) {
        const reference *ref = p->trial.reference[k];
        *looked_at = k + 1;
        char step[NUMBER_SIZE];
        image *im = priced_image(p, k, s, trial_step_text(&p->trial, pace, step));
        deviation_of_what what = {p->trial.what.column, 1.0};
        if (what.column >= 0) {
            what.give_up = fmax(tolerated, ref->column[what.column].largest);
        }
        const deviation d = deviation_measure(ref, im, s->number, pace, what);
        image_free(im);
        const double error = d.error < 10.0 * d.known ? d.error + d.known : d.error;
        if (error > r.error || !(error <= r.error)) {
            r.error = error;
            r.bound = d.error < 10.0 * d.known;
            r.point = k;
            r.column = d.column;
        }
        r.evaluations = fmax(r.evaluations, d.evaluations);
        r.evaluations_most = fmax(r.evaluations_most, d.evaluations_most);
        r.usable = d.usable;
    }
    return r;
}

TEST(price_trials, errors_are_maxima_over_places) {
    static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4, WH_LEAPFROG};
    static const char *const of[] = {NULL, "x", "a'"};
    dice d = dice_of("price_trials errors", 13);
    int usable = 0;
    int useless = 0;
    int bounds = 0;
    int at[3] = {0};
    for (int n = 0; n < 3; n++) {
        priced p;
        priced_open(&p, places, 3);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, of[n]));
        for (unsigned i = 0; i < dice_cases(few_or_all(24, 400)); i++) {
            const setting s =
                priced_setting(methods[dice_one_of(&d, 4)],
                               dice_one_of(&d, 2) == 0 ? &engine_float : &engine_double);
            const deviation_pace pace = {1, i % 3 == 0 ? 5 : 1};
            /* replaces the errors of the references by larger ones */
            for (int k = 0; k < 3; k++) {
                reference *r = p.trial.reference[k];
                for (int c = 1; c < r->columns; c++) {
                    r->column[c].off = r->column[c].largest * pow(10.0, dice_between(&d, -9, -1));
                }
            }
            p.trial.tolerated = dice_one_of(&d, 2) == 0 ? 0.0 : 1e4;
            const int asked = p.asked;
            int looked_at;
            const trial_result r = trial_run(&p.trial, &s, pace);
            const trial_result want = each_by_itself(&p, &s, pace, p.trial.tolerated, &looked_at);
            /* a result that is not useful must be the last */
            TEST_ASSERT_EQUAL_INT(looked_at, p.asked - asked);
            TEST_ASSERT_TRUE(r.ran && r.usable == want.usable && r.bound == want.bound);
            TEST_ASSERT_TRUE(r.error == want.error && r.point == want.point);
            TEST_ASSERT_TRUE(r.column == want.column && r.evaluations == want.evaluations);
            TEST_ASSERT_TRUE(r.evaluations_most == want.evaluations_most);
            usable += r.usable;
            useless += !r.usable;
            bounds += r.bound;
            at[r.point]++;
        }
        priced_close(&p);
    }
    printf("  %d of use, %d of none, %d bounds; worst at %d, %d, %d\n", usable, useless, bounds,
           at[0], at[1], at[2]);
    TEST_ASSERT_TRUE(usable > 0 && useless > 0 && bounds > 0 && at[0] > 0 && at[1] > 0 &&
                     at[2] > 0);
}
