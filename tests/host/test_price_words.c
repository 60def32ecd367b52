/* test_price_words.c: printed prices (host/study/price_table.h): digits and basis of figures, rows of a made-up table
 * as text and CSV, parsed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "caught.h"
#include "command.h"
#include "host/base/alloc.h"
#include "host/base/atomic_file.h"
#include "host/fixed/engine_fixed.h"
#include "host/study/price_table.h"
#include "priced.h"
#include "unity.h"

void suite_price_words(void);

static const char letters[] = "-xpmesr"; /* by basis */

static cost_figure drawn_figure(dice *d) {
    cost_figure f = {.basis = (cost_basis)dice_one_of(d, COST_BASES)};
    const double within = 1.0 + pow(10.0, dice_between(d, -2.0, 0.5));
    f.value = pow(10.0, dice_between(d, 0.0, 7.0));
    f.least = f.value / within;
    f.most = f.value * within;
    return f;
}

static void test_figures_say_how_they_are_known(void) {
    dice d = dice_of("price_words", 31);
    for (unsigned n = 0; n < dice_cases(few_or_all(1000, 30000)); n++) {
        const cost_figure f = drawn_figure(&d);
        char text[FIGURE_TEXT];
        char words[FIGURE_WORDS];
        char letter[8];
        double low;
        TEST_ASSERT_EQUAL_CHAR(letters[f.basis], figure_letter(f.basis));
        TEST_ASSERT_EQUAL_PTR(text, figure_text(&f, text));
        TEST_ASSERT_EQUAL_PTR(words, figure_words(&f, words));
        if (f.basis == COST_NOT_KNOWN) {
            TEST_ASSERT_EQUAL_STRING("-", text);
        } else if (f.basis == COST_RANGE) {
            double high;
            const char *rest = said_number(said_words(said_number(text, &low), "to"), &high);
            TEST_ASSERT_EQUAL_STRING(" r", rest);
            TEST_ASSERT_TRUE(fabs(low / f.least - 1) <= 5e-3 && fabs(high / f.most - 1) <= 5e-3);
        } else {
            TEST_ASSERT_EQUAL_STRING("", said_word(said_number(text, &low), letter, 8));
            TEST_ASSERT_TRUE(fabs(low - f.value) <= 0.5 && letter[0] == letters[f.basis]);
        }
        if (f.basis != COST_PREDICTED) {
            TEST_ASSERT_EQUAL_STRING(cost_basis_words[f.basis], words);
            continue;
        }
        const char *rest = said_words(words, "predicted: in nine of ten counted cases within ");
        TEST_ASSERT_EQUAL_STRING(" %", said_number(rest, &low));
        TEST_ASSERT_TRUE(fabs(1.0 + low / 100.0 - f.most / f.value) <= 0.0051);
    }
}

static void test_legends_have_a_line_for_each_basis_that_is_there(void) {
    dice d = dice_of("price_words legends", 32);
    for (int n = 0; n < 200; n++) {
        cost c;
        cost_figure *const figures[] = {&c.instructions, &c.instructions_worst, &c.cycles,
                                        &c.cycles_worst, &c.flash_bytes,        &c.ram_bytes,
                                        &c.stack_bytes,  &c.state_bytes};
        bool there[COST_BASES] = {false};
        const unsigned few = 1 + dice_one_of(&d, 8);
        for (int i = 0; i < 8; i++) {
            *figures[i] = (cost_figure){0};
            if ((unsigned)i % few == 0) {
                *figures[i] = drawn_figure(&d);
                there[figures[i]->basis] = true;
            }
        }
        caught legend;
        figure_legend(catch_text(&legend), &c);
        alloc_text_end(legend.to);
        const char *at = legend.text;
        for (int b = COST_EXACT; b < COST_BASES; b++) {
            char begin[40];
            snprintf(begin, sizeof begin, "  %c  %s: ", letters[b], cost_basis_words[b]);
            const bool is = strncmp(at, begin, strlen(begin)) == 0;
            TEST_ASSERT_EQUAL_INT(there[b], is);
            if (is) {
                TEST_ASSERT_TRUE(at[strlen(begin)] != '\n');
                at = strchr(at, '\n') + 1;
            }
        }
        TEST_ASSERT_EQUAL_STRING("", at);
        free(legend.text);
    }
}

