/* scene_range.c: `range NAME = A .. B`: what a component or an input keeps to in fixed point. */
#include "scene_block.h"
#include "value.h"

static bool is_number(const expr *tree) {
    while (tree->op == EXPR_NEG) {
        tree = tree->left;
    }
    return tree->op == EXPR_NUMBER;
}

/* -5 .. 5 [m]: a bare number before a number with a unit has that unit, too. */
static const expr *with_unit(parser *in, const expr *low, const expr *high) {
    if (!is_number(low) || !is_number(high) || low->uses != 0 || (high->uses & USES_UNIT) == 0) {
        return low;
    }
    expr *made = expr_new(in, EXPR_NUMBER, low->at);
    made->number = expr_value(low, NULL) * in->number_unit.scale / in->number_unit.divisor;
    made->dim = in->number_unit.dim;
    made->dim.any = made->number == 0.0;
    made->uses = USES_UNIT;
    return made;
}

static bool has_range(parser *in, const token *name, const named *found) {
    const symbol *what = &found->symbol;
    const bool moves = what->kind == SYM_COORDINATE || what->kind == SYM_STATE;
    const scene *made = in->draft->made;
    if (!moves && what->kind != SYM_INPUT) {
        diag_error(in->diags, name->at, NULL,
                   "range takes coordinates, their rates and inputs, and '%s' is none", what->name);
        return false;
    }
    if ((moves && what->order > 0 && name->primes >= what->order) || (!moves && name->primes > 0)) {
        diag_error(in->diags, name->at, NULL, "range takes '%s' with %s", what->name,
                   moves ? "fewer primes: what follows from the equations has no range"
                         : "no prime: an input has no rate");
        return false;
    }
    for (int i = 0; i < made->range_count; i++) {
        if (made->ranges[i].symbol == what && made->ranges[i].primes == name->primes) {
            diag_error(in->diags, name->at, NULL,
                       "the range of '%s%.*s' was already given in line %d", what->name,
                       name->primes, "'''''''''", made->ranges[i].at.line);
            return false;
        }
    }
    return true;
}

static bool range_item(parser *in, const statement_word *word) {
    draft *into = in->draft;
    scene *made = into->made;
    token name;
    named *found = NULL;
    dimension wanted = dim_none();
    char words[80];
    char rule[RULE_SIZE];
    if (!scene_take_symbol(in, into, word, &name, &found)) {
        return false;
    }
    bool usable = found != NULL && !found->is_placeholder && has_range(in, &name, found);
    usable = usable && dim_power(dim_of(0, 0, -1, 0, 0), name.primes, &wanted) &&
             dim_multiply(found->symbol.dim, wanted, &wanted);
    token_words(&name, words, sizeof words);
    if (!parser_expect_sign(in, '=', "behind the name")) {
        return false;
    }
    const place low_at = in->token.at;
    const expr *low = parse_expression(in, CONTEXT_CONSTANT);
    if (low == NULL || !parser_is_sign(in, SIGN_TO)) {
        return low == NULL
                   ? false
                   : parser_fail(in, word->form, "'..' is missing in the range of %s", words);
    }
    parser_next(in);
    const place high_at = in->token.at;
    const expr *high = parse_expression(in, CONTEXT_CONSTANT);
    if (high == NULL) {
        return false;
    }
    if (!usable) {
        return true;
    }
    low = with_unit(in, low, high);
    dimension_rule(rule, words, "is", wanted);
    if (check_unit(in, high_at, high, &found->symbol, name.primes) &&
        check_unit(in, low_at, low, &found->symbol, name.primes) &&
        check_dimension(in, low_at, low, wanted, rule) &&
        check_dimension(in, high_at, high, wanted, rule)) {
        range_statement *longer = arena_room(in->arena, (range_statement *)made->ranges,
                                             made->range_count, sizeof *longer);
        longer[made->range_count++] =
            (range_statement){&found->symbol, name.primes, low, high, name.at};
        made->ranges = longer;
    }
    return true;
}

bool read_range(parser *in, const statement_word *word) { return scene_list(in, word, range_item); }
