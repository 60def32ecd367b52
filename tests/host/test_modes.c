/* test_modes.c: eigenvalues of matrices made from known ones, real and in pairs, mixed by similarities and measured in other
 * units; and what each contributes to a motion: eigenvectors that add up to it, and shares that add up to one, know
 * no units, and are those of the components that a motion moves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/run/modes.h"

#include "unity.h"

void suite_modes(void);

enum { MOST = 10 };

typedef struct known {
    int n;
    double a[MOST * MOST];
    complex_number value[MOST];
    int block[MOST]; /* of each component, where nothing is mixed */
} known;

/* Distinct: kept apart by a tenth of their size. */
static bool is_new(const known *k, int count, complex_number v) {
    for (int i = 0; i < count; i++) {
        const double size = complex_size(k->value[i]) + complex_size(v);
        if (hypot(k->value[i].re - v.re, k->value[i].im - v.im) < 0.1 * size) {
            return false;
        }
    }
    return true;
}

/* Blocks along the diagonal: a number, or [re, im; -im, re]. */
static known draw_blocks(dice *d, double spread) {
    known k = {.n = 1 + (int)dice_one_of(d, MOST)};
    for (int i = 0; i < k.n;) {
        const double size = pow(10.0, dice_between(d, -spread, spread));
        const bool pair = i + 1 < k.n && dice_one_of(d, 2) == 0;
        const double angle = dice_between(d, 0.2, 2.9);
        const complex_number v = {pair                     ? size * cos(angle)
                                  : dice_one_of(d, 2) == 0 ? size
                                                           : -size,
                                  pair ? size * sin(angle) : 0.0};
        if (!is_new(&k, i, v)) {
            continue;
        }
        k.value[i] = v;
        k.block[i] = i;
        k.a[i * k.n + i] = v.re;
        if (pair) {
            k.value[i + 1] = (complex_number){v.re, -v.im};
            k.block[i + 1] = i;
            k.a[i * k.n + i + 1] = v.im;
            k.a[(i + 1) * k.n + i] = -v.im;
            k.a[(i + 1) * k.n + i + 1] = v.re;
        }
        i += pair ? 2 : 1;
    }
    return k;
}

/* Component i becomes i plus `by` times j. */
static void mix(known *k, int i, int j, double by) {
    for (int c = 0; c < k->n; c++) {
        k->a[i * k->n + c] += by * k->a[j * k->n + c];
    }
    for (int r = 0; r < k->n; r++) {
        k->a[r * k->n + j] -= by * k->a[r * k->n + i];
    }
}

static void exchange(known *k, int i, int j) {
    for (int c = 0; c < k->n; c++) {
        const double kept = k->a[i * k->n + c];
        k->a[i * k->n + c] = k->a[j * k->n + c];
        k->a[j * k->n + c] = kept;
    }
    for (int r = 0; r < k->n; r++) {
        const double kept = k->a[r * k->n + i];
        k->a[r * k->n + i] = k->a[r * k->n + j];
        k->a[r * k->n + j] = kept;
    }
}

/* Component i in a unit that is so many times smaller. */
static void measure(known *k, int i, double times) {
    for (int c = 0; c < k->n; c++) {
        k->a[i * k->n + c] *= times;
        k->a[c * k->n + i] /= times;
    }
}

static void mix_all(dice *d, known *k) {
    for (int n = 0; n < k->n && k->n > 1; n++) {
        const int i = (int)dice_one_of(d, (unsigned)k->n);
        const int j = (i + 1 + (int)dice_one_of(d, (unsigned)k->n - 1U)) % k->n;
        if (dice_one_of(d, 3) == 0) {
            exchange(k, i, j);
        } else {
            mix(k, i, j, dice_between(d, -0.5, 0.5));
        }
    }
}

static double norm_of(const known *k) {
    double sum = 0.0;
    for (int i = 0; i < k->n * k->n; i++) {
        sum += fabs(k->a[i]);
    }
    return sum;
}

