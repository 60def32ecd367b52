/* parser.h: what the files of the parser share. A statement function returns false when it gave up
 * inside its statement (the error is reported); the caller then skips to the next statement. */
#ifndef LANG_PARSER_H
#define LANG_PARSER_H

#include "host/base/arena.h"
#include "lexer.h"
#include "model.h"
#include "names.h"

enum { NESTING_MAX = 200 };

/* Where an expression stands decides what it may name. */
typedef enum expr_context {
    CONTEXT_CONSTANT, /* parameter, input, set, start, step: numbers and parameters */
    CONTEXT_FORCE,    /* T, V, F, Q: up to first derivatives of coordinates */
    CONTEXT_EQUATION, /* equations of a state system: derivatives of any order */
    CONTEXT_GAP,      /* what stops and holds act on: coordinates, no rates */
    CONTEXT_EVENT,    /* the rest of stop, friction, hold, when: up to first derivatives */
    CONTEXT_LET,      /* whatever its users may name */
    CONTEXT_OUTPUT    /* also second derivatives and earlier outputs */
} expr_context;

/* A mechanism being read. */
typedef struct builder {
    mechanism *made;
    struct names *names;
    place energy_at[3]; /* first `T =`, `V =`, `F =`; line 0 when there was none */
    place *force_at;    /* [COORDINATES_MAX] first `Q(c) =` */
    int equation_count;
    bool has_energies;  /* coordinate, T, V, F or Q was met */
    bool has_equations; /* state or equation was met */
    bool mixed;         /* the mix of both was reported */
    bool nameless;      /* stands in for a missing `mechanism` line */
    bool broken;        /* a statement failed: do not complain about what is missing */
} builder;

/* A scene's text, read after all mechanisms are known. */
typedef struct pending_scene {
    lexer from; /* just after the word `scene` */
    place at;
    builder *inside; /* the mechanism it stands in, or NULL */
} pending_scene;

typedef struct parser {
    lexer lexer;
    token token;     /* the one to be looked at next */
    int parentheses; /* open ones: lines go on */
    int nesting;
    size_t statement; /* offset of the statement being read */
    diags *diags;
    struct arena *arena;
    expr_context context;
    unit number_unit; /* the last one behind a number, and its text */
    const char *number_unit_text;
    const expr *ready;         /* read already: the first operand of the expression to be parsed */
    int effect;                /* the one being read, or -1 */
    bool all_effects;          /* a scene may name the parameters of every effect */
    const struct names *names; /* NULL: no names at all */
    builder *builder;          /* the mechanism being read, or NULL */
    builder **builders;
    int builder_count;
    pending_scene *pending;
    int pending_count;
    const scene **scenes;
    int scene_count;
} parser;

/* --- tokens (parser.c) --- */
void parser_next(parser *in);
bool parser_is_sign(const parser *in, int sign);
bool parser_is_word(const parser *in, const char *word);
bool parser_at_end_of_line(const parser *in); /* newline, `;`, end of text */
bool token_is(const token *each, const char *word);
/* The word wanted here; if another, it is reported with `form`, the statement's usual look. */
bool parser_expect_word(parser *in, const char *word, const char *form);
/* Report at the token in hand (once: an unreadable one was reported by the lexer); returns false. */
bool parser_fail(parser *in, const char *hint, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool parser_expect_sign(parser *in, int sign, const char *where);
/* How messages name the token in hand, such as "'x'" or "the end of the line". */
const char *token_words(const token *each, char *buffer, size_t size);
/* Skip what is left of a statement that failed, with the braces it opened. */
void parser_skip_statement(parser *in);
void parser_skip_lines(parser *in); /* empty ones */
bool parser_end_statement(parser *in, const char *what);
char *parser_copy_text(parser *in, const token *each);
/* An optional text in quotes; "" when there is none. */
const char *parser_title(parser *in);

/* --- expressions (expression.c, operators.c) --- */
const expr *parse_expression(parser *in, expr_context context); /* NULL: gave up */
bool parse_close(parser *in, place open);                       /* the ')' that closes `open` */
/* Comparisons joined by `and`, `or` as one expression: true when above zero. `form` as above. */
const expr *parse_condition(parser *in, const char *form); /* condition.c */
expr *expr_new(parser *in, expr_op op, place at);
const expr *expr_binary(parser *in, expr_op op, place at, const expr *left, const expr *right);
/* left - right of a comparison: both must have one dimension. */
const expr *expr_difference(parser *in, place at, const expr *left, const expr *right);
const expr *expr_negate(parser *in, place at, const expr *operand);
const expr *expr_call(parser *in, function_id function, place at, const expr *left,
                      const expr *right);
const expr *expr_name(parser *in, const token *name); /* reference.c */
/* The line in which a later statement of the mechanism declares the name, or 0. */
int name_declared_later(const token *name);
/* The value when only numbers and operators are in it. */
bool expr_constant(const expr *tree, double *value);
/* Report at `at` "RULE, but this is ..." when `value` has not the dimension `wanted`. */
bool check_dimension(parser *in, place at, const expr *value, dimension wanted, const char *rule);
/* "SUBJECT is mass [kg]", the rule for something that has its dimension already. */
enum { RULE_SIZE = 300 };
char *dimension_rule(char *buffer, const char *subject, const char *verb, dimension dim);
/* The unit token in hand; *text is set to what it says, without blanks. */
bool parse_unit(parser *in, unit *result, const char **text);

/* --- statements --- */
bool is_reserved(const char *text, size_t length); /* declare.c */
symbol *declare(parser *in, const token *name, symbol_kind kind);
bool parse_declaration(parser *in, bool *known); /* coordinate, parameter, input, ... */
void note_way(parser *in, bool by_equations);    /* the token in hand is the statement's word */
bool parse_term(parser *in, bool *known);        /* T, V, F, Q, equation: terms.c */
bool parse_effect(parser *in);                   /* effect.c */
bool parse_contact(parser *in, bool *known);     /* stop, friction, hold, when: contact.c */
bool parse_when(parser *in, contact_statement *made); /* when.c */
void contact_on_system(parser *in, const contact_statement *each);
bool parse_noise(parser *in, bool *known);                                       /* noise.c */
const symbol *find_coordinate(parser *in, const token *name, const char *whose); /* terms.c */
void finish_mechanism(parser *in, builder *made);                                /* finish.c */
bool parse_scene(parser *in, const pending_scene *pending);                      /* scene.c */
bool statement_unknown(parser *in, const char *const *words, int count);         /* parser.c */

#endif
