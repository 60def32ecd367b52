/* test_price_measured.c: prices that are counted (host/price/measured.h, table_counted.h), in a made-up source tree
 * (made_up_tree.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "host/base/room.h"
#include "host/fixed/engine_fixed.h"
#include "host/price/table_counted.h"
#include "made_up_tree.h"
#include "priced.h"
#include "unity.h"

void suite_price_measured(void);

/* --- can it be counted? ----------------------------------------------------------------------------------*/

static void test_what_is_missing_is_told(void) {
    static const struct {
        const char *says;
        const char *status;
        const char *answer; /* NULL: nothing is */
    } rows[] = {
        {"", "0\n", NULL},
        {"a 'tool' is missing\n", "0\n", NULL},
        {"error: 'arm-none-eabi-gcc' is missing: make deps\n", "2\n",
         "'arm-none-eabi-gcc' is missing"},
        {"first\n'one' is missing here\n'two' is missing there\nlast\n", "2\n", "'one' is missing"},
        {"something\nelse\n", "2\n", "make BOARD=mps2-an386 price-ready-board fails"},
        {"the tool is missing, 'quoted' behind it\n", "1\n",
         "make BOARD=mps2-an386 price-ready-board fails"},
        {"'unfinished\n", "1\n", "make BOARD=mps2-an386 price-ready-board fails"},
        {"", "127\n", "'make' is missing"}};
    tree_enter();
    char text[MEASURED_TEXT];
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tree_keep("says", rows[i].says);
        tree_keep("status", rows[i].status);
        const char *answer = measured_missing(cost_board_named("mps2-an386"), text);
        TEST_ASSERT_TRUE((answer == NULL) == (rows[i].answer == NULL));
        if (answer != NULL) {
            TEST_ASSERT_EQUAL_STRING(rows[i].answer, answer);
        }
        TEST_ASSERT_EQUAL_STRING("-s BOARD=mps2-an386 price-ready-board\n", tree_taken("made"));
    }
    tree_keep("status", "3\n");
    TEST_ASSERT_EQUAL_STRING("make price-ready-host fails",
                             measured_missing(cost_board_named("host"), text));
    TEST_ASSERT_EQUAL_STRING("-s price-ready-host\n", tree_taken("made"));
    tree_keep("status", "0\n");
    unlink("mk/price/measure_one.sh");
    TEST_ASSERT_NOT_NULL(strstr(measured_missing(cost_board_named("host"), text), "not the root"));
    TEST_ASSERT_EQUAL_STRING("", tree_taken("made"));
    tree_leave();
}

static void test_which_numbers_are_counted_where(void) {
    for (int b = 0; b < cost_board_count; b++) {
        const cost_board *board = &cost_boards[b];
        const bool host = strcmp(board->name, "host") == 0;
        const bool avr = strncmp(board->name, "atmega", 6) == 0;
        const setting in_float = priced_setting(WH_RK4, &engine_float);
        const setting in_double = priced_setting(WH_RK4, &engine_double);
        const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
        TEST_ASSERT_EQUAL_INT(!host, measured_takes_runs(board));
        TEST_ASSERT_TRUE(measured_takes(board, &in_float));
        TEST_ASSERT_EQUAL_INT(!avr, measured_takes(board, &in_double));
        TEST_ASSERT_EQUAL_INT(!host, measured_takes(board, &in_fixed));
    }
    measured_prices m = {.count = 0};
    const setting in_float = priced_setting(WH_HEUN, &engine_float);
    const setting in_double = priced_setting(WH_RK4, &engine_double);
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    TEST_ASSERT_EQUAL_PTR(&m.lesson[COST_FLOAT], measured_lesson_of(&m, &in_float));
    TEST_ASSERT_EQUAL_PTR(&m.lesson[COST_DOUBLE], measured_lesson_of(&m, &in_double));
    TEST_ASSERT_EQUAL_PTR(&m.lesson[COST_FIXED], measured_lesson_of(&m, &in_fixed));
}

/* --- steps -----------------------------------------------------------------------------------------------*/

