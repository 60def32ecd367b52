/* image.h: one scene with its effects and settings, ready to run, to be written as code, or to be described. The image
 * has the complete result of the derivation in numbers, names and operation lists, for both number types. It has no
 * pointers to the model or the algebra. host/engine and host/emit read only the image.
 *
 * Arrays state their length in brackets. Units are SI, angles are in radians, and an `index` counts from 0. Texts are
 * never NULL. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "core/scene.h"
#include "host/base/diag.h"
#include "host/image/op_list.h"
#include "host/number/ratio.h"

enum { IMAGE_WAYS = 6 }; /* largest number of variants, see image.refolded */

#define IMAGE_COMPONENTS_MAX 64 /* second order: most coordinates; first order: most components */

/* Each setting below is a list of rows X(id, word). Options and descriptions use the word. */
#define IMAGE_ROW_ID(id, word) id,
#define IMAGE_ROW_WORD(id, word) word,
#define IMAGE_ROW_ONE(id, word) +1

/* ANGLES_LOOKUP: each stage computes the sines of turn angles. ANGLES_TURNED: if image_turns(), a step computes the
 * sines once, and its stages rotate the sines (core/step/stage_turn.h). */
#define IMAGE_ANGLES_ROWS(X) \
    X(ANGLES_TURNED, "turned") \
    X(ANGLES_LOOKUP, "lookup")
typedef enum image_angles { IMAGE_ANGLES_ROWS(IMAGE_ROW_ID) } image_angles;
enum { IMAGE_ANGLES = IMAGE_ANGLES_ROWS(IMAGE_ROW_ONE) };
extern const char *const image_angles_words[IMAGE_ANGLES];

/* A step of a linear mechanism may be one constant matrix (core/step/matrix_step.h). MATRIX_EXACT gives the exact
 * motion if the inputs are constant during the step. MATRIX_RK4 gives the same step as WH_RK4. */
#define IMAGE_MATRIX_ROWS(X) \
    X(MATRIX_NONE, "none") \
    X(MATRIX_EXACT, "exact") \
    X(MATRIX_RK4, "rk4")
typedef enum image_matrix_of { IMAGE_MATRIX_ROWS(IMAGE_ROW_ID) } image_matrix_of;
enum { IMAGE_MATRICES = IMAGE_MATRIX_ROWS(IMAGE_ROW_ONE) };
extern const char *const image_matrix_words[IMAGE_MATRICES];

/* TABLES_NONE: a step computes each function of a turn angle. TABLES_LINEAR and TABLES_CUBIC: a step interpolates
 * such functions in tables of one turn (core/step/table.h). */
#define IMAGE_TABLES_ROWS(X) \
    X(TABLES_NONE, "none") \
    X(TABLES_LINEAR, "linear") \
    X(TABLES_CUBIC, "cubic")
typedef enum image_tables { IMAGE_TABLES_ROWS(IMAGE_ROW_ID) } image_tables;
enum { IMAGE_TABLES_FORMS = IMAGE_TABLES_ROWS(IMAGE_ROW_ONE) };
extern const char *const image_tables_words[IMAGE_TABLES_FORMS];

/* cells of a table for one turn; powers of two */
enum { IMAGE_CELLS_LEAST = 8, IMAGE_CELLS_MOST = 65536 };

typedef struct image_settings {
    wh_method method;
    bool compensated;
    bool stabilized; /* corrects the drift that the ledger finds (core/step/stabilize.h) */
    image_angles angles;
    image_matrix_of matrix;
    image_tables tables;
    int cells; /* number of cells of a table of one turn: a power of two, or 0 for the default */
} image_settings;

#define IMAGE_SETTINGS_DEFAULT \
    { WH_METHOD_DEFAULT, false, false, ANGLES_TURNED, MATRIX_NONE, TABLES_NONE, 0 }

