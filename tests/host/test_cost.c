/* test_cost.c: predicted prices (host/study/cost.h). Figures must lie within their bounds, be larger for more work,
 * and agree with the counted steps of docs/figures/price.csv. */
#include "command.h"
#include "derived.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/fixed/fixed_plan.h"
#include "host/lang/model.h"
#include "host/study/cost.h"

static const cost_number numbers[] = {COST_FLOAT, COST_DOUBLE};

/* Fails the test if a figure contradicts itself: an unknown figure has no number, and the best estimate lies within
 * its bounds. */
static void expect_whole(const cost_figure *f, const char *what) {
    switch (f->basis) {
    case COST_NOT_KNOWN:
        TEST_ASSERT_TRUE_MESSAGE(f->value == 0.0 && f->least == 0.0 && f->most == 0.0, what);
        break;
    case COST_EXACT:
        TEST_ASSERT_TRUE_MESSAGE(f->value == f->least && f->value == f->most, what);
        break;
    case COST_PREDICTED:
        TEST_ASSERT_TRUE_MESSAGE(f->value > 0.0 && f->most > f->value, what);
        TEST_ASSERT_TRUE_MESSAGE(f->least <= f->value && f->value <= f->most, what);
        break;
    case COST_RANGE:
        TEST_ASSERT_TRUE_MESSAGE(f->value == 0.0 && f->least >= 0.0 && f->least < f->most, what);
        break;
    case COST_MEASURED:
    case COST_ESTIMATED:
    case COST_SIMULATED: TEST_FAIL_MESSAGE(what); break;
    }
}

/* Fails the test if a price of the image, on any board and with any number type, contradicts itself. Returns
 * how many of these prices are known. */
static int check_whole(image *im, const scene *s) {
    char what[160];
    int priced = 0;
    for (int b = 0; b < cost_board_count; b++) {
        for (int n = 0; n < 2; n++) {
            const cost c = cost_of(im, &cost_boards[b], numbers[n]);
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
            const bool known = c.instructions.basis != COST_NOT_KNOWN;
            TEST_ASSERT_TRUE_MESSAGE(known || c.why[0] != '\0', what);
            TEST_ASSERT_TRUE_MESSAGE(im->contacts == 0 || !known, what);
            priced += known;
        }
    }
    return priced;
}

static double instructions(image *im, const cost_board *board, wh_method method, bool compensated) {
    const image_settings before = im->settings;
    im->settings.method = method;
    im->settings.compensated = compensated;
    const cost c = cost_of(im, board, COST_FLOAT);
    im->settings = before;
    return c.instructions.value;
}

/* More stages and compensated sums are never cheaper. */
static void check_monotonic(image *im, const scene *s) {
    char what[160];
    for (int b = 0; b < cost_board_count && im->contacts == 0; b++) {
        const cost_board *board = &cost_boards[b];
        const double one = instructions(im, board, WH_EULER, false);
        const double two = instructions(im, board, WH_HEUN, false);
        const double four = instructions(im, board, WH_RK4, false);
        snprintf(what, sizeof what, "%s on %s: %g %g %g", s->name, board->name, one, two, four);
        if (one > 0.0 && two > 0.0 && four > 0.0) {
            TEST_ASSERT_TRUE_MESSAGE(one <= two && two <= four, what);
            TEST_ASSERT_TRUE_MESSAGE(instructions(im, board, WH_RK4, true) >= four, what);
            TEST_ASSERT_TRUE_MESSAGE(instructions(im, board, WH_HEUN, true) >= two, what);
        }
    }
}

static int check_prices(const scene *s) {
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    const int priced = check_whole(d.image, s);
    check_monotonic(d.image, s);
    derived_free(&d);
    return priced;
}

TEST(cost, prices_are_whole_and_grow_with_the_work) {
    /* at least one price for each board, in float */
    TEST_ASSERT_GREATER_THAN_INT(30 * cost_board_count, each_builtin_scene(check_prices));
}

