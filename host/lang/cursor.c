/* parser.c: tokens in hand, recovery after errors, and the file as a whole. */
#include "parser.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void parser_next(parser *in) {
    do {
        in->token = lexer_next(&in->lexer);
    } while (in->parentheses > 0 && in->token.kind == TOKEN_NEWLINE);
}

bool parser_is_sign(const parser *in, int sign) {
    return in->token.kind == TOKEN_SIGN && in->token.sign == sign;
}

bool token_is(const token *each, const char *word) {
    return each->kind == TOKEN_NAME && each->primes == 0 && strlen(word) == each->length &&
           memcmp(word, each->text, each->length) == 0;
}

bool parser_is_word(const parser *in, const char *word) { return token_is(&in->token, word); }

bool parser_at_end_of_line(const parser *in) {
    return in->token.kind == TOKEN_NEWLINE || in->token.kind == TOKEN_END ||
           parser_is_sign(in, ';');
}

const char *token_words(const token *each, char *buffer, size_t size) {
    switch (each->kind) {
    case TOKEN_END: snprintf(buffer, size, "the end of the text"); break;
    case TOKEN_NEWLINE: snprintf(buffer, size, "the end of the line"); break;
    case TOKEN_STRING: snprintf(buffer, size, "a text in quotes"); break;
    case TOKEN_UNIT: snprintf(buffer, size, "a unit"); break;
    case TOKEN_NAME:
    case TOKEN_NUMBER:
    case TOKEN_SIGN:
    case TOKEN_BAD:
        /* Single quotes around primes would be hard to read. */
        snprintf(buffer, size, each->primes > 0 ? "\"%.*s%.*s\"" : "'%.*s%.*s'",
                 (int)(each->length > 63 ? 63 : each->length), each->text, each->primes,
                 "'''''''''");
        break;
    }
    return buffer;
}

bool parser_fail(parser *in, const char *hint, const char *format, ...) {
    if (in->token.kind != TOKEN_BAD) {
        char message[300];
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(message, sizeof message, format, arguments);
        va_end(arguments);
        diag_error(in->diags, in->token.at, hint, "%s", message);
    }
    return false;
}

bool parser_expect_sign(parser *in, int sign, const char *where) {
    if (!parser_is_sign(in, sign)) {
        char words[80];
        return parser_fail(in, NULL, "'%c' is missing %s, before %s", sign, where,
                           token_words(&in->token, words, sizeof words));
    }
    parser_next(in);
    return true;
}

bool parser_expect_word(parser *in, const char *word, const char *form) {
    if (parser_is_word(in, word)) {
        parser_next(in);
        return true;
    }
    char words[80];
    char hint[120];
    snprintf(hint, sizeof hint, "%s", form);
    if (in->token.kind == TOKEN_NAME) {
        nearest search = nearest_start(in->token.text, in->token.length);
        nearest_offer(&search, word);
        if (search.best != NULL) {
            snprintf(hint, sizeof hint, "did you mean '%s'?", word);
        }
    }
    return parser_fail(in, hint, "'%s' is missing before %s", word,
                       token_words(&in->token, words, sizeof words));
}

void parser_skip_lines(parser *in) {
    while (in->token.kind == TOKEN_NEWLINE || parser_is_sign(in, ';')) {
        parser_next(in);
    }
}

static const char *const top_words[] = {"mechanism", "scene", "effect"};
static const char *const statement_words[] = {
    "mechanism", "coordinate", "state", "parameter", "input",  "let",    "T",
    "V",         "F",          "Q",     "equation",  "output", "effect", "scene",
    "stop",      "friction",   "hold",  "when",      "noise"};
enum {
    TOP_WORD_COUNT = sizeof top_words / sizeof top_words[0],
    STATEMENT_WORD_COUNT = sizeof statement_words / sizeof statement_words[0]
};

static bool is_one_of(const token *each, const char *const *words, int count) {
    for (int i = 0; i < count; i++) {
        if (token_is(each, words[i])) {
            return true;
        }
    }
    return false;
}

void parser_skip_statement(parser *in) {
    int braces = 0;
    in->parentheses = 0;
    in->nesting = 0;
    while (in->token.kind != TOKEN_END) {
        if (braces == 0 && (parser_at_end_of_line(in) || parser_is_sign(in, '}'))) {
            return;
        }
        /* After an unclosed parenthesis or brace the next statement is the way back. */
        if (in->token.at.offset != in->statement && in->token.starts_line &&
            (braces > 0 ? is_one_of(&in->token, top_words, TOP_WORD_COUNT)
                        : is_one_of(&in->token, statement_words, STATEMENT_WORD_COUNT))) {
            return;
        }
        if (parser_is_sign(in, '{')) {
            braces++;
        } else if (parser_is_sign(in, '}')) {
            braces--;
        }
        parser_next(in);
    }
}

bool parser_end_statement(parser *in, const char *what) {
    if (parser_at_end_of_line(in) || parser_is_sign(in, '}')) {
        return true;
    }
    char words[80];
    token_words(&in->token, words, sizeof words);
    switch (in->token.kind) {
    case TOKEN_UNIT:
        return parser_fail(in, "a unit belongs to a number: 2 [kg]", "a unit without a number");
    case TOKEN_NAME:
    case TOKEN_NUMBER:
        return parser_fail(in, "products are written with *, units in brackets: 2*m, 2 [m]",
                           "an operator is missing before %s", words);
    case TOKEN_SIGN:
        if (in->token.sign == ')') {
            return parser_fail(in, NULL, "')' without '('");
        }
        return parser_fail(in, "a statement ends with its line", "unexpected %s after %s", words,
                           what);
    case TOKEN_STRING:
    case TOKEN_BAD:
    case TOKEN_END:
    case TOKEN_NEWLINE: break;
    }
    return parser_fail(in, "a statement ends with its line", "unexpected %s after %s", words, what);
}

