/* model.h: the contents of a .whirl file, with names resolved, units converted to SI and dimensions checked. The arena
 * of the `model` owns everything and frees it. */
#ifndef LANG_MODEL_H
#define LANG_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/base/diag.h"
#include "host/lang/units.h"
#include "host/lang/words.h"
#include "host/number/enclosure.h"
#include "host/number/folding.h"
#include "host/number/functions.h"
#include "host/number/ratio.h"

/* --- symbols ----------------------------------------------------------------------------------- */

typedef struct expr expr;

typedef struct symbol {
    symbol_kind kind;
    const char *name;
    const char *text; /* the description in quotes, or "" */
    /* the declared unit without blanks, or "". A parameter or input whose value is one number has the number's unit. */
    const char *unit;
    unit_scale declared; /* scale of the declared unit; divisor 0 if no unit is declared */
    dimension dim;       /* dimension of the symbol without primes */
    bool is_angle;       /* coordinate or state: declared in rad, deg or rev */
    const expr *value;   /* parameter, input, let, output, record: its expression; else NULL */
    place at;            /* place of its declaration */
    int index;           /* index in the mechanism's list of this kind, such as parameters[] */
    int effect;          /* index of the effect that declared it, or -1 */
    int order;           /* coordinate: 2; state: order of its highest derivative; else 0 */
    const struct symbol *rate; /* input: the input that is its time derivative, or NULL */
    /* input: the driven coordinate that replaces the input; driven coordinate: the input; else NULL */
    const struct symbol *driven;
} symbol;

/* Is it a coordinate or a state? */
static inline bool symbol_moves(const symbol *s) {
    return s->kind == SYM_COORDINATE || s->kind == SYM_STATE;
}

/* If a driven coordinate replaces `s`, returns the coordinate. *primes is 1 if `s` is the coordinate's rate, else 0.
 * If no driven coordinate replaces `s`, returns `s`, and does not set *primes. */
const symbol *symbol_moving(const symbol *s, int *primes);

/* Returns the input that is the acceleration of `driven`; NULL if the rate of `driven` is constant inside a step. */
const symbol *symbol_acceleration(const symbol *driven);

/* Writes two statements, which declare the rate of an input, to buffer[RATE_HINT_SIZE]. Returns `buffer`. */
enum { RATE_HINT_SIZE = 320 };
char *input_rate_hint(const symbol *input, char *buffer);

/* --- expressions ------------------------------------------------------------------------------- */

typedef enum expr_op {
    EXPR_NUMBER, /* number, SI */
    EXPR_SYMBOL, /* symbol with `primes` time derivatives */
    EXPR_ADD,    /* left + right */
    EXPR_SUB,
    EXPR_MUL,
    EXPR_DIV,
    EXPR_POW,
    EXPR_NEG, /* -left */
    EXPR_CALL /* function(left) or function(left, right) */
} expr_op;

struct expr {
    expr_op op;
    function_id function;
    int primes;      /* number of time derivatives of `symbol` */
    double number;   /* SI value of EXPR_NUMBER */
    enclosure exact; /* encloses the decimal value, which a double may not represent */
    const symbol *symbol;
    const expr *left;
    const expr *right;
    place at; /* place of the operator or the operand, for messages */
    dimension dim;
    int height;          /* leaf: 1; name of a let or output: 1 + height of its expression */
    int order;           /* highest derivative of a coordinate or state, also within lets */
    unsigned uses;       /* USES_ bits; a let or output has those of its expression */
    bool is_condition;   /* a condition: true while above zero; arithmetic refuses conditions */
    const symbol *angle; /* a symbol in a unit such as deg that makes the value an angle; or NULL */
};

enum {
    USES_UNKNOWNS = 1, /* coordinates or states */
    USES_PARAMETER = 2,
    USES_INPUT = 4,
    USES_OUTPUT = 8,
    USES_UNIT = 16 /* contains a number with a unit, or a value that needs none, such as a let */
};

#define EXPR_HEIGHT_MAX 1000 /* largest `height` of an expression, so that recursion is bounded */

/* --- mechanisms -------------------------------------------------------------------------------- */

/* One contribution: `T = e`, `V += e`, `Q(c) = e`, `equation left = right`. */
typedef struct term {
    term_kind kind;
    const symbol *coordinate; /* the coordinate of a Q, else NULL */
    const expr *value;        /* T, V, F, Q; left side of an equation */
    const expr *right;        /* right side of an equation, else NULL */
    int effect;               /* index of the effect that contains the statement, or -1 */
    place at;
} term;

