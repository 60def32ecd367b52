/* printed.h: the printed text of every mechanism, for tests of host/emit. */
#ifndef TESTS_HOST_PRINTED_H
#define TESTS_HOST_PRINTED_H

#include "derived.h"

typedef void checker(const char *name, derived *d);

/* Calls `check` for built-in mechanisms and those of tests/mechanisms. */
void each_mechanism(checker *check);

typedef enum language { TEXT, STEPS, LATEX, LATEX_STEPS, FOLDED, OCTAVE } language;

/* The text of one writer; to be freed. */
char *printed(const derived *d, language as);

#endif
