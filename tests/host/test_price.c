/* test_price.c: cost of operation lists for expressions of known least cost: no one writes them shorter by hand.
 * Values are checked elsewhere. Also choices, extrapolation and trials. */
#define _POSIX_C_SOURCE 200809L

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/study/choice.h"
#include "host/study/price_table.h"
#include "host/study/reference_run.h"

#include "blocks.h"
#include "caught.h"
#include "command.h"
#include "derived.h"
#include "priced.h"

#include "unity.h"

void suite_price(void);
void suite_price_chosen(void);
void suite_price_control(void);
void suite_price_dearest(void);

/* === price ==================================================================================== */

/* Operations, and sine pairs, of the only output of seven numbers x0 ... x6 and two angles a and b. */
typedef struct price {
    int operations;
    int waves;
} price;

__attribute__((format(printf, 1, 2))) static price price_of(const char *format, ...) {
    char output[2000];
    char text[3000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(output, sizeof output, format, arguments);
    va_end(arguments);
    snprintf(
        text, sizeof text,
        "mechanism m\ncoordinate x0\ncoordinate x1\ncoordinate x2\ncoordinate x3\n"
        "coordinate x4\ncoordinate x5\ncoordinate x6\ncoordinate a [rad]\ncoordinate b [rad]\n"
        "T = 1 [kg*m^2]*(x0'^2 + x1'^2 + x2'^2 + x3'^2 + x4'^2 + x5'^2 + x6'^2 + a'^2 + b'^2)/2\n"
        "output it = %s\n",
        output);
    derived d = derived_text(text);
    derived_expect(&d, text);
    const price of = {op_list_operations(d.image->list[IMAGE_OBSERVE]),
                      op_list_count(d.image->list[IMAGE_OBSERVE]).waves};
    derived_free(&d);
    return of;
}

static unsigned draw(uint64_t *seed, unsigned bound) {
    return (unsigned)(random_bits(seed) % bound);
}

static void expect(price got, int operations, int waves, const char *what) {
    char line[2200];
    snprintf(line, sizeof line, "%s: %d operations, %d sine pairs; wanted %d, %d", what,
             got.operations, got.waves, operations, waves);
    TEST_ASSERT_TRUE_MESSAGE(got.operations <= operations && got.waves <= waves, line);
}

/* --- sums and products ------------------------------------------------------------------------------------- */

/* Horner's scheme: a product and a sum per power. */
static void test_polynomials_take_two_operations_a_power(void) {
    for (int degree = 1; degree <= 9; degree++) {
        char sum[400] = "1";
        for (int k = 1; k <= degree; k++) {
            snprintf(sum + strlen(sum), sizeof sum - strlen(sum), " %c %d*x0^%d",
                     k % 3 == 0 ? '-' : '+', k + 1, k);
        }
        expect(price_of("%s", sum), 2 * degree, 0, sum);
    }
}

/* By squaring: binary digits plus ones of the exponent, less two. */
static void test_powers_take_few_products(void) {
    for (int exponent = 2; exponent <= 64; exponent++) {
        int products = -2;
        for (int rest = exponent; rest > 0; rest /= 2) {
            products += 1 + rest % 2;
        }
        char what[40];
        snprintf(what, sizeof what, "x0^%d", exponent);
        expect(price_of("%s", what), products, 0, what);
        expect(price_of("1/%s", what), products + 1, 0, what);
        snprintf(what, sizeof what, "x0^(%d/2)", 2 * exponent + 1);
        expect(price_of("%s", what), 2 * exponent > 62 ? 1 : 60, 0, what);
    }
}

static void test_equal_coefficients_are_taken_out(void) {
    uint64_t seed = 17;
    for (int count = 2; count <= 7; count++) {
        for (int round = 0; round < 8; round++) {
            char sum[200] = "0";
            bool plus = false;
            for (int k = 0; k < count; k++) {
                const bool negative = draw(&seed, 2) != 0;
                plus = plus || !negative;
                snprintf(sum + strlen(sum), sizeof sum - strlen(sum), " %c 3*x%d",
                         negative ? '-' : '+', k);
            }
            expect(price_of("%s", sum), count - 1 + 1 + (plus ? 0 : 1), 0, sum);
            expect(price_of("%s + 5*x0*x1", sum), count - 1 + 1 + (plus ? 0 : 1) + 3, 0, sum);
        }
    }
}

/* Nested as written: x0 (2 x1 + x2 (3 x3 + x4 (5 x5 + 7 x6))), and with another x0 in each part. */
static void test_factors_are_taken_out_again(void) {
    expect(price_of("x0*(2*x1 + 3*x2)"), 4, 0, "one factor");
    expect(price_of("x0*(2*x1 + x2*(3*x3 + 5*x4))"), 7, 0, "a factor inside");
    expect(price_of("x0*(2*x1 + x2*(3*x3 + x4*(5*x5 + 7*x6)))"), 10, 0, "two factors inside");
    expect(price_of("x0^2*(2*x1 + 3*x2) + x0*5*x3 + 7"), 9, 0, "powers of a factor");
    expect(price_of("x0*x1*(2*x2 + 3*x3) + 5*x4*x5"), 8, 0, "two factors");
    expect(price_of("1 [s]*x0'*(2*x1 + 3*x2) + x3*(5*x1 + 7*x4)"), 9, 0, "rates");
    expect(price_of("x0*x1 + x0*x2 + x0*x3"), 3, 0, "no coefficients");
}

/* Odd powers of a root share it. */
static void test_what_is_the_same_is_computed_once(void) {
    static const char *const of[] = {"exp(x0)",    "sqrt(x0)",    "atan2(x0, x1)", "abs(x0)",
                                     "log(x0*x1)", "max(x0, x1)", "sin(x0*x1)"};
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        const price one = price_of("%s", of[i]);
        expect(price_of("%s*x2 + 3*%s*x3", of[i], of[i]), one.operations + 3, one.waves, of[i]);
        expect(price_of("x4 + 5*%s + 3*x2*%s", of[i], of[i]), one.operations + 4, one.waves, of[i]);
    }
}

