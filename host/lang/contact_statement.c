/* contact_statement.c: the parser of stop, friction, hold and when. */

#include "host/lang/expression.h"
#include "host/lang/parser.h"
#include "host/lang/statements.h"

/* === stop, friction and hold ================================================================== */

void contact_on_system(parser *in, const contact_statement *each) {
    diag_error(in->diags, each->at, "write the mechanism with 'coordinate', T, V, F and Q",
               "'%s' is not possible in a mechanism that is given by equations",
               contact_word(each->kind));
}

static void check_friction_once(parser *in, const contact_statement *made) {
    const mechanism *into = in->builder->made;
    for (int i = 0; i < into->contact_count && made->kind == CONTACT_FRICTION; i++) {
        const contact_statement *each = &into->contacts[i];
        if (each->kind == CONTACT_FRICTION && each->coordinate == made->coordinate &&
            made->coordinate != NULL && always_meet(each->effect, made->effect)) {
            diag_error(in->diags, made->at, "add all normal forces in one statement",
                       "friction on '%s' was already given in line %d", made->coordinate->name,
                       each->at.line);
            break;
        }
    }
}

static bool add_contact(parser *in, const contact_statement *made) {
    mechanism *into = in->builder->made;
    if (in->draft == NULL) {
        check_friction_once(in, made);
        into->contacts =
            arena_push(in->arena, into->contacts, &into->contact_count, made, sizeof *made);
        return true;
    }
    if (into->is_system) {
        contact_on_system(in, made);
    }
    scene *of = in->draft->made;
    of->whens = arena_push(in->arena, of->whens, &of->when_count, made, sizeof *made);
    return true;
}

static contact_statement contact_begun(const parser *in, const statement_word *word) {
    return (contact_statement){
        .kind = (contact_kind)word->kind, .effect = in->effect, .at = in->statement_at};
}

static void check_moves(parser *in, place at, const expr *value, const char *rule) {
    if ((value->uses & USES_UNKNOWNS) == 0 && !value->dim.unknown) {
        diag_error(in->diags, at, NULL, "%s", rule);
    }
}

static const expr *parse_number_between(parser *in, const char *what) {
    const place at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_EVENT);
    if (value != NULL) {
        check_named(in, at, value, dim_none(), what, "is");
    }
    return value;
}

bool read_stop(parser *in, const statement_word *word) {
    contact_statement made = contact_begun(in, word);
    const place at = in->token.at;
    const expr *left = parse_expression(in, CONTEXT_GAP);
    if (left == NULL) {
        return false;
    }
    const token sign = in->token;
    const bool above = parser_is_sign(in, SIGN_AT_LEAST);
    if (parser_is_sign(in, '>') || parser_is_sign(in, '<')) {
        parser_fail(
            in, sign.sign == '>' ? "write >=" : "write <=", "a stop needs >= or <=, not > or <");
    } else if (!above && !parser_is_sign(in, SIGN_AT_MOST)) {
        return parser_fail(in, word->form, "'>=' or '<=' is missing before %s",
                           token_words(in, &in->token));
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
    check_moves(in, at, made.value, "the expression of a stop must depend on a coordinate");
    if (!parser_expect_word(in, WORD_RESTITUTION, WORD_STOP)) {
        return false;
    }
    made.restitution = parse_number_between(in, "the restitution");
    return made.restitution != NULL && parser_end_statement(in, "the restitution") &&
           add_contact(in, &made);
}

/* Reads the normal force, in the dimension of the coordinate's generalized force: a torque for an angle. */
static const expr *parse_normal(parser *in, const symbol *coordinate) {
    const place at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_EVENT);
    dimension wanted;
    if (value != NULL && coordinate != NULL && coordinate->kind == SYM_COORDINATE &&
        dim_divide(dim_of_quantity(QUANTITY_ENERGY), coordinate->dim, &wanted)) {
        if (coordinate->is_angle) {
            const char *rule = arena_words(
                in->arena,
                "'%s' is an angle, so its friction needs the normal force times a radius, a torque [kg*m^2/s^2]",
                coordinate->name);
            check_dimension(in, at, value, wanted, rule);
        } else {
            check_named(in, at, value, wanted,
                        arena_words(in->arena, "the normal force on '%s'", coordinate->name),
                        "must be");
        }
    }
    return value;
}

