/* test_rank.c: the rank of matrices that are made to have it, in whatever units their rows and columns are, and how much
 * of a rounding error it takes for none. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "derived.h"
#include "host/derive/rank.h"
#include "unity.h"

void suite_rank(void);

enum { MOST = 6 };

static double whole(uint64_t *seed, int most) {
    return (double)(random_bits(seed) % (uint64_t)(2 * most + 1)) - most;
}

/* The rank of a matrix of small whole numbers, exactly: Bareiss' elimination without fractions. */
static int exact_rank(const double *m, int n) {
    double a[MOST][MOST] = {{0.0}};
    for (int i = 0; i < n * n; i++) {
        a[i / n][i % n] = m[i];
    }
    double last = 1.0;
    int rank = 0;
    for (int column = 0; column < n && rank < n; column++) {
        int row = rank;
        while (row < n && a[row][column] == 0.0) {
            row++;
        }
        if (row == n) {
            continue;
        }
        for (int j = 0; j < n; j++) {
            const double swap = a[rank][j];
            a[rank][j] = a[row][j];
            a[row][j] = swap;
        }
        for (int i = rank + 1; i < n; i++) {
            for (int j = n - 1; j >= column; j--) {
                a[i][j] = (a[i][j] * a[rank][column] - a[i][column] * a[rank][j]) / last;
            }
        }
        last = a[rank][column];
        rank++;
    }
    return rank;
}

/* m = left right, n by inner by n. */
static void product(double *m, const double *left, const double *right, int n, int inner) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            m[i * n + j] = 0.0;
            for (int k = 0; k < inner; k++) {
                m[i * n + j] += left[i * MOST + k] * right[k * MOST + j];
            }
        }
    }
}

static void errors_of(const double *m, double *error, int n) {
    for (int i = 0; i < n * n; i++) {
        error[i] = 4e-16 * fabs(m[i]);
    }
}

static void test_the_rank_does_not_hang_on_units(void) {
    uint64_t seed = 17;
    int seen[MOST + 1] = {0};
    for (int round = 0; round < 3000; round++) {
        const int n = 1 + round % MOST;
        const int inner = (int)(random_bits(&seed) % (unsigned)(n + 1));
        double left[MOST * MOST];
        double right[MOST * MOST];
        double m[MOST * MOST];
        double error[MOST * MOST];
        const bool symmetric = round % 2 == 0;
        for (int i = 0; i < MOST * MOST; i++) {
            left[i] = whole(&seed, 3);
            right[i] = whole(&seed, 3);
        }
        for (int i = 0; i < MOST && symmetric; i++) {
            for (int k = 0; k < MOST; k++) {
                right[k * MOST + i] = left[i * MOST + k];
            }
        }
        product(m, left, right, n, inner);
        const int rank = exact_rank(m, n);
        seen[rank]++;
        int row[MOST];
        int column[MOST];
        for (int i = 0; i < n; i++) {
            row[i] = (int)whole(&seed, symmetric ? 60 : 30);
            column[i] = symmetric ? row[i] : (int)whole(&seed, 30);
        }
        for (int i = 0; i < n * n; i++) {
            m[i] = ldexp(m[i], row[i / n] + column[i % n]);
        }
        errors_of(m, error, n);
        TEST_ASSERT_EQUAL_INT(rank, rank_of(m, error, n, symmetric));
    }
    for (int r = 1; r <= MOST; r++) {
        TEST_ASSERT_GREATER_THAN_INT(50, seen[r]);
    }
}

/* [1 1; 1 1 + x]: what is left of the second row is x. */
static void test_a_pivot_that_is_rounding_is_none(void) {
    for (int k = 0; k < 4; k++) {
        const bool symmetric = k % 2 == 0;
        double m[4] = {1.0, 1.0, 1.0, 1.0 + (k < 2 ? 2e-14 : 1e-13)};
        double error[4];
        errors_of(m, error, 2);
        TEST_ASSERT_EQUAL_INT(k < 2 ? 1 : 2, rank_of(m, error, 2, symmetric));
    }
    for (int k = 0; k < 4; k++) { /* n times the largest error, scaled as its entry */
        const double size = k % 2 == 0 ? 1.0 : 0x1p80;
        const bool blurred = k >= 2;
        double m[4] = {2.0 * size, size, size, 2.0 * size}; /* pivots 2 and 1.5 */
        double error[4] = {0.0, blurred ? 0.8 * size : 0.7 * size, 0.0, 0.0};
        TEST_ASSERT_EQUAL_INT(blurred ? 1 : 2, rank_of(m, error, 2, false));
    }
    double none[4] = {0.0, 0.0, 0.0, 0.0};
    double error[4] = {0.0, 0.0, 0.0, 0.0};
    TEST_ASSERT_EQUAL_INT(0, rank_of(none, error, 2, true));
    TEST_ASSERT_EQUAL_INT(0, rank_of(none, error, 2, false));
}