/* --- sines --------------------------------------------------------------------------------------------------- */

static void test_sines_of_multiples_follow_from_one(void) {
    uint64_t seed = 19;
    for (int round = 0; round < 24; round++) {
        char sum[400] = "7*sin(a)*x0";
        for (int k = 1; k <= 4; k++) {
            snprintf(sum + strlen(sum), sizeof sum - strlen(sum), " + %d*%s(%u*a)", k + 1,
                     draw(&seed, 2) != 0 ? "sin" : "cos", draw(&seed, 2) + (unsigned)k);
        }
        expect(price_of("%s", sum), 40, 1, sum);
    }
    /* also inside functions */
    expect(price_of("exp(sin(a)) + 3*exp(cos(2*a))"), 40, 1, "sines inside functions");
    expect(price_of("atan2(sin(2*a), x0 + cos(a)) + x1*sqrt(3 + sin(3*a))"), 40, 1, "sines inside");
    expect(price_of("sin(x0*sin(2*a)) + x1*cos(a)"), 40, 2, "a sine inside a sine");
    expect(price_of("sin(2*a) + 3*sin(a)"), 6, 1, "twice an angle");
    expect(price_of("3*cos(2*a)"), 5, 1, "the cosine of twice an angle");
    expect(price_of("cos(a + b) + 3*cos(a) + 5*cos(b)"), 11, 2, "a sum of angles");
    expect(price_of("3*cos(a - b) + 5*sin(a) + cos(b)"), 11, 2, "a difference of angles");
}

/* Powers of sines stay powers where their sums would lose digits and cost more. */
static void test_powers_of_sines_are_put_back(void) {
    for (int n = 1; n <= 7; n++) {
        char what[60];
        int products = -2;
        for (int rest = 2 * n; rest > 0; rest /= 2) {
            products += 1 + rest % 2;
        }
        snprintf(what, sizeof what, "sin(a)^%d", 2 * n);
        expect(price_of("%s", what), 1 + products, 1, what);
        snprintf(what, sizeof what, "cos(a)^%d", 2 * n);
        expect(price_of("%s", what), 1 + products, 1, what);
    }
    expect(price_of("x0*(1 + cos(2*a))"), 4, 1, "a square of a cosine");
    expect(price_of("1 - cos(2*a)"), 3, 1, "a square of a sine");
    expect(price_of("x0*(1 - cos(2*a)) + x1*(1 + cos(4*b))"), 9, 2, "squares beside each other");
}

/* --- equations ----------------------------------------------------------------------------------------------- */

/* n equations; all entries of matrix and right side are distinct states. */
static int price_of_system(int n) {
    char text[4000] = "mechanism m\n";
#define PUT(...) snprintf(text + strlen(text), sizeof text - strlen(text), __VA_ARGS__)
    for (int i = 0; i < n * (n + 2); i++) {
        PUT("state s%d\n", i);
    }
    for (int i = 0; i < n; i++) {
        PUT("equation 1 [s]*(0");
        for (int j = 0; j < n; j++) {
            PUT(" + s%d*s%d'", n + i * (n + 1) + j, j);
        }
        PUT(") = s%d\n", n + i * (n + 1) + n);
    }
    for (int i = n; i < n * (n + 2); i++) {
        PUT("equation 1 [s]*s%d' = 0\n", i);
    }
#undef PUT
    derived d = derived_text(text);
    derived_expect(&d, text);
    const int operations = op_list_operations(d.image->list[IMAGE_STEP]);
    derived_free(&d);
    printf("  %d equations: %d operations\n", n, operations);
    return operations;
}

/* Up to three by Cramer's rule. Each further one by elimination: divide a column, subtract its row, substitute back. */
static void test_equations_are_eliminated_one_by_one(void) {
    int last = 0; /* of three: four determinants with shared parts */
    for (int n = 1; n <= 6; n++) {
        const int now = price_of_system(n);
        const int more = (n - 1) + 2 * (n - 1) * (n - 1) + 2 * (n - 1) + 2 * (n - 1) + 1;
        const int most = n == 1 ? 1 : n == 2 ? 12 : n == 3 ? 43 : last + more;
        TEST_ASSERT_TRUE_MESSAGE(now <= most, "elimination");
        last = now;
    }
}

/* In two equations a numeric coefficient at any place is the pivot; no determinant is needed. */
static void test_a_number_is_the_pivot(void) {
    for (int at = 0; at < 4; at++) {
        char text[600] = "mechanism m\n";
#define PUT(...) snprintf(text + strlen(text), sizeof text - strlen(text), __VA_ARGS__)
        for (int i = 0; i < 8; i++) {
            PUT("state s%d\n", i);
        }
        for (int i = 0; i < 2; i++) {
            PUT("equation 1 [s]*(");
            for (int j = 0; j < 2; j++) {
                PUT(2 * i + j == at ? "%s3*s%d'" : "%ss%d*s%d'", j > 0 ? " + " : "",
                    2 * i + j == at ? j : 2 + 2 * i + j, j);
            }
            PUT(") = s%d\n", 6 + i);
        }
        for (int i = 2; i < 8; i++) {
            PUT("equation 1 [s]*s%d' = 0\n", i);
        }
#undef PUT
        derived d = derived_text(text);
        derived_expect(&d, text);
        /* forward: a quotient, twice a product and a difference, a quotient; back: a product, a difference, a quotient */
        printf("  pivot %d: %d\n", at, op_list_operations(d.image->list[IMAGE_STEP]));
        TEST_ASSERT_TRUE_MESSAGE(op_list_operations(d.image->list[IMAGE_STEP]) <= 9, text);
        derived_free(&d);
    }
}

/* The cost does not depend on the decimals of parameters. Values equal up to round-off are one number; a value within
 * round-off of a simple fraction is that fraction. */
