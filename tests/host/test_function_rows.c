/* test_function_rows.c: every row of host/number/functions.h in all its uses. These are
 * slopes (compared with differences), operations, the force from an energy, dimensions, generated texts, the words of
 * the fuzzers, and the docs. A new function is tested through its row.
 *
 *   WHIRL_RANDOM_STATES=10000 build/tests/host function_rows
 *
 * tests so many points of each function instead of two hundred. */
#include "derived.h"
#include "host/algebra/algebra.h"
#include "host/engine/engine.h"

#define SEED UINT64_C(20061122)

static int places(void) {
    const char *asked = getenv("WHIRL_RANDOM_STATES");
    return asked != NULL ? (int)strtol(asked, NULL, 10) : 200;
}

static function_id at(int f) { return (function_id)f; }
static const char *name(int f) { return function_name(at(f)); }
static bool of_two(int f) { return function_arguments(at(f)) == 2; }

static void expect_near(int f, double wanted, double got, double allowed, double x, double y) {
    char text[160];
    snprintf(text, sizeof text, "%s at (%.17g, %.17g): %.17g, not %.17g (seed %llu)", name(f), x, y,
             got, wanted, (unsigned long long)SEED);
    TEST_ASSERT_TRUE_MESSAGE(fabs(got - wanted) <= allowed, text);
}

#define WIDTH 1e-3

/* The slope, by differences of fourth order. Returns false if the function is not smooth near this point. */
static bool difference(int f, int which, double x, double y, double *slope) {
    double value[5];
    for (int k = -2; k <= 2; k++) {
        const double off = k * WIDTH;
        value[k + 2] =
            number_call(at(f), x + (which == 0 ? off : 0.0), y + (which == 1 ? off : 0.0));
    }
    const double narrow = (value[3] - value[1]) / (2.0 * WIDTH);
    const double wide = (value[4] - value[0]) / (4.0 * WIDTH);
    *slope = narrow + (narrow - wide) / 3.0;
    return fabs(narrow - wide) <= 1e-4 * (1.0 + fabs(narrow)); /* false for NaN, too */
}

static const symbol variables[2] = {
    {.kind = SYM_COORDINATE, .name = "x", .text = "", .unit = "", .index = 0},
    {.kind = SYM_COORDINATE, .name = "y", .text = "", .unit = "", .index = 1}};

static double variable_value(void *context, const symbol *sym, int primes) {
    (void)primes;
    return ((const double *)context)[sym->index];
}

TEST(function_rows, slopes) {
    uint64_t seed = SEED;
    for (int f = 0; f < FUNCTIONS; f++) {
        algebra *a = algebra_new();
        const poly *x = poly_symbol(a, &variables[0], 0);
        const poly *y = of_two(f) ? poly_symbol(a, &variables[1], 0) : NULL;
        const poly *whole = poly_call(a, at(f), x, y);
        int compared = 0;
        for (int i = 0; i < places(); i++) {
            double point[2] = {random_between(&seed, -3.0, 3.0), random_between(&seed, -3.0, 3.0)};
            for (int which = 0; which < function_arguments(at(f)); which++) {
                double wanted;
                if (!difference(f, which, point[0], point[1], &wanted)) {
                    continue;
                }
                const double allowed = 1e-6 * (1.0 + fabs(wanted));
                expect_near(f, wanted, number_slope(at(f), which, point[0], point[1]), allowed,
                            point[0], point[1]);
                /* the slope by the function's own rule, and by poly_derivative() */
                const poly *rule = function_slope(a, at(f), which, x, y);
                const poly *of_whole = poly_derivative(a, whole, &variables[which], 0);
                expect_near(f, wanted, poly_evaluate(rule, variable_value, point), allowed,
                            point[0], point[1]);
                expect_near(f, wanted, poly_evaluate(of_whole, variable_value, point), allowed,
                            point[0], point[1]);
                compared++;
            }
        }
        algebra_free(a);
        TEST_ASSERT_TRUE_MESSAGE(compared > places() / 5, name(f));
    }
}

/* At a tie, each argument has half of the slope. The absolute value has slope 0 at zero. */
TEST(function_rows, slopes_where_they_jump) {
    for (int which = 0; which < 2; which++) {
        TEST_ASSERT_TRUE(number_slope(FN_MIN, which, 2.0, 2.0) == 0.5);
        TEST_ASSERT_TRUE(number_slope(FN_MAX, which, 2.0, 2.0) == 0.5);
    }
    TEST_ASSERT_TRUE(number_slope(FN_ABS, 0, 0.0, 0.0) == 0.0);
    TEST_ASSERT_TRUE(number_slope(FN_SIGN, 0, 0.0, 0.0) == 0.0);
}

