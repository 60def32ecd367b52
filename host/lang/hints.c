#include "hints.h"

#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/value.h"

/* A rate in SI units, far below the rates of real motions. */
#define NEAR_REST 1e-6

/* Does the tree depend on coordinates or rates other than the rate of `own`? */
static bool names_others(const expr *tree, const symbol *own) {
    if (tree == NULL || (tree->uses & USES_UNKNOWNS) == 0) {
        return false;
    }
    if (tree->op == EXPR_SYMBOL) {
        return tree->symbol->kind == SYM_LET ? names_others(tree->symbol->value, own)
                                             : tree->symbol != own || tree->primes != 1;
    }
    return names_others(tree->left, own) || names_others(tree->right, own);
}

/* Does the tree contain a sign() whose argument depends on the rate of `own`, and on no other coordinate or rate? */
static bool has_sign_of_rate(const expr *tree, const symbol *own) {
    if (tree == NULL || (tree->uses & USES_UNKNOWNS) == 0) {
        return false;
    }
    if (tree->op == EXPR_SYMBOL) {
        return tree->symbol->kind == SYM_LET && has_sign_of_rate(tree->symbol->value, own);
    }
    const bool here = tree->op == EXPR_CALL && tree->function == FN_SIGN &&
                      (tree->left->uses & USES_UNKNOWNS) != 0 && !names_others(tree->left, own);
    return here || has_sign_of_rate(tree->left, own) || has_sign_of_rate(tree->right, own);
}

static double term_at(const term *of, const symbol *coordinate, valuation *known, double rate) {
    double *now = &known->state[coordinate->index][1];
    const double start = *now;
    *now = rate;
    memset(known->let_known, 0, (size_t)known->of->let_count * sizeof *known->let_known);
    const double value = expr_value(of->value, known);
    *now = start;
    return value;
}

/* Does the force drop suddenly at rate 0? The drop of a smooth force would be proportional to the rate. */
static bool opposes_at_rest(const term *of, valuation *known) {
    const symbol *own = of->coordinate;
    const double jump = term_at(of, own, known, NEAR_REST) - term_at(of, own, known, -NEAR_REST);
    const double nearer =
        term_at(of, own, known, 0.1 * NEAR_REST) - term_at(of, own, known, -0.1 * NEAR_REST);
    return jump < 0.0 && nearer < 0.5 * jump;
}

/* Second difference of F at rate 0, with the step `rate`. */
static double bend(const term *of, const symbol *coordinate, valuation *known, double rate) {
    return term_at(of, coordinate, known, rate) + term_at(of, coordinate, known, -rate) -
           2.0 * term_at(of, coordinate, known, 0.0);
}

/* Has F a kink at rate 0? bend() is proportional to the rate if there is a kink, else to the square of the rate. */
static bool has_kink(const term *of, const symbol *coordinate, valuation *known) {
    const double size = term_at(of, coordinate, known, 0.0);
    const double far = bend(of, coordinate, known, NEAR_REST);
    const double near = bend(of, coordinate, known, 0.1 * NEAR_REST);
    return far > 1e-12 * (size < 0.0 ? -size : size) && near > 0.05 * far;
}

const term *hint_friction(const instance *made, const symbol **on) {
    const mechanism *of = made->mechanism;
    const term *found = NULL;
    struct arena *memory = arena_new();
    diags *unsaid = diags_new();
    valuation known = valuation_new(of, memory, unsaid);
    for (int i = 0; i < of->parameter_count; i++) {
        known.parameter[i] = made->parameter[i];
        known.parameter_state[i] = 2;
    }
    known.input = made->input;
    known.state = made->start;
    known.primes_most = 1;
    for (int i = 0; i < of->term_count && found == NULL; i++) {
        const term *each = &of->terms[i];
        if (each->kind == TERM_Q && each->coordinate != NULL && instance_has(made, each->effect) &&
            has_sign_of_rate(each->value, each->coordinate) && opposes_at_rest(each, &known)) {
            found = each;
            *on = each->coordinate;
        }
        for (int c = 0; c < of->coordinate_count && each->kind == TERM_F && found == NULL &&
                        instance_has(made, each->effect);
             c++) {
            if (has_kink(each, of->coordinates[c], &known)) {
                found = each;
                *on = of->coordinates[c];
            }
        }
    }
    diags_free(unsaid);
    arena_free(memory);
    return found;
}
