/* test_bad_input.c: texts with errors are refused with all their errors, each at its place.
 *
 * Every text in tests/bad begins with lines `# expect: LINE:COLUMN: TEXT`, one for each error, in sequence. Run from
 * the root of the project. */
#include "test.h"

#include <dirent.h>
#include <time.h>

#include "host/derive/lagrange.h"
#include "host/image/image_make.h"
#include "host/lang/model.h"

#define FOLDER "tests/bad"
enum { TEXTS_MIN = 141, LINE_SIZE = 512 };

/* Instantiates a mechanism and, if `derive`, derives its equations and operation lists. Does nothing if `all` has
 * errors already. */
static void try_instance(const mechanism *of, const scene *in, bool derive, diags *all) {
    instance *made = instance_make(of, in, NULL, all);
    if (derive && made != NULL && diags_count(all) == 0) {
        equations *derived = equations_derive(made, all);
        if (derived != NULL) {
            image_free(image_make(derived, in == NULL ? NULL : in->conserve,
                                  &(image_settings)IMAGE_SETTINGS_DEFAULT, IMAGE_TO_RUN, all));
        }
        equations_free(derived);
    }
    instance_free(made);
}

/* All messages about a text. *errors: the number of errors. The caller frees the result. */
static char *full_report_on(const char *file, const char *text, size_t length, bool derive,
                            int *errors) {
    diags *all = diags_new();
    whirl_model *parsed = model_parse(file, text, length, all);
    if (parsed != NULL) {
        for (int i = 0; i < parsed->mechanism_count; i++) {
            try_instance(parsed->mechanisms[i], NULL, derive, all);
        }
        for (int i = 0; i < parsed->scene_count; i++) {
            const scene *each = parsed->scenes[i];
            try_instance(each->mechanism, each, derive, all);
        }
    }
    *errors = diags_count(all);
    char *report = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&report, &size);
    TEST_ASSERT_NOT_NULL(out);
    diags_flush(all, out);
    fclose(out);
    diags_free(all);
    model_free(parsed);
    return report;
}

static char *report_on(const char *file, const char *text, size_t length, int *errors) {
    return full_report_on(file, text, length, false, errors);
}

static void expect(const char *text, size_t length, const char *wanted) {
    int errors = 0;
    char *report = report_on("x.whirl", text, length, &errors);
    const bool found = strstr(report, wanted) != NULL;
    if (!found) {
        printf("wanted: %s\ngot: %.2000s\n", wanted, report);
    }
    free(report);
    TEST_ASSERT_TRUE(found);
    TEST_ASSERT_GREATER_THAN_INT(0, errors);
}

static void expect_text(const char *text, const char *wanted) {
    expect(text, strlen(text), wanted);
}

static char *read_whole(const char *path, size_t *length) {
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    char *text = calloc(1, 65536);
    TEST_ASSERT_NOT_NULL(text);
    *length = fread(text, 1, 65535, in);
    TEST_ASSERT_TRUE_MESSAGE(feof(in), path);
    fclose(in);
    return text;
}

/* Returns false and prints the reason if the errors of a text differ from the expected ones. */
static bool text_fails_as_announced(const char *path, const char *text, size_t length) {
    static const char mark[] = "# expect: ";
    int errors = 0;
    char *report = full_report_on(path, text, length, true, &errors);
    int announced = 0;
    bool good = true;
    const char *from = report;
    for (const char *line = text; strncmp(line, mark, sizeof mark - 1) == 0;) {
        const char *end = strchr(line, '\n');
        TEST_ASSERT_NOT_NULL_MESSAGE(end, path);
        char where[2 * LINE_SIZE];
        char words[LINE_SIZE];
        char whole[3 * LINE_SIZE + 16];
        line += sizeof mark - 1;
        char *after = NULL;
        const long row = strtol(line, &after, 10);
        const long column = *after == ':' ? strtol(after + 1, &after, 10) : 0;
        if (strncmp(after, ": ", 2) != 0 || end - after >= LINE_SIZE) {
            printf("%s: not LINE:COLUMN: TEXT\n", path);
            good = false;
            break;
        }
        after += 2;
        snprintf(where, sizeof where, "%s:%ld:%ld", path, row, column);
        snprintf(words, sizeof words, "%.*s", (int)(end - after), after);
        snprintf(whole, sizeof whole, "%s: error: %s", where, words);
        const char *found = strstr(from, whole);
        if (found == NULL) {
            printf("%s: not reported in its turn: %s\n", path, whole);
            good = false;
            break;
        }
        from = found + 1;
        announced++;
        line = end + 1;
    }
    if (announced != errors || announced == 0) {
        printf("%s: %d errors announced, %d reported\n", path, announced, errors);
        good = false;
    }
    if (!good) {
        printf("%s\n", report);
    }
    free(report);
    return good;
}

