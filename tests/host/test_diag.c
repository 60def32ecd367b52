/* test_diag.c: drawn errors in drawn places of several files, in the order in which they are printed: each file's together,
 * the files as they were first told of, and within a file by place; what is told twice once; no more than DIAG_MAX. */
#include "host/base/diag.h"

#include <stdbool.h>
#include <string.h>

#include "command.h"
#include "unity.h"

void suite_diag(void);

enum { FILES = 3, ERRORS_MOST = 30, LENGTH = 60 };

typedef struct told {
    int file;
    unsigned offset;
} told;

/* What is printed: the rows as they were told, without repeats, at most DIAG_MAX; then sorted by picking the least. */
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
            at++;
        }
        said_more = said_more || strncmp(line, "too many errors", 15) == 0;
    }
    TEST_ASSERT_EQUAL_INT(held, at);
    TEST_ASSERT_TRUE(more == said_more);
}

static void test_order(void) {
    static const char text[LENGTH + 1] =
        "abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefgh";
    static const char *const names[FILES] = {"file0", "file1", "file2"};
    dice d = dice_of("errors in drawn places", 20261124);
    const unsigned cases = dice_cases(200);
    source files[FILES];
    for (int i = 0; i < FILES; i++) {
        files[i] = (source){names[i], text, LENGTH};
    }
    diags *all = diags_new();
    for (unsigned c = 0; c < cases; c++) {
        told rows[ERRORS_MOST];
        const int count = 1 + (int)dice_one_of(&d, ERRORS_MOST);
        const unsigned few = 1 + dice_one_of(&d, LENGTH); /* so that places are met again */
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

void suite_diag(void) { RUN_TEST(test_order); }
