/* scene.c: scene blocks. They are read last, so that they may name effects that follow them. */
#include "scene_block.h"

#include <stdio.h>
#include <string.h>

static void choose_mechanism(parser *in, draft *into, builder *chosen) {
    into->of = chosen;
    into->made->mechanism = chosen->made;
    into->with = arena_alloc(in->arena, (size_t)chosen->made->effect_count * sizeof *into->with);
    into->conserve =
        arena_alloc(in->arena, (size_t)chosen->made->coordinate_count * sizeof *into->conserve);
    in->builder = chosen;
    in->names = chosen->names;
}

bool read_use(parser *in, const statement_word *word) {
    draft *into = in->draft;
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        return scene_fail_name(in, word);
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
static bool parse_duration(parser *in, const statement_word *word, place *first,
                           const expr **into) {
    if (first->line > 0) {
        diag_error(in->diags, in->statement_at, NULL, "%s was already given in line %d", word->text,
                   first->line);
    }
    *first = in->statement_at;
    const place at = in->token.at;
    const expr *value = parse_expression(in, CONTEXT_CONSTANT);
    if (value == NULL) {
        return false;
    }
    const dimension wanted = dim_of(0, 0, 1, 0, 0);
    char rule[RULE_SIZE];
    check_dimension(in, at, value, wanted, dimension_rule(rule, word->text, "is", wanted));
    *into = value;
    return parser_end_statement(in, "the expression");
}

bool read_step(parser *in, const statement_word *word) {
    return parse_duration(in, word, &in->draft->step_at, &in->draft->made->step);
}

bool read_until(parser *in, const statement_word *word) {
    return parse_duration(in, word, &in->draft->until_at, &in->draft->made->until);
}

#define READER(id, text, stands, rules, reader, kind, form) [WORD_##id] = reader,
static statement_reader *const readers[] = {SCENE_WORD_ROWS(READER)[WORD_WHEN] = read_when};
#undef READER

static bool parse_scene_statement(parser *in) {
    draft *into = in->draft;
    const statement_word *word = token_statement(&in->token);
    const bool uses = parser_is_word(in, WORD_USE);
    in->statement_at = in->token.at;
    if (uses && into->has_content) {
        diag_error(in->diags, in->token.at, NULL, "'use' comes first in a scene");
    }
    if (!uses && into->of == NULL) {
        into->has_content = true;
        diag_error(in->diags, into->made->at, "name its mechanism with: use NAME",
                   "scene '%s' stands in no mechanism", into->made->name);
        return false;
    }
    into->has_content |= !uses;
    if (word != NULL && (word->rules & INTO_EFFECT) != 0) {
        return parser_fail(in, "put it into an effect, and call for that: with NAME",
                           "'%s' belongs into a mechanism or an effect", word->text);
    }
    if (word == NULL || (word->stands & IN_SCENE) == 0) {
        return statement_unknown(in, IN_SCENE);
    }
    parser_next(in);
    return readers[word - word_row((word_id)0)](in, word);
}

static bool parse_body(parser *in) {
    draft *into = in->draft;
    for (;;) {
        parser_skip_lines(in);
        if (parser_is_sign(in, '}')) {
            into->made->last_line = in->token.at.line;
            parser_next(in);
            return parser_end_statement(in, "the scene");
        }
        if (in->token.kind == TOKEN_END || parser_leaves(in, ENDS_SCENE)) {
            diag_error(in->diags, into->made->at, NULL, "scene '%s' is not closed with '}'",
                       into->made->name);
            return false;
        }
        const bool had_mechanism = into->of != NULL;
        if (!parse_scene_statement(in)) {
            parser_skip_statement(in);
        }
        if (into->of == NULL && (had_mechanism || into->has_content)) {
            return false; /* an unknown mechanism: nothing more to check here */
        }
    }
}

static void read_scene(parser *in, const pending_scene *pending, draft *into) {
    in->lexer = pending->from;
    in->token = pending->next;
    in->draft = into;
    in->parentheses = 0;
    in->nesting = 0;
    in->effect = -1;
    in->all_effects = true;
    into->made->at = pending->at;
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        parser_fail(in, word_row(WORD_SCENE)->form, "a scene needs a name");
        return;
    }
    into->made->at = in->token.at;
    into->made->name = parser_copy_text(in, &in->token);
    for (int i = 0; i < in->scene_count; i++) {
        if (strcmp(in->scenes[i]->name, into->made->name) == 0) {
            diag_error(in->diags, in->token.at, NULL, "scene '%s' was already declared in line %d",
                       into->made->name, in->scenes[i]->at.line);
            break;
        }
    }
    parser_next(in);
    into->made->title = parser_title(in);
    while (in->token.kind == TOKEN_NEWLINE) {
        parser_next(in);
    }
    if (!parser_expect_sign(in, '{', "after the scene's name")) {
        return;
    }
    if (pending->inside != NULL) {
        choose_mechanism(in, into, pending->inside);
    }
    in->scenes = arena_room(in->arena, in->scenes, in->scene_count, sizeof *in->scenes);
    in->scenes[in->scene_count++] = into->made;
    into->number = 2 + in->scene_count; /* apart from the marks of finish.c */
    const bool good = parse_body(in);
    if (good && into->of == NULL) {
        diag_error(in->diags, into->made->at, "name its mechanism with: use NAME",
                   "scene '%s' stands in no mechanism", into->made->name);
    }
    if (good && into->of != NULL) {
        scene_check_sets(in, into);
    }
    into->made->with = into->with;
    into->made->conserve = into->conserve;
}

void read_noted_scene(parser *in, const pending_scene *pending) {
    draft into = {.made = arena_alloc(in->arena, sizeof *into.made)};
    read_scene(in, pending, &into);
    in->draft = NULL;
}