/* Tries the texts of an archive, each of which follows a line "=== NAME". Returns the number of texts and adds the
 * failures to *failed. */
static int try_archive(const char *path, int *failed) {
    size_t length = 0;
    char *all = read_whole(path, &length);
    int texts = 0;
    for (char *name = all; strncmp(name, "=== ", 4) == 0; texts++) {
        name += 4;
        char *text = strchr(name, '\n');
        TEST_ASSERT_NOT_NULL_MESSAGE(text, path);
        *text++ = '\0';
        char *next = strstr(text, "\n=== ");
        next = next == NULL ? strchr(text, '\0') : next + 1;
        const char kept = *next;
        *next = '\0';
        *failed += text_fails_as_announced(name, text, (size_t)(next - text)) ? 0 : 1;
        *next = kept;
        name = next;
    }
    free(all);
    return texts;
}

TEST(bad_input, bad_texts_have_their_announced_errors) {
    struct dirent **entries = NULL;
    const int count = scandir(FOLDER, &entries, NULL, alphasort);
    TEST_ASSERT_GREATER_THAN_INT_MESSAGE(0, count, "run the tests from the root of the project");
    int texts = 0;
    int failed = 0;
    for (int i = 0; i < count; i++) {
        if (strstr(entries[i]->d_name, ".texts") != NULL) {
            char path[LINE_SIZE];
            snprintf(path, sizeof path, "%s/%s", FOLDER, entries[i]->d_name);
            texts += try_archive(path, &failed);
        }
        free(entries[i]);
    }
    free(entries);
    TEST_ASSERT_EQUAL_INT(0, failed);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(TEXTS_MIN, texts);
}

TEST(bad_input, empty_texts) {
    expect_text("", "x.whirl:1:1: error: this text contains no mechanism");
    expect_text("\n\n# only a comment", "x.whirl:1:1: error: this text contains no mechanism");
    expect_text("\xef\xbb\xbf", "x.whirl:1:1: error: this text contains no mechanism");
}

TEST(bad_input, binary_is_no_text) {
    static const char elf[] = "mechanism m\n\x7f"
                              "ELF\0\0\1\2";
    expect(elf, sizeof elf - 1, "x.whirl:2:1: error: control character 127");
    expect("mechanism m\0\n", 13, "x.whirl:1:12: error: a zero byte: this is not a text file");
    expect("# x\0", 4, "x.whirl:1:4: error: a zero byte");
}

TEST(bad_input, columns_count_characters) {
    expect_text("mechanism m \"\xc3\xa4\xe2\x82\xac\" ?",
                "x.whirl:1:18: error: unexpected character '?'");
    expect_text("\xef\xbb\xbfparamter", "x.whirl:1:1: error: unknown statement 'paramter'");
    expect_text("mechanism m\r\ncoordinate X [m]\r\nT = Y\r\n", "x.whirl:3:5: error: unknown name");
}

/* A carriage return before a line feed or at the end of the file belongs to the end of the line. Anywhere else it is
 * an error, reported at its place. */
