/* declare.c: coordinate, state, parameter, input, let, output. */
#include <stdio.h>
#include <string.h>

#include "statements.h"

/* A fresh symbol under this name, or NULL when it cannot have it (reported). */
static named *claim_name(parser *in, const token *name) {
    function_id function = FN_SIN;
    const int length = (int)name->length;
    if (word_is_reserved(name->text, name->length)) {
        char hint[80];
        snprintf(hint, sizeof hint, "take another name, such as %.*s_1", length > 30 ? 30 : length,
                 name->text);
        diag_error(in->diags, name->at, hint, "'%.*s' is a reserved word", length, name->text);
        return NULL;
    }
    if (function_find(name->text, name->length, &function)) {
        diag_error(in->diags, name->at, NULL, "'%.*s' is a function", length, name->text);
        return NULL;
    }
    if (name->primes > 0) {
        diag_error(in->diags, name->at, "a prime is a time derivative: it comes with the name",
                   "a declared name carries no primes");
        return NULL;
    }
    named *found = names_find(in->builder->names, name->text, name->length);
    if (found != NULL && !found->is_placeholder) {
        diag_error(in->diags, name->at, NULL, "'%s' was already declared in line %d",
                   found->symbol.name, found->symbol.at.line);
        return NULL;
    }
    if (found == NULL) {
        found = names_add(in->builder->names, name->text, name->length);
    }
    found->is_placeholder = false;
    return found;
}

static void append(parser *in, const symbol ***list, int *count, symbol *made) {
    const symbol **longer = arena_room(in->arena, *list, *count, sizeof *longer);
    made->index = *count;
    longer[(*count)++] = made;
    *list = longer;
}

static symbol *declare(parser *in, const token *name, symbol_kind kind) {
    named *entry = claim_name(in, name);
    if (entry == NULL) {
        return NULL;
    }
    symbol *made = &entry->symbol;
    mechanism *into = in->builder->made;
    made->kind = kind;
    made->dim = dim_none();
    made->at = name->at;
    made->effect = in->effect;
    switch (kind) {
    case SYM_COORDINATE:
    case SYM_STATE:
        made->order = kind == SYM_COORDINATE ? 2 : 0;
        append(in, &into->coordinates, &into->coordinate_count, made);
        break;
    case SYM_PARAMETER: append(in, &into->parameters, &into->parameter_count, made); break;
    case SYM_INPUT: append(in, &into->inputs, &into->input_count, made); break;
    case SYM_LET: append(in, &into->lets, &into->let_count, made); break;
    case SYM_OUTPUT: append(in, &into->outputs, &into->output_count, made); break;
    case SYM_RECORD: break; /* never declared: noise makes it */
    }
    return made;
}

/* The name after the statement's word. */
static bool take_name(parser *in, const char *statement, token *name) {
    char words[80];
    *name = in->token;
    if (in->token.kind != TOKEN_NAME) {
        return parser_fail(in, NULL, "%s needs a name, not %s", statement,
                           token_words(&in->token, words, sizeof words));
    }
    parser_next(in);
    return true;
}

bool read_unknown(parser *in, const statement_word *word) {
    token name;
    if (!take_name(in, word->text, &name)) {
        return false;
    }
    if (in->builder->made->coordinate_count == COORDINATES_MAX) {
        diag_error(in->diags, name.at, NULL, "more than %d coordinates in one mechanism",
                   COORDINATES_MAX);
        in->lexer.stopped = true;
        return false;
    }
    if (token_is(&name, "time")) {
        diag_error(in->diags, name.at, NULL, "'time' is the first column of every record");
    }
    symbol *made = declare(in, &name, (symbol_kind)word->kind);
    symbol unused = {0};
    if (made == NULL) {
        made = &unused;
    }
    if (in->token.kind == TOKEN_UNIT) {
        unit_scale written;
        made->is_angle = unit_is_angle(in->token.text, in->token.length);
        parse_unit(in, &written, &made->unit);
        made->declared = written;
        made->dim = written.dim;
    }
    made->text = parser_title(in);
    return parser_end_statement(in, "the declaration");
}

