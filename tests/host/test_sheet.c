/* test_sheet.c: a sweep's CSV file (host/study/resumable_csv.h): begun, gone on with wherever it was torn off, begun anew, and refused
 * where it is another's, which leaves it as it was; drawn, against what the test writes itself. */
#define _POSIX_C_SOURCE 200809L

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "command.h"
#include "host/base/alloc.h"
#include "host/base/exit.h"
#include "host/study/resumable_csv.h"
#include "unity.h"

void suite_sheet(void);

enum { ROWS_MOST = 12, TEXT = 2000, PATH = 120 };

static const char fingerprint[] = "scene: s\nover: m=1..3:7\nmeasure: X\n";

static dice die;
static char folder[80];
static char path[PATH];
static char path_beside[PATH + 20];

/* A sweep, and its file when it is whole. */
typedef struct drawn_sheet {
    resumable_csv_settings settings;
    char whole[TEXT];
    size_t end[ROWS_MOST + 1]; /* of the header, then of each row */
    bool failed[ROWS_MOST];
} drawn_sheet;

static drawn_sheet d;

/* What is swept: two numbers of the row. */
static void put_swept(const void *context, uint64_t row, FILE *out) {
    TEST_ASSERT_EQUAL_PTR(&d, context);
    fprintf(out, "%u,0.%u", (unsigned)row / 3U + 1U, (unsigned)row % 3U);
}

static void add(const char *words) {
    TEST_ASSERT_TRUE(strlen(d.whole) + strlen(words) < TEXT);
    strcat(d.whole, words);
}

static void draw_sheet(void) {
    static const char *const numbers[] = {"1", "-2.5e-07", "nan", "0.125", "-inf", "3e+20"};
    d = (drawn_sheet){.settings = {.path = path,
                                   .fingerprint = fingerprint,
                                   .header = dice_one_of(&die, 2) == 0 ? "" : "m,r,X,Y\r\n",
                                   .rows = 1 + dice_one_of(&die, ROWS_MOST),
                                   .measures = 1 + (int)dice_one_of(&die, 3),
                                   .swept = put_swept,
                                   .context = &d}};
    add(d.settings.header);
    d.end[0] = strlen(d.whole);
    for (unsigned row = 0; row < d.settings.rows; row++) {
        char swept[40];
        d.failed[row] = dice_one_of(&die, 4) == 0;
        snprintf(swept, sizeof swept, "%u,0.%u", row / 3U + 1U, row % 3U);
        add(swept);
        for (int i = 0; i < d.settings.measures; i++) {
            add(",");
            add(d.failed[row] ? "" : numbers[dice_one_of(&die, 6)]);
        }
        add("\r\n");
        d.end[row + 1] = strlen(d.whole);
    }
}

static void put_file(const char *name, const char *text, size_t length) {
    FILE *out = fopen(name, "wb");
    TEST_ASSERT_TRUE(out != NULL && fwrite(text, 1, length, out) == length && fclose(out) == 0);
}

static void expect_file(const char *name, const char *text, size_t length) {
    char there[TEXT];
    FILE *in = fopen(name, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, name);
    TEST_ASSERT_EQUAL_size_t(length, fread(there, 1, sizeof there, in));
    TEST_ASSERT_TRUE(memcmp(text, there, length) == 0);
    fclose(in);
}

static bool exists(const char *name) { return access(name, F_OK) == 0; }

/* The file is there, as far as `length`, with what belongs beside it. */
static void leave(size_t length) {
    put_file(path, d.whole, length);
    put_file(path_beside, fingerprint, strlen(fingerprint));
}

