/* printed.h: for the tests of host/emit: what the writers print about every mechanism there is. */
#ifndef TESTS_HOST_PRINTED_H
#define TESTS_HOST_PRINTED_H

#include "derived.h"

typedef void checker(const char *name, derived *d);

/* Calls `check` for built-in mechanisms and for each of tests/mechanisms. */
void each_mechanism(checker *check);

typedef enum language { TEXT, STEPS, LATEX, LATEX_STEPS, FOLDED, OCTAVE } language;

/* What one writer prints; free() it. */
char *printed(const derived *d, language as);

#endif
