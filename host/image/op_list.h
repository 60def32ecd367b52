/* op_list.h: the operation list: a model's right-hand side as a table of elementary operations. One list serves the
 * interpreter (host/engine) and the generated C and Octave (host/emit). Each operation is one IEEE operation on earlier
 * results, so interpreter and C give the same bits. Equal operations are entered once. Constants are folded. */
#ifndef IMAGE_OP_LIST_H
#define IMAGE_OP_LIST_H

#include <stdbool.h>
#include <stdint.h>

#include "host/number/folding.h"

/* === the operations =========================================================================== */
/* The table of operations. Code that lists the operations uses these rows, or switches over op_code with -Wswitch-enum.
 * value_at() in op_list_scaling.c evaluates each operation without such a switch.
 *
 * X(id, kind, cost, C, Octave, meaning)
 *
 *   id      its constant is OP_id. Hashes of models depend on the order: add a new row at the end.
 *   kind    OP_IS_kind gives the meaning of a and b.
 *   cost    OP_COSTS_cost.
 *   C, Octave  its right-hand side in generated code, or NULL if it is not written. A dollar sign marks a placeholder:
 *           a, b   the operands.
 *           f, o   the called function, and its operands, separated by commas.
 *           n      a test for b being NaN: " || b != b", or nothing if b is a constant.
 *           i      the number in a.
 *           v      the value, a whole number.
 *           l, r, u   in Octave: the linear component, rate or input with the number a. */

/* clang-format off */
#define OP_ROWS(X) \
    X(CONSTANT, CONSTANT, NOTHING, NULL, NULL, "value: stands in place") \
    X(LINEAR, LEAF, NOTHING, "linear[$i]", "y($l)", \
      "real component a: a linear position (second order), any real (first order)") \
    X(RATE, LEAF, NOTHING, "rate[$i]", "y($r)", "rate of coordinate a (second order only)") \
    X(INPUT, LEAF, NOTHING, "input[$i]", "u_$u", "input a") \
    X(ACCEL, LEAF, NOTHING, "accel[$i]", NULL, \
      "acceleration of coordinate a, contact forces in it: for records") \
    X(TIME, LEAF, NOTHING, "wh_scene_time_s(scene, state)", NULL, \
      "time, s: for records, never in a step") \
    X(RADIANS, LEAF, NOTHING, "wh_angle_to_rad(angle[$i])", NULL, \
      "unwrapped angle a in radians: for records, never in a step") \
    X(NOISE, LEAF, NOTHING, "wh_noise($vU, state->steps)", NULL, \
      "Gaussian deviate with seed `value` at this step: for records, never in a step") \
    X(PHASE, PHASE, WAVE, NULL, NULL, \
      "sum turns[i]*phase[i] + sum parts[i]*angle[i] + value [rad] + (radians from b, if b >= 0)") \
    X(SIN, WAVE, NOTHING, "s$i", "sin($a)", "sine of phase a") \
    X(COS, WAVE, NOTHING, "c$i", "cos($a)", "cosine of phase a") \
    X(ADD, BINARY, ARITHMETIC, "$a + $b", "$a + $b", "") \
    X(SUB, BINARY, ARITHMETIC, "$a - $b", "$a - $b", "") \
    X(MUL, BINARY, ARITHMETIC, "$a * $b", "$a * $b", "") \
    X(DIV, BINARY, DIVISION, "$a / $b", "$a / $b", "") \
    X(NEG, UNARY, ARITHMETIC, "-$a", "-$a", "") \
    X(SQRT, UNARY, ROOT, "WH_SQRT($a)", "sqrt($a)", "") \
    X(ABS, UNARY, ARITHMETIC, "WH_ABS($a)", "abs($a)", "") \
    X(SIGN, UNARY, ARITHMETIC, \
      "$a == $a ? (wh_real)(($a > WH_R(0.0)) - ($a < WH_R(0.0))) : $a", "sign($a)", \
      "this, MIN and MAX give NaN of NaN: nothing that is no number may vanish in a comparison") \
    X(MIN, BINARY, ARITHMETIC, "$b < $a$n ? $b : $a", "min($a, $b)", "b < a || b != b ? b : a") \
    X(MAX, BINARY, ARITHMETIC, "$b > $a$n ? $b : $a", "max($a, $b)", "b > a || b != b ? b : a") \
    X(CALL, CALL, CALL, "wh_$f($o)", "$f($o)", "function(a) or function(a, b), of core/function.h") \
    X(POW, BINARY, CALL, "wh_pow($a, $b)", "$a ^ $b", "a to the b, likewise") \
    X(CELL, CELL, NOTHING, NULL, NULL, "the cell of the list's tables that phase sum turns[i]*phase[i] is in") \
    X(LINE, LOOKUP, LINE, "wh_table_linear(&row$i[$v], y$i)", NULL, \
      "in cell a, the table whose numbers begin at `value`: linear, core/step/table.h") \
    X(CUBIC, LOOKUP, CUBIC, "wh_table_cubic(&row$i[$v], y$i)", NULL, "likewise, cubic")
