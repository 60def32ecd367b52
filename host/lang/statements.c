/* statements.c: dispatch of statements to their readers; mechanisms and effects. */
#include "host/lang/statements.h"

#include <string.h>

#include "host/lang/model.h"

static void add_term(parser *in, term made) {
    mechanism *into = in->builder->made;
    into->terms = arena_push(in->arena, into->terms, &into->term_count, &made, sizeof made);
}

/* Reads `=` in the mechanism, `+=` in an effect. */
static bool parse_assign_sign(parser *in, const char *what) {
    const bool assigns = parser_is_sign(in, '=');
    if (!assigns && !parser_is_sign(in, SIGN_PLUS_ASSIGN)) {
        return parser_fail(in, NULL, "'%s' is missing after %s, before %s",
                           in->effect >= 0 ? "+=" : "=", what, token_words(in, &in->token));
    }
    if (assigns && in->effect >= 0) {
        parser_fail(in, arena_words(in->arena, "write %s += ...", what),
                    "'=' is not possible in an effect, which only adds");
    } else if (!assigns && in->effect < 0) {
        parser_fail(
            in, arena_words(in->arena, "write %s = ... here, or put the line into an effect", what),
            "'+=' is possible only in an effect");
    }
    parser_next(in);
    return true;
}

/* Reports a second statement of the same kind in the mechanism, such as a second `T =`. */
static void check_once(parser *in, place *first, place at, const char *what) {
    if (in->effect >= 0) {
        return;
    }
    if (first->line > 0) {
        diag_error(in->diags, at, "write the whole sum in one statement",
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
    const dimension wanted =
        kind == TERM_F ? dim_of_quantity(QUANTITY_POWER) : dim_of_quantity(QUANTITY_ENERGY);
    if (value->op == EXPR_NUMBER) {
        check_dimension(in, value_at, value, wanted, term_rule(kind));
    } else if (!dim_fits(value->dim, wanted)) {
        diag_error(in->diags, value_at,
                   kind == TERM_V || value->order > 0
                       ? "check the unit of each parameter; a number without one is dimensionless"
                   : kind == TERM_T
                       ? "the expression contains no speed; write: T = m*l^2*theta'^2/2"
                       : "the expression contains no speed; write: F = b*theta'^2/2",
                   "%s, but this is %s", term_rule(kind), dimension_words(in, value->dim));
    }
    add_term(in, (term){kind, NULL, value, NULL, in->effect, at});
    return true;
}

bool read_force(parser *in, const statement_word *word) {
    (void)word;
    const place at = in->statement_at;
    const mechanism *of = in->builder->made;
    const char *form = arena_words(in->arena, "write Q(%s) = ...",
                                   of->coordinate_count > 0 ? of->coordinates[0]->name : "x");
    if (!parser_is_sign(in, '(')) {
        return parser_fail(in, form, "Q needs a coordinate in parentheses");
    }
    parser_next(in);
    const token name = in->token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, form, "Q needs a coordinate in parentheses");
    }
    const symbol *coordinate = find_coordinate(in, &name, "Q");
    parser_next(in);
    if (!parser_expect_sign(in, ')', "after the coordinate")) {
        return false;
    }
    const char *what = arena_words(in->arena, "Q(%.*s)", (int)name.length, name.text);
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
        dimension wanted;
        if (dim_is_none(coordinate->dim)) {
            check_dimension(in, value_at, value, dim_of_quantity(QUANTITY_ENERGY),
                            arena_words(in->arena, "%s must be a torque [kg*m^2/s^2]", what));
        } else if (dim_divide(dim_of_quantity(QUANTITY_ENERGY), coordinate->dim, &wanted)) {
            check_named(in, value_at, value, wanted, what, "must be");
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
        return parser_fail(in, word->form, "'=' is missing before %s", token_words(in, &in->token));
    }
    parser_next(in);
    const expr *right = parse_expression(in, CONTEXT_EQUATION);
    if (right == NULL) {
        return false;
    }
    if (!dim_fits(left->dim, right->dim)) {
        diag_error(in->diags, sign_at, NULL, "the left side is %s, but the right side is %s",
                   dimension_words(in, left->dim), dimension_words(in, right->dim));
    }
    add_term(in, (term){TERM_EQUATION, NULL, left, right, -1, at});
    return parser_end_statement(in, "the equation");
}

