/* test_simulated.c: a run from start to end (host/study/simulate.h) in this process. The rows have closed forms. The
 * report is tested for runs that diverge, have an output that ends, or are not trusted. */
#include "test.h"

#include <unistd.h>

#include "command.h"
#include "derived.h"
#include "host/check/finding.h"
#include "host/study/simulate.h"

enum { TEXT = 200000 };

static dice die;
static char folder[60];

static const char *path_of(const char *name) {
    static char path[3][100];
    static int next;
    next = (next + 1) % 3;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static void begin(void) {
    snprintf(folder, sizeof folder, "/tmp/whirl-simulated-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
}

static void end(void) {
    static const char *const names[] = {"r.csv",      "r.csv.toml", "r.txt",
                                        "r.txt.toml", "r.vcd",      "r.svg"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        (void)remove(path_of(names[i]));
    }
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
}

static derived scene_of(const char *text) { return derived_surely(derived_scene(text, "s"), text); }

static unsigned fails; /* findings of the last run, as bits */

static const char *simulated(const image *im, const simulation_settings *s,
                             simulation_result wanted) {
    simulation_trust trust;
    errors_catch();
    const simulation_result result = simulate(im, s, &trust);
    const char *told = errors_caught();
    TEST_ASSERT_EQUAL_INT_MESSAGE(wanted, result, told);
    fails = trust.fails;
    TEST_ASSERT_TRUE((fails != 0) == (strstr(told, "warning") != NULL) ||
                     s->strict != STRICT_FINDINGS);
    return told;
}

static const char *read_file(const char *path) {
    static char text[TEXT];
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    const size_t length = fread(text, 1, sizeof text - 1, in);
    text[length] = '\0';
    fclose(in);
    return text;
}

static int lines_in(const char *text) {
    int lines = 0;
    for (; *text != '\0'; text++) {
        lines += *text == '\n' ? 1 : 0;
    }
    return lines;
}

static const char steady[] =
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\nT = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n"
    "output twice [m] = 2*x\noutput far [km] = 1000*x\n"
    "scene s { start x = %.17g [m], x' = %.17g [m/s], a' = %.17g [rad/s]; step 1 [ms]; until 1 [s] }\n";

/* Expects rows of a motion at constant speed, in which each number is known. `between` and `end` separate columns
 * and rows. */
static void expect_rows(const char *text, const char *header, const char *between, const char *end,
                        const double *start, uint64_t every, uint64_t steps) {
    const char *at = said_exactly(text, header);
    for (uint64_t k = 0; k * every < steps + every; k++) { /* the last state is always recorded */
        const uint64_t step = k * every < steps ? k * every : steps;
        const double t = 1e-3 * (double)step;
        const double x = start[0] + start[1] * t;
        const double deg = 57.29577951308232;
        const double wanted[] = {t,     1e3 * x, deg * start[2] * t, 1e3 * start[1], deg * start[2],
                                 2 * x, x};
        for (int i = 0; i < 7; i++) {
            double number = 0.0;
            at = said_number(i > 0 ? said_exactly(at, between) : at, &number);
            TEST_ASSERT_TRUE(fabs(number - wanted[i]) <= 3e-7 * (1.0 + fabs(wanted[i])));
        }
        at = said_exactly(at, end);
    }
    TEST_ASSERT_EQUAL_STRING("", at);
}

TEST(simulated, rows) {
    begin();
    for (unsigned c = 0; c < dice_cases(usual_or(12, 6)); c++) {
        char text[500];
        const double start[] = {dice_between(&die, -1.0, 1.0), dice_between(&die, -1.0, 1.0),
                                dice_between(&die, -9.0, 9.0)};
        snprintf(text, sizeof text, steady, start[0], start[1], start[2]);
        derived d = scene_of(text);
        const uint64_t every = 1 + dice_one_of(&die, c % 4U == 0 ? 1 : 300);
        const simulation_settings s = {.kind = &engine_double,
                                       .every = every,
                                       .csv = c % 3U != 0 ? path_of("r.csv") : NULL,
                                       .columns = c % 3U != 1 ? path_of("r.txt") : NULL,
                                       .quiet = true};
        TEST_ASSERT_EQUAL_STRING("", simulated(d.image, &s, SIMULATION_DONE));
        if (s.csv != NULL) {
            expect_rows(read_file(path_of("r.csv")),
                        "time,x [mm],a [deg],der(x) [mm/s],der(a) [deg/s],twice,far [km]\r\n", ",",
                        "\r\n", start, every, 1000);
        }
        if (s.columns != NULL) {
            expect_rows(read_file(path_of("r.txt")),
                        "% time x[mm] a[deg] der(x)[mm/s] der(a)[deg/s] twice far[km]\n", " ", "\n",
                        start, every, 1000);
        }
        derived_free(&d);
    }
    end();
}

/* sqrt(c - x) with x = t is undefined from the first step after c. The report must have the number of such records
 * and their first time. If nothing is recorded, the report is about the end. */
TEST(simulated, outputs_that_end) {
    begin();
    for (unsigned c = 0; c < dice_cases(usual_or(20, 8)); c++) {
        char text[500];
        char wanted[400];
        char more[60] = "";
        const unsigned ends = dice_one_of(&die, c % 4U == 0 ? 1200 : 1000); /* ms */
        const bool second = dice_one_of(&die, 2) == 0;
        const bool recorded = c % 3U > 0;
        const uint64_t every = 1 + dice_one_of(&die, c % 2U == 0 ? 1 : 200);
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n%soutput y = sqrt(%.4f - x/(1 [m]))\n"
            "output z = 2\nscene s { start x' = 1 [m/s]; step 1 [ms]; until 1 [s] }\n",
            second ? "output w = 1\n" : "", 1e-3 * (ends + 0.5));
        derived d = scene_of(text);
        const simulation_settings s = {.kind = &engine_double,
                                       .every = every,
                                       .csv = recorded ? path_of("r.csv") : NULL,
                                       .quiet = true};
        uint64_t first = 0;
        unsigned count = 0;
        for (uint64_t k = 0; k * every < 1000 + every; k++) {
            const uint64_t step = k * every < 1000 ? k * every : 1000;
            if (recorded && step > ends) {
                first = count == 0 ? step : first;
                count++;
            }
        }
        if (count == 0 && ends < 1000) { /* if nothing is recorded, the report is about the end */
            first = 1000;
            count = 1;
        }
        if (count > 1) {
            snprintf(more, sizeof more, " (and in %u more records)", count - 1);
        }
        snprintf(
            wanted, sizeof wanted,
            "x.whirl:%d:8: error: at t = %.9g s%s the output 'y' is not a finite number: output y = "
            "sqrt(%.4f - x/(1 [m]))\n",
            second ? 5 : 4, 1e-3 * (double)first, more, 1e-3 * (ends + 0.5));
        const char *told = simulated(d.image, &s, count > 0 ? SIMULATION_FAILED : SIMULATION_DONE);
        if (count > 0) {
            const char *colon = strchr(wanted, ':');
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, colon), told);
            TEST_ASSERT_NOT_NULL(
                strstr(told, "hint: write a formula that is finite in every state of the run\n"));
        } else {
            TEST_ASSERT_EQUAL_STRING("", told);
        }
        derived_free(&d);
    }
    end();
}