/* A function that counts as real everywhere must have a value at every point; the others must have none at some
 * points. */
TEST(function_rows, range) {
    uint64_t seed = SEED + 4;
    for (int f = 0; f < FUNCTIONS; f++) {
        int none = 0;
        for (int i = 0; i < places(); i++) {
            const double x = random_between(&seed, -3.0, 3.0);
            none += isnan(number_call(at(f), x, random_between(&seed, -3.0, 3.0)));
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(function_is_real(at(f)), none == 0, name(f));
    }
}

/* The operation list must give the bits of number_call(), except for sine and cosine, whose argument is a phase. */
TEST(function_rows, operations) {
    uint64_t seed = SEED + 1;
    for (int f = 0; f < FUNCTIONS; f++) {
        op_list *t = op_list_new(0, 1);
        const int x = op_list_leaf(t, OP_LINEAR, 0);
        const int y = of_two(f) ? op_list_leaf(t, OP_LINEAR, 1) : -1;
        t->result[0] = op_list_call(t, at(f), x, y);
        op_list_prune(t);
        const op_list_cost cost = op_list_count(t);
        TEST_ASSERT_EQUAL_INT(1, cost.arithmetic + cost.divisions + cost.roots + cost.waves +
                                     cost.calls);
        evaluator *ev = evaluator_new(t);
        for (int i = 0; i < places(); i++) {
            const double point[2] = {random_between(&seed, -2.0, 2.0),
                                     random_between(&seed, -2.0, 2.0)};
            const double wanted = number_call(at(f), point[0], point[1]);
            double got;
            evaluator_run(ev, 0.0, NULL, point, NULL, NULL, &got);
            if (isnan(wanted)) {
                TEST_ASSERT_TRUE_MESSAGE(isnan(got), name(f));
            } else {
                expect_near(f, wanted, got, cost.waves > 0 ? 4e-16 : 0.0, point[0], point[1]);
            }
        }
        evaluator_free(ev);
        /* a function of constants must be folded if the list can evaluate it */
        const int known = op_list_call(t, at(f), op_list_constant(t, 0.25), of_two(f) ? x : -1);
        double number;
        if (op_list_is_constant(t, known, &number)) {
            expect_near(f, number_call(at(f), 0.25, 0.0), number, 0.0, 0.25, 0.0);
        }
        op_list_free(t);
    }
}

static bool accepted(const char *dimensions, const char *call) {
    char text[400];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\noutput o [%s] = %s\n", dimensions,
             call);
    diags *said = diags_new();
    whirl_model *read = model_parse("x.whirl", text, strlen(text), said);
    model_free(read);
    diags_free(said);
    return read != NULL;
}

/* Is f(4 x, 4 y) = times f(x, y) at all tested points? All have positive x. */
static bool grows(int f, double times) {
    for (int i = 1; i < 20; i++) {
        const double x = 0.05 * i;
        const double y = 1.0 - 0.7 * x;
        const double more = number_call(at(f), 4.0 * x, 4.0 * y);
        if (!(fabs(more - times * number_call(at(f), x, y)) <= 1e-12 * fabs(more))) {
            return false;
        }
    }
    return true;
}

static bool has_period(int f, double period) {
    for (int i = -20; i < 20; i++) {
        const double x = 0.07 * i + 0.03;
        const double value = number_call(at(f), x, 0.0);
        if (!(fabs(number_call(at(f), x + period, 0.0) - value) <= 1e-12 * (1.0 + value * value))) {
            return false;
        }
    }
    return true;
}

/* How a function's value changes with the unit of its arguments shows which dimensions the function may allow. */
TEST(function_rows, dimensions_of_values) {
    for (int f = 0; f < FUNCTIONS; f++) {
        const function_dimensions takes = function_takes(at(f));
        const bool root = takes == TAKES_SQUARE;
        const bool same = takes == TAKES_SIZE || takes == TAKES_CHOICE;
        const bool any = takes == TAKES_ANY || takes == TAKES_RATIO;
        TEST_ASSERT_EQUAL_INT_MESSAGE(grows(f, 1.0), any, name(f));
        TEST_ASSERT_EQUAL_INT_MESSAGE(grows(f, 2.0), root, name(f));
        TEST_ASSERT_EQUAL_INT_MESSAGE(grows(f, 4.0), same, name(f));
        TEST_ASSERT_EQUAL_INT_MESSAGE(has_period(f, 6.283185307179586), takes == TAKES_ANGLE,
                                      name(f));
    }
}

