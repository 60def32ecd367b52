/* input_rate.c: inputs with a rate. Inside a step such an input moves like a coordinate of given acceleration. */
#include <stdio.h>
#include <string.h>

#include "host/lang/statements.h"
#include "shown.h"

const symbol *symbol_moving(const symbol *s, int *primes) {
    if (s->kind != SYM_INPUT || s->driven == NULL) {
        return s;
    }
    *primes = s->driven->driven == s ? 0 : 1;
    return s->driven;
}

const symbol *symbol_acceleration(const symbol *driven) { return driven->driven->rate->rate; }

char *input_rate_hint(const symbol *input, char *buffer) {
    char unit[DIM_TEXT_SIZE];
    dimension dim = input->dim;
    const char *rest = input->at.source->text + input->at.offset + strlen(input->name);
    const int length = (int)strcspn(rest, "#\";\r\n");
    (void)dim_divide(input->dim, dim_of(0, 0, 1, 0, 0), &dim);
    dimension_unit(dim, false, unit, sizeof unit);
    snprintf(buffer, RATE_HINT_SIZE,
             "input %.40s rate %.40s_rate%.*s; input %.40s_rate = 0 [%.40s]", input->name,
             input->name, length < 100 ? length : 0, rest, input->name,
             strcmp(unit, "1") == 0 ? "rad" : unit);
    return buffer;
}

/* Is the rate an input of the right kind? */
static bool check_rate(parser *in, const mechanism *made, const symbol *s) {
    const named *rate = (const named *)s->rate;
    char unit[DIM_TEXT_SIZE];
    char hint[RATE_HINT_SIZE];
    dimension wanted;
    if (s->dim.unknown || rate->symbol.dim.unknown ||
        !dim_divide(s->dim, dim_of(0, 0, 1, 0, 0), &wanted)) {
        return false;
    }
    dimension_unit(wanted, false, unit, sizeof unit);
    snprintf(hint, sizeof hint, "input %s = 0 [%s]", rate->symbol.name, unit);
    if (rate->is_placeholder) {
        diag_error(in->diags, s->at, hint, "no input is called '%s', the rate of '%s'",
                   rate->symbol.name, s->name);
    } else if (rate->symbol.kind != SYM_INPUT || rate->symbol.effect >= 0) {
        diag_error(in->diags, s->at, hint,
                   "the rate of input '%s' is another input of the mechanism", s->name);
    } else if (!dim_fits(rate->symbol.dim, wanted)) {
        diag_error(in->diags, rate->symbol.at, hint, "the rate of input '%s' must be in [%s]",
                   s->name, unit);
    } else if (made->is_system) {
        diag_error(in->diags, s->at, "write a state for it, and its equation",
                   "an input with a rate does not go with state and equation");
    } else if (rate->symbol.rate != NULL && rate->symbol.rate->rate != NULL) {
        diag_error(in->diags, rate->symbol.rate->at, "leave out its rate",
                   "'%s' is the acceleration of '%s': it takes no rate", rate->symbol.rate->name,
                   s->name);
    } else {
        return true;
    }
    return false;
}

static bool is_rate(const mechanism *made, const symbol *s) {
    bool is = false;
    for (int i = 0; i < made->input_count; i++) {
        is = is || made->inputs[i]->rate == s;
    }
    return is;
}

/* Add the coordinate that follows the input. */
static void drive(parser *in, mechanism *made, named *input) {
    named *coordinate = arena_alloc(in->arena, sizeof *coordinate);
    named *rate = (named *)input->symbol.rate;
    const symbol **longer =
        arena_room(in->arena, made->coordinates, made->coordinate_count, sizeof *longer);
    coordinate->symbol = input->symbol;
    coordinate->symbol.kind = SYM_COORDINATE;
    coordinate->symbol.order = 2;
    coordinate->symbol.value = NULL;
    coordinate->symbol.index = made->coordinate_count;
    coordinate->symbol.driven = &input->symbol;
    longer[made->coordinate_count++] = &coordinate->symbol;
    made->coordinates = longer;
    input->symbol.driven = &coordinate->symbol;
    rate->symbol.driven = rate->symbol.driven != NULL ? rate->symbol.driven : &coordinate->symbol;
}

/* An input without a rate in the expression, or with `rates` one that is a rate; NULL if there is none. Each let is
 * visited once. */
static const symbol *find_input(const mechanism *made, const expr *tree, bool rates, int mark) {
    if (tree == NULL || (tree->uses & USES_INPUT) == 0) {
        return NULL;
    }
    if (tree->op == EXPR_SYMBOL && tree->symbol->kind == SYM_INPUT) {
        const bool found = rates ? is_rate(made, tree->symbol) : tree->symbol->rate == NULL;
        return found ? tree->symbol : NULL;
    }
    if (tree->op == EXPR_SYMBOL) {
        named *entry = (named *)tree->symbol;
        if (entry->mark == mark) {
            return NULL;
        }
        entry->mark = mark;
        return find_input(made, tree->symbol->value, rates, mark);
    }
    const symbol *found = find_input(made, tree->left, rates, mark);
    return found != NULL ? found : find_input(made, tree->right, rates, mark);
}

/* A hold fixes a value, so it needs the rates of the inputs in it. */
static void check_contact(parser *in, const mechanism *made, const contact_statement *each,
                          int mark) {
    char hint[RATE_HINT_SIZE];
    const symbol *rate = find_input(made, each->value, true, mark);
    if (rate != NULL) {
        diag_error(in->diags, each->value->at, "write what is to be limited or held, not its rate",
                   "stop and hold act on coordinates: they take no rate, as '%s' is", rate->name);
        return;
    }
    const symbol *input =
        each->kind == CONTACT_HOLD ? find_input(made, each->value, false, mark - 1) : NULL;
    if (input != NULL) {
        diag_error(in->diags, each->value->at, input_rate_hint(input, hint),
                   "what is held contains the input '%s', whose rate is not known", input->name);
    }
}

void finish_inputs(parser *in, mechanism *made) {
    int mark = -1;
    for (int i = 0; i < made->input_count; i++) {
        const symbol *s = made->inputs[i];
        if (s->rate == NULL || !check_rate(in, made, s) || is_rate(made, s)) {
            continue;
        }
        if (made->coordinate_count == COORDINATES_MAX) {
            diag_error(in->diags, s->at, NULL,
                       "more than %d coordinates and inputs with a rate in one mechanism",
                       COORDINATES_MAX);
            return;
        }
        drive(in, made, (named *)s);
    }
    for (int k = 0; k < made->contact_count; k++, mark -= 2) {
        if (made->contacts[k].kind == CONTACT_STOP || made->contacts[k].kind == CONTACT_HOLD) {
            check_contact(in, made, &made->contacts[k], mark);
        }
    }
}
