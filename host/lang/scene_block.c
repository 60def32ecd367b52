/* scene.c: scene blocks. They are read last, so that they may name effects that follow them. */
#include "scene_block.h"

#include <stdio.h>
#include <string.h>

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
        return scene_fail_name(in, "use");
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

static bool parse_scene_when(parser *in, draft *into) {
    scene *made = into->made;
    contact_statement each = {.kind = CONTACT_WHEN, .effect = -1, .at = in->token.at};
    parser_next(in);
    if (!parse_when(in, &each)) {
        return false;
    }
    if (made->mechanism->is_system) {
        contact_on_system(in, &each);
    }
    contact_statement *longer =
        arena_room(in->arena, (contact_statement *)made->whens, made->when_count, sizeof *longer);
    longer[made->when_count++] = each;
    made->whens = longer;
    return true;
}

static bool parse_scene_statement(parser *in, draft *into) {
    static const char *const words[] = {"use",  "with",  "set",      "start",
                                        "step", "until", "conserve", "when"};
    const token word = in->token;
    in->statement = word.at.offset;
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
    } lists[] = {{"with", scene_with_item},
                 {"set", scene_set_item},
                 {"start", scene_start_item},
                 {"conserve", scene_conserve_item}};
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
    if (token_is(&word, "when")) {
        return parse_scene_when(in, into);
    }
    static const char *const elsewhere[] = {"stop", "friction", "hold", "noise"};
    for (size_t i = 0; i < sizeof elsewhere / sizeof elsewhere[0]; i++) {
        if (token_is(&word, elsewhere[i])) {
            return parser_fail(in, "put it into an effect, and call for that: with NAME",
                               "'%s' belongs into a mechanism or an effect", elsewhere[i]);
        }
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
            into->made->last_line = in->token.at.line;
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
    if (good && into.of != NULL) {
        scene_check_sets(in, &into);
    }
    into.made->with = into.with;
    into.made->conserve = into.conserve;
    return good;
}