/* Arguments: a length, two lengths, or a length and a time. The result must have the right dimension, or there must
 * be an error. */
TEST(function_rows, dimensions) {
    for (int f = 0; f < FUNCTIONS; f++) {
        char alike[80];
        char mixed[80];
        char plain[80];
        char area[80];
        snprintf(alike, sizeof alike, of_two(f) ? "%s(x, 2 [m])" : "%s(x)", name(f));
        snprintf(mixed, sizeof mixed, of_two(f) ? "%s(x, 2 [s])" : "%s(x, x)", name(f));
        snprintf(plain, sizeof plain, of_two(f) ? "%s(0.3, 0.4)" : "%s(0.3)", name(f));
        snprintf(area, sizeof area, of_two(f) ? "%s(x^2, 2 [m^2])" : "%s(x^2)", name(f));
        const function_dimensions takes = function_takes(at(f));
        const bool number = takes == TAKES_ANY || takes == TAKES_RATIO;
        const bool same = takes == TAKES_SIZE || takes == TAKES_CHOICE;
        TEST_ASSERT_EQUAL_INT_MESSAGE(number, accepted("1", alike), alike);
        TEST_ASSERT_EQUAL_INT_MESSAGE(same, accepted("m", alike), alike);
        TEST_ASSERT_EQUAL_INT_MESSAGE(takes == TAKES_SQUARE, accepted("m", area), area);
        TEST_ASSERT_FALSE_MESSAGE(accepted("1", mixed) || accepted("m", mixed), mixed);
        TEST_ASSERT_TRUE_MESSAGE(accepted("1", plain), plain);
        TEST_ASSERT_EQUAL_INT_MESSAGE(takes == TAKES_RATIO || takes == TAKES_CHOICE, of_two(f),
                                      name(f));
    }
}

TEST(function_rows, names) {
    for (int f = 0; f < FUNCTIONS; f++) {
        function_id found;
        TEST_ASSERT_TRUE_MESSAGE(function_find(name(f), strlen(name(f)), &found), name(f));
        TEST_ASSERT_EQUAL_INT_MESSAGE(f, (int)found, name(f));
        TEST_ASSERT_EQUAL_INT_MESSAGE('\\', function_latex(at(f))[0], name(f));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(function_latex(at(f)), name(f)), name(f));
        TEST_ASSERT_FALSE_MESSAGE(
            function_find(name(f), strlen(name(f)) - 1, &found) && (int)found == f, name(f));
    }
    /* the hashes of models contain these numbers, so they must not change */
    TEST_ASSERT_EQUAL_INT(2, FN_TAN);
    TEST_ASSERT_EQUAL_INT(9, FN_LOG);
    TEST_ASSERT_EQUAL_INT(13, FN_MAX);
    TEST_ASSERT_EQUAL_INT(16, FN_TANH);
}

static char *read_whole(const char *path) {
    FILE *in = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    char *text = calloc(1, 1 << 20);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_TRUE(fread(text, 1, (1 << 20) - 1, in) > 0);
    fclose(in);
    return text;
}

/* Fails the test if the text does not contain `before`, the name of f and `after`, one directly after the other. */
static void expect_in(const char *text, const char *before, int f, const char *after,
                      const char *where) {
    char words[80];
    char message[160];
    snprintf(words, sizeof words, "%s%s%s", before, name(f), after);
    snprintf(message, sizeof message, "%s has no %s", where, words);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, words), message);
}

TEST(function_rows, words_of_the_docs) {
    char *docs = read_whole("docs/language.md");
    char *words = read_whole("tests/fuzz/fuzz_lang.dict");
    for (char *c = docs; *c != '\0'; c++) { /* removes the page's line breaks */
        *c = *c == '\n' ? ' ' : *c;
    }
    char *list = strstr(docs, "`+ - * / ^`, parentheses, `");
    TEST_ASSERT_NOT_NULL(list);
    list = strchr(list + strlen("`+ - * / ^`"), '`');
    *list = ' ';
    char *end = strchr(list, '`');
    TEST_ASSERT_NOT_NULL(end);
    end[0] = ' ';
    end[1] = '\0';
    for (int f = 0; f < FUNCTIONS; f++) {
        expect_in(list, " ", f, " ", "docs/language.md");
        expect_in(words, "\"", f, "\"", "tests/fuzz/fuzz_lang.dict");
    }
    free(words);
    free(docs);
}
