/* board_tests.c: the frame for tests called by name (board_tests.h). */
#include "tests/tools/board_tests.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/scattered.h"

const char *image;
char why[300];

unsigned below(unsigned limit) { return (unsigned)(scattered() >> 33) % limit; }

bool no(const char *form, ...) {
    va_list list;
    va_start(list, form);
    (void)vsnprintf(why, sizeof why, form, list);
    va_end(list);
    return false;
}

/* A whole number from 1 to 1,000,000,000; 0: not a number. */
static unsigned long number_of(const char *word) {
    char *end = NULL;
    const unsigned long number = strtoul(word, &end, 10);
    return *word >= '0' && *word <= '9' && *end == '\0' && number <= 1000000000UL ? number : 0UL;
}

const board_test *board_test_asked(int count, char **words, const board_test *tests, size_t of,
                                   board_test *asked) {
    const unsigned long seed = count > 4 ? number_of(words[4]) : 1UL;
    const unsigned long times = count > 3 ? number_of(words[3]) : 1UL;
    if (count < 3 || count > 5 || seed == 0 || times == 0) {
        fprintf(stderr,
                "usage: %s TEST IMAGE [TIMES [SEED]], whole numbers from 1 on\ntests:", words[0]);
        for (size_t i = 0; i < of; i++) {
            fprintf(stderr, " %s", tests[i].name);
        }
        fputc('\n', stderr);
        return NULL;
    }
    image = words[2];
    FILE *file = fopen(image, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s: error: cannot be read\n", image);
        return NULL;
    }
    fclose(file);
    scattered_state = 0x9E3779B97F4A7C15U + seed;
    for (size_t i = 0; i < of; i++) {
        if (strcmp(words[1], tests[i].name) == 0) {
            *asked = tests[i];
            asked->times = count > 3 ? (unsigned)times : tests[i].times;
            return asked;
        }
    }
    fprintf(stderr, "%s: error: there is no test '%s'\n", words[0], words[1]);
    return NULL;
}

int board_test_tell(bool good, const char *what) {
    printf("%s - %s%s%s\n", good ? "ok" : "not ok", what, good ? "" : ": ", good ? "" : why);
    return good ? 0 : 1;
}