/* RFC 4180: quoted fields parse to the original, and quotes appear only where needed. */
static void test_fields_come_back(void) {
    static const char pieces[] = "abc \",\r\n\"x";
    dice d = dice_of("price_words fields", 33);
    for (int n = 0; n < 2000; n++) {
        char text[12];
        char back[12];
        size_t length = dice_one_of(&d, 10);
        for (size_t i = 0; i < length; i++) {
            text[i] = pieces[dice_one_of(&d, sizeof pieces - 1)];
        }
        text[length] = '\0';
        caught field;
        atomic_file_field(catch_text(&field), text);
        alloc_text_end(field.to);
        if (strpbrk(text, ",\"\r\n") == NULL) {
            TEST_ASSERT_EQUAL_STRING(text, field.text);
        } else {
            size_t to = 0;
            TEST_ASSERT_EQUAL_CHAR('"', field.text[0]);
            TEST_ASSERT_EQUAL_CHAR('"', field.text[field.length - 1]);
            for (size_t i = 1; i + 1 < field.length; i++) {
                TEST_ASSERT_TRUE(field.text[i] != '"' || field.text[i + 1] == '"');
                back[to++] = field.text[i];
                i += field.text[i] == '"';
            }
            back[to] = '\0';
            TEST_ASSERT_EQUAL_STRING(text, back);
        }
        free(field.text);
    }
}

