/* parsed.h: parses and instantiates one text at a time, for tests of host/lang. */
#ifndef TESTS_HOST_PARSED_H
#define TESTS_HOST_PARSED_H

#include "host/lang/model.h"

/* The results of parse() and instantiate(); NULL before the call. */
extern diags *said;
extern whirl_model *parsed;
extern instance *made;

/* Parses a text under the file name x.whirl and returns its first mechanism. If the text is refused, the test fails. */
const mechanism *parse(const char *text);
/* Instantiates the first scene, or the mechanism if there are no scenes, with these changes. If the scene is
 * refused, the test fails. */
void instantiate(const overrides *changes);
/* Fails the test if the last refusal does not contain `wanted`, or if it has an empty hint. */
void expect_said(const char *wanted);
/* Frees the results of parse() and instantiate(), and `said`. */
void drop(void);

double parameter(const char *name);

/* expect_exactly() fails the test if the numbers are not equal; expect_nearly() fails if they differ by more than a
 * relative 4e-16. */
void expect_exactly(double wanted, double got);
void expect_nearly(double wanted, double got);

#endif
