/* effect.c: effect blocks. */
#include <stdio.h>
#include <string.h>

#include "parser.h"

/* Words that begin something outside: the effect's brace must have been forgotten. */
static bool leaves_effect(const parser *in) {
    return in->token.starts_line && (parser_is_word(in, "mechanism") ||
                                     parser_is_word(in, "scene") || parser_is_word(in, "effect"));
}

static bool parse_inside(parser *in) {
    static const char *const words[] = {"parameter", "input", "let",      "T",    "V",    "F",
                                        "Q",         "stop",  "friction", "hold", "when", "noise"};
    bool known = false;
    in->statement = in->token.at.offset;
    bool good = parse_declaration(in, &known);
    if (!known) {
        good = parse_term(in, &known);
    }
    if (!known) {
        good = parse_contact(in, &known);
    }
    if (!known) {
        good = parse_noise(in, &known);
    }
    return known ? good : statement_unknown(in, words, sizeof words / sizeof words[0]);
}

static bool parse_name(parser *in, effect *made) {
    /* words that stand where effects are called for */
    static const struct {
        const char *word;
        const char *as;
    } meant[] = {{"none", "`with none` calls for no effect"},
                 {"ledger", "`with ledger` keeps the books of energy and momentum"},
                 {"all", "`--with all` calls for every effect"},
                 {"conserve", "`--without conserve` integrates what a scene conserves"}};
    const mechanism *into = in->builder->made;
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        return parser_fail(in, "effect drag \"viscous drag\" { F += b*X'^2/2 }",
                           "an effect needs a name");
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
        if (token_is(&in->token, meant[i].word)) {
            char hint[120];
            snprintf(hint, sizeof hint, "%s: take another name", meant[i].as);
            parser_fail(in, hint, "'%s' is a reserved word", meant[i].word);
        }
    }
    parser_next(in);
    return true;
}

bool parse_effect(parser *in) {
    mechanism *into = in->builder->made;
    effect made = {"", "", in->token.at, 0};
    parser_next(in);
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
        if (in->token.kind == TOKEN_END || leaves_effect(in)) {
            diag_error(in->diags, made.at, NULL, "effect '%s' is not closed with '}'", made.name);
            in->effect = -1;
            return true;
        }
        if (!parse_inside(in)) {
            parser_skip_statement(in);
            in->builder->broken = true;
        }
    }
}
