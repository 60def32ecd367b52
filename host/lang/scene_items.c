/* scene_items.c: what the lists of a scene hold: with, set, start, conserve. */
#include <stdio.h>
#include <string.h>

#include "override.h"
#include "scene_block.h"

bool scene_fail_name(parser *in, const statement_word *word) {
    char words[80];
    return parser_fail(
        in,
        in->token.kind == TOKEN_NUMBER ? "NAME = VALUE; a number has a decimal point: 0.1" : NULL,
        "%s needs a name, not %s", word->text, token_words(&in->token, words, sizeof words));
}

static bool with_item(parser *in, const statement_word *word) {
    draft *into = in->draft;
    if (in->token.kind != TOKEN_NAME) {
        return scene_fail_name(in, word);
    }
    const token name = in->token;
    const mechanism *of = into->made->mechanism;
    parser_next(in);
    if (token_is_word(&name, WORD_NONE)) {
        return true;
    }
    if (token_is_word(&name, WORD_LEDGER)) {
        into->made->ledger = true;
        return true;
    }
    for (int i = 0; i < of->effect_count; i++) {
        if (token_is(&name, of->effects[i].name)) {
            into->with[i] = true;
            return true;
        }
    }
    char hint[EFFECT_HINT];
    char words[80];
    diag_error(in->diags, name.at, effect_hint(of, name.text, name.length, hint),
               "unknown effect %s", token_words(&name, words, sizeof words));
    return true;
}

bool scene_take_symbol(parser *in, draft *into, const statement_word *word, token *name,
                       named **found) {
    if (in->token.kind != TOKEN_NAME) {
        return scene_fail_name(in, word);
    }
    *name = in->token;
    parser_next(in);
    *found = names_find(into->of->names, name->text, name->length);
    if (*found != NULL) {
        return true;
    }
    nearest search = nearest_start(name->text, name->length);
    char hint[120] = "";
    char words[80];
    names_offer(into->of->names, -2, &search);
    if (search.best != NULL) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
    }
    diag_error(in->diags, name->at, hint[0] == '\0' ? NULL : hint,
               "%s is unknown in mechanism '%s'", token_words(name, words, sizeof words),
               into->made->mechanism->name);
    return true;
}

/* = EXPR of the symbol, with the wanted dimension (not checked when the name is unknown: NULL). */
static bool parse_assigned(parser *in, const token *name, const symbol *of, dimension wanted,
                           const expr **value) {
    char words[80];
    token_words(name, words, sizeof words);
    if (!parser_is_sign(in, '=')) {
        char next[80];
        return parser_fail(in, NULL, "'=' is missing after %s, before %s", words,
                           token_words(&in->token, next, sizeof next));
    }
    parser_next(in);
    const place at = in->token.at;
    *value = parse_expression(in, CONTEXT_CONSTANT);
    if (*value == NULL) {
        return false;
    }
    char rule[RULE_SIZE];
    if (of != NULL && check_unit(in, at, *value, of, name->primes)) {
        check_dimension(in, at, *value, wanted, dimension_rule(rule, words, "is", wanted));
    }
    return true;
}

static bool set_item(parser *in, const statement_word *word) {
    draft *into = in->draft;
    token name;
    named *found = NULL;
    const expr *value = NULL;
    if (!scene_take_symbol(in, into, word, &name, &found)) {
        return false;
    }
    bool usable = found != NULL && !found->is_placeholder;
    if (usable && found->symbol.kind != SYM_PARAMETER && found->symbol.kind != SYM_INPUT) {
        const bool moves = found->symbol.kind == SYM_COORDINATE || found->symbol.kind == SYM_STATE;
        diag_error(in->diags, name.at, moves ? "give its initial value with start" : NULL,
                   "only parameters and inputs can be set, and '%s' is none", found->symbol.name);
        usable = false;
    } else if (usable && name.primes > 0) {
        diag_error(in->diags, name.at, NULL, "'%s' has no derivative", found->symbol.name);
        usable = false;
    } else if (usable && found->mark == into->number) {
        diag_error(in->diags, name.at, NULL, "'%s' was already set in line %d", found->symbol.name,
                   found->mark_at.line);
    }
    if (!parse_assigned(in, &name, usable ? &found->symbol : NULL,
                        usable ? found->symbol.dim : dim_none(), &value)) {
        return false;
    }
    if (usable) {
        scene *made = into->made;
        found->mark = into->number;
        found->mark_at = name.at;
        assignment *longer =
            arena_room(in->arena, (assignment *)made->sets, made->set_count, sizeof *longer);
        longer[made->set_count++] = (assignment){&found->symbol, 0, value, name.at};
        made->sets = longer;
    }
    return true;
}

