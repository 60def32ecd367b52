/* test_sweeps_told.c: what a whole sweep says and leaves: its rows, which points failed, overran their events, turned too
 * slowly or cannot be believed, and the first of each, of grids in which that is known of every point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "host/base/exit.h"
#include "host/base/interrupts.h"
#include "made_sweep.h"
#include "unity.h"

void suite_sweeps_told(void);

static dice die;

/* Where the point's row begins; a header stands in front of the first. */
static size_t row_at(const char *rows, uint64_t row) {
    const char *at = rows;
    for (uint64_t i = 0; i <= row; i++) {
        at = strchr(at, '\n') + 1;
    }
    return (size_t)(at - rows);
}

static unsigned times_in(const char *text, const char *words) {
    unsigned times = 0;
    for (const char *at = strstr(text, words); at != NULL; at = strstr(at + 1, words)) {
        times++;
    }
    return times;
}

/* --- points that fail --------------------------------------------------------------------------------------------*/

/* The end of all that is said: how many, of them how many there were, by how many workers. */
static void expect_end(const char *err, uint64_t points, uint64_t found, int workers) {
    char wanted[300];
    const int length = snprintf(wanted, sizeof wanted, "%llu points", (unsigned long long)points);
    const char *at = strstr(err, wanted);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, err);
    while (at != err && at[-1] != '\n') { /* "3 of 7 points failed" */
        at = strstr(at + 1, wanted);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, err);
    }
    at += length;
    if (found > 0) {
        snprintf(wanted, sizeof wanted, ", %llu of them found in %s", (unsigned long long)found,
                 sessions_path());
        at = said_exactly(at, wanted);
    }
    if (found < points) {
        double seconds = 0.0;
        double rate = 0.0;
        at = said_number(said_exactly(at, "; "), &seconds);
        at = said_number(said_exactly(at, " s, "), &rate);
        snprintf(wanted, sizeof wanted, " points/s with --jobs %d", workers);
        at = said_exactly(at, wanted);
        TEST_ASSERT_TRUE(seconds > 0.0 && seconds < 60.0);
        TEST_ASSERT_TRUE(fabs(seconds * rate / (double)(points - found) - 1.0) < 0.012);
    }
    TEST_ASSERT_EQUAL_STRING("\n", at);
}

/* A start below the floor fails, whichever point it is of: each of the first twenty is told, in order, then that there are
 * more, and in the end how many; a file that is gone on with counts those that it has, too. */
static void test_failures(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(8, 4)); c++) {
        made_sweep m;
        char over[2][80];
        const char *const axes[] = {over[0], over[1]};
        const char *const asked[] = {"x"};
        const unsigned below = 1 + dice_one_of(&die, 9);
        const unsigned above = 1 + dice_one_of(&die, 5);
        const unsigned lines = c == 0 ? 1 : 1 + dice_one_of(&die, 5);
        const unsigned columns = below + above;
        const uint64_t points = (uint64_t)lines * columns;
        const uint64_t first = c % 3U == 2 ? dice_one_of(&die, (unsigned)points) : 0;
        const int most = 1 + (int)dice_one_of(&die, 6);
        const uint64_t rows = points - first;
        snprintf(over[0], sizeof over[0], "y=%s:%u", lines == 1 ? "7..7" : "1..9", lines);
        snprintf(over[1], sizeof over[1], "x=%d..%u:%u", -(int)below, above - 1, columns);
        made_sweep_open(&m, made_sweep_floor, axes, 2, asked, 1, &engine_double);
        session_settings settings = {.first = first, .end = points, .header = true, .jobs = most};
        sessions_open();
        session_said s = sessions_sit(&m, settings);
        unsigned failed = 0;
        for (uint64_t i = first; i < points; i++) {
            const unsigned column = (unsigned)(i % columns);
            const uint64_t row = i / columns;
            if (column < below && ++failed <= 20) {
                char wanted[200];
                char y[NUMBER_SIZE];
                const double line = lines == 1 ? 7.0 : 1.0 + 8.0 * (double)row / (lines - 1.0);
                snprintf(wanted, sizeof wanted,
                         "whirl sweep: error: point %u (y=%s, x=%d): the run starts beyond this "
                         "stop, by %u m",
                         (unsigned)i + 1, number_shortest(line, y), (int)column - (int)below,
                         below - column);
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(s.err, wanted), s.err);
            }
        }
        TEST_ASSERT_EQUAL_UINT(failed < 20 ? failed : 20, times_in(s.err, "error: point "));
        TEST_ASSERT_EQUAL_UINT(
            failed > 20 ? 1 : 0,
            times_in(s.err, "\nfurther failures are not listed: their measures are empty\n"));
        char wanted[200];
        snprintf(wanted, sizeof wanted,
                 "whirl sweep: error: %u of %u points failed: their measures are empty\n", failed,
                 (unsigned)rows);
        TEST_ASSERT_EQUAL_UINT(failed > 0 ? 1 : 0, times_in(s.err, wanted));
        TEST_ASSERT_EQUAL_INT(failed > 0 ? EXIT_RUN_FAILED : EXIT_DONE, s.code);
        expect_end(s.err, rows, 0, (uint64_t)most < rows ? most : (int)rows);
        TEST_ASSERT_EQUAL_STRING_LEN("start(y),start(x),x,energy_left_over\r\n", s.rows, 38);

        const uint64_t kept = c % 2U == 0 ? rows : dice_one_of(&die, (unsigned)rows + 1U);
        sessions_cut(kept < rows ? row_at(s.rows, kept) : strlen(s.rows));
        settings.quiet = c % 4U == 3;
        const session_said again = sessions_sit(&m, settings);
        TEST_ASSERT_EQUAL_STRING(s.rows, again.rows);
        TEST_ASSERT_EQUAL_INT(s.code, again.code);
        TEST_ASSERT_EQUAL_UINT(failed > 0 ? 1 : 0, times_in(again.err, wanted));
        if (!settings.quiet) {
            const uint64_t rest = rows - kept;
            expect_end(again.err, rows, kept, (uint64_t)most < rest ? most : (int)rest);
        } else {
            TEST_ASSERT_NULL_MESSAGE(strstr(again.err, "points/s"), again.err);
        }
        made_sweep_close(&m);
    }
    sessions_close();
}