static const char *const places[] = {
    "mechanism m\ncoordinate x [mm]\ncoordinate z [m]\nT = 1 [kg]*(x'^2 + z'^2)/2\n"
    "V = 9 [N/m]*(x^2 + z^2)/2\nscene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\ncoordinate z [m]\nT = 1 [kg]*(x'^2 + z'^2)/2\n"
    "V = 16 [N/m]*(x^2 + z^2)/2\nscene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 50};
enum { RECORDS = 20, ROWS = 12 };

static void draw_rows(dice *d, table *made, table_unit unit) {
    for (int i = 0; i < ROWS; i++) {
        table_row *r = &made->row[i];
        *r = (table_row){.setting = setting_at((int)dice_one_of(d, (unsigned)setting_count())),
                         .pace = {1, 1 + dice_one_of(d, 5)}};
        r->result = (trial_result){.ran = true,
                                   .usable = true,
                                   .error = pow(10.0, dice_between(d, -9.0, -1.0)),
                                   .bound = dice_one_of(d, 2) == 1,
                                   .point = (int)dice_one_of(d, 2),
                                   .column = 1 + (int)dice_one_of(d, 4)};
        r->cost = (cost){.instructions = drawn_figure(d),
                         .cycles = drawn_figure(d),
                         .flash_bytes = drawn_figure(d),
                         .ram_bytes = drawn_figure(d),
                         .stack_bytes = drawn_figure(d),
                         .state_bytes = drawn_figure(d),
                         .why = ""};
        const double value = pow(10.0, dice_between(d, 3.0, 8.0));
        r->price = (table_price){unit, (cost_basis)(COST_PREDICTED + dice_one_of(d, 4)), value,
                                 0.5 * value, 3.0 * value};
    }
    made->count = ROWS;
    table_sort(made);
}

static const char *field_of(const char *at, char *field, size_t size) {
    size_t to = 0;
    const bool quoted = *at == '"';
    for (at += quoted; *at != '\0' && (quoted || (*at != ',' && *at != '\r')); at++) {
        if (quoted && *at == '"' && *++at != '"') {
            break;
        }
        TEST_ASSERT_TRUE(to + 1 < size);
        field[to++] = *at;
    }
    field[to] = '\0';
    return *at == ',' ? at + 1 : at;
}

static const char *expect_field(const char *at, const char *want) {
    char field[400];
    at = field_of(at, field, sizeof field);
    TEST_ASSERT_EQUAL_STRING(want, field);
    return at;
}

static const char *expect_number(const char *at, double want, double part) {
    char field[400];
    at = field_of(at, field, sizeof field);
    TEST_ASSERT_TRUE_MESSAGE(fabs(strtod(field, NULL) - want) <= part * fabs(want), field);
    return at;
}

static const char *expect_figure(const char *at, const cost_figure *f) {
    at = f->basis == COST_NOT_KNOWN ? expect_field(at, "") : expect_number(at, f->value, 0.0);
    return expect_field(at, cost_basis_words[f->basis]);
}

/* "whirl run TARGET CHANGES PLACE OPTIONS --step S --until U"; the line that writes C has no place. */
static char *line_again(const trials *t, const table_row *r, const table_words *words, bool run) {
    char options[SETTING_TEXT];
    char step[TRIAL_TIME];
    char where[24] = "";
    setting_options(&r->setting, run, options);
    trial_time(trial_step(t, r->pace), step);
    if (run) {
        snprintf(where, sizeof where, " --set place=%d", r->result.point);
    }
    return alloc_words("whirl %s %s%s%s%s%s --step %s --until 0.4%s", run ? "run" : "derive",
                       words->target, words->changes, where, options,
                       !run && setting_is_fixed(&r->setting) ? " --number fixed" : "", step,
                       run ? "" : " --as c");
}

static void test_programs_read_what_the_rows_are(void) {
    dice d = dice_of("price_words csv", 34);
    const table_words words = {"f.whirl:s", " --set \"a b\"", false, 0.0};
    for (int n = 0; n < 3; n++) {
        priced p;
        priced_open(&p, places, 2);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, n == 1 ? "x'" : NULL));
        table_row row[ROWS];
        table made = {.row = row};
        draw_rows(&d, &made, (table_unit)n);
        caught csv;
        table_csv(catch_text(&csv), &p.trial, &made, &words);
        alloc_text_end(csv.to);
        const char *at = csv.text;
        TEST_ASSERT_EQUAL_STRING_LEN("front,error,error_unit,error_basis,error_bound,component,"
                                     "price_per_s,price_of,price_basis,price_least,"
                                     "price_most,step_s,method,number,angles,matrix,tables,"
                                     "flash_bytes,flash_basis,ram_bytes,ram_basis,stack_bytes,"
                                     "stack_basis,state_bytes,state_basis,run,derive\r\n",
                                     at, strcspn(at, "\n") + 1);
        for (int i = 0; i < ROWS; i++) {
            const table_row *r = &row[i];
            char step[TRIAL_TIME];
            static const char *const columns[] = {"", "x", "z", "x'", "z'"};
            static const char *const units[] = {"cycles", "instructions", "evaluations"};
            at = strchr(at, '\n') + 1;
            at = expect_field(at, r->on_front ? "1" : "0");
            at = expect_number(at, r->result.error, 1e-8);
            at = expect_field(at, n == 1 ? "mm/s" : "");
            at = expect_field(expect_field(at, "measured"), r->result.bound ? "1" : "0");
            at = expect_field(at, columns[r->result.column]);
            at = expect_field(expect_number(at, r->price.value, 1e-8), units[n]);
            at = expect_field(at, cost_basis_words[r->price.basis]);
            at = expect_number(expect_number(at, r->price.least, 1e-8), r->price.most, 1e-8);
            at = expect_field(at, trial_time(trial_step(&p.trial, r->pace), step));
            for (int a = 0; a < AXES; a++) {
                at = expect_field(at, setting_word(&r->setting, (setting_axis)a));
            }
            at = expect_figure(expect_figure(at, &r->cost.flash_bytes), &r->cost.ram_bytes);
            at = expect_figure(expect_figure(at, &r->cost.stack_bytes), &r->cost.state_bytes);
            char *run = line_again(&p.trial, r, &words, true);
            char *derive = line_again(&p.trial, r, &words, false);
            at = expect_field(expect_field(at, run), derive);
            free(run);
            free(derive);
            TEST_ASSERT_EQUAL_STRING_LEN("\r\n", at, 2);
        }
        TEST_ASSERT_EQUAL_STRING("\r\n", at);
        free(csv.text);
        priced_close(&p);
    }
}

/* The text after `what`, which occurs once. */
static const char *behind(const char *text, const char *what) {
    const char *at = strstr(text, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, what), what);
    return at + strlen(what);
}

static void expect_row(const char *line, const trials *t, const table_row *r) {
    char text[FIGURE_TEXT];
    char word[16];
    char want[SETTING_TEXT + TRIAL_TIME + 16];
    char options[SETTING_TEXT];
    char step[TRIAL_TIME];
    double number;
    TEST_ASSERT_EQUAL_CHAR(r->on_front ? '*' : ' ', line[0]);
    const char *at = r->result.bound ? said_words(line + 1, "<") : line + 1;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(fabs(number / r->result.error - 1) <= 5.1e-3);
    at = said_word(said_number(at, &number), word, sizeof word);
    TEST_ASSERT_TRUE(fabs(number / r->price.value - 1) <= 5.1e-3);
    TEST_ASSERT_TRUE(word[0] == letters[r->price.basis] && word[1] == '\0');
    at = said_words(at, figure_text(&r->cost.flash_bytes, text));
    at = said_words(at, figure_text(&r->cost.ram_bytes, text));
    at = said_words(at, figure_text(&r->cost.stack_bytes, text));
    TEST_ASSERT_EQUAL_STRING_LEN("  ", at, 2);
    at = said_words(at, figure_text(&r->cost.state_bytes, text));
    TEST_ASSERT_EQUAL_STRING_LEN("  --", at, 4);
    snprintf(want, sizeof want, "%s --step %s\n", setting_options(&r->setting, true, options) + 1,
             trial_time(trial_step(t, r->pace), step));
    (void)said_words(at, want);
}

