/* test_price_measured.c: prices that are counted (host/study/measured.h) and chosen by (choice.h), in a made-up source tree
 * (made_up_tree.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "host/base/alloc.h"
#include "host/fixed/engine_fixed.h"
#include "host/study/choice.h"
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
        const char *answer = measured_missing(NULL, cost_board_named("mps2-an386"), text);
        TEST_ASSERT_TRUE((answer == NULL) == (rows[i].answer == NULL));
        if (answer != NULL) {
            TEST_ASSERT_EQUAL_STRING(rows[i].answer, answer);
        }
        TEST_ASSERT_EQUAL_STRING("-s BOARD=mps2-an386 price-ready-board\n", tree_taken("made"));
    }
    tree_keep("status", "3\n");
    TEST_ASSERT_EQUAL_STRING("make price-ready-host fails",
                             measured_missing(NULL, cost_board_named("host"), text));
    TEST_ASSERT_EQUAL_STRING("-s price-ready-host\n", tree_taken("made"));
    tree_keep("status", "0\n");
    unlink("mk/price/measure_one.sh");
    TEST_ASSERT_NOT_NULL(
        strstr(measured_missing(NULL, cost_board_named("host"), text), "not the root"));
    TEST_ASSERT_EQUAL_STRING("", tree_taken("made"));
    tree_leave();
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
static const table_words words = {"a.whirl:s", " --set m=3", false, 0.0};

static void expect_known(double value, cost_basis basis, const cost_figure *f) {
    TEST_ASSERT_EQUAL_INT(basis, f->basis);
    TEST_ASSERT_TRUE(f->value == value && f->least == value && f->most == value);
}

/* Two rows of a setting by two steps. */
static table table_of(table_row row[2], const setting *s, deviation_pace pace, int point) {
    for (int i = 0; i < 2; i++) {
        row[i] = (table_row){.setting = *s, .pace = {pace.steps * ((uint64_t)i + 1), pace.records}};
        row[i].result.point = point;
        row[i].cost.state_bytes = cost_known(44, COST_EXACT);
        row[i].price.value = i;
    }
    return (table){.row = row, .count = 2, .why = ""};
}