#define SPRING(k) \
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = " k " [N/m]*x^2/2\n" \
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"
static const char *const springs[] = {SPRING("9"), SPRING("16"), SPRING("25")};
#define BALL(h) \
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [kg]*9.81 [m/s^2]*x\n" \
    "stop x >= 0 [m] restitution 0.5\n" \
    "scene s { start x = " h " [m]; step 1 [ms]; until 1 [s] }\n"
static const char *const balls[] = {BALL("1"), BALL("2"), BALL("0.5")};
static const whole_ratio spacing = {1, 50};
static const table_words words = {"a.whirl:s", " --set m=3", false};

static void expect_known(double value, cost_basis basis, const cost_figure *f) {
    TEST_ASSERT_EQUAL_INT(basis, f->basis);
    TEST_ASSERT_TRUE(f->value == value && f->least == value && f->most == value);
}

static void test_steps_are_counted_and_kept(void) {
    dice d = dice_of("price_measured steps", 21);
    priced p;
    priced_open(&p, springs, 2);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 20, NULL));
    tree_enter();
    measured_prices m = {.words = &words};
    const cost predicted = {
        .predictable = true, .why = "", .state_bytes = {COST_EXACT, COST_EXACT, 44, 44, 44, 1}};
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    const setting heun = priced_setting(WH_HEUN, &engine_double);
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    char row[300];
    for (int n = 0; n < 3; n++) {
        const setting *s = n == 0 ? &rk4 : n == 1 ? &heun : &in_fixed;
        const deviation_pace pace = {n == 2 ? 4 : (uint64_t)n + 1, 1};
        double v[7];
        for (int i = 0; i < 7; i++) {
            v[i] = 1 + dice_one_of(&d, 9000);
        }
        snprintf(row, sizeof row,
                 "a line before\nabc,gcc,\"-a, -b\",mps2-an386,s,float,rk4,%.0f,%.0f,%.1f,%.0f,"
                 "estimated,%.0f,%.0f,%.0f\r\n",
                 v[0], v[1], v[2] + 0.5, v[3], v[4], v[5], v[6]);
        tree_keep(n == 1 ? "row0" : "row1", row);
        tree_keep(n == 1 ? "row1" : "row0", "nothing\n");
        TEST_ASSERT_FALSE(measured_has(&m, s, pace));
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED,
                              measured_count(&m, &p.trial, s, pace, n == 1 ? 0 : 1, &predicted));
        TEST_ASSERT_EQUAL_INT(n + 1, m.count);
        static const char *const asked[] = {
            "mps2-an386 float a.whirl:s --set m=3 --set place=1 --method rk4 --step 0.02\n",
            "mps2-an386 double a.whirl:s --set m=3 --set place=0 --method heun --step 0.01\n",
            ("mps2-an386 fixed a.whirl:s --set m=3 --set place=1 --method rk4 --step 0.005 "
             "--until 0.4\n")};
        TEST_ASSERT_EQUAL_STRING(asked[n], tree_taken("asked"));
        cost c = {.why = "?"};
        measured_tell(&m, s, pace, &c);
        expect_known(v[0], COST_MEASURED, &c.instructions);
        expect_known(v[1], COST_MEASURED, &c.instructions_worst);
        expect_known(v[2] + 0.5, COST_ESTIMATED, &c.cycles);
        expect_known(v[3], COST_ESTIMATED, &c.cycles_worst);
        expect_known(v[4], COST_MEASURED, &c.flash_bytes);
        expect_known(v[5], COST_MEASURED, &c.ram_bytes);
        expect_known(v[6], COST_MEASURED, &c.stack_bytes);
        expect_known(44, COST_EXACT, &c.state_bytes);
        TEST_ASSERT_TRUE(!(measured_run_of(&m, s, pace).steps > 0.0));
        /* a price that varies with the step is that of this one */
        const bool varies = s->number == &engine_fixed;
        TEST_ASSERT_EQUAL_INT(!varies, measured_has(&m, s, (deviation_pace){pace.steps + 1, 1}));
        TEST_ASSERT_TRUE(measured_has(&m, s, (deviation_pace){pace.steps * 3, pace.records * 3}));
    }
    setting other = rk4;
    other.image.compensated = true;
    TEST_ASSERT_FALSE(measured_has(&m, &other, (deviation_pace){1, 1}));
    cost untouched = {.why = "as it was"};
    measured_tell(&m, &other, (deviation_pace){1, 1}, &untouched);
    measured_tell(NULL, &rk4, (deviation_pace){1, 1}, &untouched);
    TEST_ASSERT_EQUAL_STRING("as it was", untouched.why);
    TEST_ASSERT_TRUE(!(measured_run_of(NULL, &rk4, (deviation_pace){1, 1}).steps > 0.0));
    /* a missing tool leaves nothing behind; what is refused has no price from then on */
    static const struct {
        const char *status;
        const char *row;
        measured_end end;
    } rows[] = {
        {"2\n", "", MEASURED_MISSING},
        {"1\n", "a,g,\"f\",mps2-an386,s,float,rk4,1,1,1,1,estimated,1,1,1\n", MEASURED_REFUSED},
        {"0\n", "no row\n", MEASURED_REFUSED},
        {"0\n", "a,g,\"f\",mps2-an385,s,float,rk4,1,1,1,1,estimated,1,1,1\n", MEASURED_REFUSED}};
    for (int i = 0; i < 4; i++) {
        const int count = m.count;
        other.image.method = (wh_method)i;
        tree_keep("status", rows[i].status);
        tree_keep("row0", rows[i].row);
        TEST_ASSERT_EQUAL_INT(rows[i].end, measured_count(&m, &p.trial, &other,
                                                          (deviation_pace){1, 1}, 0, &predicted));
        TEST_ASSERT_EQUAL_INT(count + (i > 0 ? 1 : 0), m.count);
        TEST_ASSERT_EQUAL_INT(i > 0, measured_has(&m, &other, (deviation_pace){1, 1}));
        if (i > 0) {
            cost c = {.why = ""};
            measured_tell(&m, &other, (deviation_pace){1, 1}, &c);
            TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, c.instructions.basis);
            TEST_ASSERT_EQUAL_STRING("it cannot be built, linked or run there", c.why);
        }
    }
    tree_leave();
    measured_free(&m);
    priced_close(&p);
}

