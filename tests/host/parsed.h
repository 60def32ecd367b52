/* parsed.h: one text at a time, parsed and instantiated, for tests of host/lang. */
#ifndef TESTS_HOST_PARSED_H
#define TESTS_HOST_PARSED_H

#include "host/lang/model.h"

/* The current text; NULL before parse() and instantiate(). */
extern diags *said;
extern whirl_model *parsed;
extern instance *made;

/* Parses a text named x.whirl and returns its first mechanism. A refusal fails the test. */
const mechanism *parse(const char *text);
/* Instantiates the first scene (or mechanism, without scenes) with these changes. A refusal fails the test. */
void instantiate(const overrides *changes);
/* The last refusal must contain these words. */
void expect_said(const char *wanted);
/* Frees what parse() and instantiate() made, and `said`. */
void drop(void);

double parameter(const char *name);

/* expect_exactly(): the numbers are equal. expect_nearly(): they differ by at most a relative 4e-16. */
void expect_exactly(double wanted, double got);
void expect_nearly(double wanted, double got);

#endif
