/* test_price_sums.c: sums of a row's figures and features (host/price/cost_row.h, cost_figure.h), drawn, against sums by hand;
 * the boards that there are; and rows that were measured. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/price/cost.h"
#include "host/price/cost_row.h"
#include "unity.h"

void suite_price_sums(void);

static bool near(double a, double b) { return fabs(a - b) <= 1e-12 * (fabs(a) + fabs(b)); }

/* --- drawn fits ------------------------------------------------------------------------------------------*/

static void draw_fit(dice *d, cost_fit *fit, double feature[COST_FEATURES]) {
    *fit = (cost_fit){.cases = 9,
                      .slack = dice_between(d, 0.0, 500.0),
                      .largest = dice_between(d, 100.0, 3000.0),
                      .is_parted = dice_one_of(d, 3) > 0};
    for (int c = 0; c < COST_CLASSES; c++) {
        fit->bound[c] = dice_between(d, 1.1, 4.0);
    }
    const bool wide = dice_one_of(d, 2) == 1; /* parts that no feature is beyond */
    for (int f = 0; f < COST_FEATURES; f++) {
        const bool there = dice_one_of(d, 4) == 0;
        fit->figure[f] = there ? dice_between(d, 0.1, 20.0) : 0.0;
        fit->part[f] = wide ? 1.0 : dice_between(d, 0.0, 0.2);
        feature[f] = dice_one_of(d, 3) == 0 ? 1 + dice_one_of(d, 9) : 0.0;
    }
    static const cost_feature classes[] = {COST_F_BOOKS, COST_F_CODE_CALLS, COST_F_MATRIX,
                                           COST_F_CELLS};
    for (int i = 0; i < 4; i++) {
        feature[classes[i]] = dice_one_of(d, 3) == 0 ? 2.0 : 0.0;
    }
}

static void test_drawn_sums_and_their_bounds(void) {
    dice d = dice_of("price_rows", 81);
    int of[COST_CLASSES] = {0};
    for (unsigned n = 0; n < dice_cases(few_or_all(500, 20000)); n++) {
        cost_fit fit;
        double feature[COST_FEATURES];
        draw_fit(&d, &fit, feature);
        double sum = 0.0;
        for (int f = 0; f < COST_FEATURES; f++) {
            sum += fit.figure[f] * feature[f];
        }
        int unseen = -1;
        const double have = cost_fit_at(&fit, feature, &unseen);
        TEST_ASSERT_TRUE(near(have, sum) && unseen == -1);
        /* of the sum, what is more than any fitted row had of a feature */
        double more = 0.0;
        for (int f = 0; f < COST_FEATURES; f++) {
            more += fmax(0.0, fit.figure[f] * feature[f] / sum - fit.part[f]);
        }
        const cost_class own = feature[COST_F_BOOKS] > 0        ? COST_BOOKING
                               : feature[COST_F_CODE_CALLS] > 0 ? COST_CALLING
                               : feature[COST_F_MATRIX] > 0     ? COST_AS_MATRIX
                               : feature[COST_F_CELLS] > 0      ? COST_TABLED
                                                                : COST_PLAIN;
        const cost_class is = fit.is_parted && more > 0.05 ? COST_FAR : own;
        of[is]++;
        TEST_ASSERT_EQUAL_INT(is, cost_class_at(&fit, feature, sum));
        const double bound = fmax(fit.bound[is], fit.bound[own]);
        TEST_ASSERT_TRUE(near(cost_bound_at(&fit, feature, sum),
                              sum > fit.largest ? bound + (bound - 1.0) : bound));
        TEST_ASSERT_TRUE(near(cost_most(&fit, sum, bound), sum * bound + fit.slack));
        TEST_ASSERT_TRUE(near(cost_least(&fit, sum, bound), fmax(0.0, (sum - fit.slack) / bound)));
        TEST_ASSERT_TRUE(cost_class_at(&fit, feature, -1.0) == own);
        /* a feature that no fitted scene has, unless the image has none of it either */
        const int at = (int)dice_one_of(&d, COST_FEATURES);
        const double before = feature[at];
        fit.figure[at] = COST_UNSEEN;
        feature[at] = 0.0;
        TEST_ASSERT_TRUE(cost_fit_at(&fit, feature, &unseen) >= 0.0 && unseen == -1);
        feature[at] = before + 1.0;
        TEST_ASSERT_TRUE(cost_fit_at(&fit, feature, &unseen) < 0.0 && unseen == at);
    }
    for (int c = 0; c < COST_CLASSES; c++) {
        TEST_ASSERT_TRUE(of[c] > 0);
    }
}

