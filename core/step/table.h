/* table.h: functions of one phase as constant tables in flash, interpolated within a cell.
 *
 * The tables have the terms of a mechanism's accelerations that depend only on one turn angle, including sines,
 * divisions and roots (host/image/tables.c). The turn is divided into 2^bits cells; the middle of cell i is at
 * i / 2^bits turns. A cell stores the polynomials of all tables one after the other, so that one lookup of the phase
 * finds them all. y is the distance from the cell's middle, in cells:
 *
 *      linear: a + y b        cubic: a + y (b + y (c + y d)),        -1/2 <= y < 1/2
 *
 * Neighbouring polynomials agree at the border of their cells. Cubic polynomials also agree in slope there. The sum
 * of the terms after `a` is small, so the round-off is little more than that of one addition. */
#ifndef WH_TABLE_H
#define WH_TABLE_H

#ifdef __cplusplus
#error \
    "core/step/table.h is C only, for generated .c files: in C++ include core/scene.h and the generated headers"
#endif

#include "../number/flash.h"
#include "../number/turn.h"

#include <stddef.h>

/* Limits on the binary logarithm of the number of cells per turn. */
#define WH_TABLE_BITS_LEAST 3U
#define WH_TABLE_BITS_MOST 16U

/* Numbers per cell of one linear table, and of one cubic table. */
#define WH_TABLE_LINEAR 2U
#define WH_TABLE_CUBIC 4U

/* 1: a list with only even or odd tables stores half a turn of each table. The results do not change by any bit.
 * Without an FPU, folding costs at most 1 % of a step's cycles; with an FPU, 14 %. */
#ifndef WH_TABLE_FOLD
#if !WH_DOUBLE && (defined(__AVR__) || (defined(__arm__) && !defined(__ARM_FP)) || \
                   (defined(__riscv) && !defined(__riscv_flen)))
#define WH_TABLE_FOLD 1
#else
#define WH_TABLE_FOLD 0
#endif
#endif
#if WH_TABLE_FOLD && WH_DOUBLE
#error "core/step/table.h: WH_TABLE_FOLD is for float"
#endif

/* Number of cells that the table of an even or odd function stores. */
#define WH_TABLE_HALF(bits) (WH_TABLE_FOLD ? (1U << ((bits)-1U)) + 1U : 1U << (bits))

/* Scale the coefficients b, c and d to the unit of y: one cell in double, 2^-32 of a cell in float. */
#if WH_DOUBLE
#define WH_TABLE_B(x) (x)
#define WH_TABLE_C(x) (x)
#define WH_TABLE_D(x) (x)
#else
#define WH_TABLE_B(x) ((x)*0x1p-32f)
#define WH_TABLE_C(x) ((x)*0x1p-64f)
#define WH_TABLE_D(x) ((x)*0x1p-96f)
#endif

/* Returns the cell of `phase` among 2^bits cells: cells[number * width]. *y gets the distance from the cell's middle.
 * Float: any phase. Double: |phase| <= 5e8 rad; for larger phases and NaN, *y is NaN. */
WH_INLINE const wh_real *wh_table_cell(const wh_real *cells, unsigned bits, unsigned width,
                                       wh_phase phase, wh_real *y);

#if WH_DOUBLE

/* Returns the whole number nearest to x, and sets *low to the low 32 bits of this number. |x| must be < 2^51. */
WH_INLINE double wh_table_whole(double x, uint32_t *low) {
    const double sum = x + 6755399441055744.0; /* 1.5 * 2^52 */
    uint64_t of_sum;
    __builtin_memcpy(&of_sum, &sum, sizeof of_sum);
    *low = (uint32_t)of_sum;
    return sum - 6755399441055744.0;
}

/* The three constants subtracted from `angle` add up to pi/64. */
WH_INLINE const wh_real *wh_table_cell(const wh_real *cells, unsigned bits, unsigned width,
                                       wh_phase phase, wh_real *y) {
    const unsigned coarse = bits < 7U ? bits : 7U;
    const unsigned finer = bits - coarse;
    /* size of a coarse cell, in units of pi/64 */
    const double size = (double)(1U << (7U - coarse));
    const double angle = WH_ABS(phase) <= 5e8 ? phase : __builtin_nan("");
    uint32_t number;
    uint32_t part;
    const double whole = wh_table_whole(angle * (20.371832715762604 / size), &number);
    double r = angle - whole * (0.049087285995483398 * size);
    r = r - whole * (9.9216777016408741e-08 * size);
    r = r - whole * (8.0104504737328716e-14 * size);
    const double in_cells = r * (20.371832715762604 / size) * (double)(1U << finer);
    const double parts = wh_table_whole(in_cells, &part);
    *y = in_cells - parts;
    return cells + (size_t)((((number << finer) + part) & ((1U << bits) - 1U)) * width);
}

#else

WH_INLINE const wh_real *wh_table_cell(const wh_real *cells, unsigned bits, unsigned width,
                                       wh_phase phase, wh_real *y) {
    const unsigned rest_bits = 32U - bits;
    const uint32_t number = (phase + (UINT32_C(1) << (rest_bits - 1U))) >> rest_bits;
    /* Shifting the cell number out leaves the distance from the cell's middle, with the right sign. */
    *y = (float)(int32_t)(phase << bits);
    return cells + (size_t)number * width;
}

#endif

/* wh_table_cell() for tables that are even or odd. *back becomes true if the phase was beyond half a turn and was
 * mirrored: the value of an odd function then needs wh_table_back(). */
WH_INLINE const wh_real *wh_table_half(const wh_real *cells, unsigned bits, unsigned width,
                                       wh_phase phase, wh_real *y, bool *back) {
#if WH_TABLE_FOLD
    /* -phase instead of ~phase would move a phase on the border of two cells to the other cell */
    const bool beyond = (int32_t)phase < 0;
    const wh_real *row = wh_table_cell(cells, bits, width, beyond ? ~phase : phase, y);
    const wh_real way = (wh_real)(int32_t)(phase << bits);
    *y = beyond ? -way : way;
    *back = beyond;
    return row;
#else
    *back = false;
    return wh_table_cell(cells, bits, width, phase, y);
#endif
}

/* Returns -value if `back`. Zero stays positive zero, because the tables have no negative zero. */
WH_INLINE wh_real wh_table_back(wh_real value, bool back) {
#if WH_TABLE_FOLD
    uint32_t bits;
    __builtin_memcpy(&bits, &value, sizeof bits);
    bits ^= back && bits != 0 ? UINT32_C(0x80000000) : 0;
    __builtin_memcpy(&value, &bits, sizeof bits);
#else
    (void)back;
#endif
    return value;
}

/* Return the value, at y, of the polynomial whose coefficients begin at `of`. */
WH_INLINE wh_real wh_table_linear(const wh_real *of, wh_real y) {
    return wh_flash_real(&of[0]) + y * wh_flash_real(&of[1]);
}

WH_INLINE wh_real wh_table_cubic(const wh_real *of, wh_real y) {
    const wh_real upper = wh_flash_real(&of[2]) + y * wh_flash_real(&of[3]);
    return wh_flash_real(&of[0]) + y * (wh_flash_real(&of[1]) + y * upper);
}

#endif
