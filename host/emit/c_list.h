/* c_list.h: an operation list as C statements. */
#ifndef EMIT_C_LIST_H
#define EMIT_C_LIST_H

#include <stdio.h>

#include "host/image/op_list.h"

/* === the right-hand side of an operation from its row (host/image/op_list.h) ================== */

/* The parts of the rows that depend on the language. */
typedef struct op_style {
    void (*operand)(FILE *out, const op_list *t, int a);
    /* Writes the number of a leaf: `what` is l (linear), r (rate) or u (input), `a` its index. NULL: no row needs it. */
    void (*leaf)(FILE *out, const void *context, char what, int a);
    const void *context; /* context for leaf() */
} op_style;

/* Writes the operation; `form` is its row's text for the language. */
void op_text(FILE *out, const op_list *t, const op *o, const char *form, const op_style *style);

bool c_list_uses_phase(const op_list *t);
/* Has the list so many operations that the compiler should keep their order? */
bool c_list_is_long(const op_list *t);
/* Writes "(void)NAME;", unless NAME is used. */
void c_list_ignore(FILE *out, bool used, const char *name);
/* The input of a generated list for its sines and cosines: phases, or pairs of sine and cosine. */
typedef enum c_angles { C_PHASES, C_WAVES } c_angles;

/* Writes the statements, which store the results in the array `result`, and the closing brace. */
void c_list_body(FILE *out, const op_list *t, c_angles angles, const char *result);
/* Writes a whole wh_accel_fn (second order) or wh_slope_fn, or wh_turned_accel_fn or wh_turned_slope_fn. core/ calls it
 * through a pointer in a constant, so it must not require inlining: gcc -Og resolves the pointer too late for that and
 * reports an error. */
void c_list_function(FILE *out, const op_list *t, c_angles angles, const char *name, bool second,
                     bool by_pointer);

/* "step_matrix", the function that wh_step_matrix() calls. It is called at one place only, so inlining it takes no
 * flash on any processor. */
void c_list_matrix(FILE *out, const op_list *t);
/* Writes "cells", the tables of a list; nothing if there are none. */
void c_list_cells(FILE *out, const op_list *t);

/* Writes "waves", the wh_waves of a list that takes pairs, and their data. */
void c_list_waves(FILE *out, const op_list *t);

#endif
