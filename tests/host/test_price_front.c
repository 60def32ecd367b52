/* test_price_front.c: rows of error and price (host/study/price_table.h). Sorting and Pareto front are compared with
 * all pairs of random rows. Also the steps that are tried, counted prices, and motions. */
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/fixed/engine_fixed.h"
#include "host/os/system.h"
#include "host/study/choice.h"
#include "host/study/price_table.h"
#include "host/study/reference_run.h"

#include "command.h"
#include "derived.h"
#include "made_up_tree.h"
#include "priced.h"

/* === suite price_front ======================================================================== */

enum { ROWS_MOST = 40 };

static bool comes_before(const table_row *a, const table_row *b) {
    return a->price.value < b->price.value ||
           (a->price.value == b->price.value &&
            (a->result.error < b->result.error ||
             (a->result.error == b->result.error && a->pace.steps < b->pace.steps)));
}

/* Does row a dominate row b? It must be neither dearer nor less accurate. Of two equal rows, the one with fewer
 * steps dominates. */
static bool beats(const table_row *a, const table_row *b) {
    return a->price.value <= b->price.value && a->result.error <= b->result.error &&
           (a->price.value < b->price.value || a->result.error < b->result.error ||
            a->pace.steps < b->pace.steps);
}

/* The rows have few different values, so that many rows tie. */
TEST(price_front, rows_are_sorted_with_front_marked) {
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

/* The tried paces are 50, 20, 10, 5 and 2 records in a step, then 1, 2, 5, 10, ... steps in a record, up to 5e7. */
TEST(price_front, steps_decrease_by_1_2_5) {
    double length = 100.0;
    const table_request w = {.rate_Hz = 0.0};
    deviation_pace p;
    int rungs = 0;
    for (; table_pace(&w, rungs, &p); rungs++) {
        const double next = (double)p.records / (double)p.steps;
        TEST_ASSERT_TRUE(p.records == 1 || p.steps == 1);
        TEST_ASSERT_TRUE(p.records != 0 && p.steps != 0);
        /* the next shorter step is two fifths of 5, and half of 1, 2 and 10 */
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

/* With a record rate, the number of steps in 1/rate_Hz must be 1, 2, ..., 10, and then rise by half at most. */
TEST(price_front, substeps_follow_their_series) {
    for (uint64_t periods = 1; periods < 6; periods++) {
        const table_request w = {.rate_Hz = 7.0, .periods = periods};
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
    TEST_ASSERT_EQUAL_UINT64(0, table_substeps(&(table_request){.periods = 1}, &row));
}

/* === suite price_measured ===================================================================== */
/* Counted prices (host/study/price_table.h), and choices that use them (choice.h), in a made-up source tree
 * (made_up_tree.h). */

TEST(price_measured, missing_tools_are_reported) {
    static const struct {
        const char *says;
        const char *status;
        const char *answer; /* printed answer; NULL: none */
    } rows[] = {{"", "0\n", NULL},
                {"a 'tool' is missing\n", "0\n", NULL},
                {"error: 'arm-none-eabi-gcc' is missing: make deps\n", "2\n",
                 "'arm-none-eabi-gcc' is missing: make deps"},
                {"first\n'one' is missing here\n'two' is missing there\nlast\n", "2\n",
                 "'one' is missing here"},
                {"something\nelse\n", "2\n", "else"},
                {"sh: make: not found\n", "127\n", "sh: make: not found"},
                {"", "2\n", "make fails"}};
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
    TEST_ASSERT_EQUAL_STRING("make fails", measured_missing(NULL, cost_board_named("host"), text));
    TEST_ASSERT_EQUAL_STRING("-s price-ready-host\n", tree_taken("made"));
    tree_keep("status", "0\n");
    unlink("mk/price/measure_one.sh");
    TEST_ASSERT_NOT_NULL(
        strstr(measured_missing(NULL, cost_board_named("host"), text), "only in the root"));
    TEST_ASSERT_EQUAL_STRING("", tree_taken("made"));
    tree_leave();
}

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

static table table_of(table_row row[2], const setting *s, deviation_pace pace, int point) {
    for (int i = 0; i < 2; i++) {
        row[i] = (table_row){.setting = *s, .pace = {pace.steps * ((uint64_t)i + 1), pace.records}};
        row[i].result.point = point;
        row[i].cost.state_bytes = cost_known(44, COST_EXACT);
        row[i].price.value = i;
    }
    return (table){.row = row, .count = 2, .why = ""};
}

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

/* The row for all places must have the maximum of each column and the sum of the steps. It must have a bound if
 * every place has a bound. */
TEST(price_measured, whole_runs_have_the_maxima) {
    static const char *const files[] = {"row0", "row1", "row2"};
    static const char *const boards[] = {"mps2-an386", "mps2-an500", "atmega328p"};
    dice d = dice_of("price_measured runs", 22);
    for (int n = 0; n < 3; n++) {
        priced p;
        priced_open(&p, balls, PLACES);
        TEST_ASSERT_TRUE(priced_begin(&p, boards[n], spacing, 10, NULL));
        const cost_board *b = p.request.board;
        const bool range = b->cycles == COST_RANGE;
        tree_enter();
        const setting rk4 = priced_setting(WH_RK4, &engine_float);
        for (int i = 0; i < 6; i++) {
            double v[PLACES][COLUMNS] = {{0}};
            double most[COLUMNS] = {0};
            double steps = 0.0;
            const int unbounded = i < 4 ? i - 1 : -1; /* the place without a bound; -1: none */
            for (int k = 0; k < PLACES; k++) {
                for (int c = 2; c < COLUMNS; c++) {
                    v[k][c] =
                        (c == 5 || c == 8) && k == unbounded ? 0.0 : 1 + dice_one_of(&d, 5000);
                    most[c] = fmax(most[c], v[k][c]);
                }
                steps += v[k][2];
                write_run(files[k], boards[n], v[k]);
            }
            const deviation_pace pace = {(uint64_t)i + 1, 1};
            table_row row[2];
            table made = table_of(row, &rk4, pace, 1);
            TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_count(&p.trial, &made, 0));
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
        /* rows that are too short, too long, or of another board: the place fails */
        static const char *const bad[] = {"%s,f,1,1,1,1,1,1,1,e,1,1\n",
                                          "%s,f,1,1,1,1,1,1,1,e,1,1,1,1\n",
                                          "x%s,f,1,1,1,1,1,1,1,e,1,1,1\n"};
        for (int i = 0; i < 3; i++) {
            char *row = alloc_words(bad[i], boards[n]);
            const deviation_pace pace = {(uint64_t)i + 20, 1};
            tree_keep("row2", row);
            table_row rows[2];
            table made = table_of(rows, &rk4, pace, 1);
            TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_count(&p.trial, &made, 0));
            TEST_ASSERT_EQUAL_INT(1, made.count);
            TEST_ASSERT_FALSE(made.row[0].counted);
            free(row);
        }
        tree_leave();
        priced_close(&p);
    }
}

/* The predicted costs are 100, 200, ... When counted, the first setting costs more than all others. Rows that cannot
 * be counted are removed. */
TEST(price_measured, counting_ends_with_a_counted_front) {
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
        row[3].result.error = 0.5; /* not on the front, so it is never counted */
        table made = {.row = row, .count = 5, .why = ""};
        table_sort(&made);
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, measured_front(&p.trial, &made, true));
        TEST_ASSERT_EQUAL_INT(refused ? 3 : 5, made.count);
        TEST_ASSERT_EQUAL_INT(refused ? 1 : 0, made.unpriced);
        TEST_ASSERT_EQUAL_STRING(
            refused ? "the step cannot be built, linked or run on this board" : "", made.why);
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
        for (int i = 0; i < made.count; i++) {
            made.row[i].counted = false;
        }
        TEST_ASSERT_EQUAL_INT(MEASURED_MISSING, measured_front(&p.trial, &made, false));
        tree_leave();
    }
    priced_close(&p);
}

/* Six settings with three steps each have prices. Counting the chosen rows only must give the same choice as
 * counting all, unless a prediction is too high. */
TEST(price_measured, choices_equal_those_of_full_counts) {
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
        const choice_request w = {.table = {.error = 1e-1},
                                  .clock_Hz = n % 3 == 2 ? 2e4 : 0.0,
                                  .flash_bytes = n % 2 == 1 ? dice_between(&d, 90, 900) : 0.0};
        choice c;
        TEST_ASSERT_EQUAL_INT(MEASURED_COUNTED, choice_counted(&p.trial, &made, &w, &c));
        const choice wanted = choice_make(&p.trial, &by_all, &w);
        static const choice_kind kinds[] = {CHOICE_FASTEST, CHOICE_SMALLEST, CHOICE_WEAKER,
                                            CHOICE_LARGER};
        for (int i = 0; i < (wanted.of[CHOICE_FASTEST].row >= 0 ? 2 : 4); i++) {
            const choice_row *is = &c.of[kinds[i]];
            const choice_row *should = &wanted.of[kinds[i]];
            TEST_ASSERT_EQUAL_INT(should->row < 0, is->row < 0);
            if (is->row >= 0) {
                const table_row *a = &made.row[is->row];
                const table_row *b = &by_all.row[should->row];
                TEST_ASSERT_TRUE(a->counted);
                TEST_ASSERT_TRUE(i != 0 || is->worst == should->worst);
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

/* === suite price_motion ======================================================================= */
/* The reference (host/study/reference_run.h) is compared with closed forms, and its order is checked.
 * deviation_measure() is compared with a loop of the test. test_price_reference.c has long motions. */

static const char *const spring =
    "mechanism m\ncoordinate x [mm]\noutput twice [mm] = 2*x\nT = 1 [kg]*x'^2/2\n"
    "V = 16 [N/m]*x^2/2\nscene s { start x = 250 [mm]; step 10 [ms]; until 1 [s] }\n";

static reference *reference_of(const image *im, int count) {
    const reference_request w = {
        .image = im, .spacing = {1, 20}, .records = count, .operations = 1e8};
    reference *r = reference_new(&w);
    TEST_ASSERT_TRUE(r->reliable);
    TEST_ASSERT_EQUAL_INT(count, r->records);
    return r;
}

TEST(price_motion, deviations_are_maxima_over_records) {
    static const deviation_pace paces[] = {{1, 1}, {3, 1}, {1, 2}, {1, 5}};
    static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4};
    derived of = derived_surely(derived_scene(spring, "s"), spring);
    reference *r = reference_of(of.image, 20);
    for (int column = -1; column < 4; column++) {
        for (int n = 0; n < 24 && column != 0; n++) {
            const deviation_pace pace = paces[n % 4];
            const engine_kind *kind = n < 12 ? &engine_float : &engine_double;
            image *im = of.image;
            im->settings.method = methods[n / 4 % 3];
            im->step = (whole_ratio){pace.records, 20 * pace.steps};
            im->step_s = (double)pace.records / (20.0 * (double)pace.steps);
            /* takes the same steps, and computes the error at each record; ends early if the error is useless */
            const double give_up = column < 0 ? 0.3 : 90.0;
            void *run = kind->start(im);
            double worst = -1.0;
            int at = 0;
            int taken = 0;
            for (int i = 0; i <= 20 && worst <= give_up; i += (int)pace.records) {
                double angle[1];
                double real[2];
                for (uint64_t k = 0; k < pace.steps && i > 0; k++, taken++) {
                    TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(run));
                }
                kind->state(run, angle, real);
                for (int c = 1; c < 4; c++) {
                    const double shown = (c == 3 ? 2.0 * real[0] : real[c - 1]) * 1000.0;
                    const double is = r->row[(size_t)i * (size_t)r->columns + (size_t)c];
                    const double off = fabs(shown - is) / (column < 0 ? r->column[c].largest : 1.0);
                    if ((column < 0 ? c < 3 : c == column) && off > worst) {
                        worst = off;
                        at = c;
                    }
                }
            }
            kind->stop(run);
            const deviation d =
                deviation_measure(r, im, kind, pace, (deviation_of_what){column, give_up});
            TEST_ASSERT_EQUAL_INT(worst <= give_up, d.usable);
            TEST_ASSERT_TRUE(fabs(d.error - worst) <= 1e-6 * worst + 1e-12);
            TEST_ASSERT_EQUAL_INT(at, d.column);
            const double unit = column < 0 ? r->column[at].largest : 1.0;
            TEST_ASSERT_TRUE(fabs(d.known - r->column[at].off / unit) < 1e-18);
            const double stages = wh_methods[im->settings.method].stages;
            TEST_ASSERT_TRUE(d.evaluations_most == stages);
            TEST_ASSERT_TRUE(taken == 0 || fabs(d.evaluations * im->step_s / stages - 1) < 1e-9);
        }
    }
    interrupted = 1;
    const deviation none =
        deviation_measure(r, of.image, &engine_double, paces[0], (deviation_of_what){-1, 1.0});
    interrupted = 0;
    TEST_ASSERT_TRUE(none.evaluations == 0.0);
    reference_free(r);
    derived_free(&of);
}

TEST(price_motion, step_with_most_evaluations_is_found) {
    derived of = derived_scene("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                               "V = 1 [kg]*9.81 [m/s^2]*x\nstop x >= 0 [m] restitution 0.5\n"
                               "scene s { start x = 1 [m]; step 10 [ms]; until 1 [s] }\n",
                               "s");
    derived_expect(&of, "a ball");
    const reference_request w = {
        .image = of.image, .spacing = {1, 20}, .records = 18, .operations = 1e7};
    reference *r = reference_new(&w);
    TEST_ASSERT_TRUE(r->reliable);
    TEST_ASSERT_EQUAL_INT(18, r->records);
    void *run = engine_double.start(of.image);
    double most = 0.0;
    uint64_t before = 0;
    uint64_t declared;
    for (int i = 0; i < 18 * 5; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, engine_double.step(run));
        const uint64_t now = engine_double.evaluations(run, &declared);
        most = fmax(most, (double)(now - before));
        before = now;
    }
    engine_double.stop(run);
    const deviation d = deviation_measure(r, of.image, &engine_double, (deviation_pace){5, 1},
                                          (deviation_of_what){-1, 1.0});
    TEST_ASSERT_TRUE(d.usable && d.evaluations_most == most && most > 4.0);
    TEST_ASSERT_TRUE(fabs(d.evaluations - (double)before / 0.9) < 1e-6);
    /* an error equal to the limit is usable */
    const deviation same = deviation_measure(r, of.image, &engine_double, (deviation_pace){5, 1},
                                             (deviation_of_what){-1, d.error});
    TEST_ASSERT_TRUE(same.usable && same.error == d.error);
    reference_free(r);
    derived_free(&of);
}
