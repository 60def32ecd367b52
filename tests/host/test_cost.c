/* test_cost.c: prices that are predicted (host/price): whole, within themselves, and growing with what is asked for. That
 * they are right is another test's: tests/cli/price_predicts.sh holds them against counted steps. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiled_flights.h"
#include "derived.h"
#include "host/lang/model.h"
#include "host/price/cost.h"
#include "host/price/cost_row.h"
#include "unity.h"

void suite_cost(void);

static const cost_number numbers[] = {COST_FLOAT, COST_DOUBLE, COST_FIXED};

/* A figure holds together: nothing that is not known has a number, and no best number stands outside its bounds. */
static void expect_whole(const cost_figure *f, const char *what) {
    switch (f->basis) {
    case COST_NOT_KNOWN:
        TEST_ASSERT_TRUE_MESSAGE(f->value == 0.0 && f->least == 0.0 && f->most == 0.0, what);
        break;
    case COST_EXACT:
        TEST_ASSERT_TRUE_MESSAGE(f->value == f->least && f->value == f->most, what);
        break;
    case COST_PREDICTED:
        TEST_ASSERT_TRUE_MESSAGE(f->value > 0.0 && f->bound > 1.0, what);
        TEST_ASSERT_TRUE_MESSAGE(f->least <= f->value && f->value <= f->most, what);
        TEST_ASSERT_TRUE_MESSAGE(
            f->of == COST_MEASURED || f->of == COST_ESTIMATED || f->of == COST_SIMULATED, what);
        break;
    case COST_RANGE:
        TEST_ASSERT_TRUE_MESSAGE(f->value == 0.0 && f->least >= 0.0 && f->least < f->most, what);
        break;
    case COST_MEASURED:
    case COST_ESTIMATED:
    case COST_SIMULATED: TEST_FAIL_MESSAGE(what); break;
    }
}

static int check_whole(const scene *s) {
    char what[160];
    derived d = derived_builtin(s->name);
    int priced = 0;
    derived_expect(&d, s->name);
    for (int b = 0; b < cost_board_count; b++) {
        for (int n = 0; n < COST_NUMBERS; n++) {
            const cost c = cost_of(d.image, &cost_boards[b], numbers[n]);
            const cost_figure *const figures[] = {
                &c.instructions, &c.instructions_worst, &c.cycles,      &c.cycles_worst,
                &c.flash_bytes,  &c.ram_bytes,          &c.stack_bytes, &c.state_bytes};
            snprintf(what, sizeof what, "%s on %s", s->name, cost_boards[b].name);
            for (size_t i = 0; i < sizeof figures / sizeof figures[0]; i++) {
                expect_whole(figures[i], what);
            }
            TEST_ASSERT_TRUE_MESSAGE(c.instructions_worst.basis == COST_NOT_KNOWN ||
                                         c.instructions_worst.most >= c.instructions.least,
                                     what);
            TEST_ASSERT_TRUE_MESSAGE(c.predictable || c.why[0] != '\0', what);
            priced += c.predictable;
        }
    }
    derived_free(&d);
    return priced;
}

static void prices_are_whole(void) {
    /* every board in float at least */
    TEST_ASSERT_GREATER_THAN_INT(60 * cost_board_count, each_builtin_scene(check_whole));
}

/* What a step is predicted to take with these settings. */
static double instructions(image *im, const cost_board *board, wh_method method, bool compensated) {
    const image_settings before = im->settings;
    im->settings.method = method;
    im->settings.compensated = compensated;
    const cost c = cost_of(im, board, COST_FLOAT);
    im->settings = before;
    return c.instructions.value;
}

static int check_monotonic(const scene *s) {
    char what[160];
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    for (int b = 0; b < cost_board_count && d.image->contacts == 0; b++) {
        const cost_board *board = &cost_boards[b];
        const double one = instructions(d.image, board, WH_EULER, false);
        const double two = instructions(d.image, board, WH_HEUN, false);
        const double four = instructions(d.image, board, WH_RK4, false);
        snprintf(what, sizeof what, "%s on %s: %g %g %g", s->name, board->name, one, two, four);
        if (one > 0.0 && two > 0.0 && four > 0.0) {
            TEST_ASSERT_TRUE_MESSAGE(one <= two && two <= four, what);
            TEST_ASSERT_TRUE_MESSAGE(instructions(d.image, board, WH_RK4, true) >= four, what);
            TEST_ASSERT_TRUE_MESSAGE(instructions(d.image, board, WH_HEUN, true) >= two, what);
        }
    }
    derived_free(&d);
    return 1;
}

