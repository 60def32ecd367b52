/* c_list.h: an operation list as C statements. */
#ifndef EMIT_C_LIST_H
#define EMIT_C_LIST_H

#include <stdio.h>

#include "host/image/op_list.h"

/* === the right-hand side of an operation from its row (host/image/op_list.h) ================== */

/* The parts of the rows that depend on the language. */
typedef struct op_style {
    void (*operand)(FILE *out, const op_list *t, int a);
    /* Writes element `a` of l (linear), r (rate) or u (input), as `what` says. NULL: no row needs it. */
    void (*leaf)(FILE *out, const void *context, char what, int a);
    const void *context; /* for leaf() */
} op_style;

/* `form` is the row's text for the language. */
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
/* Writes a wh_accel_fn (second order) or wh_slope_fn, or the wh_turned_ forms. `linkage` is replaced by "static" if the
 * list is long. WH_INLINE: the core calls the function at one place, so that inlining takes no flash. C_BY_POINTER: the
 * core calls it through a pointer in a constant, which gcc -Og resolves too late for inlining, so the function must not
 * require inlining. */
#define C_BY_POINTER "static inline"
void c_list_function(FILE *out, const op_list *t, c_angles angles, const char *name, bool second,
                     const char *linkage);

/* Writes "cells", the tables of a list, if there are any. */
void c_list_cells(FILE *out, const op_list *t);

/* Writes "waves", the wh_waves of a list that takes pairs, and their data. */
void c_list_waves(FILE *out, const op_list *t);

#endif