/* --- points of which more is to be told --------------------------------------------------------------------------*/

/* A ball between stops a millimetre apart bounces v times a millisecond: from 8 m/s on more often than a step takes. It then
 * rests: one step of each. Beside it an angle turns, too slowly for float or not. */
static const char between_text[] =
    "mechanism m\ncoordinate z [m]\ncoordinate a [rad]\nT = 1 [kg]*z'^2/2 + 1 [kg*m^2]*a'^2/2\n"
    "stop z >= 0 [mm] restitution 1\nstop z <= 1 [mm] restitution 1\n"
    "scene s { start z = 0.5 [mm]; step 1 [ms]; until 0.05 [s] }\n";

static void expect_note(const char *err, const char *begin, unsigned count, unsigned ran,
                        const char *middle, unsigned first, const char *at) {
    char wanted[300];
    snprintf(wanted, sizeof wanted, "%s%u of %u points ", begin, count, ran);
    const char *note = strstr(err, wanted);
    TEST_ASSERT_EQUAL_MESSAGE(count > 0, note != NULL, err);
    if (note != NULL) {
        snprintf(wanted, sizeof wanted, "%sfirst: point %u (%s)\nhint: ", middle, first + 1, at);
        note = strstr(note, wanted);
        TEST_ASSERT_NOT_NULL_MESSAGE(note, err);
    }
}

static void test_notes(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        made_sweep m;
        char over[60];
        const char *const axes[] = {over, "a'=1e-7..1:2"};
        const char *const reversed[] = {over, "a'=1..1e-7:2"};
        const char *const asked[] = {"z", "a"};
        const bool is_float = c % 2U == 0;
        const bool slow_first = c % 3U != 0;
        const unsigned count = 1 + dice_one_of(&die, 5);
        const double from = c % 2U == 0 ? 3.0 : dice_between(&die, 11.0, 20.0);
        /* 3, 13, ...: all but one bounce too often; or all do; or none of them */
        const double to = count == 1    ? from
                          : c % 3U == 0 ? from + 1.0
                                        : from + 10.0 * (count - 1.0);
        snprintf(over, sizeof over, "z'=%.17g..%.17g:%u", from, to, count);
        made_sweep_open(&m, between_text, slow_first ? axes : reversed, 2, asked, 2,
                        is_float ? &engine_float : &engine_double);
        unsigned overran = 0;
        unsigned first_overrun = 0;
        char first_at[2][100];
        const unsigned points = 2 * count;
        unsigned slow = 0;
        unsigned first_slow = 0;
        for (unsigned i = 0; i < points; i++) {
            double value[2];
            char text[NUMBER_SIZE];
            char at[100];
            grid_values(&m.grid, i, value);
            snprintf(at, sizeof at, "z'=%s, a'=%s", number_shortest(value[0], text),
                     value[1] == 1.0 ? "1" : "1e-07");
            TEST_ASSERT_TRUE(value[0] < 7.0 || value[0] > 9.0);
            if (value[0] > 8.0 && overran++ == 0) {
                first_overrun = i;
                snprintf(first_at[0], sizeof first_at[0], "%s", at);
            }
            if (is_float && value[1] != 1.0 && slow++ == 0) {
                first_slow = i;
                snprintf(first_at[1], sizeof first_at[1], "%s", at);
            }
        }
        const session_settings settings = {.end = points, .header = true, .jobs = 2, .quiet = true};
        sessions_open();
        const session_said s = sessions_sit(&m, settings);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(s.err), s.code, s.err);
        expect_note(s.err, "whirl sweep: warning: ", overran, points,
                    "had steps with more events than a step takes [events]; ", first_overrun,
                    first_at[0]);
        expect_note(s.err, "whirl sweep: note: ", slow, points,
                    "have a component that moves too slowly for the units of its steps [digits]; ",
                    first_slow, first_at[1]);
        made_sweep_close(&m);
    }
    sessions_close();
}