static void more_stages_and_compensated_sums_are_never_cheaper(void) {
    TEST_ASSERT_GREATER_THAN_INT(50, each_builtin_scene(check_monotonic));
}

/* A row of masses, each further one with a spring: more of everything. */
static void a_longer_row_costs_more(void) {
    for (int b = 0; b < cost_board_count; b++) {
        cost before = {0};
        for (int n = 1; n <= 12; n += n) {
            char *T = repeated("mechanism row \"Row\"\n", "coordinate x# [m]\n", n,
                               "parameter m = 2 [kg]\nparameter k = 30 [N/m]\n");
            char *energy = repeated("T = 0 [J]", " + m*x#'^2/2", n, "\n");
            char *spring = repeated("V = 0 [J]", " + k*(x# + x#^3/(1 [m^2]))^2/2", n, "\n");
            char *text = malloc(strlen(T) + strlen(energy) + strlen(spring) + 1);
            TEST_ASSERT_NOT_NULL(text);
            strcpy(text, T);
            strcat(strcat(text, energy), spring);
            derived d = derived_text(text);
            derived_expect(&d, text);
            const cost c = cost_of(d.image, &cost_boards[b], COST_FLOAT);
            TEST_ASSERT_TRUE_MESSAGE(c.predictable, cost_boards[b].name);
            TEST_ASSERT_TRUE_MESSAGE(c.instructions.value > before.instructions.value,
                                     cost_boards[b].name);
            TEST_ASSERT_TRUE_MESSAGE(c.cycles.most > before.cycles.most, cost_boards[b].name);
            TEST_ASSERT_TRUE_MESSAGE(c.state_bytes.value > before.state_bytes.value,
                                     cost_boards[b].name);
            before = c;
            derived_free(&d);
            free(T);
            free(energy);
            free(spring);
            free(text);
        }
    }
}