static void test_figures_are_made_of_figures(void) {
    dice d = dice_of("price_rows figures", 82);
    for (int n = 0; n < 300; n++) {
        const double value = dice_between(&d, 1.0, 99.0);
        const cost_figure known = cost_known(value, COST_EXACT);
        TEST_ASSERT_TRUE(known.value == value && known.least == value && known.most == value);
        TEST_ASSERT_TRUE(known.basis == COST_EXACT && known.of == COST_EXACT && known.bound == 1.0);
        const cost_figure mean = {COST_PREDICTED, COST_MEASURED, value, 0.5 * value, 3 * value, 3};
        const double spread = dice_between(&d, 1.0, 2.0);
        const cost_figure longest = cost_longest(mean, spread);
        TEST_ASSERT_TRUE(near(longest.value, value * spread));
        TEST_ASSERT_TRUE(near(longest.most, 3.0 * value * spread) && longest.least == mean.least);
        TEST_ASSERT_TRUE(longest.basis == COST_PREDICTED && longest.bound == 3.0);
        const cost_board board = {.cycles_least = dice_between(&d, 0.2, 1.0),
                                  .cycles_most = dice_between(&d, 2.0, 5.0)};
        const cost_figure ranged = cost_ranged(&board, &mean);
        TEST_ASSERT_TRUE(near(ranged.least, board.cycles_least * 0.5 * value));
        TEST_ASSERT_TRUE(near(ranged.most, board.cycles_most * 3.0 * value));
        TEST_ASSERT_TRUE(ranged.value == 0.0 && ranged.bound == 1.0);
        TEST_ASSERT_TRUE(ranged.basis == COST_RANGE && ranged.of == COST_PREDICTED);
        const cost_figure nothing = {0};
        TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, cost_ranged(&board, &nothing).basis);
        TEST_ASSERT_TRUE(cost_ranged(&board, &nothing).most == 0.0);
        TEST_ASSERT_TRUE(near(cost_bound_of(5.0, 4.0, 1.5), 2.0));
        TEST_ASSERT_TRUE(cost_bound_of(4.0, 4.0, 1.5) == 1.5);
    }
}

/* --- boards ----------------------------------------------------------------------------------------------*/