/* --- values ------------------------------------------------------------------------------------------------*/

/* Each known one is nearest to one that was found, and to no other. */
static void expect_values(const known *k, double norm, double tolerance) {
    complex_number found[MOST];
    bool taken[MOST] = {false};
    TEST_ASSERT_TRUE(modes_values(k->n, k->a, found));
    for (int i = 0; i < k->n; i++) {
        int best = 0;
        double least = (double)INFINITY;
        for (int j = 0; j < k->n; j++) {
            const double off = hypot(found[j].re - k->value[i].re, found[j].im - k->value[i].im);
            if (off < least) {
                least = off;
                best = j;
            }
        }
        TEST_ASSERT_TRUE(least <= tolerance * norm);
        TEST_ASSERT_FALSE(taken[best]);
        taken[best] = true;
    }
}

static void test_values_of_known_matrices(void) {
    dice d = dice_of("modes values", 2318);
    for (unsigned n = few_or_all(400, 10000); n > 0; n--) {
        known k = draw_blocks(&d, dice_one_of(&d, 2) == 0 ? 0.5 : 3.0);
        mix_all(&d, &k);
        const double norm = norm_of(&k);
        expect_values(&k, norm, 1e-10);
        for (int i = 0; i < k.n; i++) { /* powers of two: the same numbers in other units */
            measure(&k, i, ldexp(1.0, (int)dice_one_of(&d, 21) - 10));
        }
        expect_values(&k, norm, 1e-8);
    }
}

/* Triangles, companions of x^n = 1 and matrices of nothing: what QR steps by themselves do not move. */
static void test_values_of_hard_matrices(void) {
    for (int n = 1; n <= MOST; n++) {
        known turns = {.n = n};
        known zeros = {.n = n};
        known triangle = {.n = n};
        for (int i = 0; i < n; i++) {
            const double angle = 2.0 * acos(-1.0) * i / n;
            turns.value[i] = (complex_number){cos(angle), sin(angle)};
            turns.a[i * n + (i + 1) % n] = 1.0;
            triangle.value[i].re = i - 3.0;
            for (int j = i; j < n; j++) {
                triangle.a[i * n + j] = j == i ? i - 3.0 : 1.0 + j;
            }
        }
        expect_values(&turns, 1.0, 1e-12);
        expect_values(&triangle, norm_of(&triangle), 1e-10);
        complex_number found[MOST];
        TEST_ASSERT_TRUE(modes_values(n, zeros.a, found));
        for (int i = 0; i < n; i++) {
            TEST_ASSERT_TRUE(found[i].re == 0.0 && found[i].im == 0.0);
        }
        zeros.a[n * n - 1] = (double)NAN;
        TEST_ASSERT_FALSE(modes_values(n, zeros.a, found));
    }
}

/* --- what they contribute ----------------------------------------------------------------------------------*/

/* part is an eigenvector, as far as rounding lets it. */
static void expect_eigenvector(const known *k, complex_number value, const complex_number *part,
                               double size) {
    for (int i = 0; i < k->n; i++) {
        complex_number sum = {-value.re * part[i].re + value.im * part[i].im,
                              -value.re * part[i].im - value.im * part[i].re};
        for (int j = 0; j < k->n; j++) {
            sum.re += k->a[i * k->n + j] * part[j].re;
            sum.im += k->a[i * k->n + j] * part[j].im;
        }
        TEST_ASSERT_TRUE(complex_size(sum) <= 1e-8 * norm_of(k) * size);
    }
}

