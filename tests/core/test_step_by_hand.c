/* test_step_by_hand.c: test_step.c with stages unrolled by hand (core/step/stage_sums.h), for compilers that cannot be
 * asked to unroll. Each stage then has its own test for refusal, which must act like the test in the loop. */
#define WH_UNROLL
#define suite_step suite_of_steps
#include "test_step.c" // NOLINT(bugprone-suspicious-include): the same tests

void suite_step_by_hand(void);

void suite_step_by_hand(void) { suite_of_steps(); }