static void test_steps_are_counted_and_kept(void) {
    dice d = dice_of("price_measured steps", 21);
    priced p;
    priced_open(&p, springs, 2);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 20, NULL));
    tree_enter();
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    const setting heun = priced_setting(WH_HEUN, &engine_double);
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    char line[300];
    table_row row[2];
    for (int n = 0; n < 3; n++) {
        const setting *s = n == 0 ? &rk4 : n == 1 ? &heun : &in_fixed;
        const deviation_pace pace = {n == 2 ? 4 : (uint64_t)n + 1, 1};
        double v[7];
        for (int i = 0; i < 7; i++) {
            v[i] = 1 + dice_one_of(&d, 9000);
        }
        snprintf(line, sizeof line,
                 "a line before\nabc,gcc,\"-a, -b\",mps2-an386,s,float,rk4,%.0f,%.0f,%.1f,%.0f,"
                 "estimated,%.0f,%.0f,%.0f\r\n",
                 v[0], v[1], v[2] + 0.5, v[3], v[4], v[5], v[6]);
        tree_keep(n == 1 ? "row0" : "row1", line);
        tree_keep(n == 1 ? "row1" : "row0", "nothing\n");
        table made = table_of(row, s, pace, n == 1 ? 0 : 1);
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_count(&p.trial, &made, 0, &words));
        static const char *const asked[] = {
            "mps2-an386 float a.whirl:s --set m=3 --set place=1 --method rk4 --step 0.02\n",
            "mps2-an386 double a.whirl:s --set m=3 --set place=0 --method heun --step 0.01\n",
            ("mps2-an386 fixed a.whirl:s --set m=3 --set place=1 --method rk4 --step 0.005 "
             "--until 0.4\n")};
        TEST_ASSERT_EQUAL_STRING(asked[n], tree_taken("asked"));
        /* a price that varies with the step is that of this one */
        const bool varies = s->number == &engine_fixed;
        int counted = 0;
        for (int i = 0; i < 2; i++) {
            const table_row *r = &made.row[i];
            const cost *c = &r->cost;
            const double each_s = ratio_times(1, trial_step(&p.trial, r->pace));
            counted += r->counted;
            TEST_ASSERT_TRUE(!(r->run.steps > 0.0));
            expect_known(44, COST_EXACT, &c->state_bytes);
            if (r->counted) {
                expect_known(v[0], COST_MEASURED, &c->instructions);
                expect_known(v[1], COST_MEASURED, &c->instructions_worst);
                expect_known(v[2] + 0.5, COST_ESTIMATED, &c->cycles);
                expect_known(v[3], COST_ESTIMATED, &c->cycles_worst);
                expect_known(v[4], COST_MEASURED, &c->flash_bytes);
                expect_known(v[5], COST_MEASURED, &c->ram_bytes);
                expect_known(v[6], COST_MEASURED, &c->stack_bytes);
                TEST_ASSERT_TRUE(fabs(r->price.value * each_s / c->cycles.value - 1.0) < 1e-12);
            }
        }
        TEST_ASSERT_EQUAL_INT(varies ? 1 : 2, counted);
    }
    /* a missing tool leaves the table as it is; rows that are refused leave it */
    static const struct {
        const char *status;
        const char *row;
        measured_end end;
    } rows[] = {
        {"2\n", "", MEASURED_MISSING},
        {"1\n", "a,g,\"f\",mps2-an386,s,float,rk4,1,1,1,1,estimated,1,1,1\n", MEASURED_COUNTED},
        {"0\n", "no row\n", MEASURED_COUNTED},
        {"0\n", "a,g,\"f\",mps2-an385,s,float,rk4,1,1,1,1,estimated,1,1,1\n", MEASURED_COUNTED}};
    for (int i = 0; i < 4; i++) {
        table made = table_of(row, &heun, (deviation_pace){1, 1}, 0);
        tree_keep("status", rows[i].status);
        tree_keep("row0", rows[i].row);
        TEST_ASSERT_EQUAL_INT(rows[i].end, measured_count(&p.trial, &made, 0, &words));
        TEST_ASSERT_EQUAL_INT(i > 0 ? 0 : 2, made.count);
        TEST_ASSERT_EQUAL_INT(i > 0, made.unpriced);
        TEST_ASSERT_EQUAL_STRING(i > 0 ? "it cannot be built, linked or run there" : "", made.why);
    }
    tree_leave();
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
        const setting rk4 = priced_setting(WH_RK4, &engine_float);
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
            table_row row[2];
            table made = table_of(row, &rk4, pace, 1);
            TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_count(&p.trial, &made, 0, &words));
            const int at = made.row[0].counted ? 0 : 1;
            TEST_ASSERT_FALSE(made.row[1 - at].counted);
            const cost c = made.row[at].cost;
            const counted_run run = made.row[at].run;
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
            char *row = alloc_words(bad[i], boards[n]);
            const deviation_pace pace = {(uint64_t)i + 20, 1};
            tree_keep("row2", row);
            table_row rows[2];
            table made = table_of(rows, &rk4, pace, 1);
            TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_count(&p.trial, &made, 0, &words));
            TEST_ASSERT_EQUAL_INT(1, made.count);
            TEST_ASSERT_FALSE(made.row[0].counted);
            free(row);
        }
        tree_leave();
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
                                 .pace = {1, i == 4 ? 2 : 1}};
            row[i].result.error = i == 4 ? 0.9 : 0.1 * (4 - i);
            row[i].cost.cycles = cost_known(100.0 * (i % 4 + 1), COST_ESTIMATED);
            row[i].price.value = 100.0 * (i % 4 + 1) * (i == 4 ? 25.0 : 50.0);
            row[i].price.basis = COST_ESTIMATED;
        }
        row[3].result.error = 0.5; /* not on the front, and never counted */
        table made = {.row = row, .count = 5, .why = ""};
        table_sort(&made);
        int told = 0;
        const table_wish w = {.progress = count_progress, .context = &told};
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_front(&p.trial, &made, &words, &w));
        TEST_ASSERT_EQUAL_INT(refused ? 4 : 3, told);
        TEST_ASSERT_EQUAL_INT(refused ? 3 : 5, made.count);
        TEST_ASSERT_EQUAL_INT(refused ? 1 : 0, made.unpriced);
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
            TEST_ASSERT_TRUE(!r->on_front || r->counted);
        }
        tree_keep("mk/price/measure_one.sh", "exit 2\n");
        const table_wish quiet = {.progress = NULL};
        for (int i = 0; i < made.count; i++) {
            made.row[i].counted = false;
        }
        TEST_ASSERT_EQUAL_INT(MEASURED_MISSING, measured_front(&p.trial, &made, &words, &quiet));
        tree_leave();
    }
    priced_close(&p);
}

/* --- choices -----------------------------------------------------------------------------------------------*/

/* Drawn prices of six settings by three steps. A choice that counts its answers equals the choice from a table that is
 * counted in all, if no prediction is too high. */
