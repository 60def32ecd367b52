#include "contacts.h"
#include "test.h"

#define REFERENCE "tests/reference/contacts.txt"
#define LINE_MAX_BYTES 1024

/* The part after the second bar of the line of scene `of` at `at`. */
static void line_of(const char *of, const char *at, char line[LINE_MAX_BYTES]) {
    char wanted[128];
    snprintf(wanted, sizeof wanted, ":%s | %s | ", of, at);
    FILE *file = fopen(REFERENCE, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, REFERENCE " cannot be read: run from the project's root");
    bool found = false;
    while (!found && fgets(line, LINE_MAX_BYTES, file) != NULL) {
        const char *rest = strstr(line, wanted);
        found = rest != NULL;
        if (found) {
            rest += strlen(wanted);
            memmove(line, rest, strlen(rest) + 1);
        }
    }
    fclose(file);
    TEST_ASSERT_TRUE_MESSAGE(found, wanted);
}

double contacts_reference(const char *of, const char *at, const char *name) {
    char line[LINE_MAX_BYTES];
    char *rest = NULL;
    const size_t length = strlen(name);
    line_of(of, at, line);
    for (char *word = strtok_r(line, " \n", &rest); word != NULL;
         word = strtok_r(NULL, " \n", &rest)) {
        if (strncmp(word, name, length) == 0 && word[length] == '=') {
            return strtod(word + length + 1, NULL);
        }
    }
    TEST_FAIL_MESSAGE(name);
    return (double)NAN;
}

double contacts_error(const motion *m, const char *of, const char *time) {
    char line[LINE_MAX_BYTES];
    char *rest = NULL;
    double largest = 0.0;
    int states = 0;
    line_of(of, time, line);
    for (char *word = strtok_r(line, " \n", &rest); word != NULL;
         word = strtok_r(NULL, " \n", &rest)) {
        char *equals = strchr(word, '=');
        TEST_ASSERT_NOT_NULL_MESSAGE(equals, word);
        *equals = '\0';
        const double error = fabs(motion_value(m, word) - strtod(equals + 1, NULL));
        TEST_ASSERT_TRUE_MESSAGE(isfinite(error), word);
        largest = fmax(largest, error);
        states++;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(2 * m->equations->count, states, "a state is missing");
    return largest;
}

uint64_t contacts_events(const motion *m) {
    uint64_t overruns;
    return m->kind->events(m->run, &overruns);
}

uint64_t contacts_overruns(const motion *m) {
    uint64_t overruns;
    (void)m->kind->events(m->run, &overruns);
    return overruns;
}

uint64_t contacts_steps(const motion *m) { return m->instance->steps; }
