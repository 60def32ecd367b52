/* image.h: one scene, ready to run, to be written as code or to be described: all that is known of it when
 * its derivation has ended, in numbers, names and operation lists.
 *
 * One image is one scene with its effects and settings, for both numbers. It points into nothing but itself: the
 * language and the algebra that it came from may be gone (host/derive/image_make.h makes it). What runs (host/run) and
 * what writes code or describes (host/emit) reads this and nothing else. Arrays say their length in brackets; units
 * are SI, angles radians; an `index` counts from 0. All text is never NULL.
 *
 * Room for more: a list that is added gets a role; what is known of each operation of a list (its range) stands
 * beside that list, by role; what is known of a parameter stands in its row. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "core/scene.h"
#include "host/base/diag.h"
#include "host/number/ratio.h"
#include "tape.h"

/* So many other ways of folding numbers are asked, at most. */
enum { IMAGE_WAYS = 6 };

/* Most coordinates of a mechanism, or first-order components of a system. */
#define IMAGE_COMPONENTS_MAX 64

/* Where a stage's sines of turn angles come from: they are looked up once a step and turned on (core/stage_turn.h),
 * where that can be, or looked up at each stage (core/step.h). */
#define IMAGE_ANGLES_ROWS(X) \
    X(ANGLES_TURNED, "turned") \
    X(ANGLES_LOOKUP, "lookup")
#define IMAGE_ANGLES_NAME(id, word) id,
typedef enum image_angles { IMAGE_ANGLES_ROWS(IMAGE_ANGLES_NAME) } image_angles;
#undef IMAGE_ANGLES_NAME
#define IMAGE_ANGLES_ONE(id, word) +1
enum { IMAGE_ANGLES = IMAGE_ANGLES_ROWS(IMAGE_ANGLES_ONE) };
#undef IMAGE_ANGLES_ONE
/* Their words on command lines and in descriptions. */
extern const char *const image_angles_words[IMAGE_ANGLES];

/* A whole step as one constant matrix (core/matrix_step.h), of a mechanism that is linear: no, the exact motion with
 * inputs held over the step, or what WH_RK4 makes of it. */
#define IMAGE_MATRIX_ROWS(X) \
    X(MATRIX_NONE, "none") \
    X(MATRIX_EXACT, "exact") \
    X(MATRIX_RK4, "rk4")
#define IMAGE_MATRIX_NAME(id, word) id,
typedef enum image_matrix_of { IMAGE_MATRIX_ROWS(IMAGE_MATRIX_NAME) } image_matrix_of;
#undef IMAGE_MATRIX_NAME
#define IMAGE_MATRIX_ONE(id, word) +1
enum { IMAGE_MATRICES = IMAGE_MATRIX_ROWS(IMAGE_MATRIX_ONE) };
#undef IMAGE_MATRIX_ONE
/* Their words on command lines and in descriptions. */
extern const char *const image_matrix_words[IMAGE_MATRICES];

/* What the accelerations owe to the one turn angle that they depend on: computed, or looked up in tables of its turn
 * (core/table.h), between whose entries it is interpolated so. */
#define IMAGE_TABLES_ROWS(X) \
    X(TABLES_NONE, "none") \
    X(TABLES_LINEAR, "linear") \
    X(TABLES_CUBIC, "cubic")
#define IMAGE_TABLES_NAME(id, word) id,
typedef enum image_tables { IMAGE_TABLES_ROWS(IMAGE_TABLES_NAME) } image_tables;
#undef IMAGE_TABLES_NAME
#define IMAGE_TABLES_ONE(id, word) +1
enum { IMAGE_TABLES_FORMS = IMAGE_TABLES_ROWS(IMAGE_TABLES_ONE) };
#undef IMAGE_TABLES_ONE
extern const char *const image_tables_words[IMAGE_TABLES_FORMS];

/* Cells of such a table, a turn: powers of two. */
enum { IMAGE_CELLS_LEAST = 8, IMAGE_CELLS_MOST = 65536 };

