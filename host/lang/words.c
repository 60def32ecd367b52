/* words.c: the words of the language, and names of kinds in messages. */
#include "host/lang/words.h"

#include <string.h>

/* Defines the function name(kind). It returns the part of the kind's row that the macro `row` selects. */
#define COLUMN(name, kinds, rows, row) \
    const char *name(kinds kind) { \
        static const char *const text[] = {rows(row)}; \
        return text[kind]; \
    }
#define SYMBOL_WORDS(id, words) [SYM_##id] = words,
#define TERM_MEANING(id, meaning, part, rule) [TERM_##id] = meaning,
#define TERM_PART(id, meaning, part, rule) [TERM_##id] = part,
#define TERM_RULE(id, meaning, part, rule) [TERM_##id] = rule,
#define CONTACT_CALLED(id, called, undefined) [CONTACT_##id] = called,
#define CONTACT_UNDEFINED(id, called, undefined) [CONTACT_##id] = undefined,
COLUMN(symbol_kind_words, symbol_kind, SYMBOL_KIND_ROWS, SYMBOL_WORDS)
COLUMN(term_meaning, term_kind, TERM_KIND_ROWS, TERM_MEANING)
COLUMN(term_part, term_kind, TERM_KIND_ROWS, TERM_PART)
COLUMN(term_rule, term_kind, TERM_KIND_ROWS, TERM_RULE)
COLUMN(contact_called, contact_kind, CONTACT_KIND_ROWS, CONTACT_CALLED)
COLUMN(contact_undefined, contact_kind, CONTACT_KIND_ROWS, CONTACT_UNDEFINED)

/* === words of other languages, and their counterparts here ==================================== */

#define CLOCK \
    "the language has no name for the time; in Q and in the condition of a hold use a coordinate as a clock (docs/language.md, \"What is given over time\")"
#define CHOICE "write max(a, b), min(a, b) or sign(x); for a change at a moment, write when or hold"
#define JUMP "for a step function write (1 + sign(x))/2; for a contact use stop, hold or when"
#define COUNT \
    "the language has no rounding; to set a coordinate back, use an event: when x crosses 1 [m] rising { set x = 0 [m] }"
#define PARAMETER "write: parameter m = 2 [kg]"
#define RATE "write a derivative in time as a prime: x', x''"
#define NOISE "add noise to an output: noise y deviation 0.01 [m] seed 7"
#define BLOW \
    "write an impact as a change of a rate: when x crosses 1 [m] rising { set x' = 2 [m/s] }"
#define TABLE "write a formula, or an input that firmware changes: input u = 0 [N]"

const char *energy_hint(const char *text, size_t length) {
    static const char *const rows[][2] = {
        {" t k K Ek Ekin kinetic ", "write the kinetic energy as T = ..."},
        {" v u U Ep Epot potential ", "write the potential energy as V = ..."},
        {" f D dissipation ", "write the dissipation function as F = ..."},
        {" L lagrangian Lagrangian ", "write the parts of L = T - V: T = ... and V = ..."}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (const char *at = rows[i][0]; at[1] != '\0'; at = strchr(at + 1, ' ')) {
            if (strncmp(at + 1, text, length) == 0 && at[1 + length] == ' ') {
                return rows[i][1];
            }
        }
    }
    return NULL;
}

const char *first_word_hint(const char *text, size_t length) {
    static const struct {
        const char *word;
        const char *hint;
    } rows[] = {
        {"t", CLOCK},
        {"time", CLOCK},
        {"given",
         "for a given motion, write the force that it causes: Q(x) = k*xe "
         "(docs/language.md, \"What is given over time\"); to hold a coordinate under a condition, write: hold x while x > 0 [m]"},
        {"every",
         "for events at intervals use a coordinate as a clock: when phi crosses 2*pi rising "
         "{ set phi = 0 [rad] }"},
        {"if", CHOICE},
        {"else", CHOICE},
        {"where", CHOICE},
        {"piecewise", CHOICE},
        {"?", CHOICE},
        {">", CHOICE},
        {"<", CHOICE},
        {">=", CHOICE},
        {"<=", CHOICE},
        {"==", CHOICE},
        {"&", "join two comparisons with 'and': x > a and x < b"},
        {"|", "join two comparisons with 'or': x < a or x > b; for the size of x, write abs(x)"},
        {"sgn", "write sign(x)"},
        {"pow", "write powers with ^: a^b"},
        {"ln", "write log(x), the natural logarithm"},
        {"log10", "write log(x)/log(10): log(x) is the natural logarithm"},
        {"const", PARAMETER},
        {"constant", PARAMETER},
        {"param", PARAMETER},
        {"parameters", PARAMETER},
        {"Piecewise", CHOICE},
        {"diff", RATE},
        {"derivative", RATE},
        {"Derivative", RATE},
        {"rand", NOISE},
        {"random", NOISE},
        {"dirac", BLOW},
        {"PI", "write pi"},
        {"Pi", "write pi"},
        {"e", "write exp(1)"},
        {"heaviside", JUMP},
        {"step", JUMP},
        {"floor", COUNT},
        {"ceil", COUNT},
        {"round", COUNT},
        {"mod", COUNT},
        {"table", TABLE},
        {"lookup", TABLE},
        {"interp", TABLE},
        {"constraint", "write: hold x - l*sin(a) while 1 > 0"},
        {"duration", "write: until 2 [s]"},
        {"for", "write: until 2 [s]"},
        {"tunable", "a value that may change during a run is an input: input k = 3 [N/m]"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (strlen(rows[i].word) == length && memcmp(rows[i].word, text, length) == 0) {
            return rows[i].hint;
        }
    }
    return NULL;
}

/* === the words of the language ================================================================ */

static const statement_word rows[] = {
#define WORD_ROW(id, text, stands, rules, reader, kind, form) \
    [WORD_##id] = {text, form, stands, rules, (int)(kind)},
    BODY_WORD_ROWS(WORD_ROW) SCENE_WORD_ROWS(WORD_ROW)
#undef WORD_ROW
#define WORD_ROW(id, text, rules) [WORD_##id] = {text, "", 0, rules, 0},
        INNER_WORD_ROWS(WORD_ROW)
#undef WORD_ROW
};
_Static_assert(sizeof rows / sizeof rows[0] == WORD_COUNT, "a row for each word");

const statement_word *word_row(word_id id) { return &rows[id]; }

bool word_is(word_id id, const char *text, size_t length) {
    /* the first letter excludes most words, which saves calls of strlen() */
    const char *word = rows[id].text;
    return length > 0 && word[0] == text[0] && strlen(word) == length &&
           memcmp(word, text, length) == 0;
}

int word_find(const char *text, size_t length) {
    for (int i = 0; i < STATEMENT_WORDS; i++) {
        if (word_is((word_id)i, text, length)) {
            return i;
        }
    }
    return WORD_COUNT;
}

bool word_is_reserved(const char *text, size_t length) {
    for (int i = 0; i < WORD_COUNT && length > 0; i++) {
        if (rows[i].text[0] == text[0] && (rows[i].rules & RESERVED) != 0 &&
            word_is((word_id)i, text, length)) {
            return true;
        }
    }
    return false;
}

const char *contact_word(contact_kind kind) {
#define WORD(id, called, undefined) [CONTACT_##id] = WORD_##id,
    static const word_id words[] = {CONTACT_KIND_ROWS(WORD)};
#undef WORD
    return word_row(words[kind])->text;
}