/* clang-format on */

#define OP_ID(id, ...) OP_##id,
typedef enum op_code { OP_ROWS(OP_ID) } op_code;
#undef OP_ID

#define OP_ONE(...) +1
enum { OPS = 0 OP_ROWS(OP_ONE) }; /* number of operations */
#undef OP_ONE

typedef enum op_kind {
    OP_IS_CONSTANT,
    OP_IS_LEAF,   /* a is an index, or unused */
    OP_IS_PHASE,  /* b is an operation or -1 */
    OP_IS_WAVE,   /* a is a phase */
    OP_IS_UNARY,  /* a is an operation */
    OP_IS_BINARY, /* a and b are operations */
    OP_IS_CALL,   /* a is an operation; b is an operation or -1 */
    OP_IS_CELL,   /* neither a nor b is an operation */
    OP_IS_LOOKUP  /* a is a cell */
} op_kind;

typedef enum op_cost {
    OP_COSTS_NOTHING,
    OP_COSTS_ARITHMETIC,
    OP_COSTS_DIVISION,
    OP_COSTS_ROOT,
    OP_COSTS_WAVE,
    OP_COSTS_CALL,
    OP_COSTS_LINE, /* looked up in a table, and interpolated */
    OP_COSTS_CUBIC
} op_cost;

typedef struct op_row {
    op_kind kind;
    op_cost cost;
    /* number of earlier values that the operation uses: 2 (a and b), 1 (a), 0 for a leaf or a phase */
    int values;
    const char *c;      /* NULL: not written in C */
    const char *octave; /* NULL: not written in Octave */
} op_row;

extern const op_row op_rows[OPS]; /* [op_code] */

typedef struct op {
    op_code code;
    function_id function; /* OP_CALL */
    int a;
    int b;
    double value;     /* OP_CONSTANT, OP_PHASE, OP_NOISE, OP_LINE, OP_CUBIC */
    const int *turns; /* OP_PHASE, OP_CELL: [angles] integer factors of the angles, or NULL */
    /* OP_PHASE: [angles] fractional factors of unwrapped angles, or NULL. Only lists for records have them. */
    const double *parts;
} op;

/* Tables as in core/step/table.h, but WH_TABLE_B(), WH_TABLE_C() and WH_TABLE_D() are not yet applied. */
typedef struct op_list_tables {
    int count;
    int bits;       /* 2^bits cells */
    int terms;      /* numbers in a cell of one table: WH_TABLE_LINEAR, WH_TABLE_CUBIC */
    double *number; /* [2^bits][count][terms], in the list's arena */
    double *size;   /* [count]: largest absolute value of a table */
    double *off;    /* [count]: largest interpolation error of a table, without round-off */
    bool folds;     /* each table is an even or an odd function, and only half of it is stored */
    bool *odd;      /* [count]: true for an odd table, false for an even one */
} op_list_tables;

typedef struct op_list {
    op *ops;
    int count;
    int room;
    int angles; /* number of turn angles, and length of each array `turns` */
    int *index; /* hash table of the operations */
    int index_size;
    int *result; /* operation numbers of the list's results */
    int results;
    op_list_tables tables; /* without tables: all zero */
    struct arena *arena;
    folding *folding; /* of the constants while the list is made; may be NULL */
} op_list;

op_list *op_list_new(int angles, int results);
void op_list_free(op_list *t);

int op_list_constant(op_list *t, double value);
int op_list_leaf(op_list *t, op_code code, int which);
int op_list_noise(op_list *t, uint32_t seed);
/* Enters `offset_rad` + sum of multiple[k] * turn angle k + value of operation `radians` (-1: none), in radians.
 * multiple[t->angles] may be NULL. If op_list_is_whole(multiple[k]), angle k is taken modulo a turn, else unwrapped. */
