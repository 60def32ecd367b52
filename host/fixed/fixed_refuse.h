/* fixed_refuse.h: what a scene may have that fixed point has not, each refused at its place. */
#ifndef FIXED_FIXED_REFUSE_H
#define FIXED_FIXED_REFUSE_H

#include "host/image/image.h"
#include "interval.h"

/* Contacts, books, noise, other methods and settings: false, reported. */
bool fixed_has_step(const image *im, diags *errors);

/* Ranges of the reals and inputs: larger than anything may be, or a start outside its own: false, reported. */
bool fixed_ranges_hold(const image *im, const interval *range, diags *errors);

/* Code takes inputs that nobody has run yet: each input without a declared range is reported, with the range that a run
 * takes; false: there is one. */
bool fixed_inputs_declared(const image *im, const interval *range, diags *errors);

#endif