/* Opens it, writes the rows that are missing, and closes it: then it is whole. */
static void expect_gone_on(unsigned rows) {
    resumable_csv sh;
    unsigned failed = 0;
    for (unsigned i = 0; i < rows; i++) {
        failed += d.failed[i] ? 1 : 0;
    }
    errors_catch();
    const int code = resumable_csv_open(&sh, &d.settings);
    TEST_ASSERT_EQUAL_STRING("", errors_caught());
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, code);
    TEST_ASSERT_TRUE(sh.out != NULL && sh.is_file);
    TEST_ASSERT_EQUAL_UINT64(rows, sh.rows);
    TEST_ASSERT_EQUAL_UINT64(failed, sh.failed);
    expect_file(path, d.whole, d.end[rows]); /* what was torn off is gone, and the header there */
    expect_file(path_beside, fingerprint, strlen(fingerprint));
    fputs(d.whole + d.end[rows], sh.out);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    TEST_ASSERT_TRUE(resumable_csv_close(&sh)); /* again: nothing */
    expect_file(path, d.whole, strlen(d.whole));
}

/* It is refused so, and is as it was. */
static void expect_refused(const char *text, size_t length, const char *beside, const char *why) {
    resumable_csv sh;
    char wanted[300];
    put_file(path, text, length);
    (void)remove(path_beside);
    if (beside != NULL) {
        put_file(path_beside, beside, strlen(beside));
    }
    errors_catch();
    const int code = resumable_csv_open(&sh, &d.settings);
    snprintf(wanted, sizeof wanted,
             "%s: error: %s\nhint: another --csv keeps it; --fresh overwrites it\n", path, why);
    const char *told = errors_caught();
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told, strlen(wanted));
    TEST_ASSERT_NULL_MESSAGE(strstr(told + strlen(wanted), "error:"), told); /* once */
    TEST_ASSERT_EQUAL_INT(EXIT_BAD_INPUT, code);
    TEST_ASSERT_NULL(sh.out);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    expect_file(path, text, length);
    TEST_ASSERT_EQUAL(beside != NULL, exists(path_beside));
}

static void open_folder(void) {
    snprintf(folder, sizeof folder, "/tmp/whirl-sheet-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/s.csv", folder);
    snprintf(path_beside, sizeof path_beside, "%s.sweep", path);
}

static void close_folder(void) {
    (void)remove(path);
    (void)remove(path_beside);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, rmdir(folder), "something else was left there");
}

/* Nothing there, or an empty file of anybody's. */
static void test_begun(void) {
    open_folder();
    for (int c = 0; c < 8; c++) {
        draw_sheet();
        (void)remove(path);
        (void)remove(path_beside);
        if (c % 2 == 0) {
            put_file(path, "", 0);
        }
        expect_gone_on(0);
    }
    close_folder();
}

/* Torn off anywhere, and about a line's end most of all. */
static void test_gone_on_with(void) {
    open_folder();
    for (unsigned c = 0; c < dice_cases(usual_or(5, 3)); c++) {
        draw_sheet();
        unsigned rows = 0;
        for (size_t length = 0; length <= strlen(d.whole); length++) {
            const char *at = d.whole + length; /* where it is torn off */
            const bool ends = strchr("\r\n", *at) != NULL || (length > 0 && at[-1] == '\n');
            if (dice_one_of(&die, ends ? 3 : 25) > 0) {
                continue;
            }
            while (rows < d.settings.rows && d.end[rows + 1] <= length) {
                rows++;
            }
            leave(length);
            expect_gone_on(rows);
        }
    }
    close_folder();
}

static void test_fresh(void) {
    open_folder();
    for (int c = 0; c < 6; c++) {
        draw_sheet();
        d.settings.fresh = true;
        put_file(path, "anything\n", 9);
        put_file(path_beside, "another: sweep\n", 15);
        expect_gone_on(0);
        leave(strlen(d.whole));
        expect_gone_on(0);
    }
    close_folder();
}

