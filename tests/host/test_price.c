/* test_price.c: what operation lists cost, for classes of expressions whose price is known: nobody writes them shorter by
 * hand. Not a result's value (other suites), but that nothing is computed that need not be. */
#define _POSIX_C_SOURCE 200809L
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "unity.h"

void suite_price(void);

/* Operations of the only output of seven coordinates x0 ... x6 (numbers) and the angles a and b; sine pairs too. */
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

/* Horner's scheme: a product and a sum for each power. */
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

/* By squares: as many products as the exponent has digits in base two, and ones among them, less two. */
static void test_powers_take_few_products(void) {
    for (int exponent = 2; exponent <= 64; exponent++) {
        int products = -2;
        for (int rest = exponent; rest > 0; rest /= 2) {
            products += 1 + rest % 2;
        }
        char what[40];
        snprintf(what, sizeof what, "x0^%d", exponent);
        expect(price_of("%s", what), products, 0, what);
        expect(price_of("1/%s", what), products + 1, 0, what); /* and one division */
        snprintf(what, sizeof what, "x0^(%d/2)", 2 * exponent + 1);
        expect(price_of("%s", what), 2 * exponent > 62 ? 1 : 60, 0, what);
    }
}

/* One size of coefficients is multiplied once. */
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

/* As it was written: x0 (2 x1 + x2 (3 x3 + x4 (5 x5 + 7 x6))), and the same with x0 in each part once more. */
static void test_factors_are_taken_out_again(void) {
    expect(price_of("x0*(2*x1 + 3*x2)"), 4, 0, "one factor");
    expect(price_of("x0*(2*x1 + x2*(3*x3 + 5*x4))"), 7, 0, "a factor inside");
    expect(price_of("x0*(2*x1 + x2*(3*x3 + x4*(5*x5 + 7*x6)))"), 10, 0, "two factors inside");
    expect(price_of("x0^2*(2*x1 + 3*x2) + x0*5*x3 + 7"), 9, 0, "powers of a factor");
    expect(price_of("x0*x1*(2*x2 + 3*x3) + 5*x4*x5"), 8, 0, "two factors");
    expect(price_of("1 [s]*x0'*(2*x1 + 3*x2) + x3*(5*x1 + 7*x4)"), 9, 0, "rates");
    expect(price_of("x0*x1 + x0*x2 + x0*x3"), 3, 0, "no coefficients");
}

/* What stands twice is computed once; a root's odd powers share it. */
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

/* Whatever multiples of one angle there are, one pair is evaluated. */
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
    /* inside functions, too */
    expect(price_of("exp(sin(a)) + 3*exp(cos(2*a))"), 40, 1, "sines inside functions");
    expect(price_of("atan2(sin(2*a), x0 + cos(a)) + x1*sqrt(3 + sin(3*a))"), 40, 1, "sines inside");
    expect(price_of("sin(x0*sin(2*a)) + x1*cos(a)"), 40, 2, "a sine inside a sine");
    expect(price_of("sin(2*a) + 3*sin(a)"), 6, 1, "twice an angle");
    expect(price_of("3*cos(2*a)"), 5, 1, "the cosine of twice an angle");
    expect(price_of("cos(a + b) + 3*cos(a) + 5*cos(b)"), 11, 2, "a sum of angles");
    expect(price_of("3*cos(a - b) + 5*sin(a) + cos(b)"), 11, 2, "a difference of angles");
}

/* Powers of sines stay powers where their sums would lose digits, and cost less. */
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

/* n equations whose matrix and right side are states of their own, all different. */
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

/* Up to three by Cramer's rule, one more each by elimination: to divide a column, to take its row from what is left, and
 * the way back. */
static void test_equations_are_eliminated_one_by_one(void) {
    int last = 0; /* of three: four determinants that share what they can */
    for (int n = 1; n <= 6; n++) {
        const int now = price_of_system(n);
        const int more = (n - 1) + 2 * (n - 1) * (n - 1) + 2 * (n - 1) + 2 * (n - 1) + 1;
        const int most = n == 1 ? 1 : n == 2 ? 12 : n == 3 ? 43 : last + more;
        TEST_ASSERT_TRUE_MESSAGE(now <= most, "elimination");
        last = now;
    }
}

/* Two equations of which one coefficient is a number, wherever it is: it is the pivot, and a determinant is not needed. */
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
        /* a quotient, twice a product and a difference, a quotient; back: a product, a difference, a quotient */
        printf("  pivot %d: %d\n", at, op_list_operations(d.image->list[IMAGE_STEP]));
        TEST_ASSERT_TRUE_MESSAGE(op_list_operations(d.image->list[IMAGE_STEP]) <= 9, text);
        derived_free(&d);
    }
}

/* Whatever decimals the parameters have, a list takes the same operations: what is equal but for rounding is one number,
 * and what comes out a rounding error beside a simple fraction is that. */
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
