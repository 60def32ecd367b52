#include "override.h"

#include <stdio.h>
#include <string.h>

#include "host/lang/expression.h"
#include "host/lang/parser.h"
#include "host/lang/value.h"

static parser begin(const mechanism *of, const char *text, struct arena *arena, diags *all) {
    source *typed = arena_alloc(arena, sizeof *typed);
    typed->file = "<command line>";
    typed->length = strlen(text);
    typed->text = arena_copy(arena, text, typed->length);
    parser in = {
        .diags = all, .arena = arena, .effect = -1, .all_effects = true, .bare_units = true};
    in.names = of->names;
    in.lexer = lexer_start(typed, all);
    parser_next(&in);
    return in;
}

/* Reads the remaining text. A value without a unit is SI in the wanted dimension. */
static const expr *parse_quantity(parser *in, dimension wanted, const char *what) {
    const place at = in->token.at;
    const expr *made = parse_expression(in, CONTEXT_CONSTANT);
    if (made == NULL) {
        return NULL;
    }
    if (in->token.kind != TOKEN_END) {
        if (parser_end_statement(in, "the value")) {
            parser_fail(in, NULL, "%s is unexpected here", token_words(in, &in->token));
        }
        return NULL;
    }
    const bool is_bare = made->uses == 0 && dim_is_none(made->dim);
    if (!is_bare) {
        check_named(in, at, made, wanted, what, "is");
    }
    return made;
}

/* May this option change the symbol? If not, reports the reason. */
static bool check_target(parser *in, override_kind kind, const token *name, const symbol *target) {
    const bool moves = symbol_moves(target);
    const bool is_constant = target->kind == SYM_PARAMETER || target->kind == SYM_INPUT;
    const char *problem = NULL;
    const char *hint = NULL;
    if (!moves && !is_constant) {
        problem = "follows from other quantities and cannot be given";
    } else if (kind == OVERRIDE_SET && moves) {
        problem = "is not a parameter or an input";
        hint = "give its initial value with --start";
    } else if (kind == OVERRIDE_START && !moves) {
        problem = "is not a coordinate or a rate";
        hint = "change it with --set";
    } else if (is_constant && name->primes > 0) {
        problem = "has no derivative";
    } else if (moves && name->primes >= target->order) {
        problem = "has no initial value for this derivative: it follows from the equations";
    }
    if (problem != NULL) {
        diag_error(in->diags, name->at, hint, "'%s' %s", target->name, problem);
    }
    return problem == NULL;
}

bool override_parse(const mechanism *of, override_kind kind, const char *text,
                    const char *const around[2], struct arena *arena, diags *all,
                    assignment *made) {
    const size_t before = diags_calls(all);
    parser in = begin(of, text, arena, all);
    in.around = around;
    const token name = in.token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(&in, "write NAME=VALUE, such as m=3 or \"theta'=1.2\"",
                           "a name is missing");
    }
    parser_next(&in);
    const named *found = names_find(of->names, name.text, name.length);
    if (found == NULL) {
        no_such_symbol(&in, of, &name);
    }
    if (found == NULL || !check_target(&in, kind, &name, &found->symbol)) {
        return false;
    }
    if (!parser_is_sign(&in, '=')) {
        return parser_fail(&in, "write NAME=VALUE, such as m=3 or \"theta'=1.2\"",
                           "'=' is missing after '%s'", found->symbol.name);
    }
    parser_next(&in);
    dimension wanted = dim_none();
    if (!dim_derivative(found->symbol.dim, name.primes, &wanted)) {
        return false;
    }
    const char *words = token_words(&in, &name);
    const place at = in.token.at;
    *made = (assignment){&found->symbol, name.primes, parse_quantity(&in, wanted, words), name.at};
    return made->value != NULL && diags_calls(all) == before &&
           check_unit(&in, at, made->value, made->symbol, name.primes);
}

const expr *override_quantity(const mechanism *of, const char *what, const char *text,
                              dimension wanted, struct arena *arena, diags *all) {
    const size_t before = diags_calls(all);
    parser in = begin(of, text, arena, all);
    const expr *made = parse_quantity(&in, wanted, what);
    return diags_calls(all) == before ? made : NULL;
}

const expr *override_size(const mechanism *of, const char *name, const char *what, const char *text,
                          struct arena *arena, diags *all) {
    const size_t calls = diags_calls(all);
    const size_t length = strcspn(name, "'");
    const int primes = (int)(strlen(name) - length);
    const named *found = names_find(of->names, name, length);
    const symbol *known = found != NULL && (int)strspn(name + length, "'") == primes &&
                                  (symbol_moves(&found->symbol) || found->symbol.kind == SYM_OUTPUT)
                              ? &found->symbol
                              : NULL;
    dimension wanted = dim_none();
    wanted.unknown = known == NULL || !dim_derivative(known->dim, primes, &wanted);
    parser in = begin(of, text, arena, all);
    for (bool before = strchr(text, '=') != NULL; before; parser_next(&in)) {
        before = in.token.kind != TOKEN_END && !parser_is_sign(&in, '=');
    }
    const place at = in.token.at;
    const expr *made = parse_quantity(&in, wanted, what);
    return diags_calls(all) == calls && (known == NULL || check_unit(&in, at, made, known, primes))
               ? made
               : NULL;
}

const expr *override_duration(const mechanism *of, const char *what, const char *text,
                              struct arena *arena, diags *all) {
    return override_quantity(of, what, text, dim_of_quantity(QUANTITY_TIME), arena, all);
}

const char *effect_hint(const mechanism *of, const char *text, size_t length,
                        char hint[EFFECT_HINT]) {
    nearest search = nearest_start(text, length);
    size_t at = (size_t)snprintf(hint, EFFECT_HINT, "choose one of ");
    for (int i = 0; i <= of->effect_count && at < EFFECT_HINT; i++) {
        const bool last = i == of->effect_count;
        const char *name = last ? word_row(WORD_LEDGER)->text : of->effects[i].name;
        nearest_offer(&search, name);
        at += (size_t)snprintf(hint + at, EFFECT_HINT - at, last ? "%s" : "%s, ", name);
    }
    if (search.best != NULL) {
        snprintf(hint, EFFECT_HINT, "did you mean '%s'?", search.best);
    } else if (of->effect_count == 0) {
        snprintf(hint, EFFECT_HINT, "the mechanism '%s' has no effects", of->name);
    }
    return hint;
}

int override_effect(const mechanism *of, const char *text, struct arena *arena, diags *all) {
    parser in = begin(of, text, arena, all);
    for (int i = 0; i < of->effect_count; i++) {
        if (strcmp(of->effects[i].name, text) == 0) {
            return i;
        }
    }
    char hint[EFFECT_HINT];
    diag_error(all, in.token.at, effect_hint(of, text, strlen(text), hint),
               "unknown effect '%.60s'", text);
    return -1;
}
