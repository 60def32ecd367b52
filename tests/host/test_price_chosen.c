/* test_price_chosen.c: choices in words (host/study/choice.h), of made-up ones, read back. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "caught.h"
#include "command.h"
#include "host/base/alloc.h"
#include "host/study/choice.h"
#include "host/study/table_text.h"
#include "priced.h"
#include "unity.h"

void suite_price_chosen(void);

static const char *const places[] = {
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 16 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 50};
static const table_words words = {"f.whirl:s", " --set m=3", false, 1e7};
enum { RECORDS = 20 };

static cost_figure figure_of(dice *d, cost_basis basis) {
    const double value = pow(10.0, dice_between(d, 1.0, 5.0));
    const double bound = 1.0 + dice_between(d, 0.05, 2.0);
    return (cost_figure){.basis = basis,
                         .value = basis == COST_RANGE || basis == COST_NOT_KNOWN ? 0.0 : value,
                         .least = basis == COST_NOT_KNOWN ? 0.0 : value / bound,
                         .most = basis == COST_NOT_KNOWN ? 0.0 : value * bound};
}

static table_row drawn_row(dice *d, cost_basis cycles) {
    table_row r = {.setting = setting_at((int)dice_one_of(d, (unsigned)setting_count())),
                   .pace = {1 + dice_one_of(d, 20), 1}};
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
    if (dice_one_of(d, 2) == 1) {
        r.run = (counted_run){100 + dice_one_of(d, 900), 1000 * dice_one_of(d, 2),
                              2000 * dice_one_of(d, 2)};
    }
    return r;
}

static choice_row drawn_answer(dice *d, int row, bool no_cycles) {
    choice_row r = {.row = row};
    r.worst = pow(10.0, dice_between(d, 4.0, 6.0));
    r.load = dice_between(d, 0.01, 0.5);
    r.load_most = r.load * 1.5;
    r.unknown[CHOICE_LOAD] = no_cycles;
    r.unknown[CHOICE_FLASH] = dice_one_of(d, 2) == 1;
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
static void expect_options(const char *at, const trials *t, const table_row *r) {
    char options[SETTING_TEXT];
    char step[TRIAL_TIME];
    char *want = alloc_words("%s --step %s\n", setting_options(&r->setting, true, options) + 1,
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

/* "  flash       1234 bytes, predicted: ...". */
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
        at = said_words(said_words(at, unit), ",");
    }
    (void)said_words(said_words(at, figure_words(f, of)), "\n");
}

static void expect_load(const char *text, const choice_wish *w, const table_row *row,
                        const choice_row *r, bool range) {
    const char *at = behind(text, "\n  load        ");
    if (!(w->clock_Hz > 0.0)) {
        (void)said_words(at, "not asked: give --clock\n");
        return;
    }
    if (r->unknown[CHOICE_LOAD]) {
        (void)said_words(at, "not known: the cycles of the longest step are not\n");
        return;
    }
    const cost_figure *f = &row->cost.cycles_worst;
    if (range) {
        at = expect_near(at, 100.0 * r->load_most / f->most * f->least, 0.051);
        at = said_words(expect_near(said_words(at, "to"), 100.0 * r->load_most, 0.051), "%");
    } else {
        at = said_words(expect_near(at, 100.0 * r->load, 5.1e-3), "%, at most");
        at = said_words(expect_near(at, 100.0 * r->load_most, 5.1e-3), "%,");
    }
    if (w->table.rate_Hz > 0.0) {
        at = expect_near(said_words(at, "of a period of"), 1.0 / w->table.rate_Hz, 1e-5);
        at = said_words(expect_near(said_words(at, "s ("), w->table.rate_Hz, 1e-5), "Hz)");
    } else {
        at = said_words(at, "of real time");
    }
    at = expect_near(said_words(at, "at"), w->clock_Hz / 1e6, 1e-5);
    at = said_words(at, "MHz, by the longest");
    if (row->run.steps > 0.0) {
        at = said_words(expect_near(said_words(at, "of"), row->run.steps, 0.0), "counted steps");
    } else {
        at = said_words(at, "step");
    }
    const double declared = range ? row->run.instructions_bound : row->run.cycles_bound;
    if (declared > 0.0) {
        const double most = range ? row->cost.instructions_worst.most : f->most;
        at = expect_near(said_words(at, ";"), 100.0 * r->load_most * declared / most, 5.1e-3);
        at = said_words(at, "% by the declared one");
    }
    TEST_ASSERT_EQUAL_CHAR('\n', *at);
}