/* --- whole runs ------------------------------------------------------------------------------------------*/

enum { COLUMNS = 13, PLACES = 3 };

static void write_run(const char *file, const char *board, const double v[COLUMNS]) {
    char row[400];
    snprintf(row, sizeof row, "%s,%s,%.0f,%.2f,%.0f,%.0f,%.2f,%.0f,%.0f,%s,%.0f,%.0f,%.0f\n", board,
             "float", v[2], v[3], v[4], v[5], v[6], v[7], v[8], "estimated", v[10], v[11], v[12]);
    tree_keep(file, row);
}

static void expect_most(double each_least, double each_most, double most, cost_basis basis,
                        const cost_figure *f) {
    TEST_ASSERT_EQUAL_INT(basis, f->basis);
    TEST_ASSERT_TRUE(fabs(f->most - each_most * most) <= 1e-12 * f->most);
    TEST_ASSERT_TRUE(fabs(f->least - each_least * most) <= 1e-12 * f->most);
    TEST_ASSERT_TRUE(f->value == (basis == COST_RANGE ? 0.0 : most));
    TEST_ASSERT_TRUE(f->bound == 1.0);
}

/* Of all places the most of each column, the sum of their steps, and bounds where each place has one. */
static void test_whole_runs_are_the_most_of_all_places(void) {
    static const char *const files[] = {"row0", "row1", "row2"};
    static const char *const boards[] = {"mps2-an386", "mps2-an500", "atmega328p"};
    dice d = dice_of("price_measured runs", 22);
    for (int n = 0; n < 3; n++) {
        priced p;
        priced_open(&p, balls, PLACES);
        TEST_ASSERT_TRUE(priced_begin(&p, boards[n], spacing, 10, NULL));
        const cost_board *b = p.wish.board;
        const bool range = b->cycles == COST_RANGE;
        tree_enter();
        measured_prices m = {.words = &words, .by_run = true};
        const setting rk4 = priced_setting(WH_RK4, &engine_float);
        const cost predicted = {.why = "not this"};
        for (int i = 0; i < 6; i++) {
            double v[PLACES][COLUMNS] = {{0}};
            double most[COLUMNS] = {0};
            double steps = 0.0;
            const int unbounded = i < 4 ? i - 1 : -1; /* a place */
            for (int k = 0; k < PLACES; k++) {
                for (int c = 2; c < COLUMNS; c++) {
                    v[k][c] = c == 5 && k == unbounded ? 0.0 : 1 + dice_one_of(&d, 5000);
                    most[c] = fmax(most[c], v[k][c]);
                }
                steps += v[k][2];
                write_run(files[k], boards[n], v[k]);
            }
            const deviation_pace pace = {(uint64_t)i + 1, 1};
            TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED,
                                  measured_count(&m, &p.trial, &rk4, pace, 1, &predicted));
            cost c = {.why = "?"};
            measured_tell(&m, &rk4, pace, &c);
            const measured_run run = measured_run_of(&m, &rk4, pace);
            TEST_ASSERT_TRUE(c.predictable && c.why[0] == '\0');
            expect_most(1, 1, most[3], COST_MEASURED, &c.instructions);
            expect_most(1, 1, most[4], COST_MEASURED, &c.instructions_worst);
            expect_most(range ? b->cycles_least : 1, range ? b->cycles_most : 1,
                        most[range ? 3 : 6], b->cycles, &c.cycles);
            expect_most(range ? b->cycles_least : 1, range ? b->cycles_most : 1,
                        most[range ? 4 : 7], b->cycles, &c.cycles_worst);
            expect_most(1, 1, most[10], COST_MEASURED, &c.flash_bytes);
            expect_most(1, 1, most[11], COST_MEASURED, &c.ram_bytes);
            expect_most(1, 1, most[12], COST_MEASURED, &c.stack_bytes);
            TEST_ASSERT_TRUE(run.steps == steps);
            TEST_ASSERT_TRUE(run.instructions_bound == (unbounded < 0 ? most[5] : 0.0));
            TEST_ASSERT_TRUE(run.cycles_bound == (unbounded < 0 ? most[8] : 0.0));
            TEST_ASSERT_FALSE(measured_has(&m, &rk4, (deviation_pace){pace.steps + 1, 1}));
            const char *asked = tree_taken("asked");
            TEST_ASSERT_EQUAL_STRING_LEN("--whole-run ", asked, 12);
            TEST_ASSERT_NOT_NULL(strstr(asked, " --until 0.2\n--whole-run "));
            TEST_ASSERT_NOT_NULL(strstr(asked, "place=0"));
            TEST_ASSERT_NOT_NULL(strstr(asked, "place=2"));
        }
        /* a row too short, too long, of another board; one place that fails */
        static const char *const bad[] = {"%s,f,1,1,1,1,1,1,1,e,1,1\n",
                                          "%s,f,1,1,1,1,1,1,1,e,1,1,1,1\n",
                                          "x%s,f,1,1,1,1,1,1,1,e,1,1,1\n"};
        for (int i = 0; i < 3; i++) {
            char *row = room_words(bad[i], boards[n]);
            const deviation_pace pace = {(uint64_t)i + 20, 1};
            tree_keep("row2", row);
            TEST_ASSERT_EQUAL_INT(MEASURED_REFUSED,
                                  measured_count(&m, &p.trial, &rk4, pace, 1, &predicted));
            cost c = {.why = "?"};
            measured_tell(&m, &rk4, pace, &c);
            TEST_ASSERT_EQUAL_STRING("it cannot be built, linked or run to its end there", c.why);
            TEST_ASSERT_TRUE(measured_run_of(&m, &rk4, pace).steps == 0.0);
            free(row);
        }
        tree_leave();
        measured_free(&m);
        priced_close(&p);
    }
}