/* === checks of a complete mechanism =========================================================== */

static void walk_orders(parser *in, const expr *tree) {
    if (tree == NULL) {
        return;
    }
    if (tree->op == EXPR_SYMBOL && tree->symbol != NULL) {
        named *entry = (named *)tree->symbol;
        symbol *s = &entry->symbol;
        const bool above = s->kind == SYM_STATE && tree->primes > s->order;
        if (above && in == NULL) {
            s->order = tree->primes;
        } else if (above) {
            diag_error(in->diags, tree->at, NULL,
                       "no equation has this derivative of '%s': the highest has %d prime%s",
                       s->name, s->order, s->order == 1 ? "" : "s");
        }
        if (s->kind == SYM_LET && entry->mark == 0) {
            entry->mark = 1;
            walk_orders(in, s->value);
        }
    }
    walk_orders(in, tree->left);
    walk_orders(in, tree->right);
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
                   "mechanism '%s' has %d state%s but %d equation%s: the numbers must be equal",
                   made->name, made->coordinate_count, made->coordinate_count == 1 ? "" : "s",
                   done->equation_count, done->equation_count == 1 ? "" : "s");
        return;
    }
    for (int i = 0; i < made->term_count; i++) {
        walk_orders(NULL, made->terms[i].value);
        walk_orders(NULL, made->terms[i].right);
    }
    for (int i = 0; i < made->coordinate_count; i++) {
        const symbol *state = made->coordinates[i];
        if (state->order == 0) {
            diag_error(in->diags, state->at,
                       "write an equation that contains this state with a prime, such as x'",
                       "no equation has a derivative of '%s'", state->name);
            return;
        }
    }
    for (int i = 0; i < made->output_count; i++) {
        walk_orders(in, made->outputs[i]->value);
    }
}

static void finish_mechanism(parser *in, builder *done) {
    mechanism *made = done->made;
    bool has_T = false;
    for (int i = 0; i < made->term_count; i++) {
        has_T = has_T || made->terms[i].kind == TERM_T;
    }
    made->is_system = done->has_equations;
    if (done->nameless || done->broken || done->mixed) {
        return; /* the missing part may be in the lines that failed */
    }
    if (made->is_system) {
        finish_system(in, done);
        for (int i = 0; i < made->contact_count; i++) {
            contact_on_system(in, &made->contacts[i]);
        }
    } else if (made->coordinate_count == 0) {
        diag_error(in->diags, made->at, "declare one with: coordinate theta [rad]",
                   "mechanism '%s' has no coordinate", made->name);
    } else if (!has_T) {
        diag_error(in->diags, made->at, "T = m*X'^2/2", "mechanism '%s' has no kinetic energy T",
                   made->name);
    }
    finish_inputs(in, made);
}

/* === dispatch of statements =================================================================== */

static bool read_statement(parser *in, unsigned where);

static bool parse_name(parser *in, effect *made) {
    /* words with a special meaning in a list of effects */
    static const struct {
        word_id word;
        const char *as;
    } meant[] = {
        {WORD_NONE, "`with none` selects no effect"},
        {WORD_LEDGER, "`with ledger` records the balances of energy and momentum"},
        {WORD_ALL, "`--with all` selects every effect"},
        {WORD_CONSERVE,
         "`--without conserve` integrates the coordinates of the scene's 'conserve' lines"}};
    const mechanism *into = in->builder->made;
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        return parser_fail(in, word_row(WORD_EFFECT)->form, "an effect needs a name");
    }
    made->name = parser_copy_text(in, &in->token);
    made->at = in->token.at;
    for (int i = 0; i < into->effect_count; i++) {
        if (strcmp(into->effects[i].name, made->name) == 0) {
            diag_error(in->diags, made->at, NULL, "effect '%s' was already declared in line %d",
                       made->name, into->effects[i].at.line);
        }
    }
    for (size_t i = 0; i < sizeof meant / sizeof meant[0]; i++) {
        if (token_is_word(&in->token, meant[i].word)) {
            parser_fail(in, arena_words(in->arena, "%s: choose another name", meant[i].as),
                        "'%s' is a reserved word", word_row(meant[i].word)->text);
        }
    }
    parser_next(in);
    return true;
}