typedef struct effect {
    const char *name;
    const char *text;
    place at;      /* place of the name */
    int last_line; /* end of its block */
} effect;

/* NAME = EXPR in a `set`, `start` or `when`. In a `set` or `start`, EXPR is constant. */
typedef struct assignment {
    const symbol *symbol;
    int primes;
    const expr *value;
    place at;
} assignment;

/* One contact, handled inside the step (core/contact.h). */
typedef struct contact_statement {
    contact_kind kind;
    /* stop: the gap, an expression without rates
     * hold: an expression without rates, which is constant while the hold acts
     * when: left side minus right side
     * friction: NULL */
    const expr *value;
    const symbol *coordinate;    /* friction: the coordinate whose motion it opposes; else NULL */
    const expr *restitution;     /* stop: restitution, 0 to 1 */
    const expr *static_friction; /* friction: coefficients, 0 <= kinetic <= static */
    const expr *kinetic_friction;
    const expr *normal;     /* friction: normal force (for an angle: torque); 0 if negative */
    const expr *condition;  /* hold: acts while this is > 0; `and` becomes FN_MIN, `or` FN_MAX */
    int direction;          /* when: +1 rising, -1 falling, 0 both */
    const assignment *sets; /* when: all values are computed before any is assigned */
    int set_count;
    int effect; /* index of the effect that contains the statement, or -1 */
    place at;
} contact_statement;

/* One run has at most CONTACTS_MAX stops, frictions, holds and whens. Its whens set at most SETS_MAX values. */
enum { CONTACTS_MAX = 16, SETS_MAX = 128 };

/* `noise OUTPUT deviation EXPR seed NUMBER`: Gaussian noise on a recorded output (core/noise.h). */
typedef struct noise {
    const symbol *output;
    const symbol *record;  /* `output` with noise (SYM_RECORD), shared by all noises of `output` */
    const expr *deviation; /* expression of constants, in the output's dimension, >= 0 */
    uint32_t seed;
    int effect;
    place at;
} noise;

/* `range NAME = A .. B` of a scene: the bounds of a symbol in fixed point. */
typedef struct range_statement {
    const symbol *symbol; /* a coordinate, a state, an input */
    int primes;
    const expr *low; /* expressions of constants */
    const expr *high;
    place at;
} range_statement;

typedef struct mechanism {
    const char *name;
    const char *title;
    place at;
    int last_line; /* the line before the next mechanism, or the last line of the file */
    const symbol **coordinates;
    int coordinate_count; /* coordinates, or states */
    const symbol **parameters;
    int parameter_count; /* includes the parameters of effects */
    const symbol **inputs;
    int input_count;
    const symbol **outputs;
    int output_count;
    const symbol **lets;
    int let_count; /* a let refers only to earlier lets */
    const term *terms;
    int term_count;
    const contact_statement *contacts;
    int contact_count;
    const noise *noises;
    int noise_count;
    const effect *effects;
    int effect_count;
    bool is_system;      /* given by state/equation, not by T, V, F, Q */
    struct names *names; /* finds symbols by name (parser.h) */
} mechanism;

enum { COORDINATES_MAX = 64, EFFECTS_MAX = 500, MECHANISMS_MAX = 500, SCENES_MAX = 1000 };

/* --- scenes ------------------------------------------------------------------------------------ */

typedef struct scene {
    const char *name;
    const char *title;
    place at;      /* place of the name */
    int last_line; /* end of its block */
    const mechanism *mechanism;
    bool *with; /* [mechanism->effect_count] active effects */
    const assignment *sets;
    int set_count;
    const assignment *starts;
    int start_count;
    bool *conserve;                 /* [mechanism->coordinate_count] named by `conserve` */
    bool ledger;                    /* `with ledger`: record the balance of energy and momentum */
    const contact_statement *whens; /* `when` statements of the scene itself */
    int when_count;
    const range_statement *ranges;
    int range_count;
    const expr *step;  /* seconds, or NULL */
    const expr *until; /* seconds, or NULL */
} scene;

typedef struct whirl_model {
    const mechanism *const *mechanisms;
    int mechanism_count;
    const scene *const *scenes;
    int scene_count;
    struct arena *arena;
} whirl_model;

