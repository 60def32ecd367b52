/* scene.c: scene blocks. They are read last, so that they may name effects that follow them. */
#include <stdio.h>
#include <string.h>

#include "parser.h"

/* A scene being read. */
typedef struct draft {
    scene *made;
    bool *with;
    bool *conserve;
    builder *of;
    int number;       /* from 1: marks the symbols that were set */
    bool has_content; /* a statement other than `use` was met */
    place step_at;    /* line 0: none yet */
    place until_at;
} draft;

typedef bool item_reader(parser *in, draft *into);

static bool fail_name(parser *in, const char *what) {
    char words[80];
    return parser_fail(in, NULL, "%s needs a name, not %s", what,
                       token_words(&in->token, words, sizeof words));
}

/* ITEM {, ITEM}: a line may end after a comma. */
static bool parse_list(parser *in, draft *into, item_reader *read) {
    for (;;) {
        if (!read(in, into)) {
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

static bool choose_mechanism(parser *in, draft *into, builder *chosen) {
    into->of = chosen;
    into->made->mechanism = chosen->made;
    into->with = arena_alloc(in->arena, (size_t)chosen->made->effect_count * sizeof *into->with);
    into->conserve =
        arena_alloc(in->arena, (size_t)chosen->made->coordinate_count * sizeof *into->conserve);
    in->builder = chosen;
    in->names = chosen->names;
    return true;
}

static bool parse_use(parser *in, draft *into) {
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        return fail_name(in, "use");
    }
    const token name = in->token;
    parser_next(in);
    nearest search = nearest_start(name.text, name.length);
    for (int i = 0; i < in->builder_count; i++) {
        if (token_is(&name, in->builders[i]->made->name)) {
            choose_mechanism(in, into, in->builders[i]);
            return parser_end_statement(in, "the mechanism's name");
        }
        nearest_offer(&search, in->builders[i]->made->name);
    }
    char hint[120] = "";
    char words[80];
    if (search.best != NULL) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
    }
    diag_error(in->diags, name.at, hint[0] == '\0' ? NULL : hint, "no mechanism %s in this file",
               token_words(&name, words, sizeof words));
    into->of = NULL;
    return true;
}

static bool parse_with_item(parser *in, draft *into) {
    if (in->token.kind != TOKEN_NAME) {
        return fail_name(in, "with");
    }
    const token name = in->token;
    const mechanism *of = into->made->mechanism;
    nearest search = nearest_start(name.text, name.length);
    parser_next(in);
    if (token_is(&name, "none")) {
        return true;
    }
    for (int i = 0; i < of->effect_count; i++) {
        if (token_is(&name, of->effects[i].name)) {
            into->with[i] = true;
            return true;
        }
        nearest_offer(&search, of->effects[i].name);
    }
    char hint[120] = "";
    char words[80];
    if (search.best != NULL) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
    } else if (of->effect_count == 0) {
        snprintf(hint, sizeof hint, "the mechanism '%s' has no effects", of->name);
    }
    diag_error(in->diags, name.at, hint[0] == '\0' ? NULL : hint, "unknown effect %s",
               token_words(&name, words, sizeof words));
    return true;
}

