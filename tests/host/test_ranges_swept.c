/* test_ranges_swept.c: random axes of a sweep (host/study/grid.h): linear or geometric values in counting sequence,
 * and the changes of each point. An error must name its option and leave the grid as it was. Also the CSV file of a
 * sweep that is resumed. */
#include "test.h"

#include <sys/wait.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/base/exit.h"
#include "host/lang/model.h"
#include "host/study/grid.h"
#include "host/study/session.h"

#include "command.h"

/* === suite ranges_swept ======================================================================= */

static const char sample[] =
    "mechanism swing\ncoordinate theta [rad]\ncoordinate z [m]\nparameter m = 2 [kg]\n"
    "parameter mm = 3 [kg]\nparameter r = 0.3 [m]\nparameter q = 5 [mm]\ninput M = 2 [N*m]\n"
    "T = m*r^2*theta'^2/2 + mm*z'^2/2\nQ(theta) = M\n"
    "effect tug \"pulled\" { parameter pull = 3 [N]; Q(z) += pull }\nscene s { until 1 [s] }\n"
    "mechanism decay\nstate x [m]\nparameter k = 1 [1/s]\nequation x' + k*x = 0\n";

static dice die;
static diags *heard;
static whirl_model *parsed;
static grid g;

static void open_sample(void) {
    heard = diags_new();
    parsed = model_parse("x.whirl", sample, strlen(sample), heard);
    TEST_ASSERT_NOT_NULL(parsed);
    g = (grid){0};
}

static void close_sample(void) {
    grid_free(&g);
    model_free(parsed);
    diags_free(heard);
}

static const char *one_of(const char *const *words, unsigned count) {
    return words[dice_one_of(&die, count)];
}

static const char *blank(void) {
    static const char *const blanks[] = {"", "", " ", "\t", "  "};
    return one_of(blanks, 5);
}

enum { AXES_MOST = 4, NAMES = 9 };

static const struct {
    const char *name;
    const char *column;
    int primes;
    bool is_parameter;
} names[NAMES] = {{"m", "m", 0, true},
                  {"r", "r", 0, true},
                  {"q", "q", 0, true},
                  {"M", "M", 0, false},
                  {"theta", "start(theta)", 0, false},
                  {"theta'", "start(theta')", 1, false},
                  {"z", "start(z)", 0, false},
                  {"z'", "start(z')", 1, false},
                  {"step", "step", 0, false}};

typedef struct drawn_axis {
    int name;
    double from;
    double to;
    unsigned count;
    bool is_log;
} drawn_axis;

/* Appends an axis to the grid as a text with 17 digits, which are exact for doubles. */
static void add_axis(drawn_axis *a) {
    char text[200];
    const double sign = names[a->name].column[1] == 't' ? 1.0 : dice_one_of(&die, 2) - 0.5;
    a->is_log = dice_one_of(&die, 2) == 0;
    a->count = 1 + dice_one_of(&die, 6);
    a->from = (sign < 0.0 ? -1.0 : 1.0) * exp(dice_between(&die, -8.0, 8.0));
    a->to = a->count == 1 ? a->from
            : a->is_log   ? a->from * exp(dice_between(&die, -9.0, 9.0))
            : sign == 1.0 ? a->from * exp(dice_between(&die, -9.0, 9.0))
                          : dice_between(&die, -900.0, 900.0);
    if (a->is_log && a->count > 1 && strcmp(names[a->name].name, "step") != 0 &&
        dice_one_of(&die, 4) == 0) { /* the ratio of both ends over- or underflows */
        const double way = dice_one_of(&die, 2) == 0 ? -1.0 : 1.0;
        a->from = copysign(exp(-way * dice_between(&die, 380.0, 690.0)), a->from);
        a->to = copysign(exp(way * dice_between(&die, 380.0, 690.0)), a->from);
    }
    snprintf(text, sizeof text, "%s%s%s=%s%.17g%s..%s%.17g%s%s:%s%u%s%s", blank(),
             names[a->name].name, blank(), blank(), a->from, blank(), blank(), a->to,
             strcmp(names[a->name].name, "q") == 0 ? " [m]" : "", blank(), blank(), a->count,
             a->is_log ? ",log" : "", blank());
    TEST_ASSERT_TRUE_MESSAGE(grid_add(&g, parsed->mechanisms[0], text, heard), text);
}

static long double wanted_value(const drawn_axis *a, uint64_t i) {
    const long double part = a->count == 1 ? 0.0L : (long double)i / (long double)(a->count - 1);
    return a->is_log ? (long double)a->from * powl((long double)a->to / (long double)a->from, part)
                     : (long double)a->from + ((long double)a->to - (long double)a->from) * part;
}