static void test_choices_are_as_if_all_was_counted(void) {
    dice d = dice_of("price_measured choices", 23);
    priced p;
    priced_open(&p, springs, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 20, NULL));
    int fewer = 0;
    for (int n = 0; n < 12; n++) {
        enum { ROWS = 18 };
        static const wh_method methods[] = {WH_RK4,       WH_NYSTROEM3, WH_NYSTROEM4,
                                            WH_NYSTROEM5, WH_HEUN,      WH_EULER};
        table_row row[ROWS];
        table_row all[ROWS];
        tree_enter();
        char *script = alloc_words("echo . >>asked\ncase \"$*\" in\n");
        double counted[6];
        for (int i = 0; i < 6; i++) {
            counted[i] = 100 + dice_one_of(&d, 900);
            char *longer = alloc_words("%s*%s\\ *) n=%.0f ;;\n", script,
                                       wh_methods[methods[i]].word, counted[i]);
            free(script);
            script = longer;
        }
        char *whole =
            alloc_words("%sesac\necho \"a,g,f,mps2-an386,s,float,rk4,$n,$n,$n,$n,estimated,"
                        "$n,10,10\"\n",
                        script);
        tree_keep("mk/price/measure_one.sh", whole);
        free(whole);
        free(script);
        for (int i = 0; i < ROWS; i++) {
            row[i] = (table_row){.setting = priced_setting(methods[i % 6], &engine_float),
                                 .pace = {(uint64_t)(i / 6) + 1, 1}};
            row[i].result.error = pow(10.0, dice_between(&d, -4.0, 0.0));
            const double predicted = counted[i % 6] * dice_between(&d, 0.8, 1.0);
            const double each_s = ratio_times(1, trial_step(&p.trial, row[i].pace));
            all[i] = row[i];
            for (int k = 0; k < 2; k++) {
                table_row *r = k == 0 ? &row[i] : &all[i];
                const double value = k == 0 ? predicted : counted[i % 6];
                r->cost.cycles = r->cost.cycles_worst = cost_known(value, COST_ESTIMATED);
                r->cost.instructions = r->cost.instructions_worst = r->cost.flash_bytes =
                    cost_known(value, COST_MEASURED);
                r->cost.ram_bytes = r->cost.stack_bytes = cost_known(10, COST_MEASURED);
                r->price.value = value / each_s;
            }
        }
        table made = {.row = row, .count = ROWS, .why = ""};
        table by_all = {.row = all, .count = ROWS, .why = ""};
        table_sort(&made);
        table_sort(&by_all);
        const choice_wish w = {.table = {.error = 1e-1},
                               .clock_Hz = n % 3 == 2 ? 2e4 : 0.0,
                               .flash_bytes = n % 2 == 1 ? dice_between(&d, 90, 900) : 0.0};
        choice c;
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, choice_counted(&p.trial, &made, &w, &words, &c));
        const choice wanted = choice_make(&p.trial, &by_all, &w);
        const choice_row *const is[] = {&c.fastest, &c.smallest, &c.weaker, &c.larger};
        const choice_row *const should[] = {&wanted.fastest, &wanted.smallest, &wanted.weaker,
                                            &wanted.larger};
        for (int i = 0; i < (wanted.fastest.row >= 0 ? 2 : 4); i++) {
            TEST_ASSERT_EQUAL_INT(should[i]->row < 0, is[i]->row < 0);
            if (is[i]->row >= 0) {
                const table_row *a = &made.row[is[i]->row];
                const table_row *b = &by_all.row[should[i]->row];
                TEST_ASSERT_TRUE(a->counted);
                TEST_ASSERT_TRUE(i != 0 || is[i]->worst == should[i]->worst);
                TEST_ASSERT_TRUE(i != 2 || a->result.error == b->result.error);
                TEST_ASSERT_TRUE(i % 2 == 0 ||
                                 a->cost.flash_bytes.value == b->cost.flash_bytes.value);
            }
        }
        int asked = 0;
        for (const char *at = tree_taken("asked"); *at != '\0'; at++) {
            asked += *at == '.';
        }
        fewer += asked < 6;
        tree_leave();
    }
    TEST_ASSERT_GREATER_THAN_INT(0, fewer);
    priced_close(&p);
}

void suite_price_measured(void) {
    RUN_TEST(test_what_is_missing_is_told);
    RUN_TEST(test_steps_are_counted_and_kept);
    RUN_TEST(test_whole_runs_are_the_most_of_all_places);
    RUN_TEST(test_the_front_is_counted_until_all_of_it_is);
    RUN_TEST(test_choices_are_as_if_all_was_counted);
}
