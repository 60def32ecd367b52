/* declare.c: the parser of coordinate, state, parameter, input, let and output. */
#include <math.h>

#include "host/lang/statements.h"

/* Returns the output of this name, or NULL (reported) if the name is unknown or not an output. */
static const symbol *find_output(parser *in, const token *name) {
    const mechanism *inside = in->builder->made;
    const named *found = names_find(in->names, name->text, name->length);
    const char *words = token_words(in, name);
    if (found != NULL && !found->is_placeholder) {
        if (found->symbol.kind == SYM_OUTPUT && name->primes == 0) {
            return &found->symbol;
        }
        diag_error(in->diags, name->at,
                   arena_words(in->arena, "declare an output: output %s_read = %s",
                               found->symbol.name, found->symbol.name),
                   "noise can be added only to an output, and %s is not one", words);
        return NULL;
    }
    const char *later = hint_declared_later(in, name);
    nearest search = nearest_start(name->text, name->length);
    for (int i = 0; i < inside->output_count; i++) {
        nearest_offer(&search, inside->outputs[i]->name);
    }
    diag_error(in->diags, name->at, later != NULL ? later : parser_nearest(in, &search, NULL),
               "unknown output %s", words);
    return NULL;
}

static bool parse_seed(parser *in, uint32_t *seed) {
    const double number = in->token.number;
    if (in->token.kind != TOKEN_NUMBER || !(number <= UINT32_MAX) ||
        number != number_floor(number)) {
        return parser_fail(in, word_row(WORD_NOISE)->form,
                           "a seed is a whole number from 0 to %u, not %s", UINT32_MAX,
                           token_words(in, &in->token));
    }
    *seed = (uint32_t)number;
    parser_next(in);
    return true;
}

static void add_noise(parser *in, noise *made) {
    mechanism *into = in->builder->made;
    for (int i = 0; i < into->noise_count; i++) {
        const noise *each = &into->noises[i];
        if (each->output != made->output) {
            continue;
        }
        made->record = each->record; /* all noises of one output share this symbol */
        if (always_meet(each->effect, made->effect)) {
            diag_error(in->diags, made->at, NULL, "noise on '%s' was already given in line %d",
                       made->output->name, each->at.line);
            break;
        }
    }
    if (made->record == NULL) {
        symbol *record = arena_alloc(in->arena, sizeof *record);
        *record = *made->output;
        record->kind = SYM_RECORD;
        made->record = record;
    }
    into->noises = arena_push(in->arena, into->noises, &into->noise_count, made, sizeof *made);
}

bool read_noise(parser *in, const statement_word *word) {
    noise made = {.seed = 1, .effect = in->effect, .at = in->statement_at};
    const token name = in->token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, word->form, "noise needs the name of an output, not %s",
                           token_words(in, &in->token));
    }
    made.output = find_output(in, &name);
    parser_next(in);
    if (!parser_expect_word(in, WORD_DEVIATION, WORD_NOISE)) {
        return false;
    }
    const place at = in->token.at;
    made.deviation = parse_expression(in, CONTEXT_CONSTANT);
    if (made.deviation == NULL) {
        return false;
    }
    if (made.output != NULL) {
        check_named(in, at, made.deviation, made.output->dim, token_words(in, &name), "is");
    }
    if (!parser_at_end_of_line(in) && !parser_is_sign(in, '}')) {
        if (!parser_expect_word(in, WORD_SEED, WORD_NOISE) || !parse_seed(in, &made.seed)) {
            return false;
        }
    }
    if (made.output != NULL) {
        add_noise(in, &made);
    }
    return parser_end_statement(in, "the noise");
}

/* === coordinate, state, parameter, input, let, output ========================================= */

/* Returns a new symbol of this name, or NULL (reported) if the name is not available. */
static named *claim_name(parser *in, const token *name) {
    function_id function = FN_SIN;
    const int length = (int)name->length;
    if (word_is_reserved(name->text, name->length)) {
        diag_error(
            in->diags, name->at,
            arena_words(in->arena, "choose another name, such as %.*s_1", length, name->text),
            "'%.*s' is a reserved word", length, name->text);
        return NULL;
    }
    if (function_find(name->text, name->length, &function)) {
        diag_error(in->diags, name->at, NULL, "'%.*s' is a function", length, name->text);
        return NULL;
    }
    if (name->primes > 0) {
        diag_error(in->diags, name->at,
                   "declare the name without a prime: each prime is a time derivative",
                   "a declared name carries no primes");
        return NULL;
    }
    named *found = names_find(in->names, name->text, name->length);
    if (found != NULL && !found->is_placeholder) {
        diag_error(in->diags, name->at, NULL, "'%s' was already declared in line %d",
                   found->symbol.name, found->symbol.at.line);
        return NULL;
    }
    if (found == NULL) {
        found = names_add(in->names, name->text, name->length);
    }
    found->is_placeholder = false;
    return found;
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
        parser_add_symbol(in, &into->coordinates, &into->coordinate_count, made);
        break;
    case SYM_PARAMETER:
        parser_add_symbol(in, &into->parameters, &into->parameter_count, made);
        break;
    case SYM_INPUT: parser_add_symbol(in, &into->inputs, &into->input_count, made); break;
    case SYM_LET: parser_add_symbol(in, &into->lets, &into->let_count, made); break;
    case SYM_OUTPUT: parser_add_symbol(in, &into->outputs, &into->output_count, made); break;
    case SYM_RECORD: break; /* not declared in the file: a noise makes this symbol */
    }
    return made;
}