static void expect_run(const char *text, const table_row *r, bool range) {
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

static void begin(priced *p, const char *of) {
    priced_open(p, places, 2);
    TEST_ASSERT_TRUE(priced_begin(p, "mps2-an386", spacing, RECORDS, of));
}

static void expect_answer(const char *text, const trials *t, const choice_wish *w,
                          const table_row *row, const choice_row *by) {
    const cost *c = &row->cost;
    const bool cycles = c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
    const char *unit = cycles ? "cycles" : "instructions";
    char name[TRIAL_NAME];
    char want[80];
    expect_options(text, t, row);
    const char *at = behind(text, "\n  error       ");
    at = row->result.bound ? said_words(at, "at most ") : at;
    expect_amount(at, t, row->result.error, ", measured");
    if (t->what.column < 0) {
        snprintf(want, sizeof want, ", measured (%s)", trial_column(t, row->result.column, name));
        (void)behind(text, want);
    }
    snprintf(want, sizeof want, ", worst of %d sampled places with --set place=%d; ", t->points,
             row->result.point);
    expect_amount(behind(text, want), t, w->table.error, " is allowed\n");
    TEST_ASSERT_EQUAL_INT(w->table.rate_Hz > 0.0, has(text, "\n  a period    "));
    expect_figure(text, "a step", cycles ? &c->cycles : &c->instructions, unit);
    expect_figure(text, "the longest", cycles ? &c->cycles_worst : &c->instructions_worst, unit);
    expect_run(text, row, !cycles);
    TEST_ASSERT_EQUAL_INT(!cycles, has(text, "\n  in cycles   "));
    expect_load(text, w, row, by, c->cycles.basis == COST_RANGE);
    expect_figure(text, "flash", &c->flash_bytes, "bytes");
    expect_figure(text, "RAM", &c->ram_bytes, "bytes without the stack");
    expect_figure(text, "stack", &c->stack_bytes, "bytes");
    if (c->state_bytes.basis == COST_NOT_KNOWN) {
        TEST_ASSERT_FALSE(has(text, "\n  state "));
    } else {
        expect_figure(text, "state", &c->state_bytes, "bytes of these");
    }
    TEST_ASSERT_EQUAL_INT(by->unknown[CHOICE_FLASH], has(text, "\n  flash is limited, and not"));
    const setting *s = &row->setting;
    char *const lines[] = {table_run_line(t, s, row->pace, row->result.point, &words),
                           table_derive_line(t, s, row->pace, &words),
                           table_measure_line(t, s, row->pace, row->result.point, &words)};
    static const char *const heads[] = {"\n  again       ", "\n  as code     ", "\n  counted by  "};
    for (int i = 0; i < 3; i++) {
        at = behind(text, heads[i]);
        TEST_ASSERT_EQUAL_STRING_LEN(lines[i], at, strlen(lines[i]));
        TEST_ASSERT_EQUAL_CHAR('\n', at[strlen(lines[i])]);
        free(lines[i]);
    }
}

static void test_both_answers_are_told(void) {
    dice d = dice_of("price_chosen", 41);
    static const cost_basis bases[] = {COST_ESTIMATED, COST_RANGE, COST_PREDICTED};
    for (int n = 0; n < 24; n++) {
        priced p;
        begin(&p, n % 2 ? "x" : NULL);
        const cost_basis basis = bases[n % 3];
        table_row row[2] = {drawn_row(&d, basis), drawn_row(&d, basis)};
        table made = {.row = row, .count = 2, .settings = 50, .why = "a reason"};
        made.broken_off = n % 4 == 0 ? 3 : 0;
        made.unpriced = n % 5 == 0 ? 2 : 0;
        const choice_wish w = {.table = {.error = 0.01,
                                         .rate_Hz = n % 4 == 1 ? 40.0 : 0.0,
                                         .periods = 1,
                                         .operations = 1e7},
                               .clock_Hz = n % 4 < 2 ? 16e6 : 0.0,
                               .prices = "as they are"};
        const bool same = n % 6 == 5;
        const bool none = n % 6 == 4;
        const choice c = {.fastest = drawn_answer(&d, 0, n % 8 == 0),
                          .smallest = drawn_answer(&d,
                                                   same   ? 0
                                                   : none ? -1
                                                          : 1,
                                                   false)};
        caught out;
        choice_print(catch_text(&out), &p.trial, &made, &w, &c, &words);
        alloc_text_end(out.to);
        (void)behind(out.text, "\n  prices      as they are\n");
        char *second = strstr(out.text, "\nleast flash    ");
        TEST_ASSERT_NOT_NULL(second);
        *second++ = '\0';
        expect_answer(behind(out.text, "\nfewest cycles  "), &p.trial, &w, &row[0], &c.fastest);
        second += strlen("least flash    ");
        if (same || none) {
            TEST_ASSERT_TRUE(strncmp(second, same ? "the same\n" : "not known\n", 9) == 0);
        } else {
            expect_answer(second, &p.trial, &w, &row[1], &c.smallest);
        }
        (void)behind(second, "\n\n50 settings");
        TEST_ASSERT_EQUAL_INT(made.broken_off > 0,
                              has(second, "; finer steps of 3 take more than"));
        TEST_ASSERT_EQUAL_INT(made.unpriced > 0, has(second, "; 2 without a price here: a reason"));
        free(out.text);
        priced_close(&p);
    }
}

/* --- nothing fits ----------------------------------------------------------------------------------------*/

/* No less than what is wanted, by two digits. */
static const char *expect_no_less(const char *at, double want) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE_MESSAGE(number >= want * (1 - 1e-9) && number <= 1.1 * want, at);
    return at;
}

