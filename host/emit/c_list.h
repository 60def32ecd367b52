/* c_list.h: an operation list as C statements. */
#ifndef EMIT_C_LIST_H
#define EMIT_C_LIST_H

#include <stdio.h>

#include "host/image/op_list.h"

/* === code for one operation, from its row in OP_ROWS (host/image/op_list.h) =================== */

/* The parts of the rows that depend on the language. */
typedef struct op_style {
    void (*operand)(FILE *out, const op_list *t, int a);
    /* Writes leaf `a` of the list; `what`: l, r or u, as in OP_ROWS. NULL in C, which has none of these letters. */
    void (*leaf)(FILE *out, const void *context, char what, int a);
    const void *context; /* for leaf() */
} op_style;

/* Writes the right-hand side of operation `o`. `form`: the operation's text for C or Octave in OP_ROWS. */
void op_text(FILE *out, const op_list *t, const op *o, const char *form, const op_style *style);

bool c_list_uses_phase(const op_list *t);
/* Should the compiler keep the order of the operations, because there are many? */
bool c_list_is_long(const op_list *t);
/* Writes "(void)NAME;", unless NAME is used. */
void c_list_ignore(FILE *out, bool used, const char *name);
/* The arguments of a generated list: phases, or pairs of sine and cosine. */
typedef enum c_angles { C_PHASES, C_WAVES } c_angles;

/* Writes the statements, with results in the array `result`, and the closing brace. */
void c_list_body(FILE *out, const op_list *t, c_angles angles, const char *result);
/* Writes a wh_accel_fn (if `second`) or a wh_slope_fn; with C_WAVES a wh_turned_accel_fn or a wh_turned_slope_fn.
 * `linkage`: WH_INLINE, or C_BY_POINTER if the core calls the function through a pointer. A function with too many
 * operations for inlining becomes "static". */
#define C_BY_POINTER "static inline"
void c_list_function(FILE *out, const op_list *t, c_angles angles, const char *name, bool second,
                     const char *linkage);

/* Writes "cells", the tables of a list, if there are any. */
void c_list_cells(FILE *out, const op_list *t);

/* Writes the wh_waves `waves` and the functions that `waves` points to. op_list_takes_waves() must be true. */
void c_list_waves(FILE *out, const op_list *t);

#endif