static void test_decimals_cost_nothing(void) {
    uint64_t seed = 23;
    int least = 1000;
    int most = 0;
    for (int round = 0; round < 40; round++) {
        char text[600];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\n"
                 "parameter m = %.17g [kg]\nparameter r = %.17g [m]\nparameter k = %.17g [N/m]\n"
                 "T = m*r^2*(3*a'^2/2 + b'^2 + a'*b'*cos(a - b)/3) + m*x'^2/6 - m*r*x'*a'*sin(a)\n"
                 "V = m*9.81 [m/s^2]*r*(2*cos(a) + cos(b)/3) + k*r^2*(a - b)^2/2 + k*x^2/3\n",
                 random_between(&seed, 0.1, 9.0), random_between(&seed, 0.1, 9.0),
                 random_between(&seed, 1.0, 99.0));
        derived d = derived_text(text);
        derived_expect(&d, text);
        const int operations = op_list_operations(d.image->list[IMAGE_STEP]);
        least = operations < least ? operations : least;
        most = operations > most ? operations : most;
        derived_free(&d);
    }
    printf("  any parameters: %d to %d operations\n", least, most);
    TEST_ASSERT_EQUAL_INT(least, most);
}

void suite_price(void) {
    RUN_TEST(test_polynomials_take_two_operations_a_power);
    RUN_TEST(test_powers_take_few_products);
    RUN_TEST(test_equal_coefficients_are_taken_out);
    RUN_TEST(test_factors_are_taken_out_again);
    RUN_TEST(test_what_is_the_same_is_computed_once);
    RUN_TEST(test_sines_of_multiples_follow_from_one);
    RUN_TEST(test_powers_of_sines_are_put_back);
    RUN_TEST(test_equations_are_eliminated_one_by_one);
    RUN_TEST(test_a_number_is_the_pivot);
    RUN_TEST(test_decimals_cost_nothing);
}

/* === price chosen ============================================================================= */
/* Printed choices (host/study/choice.h) of made-up prices, parsed. */

static const char *const places[] = {
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 16 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 50};
static const table_words words = {"f.whirl:s", " --set m=3", false, 1e7};
enum { RECORDS = 20 };

static cost_figure figure_of(dice *d, cost_basis basis) {
    const double value = pow(10.0, dice_between(d, 1.0, 5.0));
    const double bound = 1.0 + dice_between(d, 0.05, 2.0);
    return (cost_figure){.basis = basis,
                         .value = basis == COST_RANGE || basis == COST_NOT_KNOWN ? 0.0 : value,
                         .least = basis == COST_NOT_KNOWN ? 0.0 : value / bound,
                         .most = basis == COST_NOT_KNOWN ? 0.0 : value * bound};
}

static table_row drawn_row(dice *d, cost_basis cycles) {
    table_row r = {.setting = setting_at((int)dice_one_of(d, (unsigned)setting_count())),
                   .pace = {1 + dice_one_of(d, 20), 1}};
    r.result = (trial_result){.ran = true,
                              .usable = true,
                              .error = pow(10.0, dice_between(d, -6.0, -2.0)),
                              .bound = dice_one_of(d, 2) == 1,
                              .point = (int)dice_one_of(d, 2),
                              .column = 1 + (int)dice_one_of(d, 2)};
    r.cost =
        (cost){.instructions = figure_of(d, COST_PREDICTED),
               .instructions_worst = figure_of(d, COST_PREDICTED),
               .cycles = figure_of(d, cycles),
               .cycles_worst = figure_of(d, cycles),
               .flash_bytes = figure_of(d, dice_one_of(d, 2) ? COST_PREDICTED : COST_MEASURED),
               .ram_bytes = figure_of(d, COST_MEASURED),
               .stack_bytes = figure_of(d, dice_one_of(d, 2) ? COST_PREDICTED : COST_NOT_KNOWN),
               .state_bytes = figure_of(d, COST_EXACT),
               .why = ""};
    if (dice_one_of(d, 2) == 1) {
        r.run = (counted_run){100 + dice_one_of(d, 900), 1000 * dice_one_of(d, 2),
                              2000 * dice_one_of(d, 2)};
    }
    return r;
}

static choice_row drawn_answer(dice *d, int row, bool no_cycles) {
    choice_row r = {.row = row};
    r.worst = pow(10.0, dice_between(d, 4.0, 6.0));
    r.load = dice_between(d, 0.01, 0.5);
    r.load_most = r.load * 1.5;
    r.unknown[CHOICE_LOAD] = no_cycles;
    r.unknown[CHOICE_FLASH] = dice_one_of(d, 2) == 1;
    return r;
}

static const char *behind(const char *text, const char *what) {
    const char *at = strstr(text, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, what), what);
    return at + strlen(what);
}

static bool has(const char *text, const char *what) { return strstr(text, what) != NULL; }

static const char *expect_near(const char *at, double want, double part) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE_MESSAGE(fabs(number - want) <= part * fabs(want), at);
    return at;
}

/* "--method rk4 --step 0.01\n" */
static void expect_options(const char *at, const trials *t, const table_row *r) {
    char options[SETTING_TEXT];
    char step[TRIAL_TIME];
    char *want = alloc_words("%s --step %s\n", setting_options(&r->setting, true, options) + 1,
                             trial_time(trial_step(t, r->pace), step));
    TEST_ASSERT_EQUAL_STRING_LEN(want, at, strlen(want));
    free(want);
}

static void expect_amount(const char *at, const trials *t, double error, const char *rest) {
    char unit[40];
    at = expect_near(at, error, 5.1e-3);
    snprintf(unit, sizeof unit, " %s%s", t->what.column < 0 ? "of the largest value" : "mm", rest);
    TEST_ASSERT_EQUAL_STRING_LEN(unit, at, strlen(unit));
}

/* " flash 1234 bytes, predicted: ...". */
static void expect_figure(const char *text, const char *name, const cost_figure *f,
                          const char *unit) {
    char begin[32];
    char of[FIGURE_WORDS];
    double number;
    snprintf(begin, sizeof begin, "\n  %-12s", name);
    const char *at = behind(text, begin);
    if (f->basis == COST_NOT_KNOWN) {
        TEST_ASSERT_EQUAL_STRING_LEN("not known\n", at, 10);
        return;
    }
    if (f->basis == COST_RANGE) {
        at = expect_near(at, f->least, 5.1e-3);
        at = expect_near(said_words(at, "to"), f->most, 5.1e-3);
        at = said_words(said_words(at, unit), ",");
    } else {
        at = said_number(at, &number);
        TEST_ASSERT_TRUE(fabs(number - f->value) <= 0.5);
        at = said_words(said_words(at, unit), ",");
    }
    (void)said_words(said_words(at, figure_words(f, of)), "\n");
}