void scene_check_sets(parser *in, const draft *read) {
    const scene *made = read->made;
    for (int i = 0; i < made->set_count; i++) {
        const assignment *each = &made->sets[i];
        const int of = each->symbol->effect;
        if (of >= 0 && !read->with[of]) {
            const char *name = made->mechanism->effects[of].name;
            char hint[120];
            snprintf(hint, sizeof hint, "add to the scene: with %.80s", name);
            diag_error(in->diags, each->at, hint,
                       "'%s' belongs to the effect '%s', which this scene does not name",
                       each->symbol->name, name);
        }
    }
}

static void check_started_once(parser *in, const scene *made, const symbol *what,
                               const token *name) {
    for (int i = 0; i < made->start_count; i++) {
        if (made->starts[i].symbol == what && made->starts[i].primes == name->primes) {
            char words[80];
            diag_error(in->diags, name->at, NULL, "%s was already given in line %d",
                       token_words(name, words, sizeof words), made->starts[i].at.line);
        }
    }
}

static bool start_item(parser *in, const statement_word *word) {
    draft *into = in->draft;
    token name;
    named *found = NULL;
    const expr *value = NULL;
    dimension wanted = dim_none();
    if (!scene_take_symbol(in, into, word, &name, &found)) {
        return false;
    }
    bool usable = found != NULL && !found->is_placeholder;
    if (usable && found->symbol.kind != SYM_COORDINATE && found->symbol.kind != SYM_STATE) {
        const bool sets = found->symbol.kind == SYM_PARAMETER || found->symbol.kind == SYM_INPUT;
        diag_error(in->diags, name.at, sets ? "use set for it" : NULL,
                   "start takes coordinates and their rates, and '%s' is none", found->symbol.name);
        usable = false;
    } else if (usable && name.primes >= found->symbol.order && found->symbol.order > 0) {
        diag_error(in->diags, name.at, NULL,
                   "start takes '%s' with at most %d prime%s: the next follows from the equations",
                   found->symbol.name, found->symbol.order - 1,
                   found->symbol.order == 2 ? "" : "s");
        usable = false;
    } else if (usable) {
        check_started_once(in, into->made, &found->symbol, &name);
        usable = dim_power(dim_of(0, 0, -1, 0, 0), name.primes, &wanted) &&
                 dim_multiply(found->symbol.dim, wanted, &wanted);
    }
    if (!parse_assigned(in, &name, usable ? &found->symbol : NULL, wanted, &value)) {
        return false;
    }
    if (usable) {
        scene *made = into->made;
        assignment *longer =
            arena_room(in->arena, (assignment *)made->starts, made->start_count, sizeof *longer);
        longer[made->start_count++] = (assignment){&found->symbol, name.primes, value, name.at};
        made->starts = longer;
    }
    return true;
}

static bool conserve_item(parser *in, const statement_word *word) {
    draft *into = in->draft;
    token name;
    named *found = NULL;
    if (!scene_take_symbol(in, into, word, &name, &found)) {
        return false;
    }
    if (found == NULL || found->is_placeholder) {
        return true;
    }
    if (found->symbol.kind != SYM_COORDINATE || name.primes > 0) {
        diag_error(in->diags, name.at, NULL, "conserve takes coordinates, without primes");
        return true;
    }
    into->conserve[found->symbol.index] = true;
    return true;
}

bool scene_list(parser *in, const statement_word *word, statement_reader *read) {
    for (;;) {
        if (!read(in, word)) {
            return false;
        }
        if (!parser_is_sign(in, ',')) {
            return parser_end_statement(in, "the list");
        }
        parser_next(in);
        while (in->token.kind == TOKEN_NEWLINE) {
            parser_next(in);
        }
    }
}

bool read_with(parser *in, const statement_word *word) { return scene_list(in, word, with_item); }

bool read_set(parser *in, const statement_word *word) { return scene_list(in, word, set_item); }

bool read_start(parser *in, const statement_word *word) { return scene_list(in, word, start_item); }

bool read_conserve(parser *in, const statement_word *word) {
    return scene_list(in, word, conserve_item);
}
