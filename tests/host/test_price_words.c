/* test_price_words.c: printed prices and choices (host/study/price_table.h, choice.h): made-up rows as text, CSV and
 * JSON, compared with price_words.txt. */
#include "caught.h"
#include "command.h"
#include "host/base/alloc.h"
#include "host/os/atomic_file.h"
#include "host/study/choice.h"
#include "priced.h"

#define PLACE(k) \
    "mechanism m\ncoordinate x [mm]\ncoordinate z [m]\nT = 1 [kg]*(x'^2 + z'^2)/2\n" \
    "V = " k " [N/m]*(x^2 + z^2)/2\nscene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n"
static const char *const places[] = {PLACE("9"), PLACE("16")};
static const whole_ratio spacing = {1, 50};
enum { RECORDS = 20, ROWS = 12 };

static void begin(priced *p, const char *const *texts, int points, const char *of) {
    priced_open(p, texts, points);
    TEST_ASSERT_TRUE(priced_begin(p, "mps2-an386", spacing, RECORDS, of));
}

/* Copies a text, beginning with the words `from`, without lines that depend on the digits of long double. */
static void copy_text(FILE *out, const char *name, int n, char *text, const char *from) {
    fprintf(out, "=== %s %d\n", name, n);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, from), from);
    for (char *line = strstr(text, from); *line != '\0';) {
        const size_t length = strcspn(line, "\n") + 1;
        if (strncmp(line, "  reference ", 12) != 0 &&
            strstr(line, "both references agree") != line + 14) {
            for (size_t i = 0; i < length; i++) {
                fputs(line[i] == '\r' ? "\\r" : (char[]){line[i], '\0'}, out);
            }
        }
        line += length;
    }
    free(text);
}

static cost_figure figure_of(int i, cost_basis basis) {
    const double value = 137.0 * (1 + i * 7919 % 1000);
    return basis == COST_NOT_KNOWN
               ? (cost_figure){0}
               : (cost_figure){basis, basis == COST_RANGE ? 0.0 : value, value / 1.25, value * 1.5};
}

static table_row row_of(int i, int points, cost_basis cycles, table_unit unit) {
    const cost_basis basis = (cost_basis)(i % COST_BASES);
    const int by_price = i * 7 % ROWS;
    const double value = 1e3 * (1 + by_price);
    double error = 1e-12;
    for (int k = 2 * (ROWS - by_price) + i % 3 * 4; k > 0; k--) {
        error *= 2.3;
    }
    return (table_row){
        .setting = setting_at(i * 23 % setting_count()),
        .pace = {1, 1 + (unsigned)i % 5U},
        .result = {.ran = true,
                   .usable = true,
                   .error = error,
                   .bound = i % 3 == 0,
                   .point = i % points,
                   .column = 1 + i % 4},
        .cost = {.instructions = figure_of(i, COST_PREDICTED),
                 .instructions_worst = figure_of(i + 1, COST_PREDICTED),
                 .cycles = figure_of(i + 2, cycles),
                 .cycles_worst = figure_of(i + 3, cycles),
                 .flash_bytes = figure_of(i + 4, basis),
                 .ram_bytes = figure_of(i + 5, (cost_basis)((i + 2) % COST_BASES)),
                 .stack_bytes = figure_of(i + 6, (cost_basis)((i + 4) % COST_BASES)),
                 .state_bytes = figure_of(i + 7, i % 4 == 3 ? COST_NOT_KNOWN : COST_EXACT),
                 .why = ""},
        .price = {unit, (cost_basis)(COST_PREDICTED + i % 4), value, 0.5 * value, 3.0 * value}};
}

static table table_of(table_row *row, int count, int points, cost_basis cycles, table_unit unit) {
    for (int i = 0; i < count; i++) {
        row[i] = row_of(i, points, cycles, unit);
    }
    table made = {.row = row, .count = count, .settings = 90, .why = "a reason", .operations = 1e7};
    table_sort(&made);
    return made;
}

