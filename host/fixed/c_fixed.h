/* c_fixed.h: generator of a scene's C code in fixed point. The code has the same operations as engine_fixed.c. */
#ifndef FIXED_C_FIXED_H
#define FIXED_C_FIXED_H

#include <stdio.h>

#include "host/fixed/fixed_plan.h"

/* The scene as C for core/fixed_scene.h, and its header for C and C++. */
void c_fixed(FILE *out, const fixed_plan *plan, const char *file);
void c_fixed_header(FILE *out, const fixed_plan *plan, const char *file);

#endif
