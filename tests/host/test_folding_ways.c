/* test_folding_ways.c: constants folded with other roundings (host/number/folding.h): sums, products, quotients,
 * powers and functions of random numbers, compared with long double or fma(). Exact results must stay. Other results
 * must change by up to two units in the last place: to the far side of the exact value with FOLDING_OPPOSITE, to either
 * side with later ways. */
#include "host/number/folding.h"

#include "command.h"

enum { DRAWN = 2000 };

/* A number of 53 digits. The sum of two such numbers fits into the 64 digits of a long double. */
static double drawn(dice *d) {
    const double size = ldexp(dice_between(d, 1.0, 2.0), (int)dice_one_of(d, 9) - 4);
    return dice_one_of(d, 2) == 0 ? size : -size;
}

typedef enum kind { SUM, PRODUCT, QUOTIENT, POWER, SINE, ROOT, KINDS } kind;

/* Sign of the exact result minus `nearest`; 0 if the result is exact, or if the sign is not known. */
static int side_of(kind of, double x, double y, double nearest) {
    switch (of) {
    case SUM: {
        const long double left = (long double)x + (long double)y - (long double)nearest;
        return (left > 0.0L) - (left < 0.0L);
    }
    case PRODUCT: {
        const double left = fma(x, y, -nearest);
        return (left > 0.0) - (left < 0.0);
    }
    case QUOTIENT: {
        const double left = -fma(nearest, y, -x) * y;
        return (left > 0.0) - (left < 0.0);
    }
    case POWER:
    case SINE:
    case ROOT:
    case KINDS: break;
    }
    return 0;
}

static double folded_by(int way, kind of, double x, double y) {
    folding mine = {.way = way};
    double made = 0.0;
    switch (of) {
    case SUM: made = folding_sum(&mine, x, y); break;
    case PRODUCT: made = folding_product(&mine, x, y); break;
    case QUOTIENT: made = folding_quotient(&mine, x, y); break;
    case POWER: made = folding_power(&mine, fabs(x), y); break;
    case SINE: made = folding_call(&mine, FN_SIN, x, 0.0); break;
    case ROOT: made = folding_call(&mine, FN_SQRT, fabs(x), 0.0); break;
    case KINDS: break;
    }
    return made;
}

/* The number of doubles from `from` up to `to`, between -7 and 7; 9 if the distance is larger. */
static int doubles_from(double from, double to) {
    double up = from;
    double down = from;
    for (int i = 0; i < 8; i++) {
        if (up == to || down == to) {
            return up == to ? i : -i;
        }
        up = nextafter(up, (double)INFINITY);
        down = nextafter(down, -(double)INFINITY);
    }
    return 9;
}

TEST(folding_ways, inexact_results_are_moved) {
    dice d = dice_of("folding ways", 1);
    unsigned times[KINDS][FOLDING_WAYS][5] = {{{0}}}; /* number of moves by -2 to 2 doubles */
    for (unsigned i = 0; i < DRAWN; i++) {
        const double x = drawn(&d);
        const double y = drawn(&d);
        for (kind of = SUM; of < KINDS; of++) {
            const double nearest = folded_by(FOLDING_NEAREST, of, x, y);
            const int side = side_of(of, x, y, nearest);
            for (int way = FOLDING_OPPOSITE; way < FOLDING_WAYS; way++) {
                const int by = doubles_from(nearest, folded_by(way, of, x, y));
                char what[160];
                snprintf(what, sizeof what, "kind %d, way %d: %a and %a moved by %d", (int)of, way,
                         x, y, by);
                TEST_ASSERT_TRUE_MESSAGE(by >= -2 && by <= 2, what);
                times[of][way][by + 2]++;
                if (way == FOLDING_OPPOSITE && of == SUM) {
                    TEST_ASSERT_EQUAL_INT_MESSAGE(2 * side, by, what);
                }
                if (of <= QUOTIENT && side == 0) {
                    TEST_ASSERT_EQUAL_INT_MESSAGE(0, by, what);
                }
            }
        }
    }
    for (kind of = SUM; of < KINDS; of++) {
        const bool stays = of == PRODUCT || of == QUOTIENT;
        TEST_ASSERT_EQUAL_UINT(DRAWN, times[of][FOLDING_APART][2]);
        TEST_ASSERT_TRUE((times[of][FOLDING_OPPOSITE][2] == DRAWN) == stays);
        for (int way = FOLDING_SOME; way < FOLDING_WAYS; way++) {
            /* each size of change must be frequent; a third of the sums is exact */
            for (int by = 0; by < 5; by++) {
                TEST_ASSERT_TRUE(by == 2 ? times[of][way][by] < DRAWN / 2
                                         : times[of][way][by] > DRAWN / 9);
            }
        }
    }
}