static void expect_load(const char *text, const choice_wish *w, const table_row *row,
                        const choice_row *r, bool range) {
    const char *at = behind(text, "\n  load        ");
    if (!(w->clock_Hz > 0.0)) {
        (void)said_words(at, "not asked: give --clock\n");
        return;
    }
    if (r->unknown[CHOICE_LOAD]) {
        (void)said_words(at, "not known: the cycles of the longest step are not\n");
        return;
    }
    const cost_figure *f = &row->cost.cycles_worst;
    if (range) {
        at = expect_near(at, 100.0 * r->load_most / f->most * f->least, 0.051);
        at = said_words(expect_near(said_words(at, "to"), 100.0 * r->load_most, 0.051), "%");
    } else {
        at = said_words(expect_near(at, 100.0 * r->load, 5.1e-3), "%, at most");
        at = said_words(expect_near(at, 100.0 * r->load_most, 5.1e-3), "%,");
    }
    if (w->table.rate_Hz > 0.0) {
        at = expect_near(said_words(at, "of a period of"), 1.0 / w->table.rate_Hz, 1e-5);
        at = said_words(expect_near(said_words(at, "s ("), w->table.rate_Hz, 1e-5), "Hz)");
    } else {
        at = said_words(at, "of real time");
    }
    at = expect_near(said_words(at, "at"), w->clock_Hz / 1e6, 1e-5);
    at = said_words(at, "MHz, by the longest");
    if (row->run.steps > 0.0) {
        at = said_words(expect_near(said_words(at, "of"), row->run.steps, 0.0), "counted steps");
    } else {
        at = said_words(at, "step");
    }
    const double declared = range ? row->run.instructions_bound : row->run.cycles_bound;
    if (declared > 0.0) {
        const double most = range ? row->cost.instructions_worst.most : f->most;
        at = expect_near(said_words(at, ";"), 100.0 * r->load_most * declared / most, 5.1e-3);
        at = said_words(at, "% by the declared one");
    }
    TEST_ASSERT_EQUAL_CHAR('\n', *at);
}

static void expect_run(const char *text, const table_row *r, bool range) {
    TEST_ASSERT_EQUAL_INT(r->run.steps > 0.0, has(text, "\n  of          "));
    TEST_ASSERT_EQUAL_INT(r->run.steps > 0.0, has(text, "\n  declared    "));
    if (r->run.steps > 0.0) {
        const double declared = range ? r->run.instructions_bound : r->run.cycles_bound;
        const char *at = expect_near(behind(text, "\n  of          "), r->run.steps, 0.0);
        (void)said_words(at, "counted steps: every one to the horizon");
        at = behind(text, "\n  declared    ");
        if (declared > 0.0) {
            at = expect_near(at, declared, 0.0);
            (void)said_words(at, range ? "instructions are" : "cycles are");
        } else {
            (void)said_words(at, "not known");
        }
    }
}

static void begin(priced *p, const char *of) {
    priced_open(p, places, 2);
    TEST_ASSERT_TRUE(priced_begin(p, "mps2-an386", spacing, RECORDS, of));
}

static void expect_answer(const char *text, const trials *t, const choice_wish *w,
                          const table_row *row, const choice_row *by) {
    const cost *c = &row->cost;
    const bool cycles = c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
    const char *unit = cycles ? "cycles" : "instructions";
    char name[TRIAL_NAME];
    char want[80];
    expect_options(text, t, row);
    const char *at = behind(text, "\n  error       ");
    at = row->result.bound ? said_words(at, "at most ") : at;
    expect_amount(at, t, row->result.error, ", measured");
    if (t->what.column < 0) {
        snprintf(want, sizeof want, ", measured (%s)", trial_column(t, row->result.column, name));
        (void)behind(text, want);
    }
    snprintf(want, sizeof want, ", worst of %d sampled places with --set place=%d; ", t->points,
             row->result.point);
    expect_amount(behind(text, want), t, w->table.error, " is allowed\n");
    TEST_ASSERT_EQUAL_INT(w->table.rate_Hz > 0.0, has(text, "\n  a period    "));
    expect_figure(text, "a step", cycles ? &c->cycles : &c->instructions, unit);
    expect_figure(text, "the longest", cycles ? &c->cycles_worst : &c->instructions_worst, unit);
    expect_run(text, row, !cycles);
    TEST_ASSERT_EQUAL_INT(!cycles, has(text, "\n  in cycles   "));
    expect_load(text, w, row, by, c->cycles.basis == COST_RANGE);
    expect_figure(text, "flash", &c->flash_bytes, "bytes");
    expect_figure(text, "RAM", &c->ram_bytes, "bytes without the stack");
    expect_figure(text, "stack", &c->stack_bytes, "bytes");
    if (c->state_bytes.basis == COST_NOT_KNOWN) {
        TEST_ASSERT_FALSE(has(text, "\n  state "));
    } else {
        expect_figure(text, "state", &c->state_bytes, "bytes of these");
    }
    TEST_ASSERT_EQUAL_INT(by->unknown[CHOICE_FLASH], has(text, "\n  flash is limited, and not"));
    const setting *s = &row->setting;
    char *const lines[] = {table_run_line(t, s, row->pace, row->result.point, &words),
                           table_derive_line(t, s, row->pace, &words),
                           table_measure_line(t, s, row->pace, row->result.point, &words)};
    static const char *const heads[] = {"\n  again       ", "\n  as code     ", "\n  counted by  "};
    for (int i = 0; i < 3; i++) {
        at = behind(text, heads[i]);
        TEST_ASSERT_EQUAL_STRING_LEN(lines[i], at, strlen(lines[i]));
        TEST_ASSERT_EQUAL_CHAR('\n', at[strlen(lines[i])]);
        free(lines[i]);
    }
}