/* As `whirl describe` and the generated headers have it (WH_MEMORY_BYTES). */
static void state_bytes_are_those_of_the_header(void) {
    static const struct {
        const char *name;
        double in_float, in_double;
    } rows[] = {{"thomson_a", 36.0, 56.0}, {"epicyclic_from_rest", 24.0, 40.0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        derived d = derived_builtin(rows[i].name);
        derived_expect(&d, rows[i].name);
        const cost_board *board = cost_board_named("mps2-an386");
        TEST_ASSERT_TRUE(cost_of(d.image, board, COST_FLOAT).state_bytes.value == rows[i].in_float);
        TEST_ASSERT_TRUE(cost_of(d.image, board, COST_DOUBLE).state_bytes.value ==
                         rows[i].in_double);
        derived_free(&d);
    }
}

/* The table has every board there is, and none that there is not; an STM32F405 is priced as its processor, mps2-an386. */
static void every_board_has_a_row(void) {
    char path[128];
    char line[64];
    FILE *boards = popen("grep -L stm32f4.mk boards/*/board.mk", "r");
    int count = 0;
    TEST_ASSERT_NOT_NULL(boards);
    while (fgets(path, sizeof path, boards) != NULL) {
        TEST_ASSERT_EQUAL_INT(1, sscanf(path, "boards/%63[^/]", line));
        TEST_ASSERT_NOT_NULL_MESSAGE(cost_board_named(line), line);
        count++;
    }
    pclose(boards);
    TEST_ASSERT_EQUAL_INT(cost_board_count, count + 1); /* and the host */
    TEST_ASSERT_NOT_NULL(cost_board_named("host"));
    TEST_ASSERT_NULL(cost_board_named("mps2"));
}

static void measured_rows_are_read(void) {
    const cost_board *m4 = cost_board_named("mps2-an386");
    const cost_board *m7 = cost_board_named("mps2-an500");
    cost c = {0};
    TEST_ASSERT_TRUE(cost_measured(
        "abc1234,arm-none-eabi-gcc 12.2.1,\"-mcpu=cortex-m4, -O2\",mps2-an386,thomson_a,float,rk4,"
        "555,560,708.5,712,estimated,7120,124,268\n",
        m4, &c));
    TEST_ASSERT_TRUE(c.instructions.value == 555.0 && c.instructions.basis == COST_MEASURED);
    TEST_ASSERT_TRUE(c.instructions_worst.value == 560.0);
    TEST_ASSERT_TRUE(c.cycles.value == 708.5 && c.cycles.basis == COST_ESTIMATED);
    TEST_ASSERT_TRUE(c.flash_bytes.value == 7120.0 && c.ram_bytes.value == 124.0 &&
                     c.stack_bytes.value == 268.0);
    /* nobody counts a Cortex-M7's cycles: a range, and no number */
    TEST_ASSERT_TRUE(
        cost_measured("a,gcc,\"-O2\",mps2-an500,s,float,rk4,100,100,,,,7120,124,268", m7, &c));
    TEST_ASSERT_TRUE(c.cycles.basis == COST_RANGE && c.cycles.value == 0.0 &&
                     c.cycles.least < c.cycles.most);
    /* another board's, one column less or more, the header, nothing */
    TEST_ASSERT_FALSE(
        cost_measured("a,gcc,\"-O2\",mps2-an500,s,float,rk4,100,100,,,,7120,124,268", m4, &c));
    TEST_ASSERT_FALSE(
        cost_measured("a,gcc,\"-O2\",mps2-an386,s,float,rk4,100,100,,,,7120,124", m4, &c));
    TEST_ASSERT_FALSE(
        cost_measured("a,gcc,\"-O2\",mps2-an386,s,float,rk4,100,100,,,,7120,124,268,9", m4, &c));
    TEST_ASSERT_FALSE(cost_measured(COST_HEADER, m4, &c));
    TEST_ASSERT_FALSE(cost_measured("", m4, &c));
}

/* The arithmetic of a step whose list computes nothing, held against what a compiler makes of it. */
static void a_steps_own_arithmetic_is_counted(void) {
    derived d = derived_builtin("cartesian_flight");
    derived_expect(&d, "cartesian_flight");
    const image_settings before = d.image->settings;
    for (int i = 0; i < COMPILED_FLIGHTS; i++) {
        d.image->settings.method = compiled_flights[i].method;
        d.image->settings.compensated = compiled_flights[i].compensated;
        const cost_counts c = cost_counts_of(d.image, cost_board_named("mps2-an385"), COST_FLOAT);
        const char *word = wh_methods[compiled_flights[i].method].word;
        TEST_ASSERT_TRUE_MESSAGE(
            c.moves.products + c.moves.zero_products == compiled_flights[i].products, word);
        TEST_ASSERT_TRUE_MESSAGE(c.moves.sums + c.moves.zero_sums == compiled_flights[i].sums,
                                 word);
        /* it falls along z: of x and y no acceleration is other than zero */
        TEST_ASSERT_TRUE_MESSAGE(c.moves.zero_products > 0.0, word);
    }
    d.image->settings = before;
    derived_free(&d);
}

/* Of what lies still all is zero, of what swings nothing; and where an FPU computes nobody asks. */
static void what_rests_is_seen(void) {
    derived d = derived_scene("mechanism two \"Two\"\ncoordinate x [m]\ncoordinate y [m]\n"
                              "T = 2 [kg]*(x'^2 + y'^2)/2\nV = 30 [N/m]*(x^2 + y^2)/2\n"
                              "scene two {\n  start x = 0.1 [m]\n  step 1 [ms]\n  until 1 [s]\n}\n",
                              "two");
    derived_expect(&d, "two");
    operands given = operands_of(d.image, COST_FLOAT);
    TEST_ASSERT_TRUE(given.rate[0] == 0.0 && given.accel[0] == 0.0);
    TEST_ASSERT_TRUE(given.rate[1] == 1.0 && given.accel[1] == 1.0);
    operands_free(&given);
    const cost_counts soft = cost_counts_of(d.image, cost_board_named("mps2-an385"), COST_FLOAT);
    const cost_counts hard = cost_counts_of(d.image, cost_board_named("mps2-an386"), COST_FLOAT);
    TEST_ASSERT_TRUE(soft.moves.zero_sums > 0.0 && soft.step.zero_products > 0.0);
    TEST_ASSERT_TRUE(hard.moves.sums == 0.0 && hard.step.zero_products == 0.0);
    derived_free(&d);
}

/* Angles that stay: where they hang, at zero, and beside what swings. Their pair is turned by nothing. */
static void angles_that_rest_are_seen(void) {
    static const struct {
        const char *start;
        double still, zero;
    } row[] = {{"a = 0 [rad], b = 0.2 [rad]", 1.0, 1.0},
               {"a = 0.1 [rad], b = 0.2 [rad]", 0.0, 0.0},
               {"a = 0 [rad], b = 0 [rad]", 2.0, 2.0},
               {"a = 0 [rad], a' = 1 [rad/s], b = 0.2 [rad]", 0.0, 0.0}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "mechanism two \"Two\"\ncoordinate a [rad]\ncoordinate b [rad]\n"
                 "T = 2 [kg*m^2]*(a'^2 + b'^2)/2\nV = -3 [J]*cos(a) - 4 [J]*cos(b)\n"
                 "scene two {\n  start %s\n  step 1 [ms]\n  until 1 [s]\n}\n",
                 row[i].start);
        derived d = derived_scene(text, "two");
        derived_expect(&d, text);
        const cost_counts soft =
            cost_counts_of(d.image, cost_board_named("mps2-an385"), COST_FLOAT);
        const cost_counts hard =
            cost_counts_of(d.image, cost_board_named("mps2-an386"), COST_FLOAT);
        TEST_ASSERT_TRUE_MESSAGE(soft.step.still_pairs == row[i].still, row[i].start);
        TEST_ASSERT_TRUE_MESSAGE(soft.step.zero_pairs == row[i].zero, row[i].start);
        TEST_ASSERT_TRUE_MESSAGE(hard.step.still_pairs == 0.0, row[i].start);
        derived_free(&d);
    }
}

