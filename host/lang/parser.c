/* parser.c: the parser's state: the symbols of a mechanism, and the current token. */
#include "host/lang/parser.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "host/base/hashing.h"

struct names {
    struct arena *arena;
    named **slots;
    size_t slot_count; /* a power of two */
    named **entries;   /* in the order of declaration */
    int count;
};

names *names_new(struct arena *arena) {
    names *made = arena_alloc(arena, sizeof *made);
    made->arena = arena;
    made->slot_count = 64;
    made->slots = arena_alloc(arena, made->slot_count * sizeof *made->slots);
    return made;
}

static size_t slot_of(const names *all, const char *text, size_t length) {
    const uint32_t hash = hash_text(text, length);
    return (hash ^ (hash >> 15)) & (all->slot_count - 1);
}

named *names_find(const names *all, const char *text, size_t length) {
    named *each = all == NULL ? NULL : all->slots[slot_of(all, text, length)];
    while (each != NULL &&
           (strncmp(each->symbol.name, text, length) != 0 || each->symbol.name[length] != '\0')) {
        each = each->next;
    }
    return each;
}

static void link_in(names *all, named *entry) {
    const size_t slot = slot_of(all, entry->symbol.name, strlen(entry->symbol.name));
    entry->next = all->slots[slot];
    all->slots[slot] = entry;
}

named *names_add(names *all, const char *text, size_t length) {
    if ((size_t)all->count >= all->slot_count) {
        all->slot_count *= 4;
        all->slots = arena_alloc(all->arena, all->slot_count * sizeof *all->slots);
        for (int i = 0; i < all->count; i++) {
            link_in(all, all->entries[i]);
        }
    }
    named *entry = arena_alloc(all->arena, sizeof *entry);
    entry->symbol.name = arena_copy(all->arena, text, length);
    entry->symbol.text = "";
    entry->symbol.unit = "";
    entry->symbol.effect = -1;
    all->entries = arena_push(all->arena, all->entries, &all->count, &entry, sizeof entry);
    link_in(all, entry);
    return entry;
}

void names_add_placeholder(names *all, const token *name) {
    named *made = names_add(all, name->text, name->length);
    made->is_placeholder = true;
    made->symbol.kind = SYM_LET;
    made->symbol.dim.unknown = true;
}

void names_offer(const names *all, int effect_index, nearest *search) {
    for (int i = 0; i < all->count; i++) {
        const named *each = all->entries[i];
        const bool visible =
            effect_index == -2 || each->symbol.effect == -1 || each->symbol.effect == effect_index;
        if (visible && !each->is_placeholder) {
            nearest_offer(search, each->symbol.name);
        }
    }
}

/* === access to tokens, and recovery after errors ============================================== */

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

bool token_is_word(const token *each, word_id word) {
    return each->kind == TOKEN_NAME && each->primes == 0 && word_is(word, each->text, each->length);
}

const statement_word *token_statement(const token *each) {
    const int found = each->kind == TOKEN_NAME && each->primes == 0
                          ? word_find(each->text, each->length)
                          : WORD_COUNT;
    return found == WORD_COUNT ? NULL : word_row((word_id)found);
}

bool parser_is_word(const parser *in, word_id word) { return token_is_word(&in->token, word); }

/* Does the token show that the '}' of a block is missing? `rule` is ENDS_EFFECT, ENDS_SCENE or ENDS_WHEN. */
static bool parser_leaves(const parser *in, unsigned rule) {
    const statement_word *word = in->token.starts_line ? token_statement(&in->token) : NULL;
    return word != NULL && (word->rules & rule) != 0;
}

bool parser_at_end_of_line(const parser *in) {
    return in->token.kind == TOKEN_NEWLINE || in->token.kind == TOKEN_END ||
           parser_is_sign(in, ';');
}

const char *token_words(const parser *in, const token *each) {
    switch (each->kind) {
    case TOKEN_END: return "the end of the text";
    case TOKEN_NEWLINE: return "the end of the line";
    case TOKEN_STRING: return "a text in quotes";
    case TOKEN_UNIT: return "a unit";
    case TOKEN_NAME:
    case TOKEN_NUMBER:
    case TOKEN_SIGN:
    case TOKEN_BAD: break;
    }
    /* Single quotes around primes would be hard to read. */
    return arena_words(in->arena, each->primes > 0 ? "\"%.*s%.*s\"" : "'%.*s%.*s'",
                       (int)(each->length > 63 ? 63 : each->length), each->text, each->primes,
                       "''''''''''");
}

