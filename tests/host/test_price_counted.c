/* test_price_counted.c: what is chosen by prices that are counted (host/price/choice_counted.h), in a made-up source tree: as
 * if all settings had been counted before, though few are. What is chosen by known prices is test_price_choices.c's. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "host/price/choice_counted.h"
#include "host/price/choice_price.h"
#include "made_up_tree.h"
#include "priced.h"
#include "unity.h"

void suite_price_counted(void);

enum { RECORDS = 10, SETTINGS = PRICED_TRIED };
static const double rate_Hz = 20.0;
static const table_words words = {"a.whirl:s", "", false};

/* --- what is counted -------------------------------------------------------------------------------------*/

/* The row of each setting, or "": it is refused. */
typedef struct answers {
    char row[SETTINGS][200];
} answers;

/* No less than was expected of it while nothing was counted, each figure by its own factor. */
static void draw_answers(dice *d, priced *p, answers *a) {
    for (int i = 0; i < SETTINGS; i++) {
        measured_prices none = {.words = &words};
        const choice_wish w = {.counted = &none};
        const setting s = priced_tried(i);
        bool own;
        const cost c = choice_price(&p->trial, &w, &s, (deviation_pace){1, 1}, false, &own);
        double v[7];
        const cost_figure *const figures[] = {&c.instructions, &c.instructions_worst, &c.cycles,
                                              &c.cycles_worst, &c.flash_bytes,        &c.ram_bytes,
                                              &c.stack_bytes};
        for (int k = 0; k < 7; k++) {
            v[k] = ceil(figures[k]->most * dice_between(d, 1.0, 1.7)) + 1.0;
        }
        a->row[i][0] = '\0';
        if (dice_one_of(d, 6) > 0) {
            snprintf(a->row[i], sizeof a->row[i],
                     "a,g,\"f\",%s,s,n,o,%.0f,%.0f,%.0f,%.0f,estimated,%.0f,%.0f,%.0f",
                     p->wish.board->name, v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
        }
    }
}

/* A script that says them. */
static void write_script(const answers *a) {
    char text[4000] = "echo \"$@\" >>asked\ncase \"$*\" in\n";
    for (int i = 0; i < SETTINGS; i++) {
        const setting s = priced_tried(i);
        char options[SETTING_TEXT];
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "*\" %s a.whirl:s%s \"*) ", s.number->name,
                 setting_options(&s, false, options));
        used = strlen(text);
        snprintf(text + used, sizeof text - used,
                 a->row[i][0] != '\0' ? "echo '%s' ;;\n" : "exit 1 ;;%s\n", a->row[i]);
    }
    strcat(text, "*) exit 2 ;;\nesac\n");
    tree_keep("mk/price/measure_one.sh", text);
}

/* All settings as if they had been counted. */
static measured_prices all_counted(const priced *p, const answers *a,
                                   measured_price price[SETTINGS]) {
    for (int i = 0; i < SETTINGS; i++) {
        const setting s = priced_tried(i);
        price[i] = (measured_price){.pace = {1, 1}};
        setting_options(&s, true, price[i].options);
        price[i].cost.why = "it cannot be built, linked or run there";
        (void)cost_measured(a->row[i], p->wish.board, &price[i].cost);
    }
    return (measured_prices){.words = &words, .price = price, .count = SETTINGS};
}

/* --- what is chosen --------------------------------------------------------------------------------------*/

static void expect_row(bool has, const choice_row *want, bool have, const choice_row *row,
                       const measured_prices *m) {
    TEST_ASSERT_EQUAL_INT(has, have);
    if (has) {
        TEST_ASSERT_TRUE(row->setting.image.method == want->setting.image.method);
        TEST_ASSERT_TRUE(row->setting.number == want->setting.number);
        TEST_ASSERT_EQUAL_UINT64(want->pace.steps, row->pace.steps);
        TEST_ASSERT_TRUE(row->worst == want->worst && row->load == want->load);
        TEST_ASSERT_TRUE(row->cost.flash_bytes.most == want->cost.flash_bytes.most);
        TEST_ASSERT_TRUE(measured_has(m, &row->setting, row->pace));
        TEST_ASSERT_EQUAL_INT(COST_MEASURED, row->cost.instructions_worst.basis);
    }
}

/* How often it was told that something is counted, and how many were before. */
typedef struct told {
    int times;
    int stop_at;
    volatile sig_atomic_t stop;
} told;

static void count_told(void *context, int counted) {
    told *t = context;
    TEST_ASSERT_EQUAL_INT(t->times, counted);
    t->times++;
    t->stop = t->times == t->stop_at;
}

