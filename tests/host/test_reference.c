/* test_reference.c: what `whirl accel` prints, against accelerations derived independently with
 * SymPy and mpmath (tests/reference/accel.txt, made by derive.py).
 *
 * The criterion is relative and the same for every value: |got - want| <= 1e-12 |want|. Only where
 * the true value is zero is there an absolute floor, 1e-12 of the largest acceleration of that state
 * (or 1e-12 itself when all are zero).
 *
 * The program is build/whirl, or what the environment variable WHIRL names; run from the root. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

void suite_reference(void);

#define REFERENCE "tests/reference/accel.txt"
#define TOLERANCE 1e-12
#define VALUES_MAX 16
#define TEXT_MAX 2048

typedef struct named_value {
    char name[64]; /* with its primes */
    double value;
} named_value;

typedef struct tally {
    int states;
    int values;
    int failures;
    double worst; /* largest relative deviation of a nonzero value */
    char worst_at[TEXT_MAX];
} tally;

/* Append to a command line without overrunning it. */
static void append(char *command, const char *text) {
    const size_t used = strlen(command);
    TEST_ASSERT_TRUE_MESSAGE(used + strlen(text) < TEXT_MAX, "a reference line is too long");
    strcpy(command + used, text);
}

/* `FILE | a=1 b'=2 | ...` to `whirl accel 'FILE' "a=1" "b'=2"`. */
static void build_command(char command[TEXT_MAX], const char *where, char *given) {
    const char *whirl = getenv("WHIRL");
    command[0] = '\0';
    append(command, whirl != NULL ? whirl : "build/whirl");
    append(command, " accel \"");
    append(command, where);
    append(command, "\"");
    char *rest = NULL;
    for (const char *word = strtok_r(given, " ", &rest); word != NULL;
         word = strtok_r(NULL, " ", &rest)) {
        append(command, " \"");
        append(command, word);
        append(command, "\"");
    }
    append(command, " 2>&1");
}

/* Split `a''=1 b''=2`; returns how many. */
static int parse_wanted(char *text, named_value wanted[VALUES_MAX]) {
    int count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(text, " \n", &rest); word != NULL;
         word = strtok_r(NULL, " \n", &rest)) {
        char *equals = strchr(word, '=');
        TEST_ASSERT_NOT_NULL(equals);
        TEST_ASSERT_TRUE(count < VALUES_MAX);
        *equals = '\0';
        TEST_ASSERT_TRUE(strlen(word) < sizeof wanted[count].name);
        strcpy(wanted[count].name, word);
        wanted[count].value = strtod(equals + 1, NULL);
        count++;
    }
    return count;
}

/* Read lines `theta'' = 1.25`. Returns how many; the first other line goes to `complaint`. */
static int read_answer(FILE *pipe, named_value got[VALUES_MAX], char complaint[TEXT_MAX]) {
    char line[TEXT_MAX];
    int count = 0;
    complaint[0] = '\0';
    while (fgets(line, (int)sizeof line, pipe) != NULL) {
        named_value value;
        char number[64];
        char *end = number;
        const bool shaped = sscanf(line, "%63s = %63s", value.name, number) == 2;
        if (shaped) {
            value.value = strtod(number, &end);
        }
        if (shaped && *end == '\0' && end != number && count < VALUES_MAX) {
            got[count++] = value;
        } else if (complaint[0] == '\0') {
            strcpy(complaint, line);
        }
    }
    return count;
}

/* True when `got` holds `want` within the tolerance; `scale` is the state's largest acceleration. */
static bool agrees(const named_value *want, double scale, const named_value *got, int got_count,
                   const char *command, tally *score) {
    for (int i = 0; i < got_count; i++) {
        if (strcmp(got[i].name, want->name) != 0) {
            continue;
        }
        const double error = fabs(got[i].value - want->value);
        const double floor_at_zero = TOLERANCE * (scale > 0.0 ? scale : 1.0);
        const double allowed = want->value == 0.0 ? floor_at_zero : TOLERANCE * fabs(want->value);
        if (want->value != 0.0 && error / fabs(want->value) > score->worst) {
            score->worst = error / fabs(want->value);
            strcpy(score->worst_at, command);
        }
        if (error <= allowed) { /* false for NaN */
            return true;
        }
        printf("  %s\n    %s: got %.17g, want %.17g\n", command, want->name, got[i].value,
               want->value);
        return false;
    }
    printf("  %s\n    %s is missing\n", command, want->name);
    return false;
}

/* Check one line of the reference file. */
static void check_line(char *line, tally *score) {
    char *rest = NULL;
    const char *where = strtok_r(line, "|", &rest);
    char *given = strtok_r(NULL, "|", &rest);
    char *expected = strtok_r(NULL, "|", &rest);
    TEST_ASSERT_NOT_NULL_MESSAGE(expected, "malformed line in " REFERENCE);
    char path[256];
    TEST_ASSERT_EQUAL_INT(1, sscanf(where, "%255s", path));

    char command[TEXT_MAX];
    build_command(command, path, given);
    named_value wanted[VALUES_MAX];
    const int wanted_count = parse_wanted(expected, wanted);
    named_value got[VALUES_MAX];
    char complaint[TEXT_MAX];
    FILE *pipe = popen(command, "r");
    TEST_ASSERT_NOT_NULL(pipe);
    const int got_count = read_answer(pipe, got, complaint);
    const int status = pclose(pipe);

    score->states++;
    if (status != 0 || got_count != wanted_count || complaint[0] != '\0') {
        printf("  %s\n    status %d, %d of %d values; %s\n", command, status, got_count,
               wanted_count, complaint);
        score->failures++;
        return;
    }
    double scale = 0.0;
    for (int i = 0; i < wanted_count; i++) {
        scale = fmax(scale, fabs(wanted[i].value));
    }
    for (int i = 0; i < wanted_count; i++) {
        score->values++;
        if (!agrees(&wanted[i], scale, got, got_count, command, score)) {
            score->failures++;
        }
    }
}

/* Check all lines whose file lies in `folder`. */
static void check_folder(const char *folder, int states_at_least) {
    FILE *file = fopen(REFERENCE, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, REFERENCE " cannot be read: run from the project's root");
    tally score = {0};
    char line[TEXT_MAX];
    while (fgets(line, (int)sizeof line, file) != NULL) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strchr(line, '\n'), "a reference line is too long");
        if (strncmp(line, folder, strlen(folder)) == 0) {
            check_line(line, &score);
        }
    }
    fclose(file);
    printf(
        "  %s: %d values in %d states, %d failures, largest relative deviation %.2g\n    at %s\n",
        folder, score.values, score.states, score.failures, score.worst, score.worst_at);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, score.failures, "accelerations differ from the reference");
    TEST_ASSERT_TRUE_MESSAGE(score.states >= states_at_least, "too few reference states read");
}

static void test_accelerations_of_the_dissertations_mechanisms(void) {
    check_folder("core/models/", 120);
}

static void test_accelerations_of_textbook_mechanisms_and_systems(void) {
    check_folder("tests/mechanisms/", 186);
}

void suite_reference(void) {
    RUN_TEST(test_accelerations_of_the_dissertations_mechanisms);
    RUN_TEST(test_accelerations_of_textbook_mechanisms_and_systems);
}