static void test_both_answers_are_told(void) {
    dice d = dice_of("price_chosen", 41);
    static const cost_basis bases[] = {COST_ESTIMATED, COST_RANGE, COST_PREDICTED};
    for (int n = 0; n < 24; n++) {
        priced p;
        begin(&p, n % 2 ? "x" : NULL);
        const cost_basis basis = bases[n % 3];
        table_row row[2] = {drawn_row(&d, basis), drawn_row(&d, basis)};
        table made = {.row = row, .count = 2, .settings = 50, .why = "a reason"};
        made.broken_off = n % 4 == 0 ? 3 : 0;
        made.unpriced = n % 5 == 0 ? 2 : 0;
        const choice_wish w = {.table = {.error = 0.01,
                                         .rate_Hz = n % 4 == 1 ? 40.0 : 0.0,
                                         .periods = 1,
                                         .operations = 1e7},
                               .clock_Hz = n % 4 < 2 ? 16e6 : 0.0,
                               .prices = "as they are"};
        const bool same = n % 6 == 5;
        const bool none = n % 6 == 4;
        const choice c = {.fastest = drawn_answer(&d, 0, n % 8 == 0),
                          .smallest = drawn_answer(&d,
                                                   same   ? 0
                                                   : none ? -1
                                                          : 1,
                                                   false)};
        caught out;
        choice_print(catch_text(&out), &p.trial, &made, &w, &c, &words);
        alloc_text_end(out.to);
        (void)behind(out.text, "\n  prices      as they are\n");
        char *second = strstr(out.text, "\nleast flash    ");
        TEST_ASSERT_NOT_NULL(second);
        *second++ = '\0';
        expect_answer(behind(out.text, "\nfewest cycles  "), &p.trial, &w, &row[0], &c.fastest);
        second += strlen("least flash    ");
        if (same || none) {
            TEST_ASSERT_TRUE(strncmp(second, same ? "the same\n" : "not known\n", 9) == 0);
        } else {
            expect_answer(second, &p.trial, &w, &row[1], &c.smallest);
        }
        (void)behind(second, "\n\n50 settings");
        TEST_ASSERT_EQUAL_INT(made.broken_off > 0,
                              has(second, "; finer steps of 3 take more than"));
        TEST_ASSERT_EQUAL_INT(made.unpriced > 0, has(second, "; 2 without a price here: a reason"));
        free(out.text);
        priced_close(&p);
    }
}

/* --- nothing fits ----------------------------------------------------------------------------------------*/

/* Rounded up to two digits. */
static const char *expect_no_less(const char *at, double want) {
    double number;
    at = said_number(at, &number);
    TEST_ASSERT_TRUE_MESSAGE(number >= want * (1 - 1e-9) && number <= 1.1 * want, at);
    return at;
}

static void test_what_would_fit_is_told(void) {
    dice d = dice_of("price_chosen none", 42);
    for (int n = 0; n < 32; n++) {
        priced p;
        begin(&p, n % 2 ? "x" : NULL);
        table_row row[3];
        for (int i = 0; i < 3; i++) {
            row[i] = drawn_row(&d, COST_ESTIMATED);
        }
        table made = {.row = row, .count = 3, .settings = 50, .why = ""};
        made.broken_off = n % 4 == 0 ? 3 : 0;
        const choice_wish w = {
            .table = {.error = 1e-3, .operations = 1e7}, .clock_Hz = 16e6, .prices = "as they are"};
        const choice_row none = {.row = -1};
        choice c = {none, none, none, none, none, none};
        c.weaker = n & 1 ? none : drawn_answer(&d, 0, false);
        c.dearer = n & 2 ? none : drawn_answer(&d, 1, false);
        c.larger = n & 4 ? none : drawn_answer(&d, 2, false);
        c.any = n & 8 ? none : drawn_answer(&d, 2, false);
        c.dearer.fails[CHOICE_LOAD] = c.any.fails[CHOICE_LOAD] = true;
        c.larger.fails[CHOICE_RAM] = true;
        c.dearer.load_most = c.any.load_most = 3.7;
        caught out;
        choice_print(catch_text(&out), &p.trial, &made, &w, &c, &words);
        alloc_text_end(out.to);
        TEST_ASSERT_EQUAL_INT(made.broken_off == 0,
                              has(out.text, "\nnothing fits: all 50 settings were tried\n"));
        TEST_ASSERT_EQUAL_INT(made.broken_off > 0,
                              has(out.text, "\nnothing fits of the steps that were tried: raise "
                                            "--effort\n"));
        const char *at = behind(out.text, "\nwhat would fit\n");
        if (c.weaker.row >= 0) {
            at = expect_no_less(said_words(at, "an error of"), 2.0 * row[0].result.error);
            expect_options(strstr(at, ": ") + 2, &p.trial, &row[0]);
            at = strchr(at, '\n') + 1;
        }
        if (c.dearer.row >= 0) {
            at = expect_no_less(said_words(at, "a clock of"), 16.0 * 3.7);
            expect_options(said_words(at, "MHz:") + 1, &p.trial, &row[1]);
            at = strchr(at, '\n') + 1;
        }
        const bool all = c.dearer.row < 0 && c.larger.row < 0 && c.any.row >= 0;
        if (all) {
            at = said_words(expect_no_less(said_words(at, "a clock of"), 16.0 * 3.7), "MHz:");
        }
        if (c.larger.row >= 0 || all) {
            double number;
            const cost *larger = &row[2].cost;
            at = said_number(at, &number);
            TEST_ASSERT_TRUE(number >= larger->flash_bytes.most &&
                             number < larger->flash_bytes.most + 1);
            at = said_number(said_words(at, "bytes of flash and"), &number);
            TEST_ASSERT_TRUE(number >= larger->ram_bytes.most + larger->stack_bytes.most);
            expect_options(said_words(at, "of RAM with the stack:") + 1, &p.trial, &row[2]);
            at = strchr(at, '\n') + 1;
        }
        TEST_ASSERT_EQUAL_INT(c.weaker.row < 0 && c.any.row < 0 && !all,
                              has(out.text, "  nothing that was tried\n"));
        free(out.text);
        priced_close(&p);
    }
}