/* In turn: flash that some settings keep; a slow clock; too little flash; a slow clock and flash that some keep, and an error that is hard to keep. */
static choice_wish draw_wish(dice *d, unsigned n, bool fpu) {
    const bool slow = n % 2 == 1;
    const double clock = pow(10.0, dice_between(d, 6.0, 7.0));
    const double slow_clock = pow(10.0, dice_between(d, 3.3, 4.0)) * (fpu ? 1.0 : 25.0);
    const double flash = dice_between(d, 4500.0, 8000.0);
    const double little = dice_between(d, 2000.0, 4000.0);
    return (choice_wish){
        .error = pow(10.0, n % 4 == 3 ? -4.0 : dice_between(d, -3.7, slow ? -2.5 : -1.0)),
        .rate_Hz = rate_Hz,
        .periods = 1,
        .operations = 1e9,
        .clock_Hz = slow ? slow_clock : clock,
        .flash_bytes = n % 4 == 0   ? flash
                       : n % 4 == 2 ? little
                                    : 0.0,
        .ram_bytes = n % 8 == 4 ? dice_between(d, 100.0, 300.0) : 0.0};
}

/* What an answer is made of. */
static int rows_of(const choice *c, const choice_row *row[4]) {
    int count = 0;
    if (c->found) {
        row[count++] = &c->best;
        row[count] = &c->second;
        return count + (c->has_second ? 1 : 0);
    }
    const choice_row *const all[] = {&c->dearer, &c->larger, &c->any, &c->weaker};
    const bool has[] = {c->has_dearer, c->has_larger, c->has_any, c->has_weaker};
    for (int i = 0; i < 4; i++) {
        if (has[i]) {
            row[count++] = all[i];
        }
    }
    return count;
}

/* Each was counted since it was part of the answer by those before it, and the last answer has no other. */
static void expect_reasons(priced *p, const choice_wish *of, const measured_prices *m,
                           trial_memo *memo) {
    for (int k = 0; k <= m->count; k++) {
        measured_prices before = *m;
        before.count = k;
        choice_wish w = *of;
        w.counted = &before;
        w.memo = memo;
        const choice c = choice_make(&p->trial, &w);
        const choice_row *row[4];
        bool is = false;
        bool all = true;
        for (int i = rows_of(&c, row) - 1; i >= 0; i--) {
            char options[SETTING_TEXT];
            setting_options(&row[i]->setting, true, options);
            is = is || (k < m->count && strcmp(options, m->price[k].options) == 0);
            all = all && measured_has(&before, &row[i]->setting, row[i]->pace);
        }
        TEST_ASSERT_TRUE(k < m->count ? is && !all : all);
    }
}

static void begin(priced *p, const char *board) {
    priced_open(p, priced_spring, 1);
    p->takes = priced_is_tried;
    TEST_ASSERT_TRUE(priced_begin(p, board, (whole_ratio){1, 20}, RECORDS, NULL));
    TEST_ASSERT_TRUE(p->trial.reliable);
}

static void test_drawn_choices_are_as_if_all_were_counted(void) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385"};
    dice d = dice_of("price_counted", 431);
    int of[6] = {0};
    int counted = 0;
    int cases = 0;
    for (int b = 0; b < 2; b++) {
        priced p;
        begin(&p, boards[b]);
        trial_memo memo = {.count = 0};
        for (unsigned n = 0; n < dice_cases(few_or_all(b == 0 ? 9 : 4, 1000)); n++, cases++) {
            answers a;
            measured_price price[SETTINGS];
            draw_answers(&d, &p, &a);
            measured_prices all = all_counted(&p, &a, price);
            choice_wish w = draw_wish(&d, n, b == 0);
            choice_wish other = w;
            other.counted = &all;
            other.memo = &memo;
            const choice want = choice_make(&p.trial, &other);
            told t = {.times = 0};
            measured_prices m = {.words = &words};
            measured_end end = MEASURED_MISSING;
            w.counting = count_told;
            w.context = &t;
            tree_enter();
            write_script(&a);
            const long before = blocks_in_use();
            const choice c = choice_counted(&p.trial, &w, &m, &end);
            const long kept = m.count > 0 && blocks_are_counted() ? 1 : 0;
            TEST_ASSERT_EQUAL_INT(before + kept, blocks_in_use());
            tree_leave();
            TEST_ASSERT_TRUE(end != MEASURED_MISSING);
            TEST_ASSERT_TRUE(m.count > 0 || end == MEASURED_COUNTED);
            TEST_ASSERT_TRUE(w.memo == NULL && w.counted == &m);
            TEST_ASSERT_TRUE(!m.by_run && !p.trial.without_events && !p.trial.stopped);
            TEST_ASSERT_EQUAL_INT(t.times, m.count);
            counted += m.count;
            TEST_ASSERT_EQUAL_INT(want.found, c.found);
            expect_row(want.found, &want.best, c.found, &c.best, &m);
            if (want.found) {
                expect_row(want.has_second, &want.second, c.has_second, &c.second, &m);
            } else {
                expect_row(want.has_dearer, &want.dearer, c.has_dearer, &c.dearer, &m);
                expect_row(want.has_larger, &want.larger, c.has_larger, &c.larger, &m);
                expect_row(want.has_any, &want.any, c.has_any, &c.any, &m);
                expect_row(want.has_weaker, &want.weaker, c.has_weaker, &c.weaker, &m);
            }
            of[0] += c.found;
            of[1] += c.found && c.has_second;
            of[2] += !c.found && c.has_dearer;
            of[3] += !c.found && c.has_larger;
            of[4] += !c.found && c.has_any;
            of[5] += !c.found && c.has_weaker;
            expect_reasons(&p, &w, &m, &memo);
            measured_free(&m);
        }
        trial_memo_free(&memo);
        priced_close(&p);
    }
    printf("  %d of %d settings were counted; %d, %d; %d, %d, %d, %d\n", counted, cases * SETTINGS,
           of[0], of[1], of[2], of[3], of[4], of[5]);
    TEST_ASSERT_TRUE(counted > cases && counted < cases * (SETTINGS - 1));
    for (int i = 0; i < 6; i++) {
        TEST_ASSERT_TRUE(of[i] > 0);
    }
}

