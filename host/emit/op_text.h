/* op_text.h: the right-hand side of an operation from its row (host/image/op_list.h). */
#ifndef EMIT_OP_TEXT_H
#define EMIT_OP_TEXT_H

#include <stdio.h>

#include "host/image/op_list.h"

/* The language-dependent parts of the rows. */
typedef struct op_style {
    /* Writes operand a. */
    void (*operand)(FILE *out, const op_list *t, int a);
    /* Writes the number of a leaf: `what` is l, r or u, `a` its index. NULL if no row needs it. */
    void (*leaf)(FILE *out, const void *context, char what, int a);
    const void *context; /* of leaf() */
} op_style;

/* `form` is the row's text for the language. */
void op_text(FILE *out, const op_list *t, const op *o, const char *form, const op_style *style);

#endif
