/* model.h: what a .whirl file says, with names resolved, units converted to SI and dimensions
 * checked. host/lang fills it; host/derive reads it. Nothing here knows algebra.
 *
 * Everything lives in the arena of the `model` and is freed with it.
 */
#ifndef LANG_MODEL_H
#define LANG_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/base/diag.h"
#include "host/lang/units.h"
#include "host/number/enclosure.h"
#include "host/number/folding.h"
#include "host/number/functions.h"
#include "host/number/ratio.h"
#include "kinds.h"

/* --- symbols ----------------------------------------------------------------------------------- */

typedef struct expr expr;

typedef struct symbol {
    symbol_kind kind;
    const char *name;
    const char *text; /* the description in quotes, or "" */
    const char *unit; /* the declared unit, without blanks, or ""; of a parameter or input, the one
                          behind the only number of its value */
    unit_scale declared; /* what that unit is; divisor 0 when there is none */
    dimension dim;       /* of the symbol without primes */
    bool is_angle;       /* declared [rad] (or [deg], [rev]): coordinate or state */
    const expr *value;   /* parameter, input, let, output, record: its expression; else NULL */
    place at;            /* where it was declared */
    int index;           /* running number within its kind in its mechanism, declaration order */
    int effect;          /* index of the effect that declared it, or -1 */
    int order;           /* coordinate: 2; state: its highest derivative in the equations; else 0 */
    const struct symbol *rate; /* of an input: the input that is its time derivative, or NULL */
    /* An input with a rate moves inside a step: of it and of its rate the coordinate that they drive, which the mechanism
     * has last; of that coordinate the input; else NULL. */
    const struct symbol *driven;
} symbol;

/* What a symbol stands for while the mechanism moves: of an input with a rate, and of that rate, the driven coordinate with
 * *primes primes; of every other symbol itself. */
const symbol *symbol_moving(const symbol *s, int *primes);

/* The input that accelerates a driven coordinate, or NULL: its rate is constant inside a step. */
const symbol *symbol_acceleration(const symbol *driven);

/* How to declare the rate of an input, for hints: two statements that can be pasted. */
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
    int primes;      /* time derivatives on a symbol: 0, 1, 2, ... */
    double number;   /* SI value of EXPR_NUMBER */
    enclosure exact; /* the same as it is written, which a double may not be */
    const symbol *symbol;
    const expr *left;
    const expr *right;
    place at; /* for messages: the operator's or the operand's place */
    dimension dim;
    int height;    /* 1 for a leaf; a let or output named counts with its expression */
    int order;     /* most primes on any coordinate or state in it, through lets too */
    unsigned uses; /* USES_ bits of what it depends on, through lets too */
};

enum {
    USES_UNKNOWNS = 1, /* coordinates or states */
    USES_PARAMETER = 2,
    USES_INPUT = 4,
    USES_OUTPUT = 8,
    USES_UNIT = 16 /* a number in it has a unit */
};

/* Highest expression tree the parser lets through, lets included: readers may recurse. */
#define EXPR_HEIGHT_MAX 1000

/* --- mechanisms -------------------------------------------------------------------------------- */

/* One contribution: `T = e`, `V += e`, `Q(c) = e`, `equation left = right`. */
typedef struct term {
    term_kind kind;
    const symbol *coordinate; /* of Q, else NULL */
    const expr *value;        /* T, V, F, Q; left side of an equation */
    const expr *right;        /* right side of an equation, else NULL */
    int effect;               /* index of the effect it belongs to, or -1 */
    place at;
} term;

typedef struct effect {
    const char *name;
    const char *text;
    place at;      /* of its name */
    int last_line; /* where its block ends */
} effect;

/* `set NAME = EXPR` or `start NAME' = EXPR` of a scene, where the value is an expression of constants;
 * or one assignment of a `when`, where it may name coordinates, rates, parameters and inputs. */
typedef struct assignment {
    const symbol *symbol;
    int primes;
    const expr *value;
    place at;
} assignment;

/* One contact, handled inside the step (core/contact.h says how). */
typedef struct contact_statement {
    contact_kind kind;
    /* stop: left - right, >= 0 when apart (coordinates, no rates); hold: the expression whose rate is
     * held at zero (coordinates, no rates); when: left - right (rates allowed); friction: NULL. */
    const expr *value;
    const symbol *coordinate;    /* friction: acts on its rate; else NULL */
    const expr *restitution;     /* stop: 0 to 1 */
    const expr *static_friction; /* friction: coefficients, 0 <= kinetic <= static */
    const expr *kinetic_friction;
    const expr *normal;     /* friction: normal force [N]; below zero counts as zero */
    const expr *condition;  /* hold: true while above zero; `and` is min, `or` is max */
    int direction;          /* when: +1 rising, -1 falling, 0 both */
    const assignment *sets; /* when: coordinates and rates, all evaluated before any is set */
    int set_count;
    int effect; /* index of the effect it belongs to, or -1 */
    place at;
} contact_statement;

/* Most stops, frictions, holds and whens that take part in one run, and values its whens set. */
enum { CONTACTS_MAX = 16, SETS_MAX = 128 };

/* `noise OUTPUT deviation EXPR seed NUMBER`: Gaussian noise on a recorded output (core/noise.h). */
typedef struct noise {
    const symbol *output;
    const symbol *record;  /* the output with its noise, SYM_RECORD: one for each output */
    const expr *deviation; /* an expression of constants, of the output's dimension, >= 0 */
    uint32_t seed;
    int effect;
    place at;
} noise;

