/* fixed_range.h: the ranges that components and inputs of a scene keep to. */
#ifndef FIXED_FIXED_RANGE_H
#define FIXED_FIXED_RANGE_H

#include "host/image/image.h"
#include "host/number/enclosure.h"

/* range[reals + inputs] of components, then inputs, as declared. An undeclared range comes from a reference run of the scene
 * (double, its method). It reaches twice as far from zero as the run; or half as near, if the run stays on one side of zero;
 * -1 to 1 if it stays zero. False: that run failed (reported), or was interrupted. `progress`: shown on standard error. */
bool fixed_ranges(const image *im, enclosure *range, bool *declared, bool progress, diags *errors);

#endif
