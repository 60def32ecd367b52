/* not_linear.c: the innermost subexpression, in the spelling of the file, whose degree in the state is too high. */
#include "not_linear.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "affine.h"
#include "host/base/alloc.h"
#include "host/base/statement.h"
#include "host/number/functions.h"

/* The degree of an expression that is not a polynomial. Sums of degrees stay within an int. */
enum { NO_POWER = 1000 };

/* The dependencies of a node of the blame list. */
typedef struct made_of {
    int degree;      /* in states, rates and inputs together */
    uint64_t states; /* unknowns it depends on, a bit each: above 64 they share bits */
    uint64_t inputs; /* inputs, in the same way */
} made_of;

static uint64_t bit(int number) { return UINT64_C(1) << (number % 64); }

static int capped(int degree) { return degree > NO_POWER ? NO_POWER : degree; }

static int power(const image_blame *b, const made_of *of, const diagnostics_node *n) {
    const diagnostics_node *exponent = &b->node[n->b];
    const double e = exponent->code == DIAGNOSTICS_NUMBER ? exponent->number : -1.0;
    if (of[n->a].degree == 0 && of[n->b].degree == 0) {
        return 0;
    }
    for (int whole = 0; whole <= 8; whole++) {
        if (e == (double)whole) {
            return whole * of[n->a].degree;
        }
    }
    return NO_POWER;
}

static made_of node_made_of(const image_blame *b, const made_of *of, int i) {
    const diagnostics_node *n = &b->node[i];
    const bool has_a = n->code != DIAGNOSTICS_NUMBER && n->code != DIAGNOSTICS_STATE &&
                       n->code != DIAGNOSTICS_INPUT;
    const made_of none = {0, 0, 0};
    const made_of x = has_a ? of[n->a] : none;
    const made_of y =
        has_a && n->code != DIAGNOSTICS_SAME && n->code != DIAGNOSTICS_NEG && n->b >= 0 ? of[n->b]
                                                                                        : none;
    made_of both = {0, x.states | y.states, x.inputs | y.inputs};
    switch (n->code) {
    case DIAGNOSTICS_NUMBER: break;
    case DIAGNOSTICS_STATE: both = (made_of){1, bit(n->a), 0}; break;
    case DIAGNOSTICS_INPUT: both = (made_of){1, 0, bit(n->a)}; break;
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_NEG: both.degree = x.degree; break;
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB: both.degree = x.degree > y.degree ? x.degree : y.degree; break;
    case DIAGNOSTICS_MUL: both.degree = capped(x.degree + y.degree); break;
    case DIAGNOSTICS_DIV: both.degree = y.degree == 0 ? x.degree : NO_POWER; break;
    case DIAGNOSTICS_POW: both.degree = capped(power(b, of, n)); break;
    case DIAGNOSTICS_CALL: both.degree = x.degree == 0 && y.degree == 0 ? 0 : NO_POWER; break;
    }
    return both;
}

/* Has the operand next to one of degree `other` the same limit as the whole? If both operands are within their limits,
 * only their combination exceeds it. */
static bool passes_on(diagnostics_code code, int other) {
    switch (code) {
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_NEG:
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB: return true;
    case DIAGNOSTICS_MUL:
    case DIAGNOSTICS_DIV: return other == 0;
    case DIAGNOSTICS_POW:
    case DIAGNOSTICS_CALL:
    case DIAGNOSTICS_NUMBER:
    case DIAGNOSTICS_STATE:
    case DIAGNOSTICS_INPUT: return false;
    }
    return false;
}

/* The innermost part of `node` whose degree exceeds `most` while no operand's does. */
static int innermost(const image_blame *b, const made_of *of, int node, int most) {
    for (;;) {
        const diagnostics_node *n = &b->node[node];
        const bool has_b = n->code != DIAGNOSTICS_SAME && n->code != DIAGNOSTICS_NEG && n->b >= 0;
        const int degree_a = of[n->a].degree;
        const int degree_b = has_b ? of[n->b].degree : 0;
        if (degree_a > (passes_on(n->code, degree_b) ? most : NO_POWER - 1)) {
            node = n->a;
        } else if (degree_b > (passes_on(n->code, degree_a) ? most : NO_POWER - 1)) {
            node = n->b;
        } else {
            return node;
        }
    }
}