static void test_people_read_what_the_rows_are(void) {
    dice d = dice_of("price_words tables", 35);
    static const char *const heads[] = {"cycles/s", "instr./s", "eval./s"};
    for (int n = 0; n < 6; n++) {
        const table_words words = {"f.whirl:s", " --set m=3", n >= 3, 1e7};
        const int points = n == 2 ? 1 : 2;
        priced p;
        priced_open(&p, places, points);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, n % 2 ? "x'" : NULL));
        table_row row[ROWS];
        table made = {.row = row, .why = "a reason"};
        draw_rows(&d, &made, (table_unit)(n % 3));
        for (int i = 0; i < made.count && points == 1; i++) {
            row[i].result.point = 0;
        }
        const bool evaluations = n % 3 == PRICE_EVALUATIONS;
        made.settings = 90;
        made.unpriced = n % 2 == 0 ? 7 : 0;
        made.broken_off = n % 3 ? 5 : 0;
        caught out;
        table_print(catch_text(&out), &p.trial, &made, &words);
        alloc_text_end(out.to);
        (void)said_words(out.text, "s on mps2-an386 (Cortex-M4F)\n  error       measured: ");
        TEST_ASSERT_EQUAL_INT(points > 1,
                              strstr(out.text, "the worst of 2 sampled places") != NULL);
        TEST_ASSERT_EQUAL_INT(n % 2, strstr(out.text, "deviation of x' from") != NULL);
        TEST_ASSERT_EQUAL_INT(n % 2, strstr(out.text, "  error, mm/s  ") != NULL);
        TEST_ASSERT_EQUAL_INT(n % 2 == 0, strstr(out.text, "largest value, of the worst") != NULL);
        const char *at = behind(out.text, "   settings\n");
        TEST_ASSERT_NOT_NULL(strstr(out.text, heads[n % 3]));
        const char *above = strstr(out.text, "\nletters behind figures: ");
        TEST_ASSERT_TRUE(above != NULL && above < strstr(out.text, heads[n % 3]));
        int front = 0;
        int shown = 0;
        const table_row *last = NULL;
        for (int i = 0; i < ROWS; i++) {
            front += row[i].on_front;
            last = row[i].on_front ? &row[i] : last;
            if (words.all || row[i].on_front) {
                expect_row(at, &p.trial, &row[i]);
                at = strchr(at, '\n') + 1;
                shown++;
            }
        }
        TEST_ASSERT_TRUE(*at == '\n' && shown == (words.all ? ROWS : front));
        char want[200];
        snprintf(want, sizeof want,
                 "\n12 rows, %d of them on the front (*): no row is as cheap and errs less%s\n",
                 front, words.all ? "" : "; ");
        if (words.all) {
            (void)behind(out.text, want);
        }
        snprintf(want, sizeof want, "\n90 settings%s%s%s\n",
                 made.broken_off > 0
                     ? "; finer steps of 5 take more than their share of --effort 1e+07"
                     : "",
                 made.unpriced > 0 ? "; 7 without a price here: " : "",
                 made.unpriced > 0 ? made.why : "");
        (void)behind(out.text, want);
        TEST_ASSERT_EQUAL_INT(evaluations, strstr(out.text, "counted in the run") != NULL);
        if (!evaluations) {
            char of[FIGURE_WORDS];
            snprintf(
                want, sizeof want, "\n  %s a simulated second: %s\n",
                n % 3 == 0 ? "cycles" : "instructions",
                figure_words(n % 3 == 0 ? &row[0].cost.cycles : &row[0].cost.instructions, of));
            (void)behind(out.text, want);
        }
        if (points > 1) {
            char *run = line_again(&p.trial, last, &words, true);
            char *derive = line_again(&p.trial, last, &words, false);
            at = behind(out.text, "the last row of the front again, and as code:\n  ");
            at = said_words(said_words(said_words(at, run), "\n  "), derive);
            TEST_ASSERT_EQUAL_STRING("\n", at);
            free(run);
            free(derive);
        }
        free(out.text);
        priced_close(&p);
    }
}