static void test_why_none_has_a_price_is_told(void) {
    priced p;
    priced_open(&p, priced_ball, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    table made = {.settings = 9, .unpriced = 9, .why = "a reason"};
    const choice_row none = {.row = -1};
    const choice c = {none, none, none, none, none, none};
    const choice_wish w = {.table = {.error = 1e-3}, .prices = "as they are"};
    caught out;
    choice_print(catch_text(&out), &p.trial, &made, &w, &c, &words);
    alloc_text_end(out.to);
    (void)behind(out.text, "\nnothing fits of the steps that were tried\n");
    (void)behind(out.text, "\n9 settings; 9 without a price here: a reason\n");
    TEST_ASSERT_FALSE(has(out.text, "what would fit"));
    free(out.text);
    priced_close(&p);
}

void suite_price_chosen(void) {
    RUN_TEST(test_both_answers_are_told);
    RUN_TEST(test_what_would_fit_is_told);
    RUN_TEST(test_why_none_has_a_price_is_told);
}

/* === price control ============================================================================ */
/* Steps of the extrapolation (host/study/reference_run.h) for one equation. The reference uses Lagrange weights
 * instead of a tableau. Tries and end must agree. */

/* y' = linear y + square y^2 */
typedef struct equation_of {
    long double linear, square;
} equation_of;

static long double slope(equation_of e, long double y) { return (e.linear + e.square * y) * y; }

/* The modified midpoint rule: two leapfrogging sequences, by parity. */
static long double rule(equation_of e, long double y, long double span, int substeps) {
    const long double h = span / (long double)substeps;
    long double at[2] = {0.0L, h * slope(e, y)};
    for (int k = 1; k < substeps; k++) {
        at[(k + 1) % 2] += 2.0L * h * slope(e, y + at[k % 2]);
    }
    return at[substeps % 2];
}

/* The interpolating polynomial in the squared step through rules first to last, at zero. */
static long double extrapolated(const long double *rules, int first, int last) {
    long double sum = 0.0L;
    for (int j = first; j <= last; j++) {
        long double weight = 1.0L;
        for (int i = first; i <= last; i++) {
            weight *= i == j ? 1.0L : (long double)(j * j) / (long double)(j * j - i * i);
        }
        sum += weight * rules[j];
    }
    return sum;
}

typedef struct motion_of {
    equation_of e;
    int columns;
    double tolerance;
    long double y, largest, step;
    int tries;
    extrapolation_status status;
    evaluator *rough; /* round-off of the list's slope, in units */
} motion_of;

static long double rounded_within(const motion_of *m, long double span) {
    const double y = (double)m->y;
    double result;
    double units;
    evaluator_run(m->rough, 0.0, NULL, &y, NULL, NULL, &result);
    evaluator_rounding(m->rough, NULL, 0.0, &units);
    return isfinite(units) ? span * (long double)units : 0.0L;
}

static void try_once(motion_of *m, long double span, long double *move, double *error) {
    long double rules[EXTRAPOLATION_COLUMNS + 1] = {0.0L};
    for (int j = 1; j <= m->columns; j++) {
        rules[j] = rule(m->e, m->y, span, 2 * j);
    }
    *move = extrapolated(rules, 1, m->columns);
    const long double off = fabsl(*move - extrapolated(rules, 2, m->columns));
    const long double allowed =
        fmaxl(fmaxl(fabsl(m->y + *move), m->largest), rounded_within(m, span));
    *error = isfinite(off) ? (double)(off / allowed) / m->tolerance : (double)INFINITY;
    m->tries++;
}

/* Advances by a span. Steps grow by at most 3, shrink by at most 5, aim at 0.9 of the tolerance, and leave no
 * remainder shorter than half a step. */
static void go(motion_of *m, long double span) {
    long double left = span;
    m->step = m->step > 0.0L ? m->step : span;
    m->status = EXTRAPOLATION_OK;
    while (left > 0.0L && m->status == EXTRAPOLATION_OK) {
        const bool last = m->step >= left;
        const bool halves = !last && m->step >= left / 2.0L;
        const long double taken = last ? left : halves ? left / 2.0L : m->step;
        long double move;
        double error;
        try_once(m, taken, &move, &error);
        const double power = -1.0 / (2.0 * m->columns - 1.0);
        const double factor = error > 0.0 ? fmin(3.0, fmax(0.2, 0.9 * pow(error, power))) : 3.0;
        const long double next = taken * (long double)factor;
        if (error <= 1.0) {
            m->y += move;
            m->largest = fmaxl(m->largest, fabsl(m->y));
            left = last ? 0.0L : left - taken;
            m->step = last ? fmaxl(m->step, next) : next;
        } else {
            m->step = fminl(next, 0.7L * taken);
        }
        m->status = m->step > 1e-9L * span ? EXTRAPOLATION_OK : EXTRAPOLATION_SMALL;
    }
}

static void test_steps_are_those_of_one_equation_by_hand(void) {
    dice d = dice_of("price_control", 441);
    int failed = 0;
    int tries = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(150, 5000)); n++) {
        char text[300];
        const double linear = dice_between(&d, -6.0, 3.0);
        const double square = n % 3 == 0 ? dice_between(&d, 0.1, 2.0) : 0.0; /* a pole, somewhere */
        const double start = dice_between(&d, 0.2, 2.0);
        snprintf(text, sizeof text,
                 "mechanism m\nstate y\nequation y' = %.17g [1/s]*y%s%.17g [1/s]*y^2\n"
                 "scene s { start y = %.17g; step 1 [ms]; until 1 [s] }\n",
                 linear, square > 0.0 ? " + " : " + 0*", square > 0.0 ? square : 1.0, start);
        derived of = derived_scene(text, "s");
        derived_expect(&of, text);
        motion_of m = {.e = {(long double)linear, (long double)square},
                       .columns = 2 + (int)dice_one_of(&d, 5),
                       .tolerance = pow(10.0, dice_between(&d, -10.0, -3.0)),
                       .y = (long double)start,
                       .largest = (long double)start,
                       .rough = evaluator_new(of.image->list[IMAGE_STEP])};
        const long before = blocks_in_use();
        extrapolation *e =
            extrapolation_new(of.image, (extrapolation_setting){m.columns, m.tolerance}, 1e9);
        const double each = of.image->list[IMAGE_STEP]->count * (1.0 + m.columns * m.columns);
        for (int i = 0; i < 4 && m.status == EXTRAPOLATION_OK; i++) {
            const long double span = (long double)dice_between(&d, 0.01, 2.0);
            go(&m, span);
            TEST_ASSERT_EQUAL_INT_MESSAGE(m.status, extrapolation_go(e, span), text);
            const long double off = fabsl(extrapolation_state(e)[0] - m.y);
            TEST_ASSERT_TRUE_MESSAGE(off <= 1e-9L * m.largest || m.status != EXTRAPOLATION_OK,
                                     text);
            /* a rule stopped by a NaN evaluates less */
            TEST_ASSERT_TRUE_MESSAGE(extrapolation_operations(e) <= each * m.tries * 1.0000001,
                                     text);
            TEST_ASSERT_TRUE_MESSAGE(
                square > 0.0 || fabs(extrapolation_operations(e) / each - m.tries) < 1e-6, text);
        }
        failed += m.status != EXTRAPOLATION_OK;
        tries += m.tries;
        extrapolation_free(e);
        TEST_ASSERT_EQUAL_INT_MESSAGE(before, blocks_in_use(), text);
        evaluator_free(m.rough);
        derived_free(&of);
    }
    printf("  %d tries, %d ended at a pole\n", tries, failed);
    TEST_ASSERT_TRUE(failed > 5 && tries > 2000);
}