static int draw_grid(drawn_axis *axes) {
    const int count = 1 + (int)dice_one_of(&die, AXES_MOST);
    bool used[NAMES] = {false};
    for (int i = 0; i < count; i++) {
        do {
            axes[i].name = (int)dice_one_of(&die, NAMES);
        } while (used[axes[i].name]);
        used[axes[i].name] = true;
        add_axis(&axes[i]);
    }
    return count;
}

static void expect_point(const drawn_axis *axes, int count, uint64_t point, const double *value) {
    uint64_t rest = point;
    for (int i = count - 1; i >= 0; i--) {
        const uint64_t at = rest % axes[i].count;
        const double wanted = (double)wanted_value(&axes[i], at);
        const double size = fmax(fabs(axes[i].from), fabs(axes[i].to));
        rest /= axes[i].count;
        const bool wide = fabs(log(fabs(axes[i].to)) - log(fabs(axes[i].from))) > 700.0;
        TEST_ASSERT_TRUE(fabs(value[i] - wanted) <=
                         (wide ? 1e-13 : 1e-14) * (axes[i].is_log ? fabs(wanted) : size));
        TEST_ASSERT_TRUE(at > 0 || value[i] == axes[i].from);
        TEST_ASSERT_TRUE(at + 1 < axes[i].count || value[i] == axes[i].to);
    }
    TEST_ASSERT_EQUAL_UINT64(0, rest);
}

/* The changes of a point must have each swept number to the bit, and the other changes as on the command line. */
static void expect_changes(const drawn_axis *axes, int count, uint64_t point, const double *value) {
    static const char *const sets[] = {"mm=7"};
    static const char *const old[] = {"M=8", "M=9"};
    const overrides base = {.sets = sets,
                            .set_count = 1,
                            .values = old,
                            .value_count = 2,
                            .step = dice_one_of(&die, 2) == 0 ? "1ms" : NULL,
                            .until = "3"};
    overrides made = changes_at(&g, &base, point);
    int told = 0;
    const char *step = base.step;
    for (int i = 0; i < count; i++) {
        const char *name = names[axes[i].name].name;
        if (strcmp(name, "step") == 0) {
            step = NULL;
            TEST_ASSERT_TRUE(made.step != NULL && strtod(made.step, NULL) == value[i]);
            continue;
        }
        TEST_ASSERT_TRUE(told < made.value_count);
        const char *text = made.values[told++];
        const size_t length = strlen(name);
        TEST_ASSERT_EQUAL_STRING_LEN(name, text, length);
        TEST_ASSERT_TRUE(text[length] == '=' && strtod(text + length + 1, NULL) == value[i]);
    }
    TEST_ASSERT_EQUAL_INT(told, made.value_count);
    TEST_ASSERT_TRUE(step == NULL || made.step == step);
    TEST_ASSERT_TRUE(made.sets == sets && made.set_count == 1 && made.until == base.until);
    changes_forget(&base, &made);
}

TEST(ranges_swept, values) {
    for (unsigned c = 0; c < dice_cases(usual_or(300, 60)); c++) {
        drawn_axis axes[AXES_MOST];
        open_sample();
        const int count = draw_grid(axes);
        uint64_t points = 1;
        bool varies = false;
        TEST_ASSERT_EQUAL_INT(count, g.count);
        for (int i = 0; i < count; i++) {
            points *= axes[i].count;
            varies = varies || names[axes[i].name].is_parameter;
            TEST_ASSERT_EQUAL_STRING(names[axes[i].name].name, g.axes[i].name);
            TEST_ASSERT_EQUAL_STRING(names[axes[i].name].column, g.axes[i].column);
            TEST_ASSERT_EQUAL_INT(names[axes[i].name].primes, g.axes[i].primes);
            TEST_ASSERT_EQUAL(axes[i].is_log, g.axes[i].is_log);
        }
        TEST_ASSERT_EQUAL_UINT64(points, g.points);
        TEST_ASSERT_EQUAL(varies, grid_varies_parameters(&g));
        for (int k = 0; k < 6; k++) {
            double value[AXES_MOST];
            const uint64_t point = k == 0 ? points - 1 : dice_one_of(&die, (unsigned)points);
            grid_values(&g, point, value);
            expect_point(axes, count, point, value);
            expect_changes(axes, count, point, value);
        }
        close_sample();
    }
}

