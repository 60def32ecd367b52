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
    if (token_is(&in->token, "none")) {
        parser_fail(in, NULL, "'none' is a reserved word: `with none` calls for no effect");
    }
    if (token_is(&in->token, "ledger")) {
        parser_fail(in, "`with ledger` keeps the books of energy and momentum: take another name",
                    "'ledger' is a reserved word");
    }
    parser_next(in);
    return true;
}

bool parse_effect(parser *in) {
    mechanism *into = in->builder->made;
    effect made = {"", "", in->token.at};
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
