/* test_price_chosen.c: choices in words (host/price/choice_text.h), of made-up ones, read back. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "caught.h"
#include "command.h"
#include "host/base/room.h"
#include "host/price/choice_text.h"
#include "host/price/figure_text.h"
#include "priced.h"
#include "unity.h"

void suite_price_chosen(void);

static const char *const places[] = {
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 16 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 50};
static const table_words words = {"f.whirl:s", " --set m=3", false};
enum { RECORDS = 20 };

static cost_figure figure_of(dice *d, cost_basis basis) {
    const double value = pow(10.0, dice_between(d, 1.0, 5.0));
    const double bound = 1.0 + dice_between(d, 0.05, 2.0);
    return (cost_figure){.basis = basis,
                         .of = COST_MEASURED,
                         .value = basis == COST_RANGE || basis == COST_NOT_KNOWN ? 0.0 : value,
                         .least = basis == COST_NOT_KNOWN ? 0.0 : value / bound,
                         .most = basis == COST_NOT_KNOWN ? 0.0 : value * bound,
                         .bound = bound};
}

static choice_row drawn_row(dice *d, cost_basis cycles) {
    choice_row r = {.setting = setting_at((int)dice_one_of(d, (unsigned)setting_count())),
                    .pace = {1 + dice_one_of(d, 20), 1},
                    .substeps = dice_one_of(d, 3)};
    r.result = (trial_result){.ran = true,
                              .usable = true,
                              .error = pow(10.0, dice_between(d, -6.0, -2.0)),
                              .bound = dice_one_of(d, 2) == 1,
                              .point = (int)dice_one_of(d, 2),
                              .column = 1 + (int)dice_one_of(d, 2)};
    r.cost =
        (cost){.instructions = figure_of(d, COST_PREDICTED),
               .instructions_worst = figure_of(d, COST_PREDICTED),
               .cycles = figure_of(d, cycles),
               .cycles_worst = figure_of(d, cycles),
               .flash_bytes = figure_of(d, dice_one_of(d, 2) ? COST_PREDICTED : COST_MEASURED),
               .ram_bytes = figure_of(d, COST_MEASURED),
               .stack_bytes = figure_of(d, dice_one_of(d, 2) ? COST_PREDICTED : COST_NOT_KNOWN),
               .state_bytes = figure_of(d, COST_EXACT),
               .why = ""};
    r.worst = pow(10.0, dice_between(d, 4.0, 6.0));
    r.load = dice_between(d, 0.01, 0.5);
    r.load_most = r.load * 1.5;
    return r;
}

static const char *behind(const char *text, const char *what) {
    const char *at = strstr(text, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, what), what);
    return at + strlen(what);
}

static bool has(const char *text, const char *what) { return strstr(text, what) != NULL; }

static const char *expect_near(const char *at, double want, double part) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE_MESSAGE(fabs(number - want) <= part * fabs(want), at);
    return at;
}

/* "--method rk4 --step 0.01\n" */
static void expect_options(const char *at, const trials *t, const choice_row *r) {
    char options[SETTING_TEXT];
    char step[TRIAL_TIME];
    char *want = room_words("%s --step %s\n", setting_options(&r->setting, true, options) + 1,
                            trial_time(trial_step(t, r->pace), step));
    TEST_ASSERT_EQUAL_STRING_LEN(want, at, strlen(want));
    free(want);
}

static void expect_amount(const char *at, const trials *t, double error, const char *rest) {
    char unit[40];
    at = expect_near(at, error, 5.1e-3);
    snprintf(unit, sizeof unit, " %s%s", t->what.column < 0 ? "of the largest value" : "mm", rest);
    TEST_ASSERT_EQUAL_STRING_LEN(unit, at, strlen(unit));
}

