/* tape.h: the operation list: a model's right-hand side as a table of elementary operations.
 *
 * One list, three readers: the interpreter (host/run), the generated C and Octave (host/emit). Each
 * operation is one IEEE operation on earlier results, so all readers give the same bits. Equal
 * operations are entered once; constants are folded; signs are pulled outwards, where they vanish
 * into subtractions.
 */
#ifndef IMAGE_TAPE_H
#define IMAGE_TAPE_H

#include <stdbool.h>
#include <stdint.h>

#include "host/number/functions.h"

typedef enum op_code {
    OP_CONSTANT, /* value */
    OP_LINEAR,   /* real component a: a linear position (second order), any real (first order) */
    OP_RATE,     /* rate of coordinate a (second order only) */
    OP_INPUT,    /* input a */
    OP_ACCEL,    /* acceleration of coordinate a, contact forces in it: for records */
    OP_TIME,     /* time, s: for records, never in a step */
    OP_RADIANS,  /* unwrapped angle a in radians: for records, never in a step */
    OP_NOISE,    /* Gaussian deviate with seed `value` at this step: for records, never in a step */
    OP_PHASE,    /* a phase: sum turns[i] * phase[i] + sum parts[i] * angle[i] + value [rad] +
                  * (radians from b, if b >= 0) */
    OP_SIN,      /* sine of phase a */
    OP_COS,      /* cosine of phase a */
    OP_ADD,
    OP_SUB,
    OP_MUL,
    OP_DIV,
    OP_NEG,
    OP_SQRT,
    OP_ABS,
    OP_SIGN, /* these three give NaN of NaN: nothing that is no number may vanish in a comparison */
    OP_MIN,  /* b < a || b != b ? b : a */
    OP_MAX,  /* b > a || b != b ? b : a */
    OP_CALL, /* function(a) or function(a, b), of core/function.h */
    OP_POW   /* a to the b, likewise */
} op_code;

typedef struct op {
    op_code code;
    function_id function; /* OP_CALL */
    int a;
    int b;
    double value;     /* OP_CONSTANT, OP_PHASE, OP_NOISE */
    const int *turns; /* OP_PHASE: [angles] whole factors, or NULL when there are none */
    /* OP_PHASE: [angles] factors that take the whole angle, not only its phase; or NULL. For records,
     * never in a step. */
    const double *parts;
} op;

typedef struct tape {
    op *ops;
    int count;
    int room;
    int angles; /* length of every `turns` */
    int *index; /* hash index of ops */
    int index_size;
    int *result; /* operation numbers of what the list computes */
    int results;
    struct arena *arena;
} tape;

tape *tape_new(int angles, int results);
void tape_free(tape *t);

int tape_constant(tape *t, double value);
int tape_leaf(tape *t, op_code code, int which);
int tape_noise(tape *t, uint32_t seed);
/* `multiple` [t->angles] of each turn angle may be NULL, and holds any numbers: those that are whole
 * multiply phases, the others whole angles. `radians` is an operation or -1. */
int tape_phase(tape *t, const double *multiple, double offset_rad, int radians);
/* Can a phase be multiplied by this number? Whole numbers, within bounds, can. */
bool tape_is_whole(double multiple);
int tape_unary(tape *t, op_code code, int a);
int tape_add(tape *t, int a, int b);
int tape_sub(tape *t, int a, int b);
int tape_mul(tape *t, int a, int b);
int tape_div(tape *t, int a, int b);
int tape_call(tape *t, function_id function, int a, int b);
int tape_pow(tape *t, int base, int exponent);
/* base to a fixed power, by products and square roots where that is possible. */
int tape_power(tape *t, int base, double exponent);
bool tape_is_constant(const tape *t, int a, double *value);

/* After operations were moved: rebuild the index that finds equal ones. */
void tape_reindex(tape *t);
uint64_t tape_op_hash(const tape *t, const op *o);

/* Drop what no result needs and renumber. */
void tape_prune(tape *t);

/* Does the list want whole angles, turns included, and not only their phases? No step has those. */
bool tape_reads_turns(const tape *t);

/* The first result in which a constant takes part that is not finite, or -1. */
int tape_not_finite(const tape *t);

/* Is a number zero, or within float's normal numbers? */
bool fits_float(double value);
/* The first constant that float keeps with fewer digits than it has, as zero or as infinite; 0: there is none. */
double tape_out_of_float(const tape *t);

/* What a list costs. */
typedef struct tape_cost {
    int arithmetic; /* additions, subtractions, products, negations, comparisons */
    int divisions;
    int roots;
    int waves; /* sines and cosines, a pair of one phase counted once */
    int calls; /* of core/function.h */
} tape_cost;

tape_cost tape_count(const tape *t);
/* One number to compare lists by: rough instructions on a Cortex-M4F. */
int tape_weight(const tape *t);
/* Operations in the sense of flop counts: every operation of the list that is not a leaf, a phase or
 * a constant, a sine and a cosine each counting one. */
int tape_operations(const tape *t);
uint64_t tape_hash(const tape *t);

#endif