void suite_price_control(void) { RUN_TEST(test_steps_are_those_of_one_equation_by_hand); }

/* === price dearest ============================================================================ */
/* Cost of a setting in trials (host/study/trial.h): the maximum over all places, finer steps where a coarse one
 * fails, and settings without an image. */

/* Three motions of different cost; only the last is linear. */
static const char *const springs[] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2 + 2 [N/m^3]*x^4/4\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\nF = 1 [N*s/m]*x'^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n"};
static const whole_ratio spacing_price_dearest = {1, 500};
enum { PRICE_DEAREST_RECORDS = 100 };

static cost cost_at(priced *p, int point, const setting *s, const char *step) {
    image *im = priced_image(p, point, s, step);
    TEST_ASSERT_NOT_NULL(im);
    diags *errors = diags_new();
    fixed_plan *plan = s->number == &engine_fixed ? fixed_plan_make(im, false, errors) : NULL;
    im->fixed = plan;
    const cost c = cost_of(im, p->wish.board, setting_cost_number(s));
    fixed_plan_free(plan);
    diags_free(errors);
    image_free(im);
    return c;
}

static void expect_same(const cost *want, const cost *have, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(have->instructions_worst.most == want->instructions_worst.most, what);
    TEST_ASSERT_TRUE_MESSAGE(have->cycles.value == want->cycles.value, what);
    TEST_ASSERT_TRUE_MESSAGE(have->flash_bytes.value == want->flash_bytes.value, what);
    TEST_ASSERT_TRUE_MESSAGE(have->state_bytes.value == want->state_bytes.value, what);
}

static void test_the_dearest_of_all_places(void) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385"};
    for (int turn = 0; turn < 3; turn++) {
        const char *texts[3] = {springs[turn], springs[(turn + 1) % 3], springs[(turn + 2) % 3]};
        priced p;
        priced_open(&p, texts, 3);
        TEST_ASSERT_TRUE(
            priced_begin(&p, boards[turn % 2], spacing_price_dearest, PRICE_DEAREST_RECORDS, NULL));
        const setting s[] = {priced_setting(WH_RK4, &engine_float),
                             priced_setting(WH_HEUN, &engine_double),
                             priced_setting(WH_RK4, &engine_fixed)};
        int known = 0;
        for (int i = 0; i < 3; i++) {
            cost dearest = {0};
            for (int k = 0; k < 3; k++) {
                const cost c = cost_at(&p, k, &s[i], "0.0004");
                if (k == 0 || c.instructions_worst.most > dearest.instructions_worst.most) {
                    dearest = c;
                }
            }
            bool own = false;
            const cost c = trial_cost(&p.trial, &s[i], (deviation_pace){5, 1}, &own);
            TEST_ASSERT_TRUE_MESSAGE(own, c.why);
            expect_same(&dearest, &c, wh_methods[s[i].image.method].word);
            known += c.instructions_worst.most > 0.0;
        }
        TEST_ASSERT_TRUE(known >= 2);
        /* without sines, table lookup is no separate setting */
        setting lookup = s[0];
        lookup.image.angles = ANGLES_LOOKUP;
        bool own = true;
        const cost none = trial_cost(&p.trial, &lookup, (deviation_pace){5, 1}, &own);
        TEST_ASSERT_TRUE(!own && none.instructions.basis == COST_NOT_KNOWN);
        /* nor leapfrog with a damper */
        const setting leapfrog = priced_setting(WH_LEAPFROG, &engine_float);
        (void)trial_cost(&p.trial, &leapfrog, (deviation_pace){5, 1}, &own);
        TEST_ASSERT_FALSE(own);
        priced_close(&p);
    }
}

/* --- finer steps -----------------------------------------------------------------------------------------*/

static double longest_s;
static bool none_longer(const setting *s, double step_s) {
    (void)s;
    return step_s <= longest_s;
}