/* "  flash       1234 bytes, at most 2000: predicted, ...". */
static void expect_figure(const char *text, const char *name, const cost_figure *f,
                          const char *unit) {
    char begin[32];
    char of[FIGURE_WORDS];
    double number;
    snprintf(begin, sizeof begin, "\n  %-12s", name);
    const char *at = behind(text, begin);
    if (f->basis == COST_NOT_KNOWN) {
        TEST_ASSERT_EQUAL_STRING_LEN("not known\n", at, 10);
        return;
    }
    if (f->basis == COST_RANGE) {
        at = expect_near(at, f->least, 5.1e-3);
        at = expect_near(said_words(at, "to"), f->most, 5.1e-3);
        at = said_words(said_words(at, unit), ",");
    } else {
        at = said_number(at, &number);
        TEST_ASSERT_TRUE(fabs(number - f->value) <= 0.5);
        at = said_words(at, unit);
        if (f->basis == COST_PREDICTED) {
            at = said_number(said_words(at, ", at most"), &number);
            TEST_ASSERT_TRUE(number >= f->most && number < f->most + 1.0);
            at = said_words(at, ":");
        } else {
            at = said_words(at, ",");
        }
    }
    (void)said_words(said_words(at, figure_words(f, of)), "\n");
}

static void expect_load(const char *text, const choice_wish *w, const choice_row *r, bool range) {
    const char *at = behind(text, "\n  load        ");
    if (!(w->clock_Hz > 0.0)) {
        (void)said_words(at, "not asked: give --clock\n");
        return;
    }
    if (r->unknown[CHOICE_LOAD]) {
        (void)said_words(at, "not known: nobody knows the cycles of the longest step\n");
        return;
    }
    const cost_figure *f = &r->cost.cycles_worst;
    if (range) {
        at = expect_near(at, 100.0 * r->load_most / f->most * f->least, 0.051);
        at = said_words(expect_near(said_words(at, "to"), 100.0 * r->load_most, 0.051), "%");
    } else {
        at = said_words(expect_near(at, 100.0 * r->load, 5.1e-3), "%, at most");
        at = said_words(expect_near(at, 100.0 * r->load_most, 5.1e-3), "%,");
    }
    if (w->rate_Hz > 0.0) {
        at = expect_near(said_words(at, "of a period of"), 1.0 / w->rate_Hz, 1e-5);
        at = said_words(expect_near(said_words(at, "s ("), w->rate_Hz, 1e-5), "Hz)");
    } else {
        at = said_words(at, "of real time");
    }
    at = expect_near(said_words(at, "at"), w->clock_Hz / 1e6, 1e-5);
    at = said_words(at, "MHz, by the longest");
    if (r->run.steps > 0.0) {
        at = said_words(expect_near(said_words(at, "of"), r->run.steps, 0.0), "counted steps");
    } else {
        at = said_words(at, "step");
    }
    const double declared = range ? r->run.instructions_bound : r->run.cycles_bound;
    if (declared > 0.0) {
        const double most = range ? r->cost.instructions_worst.most : f->most;
        at = expect_near(said_words(at, ";"), 100.0 * r->load_most * declared / most, 5.1e-3);
        at = said_words(at, "% by the declared one");
    }
    TEST_ASSERT_EQUAL_CHAR('\n', *at);
}

static void expect_run(const char *text, const choice_row *r, bool range) {
    TEST_ASSERT_EQUAL_INT(r->run.steps > 0.0, has(text, "\n  of          "));
    TEST_ASSERT_EQUAL_INT(r->run.steps > 0.0, has(text, "\n  declared    "));
    if (r->run.steps > 0.0) {
        const double declared = range ? r->run.instructions_bound : r->run.cycles_bound;
        const char *at = expect_near(behind(text, "\n  of          "), r->run.steps, 0.0);
        (void)said_words(at, "counted steps: every one to the horizon");
        at = behind(text, "\n  declared    ");
        if (declared > 0.0) {
            at = expect_near(at, declared, 0.0);
            (void)said_words(at, range ? "instructions are" : "cycles are");
        } else {
            (void)said_words(at, "not known");
        }
    }
}

