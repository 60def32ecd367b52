/* contact_statement.c: stop, friction and hold; `when` has its own file. */
#include <stdio.h>
#include <string.h>

#include "statements.h"

void contact_on_system(parser *in, const contact_statement *each) {
    diag_error(in->diags, each->at, "write the mechanism with coordinate, T, V, F and Q",
               "'%s' does not go with state and equation", contact_word(each->kind));
}

/* Both take part whenever one of them does. */
static bool always_meet(const contact_statement *a, const contact_statement *b) {
    return a->effect == b->effect || a->effect < 0 || b->effect < 0;
}

static void check_friction_once(parser *in, const contact_statement *made) {
    const mechanism *into = in->builder->made;
    for (int i = 0; i < into->contact_count && made->kind == CONTACT_FRICTION; i++) {
        const contact_statement *each = &into->contacts[i];
        if (each->kind == CONTACT_FRICTION && each->coordinate == made->coordinate &&
            made->coordinate != NULL && always_meet(each, made)) {
            diag_error(in->diags, made->at, "add its normal forces up in one statement",
                       "friction on '%s' was already given in line %d", made->coordinate->name,
                       each->at.line);
            break;
        }
    }
}

static void append(parser *in, const contact_statement **list, int *count,
                   const contact_statement *made) {
    contact_statement *longer =
        arena_room(in->arena, (contact_statement *)*list, *count, sizeof *longer);
    longer[(*count)++] = *made;
    *list = longer;
}

bool add_contact(parser *in, const contact_statement *made) {
    mechanism *into = in->builder->made;
    if (in->draft == NULL) {
        check_friction_once(in, made);
        append(in, &into->contacts, &into->contact_count, made);
        return true;
    }
    if (into->is_system) {
        contact_on_system(in, made);
    }
    append(in, &in->draft->made->whens, &in->draft->made->when_count, made);
    return true;
}

contact_statement contact_begun(const parser *in, const statement_word *word) {
    return (contact_statement){
        .kind = (contact_kind)word->kind, .effect = in->effect, .at = in->statement_at};
}

/* What a stop or a hold acts on must move. */
static void check_moves(parser *in, place at, const expr *value, const char *what) {
    if ((value->uses & USES_UNKNOWNS) == 0 && !value->dim.unknown) {
        diag_error(in->diags, at, NULL, "%s must depend on a coordinate", what);
    }
}

static const expr *parse_number_between(parser *in, const char *what) {
    const place at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_EVENT);
    if (value != NULL) {
        char rule[RULE_SIZE];
        check_dimension(in, at, value, dim_none(), dimension_rule(rule, what, "is", dim_none()));
    }
    return value;
}

bool read_stop(parser *in, const statement_word *word) {
    contact_statement made = contact_begun(in, word);
    char words[80];
    const place at = in->token.at;
    const expr *left = parse_expression(in, CONTEXT_GAP);
    if (left == NULL) {
        return false;
    }
    const token sign = in->token;
    const bool above = parser_is_sign(in, SIGN_AT_LEAST);
    if (parser_is_sign(in, '>') || parser_is_sign(in, '<')) {
        parser_fail(in, sign.sign == '>' ? "write >=" : "write <=",
                    "a stop is touched where both sides are equal");
    } else if (!above && !parser_is_sign(in, SIGN_AT_MOST)) {
        return parser_fail(in, word->form, "'>=' or '<=' is missing before %s",
                           token_words(&in->token, words, sizeof words));
    }
    parser_next(in);
    const place right_at = in->token.at;
    const expr *right = parse_expression(in, CONTEXT_GAP);
    if (right == NULL || !check_limit(in, right_at, right, left)) {
        return false;
    }
    made.value = expr_difference(in, sign.at, above ? left : right, above ? right : left);
    if (made.value == NULL) {
        return false;
    }
    check_moves(in, at, made.value, "what a stop limits");
    if (!parser_expect_word(in, WORD_RESTITUTION, WORD_STOP)) {
        return false;
    }
    made.restitution = parse_number_between(in, "the restitution");
    return made.restitution != NULL && parser_end_statement(in, "the restitution") &&
           add_contact(in, &made);
}

/* The coordinate's generalized force: a force for a length, a torque for an angle. */
static const expr *parse_normal(parser *in, const symbol *coordinate) {
    const place at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_EVENT);
    dimension wanted;
    if (value != NULL && coordinate != NULL && coordinate->kind == SYM_COORDINATE &&
        dim_divide(dim_energy(), coordinate->dim, &wanted)) {
        char rule[RULE_SIZE];
        char what[NAME_LENGTH_MAX + 40];
        snprintf(what, sizeof what, "the normal force on '%s'", coordinate->name);
        dimension_rule(rule, what, "must be", wanted);
        if (coordinate->is_angle) {
            snprintf(rule, sizeof rule,
                     "'%s' is an angle: its normal force, times the radius it acts at, must be a "
                     "torque [kg*m^2/s^2]",
                     coordinate->name);
        }
        check_dimension(in, at, value, wanted, rule);
    }
    return value;
}

bool read_friction(parser *in, const statement_word *word) {
    contact_statement made = contact_begun(in, word);
    char words[80];
    const token name = in->token;
    if (name.kind != TOKEN_NAME || (token_is_word(&name, WORD_STATIC) &&
                                    names_find(in->names, name.text, name.length) == NULL)) {
        return parser_fail(in, word->form, "friction needs its coordinate, not %s",
                           token_words(&in->token, words, sizeof words));
    }
    made.coordinate = find_coordinate(in, &name, "friction");
    parser_next(in);
    if (parser_is_sign(in, '-') || parser_is_sign(in, '+')) {
        return parser_fail(
            in, "between two bodies: coordinate d [rad], and let b = a + d; then friction d",
            "friction acts on one coordinate, not on a sum");
    }
    if (!parser_expect_word(in, WORD_STATIC, WORD_FRICTION)) {
        return false;
    }
    made.static_friction = parse_number_between(in, "the coefficient of static friction");
    if (made.static_friction == NULL || !parser_expect_word(in, WORD_KINETIC, WORD_FRICTION)) {
        return false;
    }
    made.kinetic_friction = parse_number_between(in, "the coefficient of kinetic friction");
    if (made.kinetic_friction == NULL || !parser_expect_word(in, WORD_NORMAL, WORD_FRICTION)) {
        return false;
    }
    made.normal = parse_normal(in, made.coordinate);
    return made.normal != NULL && parser_end_statement(in, "the normal force") &&
           add_contact(in, &made);
}

bool read_hold(parser *in, const statement_word *word) {
    contact_statement made = contact_begun(in, word);
    const place at = in->token.at;
    made.value = parse_expression(in, CONTEXT_GAP);
    if (made.value == NULL) {
        return false;
    }
    check_moves(in, at, made.value, "what is held");
    if (!parser_expect_word(in, WORD_WHILE, WORD_HOLD)) {
        return false;
    }
    made.condition = parse_condition(in, WORD_HOLD);
    return made.condition != NULL && parser_end_statement(in, "the condition") &&
           add_contact(in, &made);
}