static void test_parts_add_up_to_the_motion(void) {
    dice d = dice_of("modes parts", 2319);
    for (unsigned n = few_or_all(200, 4000); n > 0; n--) {
        known k = draw_blocks(&d, 0.5);
        const bool mixed = dice_one_of(&d, 2) == 0;
        if (mixed) {
            mix_all(&d, &k);
        }
        double slope[MOST];
        double size = 0.0;
        complex_number sum[MOST] = {{0.0, 0.0}};
        for (int i = 0; i < k.n; i++) {
            slope[i] = dice_between(&d, -1.0, 1.0);
            size = fmax(size, fabs(slope[i]));
        }
        known other = k;
        double other_slope[MOST];
        for (int i = 0; i < k.n; i++) {
            const double unit = ldexp(1.0, (int)dice_one_of(&d, 11) - 5);
            measure(&other, i, unit);
            other_slope[i] = slope[i] * unit;
        }
        for (int m = 0; m < k.n; m++) {
            complex_number part[MOST];
            complex_number left[MOST];
            complex_number other_left[MOST];
            complex_number other_part[MOST];
            double share[MOST];
            double other_share[MOST];
            double all = 0.0;
            TEST_ASSERT_TRUE(modes_part(k.n, k.a, k.value[m], slope, part, left, share));
            TEST_ASSERT_TRUE(modes_part(k.n, other.a, k.value[m], other_slope, other_part,
                                        other_left, other_share));
            expect_eigenvector(&k, k.value[m], part, size);
            for (int i = 0; i < k.n; i++) {
                sum[i].re += part[i].re;
                sum[i].im += part[i].im;
                all += share[i];
                TEST_ASSERT_DOUBLE_WITHIN(1e-7, share[i], other_share[i]);
                TEST_ASSERT_TRUE(mixed || k.block[i] == k.block[m] || share[i] < 1e-12);
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, all);
        }
        for (int i = 0; i < k.n; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-7 * size, slope[i], sum[i].re);
            TEST_ASSERT_DOUBLE_WITHIN(1e-7 * size, 0.0, sum[i].im);
        }
    }
}

/* Blocks that do not touch, in any order: those that the slope has nothing of take no part, however fast they are, and
 * the others have all of it. (Each used to be given the motion of one that moves.) */
static void test_what_stands_still_takes_no_part(void) {
    dice d = dice_of("modes at rest", 2320);
    unsigned still = 0;
    for (unsigned n = few_or_all(300, 10000); n > 0; n--) {
        known k = draw_blocks(&d, dice_one_of(&d, 2) == 0 ? 0.5 : 4.0);
        int block[MOST];
        bool rests[MOST] = {false};
        double slope[MOST];
        memcpy(block, k.block, sizeof block);
        for (int i = 0; i < k.n; i++) {
            rests[i] = block[i] == i ? dice_one_of(&d, 2) == 0 : rests[block[i]];
            slope[i] = rests[i] ? 0.0 : dice_between(&d, 0.1, 1.0);
        }
        for (int turn = 0; turn < k.n; turn++) {
            const int i = (int)dice_one_of(&d, (unsigned)k.n);
            const int j = (int)dice_one_of(&d, (unsigned)k.n);
            const double kept = slope[i];
            exchange(&k, i, j);
            slope[i] = slope[j];
            slope[j] = kept;
        }
        for (int i = 0; i < k.n; i++) {
            measure(&k, i, ldexp(1.0, (int)dice_one_of(&d, 21) - 10));
        }
        double sum[MOST] = {0.0};
        for (int m = 0; m < k.n; m++) {
            complex_number part[MOST];
            complex_number left[MOST];
            double share[MOST];
            const bool told = modes_part(k.n, k.a, k.value[m], slope, part, left, share);
            TEST_ASSERT_EQUAL(!rests[m], told);
            still += rests[m] ? 1 : 0;
            for (int i = 0; i < k.n; i++) {
                sum[i] += part[i].re;
            }
        }
        for (int i = 0; i < k.n; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-6 * fabs(slope[i]), slope[i], sum[i]);
        }
    }
    printf("  %u eigenvalues of what stands still have no part\n", still);
}

void suite_modes(void) {
    RUN_TEST(test_values_of_known_matrices);
    RUN_TEST(test_values_of_hard_matrices);
    RUN_TEST(test_parts_add_up_to_the_motion);
    RUN_TEST(test_what_stands_still_takes_no_part);
}
