/* named_cures.h: reads the options that a warning's hints name, in the way a user reads them. */
#ifndef TESTS_HOST_NAMED_CURES_H
#define TESTS_HOST_NAMED_CURES_H

#include <stdbool.h>

enum { CURE_WORD = 40, NAMED_CURES = 4 };

/* One alternative of a hint. An option that the hint does not name is "". */
typedef struct named_cure {
    char step[CURE_WORD]; /* as written, such as "200us" */
    char method[CURE_WORD];
    bool compensated;
    bool in_double;
    bool tried; /* false if the hint says "not tried" or "should do" */
} named_cure;

/* Reads all hints in `err`. Writes their alternatives in the sequence of the text to list[NAMED_CURES] and returns
 * the number of alternatives. A hint reads "A would do, or B (not tried)", "A should do (not tried: ...)" or "A
 * resolves it; ...". A and B may be lists, "A1 or A2". */
int named_cures(const char *err, named_cure *list);

/* *cure: the first alternative that names a step. Returns false if no alternative does. */
bool named_with_step(const char *err, named_cure *cure);

/* Appends the alternative's options and NULL to words[count]. `method` and `number` are used if the alternative does
 * not name them. Returns the new count, without NULL. */
int named_words(const named_cure *cure, const char *method, const char *number, const char **words,
                int count);

#endif
