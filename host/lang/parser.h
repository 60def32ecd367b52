/* parser.h: what is known while a text is read. Its floor is cursor.h (tokens), above it come expressions
 * (expression.h) and statements (statements.h); statements.c is the roof. */
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

/* A scene being read. */
typedef struct draft {
    scene *made;
    bool *with;
    bool *conserve;
    builder *of;
    int number;       /* from 1: marks the symbols that were set */
    bool has_content; /* a statement other than `use` was met */
    place step_at;    /* line 0: none yet */
    place until_at;
} draft;

/* A scene's text, read after all mechanisms are known. */
typedef struct pending_scene {
    lexer from; /* behind `next` */
    token next; /* behind the word `scene` */
    place at;
    builder *inside; /* the mechanism it stands in, or NULL */
} pending_scene;

typedef struct parser {
    lexer lexer;
    token token;     /* the one to be looked at next */
    int parentheses; /* open ones: lines go on */
    int nesting;
    place statement_at; /* of the statement being read */
    diags *diags;
    struct arena *arena;
    expr_context context;
    unit_scale number_unit; /* the last one behind a number, and its text */
    const char *number_unit_text;
    const expr *ready;         /* read already: the first operand of the expression to be parsed */
    int effect;                /* the one being read, or -1 */
    bool all_effects;          /* a scene may name the parameters of every effect */
    const struct names *names; /* NULL: no names at all */
    builder *builder;          /* the mechanism being read, or NULL */
    draft *draft;              /* the scene being read, or NULL */
    builder **builders;
    int builder_count;
    pending_scene *pending;
    int pending_count;
    const scene **scenes;
    int scene_count;
} parser;

#endif
