/* words.h: the words of the language. A statement has a row in BODY_WORD_ROWS or SCENE_WORD_ROWS. A word inside a
 * statement has a row in INNER_WORD_ROWS. docs/language.md must list all words. */
#ifndef LANG_WORDS_H
#define LANG_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* === the kinds of symbols, terms and contacts, and their names in messages ==================== */

/* Symbols: the kind, and its name in messages. */
#define SYMBOL_KIND_ROWS(X) \
    X(COORDINATE, "a coordinate") /* generalized coordinate: may carry primes */ \
    X(STATE, "a state")           /* unknown of a system given by equations: may carry primes */ \
    X(PARAMETER, "a parameter")   /* constant during a run; its expression is constant */ \
    X(INPUT, "an input")   /* may change during a run; its first value is a constant expression */ \
    X(LET, "a let")        /* shorthand for its expression */ \
    X(OUTPUT, "an output") /* computed for records; may be used by later outputs */ \
    X(RECORD, "an output") /* an output with its noise added; only measures refer to it */

#define SYMBOL_KIND(id, words) SYM_##id,
typedef enum symbol_kind { SYMBOL_KIND_ROWS(SYMBOL_KIND) } symbol_kind;
#undef SYMBOL_KIND

const char *symbol_kind_words(symbol_kind kind);

/* Terms: the kind, its name, its name in messages about undefined values, and the message about a wrong dimension.
 * This message is "" for Q and EQUATION, because they have no fixed dimension. */
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
 * quantities that may be undefined. The core calls the kinds WH_STOP, ... (core/contact.h). */
#define CONTACT_KIND_ROWS(X) \
    X(STOP, "the stop", "the restitution, or the gap, of this stop") \
    X(HOLD, "the hold", "the condition of this hold, or its expression,") \
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

/* The places in which a statement may stand. */
enum {
    IN_FILE = 1, /* outside all blocks */
    IN_MECHANISM = 2,
    IN_EFFECT = 4,
    IN_SCENE = 8,
    IN_BODY = IN_FILE | IN_MECHANISM | IN_EFFECT
};

/* Rules of a word. */
enum {
    RESERVED = 1,       /* not available as a user's name */
    DECLARES = 2,       /* declares the name after it */
    ENDS_EFFECT = 4,    /* if it begins a line in an effect, the effect's '}' is missing */
    ENDS_SCENE = 8,     /* as ENDS_EFFECT, for a scene */
    ENDS_WHEN = 16,     /* as ENDS_EFFECT, for a `when` */
    INTO_EFFECT = 32,   /* an error in a scene, with the hint to put the statement into an effect */
    BY_ENERGIES = 64,   /* only for mechanisms given by their energies */
    BY_EQUATIONS = 128, /* only for systems given by their equations */
    LISTS = 256         /* takes items separated by commas; the reader reads one item */
};
#define FILE_FORM "a file begins with: mechanism NAME \"title\""
#define ENDS_ALL (ENDS_EFFECT | ENDS_SCENE | ENDS_WHEN)

/* Statements of files, mechanisms and effects. A misspelt word is compared with them in this order.
 *
 *   word    the id (COORDINATE makes the constant WORD_COORDINATE), and the spelling.
 *   stands  the blocks that allow the statement.
 *   rules   other rules, from the list above.
 *   reader  the function that reads the part after the word (statements.h).
 *   kind    the symbol_kind, term_kind or contact_kind that the statement makes, or 0.
 *   form    the usual form, for hints. */