/* = EXPR, after the name; declares it even when the expression fails. */
static bool parse_value(parser *in, symbol *made, const statement_word *word, expr_context context,
                        place *value_at) {
    named *entry = made == NULL ? NULL : (named *)made;
    if (entry != NULL) {
        entry->is_open = true;
        made->dim.unknown = true; /* until its expression is read */
    }
    const expr *value = NULL;
    if (!parser_is_sign(in, '=')) {
        char words[80];
        const bool is_input = word->kind == SYM_INPUT && made != NULL;
        char hint[NAME_LENGTH_MAX + 80];
        snprintf(hint, sizeof hint, "an input has a value at the start: input %s = 0",
                 is_input ? made->name : "");
        parser_fail(in, is_input ? hint : word->form, "'=' is missing before %s",
                    token_words(&in->token, words, sizeof words));
    } else {
        parser_next(in);
        *value_at = in->token.at;
        value = parse_expression(in, context);
    }
    if (entry != NULL) {
        entry->is_open = false;
        made->value = value;
        if (value != NULL) {
            made->dim = value->dim;
            made->dim.any &= made->kind == SYM_LET; /* a zero with a name of its own is a number */
        }
    }
    return value != NULL;
}

/* `rate NAME`, behind an input's name or its value: the input that is its time derivative, which may come later. */
static bool parse_rate(parser *in, symbol *made) {
    if (!parser_is_word(in, WORD_RATE) || (made != NULL && made->rate != NULL)) {
        return true;
    }
    parser_next(in);
    token name;
    if (in->effect >= 0) {
        return parser_fail(in, "declare both inputs in the mechanism, before the effect",
                           "an input of an effect takes no rate");
    }
    if (!take_name(in, "rate", &name)) {
        return false;
    }
    named *found = names_find(in->builder->names, name.text, name.length);
    if (name.primes > 0 || word_is_reserved(name.text, name.length) ||
        (found != NULL && found->symbol.kind != SYM_INPUT && !found->is_placeholder)) {
        diag_error(in->diags, name.at, "input L rate v = 0.5 [m]; input v = 0 [m/s]",
                   "the rate of an input is another input");
        return true;
    }
    if (found == NULL) {
        found = names_add(in->builder->names, name.text, name.length);
        found->is_placeholder = true; /* until it is declared */
        found->symbol.kind = SYM_INPUT;
        found->symbol.at = name.at;
    }
    if (made != NULL) {
        made->rate = &found->symbol;
    }
    return true;
}

bool read_constant(parser *in, const statement_word *word) {
    const symbol_kind kind = (symbol_kind)word->kind;
    token name;
    if (!take_name(in, word->text, &name)) {
        return false;
    }
    symbol *made = declare(in, &name, kind);
    if (in->token.kind == TOKEN_UNIT) {
        return parser_fail(in, "the unit belongs to the number: parameter m = 2 [kg]",
                           "a unit in the wrong place");
    }
    place value_at;
    const bool is_input = kind == SYM_INPUT;
    if (is_input && !parse_rate(in, made)) {
        return false;
    }
    if (!parse_value(in, made, word, kind == SYM_LET ? CONTEXT_LET : CONTEXT_CONSTANT, &value_at)) {
        return false;
    }
    if (is_input && !parse_rate(in, made)) {
        return false;
    }
    const char *text = parser_title(in);
    if (made != NULL) {
        made->text = text;
        const expr *number = made->value->op == EXPR_NEG ? made->value->left : made->value;
        if (number->op == EXPR_NUMBER && (number->uses & USES_UNIT) != 0) {
            made->unit = in->number_unit_text;
            made->declared = in->number_unit;
        }
    }
    return parser_end_statement(in, "the expression");
}

bool read_output(parser *in, const statement_word *word) {
    token name;
    if (!take_name(in, word->text, &name)) {
        return false;
    }
    if (token_is(&name, "time")) {
        diag_error(in->diags, name.at, NULL, "'time' is the first column of every record");
    }
    symbol *made = declare(in, &name, SYM_OUTPUT);
    unit_scale written = {1.0, 1.0, dim_none(), enclosure_of(1.0)};
    const char *unit_text = "";
    const bool has_unit = in->token.kind == TOKEN_UNIT;
    if (has_unit) {
        parse_unit(in, &written, &unit_text);
    }
    place value_at;
    if (!parse_value(in, made, word, CONTEXT_OUTPUT, &value_at)) {
        return false;
    }
    const char *text = parser_title(in);
    if (made != NULL) {
        made->text = text;
        made->unit = unit_text;
        if (has_unit) {
            made->declared = written;
            char rule[RULE_SIZE];
            char what[NAME_LENGTH_MAX + 16];
            snprintf(what, sizeof what, "output '%s'", made->name);
            dimension_rule(rule, what, "is", written.dim);
            check_dimension(in, value_at, made->value, written.dim, rule);
            made->dim = written.dim;
        }
    }
    return parser_end_statement(in, "the expression");
}
