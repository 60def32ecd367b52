/* test_price_front.c: rows of error against price (host/study/price_table.h): sorted, and which are on the front, against
 * all pairs of drawn rows; the steps that are tried; and what of a price a row is sorted by. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/study/price_table.h"
#include "unity.h"

void suite_price_front(void);

enum { ROWS_MOST = 40 };

/* Is row a before row b? */
static bool comes_before(const table_row *a, const table_row *b) {
    return a->price.value < b->price.value ||
           (a->price.value == b->price.value &&
            (a->result.error < b->result.error ||
             (a->result.error == b->result.error && a->pace.steps < b->pace.steps)));
}

/* Does a leave nothing to say for b: no dearer, errs no more, and is not the same that was tried later? */
static bool beats(const table_row *a, const table_row *b) {
    return a->price.value <= b->price.value && a->result.error <= b->result.error &&
           (a->price.value < b->price.value || a->result.error < b->result.error ||
            a->pace.steps < b->pace.steps);
}

/* Few values, so that many rows are alike in one or both. */
static void test_drawn_rows_are_sorted_and_their_front_is_marked(void) {
    dice d = dice_of("price_front", 1);
    for (unsigned n = 0; n < dice_cases(few_or_all(400, 20000)); n++) {
        table_row row[ROWS_MOST];
        table made = {.row = row, .count = (int)dice_one_of(&d, ROWS_MOST + 1)};
        const unsigned values = 1 + dice_one_of(&d, 30);
        for (int i = 0; i < made.count; i++) {
            row[i] = (table_row){.pace = {(uint64_t)i, 1}, .on_front = dice_one_of(&d, 2) == 1};
            row[i].price.value = dice_one_of(&d, values);
            row[i].result.error = dice_one_of(&d, values);
            row[i].cost.why = dice_one_of(&d, 2) == 1 ? "a" : "b";
        }
        table_row before[ROWS_MOST];
        memcpy(before, row, sizeof row);
        table_sort(&made);
        bool seen[ROWS_MOST] = {false};
        for (int i = 0; i < made.count; i++) {
            const table_row *was = &before[row[i].pace.steps];
            TEST_ASSERT_FALSE(seen[row[i].pace.steps]);
            seen[row[i].pace.steps] = true;
            TEST_ASSERT_TRUE(was->price.value == row[i].price.value &&
                             was->result.error == row[i].result.error &&
                             was->cost.why == row[i].cost.why);
            TEST_ASSERT_TRUE(i == 0 || comes_before(&row[i - 1], &row[i]));
            bool beaten = false;
            for (int k = 0; k < made.count; k++) {
                beaten = beaten || (k != i && beats(&row[k], &row[i]));
            }
            TEST_ASSERT_EQUAL_INT(!beaten, row[i].on_front);
        }
    }
}

/* By 50, 20, 10, 5, 2 records a step, then 1, 2, 5, 10, ... steps a record, to 5e7. */
static void test_the_ladder_goes_down_by_one_two_five(void) {
    double length = 100.0;
    const table_wish w = {.rate_Hz = 0.0};
    deviation_pace p;
    int rungs = 0;
    for (; table_pace(&w, rungs, &p); rungs++) {
        const double next = (double)p.records / (double)p.steps;
        TEST_ASSERT_TRUE(p.records == 1 || p.steps == 1);
        TEST_ASSERT_TRUE(p.records != 0 && p.steps != 0);
        /* from 1 and 10, half; from 5, two fifths; from 2, half */
        const double digit = length / pow(10.0, floor(log10(length * 1.000001)));
        const double part = digit > 4.0 && digit < 6.0 ? 0.4 : 0.5;
        TEST_ASSERT_TRUE(fabs(next / (length * part) - 1.0) < 1e-9);
        length = next;
    }
    TEST_ASSERT_EQUAL_INT(5 + 24, rungs);
    TEST_ASSERT_TRUE(table_pace(&w, 0, &p) && p.records == 50);
    TEST_ASSERT_TRUE(table_pace(&w, 5, &p) && p.steps == 1 && p.records == 1);
    TEST_ASSERT_TRUE(table_pace(&w, 28, &p) && p.steps == 50000000);
}

/* With a rate: rising numbers of steps in a period of so many to a record, all of 1 to 10 among them. */
static void test_substeps_rise_as_they_are_told(void) {
    for (uint64_t periods = 1; periods < 6; periods++) {
        const table_wish w = {.rate_Hz = 7.0, .periods = periods};
        table_row row = {.pace = {0, 1}};
        uint64_t before = 0;
        for (int rung = 0; table_pace(&w, rung, &row.pace); rung++) {
            const uint64_t steps = table_substeps(&w, &row);
            TEST_ASSERT_TRUE(row.pace.records == 1 && row.pace.steps == steps * periods);
            TEST_ASSERT_TRUE(steps > before && (rung >= 10 || steps == before + 1));
            TEST_ASSERT_TRUE((double)steps <= 1.5 * (double)before || rung < 2);
            before = steps;
        }
        TEST_ASSERT_EQUAL_UINT64(800000, before);
    }
    const table_row row = {.pace = {4, 1}};
    TEST_ASSERT_EQUAL_UINT64(0, table_substeps(&(table_wish){.periods = 1}, &row));
}

static cost_figure drawn_figure(dice *d) {
    return (cost_figure){.basis = (cost_basis)dice_one_of(d, COST_BASES),
                         .value = dice_between(d, 1.0, 900.0),
                         .least = dice_between(d, 0.1, 1.0),
                         .most = dice_between(d, 900.0, 9000.0)};
}

static void test_prices_are_cycles_where_somebody_counts_them(void) {
    dice d = dice_of("price_front prices", 2);
    for (int n = 0; n < 2000; n++) {
        const cost c = {.instructions = drawn_figure(&d), .cycles = drawn_figure(&d)};
        const double step_s = dice_between(&d, 1e-4, 1.0);
        bool known = dice_one_of(&d, 2) == 1;
        const table_price p = table_price_of(&c, step_s, &known);
        const bool no_cycles = c.cycles.basis == COST_NOT_KNOWN || c.cycles.basis == COST_RANGE;
        const cost_figure *f = no_cycles ? &c.instructions : &c.cycles;
        TEST_ASSERT_EQUAL_INT(no_cycles ? PRICE_INSTRUCTIONS : PRICE_CYCLES, p.unit);
        TEST_ASSERT_EQUAL_INT(f->basis, p.basis);
        TEST_ASSERT_EQUAL_INT(f->basis != COST_NOT_KNOWN && f->basis != COST_RANGE, known);
        TEST_ASSERT_TRUE(fabs(p.value * step_s / f->value - 1.0) < 1e-12);
        TEST_ASSERT_TRUE(fabs(p.least * step_s / f->least - 1.0) < 1e-12);
        TEST_ASSERT_TRUE(fabs(p.most * step_s / f->most - 1.0) < 1e-12);
    }
    TEST_ASSERT_EQUAL_STRING("cycles", table_unit_words[PRICE_CYCLES]);
    TEST_ASSERT_EQUAL_STRING("instructions", table_unit_words[PRICE_INSTRUCTIONS]);
    TEST_ASSERT_EQUAL_STRING("evaluations", table_unit_words[PRICE_EVALUATIONS]);
}

void suite_price_front(void) {
    RUN_TEST(test_drawn_rows_are_sorted_and_their_front_is_marked);
    RUN_TEST(test_the_ladder_goes_down_by_one_two_five);
    RUN_TEST(test_substeps_rise_as_they_are_told);
    RUN_TEST(test_prices_are_cycles_where_somebody_counts_them);
}
