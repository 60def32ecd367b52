/* kinds.h: the kinds of symbols, terms and contacts, and their names in messages. */
#ifndef LANG_KINDS_H
#define LANG_KINDS_H

/* Symbols: the kind, and its name in messages. */
#define SYMBOL_KIND_ROWS(X) \
    X(COORDINATE, "a coordinate") /* generalized coordinate: may carry primes */ \
    X(STATE, "a state")           /* unknown of a system given by equations: may carry primes */ \
    X(PARAMETER, "a parameter")   /* constant of a run; value from an expression of constants */ \
    X(INPUT, "an input")   /* may change while running; value from an expression of constants */ \
    X(LET, "a let")        /* shorthand for its expression */ \
    X(OUTPUT, "an output") /* computed for records; may be used by later outputs */ \
    X(RECORD, "an output") /* the recorded output, noise included: in measures only */

#define SYMBOL_KIND(id, words) SYM_##id,
typedef enum symbol_kind { SYMBOL_KIND_ROWS(SYMBOL_KIND) } symbol_kind;
#undef SYMBOL_KIND

const char *symbol_kind_words(symbol_kind kind);

/* Terms: the kind, its name, the quantity that is undefined if its value is not finite, and the rule of its dimension.
 * Q's rule follows from its coordinate, an equation's from its sides: "" here. */
#define TERM_KIND_ROWS(X) \
    X(T, "the kinetic energy", "the kinetic energy", \
      "kinetic energy T must be an energy [kg*m^2/s^2]") \
    X(V, "the potential energy", "the stored energy", \
      "potential energy V must be an energy [kg*m^2/s^2]") \
    X(F, "the dissipation function", "the dissipation", \
      "dissipation function F must be a power [kg*m^2/s^3]") \
    X(Q, "a generalized force", "the force", "") \
    X(EQUATION, "an equation", "the equation", "")

#define TERM_KIND(id, ...) TERM_##id,
typedef enum term_kind { TERM_KIND_ROWS(TERM_KIND) } term_kind;
#undef TERM_KIND

const char *term_meaning(term_kind kind);
const char *term_part(term_kind kind);
const char *term_rule(term_kind kind);

/* Contacts, in the order in which the core handles simultaneous ones: the kind, its name in messages, and the
 * quantities that may be undefined. Its word is WORD_STOP, ... (words.h), its kind in the core WH_STOP, ...
 * (core/contact.h). */
#define CONTACT_KIND_ROWS(X) \
    X(STOP, "the stop", "the restitution, or the gap, of this stop") \
    X(HOLD, "the hold", "the condition of this hold, or what it holds,") \
    X(FRICTION, "the friction", "the normal force, or a coefficient, of this friction") \
    X(WHEN, "the crossing", "the value of this crossing")

#define CONTACT_KIND(id, ...) CONTACT_##id,
typedef enum contact_kind { CONTACT_KIND_ROWS(CONTACT_KIND) } contact_kind;
#undef CONTACT_KIND

#define CONTACT_ONE(...) +1
enum { CONTACT_KINDS = 0 CONTACT_KIND_ROWS(CONTACT_ONE) };
#undef CONTACT_ONE

const char *contact_called(contact_kind kind);    /* "the stop" */
const char *contact_undefined(contact_kind kind); /* "the restitution, or the gap, of this stop" */

#endif
