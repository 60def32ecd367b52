/* printed.h: the printed text of every mechanism, for tests of host/emit. */
#ifndef TESTS_HOST_PRINTED_H
#define TESTS_HOST_PRINTED_H

#include "derived.h"

typedef void checker(const char *name, derived *d);

/* Calls `check` for each built-in mechanism and each mechanism of tests/mechanisms. */
void each_mechanism(checker *check);

typedef enum language { TEXT, STEPS, LATEX, LATEX_STEPS, FOLDED, OCTAVE } language;

/* The derivation as one writer prints it. The caller frees the text. */
char *printed(const derived *d, language as);

#endif
