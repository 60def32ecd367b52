/* scene_block.c: the parser of scene blocks. */
#include <string.h>

#include "host/lang/override.h"
#include "host/lang/statements.h"
#include "host/lang/value.h"

/* === the lists of a scene: with, set, start, conserve, range ================================== */

static bool scene_fail_name(parser *in, const statement_word *word) {
    return parser_fail(in,
                       in->token.kind == TOKEN_NUMBER
                           ? "write NAME = VALUE, and numbers with a decimal point: 0.1"
                           : NULL,
                       "%s needs a name, not %s", word->text, token_words(in, &in->token));
}

static bool read_with(parser *in, const statement_word *word) {
    scene *made = in->draft->made;
    if (in->token.kind != TOKEN_NAME) {
        return scene_fail_name(in, word);
    }
    const token name = in->token;
    const mechanism *of = made->mechanism;
    parser_next(in);
    if (token_is_word(&name, WORD_NONE)) {
        return true;
    }
    if (token_is_word(&name, WORD_LEDGER)) {
        made->ledger = true;
        return true;
    }
    for (int i = 0; i < of->effect_count; i++) {
        if (token_is(&name, of->effects[i].name)) {
            made->with[i] = true;
            return true;
        }
    }
    char hint[EFFECT_HINT];
    diag_error(in->diags, name.at, effect_hint(of, name.text, name.length, hint),
               "unknown effect %s", token_words(in, &name));
    return true;
}

/* Reads a name. If the name is unknown, reports this and sets *found to NULL. */
static bool scene_take_symbol(parser *in, const statement_word *word, token *name,
                              const symbol **found) {
    if (in->token.kind != TOKEN_NAME) {
        (void)scene_fail_name(in, word);
        return false;
    }
    *name = in->token;
    parser_next(in);
    const named *known = names_find(in->names, name->text, name->length);
    if (known == NULL) {
        no_such_symbol(in, in->draft->made->mechanism, name);
    }
    *found = known == NULL || known->is_placeholder ? NULL : &known->symbol;
    return true;
}

static bool read_set(parser *in, const statement_word *word) {
    scene *made = in->draft->made;
    token name;
    const symbol *what;
    if (!scene_take_symbol(in, word, &name, &what)) {
        return false;
    }
    if (what != NULL && what->kind != SYM_PARAMETER && what->kind != SYM_INPUT) {
        diag_error(in->diags, name.at,
                   symbol_moves(what) ? "give its initial value with start" : NULL,
                   "only parameters and inputs can be set, and '%s' is neither", what->name);
        what = NULL;
    } else if (what != NULL && name.primes > 0) {
        diag_error(in->diags, name.at, NULL, "'%s' has no derivative", what->name);
        what = NULL;
    }
    return parse_assigned(in, &name, what, WORD_SET, &made->sets, &made->set_count);
}

/* Reports a `set` for a symbol of an unselected effect. Called at the scene's end, because `with` may follow `set`. */
static void scene_check_sets(parser *in, const scene *made) {
    for (int i = 0; i < made->set_count; i++) {
        const assignment *each = &made->sets[i];
        const int of = each->symbol->effect;
        if (of >= 0 && !made->with[of]) {
            const char *name = made->mechanism->effects[of].name;
            diag_error(in->diags, each->at,
                       arena_words(in->arena, "add to the scene: with %s", name),
                       "'%s' belongs to the effect '%s', which this scene does not select",
                       each->symbol->name, name);
        }
    }
}

static bool read_start(parser *in, const statement_word *word) {
    scene *made = in->draft->made;
    token name;
    const symbol *what;
    if (!scene_take_symbol(in, word, &name, &what)) {
        return false;
    }
    if (what != NULL && !symbol_moves(what)) {
        const bool sets = what->kind == SYM_PARAMETER || what->kind == SYM_INPUT;
        diag_error(in->diags, name.at, sets ? "use set for it" : NULL,
                   "start takes coordinates and their rates, and '%s' is neither", what->name);
        what = NULL;
    } else if (what != NULL && name.primes >= what->order && what->order > 0) {
        diag_error(
            in->diags, name.at, NULL,
            "start takes '%s' with at most %d prime%s: higher derivatives follow from the equations",
            what->name, what->order - 1, what->order == 2 ? "" : "s");
        what = NULL;
    }
    return parse_assigned(in, &name, what, WORD_START, &made->starts, &made->start_count);
}

