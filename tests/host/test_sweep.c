/* test_sweep.c: grids and measures of `whirl sweep`. test_jobs.c tests workers; tests/cli/sweep.sh tests files and
 * whole sweeps. */
#include "caught.h"
#include "command.h"
#include "host/study/grid.h"
#include "host/study/point.h"

#define PI 3.14159265358979323846

static const char sample[] = "mechanism swing\n"
                             "coordinate theta [rad]\n"
                             "parameter m = 2 [kg]\n"
                             "parameter r = 0.3 [m]\n"
                             "input M = 2 [N*m]\n"
                             "T = m*r^2*theta'^2/2\n"
                             "Q(theta) = M\n"
                             "output height [m] = r*(1 - cos(theta))\n"
                             "mechanism decay\n"
                             "state x [m]\n"
                             "parameter k = 1 [1/s]\n"
                             "equation x' + k*x = 0\n";

static diags *heard;
static whirl_model *parsed;
static grid points;

static void open_sample(void) {
    heard = diags_new();
    parsed = model_parse("x.whirl", sample, strlen(sample), heard);
    TEST_ASSERT_NOT_NULL(parsed);
    points = (grid){0};
}

static void close_sample(void) {
    grid_free(&points);
    model_free(parsed);
    diags_free(heard);
}

static bool over(const char *text) { return grid_add(&points, parsed->mechanisms[0], text, heard); }

/* A grid may have up to 1e12 points. An axis that would exceed this number must not be added. */
TEST(sweep, grids_have_an_end) {
    static const char *const axes[][3] = {{"m=1..2:1000000", "r=1..2:1000000", "M=1..2:2"},
                                          {"m=1..2:1000000000", "r=1..2:1000", "M=1..2:1000"},
                                          {"m=1..2:3", "r=1..2:333333333", "M=1..2:1001"}};
    for (size_t i = 0; i < sizeof axes / sizeof axes[0]; i++) {
        open_sample();
        TEST_ASSERT_TRUE_MESSAGE(over(axes[i][0]), axes[i][0]);
        TEST_ASSERT_TRUE_MESSAGE(over(axes[i][1]), axes[i][1]);
        const uint64_t before = points.points;
        TEST_ASSERT_TRUE(before <= GRID_POINTS_MAX && before > GRID_POINTS_MAX / 1001);
        errors_catch();
        const bool taken = over(axes[i][2]);
        const char *told = errors_caught();
        TEST_ASSERT_FALSE_MESSAGE(taken, axes[i][2]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, ": the grid has more than 1e+12 points\n"), told);
        TEST_ASSERT_EQUAL_UINT64(before, points.points);
        TEST_ASSERT_EQUAL_INT(2, points.count);
        close_sample();
    }
}

TEST(sweep, units_and_exact_ends) {
    static const struct {
        const char *text;
        double from, middle, to;
    } cases[] = {{"r=10..70 [mm]:3", 0.01, 0.04, 0.07},
                 {"r=10 [mm]..7 [cm]:3", 0.01, 0.04, 0.07},
                 {"r=10mm..70mm:3", 0.01, 0.04, 0.07},
                 {"r=0..70 mm:3", 0.0, 0.035, 0.07},
                 {" theta' = -60 .. 60 [rpm] : 3", -2.0 * PI, 0.0, 2.0 * PI},
                 {"M=0.1..1000:3,log", 0.1, 10.0, 1000.0},
                 {"M=-0.1..-1000:3,log", -0.1, -10.0, -1000.0},
                 {"step=0.5..1.5 [ms]:3", 0.5e-3, 1e-3, 1.5e-3},
                 {"m=0.1..0.3:3", 0.1, 0.2, 0.3},
                 {"m=1e16..1:3", 1e16, 5e15, 1.0}}; /* 1e16 + (1 - 1e16) rounds to 0 */
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        open_sample();
        TEST_ASSERT_TRUE_MESSAGE(over(cases[i].text), cases[i].text);
        double value[3];
        for (uint64_t k = 0; k < 3; k++) {
            grid_values(&points, k, &value[k]);
        }
        TEST_ASSERT_TRUE_MESSAGE(value[0] == points.axes[0].from, cases[i].text);
        TEST_ASSERT_TRUE_MESSAGE(value[2] == points.axes[0].to, cases[i].text);
        const double most = 1e-15 * fabs(cases[i].to);
        TEST_ASSERT_TRUE_MESSAGE(fabs(value[0] - cases[i].from) <= most, cases[i].text);
        TEST_ASSERT_TRUE_MESSAGE(fabs(value[1] - cases[i].middle) <= most, cases[i].text);
        TEST_ASSERT_TRUE_MESSAGE(fabs(value[2] - cases[i].to) <= most, cases[i].text);
        close_sample();
    }
}

