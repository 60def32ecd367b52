/* exponential.h: one step of x' = A x + B u + c with all but x held: what is added to x. */
#ifndef DERIVE_EXPONENTIAL_H
#define DERIVE_EXPONENTIAL_H

#include "host/number/twofold.h"

/* step[states * columns], on entry the rates A | B | c times the step, becomes exp([A B c; 0 0 0] h) - 1 without its lower
 * rows: what one step adds to the states. Scaling and squaring of the exponential less one, so that what a step hardly
 * changes keeps its digits (Moler & Van Loan, Nineteen Dubious Ways to Compute the Exponential of a Matrix, method 3), after
 * balancing by powers of two. False where a number outgrows the doubles, or the steps that were needed to begin with are
 * so small that digits would be lost: step[] is then of no use. */
bool exponential_exact(twofold *step, int states, int columns);

/* The same, but the exponential's series ends with the power `order`: what a Runge-Kutta method of that order and as many
 * stages makes of it, whatever its weights. */
void exponential_series(twofold *step, int states, int columns, int order);

#endif