static bool read_conserve(parser *in, const statement_word *word) {
    token name;
    const symbol *what;
    if (!scene_take_symbol(in, word, &name, &what)) {
        return false;
    }
    if (what != NULL && (what->kind != SYM_COORDINATE || name.primes > 0)) {
        diag_error(in->diags, name.at, NULL, "conserve takes coordinates, without primes");
    } else if (what != NULL) {
        in->draft->made->conserve[what->index] = true;
    }
    return true;
}

static bool is_number(const expr *tree) {
    while (tree->op == EXPR_NEG) {
        tree = tree->left;
    }
    return tree->op == EXPR_NUMBER;
}

/* If only `high` has a unit, as in -5 .. 5 [m], gives this unit to `low`. */
static const expr *with_unit(parser *in, const expr *low, const expr *high) {
    if (!is_number(low) || !is_number(high) || low->uses != 0 || (high->uses & USES_UNIT) == 0) {
        return low;
    }
    expr *made = expr_new(in, EXPR_NUMBER, low->at);
    made->number = expr_value(low, NULL) * in->number_unit.scale / in->number_unit.divisor;
    made->dim = in->number_unit.dim;
    made->dim.any = made->number == 0.0;
    made->uses = USES_UNIT;
    return made;
}

static bool has_range(parser *in, const token *name, const symbol *what) {
    const bool moves = symbol_moves(what);
    const scene *made = in->draft->made;
    if (!moves && what->kind != SYM_INPUT) {
        diag_error(in->diags, name->at, NULL,
                   "range takes coordinates, their rates and inputs, but '%s' is none of these",
                   what->name);
        return false;
    }
    if ((moves && what->order > 0 && name->primes >= what->order) || (!moves && name->primes > 0)) {
        diag_error(in->diags, name->at, NULL,
                   moves ? "the derivative of '%s' follows from the equations, so it has no range"
                         : "'%s' is an input: its rate has no range; leave out the prime",
                   what->name);
        return false;
    }
    for (int i = 0; i < made->range_count; i++) {
        if (made->ranges[i].symbol == what && made->ranges[i].primes == name->primes) {
            diag_error(in->diags, name->at, NULL,
                       "the range of '%s%.*s' was already given in line %d", what->name,
                       name->primes, "'''''''''", made->ranges[i].at.line);
            return false;
        }
    }
    return true;
}

static bool read_range(parser *in, const statement_word *word) {
    scene *made = in->draft->made;
    token name;
    const symbol *what;
    if (!scene_take_symbol(in, word, &name, &what)) {
        return false;
    }
    const bool usable = what != NULL && has_range(in, &name, what);
    const char *words = token_words(in, &name);
    if (!parser_expect_sign(in, '=', "after the name")) {
        return false;
    }
    const place low_at = in->token.at;
    const expr *low = parse_expression(in, CONTEXT_CONSTANT);
    if (low == NULL || !parser_is_sign(in, SIGN_TO)) {
        return low == NULL
                   ? false
                   : parser_fail(in, word->form, "'..' is missing in the range of %s", words);
    }
    parser_next(in);
    const place high_at = in->token.at;
    const expr *high = parse_expression(in, CONTEXT_CONSTANT);
    if (high == NULL) {
        return false;
    }
    if (!usable) {
        return true;
    }
    static const char *const nothing[] = {"", ""};
    in->around = nothing; /* the hint about a missing unit then omits "NAME = " */
    low = with_unit(in, low, high);
    if (check_value(in, low_at, low, what, &name) && check_value(in, high_at, high, what, &name)) {
        const range_statement one = {what, name.primes, low, high, name.at};
        made->ranges = arena_push(in->arena, made->ranges, &made->range_count, &one, sizeof one);
    }
    in->around = NULL;
    return true;
}

/* === the block and its statements ============================================================= */

static void choose_mechanism(parser *in, builder *chosen) {
    const mechanism *of = chosen->made;
    scene *made = in->draft->made;
    made->mechanism = of;
    made->with = arena_alloc(in->arena, (size_t)of->effect_count * sizeof *made->with);
    made->conserve = arena_alloc(in->arena, (size_t)of->coordinate_count * sizeof *made->conserve);
    in->builder = chosen;
    in->names = of->names;
}