int op_list_phase(op_list *t, const double *multiple, double offset_rad, int radians);
/* Can a phase be multiplied by this number? It must be a whole number within bounds. */
bool op_list_is_whole(double multiple);
void op_list_tables_new(op_list *t, int count, int bits, int terms); /* all entries are zero */
/* Enters an OP_CELL: the table cell in which the sum of turns[k] * turn angle k lies. */
int op_list_cell(op_list *t, const int *turns);
int op_list_look_up(op_list *t, int cell, int which);
int op_list_unary(op_list *t, op_code code, int a);
int op_list_add(op_list *t, int a, int b);
int op_list_sub(op_list *t, int a, int b);
int op_list_mul(op_list *t, int a, int b);
int op_list_div(op_list *t, int a, int b);
/* Enters function(a, b), or function(a) if b is -1. */
int op_list_call(op_list *t, function_id function, int a, int b);
int op_list_pow(op_list *t, int base, int exponent);
/* Enters base to a fixed power, by products and square roots if possible. */
int op_list_power(op_list *t, int base, double exponent);
bool op_list_is_constant(const op_list *t, int a, double *value);

/* Returns the language's function that the operation computes, or FUNCTION_NONE. */
function_id op_list_function(const op *o);

/* Returns the operation with this code and operands, or -1 if there is none yet. */
int op_list_find_binary(const op_list *t, op_code code, int a, int b);

/* Rebuilds the hash table after operations were moved. */
void op_list_reindex(op_list *t);
uint64_t op_list_op_hash(const op_list *t, const op *o);

/* Writes the operations that `o` uses, including a phase's `radians`, to operand[]. Returns their number. */
int op_list_operands(const op *o, int operand[static 2]);
/* Sets needed[i] for operation `number` and all operations on which it depends. All entries must be false before. */
void op_list_mark_needed(const op_list *t, int number, bool *needed);
bool op_list_has(const op_list *t, op_code code); /* false for a NULL list */
/* Has the list an operation with a kink or a jump? */
bool op_list_has_kinks(const op_list *t);

/* Removes operations that no result uses, and renumbers the others. */
void op_list_prune(op_list *t);
/* Saves products: writes a + 2 b as (a + b) + b if the list has a + b. Removes operations that become unused. */
void op_list_share_sums(op_list *t);
/* Reorders a finished list so that few values are live at a time, if that lowers op_list_carried(). No bit of the
 * results changes; phases stay in their order. */
void op_list_order(op_list *t);
/* Estimates the least number of loads and stores in the list's order, with some twenty registers. */
int op_list_carried(const op_list *t);

/* Does the list use unwrapped angles? A step has angles only modulo a turn. */
bool op_list_reads_turns(const op_list *t);

/* A wave: a phase composed of turn angles, which a step can rotate (core/step/stage_turn.h). */
static inline bool op_list_is_wave(const op *o) { return o->code == OP_PHASE && o->turns != NULL; }
int op_list_waves(const op_list *t);
/* Can a step pass the waves' sine-cosine pairs to the list? Each wave must be a sum of turn angles and a number. */
bool op_list_takes_waves(const op_list *t);

/* Returns the index of the first result that depends on an infinite or NaN constant; -1 if there is none. */
int op_list_not_finite(const op_list *t);

/* Is the number zero, or a normal float? */
bool fits_float(double value);
/* Returns the first constant that is neither zero nor a normal float, or 0. */
double op_list_out_of_float(const op_list *t);

typedef struct op_list_cost {
    int arithmetic; /* additions, subtractions, products, negations, comparisons */
    int divisions;
    int roots;
    int waves;    /* number of phases; sine and cosine of a phase count as one */
    int calls;    /* calls of core/function.h */
    int look_ups; /* in tables; the interpolation counts as arithmetic */
} op_list_cost;

op_list_cost op_list_count(const op_list *t);
/* Estimated instructions on a Cortex-M4F, for comparing lists. */
int op_list_weight(const op_list *t);
/* Counts the operations as flops: without leaves, phases and constants; a sine and a cosine count one each. */
int op_list_operations(const op_list *t);
uint64_t op_list_hash(const op_list *t);

#endif
