/* noise_statement.c: `noise OUTPUT deviation EXPR [seed N]`. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "statements.h"

/* NULL: unknown, or no output (reported). */
static const symbol *find_output(parser *in, const token *name) {
    char words[80];
    char hint[120] = "";
    const mechanism *inside = in->builder->made;
    const named *found = names_find(in->builder->names, name->text, name->length);
    token_words(name, words, sizeof words);
    if (found != NULL && !found->is_placeholder) {
        if (found->symbol.kind == SYM_OUTPUT && name->primes == 0) {
            return &found->symbol;
        }
        snprintf(hint, sizeof hint, "declare one: output %.40s_read = %.40s", found->symbol.name,
                 found->symbol.name);
        diag_error(in->diags, name->at, hint, "noise goes onto an output, and %s is none", words);
        return NULL;
    }
    const int later = name_declared_later(name);
    nearest search = nearest_start(name->text, name->length);
    for (int i = 0; i < inside->output_count; i++) {
        nearest_offer(&search, inside->outputs[i]->name);
    }
    if (later > 0) {
        snprintf(hint, sizeof hint, "it is declared later, in line %d: move that line up", later);
    } else if (search.best != NULL) {
        snprintf(hint, sizeof hint, "did you mean '%s'?", search.best);
    }
    diag_error(in->diags, name->at, hint[0] == '\0' ? NULL : hint, "unknown output %s", words);
    return NULL;
}

static bool parse_seed(parser *in, uint32_t *seed) {
    const double number = in->token.number;
    char words[80];
    if (in->token.kind != TOKEN_NUMBER || !(number <= UINT32_MAX) ||
        number != number_floor(number)) {
        return parser_fail(in, word_row(WORD_NOISE)->form,
                           "a seed is a whole number from 0 to %u, not %s", UINT32_MAX,
                           token_words(&in->token, words, sizeof words));
    }
    *seed = (uint32_t)number;
    parser_next(in);
    return true;
}

/* The output as it is recorded; noises of several effects on one output share it. */
static const symbol *record_of(parser *in, const symbol *output) {
    const mechanism *inside = in->builder->made;
    for (int i = 0; i < inside->noise_count; i++) {
        if (inside->noises[i].output == output) {
            return inside->noises[i].record;
        }
    }
    symbol *record = arena_alloc(in->arena, sizeof *record);
    *record = *output;
    record->kind = SYM_RECORD;
    return record;
}

/* Both take part whenever one of them does. */
static bool always_meet(const noise *a, const noise *b) {
    return a->effect == b->effect || a->effect < 0 || b->effect < 0;
}

static void add_noise(parser *in, const noise *made) {
    mechanism *into = in->builder->made;
    for (int i = 0; i < into->noise_count; i++) {
        const noise *each = &into->noises[i];
        if (each->output == made->output && always_meet(each, made)) {
            diag_error(in->diags, made->at, NULL, "noise on '%s' was already given in line %d",
                       made->output->name, each->at.line);
            break;
        }
    }
    noise *longer = arena_room(in->arena, (noise *)into->noises, into->noise_count, sizeof *longer);
    longer[into->noise_count++] = *made;
    into->noises = longer;
}

bool read_noise(parser *in, const statement_word *word) {
    char words[80];
    noise made = {.seed = 1, .effect = in->effect, .at = in->statement_at};
    const token name = in->token;
    if (name.kind != TOKEN_NAME) {
        return parser_fail(in, word->form, "noise needs its output, not %s",
                           token_words(&in->token, words, sizeof words));
    }
    made.output = find_output(in, &name);
    made.record = made.output == NULL ? NULL : record_of(in, made.output);
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
        char rule[RULE_SIZE];
        token_words(&name, words, sizeof words);
        check_dimension(in, at, made.deviation, made.output->dim,
                        dimension_rule(rule, words, "is", made.output->dim));
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