#define MODEL_BYTES_MAX ((size_t)16 << 20) /* longer texts are refused */

/* Parse and check `text` (`length` bytes, any bytes). Messages call it `file`. Returns NULL after an error; `diags` has
 * the errors, at most 20. Free the result with model_free(). */
whirl_model *model_parse(const char *file, const char *text, size_t length, diags *diags);
void model_free(whirl_model *model);

/* --- instances: values of a scene or bare mechanism, with the command line's changes applied --- */

/* Changes from the command line, as the user typed them ("m=3 [kg]", "theta'=1.2"). A number without a unit has the SI
 * unit of the quantity; it is refused if the declared unit is not SI. */
typedef struct overrides {
    const char *const *sets;
    int set_count; /* --set: parameters and inputs */
    const char *const *starts;
    int start_count; /* --start: coordinates and rates */
    const char *const *values;
    int value_count; /* parameters and inputs (as --set), coordinates and rates (as --start) */
    const char *const *with;
    int with_count; /* to add: names of effects, "ledger", or "all" (every effect) */
    const char *const *without;
    int without_count; /* to remove: as above, or "conserve"; "all" acts before single names */
    const char *step;  /* "1ms", "1 [ms]", "0.001", or NULL */
    const char *until; /* the end of the scene, or NULL */
    const char *name;  /* name of the instance; NULL: the scene's or mechanism's; not copied */
    bool balance;      /* keep a ledger if the run has contacts and a ledger is possible */
} overrides;

/* A range in SI numbers, with low < high. */
typedef struct range_value {
    const symbol *symbol;
    int primes;
    double low;
    double high;
    place at;
} range_value;

/* An expression (NULL if none was given) and its place for messages. */
typedef struct given_value {
    const expr *value;
    place at;
} given_value;

typedef struct instance {
    const mechanism *mechanism;
    const scene *scene;           /* NULL for a bare mechanism */
    const char *name;             /* the scene's name, the mechanism's, or overrides.name */
    bool *with;                   /* [effect_count] */
    const bool *conserve;         /* [coordinate_count] scene->conserve; NULL: conserve none */
    bool ledger;                  /* record the balance of energy and momentum */
    bool balance;                 /* as in overrides */
    double *parameter;            /* [parameter_count] SI */
    double *input;                /* [input_count] SI */
    const expr **parameter_given; /* [parameter_count] expression of each parameter */
    const expr **input_given;
    given_value **start_given; /* [coordinate_count][order]; a missing expression means 0 */
    double **start;            /* [coordinate_count][max(order, 2)] initial value, rate, ..., SI */
    int *start_count;          /* [coordinate_count] number of initial values */
    range_value *range;        /* [range_count] */
    int range_count;
    double step_s;    /* default 1e-3 */
    double until_s;   /* default 10 */
    folding folding;  /* record of the digits that constant folding lost in instance_make() */
    whole_ratio step; /* step_s as a fraction */
    uint64_t steps;   /* steps of the run: until_s / step_s, rounded to nearest, at most 2^63 */
    struct arena *arena;
} instance;

/* Is a statement of the effect with index `within` active? Those of the mechanism itself (-1) always are. */
bool instance_has(const instance *of, int within);

/* The SI value of a parameter or an input, or the start of a coordinate or its derivative. NAN for other symbols. */
double instance_value(const instance *of, const symbol *s, int primes);

/* The inactive effect that declared this symbol; NULL if there is none. */
const effect *instance_lacks(const instance *instance, const symbol *what);

/* Evaluates `scene` or, if NULL, the mechanism at rest at zero. `changes` may be NULL. Returns NULL after an error. */
instance *instance_make(const mechanism *mechanism, const scene *scene, const overrides *changes,
                        diags *diags);
/* A copy with parameters, inputs and initial values computed with another folding.way. `first` must outlive it.
 * Returns NULL if a value is not finite. */
instance *instance_again(const instance *first, int way);
void instance_free(instance *instance);

/* Reads *seconds, at least 0, from the command line's `text`, such as "1.5 [s]". `scene` and `changes` give the values
 * of parameters in `text`. `what` names the time in messages. Returns false after an error. */
bool instance_duration(const mechanism *mechanism, const scene *scene, const overrides *changes,
                       const char *what, const char *text, diags *diags, double *seconds);

#endif