static bool read_use(parser *in, const statement_word *word) {
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        return scene_fail_name(in, word);
    }
    const token name = in->token;
    parser_next(in);
    nearest search = nearest_start(name.text, name.length);
    for (int i = 0; i < in->builder_count; i++) {
        if (token_is(&name, in->builders[i]->made->name)) {
            choose_mechanism(in, in->builders[i]);
            return parser_end_statement(in, "the mechanism's name");
        }
        nearest_offer(&search, in->builders[i]->made->name);
    }
    diag_error(in->diags, name.at, parser_nearest(in, &search, NULL),
               "no mechanism %s in this file", token_words(in, &name));
    in->builder = NULL;
    return true;
}

/* Reads step EXPR or until EXPR, in seconds. */
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
    check_named(in, at, value, dim_of_quantity(QUANTITY_TIME), word->text, "is");
    *into = value;
    return parser_end_statement(in, "the expression");
}

static bool read_step(parser *in, const statement_word *word) {
    return parse_duration(in, word, &in->draft->step_at, &in->draft->made->step);
}

static bool read_until(parser *in, const statement_word *word) {
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
        diag_error(in->diags, in->token.at, NULL, "'use' must be the first statement of a scene");
    }
    if (!uses && in->builder == NULL) {
        into->has_content = true;
        diag_error(in->diags, into->made->at, "name the scene's mechanism: use NAME",
                   "scene '%s' belongs to no mechanism", into->made->name);
        return false;
    }
    into->has_content |= !uses;
    if (word != NULL && (word->rules & INTO_EFFECT) != 0) {
        return parser_fail(in,
                           "put the statement into an effect, and select that effect: with NAME",
                           "'%s' belongs in a mechanism or an effect", word->text);
    }
    if (word == NULL || (word->stands & IN_SCENE) == 0) {
        return statement_unknown(in, IN_SCENE);
    }
    statement_reader *const read = readers[word - word_row((word_id)0)];
    parser_next(in);
    bool good = read(in, word);
    while (good && (word->rules & LISTS) != 0 && parser_is_sign(in, ',')) {
        parser_next(in);
        parser_skip_newlines(in);
        good = read(in, word);
    }
    return good && ((word->rules & LISTS) == 0 || parser_end_statement(in, "the list"));
}

static bool parse_body(parser *in) {
    draft *into = in->draft;
    bool closed;
    while (parser_in_block(in, ENDS_SCENE, &closed)) {
        const bool had_mechanism = in->builder != NULL;
        if (!parse_scene_statement(in)) {
            parser_skip_statement(in);
        }
        if (in->builder == NULL && (had_mechanism || into->has_content)) {
            return false; /* unknown mechanism: no further checks */
        }
    }
    if (!closed) {
        diag_error(in->diags, into->made->at, NULL, "scene '%s' is not closed with '}'",
                   into->made->name);
        return false;
    }
    into->made->last_line = in->token.at.line;
    parser_next(in);
    return parser_end_statement(in, "the scene");
}

void read_noted_scene(parser *in, const pending_scene *pending) {
    draft *into = arena_alloc(in->arena, sizeof *into);
    into->made = arena_alloc(in->arena, sizeof *into->made);
    in->lexer = pending->from;
    in->token = pending->next;
    in->draft = into;
    in->parentheses = 0;
    in->nesting = 0;
    in->builder = NULL;
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
    parser_skip_newlines(in);
    if (!parser_expect_sign(in, '{', "after the scene's name")) {
        return;
    }
    if (pending->inside != NULL) {
        choose_mechanism(in, pending->inside);
    }
    in->scenes =
        arena_push(in->arena, in->scenes, &in->scene_count, &into->made, sizeof into->made);
    const bool good = parse_body(in);
    if (good && in->builder == NULL) {
        diag_error(in->diags, into->made->at, "name the scene's mechanism: use NAME",
                   "scene '%s' belongs to no mechanism", into->made->name);
    } else if (good) {
        scene_check_sets(in, into->made);
    }
}