/* Fixed point asks three times for a step a tenth as long. */
static void test_finer_steps_are_asked_for(void) {
    static const struct {
        deviation_pace from;
        double longest_s;
        deviation_pace at;
        int asked;
        bool own;
    } rows[] = {{{1, 50}, 2.0, {1, 50}, 1, true},      {{1, 50}, 0.011, {1, 5}, 2, true},
                {{1, 50}, 0.0011, {10, 5}, 3, true},   {{1, 50}, 0.00011, {100, 5}, 4, true},
                {{1, 50}, 0.000011, {1, 1}, 4, false}, {{2, 1}, 0.00015, {20, 1}, 2, true},
                {{1, 20}, 0.005, {1, 2}, 2, true}};
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        priced p;
        priced_open(&p, springs, 1);
        TEST_ASSERT_TRUE(
            priced_begin(&p, "mps2-an386", spacing_price_dearest, PRICE_DEAREST_RECORDS, NULL));
        longest_s = rows[i].longest_s;
        p.takes = none_longer;
        bool own;
        int asked = p.asked;
        const cost c = trial_any_cost(&p.trial, &in_fixed, rows[i].from, &own);
        TEST_ASSERT_EQUAL_INT(rows[i].asked, p.asked - asked);
        TEST_ASSERT_EQUAL_INT(rows[i].own, own);
        if (own) {
            /* cached for this step, asked again for another */
            asked = p.asked;
            const trial_result r = trial_run(&p.trial, &in_fixed, rows[i].at);
            TEST_ASSERT_TRUE(r.ran);
            TEST_ASSERT_EQUAL_INT(asked, p.asked);
            const cost same = trial_cost(&p.trial, &in_fixed, rows[i].at, &own);
            TEST_ASSERT_EQUAL_INT(asked + 1, p.asked);
            expect_same(&same, &c, "by the step that it takes");
            (void)trial_run(&p.trial, &in_fixed,
                            (deviation_pace){rows[i].at.steps * 2, rows[i].at.records});
            TEST_ASSERT_EQUAL_INT(asked + 2, p.asked);
        }
        /* no other setting asks */
        const setting rk4 = priced_setting(WH_RK4, &engine_float);
        longest_s = 1e-9;
        asked = p.asked;
        const cost none = trial_any_cost(&p.trial, &rk4, rows[i].from, &own);
        TEST_ASSERT_EQUAL_INT(1, p.asked - asked);
        TEST_ASSERT_TRUE(own && none.instructions.basis == COST_NOT_KNOWN);
        TEST_ASSERT_EQUAL_STRING("there is no image of it", none.why);
        priced_close(&p);
    }
}

/* Finding ranges needs a run, so it is skipped if the finer step's takes too long. */
static void test_no_finer_step_than_may_be_planned(void) {
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    priced p;
    priced_open(&p, springs, 1);
    TEST_ASSERT_TRUE(
        priced_begin(&p, "mps2-an386", spacing_price_dearest, PRICE_DEAREST_RECORDS, NULL));
    longest_s = 1e-9;
    p.takes = none_longer;
    p.trial.planned_most = trial_operations(&p.trial, &in_fixed, (deviation_pace){10, 5});
    const int asked = p.asked;
    bool own;
    (void)trial_any_cost(&p.trial, &in_fixed, (deviation_pace){1, 50}, &own);
    TEST_ASSERT_FALSE(own);
    TEST_ASSERT_EQUAL_INT(4, p.asked - asked); /* the next is asked before its cost is known */
    priced_close(&p);
}

/* A matrix whose step is too long has the price at the scene's step. Without a matrix the setting is not the scene's
 * own. */
static bool no_long_matrix(const setting *s, double step_s) {
    return s->image.matrix == MATRIX_NONE || step_s < longest_s;
}

static void test_matrices_are_priced_by_a_step_that_they_take(void) {
    priced p;
    priced_open(&p, springs, 1);
    TEST_ASSERT_TRUE(
        priced_begin(&p, "mps2-an386", spacing_price_dearest, PRICE_DEAREST_RECORDS, NULL));
    p.takes = no_long_matrix;
    setting matrix = priced_setting(WH_RK4, &engine_float);
    matrix.image.matrix = MATRIX_EXACT;
    longest_s = 0.001;
    bool own = false;
    int asked = p.asked;
    const cost c = trial_cost(&p.trial, &matrix, (deviation_pace){1, 1}, &own);
    const cost scenes = cost_at(&p, 0, &matrix, NULL);
    TEST_ASSERT_TRUE(own);
    TEST_ASSERT_EQUAL_INT(asked + 2, p.asked);
    expect_same(&scenes, &c, "a matrix by its own step");
    TEST_ASSERT_FALSE(trial_run(&p.trial, &matrix, (deviation_pace){1, 1}).ran);
    longest_s = 0.0;
    (void)trial_cost(&p.trial, &matrix, (deviation_pace){1, 1}, &own);
    TEST_ASSERT_FALSE(own);
    priced_close(&p);
}

static void test_contacts_are_left_out_where_that_is_asked(void) {
    priced p;
    priced_open(&p, priced_ball, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing_price_dearest, 10, NULL));
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    image *im = priced_image(&p, 0, &rk4, "0.0004");
    TEST_ASSERT_TRUE(im->contacts > 0);
    bool own;
    const cost with = cost_of(im, p.wish.board, COST_FLOAT);
    im->contacts = 0;
    const cost without = cost_of(im, p.wish.board, COST_FLOAT);
    im->contacts = 1;
    cost c = trial_cost(&p.trial, &rk4, (deviation_pace){5, 1}, &own);
    expect_same(&with, &c, "with");
    TEST_ASSERT_TRUE(own && with.cycles.value != without.cycles.value);
    p.trial.without_events = true;
    c = trial_cost(&p.trial, &rk4, (deviation_pace){5, 1}, &own);
    expect_same(&without, &c, "without");
    image_free(im);
    priced_close(&p);
}

void suite_price_dearest(void) {
    RUN_TEST(test_the_dearest_of_all_places);
    RUN_TEST(test_finer_steps_are_asked_for);
    RUN_TEST(test_no_finer_step_than_may_be_planned);
    RUN_TEST(test_matrices_are_priced_by_a_step_that_they_take);
    RUN_TEST(test_contacts_are_left_out_where_that_is_asked);
}