static void expect_counts(const char *text, const choice *c) {
    char want[120];
    const int not_tried =
        c->unpriced + c->left[0] + c->left[1] + c->left[2] + c->left[3] + c->left[4] + c->left[5];
    TEST_ASSERT_EQUAL_INT(6, CHOICE_LEFTS);
    TEST_ASSERT_EQUAL_INT(not_tried, choice_not_tried(c));
    snprintf(want, sizeof want, "\n\n%d settings, %d of them tried, %d not\n", c->settings,
             c->tried, not_tried);
    (void)behind(text, want);
    TEST_ASSERT_EQUAL_INT(c->unpriced > 0, has(text, "not tried: no price here: "));
    static const char *const why[] = {"even the coarsest step", "finer steps take",
                                      "the finest step",        "no step of it can",
                                      "its run has too",        "it cannot be built"};
    for (int i = 0; i < CHOICE_LEFTS; i++) {
        snprintf(want, sizeof want, "\n  %d not tried%s: %s", c->left[i],
                 i == 0 ? "" : " to the end", why[i]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(c->left[i] > 0, has(text, want), want);
    }
}

static void draw_counts(dice *d, choice *c) {
    c->settings = 70 + (int)dice_one_of(d, 20);
    c->tried = (int)dice_one_of(d, 30);
    for (int i = 0; i < CHOICE_LEFTS; i++) {
        c->left[i] = (int)dice_one_of(d, 3);
    }
    c->unpriced = (int)dice_one_of(d, 3) * 2;
    c->reason[0] = (choice_reason){"one reason", c->unpriced > 2 ? 3 : 2};
    c->reason[1] = (choice_reason){c->unpriced > 2 ? "another" : NULL, 1};
}

static void begin(priced *p, const char *of) {
    priced_open(p, places, 2);
    TEST_ASSERT_TRUE(priced_begin(p, "mps2-an386", spacing, RECORDS, of));
}

static void test_what_was_chosen_is_told(void) {
    dice d = dice_of("price_chosen", 41);
    priced plain;
    priced in_mm;
    begin(&plain, NULL);
    begin(&in_mm, "x");
    for (unsigned n = 0; n < dice_cases(few_or_all(200, 5000)); n++) {
        const trials *t = n % 2 == 0 ? &plain.trial : &in_mm.trial;
        const unsigned kind = dice_one_of(&d, 3);
        const cost_basis cycles = kind == 0   ? COST_RANGE
                                  : kind == 1 ? COST_NOT_KNOWN
                                              : COST_PREDICTED;
        const bool range = kind < 2;
        choice c = {.found = true,
                    .best = drawn_row(&d, cycles),
                    .has_second = dice_one_of(&d, 3) > 0,
                    .second = drawn_row(&d, cycles),
                    .has_coarser = dice_one_of(&d, 2) == 1,
                    .coarser = drawn_row(&d, cycles)};
        draw_counts(&d, &c);
        c.coarser.result.usable = dice_one_of(&d, 3) > 0;
        c.second.worst = n % 5 == 0 ? c.best.worst : c.best.worst * (1.0 + dice_between(&d, 0, 2));
        if (dice_one_of(&d, 2) == 1) {
            c.best.run =
                (measured_run){1000, dice_one_of(&d, 2) * 500.0, dice_one_of(&d, 2) * 700.0};
        }
        c.best.unknown[CHOICE_LOAD] = kind == 1;
        c.best.unknown[CHOICE_FLASH] = dice_one_of(&d, 2) == 1;
        c.best.unknown[CHOICE_RAM] = dice_one_of(&d, 2) == 1;
        const choice_wish w = {.error = c.best.result.error * dice_between(&d, 2.0, 50.0),
                               .rate_Hz = dice_one_of(&d, 2) ? 50.0 : 0.0,
                               .clock_Hz = dice_one_of(&d, 3) ? 48e6 : 0.0,
                               .prices = dice_one_of(&d, 2) ? "how they are known" : NULL};
        caught out;
        choice_print(catch_text(&out), t, &w, &c, &words);
        room_text_end(out.to);
        const char *text = out.text;
        (void)said_words(text, "s on mps2-an386 (Cortex-M4F)\n");
        TEST_ASSERT_EQUAL_INT(w.prices != NULL, has(text, "\n  prices      how they are known\n"));
        expect_options(behind(text, "\n\nchosen      "), t, &c.best);
        const char *at = behind(text, "\n  error       ");
        at = c.best.result.bound ? said_words(at, "at most") : at;
        char rest[80];
        snprintf(rest, sizeof rest, ", measured%s%s, worst with --set place=%d; ",
                 t->what.column < 0 ? (c.best.result.column == 1 ? " (x" : " (x'") : "",
                 t->what.column < 0 ? ")" : "", c.best.result.point);
        expect_amount(at, t, c.best.result.error, rest);
        expect_amount(strstr(at, "; ") + 2, t, w.error, " is allowed, ");
        (void)said_words(
            expect_near(behind(text, "is allowed, "), w.error / c.best.result.error, 5.1e-3),
            "times as much\n");
        at = behind(text, "\n  step        ");
        at = expect_near(at, ratio_times(1, trial_step(t, c.best.pace)), 1e-12);
        at = said_words(at, "s");
        if (c.best.substeps > 0) {
            at = said_words(expect_near(said_words(at, ","), (double)c.best.substeps, 0.0),
                            "in a period");
        }
        TEST_ASSERT_EQUAL_CHAR('\n', *at);
        const cost *k = &c.best.cost;
        const char *unit = range ? "instructions" : "cycles";
        expect_figure(text, "a step", range ? &k->instructions : &k->cycles, unit);
        expect_figure(text, "the longest", range ? &k->instructions_worst : &k->cycles_worst, unit);
        expect_run(text, &c.best, range);
        TEST_ASSERT_EQUAL_INT(range, has(text, "\n  in cycles   "));
        if (range) {
            expect_figure(text, "in cycles", &k->cycles_worst, "cycles");
        }
        expect_load(text, &w, &c.best, range);
        expect_figure(text, "flash", &k->flash_bytes, "bytes");
        expect_figure(text, "RAM", &k->ram_bytes, "bytes without the stack");
        expect_figure(text, "stack", &k->stack_bytes, "bytes");
        expect_figure(text, "state", &k->state_bytes, "bytes of these");
        TEST_ASSERT_EQUAL_INT(c.best.unknown[CHOICE_FLASH], has(text, "\n  flash is limited, and"));
        TEST_ASSERT_EQUAL_INT(c.best.unknown[CHOICE_RAM], has(text, "\n  RAM is limited, and"));
        const bool coarser = c.has_coarser && c.coarser.result.usable;
        TEST_ASSERT_EQUAL_INT(coarser, has(text, "\n  coarser     --step "));
        if (coarser) {
            at = expect_near(behind(text, "\n  coarser     --step "),
                             ratio_times(1, trial_step(t, c.coarser.pace)), 1e-12);
            expect_amount(
                said_words(at, "errs by"), t, c.coarser.result.error,
                c.coarser.result.error <= w.error ? ", more than half of what is allowed\n" : "\n");
        }
        at = behind(text, "\n\nrunner-up   ");
        if (!c.has_second) {
            (void)said_words(at, "none: no other setting keeps all this\n");
        } else {
            char options[SETTING_TEXT];
            (void)said_words(at, setting_options(&c.second.setting, true, options) + 1);
            at = behind(text, "\n  lost by     ");
            if (c.second.worst > c.best.worst) {
                at = expect_near(at, 100 * (c.second.worst - c.best.worst) / c.best.worst, 6e-3);
                at = said_words(said_words(said_words(at, "% more"), unit),
                                "in its longest steps; it errs by");
                expect_amount(at, t, c.second.result.error, "\n");
            } else {
                expect_amount(said_words(at, "its error,"), t, c.second.result.error,
                              ", for the same price\n");
            }
        }
        expect_counts(text, &c);
        char *run = table_run_line(t, &c.best.setting, c.best.pace, c.best.result.point, &words);
        char *code =
            table_derive_line(t, &c.best.setting, c.best.pace, c.best.result.point, &words);
        char *count =
            table_measure_line(t, &c.best.setting, c.best.pace, c.best.result.point, &words);
        at = said_words(said_words(behind(text, "\nagain       "), run), "\nas code     ");
        at = said_words(said_words(at, code), "\ncounted by  ");
        TEST_ASSERT_EQUAL_STRING("\n", said_words(at, count));
        free(run);
        free(code);
        free(count);
        free(out.text);
    }
    priced_close(&plain);
    priced_close(&in_mm);
}

/* --- nothing fits ----------------------------------------------------------------------------------------*/

/* No less than what is wanted, by two digits. */
static const char *expect_two_digits(const char *at, double want) {
    double number;
    char *end;
    number = strtod(at + strspn(at, " "), &end);
    const double unit = pow(10.0, floor(log10(want * (1 - 1e-11))) - 1.0);
    TEST_ASSERT_TRUE(number >= want * (1 - 1e-11) && number < want + unit * (1 + 1e-9));
    TEST_ASSERT_TRUE(fabs(number / unit - floor(number / unit + 0.5)) < 1e-6);
    return end;
}

static void test_what_would_fit_is_told(void) {
    dice d = dice_of("price_chosen none", 42);
    priced p;
    begin(&p, "x");
    const trials *t = &p.trial;
    for (unsigned n = 0; n < dice_cases(few_or_all(200, 5000)); n++) {
        choice c = {.weaker = drawn_row(&d, COST_PREDICTED),
                    .dearer = drawn_row(&d, COST_PREDICTED),
                    .larger = drawn_row(&d, COST_PREDICTED),
                    .any = drawn_row(&d, COST_PREDICTED)};
        draw_counts(&d, &c);
        const bool none = n % 4 == 0;
        c.has_weaker = !none && dice_one_of(&d, 2) == 1;
        c.has_dearer = !none && dice_one_of(&d, 2) == 1;
        c.has_larger = !none && dice_one_of(&d, 2) == 1;
        c.has_any = dice_one_of(&d, 4) > 0;
        c.dearer.fails[CHOICE_LOAD] = dice_one_of(&d, 3) > 0;
        c.dearer.load_most = dice_between(&d, 1.0, 9000.0);
        c.any.fails[CHOICE_LOAD] = dice_one_of(&d, 2) == 1;
        c.any.load_most = dice_between(&d, 1.0, 90.0);
        c.larger.fails[CHOICE_FLASH] = dice_one_of(&d, 2) == 1;
        c.larger.fails[CHOICE_RAM] = dice_one_of(&d, 2) == 1;
        c.refused = (int)dice_one_of(&d, 3);
        for (int i = 0; i < CHOICE_LIMITS; i++) {
            c.failed[i] = (int)dice_one_of(&d, 3);
        }
        if (n % 7 == 0) { /* all were tried */
            memset(c.left, 0, sizeof c.left);
            c.unpriced = 0;
        }
        const choice_wish w = {.error = 1e-3, .clock_Hz = dice_one_of(&d, 4) ? 16e6 : 0.0};
        const choice_row lower = drawn_row(&d, COST_PREDICTED);
        const double rate_Hz = dice_one_of(&d, 2) ? 12.5 : 0.0;
        caught out;
        choice_print_none(catch_text(&out), t, &w, &c, &words, rate_Hz, &lower);
        room_text_end(out.to);
        const char *text = out.text;
        char want[100];
        const int not_tried = choice_not_tried(&c);
        if (not_tried == 0) {
            snprintf(want, sizeof want, "\nnothing fits: all %d settings were tried\n", c.settings);
        } else {
            snprintf(want, sizeof want, "\nnothing fits of %d settings tried; %d not tried%s\n",
                     c.tried, not_tried,
                     c.left[CHOICE_LEFT_WHOLE] + c.left[CHOICE_LEFT_FINER] > 0 ? ": raise --effort"
                                                                               : "");
        }
        (void)behind(text, want);
        snprintf(want, sizeof want, "\n  %d keep load, flash or RAM by no step\n", c.refused);
        TEST_ASSERT_EQUAL_INT(c.refused > 0, has(text, want));
        static const char *const limits[] = {"error", "load", "flash", "RAM"};
        for (int i = 0; i < CHOICE_LIMITS; i++) {
            snprintf(want, sizeof want, "\n  %-6s fails in %d%s\n", limits[i], c.failed[i],
                     i == 0 ? "" : " of those that keep the error");
            TEST_ASSERT_EQUAL_INT(c.failed[i] > 0, has(text, want));
        }
        const char *fit = behind(text, "\nwhat would fit\n");
        TEST_ASSERT_EQUAL_INT(c.has_weaker, has(fit, "  an error of "));
        if (c.has_weaker) {
            const char *at =
                expect_two_digits(behind(fit, "  an error of"), 2.0 * c.weaker.result.error);
            expect_options(said_words(at, "mm:") + 1, t, &c.weaker);
        }
        const bool dearer = c.has_dearer && w.clock_Hz > 0.0 && c.dearer.fails[CHOICE_LOAD];
        const bool all = !c.has_weaker && !c.has_dearer && !c.has_larger;
        TEST_ASSERT_EQUAL_INT(dearer,
                              has(fit, "\n  a clock of") || !strncmp(fit, "  a clock of", 12));
        if (dearer) {
            const char *at =
                expect_two_digits(behind(fit, "  a clock of"), 16.0 * c.dearer.load_most);
            expect_options(said_words(at, "MHz:") + 1, t, &c.dearer);
        }
        TEST_ASSERT_EQUAL_INT(rate_Hz > 0.0, has(fit, "  a rate of 12.5 Hz: "));
        if (rate_Hz > 0.0) {
            expect_options(behind(fit, "  a rate of 12.5 Hz: "), t, &lower);
        }
        const bool larger =
            c.has_larger && (c.larger.fails[CHOICE_FLASH] || c.larger.fails[CHOICE_RAM]);
        TEST_ASSERT_EQUAL_INT(larger || (all && c.has_any), has(fit, " bytes of flash and "));
        if (larger || (all && c.has_any)) {
            const choice_row *r = larger ? &c.larger : &c.any;
            snprintf(want, sizeof want, "  %.0f bytes of flash and %.0f of RAM with the stack: ",
                     ceil(r->cost.flash_bytes.most),
                     ceil(r->cost.ram_bytes.most + r->cost.stack_bytes.most));
            expect_options(behind(fit, want), t, r);
        }
        TEST_ASSERT_EQUAL_INT(all && !c.has_any, has(fit, "  nothing that was tried\n"));
        const bool together = all && c.has_any && c.any.fails[CHOICE_LOAD];
        TEST_ASSERT_EQUAL_INT(together, has(fit, "  together with the next: a clock of "));
        if (together && w.clock_Hz > 0.0) {
            (void)said_words(
                expect_two_digits(behind(fit, "with the next: a clock of"), 16.0 * c.any.load_most),
                "MHz\n");
        }
        expect_counts(text, &c);
        free(out.text);
    }
    /* without a price, and without an effort */
    choice c = {.settings = 9, .unpriced = 9, .reason = {{"one reason", 6}, {"another", 3}}};
    const choice_wish w = {.error = 1e-3};
    caught out;
    choice_print_none(catch_text(&out), t, &w, &c, &words, 0.0, NULL);
    room_text_end(out.to);
    (void)behind(out.text, "\nno setting has a price here: one reason (6); another (3)\n");
    TEST_ASSERT_FALSE(has(out.text, "what would fit") || has(out.text, "--whole-run"));
    free(out.text);
    for (int tried = 0; tried < 2; tried++) {
        c = (choice){.settings = 9, .unpriced = 2, .reason = {{"only", 2}}, .tried = tried};
        c.left[CHOICE_LEFT_WHOLE] = 7;
        choice_print_none(catch_text(&out), t, &w, &c, &words, 0.0, NULL);
        room_text_end(out.to);
        TEST_ASSERT_EQUAL_INT(!tried, has(out.text, "even one step a period takes too long\n"));
        TEST_ASSERT_EQUAL_INT(tried, has(out.text, "what would fit"));
        (void)behind(out.text, "\n  2 not tried: no price here: only\n");
        expect_counts(out.text, &c);
        free(out.text);
    }
    priced_close(&p);
}

void suite_price_chosen(void) {
    RUN_TEST(test_what_was_chosen_is_told);
    RUN_TEST(test_what_would_fit_is_told);
}