const char *parser_nearest(const parser *in, const nearest *search, const char *otherwise) {
    return search->best != NULL ? arena_words(in->arena, "did you mean '%s'?", search->best)
                                : otherwise;
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
        return parser_fail(in, NULL, "'%c' is missing %s, before %s", sign, where,
                           token_words(in, &in->token));
    }
    parser_next(in);
    return true;
}

bool parser_expect_word(parser *in, word_id word, word_id statement) {
    if (parser_is_word(in, word)) {
        parser_next(in);
        return true;
    }
    const char *wanted = word_row(word)->text;
    nearest search = nearest_start(in->token.text, in->token.length);
    if (in->token.kind == TOKEN_NAME) {
        nearest_offer(&search, wanted);
    }
    const char *hint = parser_nearest(in, &search, word_row(statement)->form);
    return parser_fail(in, hint, "'%s' is missing before %s", wanted, token_words(in, &in->token));
}

void parser_skip_lines(parser *in) {
    while (in->token.kind == TOKEN_NEWLINE || parser_is_sign(in, ';')) {
        parser_next(in);
    }
}

void parser_skip_newlines(parser *in) {
    while (in->token.kind == TOKEN_NEWLINE) {
        parser_next(in);
    }
}

bool parser_in_block(parser *in, unsigned rule, bool *closed) {
    parser_skip_lines(in);
    *closed = parser_is_sign(in, '}');
    return !*closed && in->token.kind != TOKEN_END && !parser_leaves(in, rule);
}

bool parser_is_body_word(const parser *in) {
    const statement_word *word = token_statement(&in->token);
    return word != NULL && (word->stands & IN_BODY) != 0;
}