/* The shards of any grid must be exact fractions of its points, without gaps. */
TEST(ranges_swept, shards) {
    for (unsigned c = 0; c < dice_cases(200); c++) {
        grid any = {.points = (uint64_t)exp(dice_between(&die, 0.0, log(1e12)))};
        const uint64_t n = 1 + (uint64_t)exp(dice_between(&die, 0.0, log(999999.0)));
        const uint64_t k = 1 + (uint64_t)(dice_between(&die, 0.0, (double)n) * 0.999999);
        uint64_t first[2];
        uint64_t end[2];
        grid_shard(&any, k, n, &first[0], &end[0]);
        TEST_ASSERT_TRUE(end[0] * n <= any.points * k && (end[0] + 1) * n > any.points * k);
        TEST_ASSERT_TRUE(k > 1 || first[0] == 0);
        TEST_ASSERT_TRUE(k < n || end[0] == any.points);
        if (k > 1) {
            grid_shard(&any, k - 1, n, &first[1], &end[1]);
            TEST_ASSERT_EQUAL_UINT64(end[1], first[0]);
        }
    }
}

static const char no_range[] = " is not NAME=FROM..TO:COUNT\n";
static const char three_dots[] = " has three dots in a row\n";
static const char count_wrong[] =
    ": the COUNT after the last ':' must be a whole number from 1 to 999999999999, perhaps with "
    "',log' after it\n";
static const char single[] = ": a COUNT of 1 needs FROM = TO\n";
static const char no_log[] =
    ": the ends of a logarithmic range must both be above zero or both below zero\n";
static const char no_numbers[] = ": FROM and TO must be numbers\n";
static const char not_finite[] = ": FROM and TO must be finite numbers\n";
static const char one_unit[] = ": one end has a unit and the other has none\n";
static const char no_step[] = ": step must be above zero\n";
static const char twice[] = ": another option already sweeps this name\n";

/* '_' stands for random blanks. */
static const struct {
    const char *text;
    const char *problem;
} wrong[] = {{"m_1_.._2_:_3", no_range},
             {"m_=_1_.._2", no_range},
             {"m_=_1_._2_:_3", no_range},
             {"m_=_1_:_2_.._3", no_range},
             {"m_.._1_=_2_:_3", no_range},
             {"", no_range},
             {"m_=_1_..._2_:_3", three_dots},
             {"m_=_1_.._2_:_0", count_wrong},
             {"m_=_1_.._2_:_3e1", count_wrong},
             {"m_=_1_.._2_:_3,lin", count_wrong},
             {"m_=_1_.._2_:_3 ,log", count_wrong},
             {"m_=_1_.._2_:_,log", count_wrong},
             {"m_=_1_.._2_:_1234567890123", count_wrong},
             {"m_=_1_.._2_:_1", single},
             {"r_=_1_.._2_[mm]_:_1", single},
             {"m_=_0_.._2_:_3,log", no_log},
             {"m_=_2_.._0_:_3,log", no_log},
             {"m_=_-1_.._2_:_3,log", no_log},
             {"m_=_r*1[kg/m]_.._2_:_3", no_numbers},
             {"m_=_1_.._mm_:_3", no_numbers},
             {"M_=_-1e308_.._1e308_:_3", not_finite},
             {"M_=_1e200*1e200_.._1_:_3", not_finite},
             {"M_=_1_.._1e200*1e200_:_3", not_finite},
             {"r_=_1 [mm]_.._2_:_3", one_unit},
             {"r_=_2*3_.._7 [mm]_:_3", one_unit},
             {"step_=_0_.._1 ms_:_3", no_step},
             {"step_=_1_.._0_:_3", no_step},
             {"step_=_-1_.._1 [ms]_:_3", no_step},
             {"theta'_=_1_.._2_:_3", twice},
             {"m_=_1_.._2_:_3", NULL},
             {"theta_=_1_.._2_:_3", NULL},
             {"m_=_-1_.._-2_:_3,log", NULL},
             {"m_=_2_.._2_:_1", NULL},
             {"r_=_0_.._2*1[mm]_:_3", NULL},
             {"r_=_2 [mm]_.._0_:_3", NULL},
             {"step_=_1_.._2 [ms]_:_3", NULL}};

static void with_blanks(const char *from, char *text) {
    for (; *from != '\0'; from++) {
        const char *put = *from == '_' ? blank() : (const char[]){*from, '\0'};
        strcpy(text, put);
        text += strlen(put);
    }
    *text = '\0';
}