/* Chips by their data sheets; cycles an instruction as docs/price.md says what is assumed. */
static void test_boards_are_found_by_their_names(void) {
    static const struct {
        const char *name;
        bool fpu, in_double;
        int registers;
        cost_basis cycles;
        double least, most; /* cycles an instruction */
        int clock_MHz, flash_KB, ram_KB;
    } rows[] = {{"atmega328p", false, false, 0, COST_SIMULATED, 0.0, 0.0, 16, 32, 2},
                {"atmega2560", false, false, 0, COST_SIMULATED, 0.0, 0.0, 16, 256, 8},
                {"mps2-an385-m0", false, false, 0, COST_ESTIMATED, 0.0, 0.0, 0, 0, 0},
                {"mps2-an385", false, false, 0, COST_ESTIMATED, 0.0, 0.0, 0, 0, 0},
                {"mps2-an386", true, false, 32, COST_ESTIMATED, 0.0, 0.0, 0, 0, 0},
                {"mps2-an500", true, false, 32, COST_RANGE, 0.5, 3.0, 0, 0, 0},
                {"mps2-an505", true, false, 32, COST_RANGE, 0.8, 3.0, 0, 0, 0},
                {"rv32imac", false, false, 0, COST_RANGE, 1.0, 4.0, 0, 0, 0},
                {"rv32imafc", true, false, 32, COST_RANGE, 1.0, 5.0, 0, 0, 0},
                {"host", true, true, 16, COST_RANGE, 0.2, 3.0, 0, 0, 0}};
    TEST_ASSERT_EQUAL_INT(10, cost_board_count);
    for (int i = 0; i < cost_board_count; i++) {
        const cost_board *b = cost_board_named(rows[i].name);
        TEST_ASSERT_EQUAL_PTR(&cost_boards[i], b);
        TEST_ASSERT_EQUAL_INT(!rows[i].fpu, cost_is_soft(b, COST_FLOAT));
        TEST_ASSERT_EQUAL_INT(!rows[i].in_double, cost_is_soft(b, COST_DOUBLE));
        TEST_ASSERT_EQUAL_INT(rows[i].registers, cost_registers(b, COST_FLOAT));
        TEST_ASSERT_EQUAL_INT(rows[i].in_double ? 16 : 0, cost_registers(b, COST_DOUBLE));
        TEST_ASSERT_EQUAL_INT(rows[i].cycles, b->cycles);
        TEST_ASSERT_TRUE(b->cycles_least == rows[i].least && b->cycles_most == rows[i].most);
        TEST_ASSERT_TRUE(b->clock_Hz == 1e6 * rows[i].clock_MHz);
        TEST_ASSERT_EQUAL_INT(1024 * rows[i].flash_KB, b->flash_bytes);
        TEST_ASSERT_EQUAL_INT(1024 * rows[i].ram_KB, b->ram_bytes);
    }
    static const char *const numbers[] = {"float", "double", "fixed"};
    for (int n = 0; n < COST_NUMBERS; n++) {
        TEST_ASSERT_EQUAL_STRING(numbers[n], cost_number_words[n]);
    }
    TEST_ASSERT_NULL(cost_board_named("mps2-an38"));
    TEST_ASSERT_NULL(cost_board_named(""));
    static const char *const words[] = {"not known", "exact",     "predicted", "measured",
                                        "estimated", "simulated", "range"};
    for (int i = 0; i < COST_BASES; i++) {
        TEST_ASSERT_EQUAL_STRING(words[i], cost_basis_words[i]);
    }
}

/* A row of fifteen columns, cut at the commas outside quotes; no fewer and no more of them. */
static void test_measured_rows_have_fifteen_columns(void) {
    const cost_board *board = cost_board_named("mps2-an386");
    for (int columns = 12; columns <= 18; columns++) {
        char row[400] = "commit,gcc 12,\"-O2, -g, \",mps2-an386,s,float,rk4";
        for (int i = 7; i < columns; i++) {
            size_t to = strlen(row);
            snprintf(row + to, sizeof row - to, i == 11 ? ",estimated" : ",%d", 100 + i);
        }
        strcat(row, columns % 2 ? "\n" : "");
        cost c = {.why = "before"};
        const bool is = cost_measured(row, board, &c);
        TEST_ASSERT_EQUAL_INT_MESSAGE(columns == 15, is, row);
        TEST_ASSERT_EQUAL_INT(is, c.predictable);
        TEST_ASSERT_EQUAL_STRING(is ? "" : "before", c.why);
        TEST_ASSERT_TRUE(c.instructions.value == (is ? 107.0 : 0.0));
        TEST_ASSERT_TRUE(c.cycles_worst.most == (is ? 110.0 : 0.0));
        TEST_ASSERT_TRUE(c.flash_bytes.value == (is ? 112.0 : 0.0));
        TEST_ASSERT_TRUE(c.stack_bytes.least == (is ? 114.0 : 0.0));
    }
}

/* A row has room for so much, and no more. */
static void test_measured_rows_have_an_end(void) {
    const cost_board *board = cost_board_named("host");
    for (size_t length = 1000; length < 1050; length++) {
        char row[1100] = {0};
        const char *const rest = ",gcc,f,host,s,float,rk4,1,2,3,4,estimated,5,6,7";
        memset(row, 'c', length - strlen(rest));
        strcat(row, rest);
        cost c = {.why = "before"};
        TEST_ASSERT_EQUAL_INT(length < 1024, cost_measured(row, board, &c));
        TEST_ASSERT_EQUAL_INT(length < 1024, c.predictable);
    }
}

void suite_price_sums(void) {
    RUN_TEST(test_measured_rows_have_an_end);
    RUN_TEST(test_measured_rows_have_fifteen_columns);
    RUN_TEST(test_drawn_sums_and_their_bounds);
    RUN_TEST(test_figures_are_made_of_figures);
    RUN_TEST(test_boards_are_found_by_their_names);
}