/* Where a tool is missing nothing more is asked; and when it is stopped, nothing more is counted. */
static void test_counting_ends_where_it_is_of_no_use(void) {
    dice d = dice_of("price_counted ends", 432);
    priced p;
    begin(&p, "mps2-an386");
    for (int stop_at = 0; stop_at < 3; stop_at++) {
        answers a;
        draw_answers(&d, &p, &a);
        for (int i = 0; i < SETTINGS;
             i++) { /* which are expected to cost little, and all cost much */
            snprintf(a.row[i], sizeof a.row[i],
                     "a,g,\"f\",mps2-an386,s,n,o,%d,%d,%d,%d,estimated,9000,900,900", 90000 + i,
                     90000 + i, 90000 + i, 90000 + i);
        }
        told t = {.stop_at = stop_at};
        choice_wish w = {.error = 1e-2, .rate_Hz = rate_Hz, .periods = 1, .operations = 1e9};
        w.counting = count_told;
        w.context = &t;
        p.trial.wish.stop = &t.stop;
        measured_prices m = {.words = &words};
        measured_end end = MEASURED_MISSING;
        tree_enter();
        write_script(&a);
        if (stop_at == 0) {
            tree_keep("mk/price/measure_one.sh", "echo again >>asked\nexit 2\n");
        }
        (void)choice_counted(&p.trial, &w, &m, &end);
        const char *asked = tree_taken("asked");
        if (stop_at == 0) {
            TEST_ASSERT_EQUAL_INT(MEASURED_MISSING, end); /* by the first that was asked */
            TEST_ASSERT_EQUAL_STRING("again\n", asked);
            TEST_ASSERT_EQUAL_INT(0, m.count);
        } else {
            TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, end);
            TEST_ASSERT_EQUAL_INT(stop_at, m.count);
            TEST_ASSERT_TRUE(p.trial.stopped);
        }
        tree_leave();
        p.trial.stopped = false;
        p.trial.wish.stop = NULL;
        measured_free(&m);
    }
    priced_close(&p);
}

/* With contacts whole runs are counted, each pace for itself, and what one of them teaches is kept. */
static void test_runs_are_counted_and_teach(void) {
    priced p;
    priced_open(&p, priced_ball, 1);
    p.takes = priced_is_tried;
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", (whole_ratio){1, 20}, RECORDS, NULL));
    choice_wish w = {.error = 1e-2, .rate_Hz = rate_Hz, .periods = 1, .operations = 1e9};
    measured_prices m = {.words = &words};
    measured_end end = MEASURED_MISSING;
    tree_enter();
    tree_keep("mk/price/measure_one.sh",
              "echo \"$@\" >>asked\ncase \"$*\" in *float*) n=7000 ;; *) n=90000 ;; esac\n"
              "echo \"mps2-an386,f,1000,500,$n,0,600,$n,0,e,9000,900,300\"\n");
    const choice c = choice_counted(&p.trial, &w, &m, &end);
    const char *asked = tree_taken("asked");
    TEST_ASSERT_NOT_NULL(strstr(asked, "--whole-run"));
    tree_leave();
    TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, end);
    TEST_ASSERT_TRUE(m.by_run && p.trial.without_events && m.count > 0);
    TEST_ASSERT_TRUE(c.found && measured_has(&m, &c.best.setting, c.best.pace));
    TEST_ASSERT_TRUE(!c.has_second || measured_has(&m, &c.second.setting, c.second.pace));
    TEST_ASSERT_TRUE(c.best.cost.instructions_worst.value == 7000.0);
    TEST_ASSERT_TRUE(c.best.setting.number == &engine_float);
    const measured_lesson *l = &m.lesson[COST_FLOAT];
    TEST_ASSERT_TRUE(l->share > 0.0 && l->flash_bytes != 0.0);
    measured_free(&m);
    priced_close(&p);
}

void suite_price_counted(void) {
    RUN_TEST(test_drawn_choices_are_as_if_all_were_counted);
    RUN_TEST(test_counting_ends_where_it_is_of_no_use);
    RUN_TEST(test_runs_are_counted_and_teach);
}
