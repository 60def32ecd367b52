/* test_plot.c: the envelope of a run for its picture, the colours of the curves, and a recording's picture. */
#include "host/io/gnuplot.h"
#include "host/io/minmax_decimation.h"
#include "host/monitor/recording.h"

#include "command.h"

/* === suite envelope =========================================================================== */
/* The envelope of a run for its picture: random signals of every length, compared with all their values. */

/* Columns: time, an oscillation with peaks of one step, an oscillation with gaps, noise. */
enum { COLUMNS = 4 };

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

TEST(envelope, short_runs_have_every_number) {
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

/* Steps in a bucket: the least power of two with which all steps fit. */
static unsigned size_of(unsigned steps) {
    unsigned size = 1;
    while ((uint64_t)size * DECIMATION_ROOM < steps) {
        size *= 2;
    }
    return size;
}

/* In a bucket, the two numbers of column i must be the minimum and maximum of the steps from `from` to to - 1, in
 * the sequence of time. */
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

TEST(envelope, long_runs_have_minima_and_maxima) {
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

TEST(envelope, unfinished_envelope_is_complete) {
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

/* === suite palette ============================================================================ */
/* Colours of pictures (host/io/gnuplot.h): their contrast ratio by WCAG 2.1, and their distance in CIELAB, for eyes
 * with and without colour blindness (Machado, Oliveira and Fernandes, 2009, severity 1). */

#define CONTRAST 3.0
#define APART 13.0

enum { EYES = 4 };
static const char *const eye_words[EYES] = {"full sight", "protanopia", "deuteranopia",
                                            "tritanopia"};
/* matrices that simulate each eye, for linear RGB */
static const double eye[EYES][9] = {
    {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0},
    {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
    {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881},
    {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900}};

static void linear_of(const char *colour, double rgb[3]) {
    unsigned long code = strtoul(colour + 1, NULL, 16);
    TEST_ASSERT_TRUE(colour[0] == '#' && strlen(colour) == 7);
    for (int i = 2; i >= 0; i--, code /= 256) {
        const double c = (double)(code % 256) / 255.0;
        rgb[i] = c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
    }
}

static double contrast(const char *a, const char *b) {
    double light[2];
    const char *const both[] = {a, b};
    for (int i = 0; i < 2; i++) {
        double rgb[3];
        linear_of(both[i], rgb);
        light[i] = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2] + 0.05;
    }
    return fmax(light[0], light[1]) / fmin(light[0], light[1]);
}

static double curve_of(double t) {
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

static void lab_of(const char *colour, const double m[9], double lab[3]) {
    double rgb[3];
    double seen[3];
    linear_of(colour, rgb);
    for (int i = 0; i < 3; i++) {
        const double c = m[3 * i] * rgb[0] + m[3 * i + 1] * rgb[1] + m[3 * i + 2] * rgb[2];
        seen[i] = fmin(fmax(c, 0.0), 1.0);
    }
    const double x =
        curve_of((0.4124564 * seen[0] + 0.3575761 * seen[1] + 0.1804375 * seen[2]) / 0.95047);
    const double y = curve_of(0.2126729 * seen[0] + 0.7151522 * seen[1] + 0.0721750 * seen[2]);
    const double z =
        curve_of((0.0193339 * seen[0] + 0.1191920 * seen[1] + 0.9503041 * seen[2]) / 1.08883);
    lab[0] = 116.0 * y - 16.0;
    lab[1] = 500.0 * (x - y);
    lab[2] = 200.0 * (y - z);
}

TEST(palette, lines_stand_out_on_white_and_dark) {
    static const char *const pages[] = {PALETTE_WHITE, PALETTE_DARK};
    double least = 100.0;
    for (int k = 0; k < 2; k++) {
        TEST_ASSERT_TRUE(contrast(PALETTE_FRAME, pages[k]) >= CONTRAST);
        for (int i = 0; i < PALETTE_LINES; i++) {
            const double c = contrast(palette_line(i), pages[k]);
            least = fmin(least, c);
            TEST_ASSERT_TRUE_MESSAGE(c >= CONTRAST, palette_line(i));
        }
    }
    printf("# contrast of lines with white and dark: %.2f at least\n", least);
}

static double distance(const char *a, const char *b, int k) {
    double one[3];
    double other[3];
    lab_of(a, eye[k], one);
    lab_of(b, eye[k], other);
    return hypot(hypot(one[0] - other[0], one[1] - other[1]), one[2] - other[2]);
}

TEST(palette, colours_differ_for_every_eye) {
    for (int k = 0; k < EYES; k++) {
        double least = 1000.0;
        for (int i = 0; i < PALETTE_LINES; i++) {
            for (int j = 0; j < i; j++) {
                const double d = distance(palette_line(i), palette_line(j), k);
                least = fmin(least, d);
                TEST_ASSERT_TRUE_MESSAGE(d >= APART, palette_line(i));
            }
        }
        printf("# %s: any two lines differ by %.1f at least\n", eye_words[k], least);
    }
}

TEST(palette, areas_darken_from_good_to_bad) {
    for (int k = 0; k < EYES; k++) {
        for (int i = 1; i < PALETTE_AREAS; i++) {
            double one[3];
            double other[3];
            lab_of(palette_area(i - 1), eye[k], one);
            lab_of(palette_area(i), eye[k], other);
            TEST_ASSERT_TRUE_MESSAGE(one[0] > other[0], eye_words[k]);
            TEST_ASSERT_TRUE_MESSAGE(distance(palette_area(i), palette_area(i - 1), k) >= APART,
                                     eye_words[k]);
        }
    }
}

TEST(palette, lines_that_share_a_colour_differ_otherwise) {
    for (int i = 0; i < 3 * PALETTE_LINES; i++) {
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(strcmp(palette_line(i), palette_line(j)) != 0 ||
                             palette_dash(i) != palette_dash(j));
        }
    }
    for (int i = 0; i < 9; i++) {
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(palette_point(i) != palette_point(j));
        }
    }
}

/* === suite recording_plot ===================================================================== */
/* The samples that a recording stores for a plot (host/monitor/recording.h). They must be thinned evenly and never
 * changed. Without samples there must be no plot. */

static dice die;

static const schema numbers = {
    .channel[RECORDING_RUN] = {.known = true,
                               .period_ticks = 1000,
                               .eaches = 1,
                               .each[0] = {.name = "n [N]", .size = 4, .scale = 1.0}}};

TEST(recording_plot, thinned_out) {
    recording r;
    recording_begin(&r, NULL, NULL, NULL, true);
    const unsigned samples = 230000U + dice_one_of(&die, 20000);
    for (unsigned i = 0; i < samples; i++) {
        const uint8_t payload[4] = {(uint8_t)i, (uint8_t)(i >> 8), (uint8_t)(i >> 16), 0};
        recording_frame(&r, &numbers,
                        &(wire_frame){.channel = RECORDING_RUN,
                                      .sequence = (uint16_t)i,
                                      .ticks = i * 1000U,
                                      .payload = payload,
                                      .length = 4});
    }
    TEST_ASSERT_EQUAL_INT(2, r.columns);
    int rows = 0;
    double *row = decimation_rows(r.plot, &rows);
    TEST_ASSERT_TRUE(rows > 2000 && rows <= 8000 && row[1] == 0.0 &&
                     row[2 * rows - 1] == (double)(samples - 1));
    for (int i = 0; i < rows; i++) {
        TEST_ASSERT_TRUE(fabs(row[2 * i] - row[2 * i + 1] * 1e-3) < 1e-9 &&
                         (i == 0 || row[2 * i] >= row[2 * i - 2]));
    }
    free(row);
    TEST_ASSERT_EQUAL_UINT64(samples, r.counts.samples);
    recording_end(&r);
    TEST_ASSERT_NULL(r.plot);
}

TEST(recording_plot, nothing_to_plot) {
    recording r;
    recording_begin(&r, NULL, NULL, NULL, true);
    errors_catch();
    const bool drawn = recording_plot(&r, &numbers, "/nowhere/at all.svg");
    TEST_ASSERT_EQUAL_STRING("whirl monitor: error: nothing to plot: no samples came\n",
                             errors_caught());
    TEST_ASSERT_FALSE(drawn);
    recording_end(&r);
}

SUITE(recording_plot) { die = dice_of("recording_plot", 54); }