static void print_tables(FILE *out) {
    for (int n = 0; n < 3; n++) {
        priced p;
        table_row row[ROWS];
        caught text;
        const int points = n == 2 ? 1 : 2;
        begin(&p, places, points, n == 1 ? "x'" : NULL);
        p.trial.request.changes = n == 0 ? " --set m=3" : " --set \"a b\"";
        table made =
            table_of(row, ROWS, points, n == 0 ? COST_ESTIMATED : COST_RANGE, (table_unit)n);
        made.unpriced = n == 1 ? 0 : 7;
        made.broken_off = n == 0 ? 0 : 5;
        table_print(catch_text(&text), &p.trial, &made, n > 0);
        alloc_text_end(text.to);
        copy_text(out, "table", n, text.text, "");
        made = table_of(row, 3, points, COST_ESTIMATED, (table_unit)n);
        table_csv(catch_text(&text), &p.trial, &made);
        alloc_text_end(text.to);
        copy_text(out, "csv", n, text.text, "");
        priced_close(&p);
    }
}

static void print_choice(FILE *out, const char *name, int n, const priced *p, const table *made,
                         const choice_request *w, const choice *c) {
    caught text;
    choice_print(catch_text(&text), &p->trial, made, w, c);
    alloc_text_end(text.to);
    copy_text(out, name, n, text.text, c->of[CHOICE_FASTEST].row < 0 ? "no setting fits" : "");
}

static void print_answers(FILE *out) {
    static const struct {
        cost_basis cycles;
        int smallest; /* the row of the smallest setting; -1: none */
        double rate_Hz, clock_Hz;
        counted_run run;
        bool no_cycles;
    } cases[] = {{COST_ESTIMATED, 1, 40.0, 16e6, {500, 1000, 2000}, false},
                 {COST_RANGE, 0, 0.0, 16e6, {700, 1000, 0}, false},
                 {COST_PREDICTED, -1, 0.0, 0.0, {0, 0, 0}, false},
                 {COST_ESTIMATED, 0, 0.0, 1e6, {300, 0, 0}, true},
                 {COST_RANGE, 0, 25.0, 2e6, {0, 0, 0}, false}};
    for (int n = 0; n < 5; n++) {
        priced p;
        begin(&p, places, 2, n % 2 == 0 ? "x" : NULL);
        table_row row[2] = {row_of(n, 2, cases[n].cycles, PRICE_CYCLES),
                            row_of(n + 4, 2, cases[n].cycles, PRICE_CYCLES)};
        row[0].run = cases[n].run;
        const table made = {.row = row,
                            .count = 2,
                            .settings = 50,
                            .broken_off = n == 1 ? 3 : 0,
                            .unpriced = n == 2 ? 2 : 0,
                            .operations = 1e7,
                            .why = "a reason"};
        const choice_request w = {
            .table = {.error = 0.01, .rate_Hz = cases[n].rate_Hz, .periods = 1},
            .clock_Hz = cases[n].clock_Hz,
            .prices = "as they are"};
        choice c = {{{.row = 0, .worst = 4e4, .load = 0.02, .load_most = 0.03},
                     {.row = cases[n].smallest, .load = 0.4, .load_most = 0.5}}};
        c.of[CHOICE_FASTEST].unknown = (cases[n].no_cycles ? CHOICE_BIT(CHOICE_LOAD) : 0U) |
                                       (n == 2 ? CHOICE_BIT(CHOICE_FLASH) : 0U);
        print_choice(out, "answers", n, &p, &made, &w, &c);
        priced_close(&p);
    }
}