/* --- a table's front -------------------------------------------------------------------------------------*/

static void count_progress(void *context, int done, int of) {
    (void)done;
    (void)of;
    ++*(int *)context;
}

/* Rows that are predicted to cost 100, 200, ...: counted, the first costs more than all, and what is refused is gone. */
static void test_the_front_is_counted_until_all_of_it_is(void) {
    priced p;
    priced_open(&p, springs, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 20, NULL));
    for (int refused = 0; refused < 2; refused++) {
        tree_enter();
        tree_keep("mk/price/measure_one.sh",
                  refused ? "case \"$*\" in *euler*) exit 1 ;; esac\nsed \"s/N/900/g\" row0\n"
                          : "case \"$*\" in *euler*) n=950 ;; *heun*) n=90 ;; *) n=500 ;; esac\n"
                            "sed \"s/N/$n/g\" row0\n");
        tree_keep("row0", "a,g,\"f\",mps2-an386,s,float,rk4,N,N,N,N,estimated,N,N,N\n");
        static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4, WH_RK38};
        table_row row[5];
        for (int i = 0; i < 5; i++) {
            row[i] = (table_row){.setting = priced_setting(methods[i % 4], &engine_float),
                                 .pace = {1, i == 4 ? 2 : 1},
                                 .order = i};
            row[i].result.error = i == 4 ? 0.9 : 0.1 * (4 - i);
            row[i].cost.cycles = cost_known(100.0 * (i % 4 + 1), COST_ESTIMATED);
            row[i].price.value = 100.0 * (i % 4 + 1) * (i == 4 ? 25.0 : 50.0);
            row[i].price.basis = COST_ESTIMATED;
        }
        row[3].result.error = 0.5; /* not on the front, and never counted */
        table made = {.row = row, .count = 5, .why = ""};
        table_sort(&made);
        int told = 0;
        measured_prices m = {.words = &words};
        const table_wish w = {.progress = count_progress, .context = &told};
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, table_counted(&p.trial, &made, &m, &w));
        TEST_ASSERT_EQUAL_INT(m.count, told);
        TEST_ASSERT_EQUAL_INT(refused ? 4 : 3, m.count);
        TEST_ASSERT_EQUAL_INT(refused ? 3 : 5, made.count);
        TEST_ASSERT_EQUAL_INT(refused ? 2 : 0, made.unpriced);
        TEST_ASSERT_EQUAL_STRING(refused ? "it cannot be built, linked or run there" : "",
                                 made.why);
        for (int i = 0; i < made.count; i++) {
            const table_row *r = &made.row[i];
            const wh_method method = r->setting.image.method;
            const double each = method == WH_RK38 && !refused ? 400.0
                                : refused                     ? 900.0
                                : method == WH_EULER          ? 950.0
                                : method == WH_HEUN           ? 90.0
                                                              : 500.0;
            TEST_ASSERT_TRUE(r->price.value == each * (r->pace.records == 2 ? 25.0 : 50.0));
            TEST_ASSERT_TRUE(i == 0 || made.row[i - 1].price.value <= r->price.value);
            TEST_ASSERT_TRUE(!r->on_front || measured_has(&m, &r->setting, r->pace));
        }
        /* a table by evaluations stays as it is; a missing tool ends it */
        measured_prices none = {.words = &words};
        made.counted = true;
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, table_counted(&p.trial, &made, &none, &w));
        TEST_ASSERT_EQUAL_INT(0, none.count);
        made.counted = false;
        tree_keep("mk/price/measure_one.sh", "exit 2\n");
        const table_wish quiet = {.progress = NULL};
        TEST_ASSERT_EQUAL_INT(MEASURED_MISSING, table_counted(&p.trial, &made, &none, &quiet));
        TEST_ASSERT_EQUAL_INT(0, none.count);
        measured_free(&m);
        tree_leave();
    }
    priced_close(&p);
}

void suite_price_measured(void) {
    RUN_TEST(test_what_is_missing_is_told);
    RUN_TEST(test_which_numbers_are_counted_where);
    RUN_TEST(test_steps_are_counted_and_kept);
    RUN_TEST(test_whole_runs_are_the_most_of_all_places);
    RUN_TEST(test_the_front_is_counted_until_all_of_it_is);
}