/* Of a ledger beside a short list only what the step does not compute anyway; beside a long one all of it. */
static void books_share_with_short_lists(void) {
    static const char *const head = "mechanism row \"Row\"\n";
    for (int n = 1; n <= 16; n += 15) {
        char *T = repeated(head, "coordinate x# [m]\n", n, "T = 0 [J]");
        char *energy = repeated("", " + 2 [kg]*x#'^2/2", n, "\nV = 0 [J]");
        char *spring = repeated("", " + 30 [N/m]*(x# + x#^3/(1 [m^2]))^2/2", n, "\n");
        char *begin = repeated("scene row {\n  with ledger\n  step 1 [ms]\n  until 1 [s]\n  start ",
                               "x# = 0.1 [m], ", n - 1, "");
        char text[8192];
        snprintf(text, sizeof text, "%s%s%s%sx%d = 0.1 [m]\n}\n", T, energy, spring, begin, n);
        derived d = derived_scene(text, "row");
        derived_expect(&d, text);
        const cost_counts hard =
            cost_counts_of(d.image, cost_board_named("mps2-an386"), COST_FLOAT);
        const cost_counts soft =
            cost_counts_of(d.image, cost_board_named("mps2-an385"), COST_FLOAT);
        TEST_ASSERT_TRUE(d.image->ledger.kept && soft.books_called && soft.books.products > 0);
        TEST_ASSERT_TRUE(hard.books_called == (n > 1) && hard.called == (n > 1));
        TEST_ASSERT_TRUE(n > 1 ? hard.books.products == soft.books.products
                               : hard.books.products < soft.books.products);
        derived_free(&d);
        free(T);
        free(energy);
        free(spring);
        free(begin);
    }
}

/* What is told from more of something than any fitted row had is promised within more. */
static void what_is_extrapolated_is_promised_within_more(void) {
    cost_fit f = {.cases = 9,
                  .bound = {[COST_PLAIN] = 1.2, [COST_FAR] = 1.7},
                  .largest = 1000.0,
                  .is_parted = true};
    double feature[COST_FEATURES] = {0.0};
    f.figure[COST_F_SUMS] = f.figure[COST_F_PRODUCTS] = 2.0;
    f.part[COST_F_SUMS] = f.part[COST_F_PRODUCTS] = 0.6;
    for (int products = 0; products <= 10; products++) {
        feature[COST_F_SUMS] = 10 - products;
        feature[COST_F_PRODUCTS] = products;
        const bool is_far = products < 4 || products > 6;
        TEST_ASSERT_TRUE(cost_bound_at(&f, feature, 20.0) == (is_far ? 1.7 : 1.2));
    }
}

void suite_cost(void) {
    RUN_TEST(a_steps_own_arithmetic_is_counted);
    RUN_TEST(what_rests_is_seen);
    RUN_TEST(angles_that_rest_are_seen);
    RUN_TEST(books_share_with_short_lists);
    RUN_TEST(what_is_extrapolated_is_promised_within_more);
    RUN_TEST(prices_are_whole);
    RUN_TEST(more_stages_and_compensated_sums_are_never_cheaper);
    RUN_TEST(a_longer_row_costs_more);
    RUN_TEST(state_bytes_are_those_of_the_header);
    RUN_TEST(every_board_has_a_row);
    RUN_TEST(measured_rows_are_read);
}
