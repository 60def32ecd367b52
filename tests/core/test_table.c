/* test_table.c: tabulated functions, one polynomial per cell. At any phase a lookup must give the polynomial, and the
 * function as accurately as a cell's width allows. Tested with whole tables and, if the build has them, tables of
 * half a turn. */
#include "core/angle.h"
#if __STDC_HOSTED__ && !WH_DOUBLE
#define WH_TABLE_FOLD 1 /* the setting of boards without an FPU; other builds have the default */
#endif
#include "core/step/table.h"

#include "tests/core/draw.h"
#include "tests/suites.h"

enum {
    WIDTH = WH_TABLE_CUBIC + WH_TABLE_LINEAR,
    BITS_MOST = WH_TEST_SMALL ? 4 : 7,
    CASES = WH_TEST_SMALL ? 40 : 400
};
#define TWO_PI WH_R(6.283185307179586477)

static wh_phase phase_of(uint32_t units) {
#if WH_DOUBLE
    return (double)units * (6.283185307179586477 / 4294967296.0);
#else
    return units;
#endif
}

#if !defined(__AVR__) /* which reads tables from flash, not from `cells` */
/* Cells of two functions: the sine by cubics, the cosine by straight lines, about each cell's middle (Taylor). */
static wh_real cells[(1U << BITS_MOST) * WIDTH];

static void fill(unsigned bits) {
    const wh_real width = TWO_PI / (wh_real)(1U << bits); /* width of a cell, rad */
    for (uint32_t i = 0; i < 1U << bits; i++) {
        wh_real s;
        wh_real c;
        wh_real *cell = cells + i * WIDTH;
        wh_sincos(phase_of(i << (32U - bits)), &s, &c);
        cell[0] = s;
        cell[1] = WH_TABLE_B(width * c);
        cell[2] = WH_TABLE_C(WH_R(-0.5) * width * width * s);
        cell[3] = WH_TABLE_D(width * width * width * c / WH_R(-6.0));
        cell[4] = c;
        cell[5] = WH_TABLE_B(-width * s);
    }
}

/* Tests one phase. The tolerance is the next term of the series at half a cell, plus round-off. */
static void check_at(unsigned bits, uint32_t units) {
    const wh_real half = TWO_PI / (wh_real)(2U << bits);
    wh_real s;
    wh_real c;
    wh_real y;
    bool back;
    wh_sincos(phase_of(units), &s, &c);
    const wh_real *row = wh_table_cell(cells, bits, WIDTH, phase_of(units), &y);
    const wh_real sine = wh_table_cubic(row, y);
    const wh_real cosine = wh_table_linear(row + WH_TABLE_CUBIC, y);
    const wh_real rounding = WH_DOUBLE ? WH_R(1e-15) : WH_R(3e-7);
    TEST_ASSERT_TRUE((unsigned)(row - cells) / WIDTH ==
                     ((units + (UINT32_C(1) << (31U - bits))) >> (32U - bits)) % (1U << bits));
    TEST_ASSERT_TRUE(WH_ABS(sine - s) < half * half * half * half / WH_R(23.9) + rounding);
    TEST_ASSERT_TRUE(WH_ABS(cosine - c) < half * half / WH_R(1.99) + rounding);
    /* In tables of half a turn, an even function has the same value, and an odd one changes its sign. */
    const wh_real *from_half = wh_table_half(cells, bits, WIDTH, phase_of(units), &y, &back);
    TEST_ASSERT_TRUE((unsigned)(from_half - cells) < WH_TABLE_HALF(bits) * WIDTH);
    const wh_real odd = wh_table_back(wh_table_cubic(from_half, y), back);
    const wh_real even = wh_table_linear(from_half + WH_TABLE_CUBIC, y);
    TEST_ASSERT_TRUE(WH_ABS(odd - sine) < 2 * rounding);
    TEST_ASSERT_TRUE(WH_ABS(even - cosine) < 2 * rounding);
    /* Zero is never negative. */
    TEST_ASSERT_TRUE(odd != WH_R(0.0) || !__builtin_signbit((double)odd));
}

static void test_tables_hold_what_they_were_made_of(void) {
    uint64_t seed = 20261123;
    for (unsigned bits = WH_TABLE_BITS_LEAST; bits <= BITS_MOST; bits++) {
        fill(bits);
        for (unsigned i = 0; i < CASES; i++) {
            check_at(bits, (uint32_t)(draw_bits(&seed) << 16 ^ draw_bits(&seed)));
        }
        for (uint32_t i = 0; i < 2U << bits; i++) { /* middles and ends of cells, neighbours */
            const uint32_t edge = i << (31U - bits);
            check_at(bits, edge + 3U);
            check_at(bits, edge - 3U);
            if (i % 2U == 0 || !WH_DOUBLE) {
                /* In double, round-off decides to which cell an edge belongs. */
                check_at(bits, edge);
            }
        }
    }
}

#endif

/* wh_table_cell() for numbers of cells other than 128: the cell's number, and the distance from its middle. */
TEST(table, finer_cells_divide_coarse_ones) {
    static const wh_real none[1] = {WH_R(0.0)};
    uint64_t seed = 7;
    for (unsigned bits = 7; bits <= (sizeof(size_t) > 2 ? WH_TABLE_BITS_MOST : 12U); bits++) {
        for (unsigned i = 0; i < CASES; i++) {
            const uint32_t units = (uint32_t)(draw_bits(&seed) << 16 ^ draw_bits(&seed));
            const uint32_t number =
                ((units + (UINT32_C(1) << (31U - bits))) >> (32U - bits)) % (1U << bits);
            const int32_t way =
                (int32_t)((units - (number << (32U - bits))) << bits); /* in units of 2^-32 cells */
            wh_real y;
            const size_t at = (size_t)(wh_table_cell(none, bits, 1, phase_of(units), &y) - none);
            if (way < INT32_MAX - 99999 && way > -INT32_MAX + 99999) {
                /* not tested near the ends of a cell */
                const wh_real off = y * (WH_DOUBLE ? WH_R(0x1p32) : WH_R(1.0)) - (wh_real)way;
                TEST_ASSERT_TRUE(at == number);
                TEST_ASSERT_TRUE(WH_ABS(off) <= (WH_DOUBLE ? WH_R(0.4) : WH_R(0.0)));
            }
        }
    }
}

#if WH_DOUBLE
/* For a phase beyond the range in which the constants are exact, the value is NaN. */
static void test_phases_too_large_have_none(void) {
    const double far[] = {5.1e8, -5.1e8, 1e300, __builtin_inf(), __builtin_nan("")};
    fill(WH_TABLE_BITS_LEAST);
    for (unsigned i = 0; i < sizeof far / sizeof far[0]; i++) {
        double y;
        const double *row = wh_table_cell(cells, WH_TABLE_BITS_LEAST, WIDTH, far[i], &y);
        TEST_ASSERT_TRUE(y != y && wh_table_cubic(row, y) != wh_table_cubic(row, y));
    }
}
#endif

SUITE(table) {
#if !defined(__AVR__)
    RUN_TEST(test_tables_hold_what_they_were_made_of);
#endif
#if WH_DOUBLE
    RUN_TEST(test_phases_too_large_have_none);
#endif
}