typedef enum image_role {
    /* result[i]: the acceleration of the scene's coordinate i. In first order: the derivative of image_component(i) */
    IMAGE_STEP,
    /* the outputs, then value and rate of each coordinate recovered from its momentum */
    IMAGE_OBSERVE,
    /* the highest derivative of each unknown; then BOOK_KINETIC, ... if `has_energies`; then the energy integral if
     * `has_integral` */
    IMAGE_BOOKS,
    IMAGE_SIGNALS, /* IMAGE_SIGNALS to IMAGE_SETS: for contacts (core/contact.h) */
    IMAGE_FORCES,
    IMAGE_SETS,
    IMAGE_POWERS, /* IMAGE_POWERS and IMAGE_LEVELS: for the ledger (core/ledger.h) */
    IMAGE_LEVELS,
    IMAGE_MATRIX, /* a whole step, for core/step/matrix_step.h */
    IMAGE_TABLES, /* result[k]: the function that a step's table k approximates */
    IMAGE_ROLES
} image_role;

/* Add image.count to get the index of a result of IMAGE_BOOKS. BOOK_MOMENTA is the first of image.count momenta. */
enum { BOOK_KINETIC, BOOK_STORED, BOOK_INPUT_POWER, BOOK_LOSS_POWER, BOOK_MOMENTA };

/* The unit in which a number is displayed, and its SI unit. */
typedef struct image_unit {
    const char *shown; /* "deg/s" */
    const char *si;    /* "rad/s" */
    double scale;      /* shown number = SI value * divisor / scale; in SI, scale == divisor */
    double divisor;
} image_unit;

/* An input, output or parameter. */
typedef struct image_quantity {
    const char *name;
    const char *text; /* the description in quotes, or "" */
    image_unit unit;
    double value; /* SI; 0 for an output */
    place at;     /* place of the declaration */
} image_quantity;

typedef struct image_effect {
    const char *name;
    const char *text;
    bool with; /* active */
} image_effect;

/* A coordinate of a mechanism, or an unknown of a system given by equations. */
typedef struct image_unknown {
    const char *name;
    const char *text;
    place at;
    bool is_angle;           /* declared in an angle's unit */
    bool is_length;          /* the unit is a length */
    bool conserved;          /* the momentum of this unknown is constant */
    bool driven;             /* the unknown follows an input with a rate, and has no momentum */
    int order;               /* order of the highest derivative */
    image_unit *unit;        /* [order + 1] of the value, the rate, ... */
    const char *momentum_si; /* unit of the unknown's momentum */
    int starts;              /* number of start values: the order, but at least 2 */
    double *start;           /* [starts] value, rate, ... */
    place *start_at;         /* [starts] place of the value; `source` is NULL for a default */
    bool start_written;      /* the file gives start[0] without a sum or call */
} image_unknown;

/* An input with a rate. During a step, the components real[value_at] and real[rate_at] are its value and rate. */
typedef struct image_drive {
    int input;
    int rate; /* index of the rate, which is also an input */
    int value_at;
    int rate_at;
    bool rate_moves; /* the rate has a rate, too */
} image_drive;

/* The unknown of a component of the state, and the order of its derivative. */
typedef struct component {
    int unknown;
    int primes;
} component;

/* The range of a real component or of an input, for fixed point. */
typedef struct image_range {
    const char *name; /* "theta'" */
    place at;         /* place of the declared range, else of the symbol */
    bool declared;
    double low; /* SI; only if `declared` is true */
    double high;
} image_range;

typedef struct image_contact {
    int kind;              /* wh_contact_kind */
    const char *word;      /* word of the statement: "stop", "hold", ... */
    const char *undefined; /* subject of an error: "the normal force of this friction" */
    int direction;
    int pin;
    int first_set;
    int sets;
    const char *unit; /* SI unit of a stop's gap; "1" for other kinds */
    place at;
    int first_question, questions; /* range of the contact's questions in diagnostics.question */
    int first_late, late;          /* range of its questions that matter only at an impact */
} image_contact;

typedef enum ledger_kind {
    LEDGER_WORK,     /* Q q' of a generalized force, or the power of an input's drive */
    LEDGER_LOSS,     /* -sum dF/dq' q' of a damper */
    LEDGER_ENERGIES, /* dL/dq_i */
    LEDGER_DRIVE,    /* a generalized force on coordinate i */
    LEDGER_DAMPING   /* -dF/dq_i' of a damper */
} ledger_kind;