static bool take_name(parser *in, const char *statement, token *name) {
    *name = in->token;
    if (in->token.kind != TOKEN_NAME) {
        return parser_fail(in, NULL, "%s needs a name, not %s", statement,
                           token_words(in, &in->token));
    }
    parser_next(in);
    return true;
}

static void check_not_time(parser *in, const token *name, bool recorded) {
    if (recorded && token_is(name, "time")) {
        diag_error(in->diags, name->at, NULL, "'time' is the first column of every record");
    }
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
    check_not_time(in, &name, true);
    symbol unused = {0};
    symbol *made = declare(in, &name, (symbol_kind)word->kind);
    made = made == NULL ? &unused : made;
    if (in->token.kind == TOKEN_UNIT) {
        made->is_angle = unit_is_angle(in->token.text, in->token.length);
        parse_unit(in, &made->declared, &made->unit);
        made->dim = made->declared.dim;
    }
    made->text = parser_title(in);
    return parser_end_statement(in, "the declaration");
}

/* Reads "= EXPR" after the name. The name stays declared if the expression fails. */
static bool parse_value(parser *in, symbol *made, const statement_word *word, expr_context context,
                        place *value_at) {
    named *entry = (named *)made;
    if (made != NULL) {
        entry->is_open = true;
        made->dim.unknown = true;
    }
    const expr *value = NULL;
    if (!parser_is_sign(in, '=')) {
        const bool is_input = word->kind == SYM_INPUT && made != NULL;
        parser_fail(in,
                    is_input ? arena_words(in->arena, "give the input a start value: input %s = 0",
                                           made->name)
                             : word->form,
                    "'=' is missing before %s", token_words(in, &in->token));
    } else {
        parser_next(in);
        *value_at = in->token.at;
        value = parse_expression(in, context);
    }
    if (made != NULL) {
        entry->is_open = false;
        made->value = value;
        if (value != NULL) {
            made->dim = value->dim;
            /* Only a let may be a zero that fits every dimension. */
            made->dim.any &= made->kind == SYM_LET;
        }
    }
    return value != NULL;
}

/* Reads an optional `rate NAME`. Input NAME is the time derivative of `made`. NAME may be declared later. */
static bool parse_rate(parser *in, symbol *made) {
    if (!parser_is_word(in, WORD_RATE) || (made != NULL && made->rate != NULL)) {
        return true;
    }
    parser_next(in);
    token name;
    if (in->effect >= 0) {
        return parser_fail(in, "declare both inputs in the mechanism, before the effect",
                           "an input of an effect cannot have a rate");
    }
    if (!take_name(in, "rate", &name)) {
        return false;
    }
    named *found = names_find(in->names, name.text, name.length);
    if (name.primes > 0 || word_is_reserved(name.text, name.length) ||
        (found != NULL && found->symbol.kind != SYM_INPUT && !found->is_placeholder)) {
        diag_error(in->diags, name.at, "input L rate v = 0.5 [m]; input v = 0 [m/s]",
                   "the rate of an input is another input");
        return true;
    }
    if (found == NULL) {
        found = names_add(in->names, name.text, name.length);
        found->is_placeholder = true; /* until the name is declared */
        found->symbol.kind = SYM_INPUT;
        found->symbol.at = name.at;
    }
    if (made != NULL) {
        made->rate = &found->symbol;
    }
    return true;
}

bool read_valued(parser *in, const statement_word *word) {
    const symbol_kind kind = (symbol_kind)word->kind;
    const expr_context context = kind == SYM_LET      ? CONTEXT_LET
                                 : kind == SYM_OUTPUT ? CONTEXT_OUTPUT
                                                      : CONTEXT_CONSTANT;
    token name;
    if (!take_name(in, word->text, &name)) {
        return false;
    }
    check_not_time(in, &name, kind == SYM_OUTPUT);
    symbol *made = declare(in, &name, kind);
    unit_scale written = {0};
    const char *unit_text = NULL;
    place value_at = name.at;
    if (in->token.kind == TOKEN_UNIT && kind != SYM_OUTPUT) {
        return parser_fail(in, "write the unit after the number: parameter m = 2 [kg]",
                           "a unit in the wrong place");
    }
    if (in->token.kind == TOKEN_UNIT) {
        parse_unit(in, &written, &unit_text);
    }
    if ((kind == SYM_INPUT && !parse_rate(in, made)) ||
        !parse_value(in, made, word, context, &value_at) ||
        (kind == SYM_INPUT && !parse_rate(in, made))) {
        return false;
    }
    const char *text = parser_title(in);
    if (made != NULL) {
        made->text = text;
        const expr *number = made->value->op == EXPR_NEG ? made->value->left : made->value;
        if (unit_text != NULL) {
            check_named(in, value_at, made->value, written.dim,
                        arena_words(in->arena, "output '%s'", made->name), "is");
            made->unit = unit_text;
            made->declared = written;
            made->dim = written.dim;
        } else if (kind != SYM_OUTPUT && number->op == EXPR_NUMBER &&
                   (number->uses & USES_UNIT) != 0) {
            made->unit = in->number_unit_text;
            made->declared = in->number_unit;
        }
    }
    return parser_end_statement(in, "the expression");
}