/* NAME of a symbol of the mechanism; *found is NULL when it is none (reported). */
static bool take_symbol(parser *in, draft *into, const char *statement, token *name,
                        named **found) {
    if (in->token.kind != TOKEN_NAME) {
        return fail_name(in, statement);
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

/* = EXPR with the wanted dimension (not checked when the name is unknown). */
static bool parse_assigned(parser *in, const token *name, const dimension *wanted,
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
    if (wanted != NULL) {
        char rule[RULE_SIZE];
        check_dimension(in, at, *value, *wanted, dimension_rule(rule, words, "is", *wanted));
    }
    return true;
}

static bool parse_set_item(parser *in, draft *into) {
    token name;
    named *found = NULL;
    const expr *value = NULL;
    if (!take_symbol(in, into, "set", &name, &found)) {
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
    if (!parse_assigned(in, &name, usable ? &found->symbol.dim : NULL, &value)) {
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

static bool parse_start_item(parser *in, draft *into) {
    token name;
    named *found = NULL;
    const expr *value = NULL;
    dimension wanted = dim_none();
    if (!take_symbol(in, into, "start", &name, &found)) {
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
    if (!parse_assigned(in, &name, usable ? &wanted : NULL, &value)) {
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

static bool parse_conserve_item(parser *in, draft *into) {
    token name;
    named *found = NULL;
    if (!take_symbol(in, into, "conserve", &name, &found)) {
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

/* step EXPR, until EXPR: seconds. */
static bool parse_duration(parser *in, place word_at, const char *word, place *first,
                           const expr **into) {
    if (first->line > 0) {
        diag_error(in->diags, word_at, NULL, "%s was already given in line %d", word, first->line);
    }
    *first = word_at;
    const place at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_CONSTANT);
    if (value == NULL) {
        return false;
    }
    const dimension wanted = dim_of(0, 0, 1, 0, 0);
    char rule[RULE_SIZE];
    check_dimension(in, at, value, wanted, dimension_rule(rule, word, "is", wanted));
    *into = value;
    return parser_end_statement(in, "the expression");
}

static bool parse_scene_statement(parser *in, draft *into) {
    static const char *const words[] = {"use", "with", "set", "start", "step", "until", "conserve"};
    const token word = in->token;
    in->statement = word.at.offset;
    if (is_hybrid(in)) {
        return skip_hybrid(in);
    }
    if (token_is(&word, "use")) {
        parser_next(in);
        if (into->has_content) {
            diag_error(in->diags, word.at, NULL, "'use' comes first in a scene");
        }
        return parse_use(in, into);
    }
    into->has_content = true;
    if (into->of == NULL) {
        diag_error(in->diags, into->made->at, "name its mechanism with: use NAME",
                   "scene '%s' stands in no mechanism", into->made->name);
        return false;
    }
    static const struct {
        const char *word;
        item_reader *read;
    } lists[] = {{"with", parse_with_item},
                 {"set", parse_set_item},
                 {"start", parse_start_item},
                 {"conserve", parse_conserve_item}};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        if (token_is(&word, lists[i].word)) {
            parser_next(in);
            return parse_list(in, into, lists[i].read);
        }
    }
    if (token_is(&word, "step")) {
        parser_next(in);
        return parse_duration(in, word.at, "step", &into->step_at, &into->made->step);
    }
    if (token_is(&word, "until")) {
        parser_next(in);
        return parse_duration(in, word.at, "until", &into->until_at, &into->made->until);
    }
    return statement_unknown(in, words, sizeof words / sizeof words[0]);
}

/* Words that only stand outside scenes: the scene's brace must have been forgotten. */
static bool leaves_scene(const parser *in) {
    static const char *const words[] = {"mechanism", "scene", "effect",    "coordinate", "state",
                                        "output",    "let",   "parameter", "equation"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (in->token.starts_line && parser_is_word(in, words[i])) {
            return true;
        }
    }
    return false;
}

static bool parse_body(parser *in, draft *into) {
    for (;;) {
        parser_skip_lines(in);
        if (parser_is_sign(in, '}')) {
            parser_next(in);
            return parser_end_statement(in, "the scene");
        }
        if (in->token.kind == TOKEN_END || leaves_scene(in)) {
            diag_error(in->diags, into->made->at, NULL, "scene '%s' is not closed with '}'",
                       into->made->name);
            return false;
        }
        const bool had_mechanism = into->of != NULL;
        if (!parse_scene_statement(in, into)) {
            parser_skip_statement(in);
        }
        if (into->of == NULL && (had_mechanism || into->has_content)) {
            return false; /* an unknown mechanism: nothing more to check here */
        }
    }
}

bool parse_scene(parser *in, const pending_scene *pending) {
    draft into = {.made = arena_alloc(in->arena, sizeof *into.made)};
    in->lexer = pending->from;
    in->parentheses = 0;
    in->nesting = 0;
    in->effect = -1;
    in->all_effects = true;
    into.made->at = pending->at;
    parser_next(in);
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        return parser_fail(in, "scene from_rest \"title\" { until 9 [s] }", "a scene needs a name");
    }
    into.made->at = in->token.at;
    into.made->name = parser_copy_text(in, &in->token);
    for (int i = 0; i < in->scene_count; i++) {
        if (strcmp(in->scenes[i]->name, into.made->name) == 0) {
            diag_error(in->diags, in->token.at, NULL, "scene '%s' was already declared in line %d",
                       into.made->name, in->scenes[i]->at.line);
            break;
        }
    }
    parser_next(in);
    into.made->title = parser_title(in);
    while (in->token.kind == TOKEN_NEWLINE) {
        parser_next(in);
    }
    if (!parser_expect_sign(in, '{', "after the scene's name")) {
        return false;
    }
    if (pending->inside != NULL) {
        choose_mechanism(in, &into, pending->inside);
    }
    in->scenes = arena_room(in->arena, in->scenes, in->scene_count, sizeof *in->scenes);
    in->scenes[in->scene_count++] = into.made;
    into.number = 2 + in->scene_count; /* apart from the marks of finish.c */
    const bool good = parse_body(in, &into);
    if (good && into.of == NULL) {
        diag_error(in->diags, into.made->at, "name its mechanism with: use NAME",
                   "scene '%s' stands in no mechanism", into.made->name);
    }
    into.made->with = into.with;
    into.made->conserve = into.conserve;
    return good;
}