/* B Bt + I has all eigenvalues above 0; with one row and column less by too much, one is below. */
static void test_what_is_positive_definite(void) {
    uint64_t seed = 23;
    for (int round = 0; round < 1000; round++) {
        const int n = 1 + round % MOST;
        double left[MOST * MOST];
        double right[MOST * MOST];
        double m[MOST * MOST];
        for (int i = 0; i < MOST; i++) {
            for (int k = 0; k < MOST; k++) {
                left[i * MOST + k] = whole(&seed, 3);
                right[k * MOST + i] = left[i * MOST + k];
            }
        }
        product(m, left, right, n, n);
        for (int i = 0; i < n; i++) {
            m[i * n + i] += 1.0;
        }
        double kept[MOST * MOST];
        memcpy(kept, m, sizeof kept);
        TEST_ASSERT_TRUE(rank_is_positive(m, n));
        /* along x the form becomes x.Mx - (x.Mx) - 1 < 0 */
        const int at = (int)(random_bits(&seed) % (unsigned)n);
        memcpy(m, kept, sizeof kept);
        m[at * n + at] = -1.0;
        TEST_ASSERT_FALSE(rank_is_positive(m, n));
        if (n > 1) { /* a 2 by 2 part with a negative determinant, its diagonal above 0 */
            const int other = (at + 1) % n;
            memcpy(m, kept, sizeof kept);
            const double mixed = sqrt(m[at * n + at] * m[other * n + other]) + 0.5;
            m[at * n + other] = m[other * n + at] = mixed;
            TEST_ASSERT_FALSE(rank_is_positive(m, n));
        }
    }
}

/* The first equation whose highest derivatives follow from those above it is the one that is shown; if it has none at
 * all, that is said. */
static void test_the_equation_that_depends_is_shown(void) {
    uint64_t seed = 29;
    int shown = 0;
    for (int round = 0; round < 400; round++) {
        const int n = 2 + round % (MOST - 1);
        double m[MOST * MOST] = {0};
        const int poor =
            (int)(random_bits(&seed) % (unsigned)n); /* this row is made from two above, or empty */
        for (int i = 0; i < n; i++) {
            const double first = i == poor ? whole(&seed, 2) : 0.0;
            const double second = i == poor ? whole(&seed, 2) : 0.0;
            for (int j = 0; j < n; j++) {
                m[i * n + j] = i != poor ? whole(&seed, 4)
                                         : (i > 0 ? first * m[j] : 0.0) +
                                               (i > 1 ? second * m[(i - 1) * n + j] : 0.0);
            }
        }
        char text[2048] = "mechanism m\n";
        size_t length = strlen(text);
        for (int i = 0; i < n; i++) {
            length += (size_t)snprintf(text + length, sizeof text - length, "state x%d\n", i);
        }
        for (int i = 0; i < n; i++) {
            length += (size_t)snprintf(text + length, sizeof text - length, "equation x0 = 1");
            for (int j = 0; j < n; j++) {
                if (m[i * n + j] != 0.0) {
                    length += (size_t)snprintf(text + length, sizeof text - length,
                                               " + (%g [s])*x%d'", m[i * n + j], j);
                }
            }
            length += (size_t)snprintf(text + length, sizeof text - length, "\n");
        }
        int row = 0;
        for (; row < n; row++) {
            double above[MOST * MOST] = {0};
            memcpy(above, m, sizeof(double) * (size_t)((row + 1) * n));
            if (exact_rank(above, n) <= row) {
                break;
            }
        }
        bool used = true; /* each state's rate must stand somewhere, else another thing is said */
        for (int j = 0; j < n; j++) {
            bool in_column = false;
            for (int i = 0; i < n; i++) {
                in_column = in_column || m[i * n + j] != 0.0;
            }
            used = used && in_column;
        }
        if (row == n || !used) {
            continue;
        }
        bool empty = true;
        for (int j = 0; j < n; j++) {
            empty = empty && m[row * n + j] == 0.0;
        }
        char wanted[64];
        snprintf(wanted, sizeof wanted, "t.whirl:%d:1: error: ", 2 + n + row);
        derived d = derived_text(text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, wanted), d.errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(
            strstr(d.errors, empty ? "this one contains none" : "the same combination of them"),
            text);
        derived_free(&d);
        shown++;
    }
    printf("  %d systems, seed 29\n", shown);
    TEST_ASSERT_GREATER_THAN_INT(200, shown);
}

void suite_rank(void) {
    RUN_TEST(test_the_rank_does_not_hang_on_units);
    RUN_TEST(test_a_pivot_that_is_rounding_is_none);
    RUN_TEST(test_what_is_positive_definite);
    RUN_TEST(test_the_equation_that_depends_is_shown);
}
