#include "op_text.h"

static void operands(FILE *out, const op_list *t, const op *o, const op_style *style) {
    style->operand(out, t, o->a);
    if (o->b >= 0) {
        fputs(", ", out);
        style->operand(out, t, o->b);
    }
}

/* The test for a NaN; empty for a constant. */
static void or_no_number(FILE *out, const op_list *t, int b, const op_style *style) {
    if (t->ops[b].code != OP_CONSTANT) {
        fputs(" || ", out);
        style->operand(out, t, b);
        fputs(" != ", out);
        style->operand(out, t, b);
    }
}

void op_text(FILE *out, const op_list *t, const op *o, const char *form, const op_style *style) {
    for (const char *at = form; *at != '\0'; at++) {
        if (*at != '$') {
            fputc(*at, out);
            continue;
        }
        at++;
        switch (*at) {
        case 'a': style->operand(out, t, o->a); break;
        case 'b': style->operand(out, t, o->b); break;
        case 'f': fputs(function_name(o->function), out); break;
        case 'o': operands(out, t, o, style); break;
        case 'n': or_no_number(out, t, o->b, style); break;
        case 'i': fprintf(out, "%d", o->a); break;
        case 'v': fprintf(out, "%.0f", o->value); break;
        default: style->leaf(out, style->context, *at, o->a); break;
        }
    }
}
