/* named_cures.h: the options in a warning's hints, read as a user reads them. */
#ifndef TESTS_HOST_NAMED_CURES_H
#define TESTS_HOST_NAMED_CURES_H

#include <stdbool.h>

enum { CURE_WORD = 40, NAMED_CURES = 4 };

/* One alternative of a hint; "" for an option that it does not name. */
typedef struct named_cure {
    char step[CURE_WORD]; /* as written, "200us" */
    char method[CURE_WORD];
    bool compensated;
    bool in_double;
    bool tried; /* false if the hint says "not tried" */
} named_cure;

/* Writes the alternatives of all hints in `err` in order to list[NAMED_CURES] and returns their number. Hints read "A would
 * do, or B (not tried)", "A should do (not tried: ...)" or "A resolves it; ..."; an A may be "A1 or A2". */
int named_cures(const char *err, named_cure *list);

/* The first alternative that names a step; false if there is none. */
bool named_with_step(const char *err, named_cure *cure);

/* Appends the alternative's options to words[count], then NULL; `number` is the format if it names none. Returns the
 * new count. */
int named_words(const named_cure *cure, const char *method, const char *number, const char **words,
                int count);

#endif