/* Different ways must change results differently. If the same constant is folded again, or its operands are swapped,
 * the change must be the same. */
TEST(folding_ways, ways_are_several) {
    dice d = dice_of("folding ways", 2);
    unsigned alike = 0;
    for (unsigned i = 0; i < DRAWN; i++) {
        const double x = drawn(&d);
        const double y = drawn(&d);
        for (int way = FOLDING_SOME; way < FOLDING_WAYS; way++) {
            TEST_ASSERT_TRUE(folded_by(way, SUM, x, y) == folded_by(way, SUM, y, x));
            TEST_ASSERT_TRUE(folded_by(way, PRODUCT, x, y) == folded_by(way, PRODUCT, y, x));
            alike += way > FOLDING_SOME &&
                     folded_by(way, PRODUCT, x, y) == folded_by(FOLDING_SOME, PRODUCT, x, y);
        }
    }
    TEST_ASSERT_TRUE(alike < DRAWN * (FOLDING_WAYS - FOLDING_SOME - 1) * 2 / 5);
}

/* Exact results: sums, products and quotients of small integers, roots of squares, absolute values, and functions at
 * arguments such as zero. */
TEST(folding_ways, exact_results_stay) {
    static const struct {
        function_id function;
        double x, value;
    } begins[] = {{FN_SIN, 0.0, 0.0}, {FN_COS, 0.0, 1.0},  {FN_EXP, 0.0, 1.0},
                  {FN_LOG, 1.0, 0.0}, {FN_TANH, 0.0, 0.0}, {FN_ATAN, 0.0, 0.0}};
    dice d = dice_of("folding ways", 3);
    for (unsigned i = 0; i < 300; i++) {
        const double x = 1.0 + dice_one_of(&d, 1000);
        const double y = ldexp(1.0 + dice_one_of(&d, 1000), (int)dice_one_of(&d, 40) - 20);
        for (int way = FOLDING_OPPOSITE; way < FOLDING_WAYS; way++) {
            TEST_ASSERT_TRUE(folded_by(way, SUM, x, -y) == x - y);
            TEST_ASSERT_TRUE(folded_by(way, PRODUCT, x, y) == x * y);
            TEST_ASSERT_TRUE(folded_by(way, QUOTIENT, x * y, x) == y);
            TEST_ASSERT_TRUE(folded_by(way, ROOT, x * x, 0.0) == x);
            TEST_ASSERT_TRUE(folded_by(way, POWER, drawn(&d) * 0.0 + x, 2.0) == x * x);
            folding mine = {.way = way};
            const double size = drawn(&d);
            TEST_ASSERT_TRUE(folding_call(&mine, FN_ABS, size, 0.0) == fabs(size));
            TEST_ASSERT_TRUE(folding_power(&mine, size, 1.0) == size);
            for (size_t k = 0; k < sizeof begins / sizeof *begins; k++) {
                TEST_ASSERT_TRUE(folding_call(&mine, begins[k].function, begins[k].x, 0.0) ==
                                 begins[k].value);
            }
        }
    }
}