bool read_friction(parser *in, const statement_word *word) {
    contact_statement made = contact_begun(in, word);
    const token name = in->token;
    if (name.kind != TOKEN_NAME || (token_is_word(&name, WORD_STATIC) &&
                                    names_find(in->names, name.text, name.length) == NULL)) {
        return parser_fail(in, word->form, "friction needs the name of a coordinate, not %s",
                           token_words(in, &in->token));
    }
    made.coordinate = find_coordinate(in, &name, "friction");
    parser_next(in);
    if (parser_is_sign(in, '-') || parser_is_sign(in, '+')) {
        return parser_fail(
            in,
            "for friction between two bodies a and b, declare coordinate d [rad] and let b = a + d, then write friction d",
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
    check_moves(in, at, made.value, "the expression of a hold must depend on a coordinate");
    if (!parser_expect_word(in, WORD_WHILE, WORD_HOLD)) {
        return false;
    }
    made.condition = parse_condition(in);
    return made.condition != NULL && parser_end_statement(in, "the condition") &&
           add_contact(in, &made);
}

/* === `when EXPR crosses EXPR [rising|falling] { set NAME = EXPR, ... }` ======================= */

static const char *form(void) { return word_row(WORD_WHEN)->form; }

/* Returns the coordinate or state to be set, or NULL (reported) if the name is neither. */
static const symbol *find_target(parser *in, const token *name) {
    const named *found = names_find(in->names, name->text, name->length);
    if (found == NULL) {
        no_such_coordinate(in, name);
    }
    if (found == NULL || found->is_placeholder) {
        return NULL;
    }
    const symbol *target = &found->symbol;
    if (!symbol_moves(target)) {
        diag_error(in->diags, name->at, NULL,
                   "a crossing sets only coordinates and their rates, and '%s' is neither",
                   target->name);
        return NULL;
    }
    if (target->kind == SYM_COORDINATE && name->primes > 1) {
        diag_error(in->diags, name->at, NULL, "%s cannot be set: it follows from the equations",
                   token_words(in, name));
        return NULL;
    }
    return target;
}

static bool parse_set(parser *in, contact_statement *made) {
    const token name = in->token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, form(), "set needs a name, not %s", token_words(in, &name));
    }
    parser_next(in);
    return parse_assigned(in, &name, find_target(in, &name), WORD_WHEN, &made->sets,
                          &made->set_count);
}

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
        parser_skip_newlines(in);
    }
}

static bool parse_block(parser *in, contact_statement *made) {
    const size_t before = diags_calls(in->diags);
    bool closed;
    while (parser_in_block(in, ENDS_WHEN, &closed)) {
        in->statement_at = in->token.at;
        if (!parse_sets(in, made)) {
            parser_skip_statement(in);
        }
    }
    if (!closed) {
        diag_error(in->diags, made->at, form(), "this 'when' is not closed with '}'");
        return true;
    }
    parser_next(in);
    if (made->set_count == 0 && diags_calls(in->diags) == before) {
        diag_error(in->diags, made->at, form(), "this 'when' sets no value");
    }
    return parser_end_statement(in, "the crossing");
}

static bool take_direction(parser *in, contact_statement *made) {
    if (parser_is_word(in, WORD_RISING) || parser_is_word(in, WORD_FALLING)) {
        made->direction = parser_is_word(in, WORD_RISING) ? 1 : -1;
        parser_next(in);
    } else if (in->token.kind == TOKEN_NAME) {
        nearest search = nearest_start(in->token.text, in->token.length);
        nearest_offer(&search, word_row(WORD_RISING)->text);
        nearest_offer(&search, word_row(WORD_FALLING)->text);
        parser_fail(in, parser_nearest(in, &search, form()),
                    "'rising', 'falling' or '{' is missing before %s", token_words(in, &in->token));
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
    check_moves(in, at, made.value, "the crossing quantity must depend on a coordinate or a rate");
    if (!take_direction(in, &made)) {
        return false;
    }
    parser_skip_newlines(in);
    return parser_expect_sign(in, '{', "after the crossing") && parse_block(in, &made) &&
           add_contact(in, &made);
}