/* x' = x^2 diverges at a known time. The message must name the unknown with its primes, and the records must end
 * there. */
TEST(simulated, diverged) {
    begin();
    for (unsigned c = 0; c < dice_cases(usual_or(4, 2)); c++) {
        char text[500];
        char words[60];
        const double t1_s = dice_between(&die, 0.2, 0.7);
        const bool rate = c % 2U == 1;
        /* x'' = 2 x x' is the derivative of x' = x^2; its rate grows first */
        snprintf(
            text, sizeof text,
            rate
                ? "mechanism m\nstate u\nequation u' = 1 [1/s]*0\nstate x\nequation x'' = 2 "
                  "[1/s]*x*x'\nscene s { start x = %.9f, x' = %.9f [1/s]; step 1 [ms]; until 1 [s] }\n"
                : "mechanism m\nstate u\nequation u' = 1 [1/s]*0\nstate x\nequation x' = 1 "
                  "[1/s]*x^2\nscene s { start x = %.9f; step 1 [ms]; until 1 [s] }\n",
            1.0 / t1_s, 1.0 / (t1_s * t1_s));
        derived d = scene_of(text);
        const simulation_settings s = {.kind = c % 3U == 0 ? &engine_float : &engine_double,
                                       .every = 1,
                                       .csv = path_of("r.csv"),
                                       .quiet = true};
        const char *told = simulated(d.image, &s, SIMULATION_FAILED);
        double when_s = 0.0;
        const char *at = said_number(
            said_exactly(told, "whirl run: error: the run diverged in the step after t = "),
            &when_s);
        TEST_ASSERT_TRUE_MESSAGE(when_s >= t1_s - 0.003 && when_s < t1_s + 0.01, told);
        snprintf(words, sizeof words, " s: x%s grew without bound\nhint: try a smaller --step",
                 rate && strstr(told, "x' left") != NULL ? "'" : "");
        (void)said_exactly(at, words);
        const char *rows = read_file(path_of("r.csv"));
        TEST_ASSERT_EQUAL_INT(2 + (int)lround(1e3 * when_s), lines_in(rows));
        derived_free(&d);
    }
    end();
}

SUITE(simulated) { die = dice_of("simulated", 65); }