TEST(bad_input, lines_end_in_one_way) {
    static const char text[] = "mechanism m \"a \xce\xb1 title\" # a remark \"\xce\xb1\"\n"
                               "coordinate X [m/s*s] \"where\"\n"
                               "\n"
                               "parameter k = (2.5e1 +\n"
                               "    3.0)*1 [N/m]\n"
                               "T = 1 [kg]*X'^2/2\n"
                               "V = k*X^2/2\n"
                               "scene s { start X' = 2 [m/s]; until 1 [s] }";
    char with[sizeof text + 1];
    char wanted[LINE_SIZE];
    int line = 1;
    int column = 1;
    for (size_t i = 0; i < sizeof text; i++) {
        int errors = 0;
        memcpy(with, text, i);
        with[i] = '\r';
        memcpy(with + i + 1, text + i, sizeof text - i);
        if (i > 0 && ((unsigned char)text[i] & 0xc0) == 0x80) {
            continue; /* not tested: a carriage return between the bytes of one character */
        }
        if (text[i] == '\n' || text[i] == '\0') {
            free(full_report_on("x.whirl", with, sizeof with - 1, false, &errors));
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, errors, with);
            line++;
            column = 1;
            continue;
        }
        snprintf(wanted, sizeof wanted, "x.whirl:%d:%d: error: a carriage return within a line",
                 line, column);
        expect_text(with, wanted);
        column++;
    }
}

TEST(bad_input, caret_marks_the_place) {
    expect_text("mechanism m\ncoordinate \xce\xb1 [m]\n",
                "  coordinate \xce\xb1 [m]\n             ^\n");
    expect_text("mechanism m\n\tcoordinate X [q]\n", "   coordinate X [q]\n                 ^\n");
}

