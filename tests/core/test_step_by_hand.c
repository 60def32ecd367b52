/* test_step_by_hand.c: test_step.c with stages that are unrolled by hand (core/stage_sums.h), as for compilers that cannot be
 * asked to: each stage then has a check of its own, and must refuse what the loop refuses. */
#define WH_UNROLL
#define suite_step suite_step_by_hand
#include "test_step.c" // NOLINT(bugprone-suspicious-include): the same tests
