/* taylor_bounds.h: bounds of an operation list on a part of a step, by Taylor forms of second order in the time (Moore, Kearfott,
 * Cloud, Introduction to Interval Analysis, 2009, chapter 6).
 *
 * Natural interval bounds of a multiplied-out polynomial are wide: x occurs in it several times, as if each were another x.
 * Here each operation carries its value and slope at the middle of the part, and bounds of value, slope and curvature on the
 * part. Each value is cut with  f(m) + f'(m) d + f''(part) d^2/2  and with  f(m) + f'(part) d. */
#ifndef CHECK_TAYLOR_BOUNDS_H
#define CHECK_TAYLOR_BOUNDS_H

#include "host/image/image.h"
#include "host/number/enclosure.h"

typedef struct taylor_bounds_bounds taylor_bounds_bounds;

/* A list of the image that reads places, rates and inputs. */
taylor_bounds_bounds *taylor_bounds_open(const image *im, const op_list *t);
void taylor_bounds_close(taylor_bounds_bounds *a); /* NULL is fine */
/* The way: the cubic through places and rates at its ends, `span_s` apart; from, to: [angles + reals], angles in radians. */
void taylor_bounds_way(taylor_bounds_bounds *a, const double *from, const double *to,
                       double span_s);
/* Natural bounds of one result on the whole way: a quick test. */
enclosure taylor_bounds_glance(taylor_bounds_bounds *a, int result);
/* Bound one result, or all (-1), on the part from `low` to `high`, shares of the way. */
void taylor_bounds_look(taylor_bounds_bounds *a, int result, double low, double high);
enclosure taylor_bounds_value(const taylor_bounds_bounds *a, int result);  /* on the part */
enclosure taylor_bounds_middle(const taylor_bounds_bounds *a, int result); /* at its middle */
/* By how much it would change on the whole way, at its slope and curvature there. */
double taylor_bounds_change(const taylor_bounds_bounds *a, int result);

#endif