TEST(ranges_swept, mistakes) {
    static const char *const commands[] = {NULL, "map", "price"};
    static const char *const options[] = {NULL, "--vary", "--at"};
    for (unsigned c = 0; c < usual_or(6, 2) * (sizeof wrong / sizeof wrong[0]); c++) {
        const size_t which = c % (sizeof wrong / sizeof wrong[0]);
        char text[200];
        char wanted[600] = "";
        open_sample();
        TEST_ASSERT_TRUE(grid_add(&g, parsed->mechanisms[0], "theta'=1..2:5", heard));
        g.command = one_of(commands, 3);
        g.option = one_of(options, 3);
        with_blanks(wrong[which].text, text);
        if (wrong[which].problem != NULL) {
            const char *option = g.option != NULL ? g.option : "--over";
            const bool hint =
                wrong[which].problem == no_range || wrong[which].problem == three_dots;
            const int length = snprintf(wanted, sizeof wanted, "whirl %s: error: %s \"%s\"%s",
                                        g.command != NULL ? g.command : "sweep", option, text,
                                        wrong[which].problem);
            if (hint) {
                snprintf(wanted + length, sizeof wanted - (size_t)length,
                         "hint: write a range such as %s \"r=10..60 [mm]:11\", or ...:11,log for "
                         "a logarithmic range\n",
                         option);
            }
        }
        errors_catch();
        const bool taken = grid_add(&g, parsed->mechanisms[0], text, heard);
        const char *told = errors_caught();
        TEST_ASSERT_EQUAL_STRING(wanted, told);
        TEST_ASSERT_EQUAL_MESSAGE(wrong[which].problem == NULL, taken, text);
        TEST_ASSERT_EQUAL_INT(taken ? 2 : 1, g.count);
        TEST_ASSERT_EQUAL_UINT64(5 * (taken ? g.axes[1].count : 1), g.points);
        close_sample();
    }
}

/* A number without a unit must be refused if the declared unit is not SI, and only then. */
TEST(ranges_swept, bare_numbers) {
    static const struct {
        const char *text;
        const char *typed; /* the hint in SI; NULL: accepted */
    } bare[] = {{"q=1..2:3", "1..2 [m]:3"},
                {" q = 1 .. 2.5 :3,log", "1..2.5 [m]:3,log"},
                {"q=1 [mm]..2:3", "1 [mm]..2 [m]:3"},
                {"q=(1)..0:3", "((1))*1 [m]..0:3"},
                {"q=1..2 [mm]:3", NULL},
                {"q=1..2 [m]:3", NULL},
                {"q=0..0:1", NULL},
                {"r=1..2:3", NULL},
                {"theta=1..2:3", NULL},
                {"step=1..2:3", NULL},
                {"q=1..2 [mm]:x", NULL}};
    for (size_t i = 0; i < sizeof bare / sizeof bare[0]; i++) {
        char wanted[200] = "";
        open_sample();
        if (bare[i].typed != NULL) {
            snprintf(wanted, sizeof wanted, ", or in SI: \"q = %s\"\n", bare[i].typed);
        }
        errors_catch();
        const bool taken = grid_add(&g, parsed->mechanisms[0], bare[i].text, heard);
        const char *told = errors_caught();
        TEST_ASSERT_EQUAL_MESSAGE(bare[i].typed == NULL && strchr(bare[i].text, 'x') == NULL, taken,
                                  bare[i].text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, wanted), told);
        close_sample();
    }
}

/* A name that is swept cannot be set as well, with or without blanks. A name with the same beginning can be set. */
TEST(ranges_swept, given_twice) {
    static const char *const swept[] = {"m=1..2:2", "mm=1..2:2", "theta=1..2:2", "theta'=1..2:2",
                                        "step=1..2:2"};
    static const char *const named[] = {"m", "mm", "theta", "theta'", "step"};
    for (unsigned c = 0; c < 200U; c++) {
        char set[3][40];
        const char *sets[3];
        const char *starts[3];
        char wanted[200] = "";
        overrides base = {.sets = sets, .starts = starts};
        const unsigned which = dice_one_of(&die, 5);
        const char *option = NULL;
        open_sample();
        TEST_ASSERT_TRUE(grid_add(&g, parsed->mechanisms[0], "z=1..2:2", heard));
        TEST_ASSERT_TRUE(grid_add(&g, parsed->mechanisms[0], swept[which], heard));
        g.command = c % 3U == 0 ? "map" : NULL;
        for (unsigned i = 0; i < 3U; i++) {
            const unsigned given = dice_one_of(&die, 4);
            snprintf(set[i], sizeof set[i], "%s%s%s=%s1", blank(), named[given], blank(), blank());
            if (given < 2) {
                sets[base.set_count++] = set[i];
            } else {
                starts[base.start_count++] = set[i];
            }
            option = given != which ? option : given < 2 ? "--set" : "--start";
        }
        base.step = c % 2U == 0 ? "1ms" : NULL;
        option = which == 4 && base.step != NULL ? "--step" : option;
        if (option != NULL) {
            snprintf(
                wanted, sizeof wanted,
                "whirl %s: error: --over sweeps '%s', but %s sets it, too\nhint: leave out one of "
                "these options\n",
                g.command != NULL ? g.command : "sweep", named[which], option);
        }
        errors_catch();
        const bool apart = changes_are_apart(&g, &base);
        TEST_ASSERT_EQUAL_STRING(wanted, errors_caught());
        TEST_ASSERT_EQUAL(option == NULL, apart);
        close_sample();
    }
}

