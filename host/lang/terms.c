/* terms.c: T, V, F, Q and equation. */
#include <stdio.h>
#include <string.h>

#include "parser.h"

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

/* A second `T =` of the same mechanism. */
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

static bool parse_energy(parser *in, term_kind kind) {
    const place at = in->token.at;
    const char *name = kind == TERM_T ? "T" : kind == TERM_V ? "V" : "F";
    const char *rule = kind == TERM_T   ? "kinetic energy T must be an energy [kg*m^2/s^2]"
                       : kind == TERM_V ? "potential energy V must be an energy [kg*m^2/s^2]"
                                        : "dissipation function F must be a power [kg*m^2/s^3]";
    parser_next(in);
    place *first = &in->builder->energy_at[kind - TERM_T];
    if (parser_is_sign(in, '=')) {
        check_once(in, first, at, name);
    } else if (in->effect < 0) {
        *first = at; /* a wrong `+=` in the mechanism was meant as `=` */
    }
    if (!parse_assign_sign(in, name)) {
        return false;
    }
    const place value_at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_FORCE);
    if (value == NULL) {
        return false;
    }
    const dimension wanted = kind == TERM_F ? dim_of(2, 1, -3, 0, 0) : dim_energy();
    check_dimension(in, value_at, value, wanted, rule);
    add_term(in, (term){kind, NULL, value, NULL, in->effect, at});
    return parser_end_statement(in, "the expression");
}

const symbol *find_coordinate(parser *in, const token *name, const char *whose) {
    const named *found = names_find(in->builder->names, name->text, name->length);
    char words[80];
    token_words(name, words, sizeof words);
    if (found != NULL && !found->is_placeholder &&
        (found->symbol.kind == SYM_COORDINATE || found->symbol.kind == SYM_STATE)) {
        if (name->primes > 0) {
            diag_error(in->diags, name->at, NULL, "%s belongs to a coordinate, without primes",
                       whose);
            return NULL;
        }
        return &found->symbol;
    }
    if (found != NULL && !found->is_placeholder) {
        diag_error(in->diags, name->at, NULL, "%s belongs to a coordinate, which %s is not", whose,
                   words);
        return NULL;
    }
    nearest search = nearest_start(name->text, name->length);
    char hint[120] = "";
    const mechanism *inside = in->builder->made;
    for (int i = 0; i < inside->coordinate_count; i++) {
        nearest_offer(&search, inside->coordinates[i]->name);
    }
    if (search.best != NULL) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
    }
    diag_error(in->diags, name->at, hint[0] == '\0' ? NULL : hint, "unknown coordinate %s", words);
    return NULL;
}

static bool parse_force(parser *in) {
    const place at = in->token.at;
    parser_next(in);
    if (!parser_is_sign(in, '(')) {
        return parser_fail(in, "write Q(theta) = ...", "Q needs its coordinate in parentheses");
    }
    parser_next(in);
    const token name = in->token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, "write Q(theta) = ...", "Q needs its coordinate in parentheses");
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
    if (value == NULL) {
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
    return parser_end_statement(in, "the expression");
}

static bool parse_equation(parser *in) {
    const place at = in->token.at;
    if (in->effect >= 0) {
        return parser_fail(in, NULL, "'equation' is not possible inside an effect");
    }
    in->builder->equation_count++;
    parser_next(in);
    const expr *left = parse_expression(in, CONTEXT_EQUATION);
    if (left == NULL) {
        return false;
    }
    const place sign_at = in->token.at;
    if (!parser_is_sign(in, '=')) {
        char words[80];
        return parser_fail(in, "equation left = right", "'=' is missing before %s",
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

bool parse_term(parser *in, bool *known) {
    static const struct {
        const char *word;
        term_kind kind;
    } words[] = {
        {"T", TERM_T}, {"V", TERM_V}, {"F", TERM_F}, {"Q", TERM_Q}, {"equation", TERM_EQUATION}};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (!parser_is_word(in, words[i].word)) {
            continue;
        }
        const term_kind kind = words[i].kind;
        *known = true;
        note_way(in, kind == TERM_EQUATION);
        if (kind == TERM_EQUATION) {
            return parse_equation(in);
        }
        return kind == TERM_Q ? parse_force(in) : parse_energy(in, kind);
    }
    *known = false;
    return false;
}
