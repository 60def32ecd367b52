/* statements.c: which statement comes next, and who reads it; mechanisms and effects. */
#include "statements.h"

#include <stdio.h>
#include <string.h>

static bool read_statement(parser *in, unsigned where);

static bool parse_name(parser *in, effect *made) {
    /* words that stand where effects are called for */
    static const struct {
        word_id word;
        const char *as;
    } meant[] = {{WORD_NONE, "`with none` calls for no effect"},
                 {WORD_LEDGER, "`with ledger` keeps the books of energy and momentum"},
                 {WORD_ALL, "`--with all` calls for every effect"},
                 {WORD_CONSERVE, "`--without conserve` integrates what a scene conserves"}};
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
            char hint[120];
            snprintf(hint, sizeof hint, "%s: take another name", meant[i].as);
            parser_fail(in, hint, "'%s' is a reserved word", word_row(meant[i].word)->text);
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
    while (in->token.kind == TOKEN_NEWLINE) {
        parser_next(in);
    }
    if (!parser_expect_sign(in, '{', "after the effect's name")) {
        return false;
    }
    for (;;) {
        parser_skip_lines(in);
        if (parser_is_sign(in, '}')) {
            longer[in->effect].last_line = in->token.at.line;
            parser_next(in);
            in->effect = -1;
            return parser_end_statement(in, "the effect");
        }
        if (in->token.kind == TOKEN_END || parser_leaves(in, ENDS_EFFECT)) {
            diag_error(in->diags, made.at, NULL, "effect '%s' is not closed with '}'", made.name);
            in->effect = -1;
            return true;
        }
        if (!read_statement(in, IN_EFFECT)) {
            parser_skip_statement(in);
            in->builder->broken = true;
        }
    }
}

static builder *begin_mechanism(parser *in, place at) {
    builder *made = arena_alloc(in->arena, sizeof *made);
    made->made = arena_alloc(in->arena, sizeof *made->made);
    made->made->at = at;
    made->made->name = "";
    made->made->title = "";
    made->names = names_new(in->arena);
    made->made->names = made->names;
    made->force_at = arena_alloc(in->arena, COORDINATES_MAX * sizeof *made->force_at);
    in->builders = arena_room(in->arena, in->builders, in->builder_count, sizeof *in->builders);
    in->builders[in->builder_count++] = made;
    in->builder = made;
    in->names = made->names;
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

/* Remember where the scene is and move on behind it: effects may follow that it names. */
static bool read_scene(parser *in, const statement_word *word) {
    (void)word;
    if (in->pending_count == SCENES_MAX) {
        in->lexer.stopped = true;
        return parser_fail(in, NULL, "more than %d scenes in one file", SCENES_MAX);
    }
    in->pending = arena_room(in->arena, in->pending, in->pending_count, sizeof *in->pending);
    in->pending[in->pending_count++] =
        (pending_scene){in->lexer, in->token, in->statement_at, in->builder};
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

/* --- which statement ----------------------------------------------------------------------------*/

#define READER(id, text, stands, rules, reader, kind, form) [WORD_##id] = reader,
static statement_reader *const readers[] = {BODY_WORD_ROWS(READER)};
#undef READER

/* Coordinates go with energies, states with equations: one way or the other. */
static void note_way(parser *in, const statement_word *word) {
    builder *into = in->builder;
    if (into == NULL) {
        return; /* the words of a file go both ways */
    }
    into->has_equations |= (word->rules & BY_EQUATIONS) != 0;
    into->has_energies |= (word->rules & BY_ENERGIES) != 0;
    if (into->has_equations && into->has_energies && !into->mixed) {
        into->mixed = true;
        parser_fail(in, "write coordinate with T, V, F, Q, or state with equation",
                    "'%s' does not go with what this mechanism began with", word->text);
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

/* What stands outside all blocks. */
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
