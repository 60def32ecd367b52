/* test_step_by_hand.c: test_step.c with stages that are unrolled by hand (core/step/stage_sums.h), as for compilers that cannot be
 * asked to: each stage then has a check of its own, and must refuse what the loop refuses. */
#define WH_UNROLL
#define suite_step suite_of_steps
#include "test_step.c" // NOLINT(bugprone-suspicious-include): the same tests

void suite_step_by_hand(void);

void suite_step_by_hand(void) { suite_of_steps(); }