static void test_what_would_fit_is_told(void) {
    dice d = dice_of("price_chosen none", 42);
    for (int n = 0; n < 32; n++) {
        priced p;
        begin(&p, n % 2 ? "x" : NULL);
        table_row row[3];
        for (int i = 0; i < 3; i++) {
            row[i] = drawn_row(&d, COST_ESTIMATED);
        }
        table made = {.row = row, .count = 3, .settings = 50, .why = ""};
        made.broken_off = n % 4 == 0 ? 3 : 0;
        const choice_wish w = {
            .table = {.error = 1e-3, .operations = 1e7}, .clock_Hz = 16e6, .prices = "as they are"};
        const choice_row none = {.row = -1};
        choice c = {none, none, none, none, none, none};
        c.weaker = n & 1 ? none : drawn_answer(&d, 0, false);
        c.dearer = n & 2 ? none : drawn_answer(&d, 1, false);
        c.larger = n & 4 ? none : drawn_answer(&d, 2, false);
        c.any = n & 8 ? none : drawn_answer(&d, 2, false);
        c.dearer.fails[CHOICE_LOAD] = c.any.fails[CHOICE_LOAD] = true;
        c.larger.fails[CHOICE_RAM] = true;
        c.dearer.load_most = c.any.load_most = 3.7;
        caught out;
        choice_print(catch_text(&out), &p.trial, &made, &w, &c, &words);
        alloc_text_end(out.to);
        TEST_ASSERT_EQUAL_INT(made.broken_off == 0,
                              has(out.text, "\nnothing fits: all 50 settings were tried\n"));
        TEST_ASSERT_EQUAL_INT(made.broken_off > 0,
                              has(out.text, "\nnothing fits of the steps that were tried: raise "
                                            "--effort\n"));
        const char *at = behind(out.text, "\nwhat would fit\n");
        if (c.weaker.row >= 0) {
            at = expect_no_less(said_words(at, "an error of"), 2.0 * row[0].result.error);
            expect_options(strstr(at, ": ") + 2, &p.trial, &row[0]);
            at = strchr(at, '\n') + 1;
        }
        if (c.dearer.row >= 0) {
            at = expect_no_less(said_words(at, "a clock of"), 16.0 * 3.7);
            expect_options(said_words(at, "MHz:") + 1, &p.trial, &row[1]);
            at = strchr(at, '\n') + 1;
        }
        const bool all = c.dearer.row < 0 && c.larger.row < 0 && c.any.row >= 0;
        if (all) {
            at = said_words(expect_no_less(said_words(at, "a clock of"), 16.0 * 3.7), "MHz:");
        }
        if (c.larger.row >= 0 || all) {
            double number;
            const cost *larger = &row[2].cost;
            at = said_number(at, &number);
            TEST_ASSERT_TRUE(number >= larger->flash_bytes.most &&
                             number < larger->flash_bytes.most + 1);
            at = said_number(said_words(at, "bytes of flash and"), &number);
            TEST_ASSERT_TRUE(number >= larger->ram_bytes.most + larger->stack_bytes.most);
            expect_options(said_words(at, "of RAM with the stack:") + 1, &p.trial, &row[2]);
            at = strchr(at, '\n') + 1;
        }
        TEST_ASSERT_EQUAL_INT(c.weaker.row < 0 && c.any.row < 0 && !all,
                              has(out.text, "  nothing that was tried\n"));
        free(out.text);
        priced_close(&p);
    }
}

/* With contacts, and nothing counted: the lines that do. */
static void test_why_none_has_a_price_is_told(void) {
    priced p;
    priced_open(&p, priced_ball, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    table made = {.settings = 9, .unpriced = 9, .why = "a reason"};
    const choice_row none = {.row = -1};
    const choice c = {none, none, none, none, none, none};
    const choice_wish w = {.table = {.error = 1e-3}, .prices = "as they are"};
    caught out;
    choice_print(catch_text(&out), &p.trial, &made, &w, &c, &words);
    alloc_text_end(out.to);
    (void)behind(out.text, "\nnothing fits of the steps that were tried\n");
    (void)behind(out.text, "\n9 settings; 9 without a price here: a reason\n");
    TEST_ASSERT_FALSE(has(out.text, "what would fit"));
    free(out.text);
    priced_close(&p);
}

void suite_price_chosen(void) {
    RUN_TEST(test_both_answers_are_told);
    RUN_TEST(test_what_would_fit_is_told);
    RUN_TEST(test_why_none_has_a_price_is_told);
}
