/* test_palette.c: contrast and distance of the colours of pictures (host/io/palette.h), computed: WCAG 2.1's contrast
 * ratio, and CIEDE2000 (Sharma, Wu and Dalal, 2005) between colours as they look to eyes without and with colour
 * blindness (Machado, Oliveira and Fernandes, 2009, severity 1). */
#include "host/io/palette.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

void suite_palette(void);

#define CONTRAST 3.0
#define APART 11.0

enum { EYES = 4 };
static const char *const eye_words[EYES] = {"full sight", "protanopia", "deuteranopia",
                                            "tritanopia"};
/* Of linear RGB. */
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

static double turned(double degrees) { return degrees < 0.0 ? degrees + 360.0 : degrees; }

static double ciede2000(const double a[3], const double b[3]) {
    const double degree = acos(-1.0) / 180.0;
    const double mean = (hypot(a[1], a[2]) + hypot(b[1], b[2])) / 2.0;
    const double g = 0.5 * (1.0 - sqrt(pow(mean, 7) / (pow(mean, 7) + pow(25.0, 7))));
    const double a1 = (1.0 + g) * a[1];
    const double b1 = (1.0 + g) * b[1];
    const double c1 = hypot(a1, a[2]);
    const double c2 = hypot(b1, b[2]);
    const double h1 = c1 > 0.0 ? turned(atan2(a[2], a1) / degree) : 0.0;
    const double h2 = c2 > 0.0 ? turned(atan2(b[2], b1) / degree) : 0.0;
    const bool both = c1 * c2 > 0.0;
    const double dh = !both              ? 0.0
                      : h2 - h1 > 180.0  ? h2 - h1 - 360.0
                      : h2 - h1 < -180.0 ? h2 - h1 + 360.0
                                         : h2 - h1;
    const double h = !both                    ? h1 + h2
                     : fabs(h1 - h2) <= 180.0 ? (h1 + h2) / 2.0
                     : h1 + h2 < 360.0        ? (h1 + h2 + 360.0) / 2.0
                                              : (h1 + h2 - 360.0) / 2.0;
    const double hue = 2.0 * sqrt(c1 * c2) * sin(dh / 2.0 * degree);
    const double l = (a[0] + b[0]) / 2.0 - 50.0;
    const double c = (c1 + c2) / 2.0;
    const double t = 1.0 - 0.17 * cos((h - 30.0) * degree) + 0.24 * cos(2.0 * h * degree) +
                     0.32 * cos((3.0 * h + 6.0) * degree) - 0.2 * cos((4.0 * h - 63.0) * degree);
    const double sl = 1.0 + 0.015 * l * l / sqrt(20.0 + l * l);
    const double sc = 1.0 + 0.045 * c;
    const double sh = 1.0 + 0.015 * c * t;
    const double turn = 30.0 * exp(-pow((h - 275.0) / 25.0, 2));
    const double rc = 2.0 * sqrt(pow(c, 7) / (pow(c, 7) + pow(25.0, 7)));
    const double rt = -rc * sin(2.0 * turn * degree);
    const double dl = (b[0] - a[0]) / sl;
    const double dc = (c2 - c1) / sc;
    return sqrt(dl * dl + dc * dc + hue / sh * (hue / sh) + rt * dc * (hue / sh));
}

/* Pairs 1, 7, 17 and 24 of Sharma, Wu and Dalal's table of test data. */
static void test_the_distance_is_the_published_one(void) {
    static const struct {
        double a[3], b[3], distance;
    } published[] = {{{50.0, 2.6772, -79.7751}, {50.0, 0.0, -82.7485}, 2.0425},
                     {{50.0, 0.0, 0.0}, {50.0, -1.0, 2.0}, 2.3669},
                     {{50.0, 2.5, 0.0}, {73.0, 25.0, -18.0}, 27.1492},
                     {{50.0, 2.5, 0.0}, {50.0, 3.2592, 0.3350}, 1.0000}};
    for (size_t i = 0; i < sizeof published / sizeof published[0]; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, published[i].distance,
                                  ciede2000(published[i].a, published[i].b));
    }
}

static void test_lines_stand_out_on_white_and_dark(void) {
    static const char *const pages[] = {PALETTE_WHITE, PALETTE_DARK};
    double least = 100.0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 21.0, contrast("#000000", "#ffffff"));
    for (int k = 0; k < 2; k++) {
        TEST_ASSERT_TRUE(contrast(PALETTE_FRAME, pages[k]) >= CONTRAST);
        for (int i = 0; i < PALETTE_LINES; i++) {
            const double c = contrast(palette_line(i), pages[k]);
            least = fmin(least, c);
            TEST_ASSERT_TRUE_MESSAGE(c >= CONTRAST, palette_line(i));
        }
    }
    printf("# contrast of lines with white and dark: %.2f at least\n", least);
    /* the yellow that the proof's x_cm once had */
    TEST_ASSERT_TRUE(contrast("#f0e442", PALETTE_WHITE) < 1.4);
}

static double distance(const char *a, const char *b, int k) {
    double one[3];
    double other[3];
    lab_of(a, eye[k], one);
    lab_of(b, eye[k], other);
    return ciede2000(one, other);
}

static void test_colours_are_apart_to_every_eye(void) {
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
    /* red and green of one lightness, which such a test must refuse */
    TEST_ASSERT_TRUE(distance("#c06030", "#7f8030", 2) < APART);
}

static void test_areas_darken_from_good_to_bad(void) {
    for (int k = 0; k < EYES; k++) {
        for (int i = 1; i < PALETTE_AREAS; i++) {
            double one[3];
            double other[3];
            lab_of(palette_area(i - 1), eye[k], one);
            lab_of(palette_area(i), eye[k], other);
            TEST_ASSERT_TRUE_MESSAGE(one[0] > other[0], eye_words[k]);
            TEST_ASSERT_TRUE_MESSAGE(ciede2000(one, other) >= APART, eye_words[k]);
        }
    }
}

/* Points of nine methods: each has another shape, or another colour. */
static void test_lines_that_share_a_colour_differ_otherwise(void) {
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

void suite_palette(void) {
    RUN_TEST(test_the_distance_is_the_published_one);
    RUN_TEST(test_lines_stand_out_on_white_and_dark);
    RUN_TEST(test_colours_are_apart_to_every_eye);
    RUN_TEST(test_areas_darken_from_good_to_bad);
    RUN_TEST(test_lines_that_share_a_colour_differ_otherwise);
}
