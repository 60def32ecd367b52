/* shown.h: the units of displayed numbers: the declared unit, or SI. */
#ifndef LANG_SHOWN_H
#define LANG_SHOWN_H

#include "model.h"

/* The display unit of an output, of a coordinate or state, or of its derivative with so many primes. It is the declared
 * unit; a derivative adds per second: [deg] becomes deg/s, deg/s^2. Without a declared unit it is SI. */
unit_scale shown_unit(const symbol *s, int primes);

/* Its name: "deg/s", "kg*m/s^2", "rad", "1". The caller frees it. */
char *shown_unit_name(const symbol *s, int primes);

/* The name of the SI unit of the same quantity. The caller frees it. */
char *shown_si_name(const symbol *s, int primes);

/* The text of a value in the file or on the command line, "0.72 [lb]", with single blanks. NULL without a text. The
 * caller frees it. */
char *shown_written(const expr *given);
/* The same for a formula; NULL for a single number, with or without a unit. */
char *shown_formula(const expr *given);

/* "theta'=3 [rad/s]" for a number in SI, in the form of an option. The unit is included if the declared unit is not SI.
 * The caller frees it. */
char *shown_assignment(const symbol *s, int primes, const char *number);

/* The SI unit of a dimension into text[size]: "rad", "m/s", "kg*m^2/s^2", "1". Returns text. */
const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size);

#endif