/* Prints answers for requests that no setting meets. Bit i of there[n] says whether the answer rows[i] exists. */
static void print_remedies(FILE *out) {
    static const unsigned there[] = {15, 14, 13, 11, 9, 8, 0, 4};
    for (int n = 0; n < 8; n++) {
        priced p;
        begin(&p, places, 2, n % 2 == 0 ? "x" : NULL);
        table_row row[3];
        table made = table_of(row, 3, 2, COST_ESTIMATED, PRICE_CYCLES);
        made.why = "";
        made.broken_off = n == 3 ? 3 : 0;
        const choice_request w = {
            .table = {.error = 1e-3}, .clock_Hz = 16e6, .prices = "as they are"};
        choice c = {{{.row = -1}, {.row = -1}}};
        for (unsigned i = 0; i < 4; i++) {
            static const unsigned fails[] = {CHOICE_BIT(CHOICE_ERROR), CHOICE_BIT(CHOICE_LOAD),
                                             CHOICE_BIT(CHOICE_RAM),
                                             CHOICE_BIT(CHOICE_LOAD) | CHOICE_BIT(CHOICE_RAM)};
            c.of[CHOICE_WEAKER + i] =
                (choice_row){.row = (there[n] >> i & 1U) != 0 ? (int)i * 2 / 3 : -1,
                             .load_most = 3.7,
                             .fails = fails[i]};
        }
        print_choice(out, "remedies", n, &p, &made, &w, &c);
        priced_close(&p);
    }
    priced p;
    begin(&p, priced_ball, 1, NULL);
    const table made = {.settings = 9, .unpriced = 9, .why = "a reason"};
    const choice_row none = {.row = -1};
    const choice c = {{none, none, none, none, none, none}};
    print_choice(out, "no price", 0, &p, &made,
                 &(choice_request){.table = {.error = 1e-3}, .prices = "as they are"}, &c);
    priced_close(&p);
}

TEST(price_words, printed_prices_and_choices) {
    caught all;
    catch_text(&all);
    print_tables(all.to);
    print_answers(all.to);
    print_remedies(all.to);
    alloc_text_end(all.to);
    expect_printed("price_words", all.text);
    free(all.text);
}

/* By RFC 4180, quoted fields must be read as the original text. Quotes may appear only if they are needed. */
TEST(price_words, fields_are_read_back) {
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

/* Returns the text after `what`, which must occur exactly once. */
static const char *behind(const char *text, const char *what) {
    const char *at = strstr(text, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, what), what);
    return at + strlen(what);
}

/* The shown rows must include the cheapest and the most accurate one. */
TEST(price_words, front_shows_at_most_twelve_rows) {
    dice d = dice_of("price_words fronts", 36);
    priced p;
    begin(&p, places, 1, NULL);
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
        caught out;
        table_print(catch_text(&out), &p.trial, &made, false);
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
        snprintf(want, sizeof want, "in both error and cost; %d are shown, --all shows all\n",
                 shown);
        (void)behind(out.text, want);
        free(out.text);
    }
    priced_close(&p);
}

static char *table_of_nothing(const trials *t, const table *made) {
    caught out;
    table_print(catch_text(&out), t, made, false);
    alloc_text_end(out.to);
    return out.text;
}

TEST(price_words, empty_tables_give_reasons) {
    priced p;
    begin(&p, places, 1, NULL);
    table made = {.unpriced = 3, .why = "a reason"};
    char *text = table_of_nothing(&p.trial, &made);
    (void)behind(text, "\nthe table is empty: 0 settings; 3 without a price: a reason\n");
    /* z is at rest and has no relative error; the two references must agree as reported */
    (void)behind(text, "\n  left out    these are zero except for round-off: z, z'\n");
    const char *at = behind(text, "both references agree within ");
    double number;
    (void)said_number(at, &number);
    TEST_ASSERT_TRUE(fabs(number / reference_agreement(p.trial.reference[0], -1) - 1) <= 0.051);
    (void)behind(text, "  horizon     0.4 s, 20 records\n");
    free(text);
    made.unpriced = 0;
    text = table_of_nothing(&p.trial, &made);
    (void)behind(text, "\nno setting follows the motion:");
    free(text);
    text = table_of_nothing(&p.trial, NULL);
    (void)behind(text, "\nno setting follows the motion:");
    free(text);
    p.trial.records = 10; /* the run ends early */
    text = table_of_nothing(&p.trial, NULL);
    (void)behind(text, "  horizon     0.2 s of 0.4 s: the reference ends\n");
    free(text);
    p.trial.reliable = false;
    p.trial.reference[0]->reliable = false;
    free(p.trial.reference[0]->why);
    p.trial.reference[0]->why = alloc_words("nobody knows");
    text = table_of_nothing(&p.trial, NULL);
    (void)behind(text, "\n              no reliable reference: nobody knows\n");
    (void)behind(text, "\nno table: without a reliable reference the errors are unknown\n");
    TEST_ASSERT_NULL(strstr(text, "both references agree"));
    free(text);
    priced_close(&p);
}