/* `range NAME = A .. B` of a scene: what it keeps to in fixed point. */
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
    const symbol **coordinates;
    int coordinate_count; /* coordinates, or states */
    const symbol **parameters;
    int parameter_count; /* those of effects too */
    const symbol **inputs;
    int input_count;
    const symbol **outputs;
    int output_count;
    const symbol **lets;
    int let_count; /* each names only earlier ones */
    const term *terms;
    int term_count;
    const contact_statement *contacts;
    int contact_count;
    const noise *noises;
    int noise_count;
    const effect *effects;
    int effect_count;
    bool is_system;            /* given by state/equation instead of T, V, F, Q */
    const struct names *names; /* of host/lang: finds symbols by name */
} mechanism;

/* Largest numbers of things in one mechanism or file. */
enum { COORDINATES_MAX = 64, EFFECTS_MAX = 500, MECHANISMS_MAX = 500, SCENES_MAX = 1000 };

/* --- scenes ------------------------------------------------------------------------------------ */

typedef struct scene {
    const char *name;
    const char *title;
    place at;      /* of its name */
    int last_line; /* where its block ends */
    const mechanism *mechanism;
    const bool *with; /* [mechanism->effect_count] effects called for */
    const assignment *sets;
    int set_count;
    const assignment *starts;
    int start_count;
    const bool *conserve;           /* [mechanism->coordinate_count] */
    bool ledger;                    /* `with ledger`: the books of energy and momentum are kept */
    const contact_statement *whens; /* `when` statements of the scene's own */
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

#define MODEL_BYTES_MAX ((size_t)16 << 20) /* a longer text is refused */

/* Parse and check `text` (`length` bytes, any bytes), called `file` in messages. Returns NULL when
 * there was an error; all errors (up to 20) are in `diags`. Free the result with model_free(). */
whirl_model *model_parse(const char *file, const char *text, size_t length, diags *diags);
void model_free(whirl_model *model);

/* --- instances: a scene, or a bare mechanism, with the command line's changes, in numbers -------- */

/* Changes from the command line; every `const char *` is text as typed ("m=3 [kg]", "theta'=1.2").
 * On the command line a bare number is an SI value of whatever dimension is wanted, where the declared unit is SI. */
typedef struct overrides {
    const char *const *sets;
    int set_count; /* --set: parameters and inputs */
    const char *const *starts;
    int start_count; /* --start: coordinates and rates */
    const char *const *values;
    int value_count; /* either kind, told by the name (`accel`) */
    const char *const *with;
    int with_count; /* effect names added, or "ledger"; "all": every effect */
    const char *const *without;
    int without_count; /* taken away again; "all" comes first; "conserve": what the scene conserves */
    const char *step;  /* "1ms", "1 [ms]", "0.001", or NULL */
    const char *until; /* or NULL */
    const char
        *name; /* instead of the scene's or mechanism's, or NULL; lives as long as the instance */
    bool balance; /* keep books of contacts inside the run even where nobody asked for them */
} overrides;

/* The same in numbers, SI: low < high. */
typedef struct range_value {
    const symbol *symbol;
    int primes;
    double low;
    double high;
    place at;
} range_value;

typedef struct instance {
    const mechanism *mechanism;
    const scene *scene;   /* NULL for a bare mechanism */
    const char *name;     /* scene's name, or the mechanism's, or another that was asked for */
    bool *with;           /* [effect_count] */
    const bool *conserve; /* [coordinate_count] to be recovered from their momentum, or NULL */
    bool ledger;          /* keep the books of energy and momentum */
    bool balance; /* the same where there are contacts and it can be done, to balance the run */
    double *parameter;            /* [parameter_count] SI */
    double *input;                /* [input_count] SI */
    const expr **parameter_given; /* what the values are of, */
    const expr **input_given;
    const expr ***start_given; /* NULL: nothing, which is 0 */
    double **start;            /* [coordinate_count][order] value, rate, ...: SI; order >= 2 */
    place **start_at;          /* like start: where it was given; no source where it was not */
    int *start_count;          /* [coordinate_count] entries in start[i] (2 for coordinates) */
    range_value *range;        /* [range_count] */
    int range_count;
    double step_s;         /* default 1e-3 */
    double until_s;        /* default 10 */
    folding_notes folding; /* of the expressions above */
    whole_ratio step;      /* step_s, as it was written */
    uint64_t steps;        /* to the end: until_s / step_s to the nearest, at most 2^63 */
    struct arena *arena;
} instance;

/* Which terms take part: those of the mechanism itself and of the effects in instance->with. */
bool instance_has_term(const instance *instance, const term *term);
/* The same of a contact of the mechanism. */
bool instance_has_contact(const instance *instance, const contact_statement *contact);
/* The same of a noise. */
bool instance_has_noise(const instance *instance, const noise *noise);

/* The effect that declared this parameter or input, where it takes no part in the instance; NULL where it
 * does, and for what belongs to no effect. */
const effect *instance_lacks(const instance *instance, const symbol *what);

/* Evaluate a scene (or, with scene NULL, the mechanism at rest at zero) to numbers. `changes` may be
 * NULL. Returns NULL on error, reported to `diags`. */
instance *instance_make(const mechanism *mechanism, const scene *scene, const overrides *changes,
                        diags *diags);
/* The same with parameters, inputs and initial values folded in the way that folding_way() tells; all else is that
 * of the first, which must outlive it. NULL where they are no finite numbers so. */
instance *instance_again(const instance *first);
void instance_free(instance *instance);

/* A time of the command line that is not the run's own, such as `--from 1.5 [s]`: seconds, at
 * least 0. `text` may name parameters, which have their values in the scene with its changes.
 * `what` is its name in messages. False on error, reported to `diags`. */
bool instance_duration(const mechanism *mechanism, const scene *scene, const overrides *changes,
                       const char *what, const char *text, diags *diags, double *seconds);

#endif