typedef struct image_entry {
    ledger_kind kind;
    int account;
    place at; /* place of the term in the source; none for LEDGER_ENERGIES */
} image_entry;

typedef struct image_ledger {
    bool kept;          /* the run has a ledger */
    bool asked;         /* `with ledger` or stabilization requests the ledger */
    int smooth;         /* number of smooth entries (core/ledger.h) */
    int entries;        /* number of all entries */
    int accounts;       /* 1 + unknowns: the energy, then the momenta */
    int inputs;         /* number of inputs on which the energies depend */
    bool turned;        /* IMAGE_POWERS reads angles with all their turns */
    image_entry *entry; /* [smooth] */
    int *unknown;       /* [accounts] index of the momentum's unknown; -1 for the energy */
    int *input;         /* [inputs] indices of the image's inputs */
} image_ledger;

/* Operations of the file's expressions. Constants are not folded, so that a message can point at the undefined part. */
typedef enum diagnostics_code {
    DIAGNOSTICS_NUMBER, /* number */
    DIAGNOSTICS_STATE,  /* derivative b of unknown a */
    DIAGNOSTICS_INPUT,  /* input a of the image */
    DIAGNOSTICS_SAME,   /* the value of node a */
    DIAGNOSTICS_ADD,
    DIAGNOSTICS_SUB,
    DIAGNOSTICS_MUL,
    DIAGNOSTICS_DIV,
    DIAGNOSTICS_POW,
    DIAGNOSTICS_NEG,
    DIAGNOSTICS_CALL /* function(a, b), or function(a) if b is negative */
} diagnostics_code;

typedef struct diagnostics_node {
    diagnostics_code code;
    function_id function;
    int a; /* a and b: indices of earlier nodes, unless diagnostics_code says otherwise */
    int b;
    double number;
    place at; /* place in the file; `source` is NULL in a derived expression */
} diagnostics_node;

/* A number that must be finite; if it is not, a message names `what` in the statement at `where`. */
typedef struct diagnostics_question {
    int node;
    bool derived; /* the node is a derivative, which the file does not contain */
    const char *what;
    place where;
} diagnostics_question;

typedef struct image_diagnostics {
    diagnostics_node *node; /* [nodes] */
    int nodes;
    diagnostics_question *question; /* [questions] about terms, then sets, then contacts */
    int questions;
    int terms; /* number of questions about energies, losses, forces and equations */
    int sets;  /* number of questions about values that crossings set */
} image_diagnostics;

/* A step x+ = Phi x + Gamma u + g of the state x (angles first) with the inputs u, in SI units and radians. */
typedef struct image_matrix {
    int states;
    int columns;   /* those of Phi, then of Gamma, then g */
    double *entry; /* [states * columns] row by row, rounded to the nearest double */
} image_matrix;