/* How to integrate. */
typedef struct image_settings {
    wh_method method;
    bool compensated;
    bool stabilized; /* give back what the energy drifts by (core/stabilize.h): wants the books */
    image_angles angles;
    image_matrix_of matrix;
    image_tables tables;
    int cells; /* of a table, a turn: a power of two; 0: as many as its form takes by itself */
} image_settings;

/* What is integrated with unless something else is asked for. */
#define IMAGE_SETTINGS_DEFAULT \
    { WH_METHOD_DEFAULT, false, false, ANGLES_TURNED, MATRIX_NONE, TABLES_NONE, 0 }

/* --- the lists -----------------------------------------------------------------------------------*/

typedef enum image_role {
    IMAGE_STEP, /* second order: result[i] is the acceleration of the scene's coordinate i; first order:
                    * the slope of component i, angles first */
    IMAGE_OBSERVE, /* the outputs, then value and rate of each coordinate recovered from its momentum */
    IMAGE_BOOKS, /* highest derivatives (by unknown); of a mechanism with energies also what image_book
                  * names, the momenta (by unknown) and, where there is one, the energy integral */
    IMAGE_SIGNALS, /* of the contacts, as core/contact.h wants them: the next three */
    IMAGE_FORCES,
    IMAGE_SETS,
    IMAGE_POWERS, /* of the ledger, as core/ledger.h wants them: the last two */
    IMAGE_LEVELS,
    IMAGE_MATRIX, /* a whole step, as core/matrix_step.h wants it */
    IMAGE_TABLES, /* what the tables of a step hold, exactly: result[k] is that of table k */
    IMAGE_ROLES
} image_role;

/* In IMAGE_BOOKS, behind the highest derivatives. */
enum { BOOK_KINETIC, BOOK_STORED, BOOK_INPUT_POWER, BOOK_LOSS_POWER, BOOK_MOMENTA };

/* --- names, units, places ------------------------------------------------------------------------*/

/* The unit in which people read a number, and the SI unit that it has here. */
typedef struct image_unit {
    const char *shown; /* "deg/s" */
    const char *si;    /* "rad/s" */
    double scale;      /* number shown = SI * divisor / scale; 1 and 1 where it is shown in SI */
    double divisor;
} image_unit;

/* An input, output or parameter. */
typedef struct image_quantity {
    const char *name;
    const char *text; /* the description in quotes, or "" */
    image_unit unit;
    double value; /* SI; of an output 0 */
    place at;     /* where it was declared */
} image_quantity;

typedef struct image_effect {
    const char *name;
    const char *text;
    bool with; /* takes part */
} image_effect;

/* A coordinate, or an unknown of a system given outright. */
typedef struct image_unknown {
    const char *name;
    const char *text;
    place at;
    bool is_angle;           /* declared as one */
    bool is_length;          /* so that its momentum over time is a force */
    bool conserved;          /* nothing changes its momentum */
    bool driven;             /* an input with a rate: it has none */
    int order;               /* of its highest derivative */
    image_unit *unit;        /* [order + 1] of the value, the rate, ... */
    const char *momentum_si; /* unit of its momentum */
    int starts;              /* order, or 2 when that is more */
    double *start;           /* [starts] value, rate, ... */
    place *start_at;         /* [starts] where it was given; no source where it was not */
    bool
        start_written; /* its value is a product of numbers as they are written: no sum's rounding */
} image_unknown;

/* An input with a rate, which two components of the state follow inside a step: places in real[]. */
typedef struct image_drive {
    int input;
    int rate; /* an input, too */
    int value_at;
    int rate_at;
} image_drive;

/* Which unknown, and which of its derivatives, a component of the state is. */
typedef struct component {
    int unknown;
    int primes;
} component;

/* Of a component kept as a real, or an input: what it keeps to in fixed point. */
typedef struct image_range {
    const char *name; /* "theta'" */
    place at;         /* of the range, or of what it would be of */
    bool declared;
    double low; /* SI; of what is declared */
    double high;
} image_range;

