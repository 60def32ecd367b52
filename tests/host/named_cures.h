/* named_cures.h: what the hints of a warning say would do, read as a user reads it. */
#ifndef TESTS_HOST_NAMED_CURES_H
#define TESTS_HOST_NAMED_CURES_H

#include <stdbool.h>

enum { CURE_WORD = 40, NAMED_CURES = 4 };

/* One of the alternatives; "" for an option that it does not name. */
typedef struct named_cure {
    char step[CURE_WORD]; /* as written, "200us" */
    char method[CURE_WORD];
    bool compensated;
    bool in_double;
    bool tried; /* else the hint says that it was not */
} named_cure;

/* All that standard error names, in its order, into list[NAMED_CURES]; returns how many. Hints "A would do, or B (not tried)",
 * "A should do (not tried: ...)", "A resolves it; ..."; an A may be "A1 or A2". */
int named_cures(const char *err, named_cure *list);

/* The first of them that names a step; false without one. */
bool named_with_step(const char *err, named_cure *cure);

/* The command's words for it, behind words[count], up to a NULL; `number` where it names none. Returns how many there are then. */
int named_words(const named_cure *cure, const char *method, const char *number, const char **words,
                int count);

#endif
