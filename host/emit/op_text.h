/* op_text.h: an operation's right-hand side, by its row (host/image/op_rows.h). */
#ifndef EMIT_OP_TEXT_H
#define EMIT_OP_TEXT_H

#include <stdio.h>

#include "host/image/tape.h"

/* How one language writes what rows leave open. */
typedef struct op_style {
    /* The operand that is operation a. */
    void (*operand)(FILE *out, const tape *t, int a);
    /* What a leaf counts: `what` is l, r or u, `a` its place; NULL where no row asks for it. */
    void (*leaf)(FILE *out, const void *context, char what, int a);
    const void *context; /* of leaf() */
} op_style;

/* `form` is the row's text for the language. */
void op_text(FILE *out, const tape *t, const op *o, const char *form, const op_style *style);

#endif