SUITE(ranges_swept) { die = dice_of("ranges_swept", 61); }

/* === suite sheet ============================================================================== */
/* The CSV file of a sweep (host/study/session.h): created, resumed after it was cut off anywhere, restarted, or
 * refused and left unchanged because it is from another sweep. Compared with the test's own text. */

enum { ROWS_MOST = 12, TEXT = 2000, PATH = 120 };

static const char fingerprint[] = "scene: s\nover: m=1..3:7\nmeasure: X\n";
static char folder[80];
static char path[PATH];
static char path_beside[PATH + 20];

typedef struct drawn_sheet {
    resumable_csv_settings settings;
    char whole[TEXT];
    size_t end[ROWS_MOST + 1]; /* offset of the header's end, then of each row's end */
    bool failed[ROWS_MOST];
} drawn_sheet;

static drawn_sheet d;

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

/* Writes the first `length` bytes of the CSV file, and the whole file of settings beside it. */
static void leave(size_t length) {
    put_file(path, d.whole, length);
    put_file(path_beside, fingerprint, strlen(fingerprint));
}

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
    expect_file(path, d.whole, d.end[rows]); /* the incomplete row is gone, the header is there */
    expect_file(path_beside, fingerprint, strlen(fingerprint));
    fputs(d.whole + d.end[rows], sh.out);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    TEST_ASSERT_TRUE(resumable_csv_close(&sh)); /* a second close must do nothing */
    expect_file(path, d.whole, strlen(d.whole));
}

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
    snprintf(
        wanted, sizeof wanted,
        "%s: error: %s\nhint: use another --csv to keep this file, or --fresh to overwrite it\n",
        path, why);
    const char *told = errors_caught();
    TEST_ASSERT_EQUAL_STRING_LEN(wanted, told, strlen(wanted));
    /* the error must be printed once */
    TEST_ASSERT_NULL_MESSAGE(strstr(told + strlen(wanted), "error:"), told);
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

/* A file that was cut off at any byte, often near the end of a line, must be resumed. */
TEST(sheet, interrupted_sweeps_are_continued) {
    open_folder();
    for (unsigned c = 0; c < dice_cases(usual_or(5, 3)); c++) {
        draw_sheet();
        unsigned rows = 0;
        for (size_t length = 0; length <= strlen(d.whole); length++) {
            const char *at = d.whole + length; /* the file is cut off here */
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

/* If one byte of any row has changed, the file must count as that of another sweep. */
TEST(sheet, rows_of_another_sweep_are_refused) {
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
        case 3: /* one field too many */
            memmove(at + swept + 1, at + swept, strlen(at + swept) + 1);
            break;
        default: /* one row too many */
            snprintf(at, sizeof text - d.end[row], "%s", d.whole + d.end[row]);
            snprintf(text + strlen(text), 40, "%u,0.%u,1\r\n", (unsigned)d.settings.rows / 3U + 1U,
                     (unsigned)d.settings.rows % 3U);
        }
        snprintf(why, sizeof why, "row %u is not from this sweep",
                 c % 5 == 4 ? (unsigned)d.settings.rows + 1U : row + 1U);
        const size_t length = strlen(d.whole) + (c % 5 == 3   ? 1
                                                 : c % 5 == 4 ? strlen(text + strlen(d.whole))
                                                              : 0);
        expect_refused(text, length, fingerprint, why);
    }
    close_folder();
}

TEST(sheet, locked) {
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
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, ": error: another sweep is writing this file\n"),
                                 told);
    TEST_ASSERT_EQUAL_INT(0, status);
    TEST_ASSERT_TRUE(resumable_csv_close(&sh));
    close_folder();
}

SUITE(sheet) { die = dice_of("sheet", 47); }
