/* c_fixed_list.h: a list in fixed point as C. */
#ifndef FIXED_C_FIXED_LIST_H
#define FIXED_C_FIXED_LIST_H

#include <inttypes.h>
#include <stdio.h>

#include "fixed_list.h"

/* The function `accelerations`. */
void c_fixed_list(FILE *out, const fixed_list *list, bool second);

/* A number as C has it: INT32_C(-5) is no constant of its own. */
void c_fixed_number(FILE *out, int32_t number);

#endif
