/* test_diag.c: random errors in several files, and the sequence in which they are printed: files in the sequence of
 * their first error, and within a file by place. Repeated errors are printed once, and no more than DIAG_MAX errors.
 * Also quotes of lines and statements. */
#include "host/base/diag.h"

#include "command.h"

enum { FILES = 3, ERRORS_MOST = 30, LENGTH = 60 };

#define TEXT "abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefgh"

typedef struct told {
    int file;
    unsigned offset;
} told;

/* The expected output: the reported errors without repeats, up to DIAG_MAX, sorted by selection. */
static int expected(const told *rows, int count, told *printed, bool *more) {
    told kept[ERRORS_MOST];
    int rank[FILES] = {ERRORS_MOST, ERRORS_MOST, ERRORS_MOST};
    int held = 0;
    *more = false;
    for (int i = 0; i < count; i++) {
        bool repeated = false;
        for (int k = 0; k < held; k++) {
            repeated =
                repeated || (kept[k].file == rows[i].file && kept[k].offset == rows[i].offset);
        }
        *more = *more || (!repeated && held == DIAG_MAX);
        if (!repeated && held < DIAG_MAX) {
            rank[rows[i].file] = rank[rows[i].file] < held ? rank[rows[i].file] : held;
            kept[held++] = rows[i];
        }
    }
    for (int i = 0; i < held; i++) {
        int least = i;
        for (int k = i + 1; k < held; k++) {
            const int one = rank[kept[k].file];
            const int other = rank[kept[least].file];
            if (one < other || (one == other && kept[k].offset < kept[least].offset)) {
                least = k;
            }
        }
        printed[i] = kept[least];
        kept[least] = kept[i];
    }
    return held;
}

static void check_printed(FILE *out, const told *rows, int count) {
    told wanted[ERRORS_MOST];
    bool more;
    char line[200];
    char first[200];
    const int held = expected(rows, count, wanted, &more);
    int at = 0;
    bool said_more = false;
    rewind(out);
    while (fgets(line, sizeof line, out) != NULL) {
        if (strstr(line, ": error: ") != NULL) {
            TEST_ASSERT_TRUE(at < held);
            snprintf(first, sizeof first, "file%d:1:%u: error: at %u\n", wanted[at].file,
                     wanted[at].offset + 1, wanted[at].offset);
            TEST_ASSERT_EQUAL_STRING(first, line);
            TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, out));
            TEST_ASSERT_EQUAL_STRING("  " TEXT "\n", line);
            TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, out));
            TEST_ASSERT_EQUAL_UINT(2 + wanted[at].offset, strcspn(line, "^"));
            at++;
        }
        said_more = said_more || strncmp(line, "too many errors", 15) == 0;
    }
    TEST_ASSERT_EQUAL_INT(held, at);
    TEST_ASSERT_TRUE(more == said_more);
}

TEST(diag, order) {
    static const char *const names[FILES] = {"file0", "file1", "file2"};
    dice d = dice_of("errors in drawn places", 20261124);
    const unsigned cases = dice_cases(200);
    source files[FILES];
    for (int i = 0; i < FILES; i++) {
        files[i] = (source){names[i], TEXT, LENGTH};
    }
    diags *all = diags_new();
    for (unsigned c = 0; c < cases; c++) {
        told rows[ERRORS_MOST];
        const int count = 1 + (int)dice_one_of(&d, ERRORS_MOST);
        /* few places, so that several errors share one */
        const unsigned few = 1 + dice_one_of(&d, LENGTH);
        for (int i = 0; i < count; i++) {
            rows[i] = (told){(int)dice_one_of(&d, FILES), dice_one_of(&d, few)};
            const place at = {&files[rows[i].file], 1, (int)rows[i].offset + 1, rows[i].offset};
            diag_error(all, at, NULL, "at %u", rows[i].offset);
        }
        FILE *out = tmpfile();
        TEST_ASSERT_NOT_NULL(out);
        diags_flush(all, out);
        check_printed(out, rows, count);
        fclose(out);
        TEST_ASSERT_EQUAL_INT(0, diags_count(all));
    }
    diags_free(all);
}

/* A statement near the limit of length is quoted in full if it fits, else cut and with dots at its end. */
TEST(diag, statements) {
    enum { ROOM = 20, MOST = 2 * ROOM };
    for (size_t length = 1; length <= MOST; length++) {
        char line[MOST + 2];
        char shown[ROOM];
        memset(line, 'x', length);
        line[length] = '\n';
        line[length + 1] = '\0';
        const source from = {"file", line, length + 1};
        statement_text((place){&from, 1, 1, length / 2}, shown, sizeof shown);
        TEST_ASSERT_EQUAL_UINT(length < ROOM ? length : ROOM - 1, strlen(shown));
        TEST_ASSERT_TRUE((strstr(shown, "...") != NULL) == (length >= ROOM));
        TEST_ASSERT_EQUAL_UINT(length < ROOM ? length : ROOM - 4, strspn(shown, "x"));
    }
}

/* A quoted statement has neither the block around it nor its neighbours on the line, and no comment. */
TEST(diag, statements_in_braces) {
    static const char *const own[] = {"a = 1", "when x { set y; b = 2 }", "when x { a { b } }",
                                      "e {}", "a = 1 \"# b; } {\""};
    static const char *const begin[] = {"",           "scene s { ", "\n  ",
                                        "effect e {", "p = 1; ",    "e { a \"p\";"};
    static const char *const end[] = {"",     " }", " } }\n",    "\n}",
                                      " # {", "}",  "; q = 2 }", " ; # }"};
    for (size_t k = 0; k < 5 * 6 * 8; k++) {
        const char *before = begin[k / 5 % 6];
        char text[80];
        char shown[60];
        snprintf(text, sizeof text, "%s%s%s", before, own[k % 5], end[k / 30]);
        const source from = {"file", text, strlen(text)};
        statement_text((place){&from, 1, 1, strlen(before)}, shown, sizeof shown);
        TEST_ASSERT_EQUAL_STRING(own[k % 5], shown);
    }
}
