/* parser.h: the state of the parser. The lowest layer is cursor.h (tokens), then come expressions (expression.h) and
 * statements (statements.h); statements.c is the top. */
#ifndef LANG_PARSER_H
#define LANG_PARSER_H

#include "host/base/arena.h"
#include "lexer.h"
#include "model.h"
#include "names.h"

enum { NESTING_MAX = 200 };

/* The context of an expression decides which names it may use. */
typedef enum expr_context {
    CONTEXT_CONSTANT, /* parameter, input, set, start, step: numbers and parameters */
    CONTEXT_FORCE,    /* T, V, F, Q: up to first derivatives of coordinates */
    CONTEXT_EQUATION, /* equations of a state system: derivatives of any order */
    CONTEXT_GAP,      /* the quantity of stops and holds: coordinates, no rates */
    CONTEXT_EVENT,    /* other parts of stop, friction, hold, when: up to first derivatives */
    CONTEXT_LET,      /* any name; each use of the let is checked */
    CONTEXT_OUTPUT    /* up to second derivatives, and earlier outputs */
} expr_context;

/* The current mechanism. */
typedef struct builder {
    mechanism *made;
    struct names *names;
    place energy_at[3]; /* first `T =`, `V =`, `F =`; line 0 without one */
    place *force_at;    /* [COORDINATES_MAX] first `Q(c) =` */
    int equation_count;
    bool has_energies;  /* has a coordinate, T, V, F or Q */
    bool has_equations; /* has a state or an equation */
    bool mixed;         /* mixing energies with equations was reported */
    bool nameless;      /* replaces a missing `mechanism` line */
    bool broken;        /* a statement failed: report nothing as missing */
} builder;

/* The current scene. */
typedef struct draft {
    scene *made;
    bool *with;
    bool *conserve;
    builder *of;
    int number;       /* from 1: marks the symbols that are set */
    bool has_content; /* has a statement other than `use` */
    place step_at;    /* line 0: no step yet */
    place until_at;
} draft;

/* A scene's text, read after all mechanisms are known. */
typedef struct pending_scene {
    lexer from; /* after `next` */
    token next; /* after the word `scene` */
    place at;
    builder *inside; /* the enclosing mechanism, or NULL */
} pending_scene;

typedef struct parser {
    lexer lexer;
    token token;     /* the current token */
    int parentheses; /* number of open ones: lines continue */
    int nesting;
    place statement_at; /* of the current statement */
    diags *diags;
    struct arena *arena;
    expr_context context;
    unit_scale number_unit; /* the unit after the last number, and its text */
    const char *number_unit_text;
    const expr *ready;         /* first operand of the next expression, if already read */
    int effect;                /* the current one, or -1 */
    bool all_effects;          /* a scene may name the parameters of every effect */
    const struct names *names; /* NULL: no names allowed */
    builder *builder;          /* the current mechanism, or NULL */
    draft *draft;              /* the current scene, or NULL */
    builder **builders;
    int builder_count;
    pending_scene *pending;
    int pending_count;
    const scene **scenes;
    int scene_count;
} parser;

#endif
