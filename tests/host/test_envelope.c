/* test_envelope.c: the course of a run for its picture: generated signals of every length, compared with all of
 * their values. */
#include "host/io/minmax_decimation.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "unity.h"

void suite_envelope(void);

enum { COLUMNS = 4 }; /* the time, a swing with peaks of one step, a swing with gaps, noise */

/* A row at each step: [steps * COLUMNS]. */
static double *signal_of(dice *d, unsigned steps) {
    double *made = calloc((size_t)steps * COLUMNS, sizeof *made);
    TEST_ASSERT_NOT_NULL(made);
    const double h = pow(10.0, dice_between(d, -6.0, 1.0));
    const double turn = dice_between(d, 0.001, 6.28);
    const unsigned peak = dice_one_of(d, steps);
    const unsigned gap = 1 + dice_one_of(d, 400);
    for (unsigned k = 0; k < steps; k++) {
        double *row = made + (size_t)k * COLUMNS;
        row[0] = h * k;
        row[1] = sin(turn * k) + (k == peak ? 7.0 : 0.0);
        row[2] = k % gap == 0 ? (double)NAN : cos(turn * k);
        row[3] = dice_between(d, -1.0, 1.0);
    }
    return made;
}

static decimation *entered(const double *data, unsigned steps) {
    decimation *v = decimation_new(COLUMNS, false);
    for (unsigned k = 0; k < steps; k++) {
        decimation_enter(v, data + (size_t)k * COLUMNS);
    }
    return v;
}

static void test_short_runs_are_kept_number_by_number(void) {
    dice d = dice_of("short signals", 5101);
    for (unsigned i = 0; i < 20; i++) {
        const unsigned steps = i == 0   ? 1
                               : i == 1 ? DECIMATION_ROOM
                                        : 1 + dice_one_of(&d, DECIMATION_ROOM);
        double *data = signal_of(&d, steps);
        decimation *v = entered(data, steps);
        int rows;
        double *kept = decimation_rows(v, &rows);
        TEST_ASSERT_EQUAL_INT((int)steps, rows);
        TEST_ASSERT_EQUAL_INT(0, memcmp(kept, data, (size_t)steps * COLUMNS * sizeof *data));
        free(kept);
        free(data);
        decimation_free(v);
    }
}

/* The steps of a bucket: the least power of two that lets all of them in. */
static unsigned size_of(unsigned steps) {
    unsigned size = 1;
    while ((uint64_t)size * DECIMATION_ROOM < steps) {
        size *= 2;
    }
    return size;
}

/* Both numbers drawn of column i are the least and the greatest of the steps [from, to), as they came. */
static void check_bucket(const double *data, unsigned from, unsigned to, int i, double first,
                         double second) {
    unsigned least = UINT32_MAX;
    unsigned most = UINT32_MAX;
    for (unsigned k = from; k < to; k++) {
        const double value = data[(size_t)k * COLUMNS + (size_t)i];
        if (!isfinite(value)) {
            continue;
        }
        least =
            least == UINT32_MAX || value < data[(size_t)least * COLUMNS + (size_t)i] ? k : least;
        most = most == UINT32_MAX || value > data[(size_t)most * COLUMNS + (size_t)i] ? k : most;
    }
    if (least == UINT32_MAX) {
        TEST_ASSERT_TRUE(isnan(first) && isnan(second));
        return;
    }
    const unsigned early = least < most ? least : most;
    const unsigned late = least < most ? most : least;
    TEST_ASSERT_TRUE(first == data[(size_t)early * COLUMNS + (size_t)i]);
    TEST_ASSERT_TRUE(second == data[(size_t)late * COLUMNS + (size_t)i]);
}

static void test_long_runs_keep_least_and_most_of_every_stretch(void) {
    dice d = dice_of("long signals", 5102);
    const unsigned cases = dice_cases(25);
    for (unsigned i = 0; i < cases; i++) {
        const unsigned steps =
            i == 0   ? DECIMATION_ROOM + 1
            : i == 1 ? 2 * DECIMATION_ROOM
            : i == 2 ? 2 * DECIMATION_ROOM + 1
                     : DECIMATION_ROOM + 1 + (unsigned)pow(10.0, dice_between(&d, 0.0, 5.3));
        double *data = signal_of(&d, steps);
        decimation *v = entered(data, steps);
        const unsigned size = size_of(steps);
        int rows;
        double *kept = decimation_rows(v, &rows);
        TEST_ASSERT_EQUAL_INT((int)(2 * ((steps + size - 1) / size)), rows);
        TEST_ASSERT_TRUE(rows > (int)DECIMATION_ROOM && rows <= 2 * (int)DECIMATION_ROOM);
        for (int k = 0; k < rows / 2; k++) {
            const unsigned from = (unsigned)k * size;
            const unsigned to = from + size < steps ? from + size : steps;
            for (int c = 0; c < COLUMNS; c++) {
                const double *at = kept + (size_t)k * 2 * COLUMNS + c;
                check_bucket(data, from, to, c, at[0], at[COLUMNS]);
            }
        }
        free(kept);
        free(data);
        decimation_free(v);
    }
}

/* Wherever a run is broken off, what there is covers all of it. */
static void test_at_every_moment_all_is_there(void) {
    dice d = dice_of("broken off", 5103);
    const unsigned steps = 5 * DECIMATION_ROOM;
    double *data = signal_of(&d, steps);
    decimation *v = decimation_new(COLUMNS, false);
    for (unsigned k = 0; k < steps; k++) {
        decimation_enter(v, data + (size_t)k * COLUMNS);
        if (k % 97 == 0) {
            int rows;
            double *kept = decimation_rows(v, &rows);
            TEST_ASSERT_TRUE(kept[0] == data[0]);
            TEST_ASSERT_TRUE(kept[(size_t)(rows - 1) * COLUMNS] == data[(size_t)k * COLUMNS]);
            TEST_ASSERT_TRUE(k < DECIMATION_ROOM ? rows == (int)k + 1
                                                 : rows > (int)DECIMATION_ROOM);
            free(kept);
        }
    }
    free(data);
    decimation_free(v);
}

void suite_envelope(void) {
    RUN_TEST(test_short_runs_are_kept_number_by_number);
    RUN_TEST(test_long_runs_keep_least_and_most_of_every_stretch);
    RUN_TEST(test_at_every_moment_all_is_there);
}
