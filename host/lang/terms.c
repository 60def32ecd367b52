/* terms.c: the parser of T, V, F, Q and equation. */
#include <stdio.h>
#include <string.h>

#include "host/lang/statements.h"

static void add_term(parser *in, term made) {
    mechanism *into = in->builder->made;
    term *longer = arena_room(in->arena, (term *)into->terms, into->term_count, sizeof *longer);
    longer[into->term_count++] = made;
    into->terms = longer;
}

/* `=` in the mechanism, `+=` in an effect. */
static bool parse_assign_sign(parser *in, const char *what) {
    char words[80];
    char hint[120];
    const bool assigns = parser_is_sign(in, '=');
    if (!assigns && !parser_is_sign(in, SIGN_PLUS_ASSIGN)) {
        return parser_fail(in, NULL, "'%s' is missing after %s, before %s",
                           in->effect >= 0 ? "+=" : "=", what,
                           token_words(&in->token, words, sizeof words));
    }
    if (assigns && in->effect >= 0) {
        snprintf(hint, sizeof hint, "write %s += ...", what);
        parser_fail(in, hint, "an effect adds to what the mechanism has");
    } else if (!assigns && in->effect < 0) {
        snprintf(hint, sizeof hint, "write %s = ... here, or put the line into an effect", what);
        parser_fail(in, hint, "'+=' belongs into an effect");
    }
    parser_next(in);
    return true;
}

/* Report a second `T =` of the same mechanism. */
static void check_once(parser *in, place *first, place at, const char *what) {
    if (in->effect >= 0) {
        return;
    }
    if (first->line > 0) {
        diag_error(in->diags, at, "one statement holds the whole sum",
                   "%s was already given in line %d", what, first->line);
    } else {
        *first = at;
    }
}

bool read_energy(parser *in, const statement_word *word) {
    const term_kind kind = (term_kind)word->kind;
    const place at = in->statement_at;
    place *first = &in->builder->energy_at[kind - TERM_T];
    if (parser_is_sign(in, '=')) {
        check_once(in, first, at, word->text);
    } else if (in->effect < 0) {
        *first = at; /* a wrong `+=` in the mechanism counts as `=` */
    }
    if (!parse_assign_sign(in, word->text)) {
        return false;
    }
    const place value_at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_FORCE);
    if (value == NULL || !parser_end_statement(in, "the expression")) {
        return false;
    }
    const dimension wanted = kind == TERM_F ? dim_of(2, 1, -3, 0, 0) : dim_energy();
    if (value->op == EXPR_NUMBER) {
        check_dimension(in, value_at, value, wanted, term_rule(kind));
    } else if (!dim_fits(value->dim, wanted)) {
        const bool needs_rate = kind != TERM_V && value->order == 0;
        char is[DIM_TEXT_SIZE];
        diag_error(in->diags, value_at,
                   needs_rate ? (kind == TERM_T ? "no speed stands in it: T = m*l^2*theta'^2/2"
                                                : "no speed stands in it: F = b*theta'^2/2")
                              : "a number without a unit is dimensionless: write 2 [kg], 3 [N/m]",
                   "%s, but this is %s", term_rule(kind), dim_text(value->dim, is, sizeof is));
    }
    add_term(in, (term){kind, NULL, value, NULL, in->effect, at});
    return true;
}

bool read_force(parser *in, const statement_word *word) {
    (void)word;
    const place at = in->statement_at;
    const mechanism *of = in->builder->made;
    char form[NAME_LENGTH_MAX + 40];
    snprintf(form, sizeof form, "write Q(%s) = ...",
             of->coordinate_count > 0 ? of->coordinates[0]->name : "x");
    if (!parser_is_sign(in, '(')) {
        return parser_fail(in, form, "Q needs its coordinate in parentheses");
    }
    parser_next(in);
    const token name = in->token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, form, "Q needs its coordinate in parentheses");
    }
    const symbol *coordinate = find_coordinate(in, &name, "Q");
    parser_next(in);
    if (!parser_expect_sign(in, ')', "after the coordinate")) {
        return false;
    }
    char what[NAME_LENGTH_MAX + 8];
    snprintf(what, sizeof what, "Q(%.*s)", (int)name.length, name.text);
    if (coordinate != NULL && parser_is_sign(in, '=')) {
        check_once(in, &in->builder->force_at[coordinate->index], at, what);
    }
    if (!parse_assign_sign(in, what)) {
        return false;
    }
    const place value_at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_FORCE);
    if (value == NULL || !parser_end_statement(in, "the expression")) {
        return false;
    }
    if (coordinate != NULL) {
        char rule[RULE_SIZE];
        dimension wanted;
        if (dim_divide(dim_energy(), coordinate->dim, &wanted)) {
            dimension_rule(rule, what, "must be", wanted);
            if (dim_is_none(coordinate->dim)) {
                snprintf(rule, sizeof rule, "%s must be a torque [kg*m^2/s^2]", what);
            }
            check_dimension(in, value_at, value, wanted, rule);
        }
    }
    add_term(in, (term){TERM_Q, coordinate, value, NULL, in->effect, at});
    return true;
}

bool read_equation(parser *in, const statement_word *word) {
    const place at = in->statement_at;
    in->builder->equation_count++;
    const expr *left = parse_expression(in, CONTEXT_EQUATION);
    if (left == NULL) {
        return false;
    }
    const place sign_at = in->token.at;
    if (!parser_is_sign(in, '=')) {
        char words[80];
        return parser_fail(in, word->form, "'=' is missing before %s",
                           token_words(&in->token, words, sizeof words));
    }
    parser_next(in);
    const expr *right = parse_expression(in, CONTEXT_EQUATION);
    if (right == NULL) {
        return false;
    }
    if (!dim_fits(left->dim, right->dim)) {
        char a[DIM_TEXT_SIZE];
        char b[DIM_TEXT_SIZE];
        diag_error(in->diags, sign_at, NULL, "the left side is %s, but the right side is %s",
                   dim_text(left->dim, a, sizeof a), dim_text(right->dim, b, sizeof b));
    }
    add_term(in, (term){TERM_EQUATION, NULL, left, right, -1, at});
    return parser_end_statement(in, "the equation");
}