typedef struct image {
    struct arena *memory;
    /* the image that owns the lists and must outlive this image. NULL if this image owns them */
    const struct image *base;

    const char *name; /* name of the scene; without a scene, of the mechanism */
    const char *title;
    const char *mechanism;
    place mechanism_at;
    place at; /* place of the scene; without a scene, of the mechanism */
    image_effect *effect;
    int effects;

    image_settings settings;
    double step_s;
    whole_ratio step;
    uint64_t steps; /* number of steps to the end */
    double until_s;

    wh_form form;
    int count;        /* number of unknowns */
    int coordinates;  /* second order: number of integrated coordinates, angles included */
    int angles;       /* components stored as turn angles */
    int reals;        /* components stored as reals */
    int inputs;       /* inputs of the mechanism and of the active effects */
    int own_outputs;  /* number of the mechanism's outputs */
    int outputs;      /* own_outputs, plus value and rate of each recovered coordinate */
    int recovered;    /* coordinates recovered from their momentum */
    int parameters;   /* parameters of the mechanism and of the active effects */
    double mass_blur; /* relative error of the accelerations from rounding the mass matrix */
    /* [ways] variants: the same scene with other constant folding (host/number/folding.h) */
    struct image *refolded[IMAGE_WAYS];
    int ways;               /* 0 if folding lost no digits */
    struct image *finer;    /* image of step doubling's finer run; NULL if it is this image */
    bool unbounded;         /* a variant failed: a constant was not finite */
    image_unknown *unknown; /* [count] */
    component *angle;       /* [angles] */
    component *real;        /* [reals] */
    int *place;             /* [count] second order: index of the integrated coordinate, or -1 */
    int *from_momentum;     /* [recovered] indices of unknowns */
    image_quantity *input;  /* [inputs] with the value at the start */
    image_drive *drive;     /* [drives] */
    int drives;
    image_quantity *output;    /* [own_outputs] */
    image_quantity *parameter; /* [parameters] */

    double *start_rad;    /* [angles] */
    int64_t *start_turns; /* [angles] the start in units of 2^-32 turn; 0 if not representable */
    double *start_real;   /* [reals] */

    image_range *range; /* [reals + inputs] components, then inputs */
    /* [angles] declared ranges of turn angles, which fixed point ignores */
    image_range *angle_range;
    /* plan of a run in fixed point (host/fixed), or NULL. The image does not own it. */
    const struct fixed_plan *fixed;

    bool has_energies; /* the scene is given by energies, not by equations */
    bool has_integral; /* the energy integral is not T + V (host/derive/equations.h) */

    image_contact *contact; /* [contacts] crossings come last */
    int contacts;
    int forced;    /* contacts with a force: all but crossings */
    int held;      /* number of holds without a pin */
    int set_count; /* values that crossings set */
    int *target;   /* [set_count] component of the state, angles first */
    image_ledger ledger;
    image_diagnostics diagnostics; /* empty in an image for writing (IMAGE_TO_WRITE) */

    image_matrix matrix; /* empty unless settings.matrix requests one */

    uint64_t hash;              /* hash of the equations of motion */
    op_list *list[IMAGE_ROLES]; /* NULL for a missing list */
} image;

void image_free(image *im); /* `im` may be NULL */

/* Writes the settings of the finer run (host/check/step_doubling.h): a copy of *of without tables. If of->matrix is
 * MATRIX_EXACT, the finer run compensates its sums. Returns false if *finer equals *of. */
bool image_settings_finer(const image_settings *of, image_settings *finer);

component image_component(const image *im, int i); /* angles come first */
/* Returns the index of the component that is this derivative of this unknown, or -1. */
int image_find_component(const image *im, int unknown, int primes);

/* Returns the kind of matrix, or the method's title if settings.matrix is MATRIX_NONE. */
const char *image_stepper(const image *im);
/* Returns "", or words to print after image_stepper(), such as " compensated, stabilized". */
const char *image_sums(const image *im);

/* Converts an SI value to the displayed unit. image_shows_si(): is this unit the SI unit? */
double image_shown(const image_unit *unit, double si);
bool image_shows_si(const image_unit *unit);

/* Writes the initial value of each input to input[inputs]. */
void image_inputs(const image *im, double *input);
/* Returns the initial value of component i. Angles (rad) come first. */
double image_start(const image *im, int i);

/* Does generated code call functions of core/function.h? */
bool image_calls(const image *im);

/* Returns a constant of the equations, or an input, that is neither zero nor a normal float; 0 if there is none. */
double image_out_of_float(const image *im);

/* === memory =================================================================================== */
/* WH_MEMORY_BYTES() for each number type, on this machine. Pointers and alignment differ on a board. */

size_t memory_float_bytes(const image *im);
size_t memory_double_bytes(const image *im);

/* === sines of turn angles ===================================================================== */

#define TURNED_WAVES_MAX 256 /* a step rotates the sines of at most so many phases */

/* Does a step rotate its sines instead of computing them at each stage? Interpreter and generated code both ask this
 * function, so that they agree. */
bool image_turns(const image *im);

#endif
