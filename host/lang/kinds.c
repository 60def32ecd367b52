#include "kinds.h"

const char *symbol_kind_words(symbol_kind kind) {
#define WORDS_OF(id, words) [SYM_##id] = words,
    static const char *const words_of[] = {SYMBOL_KIND_ROWS(WORDS_OF)};
#undef WORDS_OF
    return words_of[kind];
}

const char *term_meaning(term_kind kind) {
#define MEANING(id, meaning, part, rule) [TERM_##id] = meaning,
    static const char *const meanings[] = {TERM_KIND_ROWS(MEANING)};
#undef MEANING
    return meanings[kind];
}

const char *term_part(term_kind kind) {
#define PART(id, meaning, part, rule) [TERM_##id] = part,
    static const char *const parts[] = {TERM_KIND_ROWS(PART)};
#undef PART
    return parts[kind];
}

const char *term_rule(term_kind kind) {
#define RULE(id, meaning, part, rule) [TERM_##id] = rule,
    static const char *const rules[] = {TERM_KIND_ROWS(RULE)};
#undef RULE
    return rules[kind];
}

const char *contact_called(contact_kind kind) {
#define CALLED(id, called, undefined) [CONTACT_##id] = called,
    static const char *const names[] = {CONTACT_KIND_ROWS(CALLED)};
#undef CALLED
    return names[kind];
}

const char *contact_undefined(contact_kind kind) {
#define UNDEFINED(id, called, undefined) [CONTACT_##id] = undefined,
    static const char *const parts[] = {CONTACT_KIND_ROWS(UNDEFINED)};
#undef UNDEFINED
    return parts[kind];
}
