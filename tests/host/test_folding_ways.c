/* test_folding_ways.c: constants folded with other roundings (host/number/folding.h): sums, products, quotients, powers
 * and functions of random numbers, compared with long double or fma(). Exact results stay. Other results change by one
 * or two units in the last place: with one rounding to the other side of the exact value, with the others to either
 * side. */
#include "host/number/folding.h"

#include "command.h"

enum { DRAWN = 2000 };

/* Of 53 digits, so that sums fit a long double's 64. */
static double drawn(dice *d) {
    const double size = ldexp(dice_between(d, 1.0, 2.0), (int)dice_one_of(d, 9) - 4);
    return dice_one_of(d, 2) == 0 ? size : -size;
}

typedef enum kind { SUM, PRODUCT, QUOTIENT, POWER, SINE, ROOT, KINDS } kind;

/* Sign of the exact value minus the nearest; 0: exact or unknown. */
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
    folding *const before = folding_use(&mine);
    double made = 0.0;
    switch (of) {
    case SUM: made = folding_sum(x, y); break;
    case PRODUCT: made = folding_product(x, y); break;
    case QUOTIENT: made = folding_quotient(x, y); break;
    case POWER: made = folding_power(fabs(x), y); break;
    case SINE: made = folding_call(FN_SIN, x, 0.0); break;
    case ROOT: made = folding_call(FN_SQRT, fabs(x), 0.0); break;
    case KINDS: break;
    }
    (void)folding_use(before);
    return made;
}

/* How many doubles `to` is above `from`, at most 7 either way; 9: further away. */
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

TEST(folding_ways, what_is_not_exact_is_moved) {
    dice d = dice_of("folding ways", 1);
    unsigned times[KINDS][FOLDING_WAYS][5] = {{{0}}}; /* moved by -2 to 2 */
    for (unsigned i = 0; i < DRAWN; i++) {
        const double x = drawn(&d);
        const double y = drawn(&d);
        for (kind of = SUM; of < KINDS; of++) {
            const double nearest = folded_by(FOLDING_NEAREST, of, x, y);
            const int side = side_of(of, x, y, nearest);
            for (int way = FOLDING_OTHER; way < FOLDING_WAYS; way++) {
                const int by = doubles_from(nearest, folded_by(way, of, x, y));
                char what[160];
                snprintf(what, sizeof what, "kind %d, way %d: %a and %a moved by %d", (int)of, way,
                         x, y, by);
                TEST_ASSERT_TRUE_MESSAGE(by >= -2 && by <= 2, what);
                times[of][way][by + 2]++;
                if (way == FOLDING_OTHER && of == SUM) {
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
        TEST_ASSERT_TRUE((times[of][FOLDING_OTHER][2] == DRAWN) == stays);
        for (int way = FOLDING_SOME; way < FOLDING_WAYS; way++) {
            /* each way and each size often; a third of the sums is exact */
            for (int by = 0; by < 5; by++) {
                TEST_ASSERT_TRUE(by == 2 ? times[of][way][by] < DRAWN / 2
                                         : times[of][way][by] > DRAWN / 9);
            }
        }
    }
}

/* The ways differ; a repeated folding, in any order, moves the same. */
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

/* Sums, products and quotients of small integers, roots of squares, absolute values, and functions where their rows
 * begin. */
TEST(folding_ways, what_is_exact_stays) {
    static const struct {
        function_id function;
        double x, value;
    } begins[] = {{FN_SIN, 0.0, 0.0}, {FN_COS, 0.0, 1.0},  {FN_EXP, 0.0, 1.0},
                  {FN_LOG, 1.0, 0.0}, {FN_TANH, 0.0, 0.0}, {FN_ATAN, 0.0, 0.0}};
    dice d = dice_of("folding ways", 3);
    for (unsigned i = 0; i < 300; i++) {
        const double x = 1.0 + dice_one_of(&d, 1000);
        const double y = ldexp(1.0 + dice_one_of(&d, 1000), (int)dice_one_of(&d, 40) - 20);
        for (int way = FOLDING_OTHER; way < FOLDING_WAYS; way++) {
            TEST_ASSERT_TRUE(folded_by(way, SUM, x, -y) == x - y);
            TEST_ASSERT_TRUE(folded_by(way, PRODUCT, x, y) == x * y);
            TEST_ASSERT_TRUE(folded_by(way, QUOTIENT, x * y, x) == y);
            TEST_ASSERT_TRUE(folded_by(way, ROOT, x * x, 0.0) == x);
            TEST_ASSERT_TRUE(folded_by(way, POWER, drawn(&d) * 0.0 + x, 2.0) == x * x);
            folding mine = {.way = way};
            folding *const before = folding_use(&mine);
            const double size = drawn(&d);
            TEST_ASSERT_TRUE(folding_call(FN_ABS, size, 0.0) == fabs(size));
            TEST_ASSERT_TRUE(folding_power(size, 1.0) == size);
            for (size_t k = 0; k < sizeof begins / sizeof *begins; k++) {
                TEST_ASSERT_TRUE(folding_call(begins[k].function, begins[k].x, 0.0) ==
                                 begins[k].value);
            }
            (void)folding_use(before);
        }
    }
}