static bool read_effect(parser *in, const statement_word *word) {
    (void)word;
    mechanism *into = in->builder->made;
    effect made = {"", "", in->statement_at, 0};
    if (into->effect_count == EFFECTS_MAX) {
        in->lexer.stopped = true;
        return parser_fail(in, NULL, "more than %d effects in one mechanism", EFFECTS_MAX);
    }
    if (!parse_name(in, &made)) {
        return false;
    }
    made.text = parser_title(in);
    effect *longer =
        arena_room(in->arena, (effect *)into->effects, into->effect_count, sizeof *longer);
    longer[into->effect_count] = made;
    into->effects = longer;
    in->effect = into->effect_count++;
    parser_skip_newlines(in);
    if (!parser_expect_sign(in, '{', "after the effect's name")) {
        return false;
    }
    bool closed;
    while (parser_in_block(in, ENDS_EFFECT, &closed)) {
        if (!read_statement(in, IN_EFFECT)) {
            parser_skip_statement(in);
            in->builder->broken = true;
        }
    }
    longer[in->effect].last_line = in->token.at.line;
    in->effect = -1;
    if (!closed) {
        diag_error(in->diags, made.at, NULL, "effect '%s' is not closed with '}'", made.name);
        return true;
    }
    parser_next(in);
    return parser_end_statement(in, "the effect");
}

static builder *begin_mechanism(parser *in, place at) {
    builder *made = arena_alloc(in->arena, sizeof *made);
    made->made = arena_alloc(in->arena, sizeof *made->made);
    made->made->at = at;
    made->made->name = "";
    made->made->title = "";
    made->made->names = names_new(in->arena);
    made->force_at = arena_alloc(in->arena, COORDINATES_MAX * sizeof *made->force_at);
    in->builders = arena_push(in->arena, in->builders, &in->builder_count, &made, sizeof made);
    in->builder = made;
    in->names = made->made->names;
    return made;
}

static bool read_mechanism(parser *in, const statement_word *word) {
    builder *made = begin_mechanism(in, in->statement_at);
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        made->nameless = true;
        return parser_fail(in, word->form, "a mechanism needs a name");
    }
    made->made->at = in->token.at;
    made->made->name = parser_copy_text(in, &in->token);
    for (int i = 0; i + 1 < in->builder_count; i++) {
        const mechanism *other = in->builders[i]->made;
        if (strcmp(other->name, made->made->name) == 0) {
            diag_error(in->diags, in->token.at, NULL,
                       "mechanism '%s' was already declared in line %d", other->name,
                       other->at.line);
            break;
        }
    }
    if (in->builder_count > MECHANISMS_MAX) {
        in->lexer.stopped = true;
        return parser_fail(in, NULL, "more than %d mechanisms in one file", MECHANISMS_MAX);
    }
    parser_next(in);
    made->made->title = parser_title(in);
    return parser_end_statement(in, "the mechanism's title");
}

/* Skips a scene, and stores its place for read_noted_scene(). */
static bool note_scene(parser *in, const statement_word *word) {
    (void)word;
    if (in->pending_count == SCENES_MAX) {
        in->lexer.stopped = true;
        return parser_fail(in, NULL, "more than %d scenes in one file", SCENES_MAX);
    }
    const pending_scene noted = {in->lexer, in->token, in->statement_at, in->builder};
    in->pending = arena_push(in->arena, in->pending, &in->pending_count, &noted, sizeof noted);
    while (in->token.kind == TOKEN_NAME || in->token.kind == TOKEN_STRING ||
           in->token.kind == TOKEN_NEWLINE) {
        if (in->token.starts_line && parser_is_body_word(in)) {
            return true;
        }
        parser_next(in);
    }
    parser_skip_statement(in);
    return true;
}

/* --- choice of the reader ----------------------------------------------------------------------*/

#define READER(id, text, stands, rules, reader, kind, form) [WORD_##id] = reader,
static statement_reader *const readers[] = {BODY_WORD_ROWS(READER)};
#undef READER

/* Records whether the mechanism has energies or equations, and reports a mix. */
static void note_way(parser *in, const statement_word *word) {
    builder *into = in->builder;
    into->has_equations |= (word->rules & BY_EQUATIONS) != 0;
    into->has_energies |= (word->rules & BY_ENERGIES) != 0;
    if (into->has_equations && into->has_energies && !into->mixed) {
        into->mixed = true;
        parser_fail(in, "use either 'coordinate' with T, V, F and Q, or 'state' with 'equation'",
                    "'%s' is not possible in this mechanism, which began with %s", word->text,
                    (word->rules & BY_EQUATIONS) != 0 ? "'coordinate', T, V, F or Q"
                                                      : "'state' or 'equation'");
    }
}