#define BODY_WORD_ROWS(X) \
    X(MECHANISM, "mechanism", IN_FILE, RESERVED | ENDS_ALL, read_mechanism, 0, \
      "mechanism pendulum \"A pendulum\"") \
    X(COORDINATE, "coordinate", IN_MECHANISM, \
      RESERVED | DECLARES | ENDS_SCENE | ENDS_WHEN | BY_ENERGIES, read_unknown, SYM_COORDINATE, \
      "coordinate theta [rad]") \
    X(STATE, "state", IN_MECHANISM, RESERVED | DECLARES | ENDS_SCENE | ENDS_WHEN | BY_EQUATIONS, \
      read_unknown, SYM_STATE, "state x") \
    X(PARAMETER, "parameter", IN_MECHANISM | IN_EFFECT, \
      RESERVED | DECLARES | ENDS_SCENE | ENDS_WHEN, read_valued, SYM_PARAMETER, \
      "parameter name = expression") \
    X(INPUT, "input", IN_MECHANISM | IN_EFFECT, RESERVED | DECLARES | ENDS_WHEN, read_valued, \
      SYM_INPUT, "input name = expression") \
    X(LET, "let", IN_MECHANISM | IN_EFFECT, RESERVED | DECLARES | ENDS_SCENE | ENDS_WHEN, \
      read_valued, SYM_LET, "let name = expression") \
    X(T, "T", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | BY_ENERGIES, read_energy, TERM_T, \
      "T = m*X'^2/2") \
    X(V, "V", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | BY_ENERGIES, read_energy, TERM_V, \
      "V = m*g*X") \
    X(F, "F", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | BY_ENERGIES, read_energy, TERM_F, \
      "F = b*X'^2/2") \
    X(Q, "Q", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | BY_ENERGIES, read_force, TERM_Q, \
      "write Q(theta) = ...") \
    X(EQUATION, "equation", IN_MECHANISM, RESERVED | ENDS_SCENE | ENDS_WHEN | BY_EQUATIONS, \
      read_equation, TERM_EQUATION, "equation left = right") \
    X(OUTPUT, "output", IN_MECHANISM, RESERVED | DECLARES | ENDS_SCENE | ENDS_WHEN, read_valued, \
      SYM_OUTPUT, "output name = expression") \
    X(EFFECT, "effect", IN_FILE, RESERVED | ENDS_ALL, read_effect, 0, \
      "effect drag \"viscous drag\" { F += b*X'^2/2 }") \
    X(SCENE, "scene", IN_FILE, RESERVED | ENDS_ALL, note_scene, 0, \
      "scene from_rest \"title\" { until 9 [s] }") \
    X(STOP, "stop", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | INTO_EFFECT, read_stop, \
      CONTACT_STOP, "stop x >= 0 [m] restitution 0.5") \
    X(FRICTION, "friction", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | INTO_EFFECT, \
      read_friction, CONTACT_FRICTION, "friction x static 0.3 kinetic 0.2 normal m*g") \
    X(HOLD, "hold", IN_MECHANISM | IN_EFFECT, RESERVED | ENDS_WHEN | INTO_EFFECT, read_hold, \
      CONTACT_HOLD, "hold x - y while x > 0 [m] and x' > 0 [m/s]") \
    X(WHEN, "when", IN_MECHANISM | IN_EFFECT | IN_SCENE, RESERVED | ENDS_WHEN, read_when, \
      CONTACT_WHEN, "when x crosses 0 [m] rising { set x' = 0 [m/s] }") \
    X(NOISE, "noise", IN_MECHANISM | IN_EFFECT, INTO_EFFECT, read_noise, 0, \
      "noise angle_read deviation 0.1 [deg] seed 7")

/* Statements of scenes only (scene_block.c), with the same columns. */
#define SCENE_WORD_ROWS(X) \
    X(USE, "use", IN_SCENE, RESERVED, read_use, 0, "use NAME") \
    X(WITH, "with", IN_SCENE, RESERVED | LISTS, read_with, 0, "with EFFECT, EFFECT") \
    X(SET, "set", IN_SCENE, RESERVED | LISTS, read_set, 0, "set m = 3 [kg]") \
    X(START, "start", IN_SCENE, RESERVED | LISTS, read_start, 0, "start x' = 1.2 [m/s]") \
    X(STEP, "step", IN_SCENE, RESERVED, read_step, 0, "step 1 [ms]") \
    X(UNTIL, "until", IN_SCENE, RESERVED, read_until, 0, "until 9 [s]") \
    X(CONSERVE, "conserve", IN_SCENE, RESERVED | LISTS, read_conserve, 0, "conserve X") \
    X(RANGE, "range", IN_SCENE, LISTS, read_range, 0, "range x' = -2 .. 2 [m/s]")

/* Words inside statements: id, spelling, rules. */
#define INNER_WORD_ROWS(X) \
    X(RATE, "rate", 0) \
    X(RESTITUTION, "restitution", 0) \
    X(STATIC, "static", 0) \
    X(KINETIC, "kinetic", 0) \
    X(NORMAL, "normal", 0) \
    X(WHILE, "while", 0) \
    X(AND, "and", 0) \
    X(OR, "or", 0) \
    X(CROSSES, "crosses", 0) \
    X(RISING, "rising", 0) \
    X(FALLING, "falling", 0) \
    X(DEVIATION, "deviation", 0) \
    X(SEED, "seed", 0) \
    X(NONE, "none", 0) \
    X(LEDGER, "ledger", 0) \
    X(ALL, "all", 0) \
    X(PI, "pi", RESERVED)

#define WORD_ID(id, ...) WORD_##id,
typedef enum word_id {
    BODY_WORD_ROWS(WORD_ID) SCENE_WORD_ROWS(WORD_ID) INNER_WORD_ROWS(WORD_ID)
} word_id;
#undef WORD_ID

#define WORD_ONE(...) +1
enum {
    STATEMENT_WORDS = 0 BODY_WORD_ROWS(WORD_ONE) SCENE_WORD_ROWS(WORD_ONE),
    WORD_COUNT = STATEMENT_WORDS INNER_WORD_ROWS(WORD_ONE)
};
#undef WORD_ONE

typedef struct statement_word {
    const char *text;
    const char *form; /* "" for a word inside statements */
    unsigned stands;  /* IN_ bits; 0 for a word inside statements */
    unsigned rules;
    int kind;
} statement_word;

const statement_word *word_row(word_id id);

bool word_is(word_id id, const char *text, size_t length);
/* Returns the word that begins a statement, or WORD_COUNT if there is no such word. */
int word_find(const char *text, size_t length);
bool word_is_reserved(const char *text, size_t length);

/* Returns the hint for a word of other languages that has no meaning here, such as "if"; or NULL. */
const char *first_word_hint(const char *text, size_t length);
/* Returns the hint for an energy under another name, such as "write the kinetic energy as T = ..."; or NULL. */
const char *energy_hint(const char *text, size_t length);

const char *contact_word(contact_kind kind);

#endif
