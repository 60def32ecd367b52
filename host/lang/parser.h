/* parser.h: the state of the parser, and access to tokens; the base of expression.h and statements.h. */
#ifndef LANG_PARSER_H
#define LANG_PARSER_H

#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/lang/lexer.h"
#include "host/lang/model.h"
#include "host/lang/words.h"

/* === the symbols of one mechanism, found by name ============================================== */

typedef struct named {
    symbol symbol;       /* must be first: a symbol's address is also that of its `named` */
    bool is_placeholder; /* used but not declared; reported */
    bool is_open;        /* the parser is reading its declaration */
    int mark;            /* number of the last walk that visited the symbol */
    struct named *rate;  /* time derivative of a let; NULL until an expression uses it */
    struct named *next;  /* next entry in the same slot */
} named;

typedef struct names names;

names *names_new(struct arena *arena);
/* Returns the entry of this name, or NULL. `all` may be NULL. */
named *names_find(const names *all, const char *text, size_t length);
/* Adds an entry. The name must be new. */
named *names_add(names *all, const char *text, size_t length);
/* Adds an undeclared name that has been reported, so that it is not reported again. */
void names_add_placeholder(names *all, const token *name);
/* Offers names to the search: those outside effects, and those of effect `effect_index` (-1: none, -2: all effects). */
void names_offer(const names *all, int effect_index, nearest *search);

enum { NESTING_MAX = 200 };

/* The context of an expression decides which names it may use. The comments list statements, then allowed names. */
typedef enum expr_context {
    CONTEXT_CONSTANT, /* parameter, input, set, start, step: numbers and parameters */
    CONTEXT_FORCE,    /* T, V, F, Q: up to first derivatives of coordinates */
    CONTEXT_EQUATION, /* equations of a state system: derivatives of any order */
    CONTEXT_GAP,      /* the quantity that a stop or a hold limits: no derivatives */
    CONTEXT_EVENT,    /* other expressions of stop, friction, hold, when: up to first derivatives */
    CONTEXT_LET,      /* let: up to second derivatives of coordinates */
    CONTEXT_OUTPUT    /* output: up to second derivatives of coordinates, and earlier outputs */
} expr_context;

/* The current mechanism. */
typedef struct builder {
    mechanism *made;
    place energy_at[3]; /* places of the first `T =`, `V =` and `F =`; line 0 if there is none */
    place *force_at;    /* [COORDINATES_MAX] place of the first `Q(c) =` for each coordinate c */
    int equation_count;
    bool has_energies;  /* has a coordinate, T, V, F or Q */
    bool has_equations; /* has a state or an equation */
    bool mixed;         /* a mix of energies and equations was reported */
    bool nameless;      /* the `mechanism` line or its name is missing */
    bool broken;        /* a statement failed: do not report anything as missing */
} builder;

/* The current scene. */
typedef struct draft {
    scene *made;
    bool has_content; /* has a statement other than `use` */
    place step_at;    /* place of the `step` statement; line 0 if there is none */
    place until_at;
} draft;

/* A scene's text, read after all mechanisms are known. */
typedef struct pending_scene {
    lexer from; /* reads the text after `next` */
    token next; /* the token after the word `scene` */
    place at;
    builder *inside; /* the enclosing mechanism, or NULL */
} pending_scene;

typedef struct parser {
    lexer lexer;
    token token;     /* the current token */
    int parentheses; /* number of open parentheses; line breaks inside them are skipped */
    int nesting;
    place statement_at; /* place of the current statement */
    diags *diags;
    struct arena *arena;
    expr_context context;
    unit_scale number_unit; /* the last unit that followed a number */
    const char *number_unit_text;
    const char *const *around; /* see override_parse() */
    const char *condition_at;  /* start of the current comparison in the text */
    int effect;                /* index of the current effect, or -1 */
    bool all_effects;          /* names that any effect declares are allowed, as in a scene */
    bool bare_units;           /* units may stand without brackets, as on the command line */
    names *names;              /* names of the mechanism, or NULL */
    builder *builder;          /* the mechanism of the current statement or scene, or NULL */
    draft *draft;              /* the current scene, or NULL */
    builder **builders;
    int builder_count;
    pending_scene *pending;
    int pending_count;
    const scene **scenes;
    int scene_count;
} parser;

/* === the current token, tests on it, and recovery after errors ================================ */

void parser_next(parser *in);
bool parser_is_sign(const parser *in, int sign);
bool parser_is_word(const parser *in, word_id word);
bool parser_at_end_of_line(const parser *in); /* newline, `;`, end of text */
bool token_is(const token *each, const char *word);
bool token_is_word(const token *each, word_id word);
const statement_word *token_statement(const token *each);
bool parser_is_body_word(const parser *in); /* begins a statement of a file, mechanism or effect */
/* Expects this word. If it is missing, reports this with the statement's form as a hint, and returns false. */
bool parser_expect_word(parser *in, word_id word, word_id statement);
/* Reports an error at the current token, unless the lexer has already reported it. Returns false. */
bool parser_fail(parser *in, const char *hint, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool parser_expect_sign(parser *in, int sign, const char *where);
/* Returns the token for messages, such as "'x'" or "the end of the line". */
const char *token_words(const parser *in, const token *each);
/* Returns the hint "did you mean 'NAME'?", or `otherwise` if no name is similar. */
const char *parser_nearest(const parser *in, const nearest *search, const char *otherwise);
/* Skips to the end of a failed statement, including the braces that it opened. */
void parser_skip_statement(parser *in);
void parser_skip_lines(parser *in);    /* skip empty lines, and `;` */
void parser_skip_newlines(parser *in); /* skip empty lines only */
/* Skips empty lines. Returns false at the block's end. *closed is false if the '}' is missing there.
 * `rule`: ENDS_EFFECT, ENDS_SCENE or ENDS_WHEN, for the kind of block. */
bool parser_in_block(parser *in, unsigned rule, bool *closed);
/* Returns the hint for a missing operator before the current name, number or '('. */
const char *parser_operator_hint(const parser *in);
bool parser_end_statement(parser *in, const char *what);
void parser_add_symbol(parser *in, const symbol ***list, int *count, symbol *made);
char *parser_copy_text(parser *in, const token *each);
/* Reads an optional text in quotes; returns "" if there is none. */
const char *parser_title(parser *in);
/* Reports that the current token begins no statement that is allowed here (IN_ bits). Returns false. */
bool statement_unknown(parser *in, unsigned where);

#endif
