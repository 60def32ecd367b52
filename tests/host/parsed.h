/* parsed.h: for the tests of host/lang: one text at a time, parsed, and an instance of it. */
#ifndef TESTS_HOST_PARSED_H
#define TESTS_HOST_PARSED_H

#include "host/lang/model.h"

/* The text at hand; NULL before parse(), instantiate(). */
extern diags *said;
extern whirl_model *parsed;
extern instance *made;

/* Parse a good text, called x.whirl; the test fails when the language refuses it. Returns its first
 * mechanism. */
const mechanism *parse(const char *text);
/* The first scene (or the first mechanism when there is none) with these changes; fails like parse(). */
void instantiate(const overrides *changes);
/* What was refused before was refused with these words. */
void expect_said(const char *wanted);
/* Free all three. */
void drop(void);

/* The instance's parameter of that name. */
double parameter(const char *name);

/* The same number; within 4e-16 of it. */
void expect_exactly(double wanted, double got);
void expect_nearly(double wanted, double got);

#endif