/* The names of the dependencies: "theta", "x and y", "x, y and M". */
static char *names(const image *im, made_of of) {
    char *text = NULL;
    size_t length = 0;
    const char *name[128];
    int count = 0;
    for (int i = 0; i < im->count && count < 64; i++) {
        if ((of.states & bit(i)) != 0) {
            name[count++] = im->unknown[i].name;
        }
    }
    for (int i = 0; i < im->inputs && count < 128; i++) {
        if ((of.inputs & bit(i)) != 0) {
            name[count++] = im->input[i].name;
        }
    }
    FILE *out = alloc_text(&text, &length);
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s%s", i == 0 ? "" : i + 1 < count ? ", " : " and ", name[i]);
    }
    alloc_text_end(out);
    return text;
}

static void report(const image *im, const made_of *of, int node, place where, diags *errors) {
    const diagnostics_node *n = &im->blame.node[node];
    const place at = n->at.source != NULL ? n->at : where;
    char *of_what = names(im, of[node]);
    char line[STATEMENT_SIZE];
    char what[64];
    statement_text(at, line, sizeof line);
    switch (n->code) {
    case DIAGNOSTICS_CALL:
        snprintf(what, sizeof what, "%s() of", function_name(n->function));
        break;
    case DIAGNOSTICS_DIV: snprintf(what, sizeof what, "a division by an expression of"); break;
    case DIAGNOSTICS_POW: snprintf(what, sizeof what, "a power of"); break;
    case DIAGNOSTICS_NUMBER:
    case DIAGNOSTICS_STATE:
    case DIAGNOSTICS_INPUT:
    case DIAGNOSTICS_SAME:
    case DIAGNOSTICS_ADD:
    case DIAGNOSTICS_SUB:
    case DIAGNOSTICS_MUL:
    case DIAGNOSTICS_NEG:
        snprintf(what, sizeof what, "a %s of", strchr(of_what, ' ') != NULL ? "product" : "power");
        break;
    }
    diag_error(errors, at, "leave out --matrix: stages step what is not linear",
               "%s %s in line %d makes '%s' not linear, so no matrix is a step of it: %s", what,
               of_what, at.line, im->name, line);
    free(of_what);
}

void not_linear_report(const image *im, int operation, diags *errors) {
    const image_blame *b = &im->blame;
    const int states = affine_states(im);
    made_of *of = alloc(b->nodes, sizeof *of);
    bool *taking = alloc(affine_columns(im), sizeof *taking);
    made_of wanted = {0, 0, 0};
    bool found = false;
    affine_takes(im, operation, taking);
    for (int i = 0; i < states + im->inputs; i++) {
        if (!taking[i]) {
            continue;
        }
        if (i < states) {
            wanted.states |= bit(image_component(im, i).unknown);
        } else {
            wanted.inputs |= bit(i - states);
        }
    }
    for (int i = 0; i < b->nodes; i++) {
        of[i] = node_made_of(b, of, i);
    }
    for (int k = 0; k < b->terms && !found; k++) {
        const diagnostics_question *q = &b->question[k];
        const int node =
            q->derived || of[q->node].degree <= q->power ? -1 : innermost(b, of, q->node, q->power);
        if (node >= 0 && ((of[node].states & wanted.states) | (of[node].inputs & wanted.inputs))) {
            report(im, of, node, q->where, errors);
            found = true;
        }
    }
    if (!found) {
        wanted.degree = NO_POWER;
        char *of_what = names(im, wanted);
        diag_error(errors, im->mechanism_at, "leave out --matrix: stages step what is not linear",
                   "the equations of '%s' are not linear in %s, so no matrix is a step of them",
                   im->mechanism, of_what);
        free(of_what);
    }
    free(of);
    free(taking);
}