/* The cheapest and the most accurate row are among them. */
static void test_at_most_twelve_rows_of_a_front_are_shown(void) {
    dice d = dice_of("price_words fronts", 36);
    priced p;
    priced_open(&p, places, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    for (unsigned n = 0; n < dice_cases(few_or_all(60, 600)); n++) {
        enum { MANY = 60 };
        table_row row[MANY];
        table made = {.row = row, .count = 1 + (int)dice_one_of(&d, MANY), .why = ""};
        double error = 1.0;
        for (int i = 0; i < made.count; i++) {
            row[i] = (table_row){.setting = setting_at(0), .pace = {(uint64_t)i + 1, 1}};
            row[i].price.value = i + 1;
            error *= dice_between(&d, 0.5, 0.99);
            row[i].result.error = error;
            row[i].cost.why = "";
        }
        table_sort(&made);
        const table_words words = {"f", "", false, 1e7};
        caught out;
        table_print(catch_text(&out), &p.trial, &made, &words);
        alloc_text_end(out.to);
        int shown = 0;
        for (const char *at = strstr(out.text, "\n* "); at != NULL; at = strstr(at + 1, "\n* ")) {
            shown++;
        }
        char want[60];
        snprintf(want, sizeof want, "\n* %9.2e  ", row[0].result.error);
        TEST_ASSERT_NOT_NULL(strstr(out.text, want));
        TEST_ASSERT_TRUE(shown <= 12 && (made.count > 12 || shown == made.count));
        TEST_ASSERT_TRUE(made.count <= 12 || shown >= 4);
        snprintf(want, sizeof want, "errs less; %d are shown, --all shows all\n", shown);
        (void)behind(out.text, want);
        free(out.text);
    }
    priced_close(&p);
}

static char *table_of_nothing(const trials *t, const table *made) {
    const table_words words = {"f", "", false, 1e7};
    caught out;
    table_print(catch_text(&out), t, made, &words);
    alloc_text_end(out.to);
    return out.text;
}

static void test_tables_of_nothing_say_why(void) {
    priced p;
    priced_open(&p, places, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    table made = {.unpriced = 3, .why = "a reason"};
    char *text = table_of_nothing(&p.trial, &made);
    (void)behind(text, "\nno setting has a row: 0 settings; 3 without a price here: a reason\n");
    /* z rests and has no relative error; the two references agree as reported */
    (void)behind(text, "\n  left out    stays at zero but for rounding: z, z'\n");
    const char *at = behind(text, "the two agree within ");
    double number;
    (void)said_number(at, &number);
    TEST_ASSERT_TRUE(fabs(number / reference_agreement(p.trial.reference[0]) - 1) <= 0.051);
    (void)behind(text, "  horizon     0.4 s, 20 records\n");
    free(text);
    made.unpriced = 0;
    text = table_of_nothing(&p.trial, &made);
    (void)behind(text, "\nno setting keeps to the motion:");
    free(text);
    text = table_of_nothing(&p.trial, NULL);
    (void)behind(text, "\nno setting keeps to the motion:");
    free(text);
    p.trial.records = 10; /* ends before the requested time */
    text = table_of_nothing(&p.trial, NULL);
    (void)behind(text, "  horizon     0.2 s of 0.4 s: the reference ends\n");
    free(text);
    p.trial.reliable = false;
    p.trial.reference[0]->kind = REFERENCE_NONE;
    free(p.trial.reference[0]->why);
    p.trial.reference[0]->why = alloc_words("nobody knows");
    text = table_of_nothing(&p.trial, NULL);
    (void)behind(text, "\n              none that could be trusted: nobody knows\n");
    (void)behind(text, "\nno front: without a reference no error is known\n");
    TEST_ASSERT_NULL(strstr(text, "the two agree"));
    free(text);
    priced_close(&p);
}

void suite_price_words(void) {
    RUN_TEST(test_figures_say_how_they_are_known);
    RUN_TEST(test_legends_have_a_line_for_each_basis_that_is_there);
    RUN_TEST(test_fields_come_back);
    RUN_TEST(test_programs_read_what_the_rows_are);
    RUN_TEST(test_people_read_what_the_rows_are);
    RUN_TEST(test_at_most_twelve_rows_of_a_front_are_shown);
    RUN_TEST(test_tables_of_nothing_say_why);
}