char *parser_copy_text(parser *in, const token *each) {
    return arena_copy(in->arena, each->text, each->length);
}

const char *parser_title(parser *in) {
    if (in->token.kind != TOKEN_STRING) {
        return "";
    }
    const char *title = parser_copy_text(in, &in->token);
    parser_next(in);
    return title;
}

bool statement_unknown(parser *in, const char *const *words, int count) {
    char name[80];
    char hint[120] = "";
    token_words(&in->token, name, sizeof name);
    if (in->token.kind != TOKEN_NAME) {
        const bool goes_on = parser_is_sign(in, '+') || parser_is_sign(in, '-') ||
                             parser_is_sign(in, '*') || parser_is_sign(in, '/');
        return parser_fail(
            in, goes_on ? "a line goes on only while a parenthesis or brace is open" : NULL,
            "a statement cannot begin with %s", name);
    }
    const token word = in->token;
    parser_next(in);
    nearest search = nearest_start(word.text, word.length);
    for (int i = 0; i < count; i++) {
        nearest_offer(&search, words[i]);
    }
    if (search.best != NULL && !parser_is_sign(in, '=')) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
    } else if (parser_is_sign(in, '=') && in->all_effects) {
        snprintf(hint, sizeof hint, "begin with set or start, or end the line before with a comma");
    } else if (parser_is_sign(in, '=')) {
        const int length = word.length > 30 ? 30 : (int)word.length;
        snprintf(hint, sizeof hint, "declare it: parameter %.*s = ..., or let %.*s = ...", length,
                 word.text, length, word.text);
    }
    diag_error(in->diags, word.at, hint[0] == '\0' ? NULL : hint, "unknown statement %s", name);
    return false;
}

/* --- the file ---------------------------------------------------------------------------------- */

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

static bool parse_mechanism(parser *in) {
    const place word_at = in->token.at;
    parser_next(in);
    builder *made = begin_mechanism(in, word_at);
    if (in->token.kind != TOKEN_NAME || in->token.primes > 0) {
        made->nameless = true;
        return parser_fail(in, "mechanism pendulum \"A pendulum\"", "a mechanism needs a name");
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
static bool note_scene(parser *in) {
    if (in->pending_count == SCENES_MAX) {
        in->lexer.stopped = true;
        return parser_fail(in, NULL, "more than %d scenes in one file", SCENES_MAX);
    }
    in->pending = arena_room(in->arena, in->pending, in->pending_count, sizeof *in->pending);
    in->pending[in->pending_count++] = (pending_scene){in->lexer, in->token.at, in->builder};
    parser_next(in);
    while (in->token.kind == TOKEN_NAME || in->token.kind == TOKEN_STRING ||
           in->token.kind == TOKEN_NEWLINE) {
        if (in->token.starts_line && is_one_of(&in->token, statement_words, STATEMENT_WORD_COUNT)) {
            return true;
        }
        parser_next(in);
    }
    parser_skip_statement(in);
    return true;
}

static bool parse_statement(parser *in) {
    in->statement = in->token.at.offset;
    if (parser_is_word(in, "mechanism")) {
        return parse_mechanism(in);
    }
    if (parser_is_word(in, "scene")) {
        return note_scene(in);
    }
    if (in->builder == NULL && is_one_of(&in->token, statement_words, STATEMENT_WORD_COUNT)) {
        parser_fail(in, "a file begins with: mechanism NAME \"title\"",
                    "this statement belongs to no mechanism");
        begin_mechanism(in, in->token.at)->nameless = true;
    }
    if (in->builder == NULL) {
        return statement_unknown(in, statement_words, STATEMENT_WORD_COUNT);
    }
    if (parser_is_word(in, "effect")) {
        return parse_effect(in);
    }
    bool known = false;
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
    return known ? good : statement_unknown(in, statement_words, STATEMENT_WORD_COUNT);
}

static void parse_file(parser *in) {
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
        if (!parse_statement(in)) {
            if (in->builder != NULL) {
                in->builder->broken = true;
            }
            parser_skip_statement(in);
        }
    }
}

static void parse_all(parser *in, place start) {
    parse_file(in);
    if (in->builder_count == 0 && in->pending_count == 0 && diags_count(in->diags) == 0) {
        diag_error(in->diags, start, "a file begins with: mechanism NAME \"title\"",
                   "no mechanism here");
    }
    for (int i = 0; i < in->builder_count; i++) {
        finish_mechanism(in, in->builders[i]);
    }
    for (int i = 0; i < in->pending_count && diags_count(in->diags) <= DIAG_MAX; i++) {
        parse_scene(in, &in->pending[i]);
    }
}

model *model_parse(const char *file, const char *text, size_t length, diags *all) {
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
    model *made = arena_alloc(memory, sizeof *made);
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

void model_free(model *done) {
    if (done != NULL) {
        arena_free(done->arena);
    }
}