/* A byte of a row is another one: it is not this sweep's, whichever row it is. */
static void test_rows_of_others(void) {
    open_folder();
    for (unsigned c = 0; c < dice_cases(usual_or(40, 20)); c++) {
        char text[TEXT];
        char why[60];
        draw_sheet();
        snprintf(text, sizeof text, "%s", d.whole);
        const unsigned row = dice_one_of(&die, (unsigned)d.settings.rows);
        char *at = text + d.end[row];
        const size_t size = d.end[row + 1] - d.end[row];
        const size_t swept = strcspn(strchr(at, ',') + 1, ",") + (size_t)(strchr(at, ',') + 1 - at);
        switch (c % 5) {
        case 0: at[dice_one_of(&die, (unsigned)swept)] = 'x'; break;
        case 1:
            at[swept + dice_one_of(&die, (unsigned)(size - swept - 2))] =
                "x \0\""[dice_one_of(&die, 4)];
            break;
        case 2: at[swept] = ';'; break;
        case 3: /* a field more */
            memmove(at + swept + 1, at + swept, strlen(at + swept) + 1);
            break;
        default: /* a row more */
            snprintf(at, sizeof text - d.end[row], "%s", d.whole + d.end[row]);
            snprintf(text + strlen(text), 40, "%u,0.%u,1\r\n", (unsigned)d.settings.rows / 3U + 1U,
                     (unsigned)d.settings.rows % 3U);
        }
        snprintf(why, sizeof why, "its row %u is not this sweep's",
                 c % 5 == 4 ? (unsigned)d.settings.rows + 1U : row + 1U);
        const size_t length = strlen(d.whole) + (c % 5 == 3   ? 1
                                                 : c % 5 == 4 ? strlen(text + strlen(d.whole))
                                                              : 0);
        expect_refused(text, length, fingerprint, why);
    }
    close_folder();
}

/* A field less: where there are some. */
static void test_too_few_fields(void) {
    open_folder();
    for (unsigned c = 0; c < dice_cases(usual_or(20, 10)); c++) {
        draw_sheet();
        d.settings.measures++;
        expect_refused(d.whole, strlen(d.whole), fingerprint, "its row 1 is not this sweep's");
    }
    close_folder();
}

static void test_settings_of_others(void) {
    static const char *const others[] = {"scene: t\nover: m=1..3:7\nmeasure: X\n",
                                         "scene: s\nover: m=1..3:8\nmeasure: X\n",
                                         "scene: s\nover: m=1..3:7\n",
                                         "scene: s\nover: m=1..3:7\nmeasure: X\nmore\n",
                                         "scene: s\nover: m=1..3:7\nmeasure: XY\n",
                                         ""};
    static const char *const there[] = {"scene: t", "over: m=1..3:8", "",
                                        "more",     "measure: XY",    ""};
    static const char *const here[] = {"scene: s", "over: m=1..3:7", "measure: X",
                                       "",         "measure: X",     "scene: s"};
    open_folder();
    for (int i = 0; i < 6; i++) {
        char wanted[200];
        resumable_csv sh;
        draw_sheet();
        expect_refused(d.whole, strlen(d.whole), others[i], "it belongs to another sweep");
        errors_catch();
        (void)resumable_csv_open(&sh, &d.settings);
        snprintf(wanted, sizeof wanted, "  there: %s\n  here:  %s\n", there[i], here[i]);
        const char *told = errors_caught();
        TEST_ASSERT_EQUAL_STRING(wanted, strstr(told, "  there:"));
    }
    draw_sheet();
    expect_refused(d.whole, strlen(d.whole), NULL,
                   "it is no sweep's: there is no FILE.sweep beside it");
    for (unsigned c = 0; c < 6U; c++) { /* alone, with its own rows, with other rows */
        draw_sheet();
        d.settings.header = "m,r,X,Z\r\n";
        char other[sizeof d.whole + 40] = "m,r,X,Y\r\n";
        const size_t rows = d.end[d.settings.rows] - d.end[0];
        memcpy(other + strlen(other), d.whole + d.end[0], c % 3U == 1U ? rows : 0);
        strcat(other, c % 3U == 2U ? "9,9,9,9,9\r\n" : "");
        expect_refused(other, strlen(other), fingerprint, "its header is another sweep's");
    }
    close_folder();
}