TEST(bad_input, values_that_are_no_numbers) {
    static const char *const rows[][2] = {
        {"parameter z = log(0)",
         "11: error: parameter 'z' is not a finite number (minus infinity)"},
        {"parameter z = sqrt(-1)",
         "11: error: parameter 'z' is not a finite number (not a number)"},
        {"input z = 1e300*1e300", "7: error: input 'z' is not a finite number (infinity)"},
        {"scene s { step 0 [s] }", "16: error: step must be above zero"},
        {"scene s { until -1 [s] }", "17: error: until must not be negative"},
        {"scene s { until 1e17 [s] }", "17: error: more than 2^63 steps of 0.001 s"},
        {"scene s { step 1e-18 [s] }", "16: error: more than 2^63 steps of 1e-18 s"},
        {"scene s { until 1.1e18 [s] }",
         "17: error: until must be at most 1e+18 s, and this is 1.1e+18 s"},
        {"scene s { step 1e-19 [s] }", "16: error: a step must be from 1e-18 s to 1e+18 s"},
        {"parameter a = 1; parameter b = a; scene s { set a = b }",
         "49: error: 'a' is set to a value that depends on itself"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[LINE_SIZE];
        char wanted[LINE_SIZE];
        snprintf(text, sizeof text, "mechanism m\ncoordinate X [m]\nT = 1 [kg]*X'^2\n%s\n",
                 rows[i][0]);
        snprintf(wanted, sizeof wanted, "x.whirl:4:%s", rows[i][1]);
        expect_text(text, wanted);
    }
}

/* Returns `head`, then `piece` `times` times, then `tail`. The caller frees the result. */
static char *repeat(const char *head, const char *piece, size_t times, const char *tail,
                    size_t *length) {
    *length = strlen(head) + strlen(piece) * times + strlen(tail);
    char *text = malloc(*length + 1);
    TEST_ASSERT_NOT_NULL(text);
    char *at = stpcpy(text, head);
    for (size_t i = 0; i < times; i++) {
        at = stpcpy(at, piece);
    }
    stpcpy(at, tail);
    return text;
}

static void expect_repeated(const char *piece, size_t times, const char *tail, const char *wanted) {
    size_t length = 0;
    char *text = repeat("mechanism m\ncoordinate X\nlet a = ", piece, times, tail, &length);
    const clock_t began = clock();
    expect(text, length, wanted);
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    free(text);
    TEST_ASSERT_TRUE_MESSAGE(seconds < 2.0, wanted);
}

TEST(bad_input, ten_thousand_deep) {
    expect_repeated("(", 10000, "1\n",
                    "x.whirl:3:209: error: this expression is nested more than 200 deep");
    expect_repeated("-", 10000, "1\n",
                    "x.whirl:3:209: error: this expression is nested more than 200 deep");
    expect_repeated("2^", 10000, "1\n", "nested more than 200 deep");
    expect_repeated("sin(", 10000, "1\n", "nested more than 200 deep");
    expect_repeated("1+", 10000, "1\n", "x.whirl:3:2008: error: this expression is more than 1000");
    expect_repeated("1*", 10000, "1\n", "this expression is more than 1000 operators deep");
    expect_repeated("1 [((", 10000, "1\n", "error: this unit is not closed");
    expect_repeated("1 [", 1, "((((((((((((((((((((((((((((m]\n", "too many parentheses in a unit");
}

TEST(bad_input, nested_lets_are_bounded) {
    size_t used = 0;
    char *text = malloc(200000);
    TEST_ASSERT_NOT_NULL(text);
    used += (size_t)sprintf(text, "mechanism m\ncoordinate X\nlet a0 = X\n");
    for (int i = 1; i <= 1200; i++) {
        used += (size_t)sprintf(text + used, "let a%d = a%d*a%d\n", i, i - 1, i - 1);
    }
    expect(text, used, "' is more than 1000 operators deep once its lets are inserted");
    free(text);
}

TEST(bad_input, ten_megabytes_of_garbage) {
    expect_repeated("@", 10000000, "", "unexpected character '@'");
    expect_repeated("\xff", 10000000, "", "written in ASCII");
    expect_repeated("\x01\n", 5000000, "", "too many errors: only the first 20 are shown");
    expect_repeated("x y z {\n", 1250000, "", "error: unknown name 'x'");
    expect_repeated("1", 10000000, "", "this number has more than 100 characters");
    expect_repeated("x", 10000000, "", "this name is longer than 63 characters");
    expect_repeated("'", 10000000, "", "a prime must stand directly after a name");
    expect_repeated("\"", 10000000, "", "a value is missing before a text in quotes");
    expect_repeated("X+", 5000000, "", "more than 1000 operators deep");
}

TEST(bad_input, very_long_texts) {
    size_t length = 0;
    char *text = repeat("mechanism m\n", "# 0123456789012345678901234567890123456789\n",
                        (17U << 20) / 43, "", &length);
    expect(text, length, "x.whirl:1:1: error: the text is longer than 16777216 bytes");
    free(text);
}

TEST(bad_input, at_most_twenty_errors_are_shown) {
    size_t length = 0;
    char *text = repeat("mechanism m\n", "what = 3\n", 1000, "", &length);
    int errors = 0;
    char *report = report_on("x.whirl", text, length, &errors);
    int told = 0;
    for (const char *at = report; (at = strstr(at, ": error: ")) != NULL; at++) {
        told++;
    }
    TEST_ASSERT_EQUAL_INT(20, told);
    TEST_ASSERT_EQUAL_INT(21, errors);
    TEST_ASSERT_NOT_NULL(strstr(report, "too many errors: only the first 20 are shown\n"));
    free(report);
    free(text);
}

/* The time for a hundred thousand names must not grow with the square of their number. */
TEST(bad_input, many_names_are_quick) {
    const int count = 100000;
    char *text = malloc((size_t)count * 40);
    TEST_ASSERT_NOT_NULL(text);
    size_t used = (size_t)sprintf(text, "mechanism m\ncoordinate X\n");
    for (int i = 0; i < count; i++) {
        used += (size_t)sprintf(text + used, "parameter p%d = %d\n", i, i);
    }
    used += (size_t)sprintf(text + used, "T = q%d\n", count);
    const clock_t began = clock();
    expect(text, used, "unknown name 'q100000'");
    free(text);
    TEST_ASSERT_TRUE((double)(clock() - began) / CLOCKS_PER_SEC < 2.0);
}

/* Whirl must not crash on any prefix of a good file, nor on a good file with one byte changed. */
TEST(bad_input, every_beginning_and_every_changed_byte) {
    size_t length = 0;
    char *text = read_whole("core/models/epicyclic.whirl", &length);
    int refused = 0;
    for (size_t i = 0; i < length; i++) {
        int errors = 0;
        free(report_on("x.whirl", text, i, &errors));
        refused += errors > 0;
        static const char changes[] = "\0\n\"'({[)}]=+-#9x\xc3";
        const char kept = text[i];
        text[i] = changes[i % (sizeof changes - 1)];
        free(report_on("x.whirl", text, length, &errors));
        text[i] = kept;
    }
    free(text);
    TEST_ASSERT_GREATER_THAN_INT((int)length / 3, refused);
}