TEST(sweep, numbers_are_read_back) {
    char text[NUMBER_SIZE];
    TEST_ASSERT_EQUAL_STRING("0.1", number_shortest(0.1, text));
    TEST_ASSERT_EQUAL_STRING("0.30000000000000004", number_shortest(0.1 + 0.2, text));
    for (int i = 1; i < 1000; i++) {
        const double value = sin((double)i) * pow(10.0, (double)(i % 40 - 20));
        TEST_ASSERT_TRUE(strtod(number_shortest(value, text), NULL) == value);
    }
}

/* The measure of offset + size sin(2 pi t/period + 1), over `samples` steps of step_s. */
static double of_sine(measure_kind kind, double offset, double size, double period_s,
                      uint64_t samples, double step_s) {
    gauge g = gauge_start(kind);
    for (uint64_t i = 0; i < samples; i++) {
        gauge_enter(&g, offset + size * sin(2.0 * PI * (double)i * step_s / period_s + 1.0));
    }
    const double result = gauge_result(&g, step_s, DBL_EPSILON);
    gauge_end(&g);
    return result;
}

TEST(sweep, series_of_a_sine) {
    /* ten periods of 200 steps: a sampled peak misses the true one by up to size (2 pi/200)^2/8 */
    const double miss = 2.5 * pow(2.0 * PI / 200.0, 2.0) / 8.0;
    TEST_ASSERT_TRUE(fabs(of_sine(MEASURE_MAX, 1.5, 2.5, 0.2, 2001, 1e-3) - 4.0) <= miss);
    TEST_ASSERT_TRUE(fabs(of_sine(MEASURE_MIN, 1.5, 2.5, 0.2, 2001, 1e-3) + 1.0) <= miss);
    TEST_ASSERT_TRUE(fabs(of_sine(MEASURE_AMPLITUDE, 1.5, 2.5, 0.2, 2001, 1e-3) - 2.5) <= miss);
    TEST_ASSERT_TRUE(fabs(of_sine(MEASURE_MEAN, 1.5, 2.5, 0.2, 2001, 1e-3) - 1.5) <= 1e-13);
    TEST_ASSERT_TRUE(fabs(of_sine(MEASURE_PERIOD, 1.5, 2.5, 0.2, 2001, 1e-3) - 0.2) <= 1e-13);
    /* a period of not a whole number of steps: linear interpolation errs by less than 1e-3 steps, divided by 18
     * periods */
    const double odd_s = 0.1 * sqrt(1.23);
    const double measured_s = of_sine(MEASURE_PERIOD, 0.0, 1.0, odd_s, 2001, 1e-3);
    TEST_ASSERT_TRUE(fabs(measured_s - odd_s) <= 2e-3 * 1e-3);
    TEST_ASSERT_TRUE(isfinite(measured_s) && measured_s != odd_s);
}

TEST(sweep, series_without_a_value) {
    TEST_ASSERT_TRUE(isnan(of_sine(MEASURE_PERIOD, 0.0, 1.0, 0.2, 250, 1e-3))); /* 1 period */
    TEST_ASSERT_FALSE(isnan(of_sine(MEASURE_PERIOD, 0.0, 1.0, 0.2, 500, 1e-3)));
    /* with this size, only round-off varies */
    TEST_ASSERT_TRUE(isnan(of_sine(MEASURE_PERIOD, 1.0, 1e-15, 0.2, 2001, 1e-3)));
    TEST_ASSERT_TRUE(isnan(of_sine(MEASURE_MEAN, 0.0, 1.0, 0.2, 0, 1e-3)));
    TEST_ASSERT_TRUE(of_sine(MEASURE_MEAN, 2.0, 0.0, 0.2, 1, 1e-3) == 2.0);
    for (measure_kind kind = MEASURE_FINAL; kind <= MEASURE_PERIOD; kind++) {
        gauge g = gauge_start(kind);
        gauge_enter(&g, 1.0);
        gauge_enter(&g, (double)NAN);
        gauge_enter(&g, 2.0);
        TEST_ASSERT_TRUE(isnan(gauge_result(&g, 1e-3, DBL_EPSILON)));
        gauge_end(&g);
    }
}

