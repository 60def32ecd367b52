/* shown.h: the units in which people read numbers: the declared one, or SI. */
#ifndef LANG_SHOWN_H
#define LANG_SHOWN_H

#include "model.h"

/* The unit in which a coordinate or state (its derivative with so many primes) or an output is shown.
 * It is the declared one, for a derivative per second: [deg] makes deg/s, deg/s^2. What has none is
 * shown in SI. */
unit_scale shown_unit(const symbol *s, int primes);

/* Its name: "deg/s", "kg*m/s^2", "rad", "1". The caller frees it. */
char *shown_unit_name(const symbol *s, int primes);

/* The name of the SI unit of the same. The caller frees it. */
char *shown_si_name(const symbol *s, int primes);

/* The text of a value as it stands in the file or on the command line, "0.72 [lb]"; its blanks are single. NULL where
 * there is no text. The caller frees it. */
char *shown_written(const expr *given);
/* The same of a formula; NULL for one number, with a unit or without. */
char *shown_formula(const expr *given);

/* "theta'=3 [rad/s]" of a number in SI, as options take it: with the unit where the declared one is not SI. The caller
 * frees it. */
char *shown_assignment(const symbol *s, int primes, const char *number);

/* The SI unit of a dimension into text[size]: "rad", "m/s", "kg*m^2/s^2", "1". Returns text. */
const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size);

#endif