static bool read_statement(parser *in, unsigned where) {
    const statement_word *word = token_statement(&in->token);
    in->statement_at = in->token.at;
    if (word == NULL || (word->stands & (IN_MECHANISM | where)) == 0) {
        return statement_unknown(in, where);
    }
    if ((word->stands & where) == 0) {
        return parser_fail(
            in,
            (word->rules & DECLARES) != 0 ? "declare it in the mechanism, before the effect" : NULL,
            "'%s' is not possible inside an effect", word->text);
    }
    if ((word->rules & (BY_ENERGIES | BY_EQUATIONS)) != 0) {
        note_way(in, word);
    }
    parser_next(in);
    return readers[word - word_row((word_id)0)](in, word);
}

static bool read_outside(parser *in) {
    const bool in_file = parser_is_word(in, WORD_MECHANISM) || parser_is_word(in, WORD_SCENE);
    if (in->builder == NULL && !in_file) {
        if (!parser_is_body_word(in)) {
            return statement_unknown(in, IN_FILE | IN_MECHANISM | IN_EFFECT);
        }
        parser_fail(in, FILE_FORM, "this statement belongs to no mechanism");
        begin_mechanism(in, in->token.at)->nameless = true;
    }
    return read_statement(in, IN_FILE | IN_MECHANISM);
}

void read_file(parser *in) {
    parser_next(in);
    for (;;) {
        parser_skip_lines(in);
        if (in->token.kind == TOKEN_END) {
            return;
        }
        if (parser_is_sign(in, '}')) {
            parser_fail(in, NULL, "'}' without '{'");
            parser_next(in);
            continue;
        }
        in->effect = -1;
        if (!read_outside(in)) {
            if (in->builder != NULL) {
                in->builder->broken = true;
            }
            parser_skip_statement(in);
        }
    }
}

/* === the whole text =========================================================================== */

static void parse_all(parser *in, place start) {
    read_file(in);
    if (in->builder_count == 0 && in->pending_count == 0 && diags_count(in->diags) == 0) {
        diag_error(in->diags, start, FILE_FORM, "this text contains no mechanism");
    }
    for (int i = 0; i < in->builder_count; i++) {
        const bool last = i + 1 == in->builder_count;
        const place end = last ? in->token.at : in->builders[i + 1]->made->at;
        in->builders[i]->made->last_line = end.line - (last && end.column > 1 ? 0 : 1);
        finish_mechanism(in, in->builders[i]);
    }
    for (int i = 0; i < in->pending_count && diags_count(in->diags) <= DIAG_MAX; i++) {
        read_noted_scene(in, &in->pending[i]);
    }
}

whirl_model *model_parse(const char *file, const char *text, size_t length, diags *all) {
    struct arena *memory = arena_new();
    source *whole = arena_alloc(memory, sizeof *whole);
    whole->file = arena_copy(memory, file, strlen(file));
    const bool too_long = length > MODEL_BYTES_MAX;
    whole->length = too_long ? 0 : length;
    whole->text = arena_copy(memory, text, whole->length);
    parser in = {.diags = all, .arena = memory, .effect = -1};
    const size_t before = diags_calls(all);
    in.lexer = lexer_start(whole, all);
    if (too_long) {
        diag_error(all, in.lexer.at, NULL, "the text is longer than %zu bytes", MODEL_BYTES_MAX);
    } else {
        parse_all(&in, in.lexer.at);
    }
    if (diags_calls(all) != before || diags_count(all) > DIAG_MAX) {
        arena_free(memory);
        return NULL;
    }
    whirl_model *made = arena_alloc(memory, sizeof *made);
    const mechanism **mechanisms =
        arena_alloc(memory, (size_t)in.builder_count * sizeof *mechanisms);
    for (int i = 0; i < in.builder_count; i++) {
        mechanisms[i] = in.builders[i]->made;
    }
    made->mechanisms = mechanisms;
    made->mechanism_count = in.builder_count;
    made->scenes = in.scenes;
    made->scene_count = in.scene_count;
    made->arena = memory;
    return made;
}

void model_free(whirl_model *done) {
    if (done != NULL) {
        arena_free(done->arena);
    }
}