TEST(sweep, measures_are_read) {
    static const struct {
        const char *text;
        int mechanism;
        int kind; /* kind of measure; -1: refused */
    } cases[] = {{"theta", 0, MEASURE_FINAL},
                 {"max(theta)", 0, MEASURE_MAX},
                 {" min ( height + r ) ", 0, MEASURE_MIN},
                 {"max(theta, m/2[kg])", 0, MEASURE_FINAL},
                 {"max(max(theta, 1))", 0, MEASURE_MAX},
                 {"amplitude(sin(theta)*theta'')", 0, MEASURE_AMPLITUDE},
                 {"mean((theta)*(M))", 0, MEASURE_MEAN},
                 {"period(x')", 1, MEASURE_PERIOD},
                 {"(theta)*(theta)", 0, MEASURE_FINAL},
                 {"period(x'')", 1, -1}, /* refused: the equation has x' only */
                 {"theta'''", 0, -1},
                 {"2*amplitude(theta)", 0, -1},
                 {"mean(theta) theta", 0, -1},
                 {"max(theta)*max(theta)", 0, -1},
                 {"theta + r", 0, -1}, /* refused: an angle and a length */
                 {"heigth", 0, -1},
                 {"mean(theta", 0, -1},
                 {"", 0, -1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        open_sample();
        measures *m =
            measures_new(parsed->mechanisms[cases[i].mechanism], &cases[i].text, 1, heard);
        TEST_ASSERT_TRUE_MESSAGE((m != NULL) == (cases[i].kind >= 0), cases[i].text);
        TEST_ASSERT_TRUE_MESSAGE((m == NULL) == (diags_count(heard) > 0), cases[i].text);
        if (m != NULL) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].kind, (int)m->list[0].kind, cases[i].text);
            TEST_ASSERT_EQUAL_INT(1, m->mechanism.output_count);
        }
        measures_free(m);
        close_sample();
    }
}

/* Expects a refusal that begins with this message. Returns all messages; the caller frees them. */
static char *expect_wrong(const char *text, const char *wanted) {
    caught told;
    open_sample();
    TEST_ASSERT_NULL(measures_new(parsed->mechanisms[0], &text, 1, heard));
    diags_flush(heard, catch_text(&told));
    alloc_text_end(told.to);
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told.text, strlen(wanted));
    close_sample();
    return told.text;
}

/* A measure inside an expression must be reported with its place. A longer name that begins like a measure is only a
 * name. */
TEST(sweep, nested_measures_are_reported) {
    static const char *const words[] = {"amplitude", "mean", "period"};
    static const char *const before[] = {"2*", "theta + ", "1/(3*", "sin(2) - ", "theta*mean_2 + "};
    for (unsigned c = 0; c < 15U; c++) {
        char text[100];
        char wanted[200];
        const char *word = words[c % 3U];
        snprintf(text, sizeof text, "%s%s%s(theta)%s", before[c / 3U], word, c % 2U == 0 ? "" : " ",
                 c / 3U == 2 ? ")" : "");
        snprintf(wanted, sizeof wanted,
                 "<measure>:1:%d: error: %s() must stand around the whole expression of a "
                 "measure\n",
                 (int)strlen(before[c / 3U]) + 1, word);
        char *told = expect_wrong(text, wanted);
        TEST_ASSERT_NULL_MESSAGE(strstr(told + strlen(wanted), "error:"), told);
        TEST_ASSERT_NOT_NULL(
            strstr(told, "hint: use this measure alone, and compute with its column afterwards\n"));
        free(told);
    }
}

TEST(sweep, lists_of_measures_are_reported) {
    static const char *const one[] = {"theta",       "max(theta)",        "mean(2*theta)",
                                      "theta*theta", "atan2(theta, 2)",   "max(theta, 1)",
                                      "min(theta)",  "max(max(theta, 1))"};
    const unsigned count = sizeof one / sizeof one[0];
    for (unsigned c = 0; c < count * count; c++) {
        char text[100];
        char wanted[60];
        snprintf(text, sizeof text, "%s%s%s", one[c / count], c % 2U == 0 ? "," : " , ",
                 one[c % count]);
        snprintf(wanted, sizeof wanted, "<measure>:1:%d: error: one measure at a time\n",
                 (int)strlen(one[c / count]) + 1 + (int)(c % 2U));
        free(expect_wrong(text, wanted));
    }
    for (unsigned c = 0; c < count; c++) {
        open_sample();
        measures *m = measures_new(parsed->mechanisms[0], &one[c], 1, heard);
        TEST_ASSERT_TRUE_MESSAGE(m != NULL, one[c]);
        measures_free(m);
        close_sample();
    }
}