/* One more mass and spring in a row must raise every figure. */
TEST(cost, a_longer_row_costs_more) {
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
            TEST_ASSERT_TRUE_MESSAGE(c.instructions.basis == COST_PREDICTED, cost_boards[b].name);
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

/* The state's bytes must be those of `whirl describe` and of the generated header (WH_MEMORY_BYTES). */
TEST(cost, state_bytes_are_those_of_the_header) {
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

/* The table must have exactly the existing boards. An STM32F405 has the price of its processor, which is that of
 * mps2-an386. */
TEST(cost, every_board_has_a_row) {
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
    TEST_ASSERT_EQUAL_INT(cost_board_count, count + 1); /* the host has a row without a board */
    TEST_ASSERT_NOT_NULL(cost_board_named("host"));
    TEST_ASSERT_NULL(cost_board_named("mps2"));
}

static bool measured(const char *row, const cost_board *board, cost *c) {
    char copy[300];
    char *column[COST_COLUMNS];
    *c = (cost){0};
    snprintf(copy, sizeof copy, "%s", row);
    return cost_enter(copy, &cost_step_layout, column, board, c);
}

TEST(cost, measured_rows_are_read) {
    const cost_board *m4 = cost_board_named("mps2-an386");
    const cost_board *m7 = cost_board_named("mps2-an500");
    cost c;
    TEST_ASSERT_TRUE(measured(
        "abc1234,arm-none-eabi-gcc 12.2.1,\"-mcpu=cortex-m4, -O2\",mps2-an386,thomson_a,float,rk4,"
        "555,560,708.5,712,estimated,7120,124,268\n",
        m4, &c));
    TEST_ASSERT_TRUE(c.instructions.value == 555.0 && c.instructions.basis == COST_MEASURED);
    TEST_ASSERT_TRUE(c.instructions_worst.value == 560.0);
    TEST_ASSERT_TRUE(c.cycles.value == 708.5 && c.cycles.basis == COST_ESTIMATED);
    TEST_ASSERT_TRUE(c.flash_bytes.value == 7120.0 && c.ram_bytes.value == 124.0 &&
                     c.stack_bytes.value == 268.0);
    /* the cycles of a Cortex-M7 are not counted: they have a range instead of a number */
    TEST_ASSERT_TRUE(
        measured("a,gcc,\"-O2\",mps2-an500,s,float,rk4,100,100,,,,7120,124,268", m7, &c));
    TEST_ASSERT_TRUE(c.cycles.basis == COST_RANGE && c.cycles.value == 0.0 &&
                     c.cycles.least < c.cycles.most);
    /* refused: the row of another board, a column too few or too many, the header, an empty line */
    TEST_ASSERT_FALSE(
        measured("a,gcc,\"-O2\",mps2-an500,s,float,rk4,100,100,,,,7120,124,268", m4, &c));
    TEST_ASSERT_FALSE(measured("a,gcc,\"-O2\",mps2-an386,s,float,rk4,100,100,,,,7120,124", m4, &c));
    TEST_ASSERT_FALSE(
        measured("a,gcc,\"-O2\",mps2-an386,s,float,rk4,100,100,,,,7120,124,268,9", m4, &c));
    TEST_ASSERT_FALSE(measured(COST_HEADER, m4, &c));
    TEST_ASSERT_FALSE(measured("", m4, &c));
}

/* The text of a column in a row of docs/figures/price.csv. The file has no quotes. */
static const char *column_of(char *const *column, char *const *heads, int count, const char *name) {
    for (int i = 0; i < count; i++) {
        if (strcmp(heads[i], name) == 0) {
            return column[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

enum { HEADS = 24, WORDS = 40 };

static int cut_at(char *line, const char *separator, char **piece, int most) {
    int count = 0;
    for (char *at = strtok(line, separator); at != NULL && count < most;
         at = strtok(NULL, separator)) {
        piece[count++] = at;
    }
    return count;
}

/* The predicted price of the scene and settings on a `whirl run` command line. */
static cost priced_line(char *line, const cost_board *board, const char *number) {
    char *words[WORDS];
    common_options options = options_defaults();
    source_model from;
    loaded made = {0};
    const mechanism *of;
    const scene *in;
    bool bad = false;
    const int count = cut_at(line, " \n", words, WORDS);
    for (int at = 3; at < count && !bad;) {
        bad = !options_take("run", OPTIONS_ENGINE | OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_NUMBER,
                            count, words, &at, &options, &bad) ||
              bad;
    }
    const load_request request = {
        .settings = options.integration, .use = IMAGE_TO_WRITE, .conserve = true};
    const overrides changes = options.changes;
    TEST_ASSERT_FALSE(bad);
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, source_open(&from, words[2]));
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, source_pick(&from, true, &of, &in));
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, load(&made, &from, of, in, &changes, &request));
    const bool fixed = strcmp(number, "fixed") == 0;
    fixed_plan *plan = fixed ? fixed_plan_make(made.image, false, from.errors) : NULL;
    made.image->fixed = plan;
    const cost c = cost_of(made.image, board,
                           fixed                           ? COST_FIXED
                           : strcmp(number, "double") == 0 ? COST_DOUBLE
                                                           : COST_FLOAT);
    made.image->fixed = NULL;
    fixed_plan_free(plan);
    unload(&made);
    source_close(&from);
    options_forget(&options);
    return c;
}

static int by_size(const void *one, const void *other) {
    const double a = *(const double *)one;
    const double b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Compares with the counted rows of docs/figures/price.csv. The table of figures was made without these rows. */
TEST(cost, counted_steps_are_predicted) {
    static char head[2000];
    static char line[2000];
    static double factor[1000];
    char *heads[HEADS];
    char *column[HEADS];
    FILE *in = fopen("docs/figures/price.csv", "r");
    TEST_ASSERT_NOT_NULL(in);
    TEST_ASSERT_NOT_NULL(fgets(head, sizeof head, in));
    const int heads_count = cut_at(head, ",\n", heads, HEADS);
    int count = 0;
    int within = 0;
    for (int n = 0; fgets(line, sizeof line, in) != NULL; n++) {
        if (strstr(line, ",counted,") == NULL || n % (int)few_or_all(usual_or(3, 5), 1) != 0) {
            continue;
        }
        cut_at(line, ",", column, HEADS);
#define OF(name) column_of(column, heads, heads_count, name)
        const double cycles = strtod(OF("cycles"), NULL);
        const double flash = strtod(OF("flash"), NULL);
        const cost_board *board = cost_board_named(OF("board"));
        char *run = column[heads_count - 1];
        const cost c = priced_line(run, board, OF("number"));
#undef OF
        TEST_ASSERT_EQUAL_INT_MESSAGE(COST_PREDICTED, c.cycles.basis, run);
        TEST_ASSERT_TRUE_MESSAGE(c.flash_bytes.value > 0.4 * flash, run);
        within += cycles >= c.cycles.least && cycles <= c.cycles.most;
        factor[count++] =
            c.cycles.value > cycles ? c.cycles.value / cycles : cycles / c.cycles.value;
    }
    fclose(in);
    TEST_ASSERT_GREATER_THAN_INT(60, count);
    qsort(factor, (size_t)count, sizeof *factor, by_size);
    printf(
        "  %d counted steps: half within %.0f %%, nine of ten within %.0f %%, all within %.0f %%\n",
        count, 100.0 * (factor[count / 2] - 1.0), 100.0 * (factor[count * 9 / 10] - 1.0),
        100.0 * (factor[count - 1] - 1.0));
    TEST_ASSERT_TRUE(within >= 0.85 * count);
    TEST_ASSERT_TRUE(factor[count / 2] < 1.25);
}
