/* finish.c: what can only be checked when a whole mechanism has been read. */
#include <string.h>

#include "statements.h"

enum { SEEN_IN_EQUATION = 1, SEEN_IN_OUTPUT = 2 };

/* The highest derivative of each state in the equations. Each let is walked once; recursion is
 * bounded by EXPR_HEIGHT_MAX. */
static void raise_orders(const expr *tree) {
    if (tree == NULL) {
        return;
    }
    if (tree->op == EXPR_SYMBOL && tree->symbol != NULL) {
        named *entry = (named *)tree->symbol;
        if (entry->symbol.kind == SYM_STATE && tree->primes > entry->symbol.order) {
            entry->symbol.order = tree->primes;
        }
        if (entry->symbol.kind == SYM_LET && entry->mark != SEEN_IN_EQUATION) {
            entry->mark = SEEN_IN_EQUATION;
            raise_orders(entry->symbol.value);
        }
    }
    raise_orders(tree->left);
    raise_orders(tree->right);
}

/* Outputs may use a state up to its highest derivative. */
static void check_orders(parser *in, const expr *tree) {
    if (tree == NULL) {
        return;
    }
    if (tree->op == EXPR_SYMBOL && tree->symbol != NULL) {
        named *entry = (named *)tree->symbol;
        if (entry->symbol.kind == SYM_STATE && tree->primes > entry->symbol.order) {
            diag_error(in->diags, tree->at, NULL,
                       "no equation has this derivative of '%s': its highest has %d prime%s",
                       entry->symbol.name, entry->symbol.order,
                       entry->symbol.order == 1 ? "" : "s");
        }
        if (entry->symbol.kind == SYM_LET && entry->mark == 0) {
            entry->mark = SEEN_IN_OUTPUT;
            check_orders(in, entry->symbol.value);
        }
    }
    check_orders(in, tree->left);
    check_orders(in, tree->right);
}

static void finish_system(parser *in, builder *done) {
    mechanism *made = done->made;
    if (made->coordinate_count == 0) {
        diag_error(in->diags, made->at, "declare one with: state x", "mechanism '%s' has no state",
                   made->name);
        return;
    }
    if (done->equation_count != made->coordinate_count) {
        diag_error(in->diags, made->at, NULL,
                   "mechanism '%s' has %d state%s but %d equation%s: as many are needed",
                   made->name, made->coordinate_count, made->coordinate_count == 1 ? "" : "s",
                   done->equation_count, done->equation_count == 1 ? "" : "s");
        return;
    }
    for (int i = 0; i < made->term_count; i++) {
        raise_orders(made->terms[i].value);
        raise_orders(made->terms[i].right);
    }
    for (int i = 0; i < made->coordinate_count; i++) {
        const symbol *state = made->coordinates[i];
        if (state->order == 0) {
            diag_error(in->diags, state->at, "at least one equation must contain it with a prime",
                       "no equation has a derivative of '%s'", state->name);
            return;
        }
    }
    for (int i = 0; i < made->output_count; i++) {
        check_orders(in, made->outputs[i]->value);
    }
}

/* All of T may come from effects: which scene has any is seen when its equations are derived. */
static bool has_kinetic_energy(const mechanism *made) {
    for (int i = 0; i < made->term_count; i++) {
        if (made->terms[i].kind == TERM_T) {
            return true;
        }
    }
    return false;
}

void finish_mechanism(parser *in, builder *done) {
    mechanism *made = done->made;
    made->is_system = done->has_equations;
    if (done->nameless || done->broken || done->mixed) {
        return; /* what seems to be missing may stand in the lines that failed */
    }
    if (made->is_system) {
        finish_system(in, done);
        for (int i = 0; i < made->contact_count; i++) {
            contact_on_system(in, &made->contacts[i]);
        }
    } else if (made->coordinate_count == 0) {
        diag_error(in->diags, made->at, "declare one with: coordinate theta [rad]",
                   "mechanism '%s' has no coordinate", made->name);
    } else if (done->energy_at[0].line == 0 && !has_kinetic_energy(made)) {
        diag_error(in->diags, made->at, "T = m*X'^2/2", "mechanism '%s' has no kinetic energy T",
                   made->name);
    }
    finish_inputs(in, made);
}