/* A spring by Runge-Kutta 4 keeps |1 - (hw)^6/72 + (hw)^8/576| of its energy a step: nearly all of a soft one's in a
 * hundred steps, nothing of a hard one's. */
static void test_not_believed(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        made_sweep m;
        static const char text[] =
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
            "V = 1 [N/m]*x^2/2\nscene s { start x = 1 [m]; step 1 [ms]; until 40 [s] }\n";
        char over[60];
        const char *const axes[] = {over};
        const char *const asked[] = {"x"};
        const double fine_s = dice_between(&die, 0.01, 0.05);
        const double coarse_s = dice_between(&die, 1.0, 1.8);
        const bool fine_first = c % 2U == 0;
        snprintf(over, sizeof over, "step=%.3g..%.3g:2", fine_first ? fine_s : coarse_s,
                 fine_first ? coarse_s : fine_s);
        made_sweep_open(&m, text, axes, 1, asked, 1, &engine_double);
        const session_settings settings = {.end = 2, .jobs = 2, .quiet = true};
        sessions_open();
        const session_said s = sessions_sit(&m, settings);
        char at[60];
        double value[1];
        char number[NUMBER_SIZE];
        grid_values(&m.grid, fine_first ? 1 : 0, value);
        snprintf(at, sizeof at, "step=%s", number_shortest(value[0], number));
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(s.err), s.code, s.err);
        expect_note(s.err, "whirl sweep: warning: ", 1, 2,
                    "cannot be believed: too much of the largest entry of their energy books is "
                    "left over (energy_left_over), or was missing on the way [energy]; ",
                    fine_first ? 1 : 0, at);
        TEST_ASSERT_TRUE(times_in(s.err, "hint: `whirl run` of the point tells what would do\n") >=
                         1);
        made_sweep_close(&m);
    }
    sessions_close();
}

/* --- stopped, and lost -------------------------------------------------------------------------------------------*/

/* Told to end before anything: what there is stays, and how it goes on is said. */
static void test_stopped(void) {
    made_sweep m;
    const char *const axes[] = {"x=1..9:9"};
    const char *const asked[] = {"x"};
    made_sweep_open(&m, made_sweep_floor, axes, 1, asked, 1, &engine_double);
    session_settings settings = {.end = 9, .header = true, .jobs = 1, .quiet = true};
    sessions_open();
    const session_said whole = sessions_sit(&m, settings);
    for (unsigned kept = 0; kept < 9U; kept++) {
        unsigned rows = 0;
        sessions_cut(row_at(whole.rows, kept));
        interrupted = 1;
        const session_said s = sessions_sit(&m, settings);
        interrupted = 0;
        for (const char *at = strchr(s.rows, '\n'); at != NULL; at = strchr(at + 1, '\n')) {
            rows += at[1] != '\0' ? 1 : 0;
        }
        if (rows == 9) { /* it was done first */
            TEST_ASSERT_EQUAL_INT(EXIT_DONE, s.code);
            continue;
        }
        char wanted[200];
        snprintf(wanted, sizeof wanted,
                 "whirl sweep: interrupted after %u of 9 points; their rows are kept\n"
                 "hint: the same command goes on from there\n",
                 rows);
        TEST_ASSERT_EQUAL_STRING(wanted, s.err);
        TEST_ASSERT_EQUAL_INT(EXIT_INTERRUPTED, s.code);
        TEST_ASSERT_TRUE(rows >= kept);
        const session_said on = sessions_sit(&m, settings);
        TEST_ASSERT_EQUAL_STRING(whole.rows, on.rows);
    }
    made_sweep_close(&m);
    sessions_close();
}

static void test_given_back(void) {
    static void (*const rounds[])(void) = {test_failures, test_notes, test_stopped};
    for (size_t i = 0; i < sizeof rounds / sizeof rounds[0]; i++) {
        const long before = blocks_in_use();
        rounds[i]();
        TEST_ASSERT_TRUE(blocks_in_use() == before);
    }
}

void suite_sweeps_told(void) {
    die = dice_of("sweeps_told", 62);
    RUN_TEST(test_failures);
    RUN_TEST(test_notes);
    RUN_TEST(test_not_believed);
    RUN_TEST(test_stopped);
    RUN_TEST(test_given_back);
}