/* --- contacts and ledger ---------------------------------------------------------------------------*/

typedef struct image_contact {
    int kind;         /* wh_contact_kind */
    const char *word; /* of the statement: "stop", "hold", ... */
    const char *
        undefined; /* what of it may be no number: "the condition of this hold, or what it holds," */
    int direction;
    int pin;
    int first_set;
    int sets;
    const char *unit; /* SI, of a stop's gap; "1" for others */
    place at;
    /* In the blame list: what may have no value, and what counts only at an impact. */
    int first_question, questions;
    int first_late, late;
} image_contact;

typedef enum ledger_kind {
    LEDGER_WORK,     /* Q q' of a generalized force */
    LEDGER_LOSS,     /* -sum dF/dq' q' of a damper */
    LEDGER_ENERGIES, /* dL/dq_i */
    LEDGER_DRIVE,    /* a generalized force on coordinate i */
    LEDGER_DAMPING   /* -dF/dq_i' of a damper */
} ledger_kind;

typedef struct image_entry {
    ledger_kind kind;
    int account;
    place at; /* of the term; no source for LEDGER_ENERGIES */
} image_entry;

typedef struct image_ledger {
    bool kept;  /* books are kept, */
    bool asked; /* by `with ledger`: else they only balance the run */
    int smooth; /* entries of what goes on while nothing happens */
    int entries; /* smooth, then for each contact its energy and its impulse by coordinate, then inputs */
    int accounts;       /* 1 + unknowns: the energy, then the momenta */
    int inputs;         /* those that the energies name: their changes are the last entries */
    bool turned;        /* a power names a turn angle outside sines and cosines */
    image_entry *entry; /* [smooth] */
    int *unknown;       /* [accounts] whose momentum an account is; -1 for the energy */
    int *input;         /* [inputs] numbers of the image's inputs */
} image_ledger;

/* --- what is to blame ------------------------------------------------------------------------------*/

/* The expressions of the file, operation by operation as they were written, so that a message can point at the one
 * that has no value: nothing is folded or shared that stands at two places. */
typedef enum blame_code {
    BLAME_NUMBER, /* number */
    BLAME_STATE,  /* unknown a, its derivative b */
    BLAME_INPUT,  /* input a of the image */
    BLAME_SAME,   /* node a: a name for it */
    BLAME_ADD,
    BLAME_SUB,
    BLAME_MUL,
    BLAME_DIV,
    BLAME_POW,
    BLAME_NEG,
    BLAME_CALL /* function(a) or function(a, b); b < 0: 0 */
} blame_code;

typedef struct blame_node {
    blame_code code;
    function_id function;
    int a; /* nodes before this one, but for states and inputs */
    int b;
    double number;
    place at; /* no source in what was derived from an expression */
} blame_node;

/* Is this a finite number? If not, `what` is to be told of the statement at `where`. */
typedef struct blame_question {
    int node;
    bool derived; /* a slope: only the statement can be blamed, not a part of it */
    int power;    /* of the state that it has at most where a mechanism is linear; of terms only */
    const char *what;
    place where;
} blame_question;

typedef struct image_blame {
    blame_node *node; /* [nodes] */
    int nodes;
    blame_question *question; /* [questions]: those of terms, of sets, then of contacts */
    int questions;
    int terms; /* energies, losses, forces, equations, and their slopes */
    int sets;  /* values that crossings set */
} image_blame;

/* --- a step as a matrix ------------------------------------------------------------------------------*/

/* x+ = Phi x + Gamma u + g: `states` rows, angles first; columns: states, inputs, 1. Angles in radians; SI units. */
typedef struct image_matrix {
    int states;
    int columns;
    double *entry; /* [states * columns] row by row, the nearest doubles */
} image_matrix;

/* --- the image ---------------------------------------------------------------------------------------*/

