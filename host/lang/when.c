/* when.c: `when EXPR crosses EXPR [rising|falling] { set NAME = EXPR, ... }`. */
#include <stdio.h>
#include <string.h>

#include "statements.h"

static const char *form(void) { return word_row(WORD_WHEN)->form; }

/* The coordinate or rate to be set; *usable is false when it is none (reported). */
static bool take_target(parser *in, const contact_statement *made, assignment *set, bool *usable) {
    char words[80];
    const token name = in->token;
    token_words(&name, words, sizeof words);
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, form(), "set needs a name, not %s", words);
    }
    parser_next(in);
    const named *found = names_find(in->names, name.text, name.length);
    *usable = false;
    if (found == NULL) {
        no_such_coordinate(in, &name);
        return true;
    }
    if (found->is_placeholder) {
        return true;
    }
    const symbol *target = &found->symbol;
    if (target->kind != SYM_COORDINATE && target->kind != SYM_STATE) {
        diag_error(in->diags, name.at, NULL,
                   "a crossing sets coordinates and their rates, and '%s' is none", target->name);
        return true;
    }
    if (target->kind == SYM_COORDINATE && name.primes > 1) {
        diag_error(in->diags, name.at, NULL, "%s cannot be set: it follows from the equations",
                   words);
        return true;
    }
    for (int i = 0; i < made->set_count; i++) {
        if (made->sets[i].symbol == target && made->sets[i].primes == name.primes) {
            diag_error(in->diags, name.at, NULL, "%s was already set in line %d", words,
                       made->sets[i].at.line);
        }
    }
    *set = (assignment){target, name.primes, NULL, name.at};
    *usable = true;
    return true;
}

static bool parse_set(parser *in, contact_statement *made) {
    assignment set = {.symbol = NULL};
    bool usable = false;
    char words[80];
    const token name = in->token;
    if (!take_target(in, made, &set, &usable)) {
        return false;
    }
    if (!parser_is_sign(in, '=')) {
        char next[80];
        return parser_fail(in, form(), "'=' is missing after %s, before %s",
                           token_words(&name, words, sizeof words),
                           token_words(&in->token, next, sizeof next));
    }
    parser_next(in);
    const place at = in->token.at;
    set.value = parse_expression(in, CONTEXT_EVENT);
    if (set.value == NULL) {
        return false;
    }
    dimension wanted;
    if (usable && dim_power(dim_of(0, 0, -1, 0, 0), name.primes, &wanted) &&
        dim_multiply(set.symbol->dim, wanted, &wanted)) {
        char rule[RULE_SIZE];
        token_words(&name, words, sizeof words);
        if (check_unit(in, at, set.value, set.symbol, name.primes)) {
            check_dimension(in, at, set.value, wanted, dimension_rule(rule, words, "is", wanted));
        }
    }
    if (usable) {
        assignment *longer =
            arena_room(in->arena, (assignment *)made->sets, made->set_count, sizeof *longer);
        longer[made->set_count++] = set;
        made->sets = longer;
    }
    return true;
}

/* set ITEM {, ITEM}: a line may end after a comma. */
static bool parse_sets(parser *in, contact_statement *made) {
    if (!parser_expect_word(in, WORD_SET, WORD_WHEN)) {
        return false;
    }
    for (;;) {
        if (!parse_set(in, made)) {
            return false;
        }
        if (!parser_is_sign(in, ',')) {
            return parser_end_statement(in, "the expression");
        }
        parser_next(in);
        while (in->token.kind == TOKEN_NEWLINE) {
            parser_next(in);
        }
    }
}

static bool parse_block(parser *in, contact_statement *made) {
    const size_t before = diags_calls(in->diags);
    for (;;) {
        parser_skip_lines(in);
        if (parser_is_sign(in, '}')) {
            parser_next(in);
            break;
        }
        if (in->token.kind == TOKEN_END || parser_leaves(in, ENDS_WHEN)) {
            diag_error(in->diags, made->at, form(), "this 'when' is not closed with '}'");
            return true;
        }
        in->statement_at = in->token.at;
        if (!parse_sets(in, made)) {
            parser_skip_statement(in);
        }
    }
    if (made->set_count == 0 && diags_calls(in->diags) == before) {
        diag_error(in->diags, made->at, form(), "this 'when' sets nothing");
    }
    return parser_end_statement(in, "the crossing");
}

/* False when what stands there is neither direction nor brace, nor nearly so. */
static bool take_direction(parser *in, contact_statement *made) {
    if (parser_is_word(in, WORD_RISING) || parser_is_word(in, WORD_FALLING)) {
        made->direction = parser_is_word(in, WORD_RISING) ? 1 : -1;
        parser_next(in);
    } else if (in->token.kind == TOKEN_NAME) {
        char words[80];
        char hint[80];
        nearest search = nearest_start(in->token.text, in->token.length);
        nearest_offer(&search, word_row(WORD_RISING)->text);
        nearest_offer(&search, word_row(WORD_FALLING)->text);
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
        parser_fail(in, search.best != NULL ? hint : form(),
                    "'rising', 'falling' or '{' is missing before %s",
                    token_words(&in->token, words, sizeof words));
        parser_next(in);
        return search.best != NULL;
    }
    return true;
}

bool read_when(parser *in, const statement_word *word) {
    contact_statement made = contact_begun(in, word);
    const place at = in->token.at;
    const expr *left = parse_expression(in, CONTEXT_EVENT);
    if (left == NULL || !parser_expect_word(in, WORD_CROSSES, WORD_WHEN)) {
        return false;
    }
    const place between = in->token.at;
    const expr *right = parse_expression(in, CONTEXT_EVENT);
    if (right == NULL || !check_limit(in, between, right, left)) {
        return false;
    }
    made.value = expr_difference(in, between, left, right);
    if (made.value == NULL) {
        return false;
    }
    if ((made.value->uses & USES_UNKNOWNS) == 0 && !made.value->dim.unknown) {
        diag_error(in->diags, at, NULL, "what crosses must depend on a coordinate or a rate");
    }
    if (!take_direction(in, &made)) {
        return false;
    }
    while (in->token.kind == TOKEN_NEWLINE) {
        parser_next(in);
    }
    return parser_expect_sign(in, '{', "after what is crossed") && parse_block(in, &made) &&
           add_contact(in, &made);
}