/* While one writes it nobody else can: a process of its own tries. */
static void test_locked(void) {
    resumable_csv sh;
    open_folder();
    draw_sheet();
    errors_catch();
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, resumable_csv_open(&sh, &d.settings));
    fflush(NULL);
    const pid_t child = fork();
    TEST_ASSERT_TRUE(child >= 0);
    if (child == 0) {
        resumable_csv other;
        const int code = resumable_csv_open(&other, &d.settings);
        fflush(stderr);
        _exit(code == EXIT_BAD_INPUT && other.out == NULL ? 0 : 1);
    }
    int status = -1;
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    const char *told = errors_caught();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, ": error: another sweep is writing it\n"), told);
    TEST_ASSERT_EQUAL_INT(0, status);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    close_folder();
}

/* Where nothing can be written: no such folder; a device that is full, at once or at the end. */
static void test_not_written(void) {
    resumable_csv sh;
    open_folder();
    draw_sheet();
    d.settings.path = "/nowhere/at all/s.csv";
    errors_catch();
    int code = resumable_csv_open(&sh, &d.settings);
    const char *told = errors_caught();
    TEST_ASSERT_EQUAL_INT(EXIT_BAD_INPUT, code);
    TEST_ASSERT_TRUE(sh.out == NULL && strstr(told, "/nowhere/at all/s.csv") != NULL);
    d.settings.path = folder; /* no file, and none can be */
    errors_catch();
    code = resumable_csv_open(&sh, &d.settings);
    told = errors_caught();
    TEST_ASSERT_TRUE(code == EXIT_RUN_FAILED && sh.out == NULL && strstr(told, folder) != NULL);
    if (exists("/dev/full")) {
        d.settings.path = "/dev/full";
        errors_catch();
        code = resumable_csv_open(&sh, &d.settings);
        const bool opened = code == EXIT_DONE && sh.out != NULL && !sh.is_file;
        const bool put = opened && fputs("1,2,3\r\n", sh.out) >= 0;
        const bool closed = resumable_csv_close(&sh);
        told = errors_caught();
        TEST_ASSERT_TRUE(opened && put && !closed && strstr(told, "/dev/full") != NULL);
    }
    /* what belongs beside it cannot be put there: a folder is */
    d.settings.path = path;
    TEST_ASSERT_EQUAL_INT(0, mkdir(path_beside, 0777));
    errors_catch();
    code = resumable_csv_open(&sh, &d.settings);
    told = errors_caught();
    TEST_ASSERT_TRUE(code == EXIT_RUN_FAILED && sh.out == NULL &&
                     strstr(told, path_beside) != NULL);
    char fresh[PATH + 40];
    snprintf(fresh, sizeof fresh, "%s.new", path_beside);
    (void)remove(fresh);
    TEST_ASSERT_EQUAL_INT(0, rmdir(path_beside));
    close_folder();
}

/* What cannot be gone on with is written as it comes: a device. */
static void test_no_file(void) {
    resumable_csv sh;
    draw_sheet();
    d.settings.path = "/dev/null";
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, resumable_csv_open(&sh, &d.settings));
    TEST_ASSERT_TRUE(!sh.is_file && sh.out != NULL && sh.out != stdout && sh.rows == 0);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    TEST_ASSERT_NULL(sh.out);
    TEST_ASSERT_FALSE(exists("/dev/null.sweep"));
    d.settings.path = "-";
    d.settings.header = "";
    TEST_ASSERT_EQUAL_INT(EXIT_DONE, resumable_csv_open(&sh, &d.settings));
    TEST_ASSERT_TRUE(!sh.is_file && sh.out == stdout);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    TEST_ASSERT_TRUE(sh.out == NULL && fileno(stdout) >= 0);
    TEST_ASSERT_FALSE(exists("-.sweep"));
}

void suite_sheet(void) {
    die = dice_of("sheet", 47);
    RUN_TEST(test_begun);
    RUN_TEST(test_gone_on_with);
    RUN_TEST(test_fresh);
    RUN_TEST(test_rows_of_others);
    RUN_TEST(test_too_few_fields);
    RUN_TEST(test_settings_of_others);
    RUN_TEST(test_locked);
    RUN_TEST(test_not_written);
    RUN_TEST(test_no_file);
}