typedef struct image {
    struct arena *memory;
    const struct image
        *base; /* whose lists these are; NULL: its own. It must not go before this one */

    const char *name; /* the scene's, or the mechanism's */
    const char *title;
    const char *mechanism;
    place mechanism_at;
    place at; /* the scene's, or the mechanism's */
    image_effect *effect;
    int effects;

    image_settings settings;
    double step_s;
    whole_ratio step;
    uint64_t steps; /* to the end */
    double until_s;

    wh_form form;
    int count;        /* unknowns */
    int coordinates;  /* integrated coordinates, angles included (second order) */
    int angles;       /* components kept as turn angles */
    int reals;        /* components kept as reals */
    int inputs;       /* the mechanism's own and those of the effects called for */
    int own_outputs;  /* the mechanism's */
    int outputs;      /* those, then value and rate of each recovered coordinate */
    int recovered;    /* coordinates that follow from their momentum */
    int parameters;   /* the mechanism's own and those of the effects called for */
    double mass_blur; /* by such a part rounding of the mass matrix puts accelerations off */
    bool mass_moves;  /* it depends on where the mechanism is, or on an input */
    /* Where digits were lost in folding: the same folded in other ways (host/number/folding.h), for their lists. */
    struct image *otherwise[IMAGE_WAYS];
    int ways;
    bool unbounded;         /* folded so, one of the file's numbers is none */
    image_unknown *unknown; /* [count] */
    component *angle;       /* [angles] */
    component *real;        /* [reals] */
    int *
        place; /* [count] unknown -> coordinate number in the scene's order, or -1 (second order) */
    int *from_momentum;    /* [recovered] unknown */
    image_quantity *input; /* [inputs] with the value at the start */
    image_drive *drive;    /* [drives] */
    int drives;
    image_quantity *output;    /* [own_outputs] */
    image_quantity *parameter; /* [parameters] */

    double *start_rad; /* [angles] */
    int64_t *
        start_turns; /* [angles] the same as float keeps it: 2^32 a turn; 0 where that holds it not */
    double *start_real; /* [reals] */

    image_range *range;       /* [reals + inputs] components, then inputs */
    image_range *angle_range; /* [angles] of which nothing takes one */
    const struct fixed_plan
        *fixed; /* of a run in fixed point (host/fixed), which is not the image's; or NULL */

    bool has_energies; /* not a system given outright */
    bool has_integral; /* the energy that is booked is not T + V (host/derive/equations.h) */

    image_contact *contact; /* [contacts] crossings come last */
    int contacts;
    int forced;    /* contacts that have a force: all but crossings */
    int held;      /* holds without a pin */
    int set_count; /* values that crossings set */
    int *target;   /* [set_count] component of the state, angles first */
    image_ledger ledger;
    image_blame blame; /* empty unless it was asked for */

    image_matrix matrix; /* empty unless settings.matrix asks for one */

    uint64_t hash;           /* of what moves it */
    tape *list[IMAGE_ROLES]; /* NULL where there is none */
} image;

void image_free(image *im); /* NULL is fine */

/* Component i of the state: angles first. */
component image_component(const image *im, int i);
/* Which of them is this derivative of this unknown; -1: none. */
int image_find_component(const image *im, int unknown, int primes);

/* What steps it, in words: the method's title, or which matrix. */
const char *image_stepper(const image *im);
/* Behind that: " compensated", " stabilized", both, or "". */
const char *image_sums(const image *im);

/* The number that people read of an SI value, and whether that is the value itself. */
double image_shown(const image_unit *unit, double si);
bool image_shows_si(const image_unit *unit);

/* The inputs as the run starts, input[inputs]; and where its component i does: angles, in radians, then reals. */
void image_inputs(const image *im, double *input);
double image_start(const image *im, int i);

/* Does what runs on a board call functions of core/function.h? */
bool image_calls(const image *im);

/* The first constant of what moves the scene, or input, that float has no room for, or 0: a run in float would go
 * on with a digit or two of it, or with nothing. */
double image_out_of_float(const image *im);

#endif