void parser_skip_statement(parser *in) {
    int braces = 0;
    in->parentheses = 0;
    in->nesting = 0;
    while (in->token.kind != TOKEN_END) {
        if (braces == 0 && (parser_at_end_of_line(in) || parser_is_sign(in, '}'))) {
            return;
        }
        /* After an unclosed parenthesis or brace, resume at the next statement. */
        if (in->token.at.offset != in->statement_at.offset && in->token.starts_line &&
            (braces > 0 ? parser_leaves(in, ENDS_EFFECT) : parser_is_body_word(in))) {
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

/* A comma between two digits: the decimal comma of "2,5". */
static bool is_decimal_comma(const token *sign) {
    return sign->sign == ',' && sign->at.offset > 0 && isdigit((unsigned char)sign->text[-1]) &&
           isdigit((unsigned char)sign->text[1]);
}

const char *parser_operator_hint(const parser *in) {
    const token *next = &in->token;
    const char *line = next->text - next->at.offset; /* beginning of the text */
    const char *end = next->text;                    /* end of the operand before the token */
    while (end > line && (end[-1] == ' ' || end[-1] == '\t')) {
        end--;
    }
    const char *begin = end;
    while (begin > line &&
           (isalnum((unsigned char)begin[-1]) || strchr("_.'", begin[-1]) != NULL)) {
        begin--;
    }
    const bool opens = parser_is_sign(in, '(');
    const char *name = opens ? next->text + 1 : next->text;
    const size_t length = opens ? strcspn(name, ")\n") : next->length;
    const size_t rest = opens ? length + 2 : length + (size_t)next->primes;
    const int before = (int)(end - begin);
    const bool whole = !opens || (name[length] == ')' && memchr(name, '(', length) == NULL);
    if (before == 0 || !whole) {
        return "write products with * and units in brackets: 2*m, 2 [m]";
    }
    size_t unit = length; /* length of the longest prefix that may be a unit, such as kg/s */
    while (!opens && (isalnum((unsigned char)name[unit]) || strchr("*/^", name[unit]) != NULL) &&
           name[unit] != '\0') {
        unit++;
    }
    unit_scale scale;
    unit_error unsaid;
    const char *as_unit = NULL;
    if (isdigit((unsigned char)*begin) && (unit_parse(name, unit, &scale, &unsaid) ||
                                           unit_parse(name, unit = length, &scale, &unsaid))) {
        as_unit = arena_words(in->arena, "%.*s [%.*s]", before, begin, (int)unit, name);
        if (names_find(in->names, name, length) == NULL) {
            return arena_words(in->arena, "write %s", as_unit);
        }
    }
    return arena_words(in->arena, "write %.*s*%.*s%s%s", before, begin, (int)rest, next->text,
                       as_unit != NULL ? ", or with a unit " : "", as_unit != NULL ? as_unit : "");
}

bool parser_end_statement(parser *in, const char *what) {
    if (parser_at_end_of_line(in) || parser_is_sign(in, '}')) {
        return true;
    }
    const char *words = token_words(in, &in->token);
    const char *first = first_word_hint(in->token.text, in->token.length);
    const char *hint = "begin a new line after the statement";
    switch (in->token.kind) {
    case TOKEN_UNIT:
        return parser_fail(in, "write a number before the unit: 2 [kg]", "a unit without a number");
    case TOKEN_NAME:
    case TOKEN_NUMBER:
        return parser_fail(in, first != NULL ? first : parser_operator_hint(in),
                           "an operator is missing before %s", words);
    case TOKEN_SIGN:
        if (in->token.sign == ')') {
            return parser_fail(in, NULL, "')' without '('");
        }
        hint = is_decimal_comma(&in->token) ? "write a decimal point: 2.5"
               : first != NULL              ? first
               : in->token.sign == '('      ? parser_operator_hint(in)
                                            : hint;
        break;
    case TOKEN_STRING:
    case TOKEN_BAD:
    case TOKEN_END:
    case TOKEN_NEWLINE: break;
    }
    return parser_fail(in, hint, "%s is unexpected after %s", words, what);
}

void parser_add_symbol(parser *in, const symbol ***list, int *count, symbol *made) {
    made->index = *count;
    *list = arena_push(in->arena, *list, count, &made, sizeof made);
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

bool statement_unknown(parser *in, unsigned where) {
    const char *hint = NULL;
    const char *name = token_words(in, &in->token);
    if (in->token.kind != TOKEN_NAME) {
        const bool goes_on = parser_is_sign(in, '+') || parser_is_sign(in, '-') ||
                             parser_is_sign(in, '*') || parser_is_sign(in, '/');
        return parser_fail(
            in, goes_on ? "to continue on the next line, keep a parenthesis or brace open" : NULL,
            "a statement cannot begin with %s", name);
    }
    const token word = in->token;
    parser_next(in);
    if (in->builder != NULL && !in->all_effects) {
        /* The unknown statement may declare this name, so later uses are not reported as unknown. */
        const token *declared = in->token.kind == TOKEN_NAME ? &in->token : &word;
        const bool fresh = !word_is_reserved(declared->text, declared->length) &&
                           names_find(in->names, declared->text, declared->length) == NULL;
        if (fresh && (declared != &word || parser_is_sign(in, '='))) {
            names_add_placeholder(in->names, declared);
        }
    }
    const statement_word *elsewhere = token_statement(&word);
    if (elsewhere != NULL && elsewhere->stands == IN_SCENE && !parser_is_sign(in, '=')) {
        hint = arena_words(in->arena, "in a scene: %s", elsewhere->form);
        diag_error(in->diags, word.at, hint, "'%s' belongs in a scene", elsewhere->text);
        return false;
    }
    nearest search = nearest_start(word.text, word.length);
    for (int i = 0; i < STATEMENT_WORDS; i++) {
        const statement_word *each = word_row((word_id)i);
        if ((each->stands & where) != 0) {
            nearest_offer(&search, each->text);
        }
    }
    const char *first = first_word_hint(word.text, word.length);
    const bool sums = parser_is_sign(in, SIGN_PLUS_ASSIGN);
    const char *energy =
        sums || parser_is_sign(in, '=') ? energy_hint(word.text, word.length) : NULL;
    if (energy != NULL && sums) {
        hint = energy;
    } else if (first != NULL && !parser_is_sign(in, '=')) {
        hint = first;
    } else if (search.best != NULL && !parser_is_sign(in, '=')) {
        hint = parser_nearest(in, &search, NULL);
    } else if (parser_is_sign(in, '=') && in->all_effects) {
        hint = "begin this line with 'set' or 'start', or end the previous line with a comma";
    } else if (parser_is_sign(in, '=')) {
        const int length = word.length > 30 ? 30 : (int)word.length;
        hint = arena_words(in->arena, "%s%sdeclare it: parameter %.*s = ..., or let %.*s = ...",
                           energy != NULL ? energy : "", energy != NULL ? "; or " : "", length,
                           word.text, length, word.text);
    }
    diag_error(in->diags, word.at, hint, "unknown statement %s", name);
    return false;
}
