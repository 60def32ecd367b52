/* fixed_list.h: the accelerations' operation list in fixed point: 32-bit integers, each with its own binary point.
 * The interpreter (engine_fixed.c) and the C writer (c_fixed.c) give the same bits. */
#ifndef FIXED_FIXED_LIST_H
#define FIXED_FIXED_LIST_H

#include "host/image/image.h"
#include "host/number/enclosure.h"

/* === the ranges that components and inputs of a scene keep to ================================= */

/* Fills range[reals + inputs], components first, with the declared ranges. If a component has no declared range, its
 * range encloses its values in a run of the scene in double, with a margin. If an input has none, its range encloses
 * its value. Returns false if the run failed (reported) or was interrupted. `progress`: show the progress on stderr. */
bool fixed_ranges(const image *im, enclosure *range, bool progress, diags *errors);

/* Most binary digits of a value. FIXED_KEPT_DIGITS is for the state, sums and differences. FIXED_RESULT_DIGITS is for
 * the list's results: six results must add up to less than 2^31. FIXED_DIGITS is for other values. */
enum { FIXED_DIGITS = 29, FIXED_RESULT_DIGITS = 28, FIXED_KEPT_DIGITS = 30 };

typedef enum fixed_code {
    FIXED_CONSTANT, /* a constant */
    FIXED_LINEAR,   /* leaf `index` */
    FIXED_RATE,
    FIXED_INPUT,
    FIXED_PHASE,      /* offset + sum turns[i] phase[i] */
    FIXED_SINE,       /* sine of phase a */
    FIXED_COSINE,     /* cosine of phase a */
    FIXED_SUM,        /* round(a) + round(b): each operand has its shift */
    FIXED_DIFFERENCE, /* round(a) - round(b) */
    FIXED_PRODUCT,    /* (a << shift) (b << shift) 2^-(32 + by), rounded */
    FIXED_QUOTIENT,   /* a times the reciprocal of b, rounded; for the shifts, see fixed_op.zeros */
    FIXED_SAME,       /* a times 2^n or -2^n, by a rounding shift */
    FIXED_ABS,        /* round(|a|) */
    FIXED_SIGN,       /* sign of a: -1, 0 or 1 */
    FIXED_LEAST,      /* the smaller of round(a) and round(b) */
    FIXED_MOST
} fixed_code;

typedef struct fixed_operand {
    int op;
    int shift;      /* in bits: left in a product or quotient, right in other operations */
    int32_t number; /* value of a constant, already shifted */
} fixed_operand;

typedef struct fixed_op {
    fixed_code code;
    fixed_operand a;
    fixed_operand b;
    int index;
    int by;
    int zeros;        /* FIXED_QUOTIENT: least number of leading zeros of |b| */
    int spread;       /* FIXED_QUOTIENT: most leading zeros of |b| beyond `zeros` */
    bool follows;     /* FIXED_QUOTIENT: the zeros of |b| beyond `zeros` shift `a` left */
    bool negated;     /* FIXED_SAME: the result is -a; FIXED_QUOTIENT: b is negative */
    const int *turns; /* FIXED_PHASE: factors, owned by the image's list */
    double offset_rad;
    uint32_t offset;
    double value;    /* FIXED_CONSTANT: the constant; FIXED_SAME: 2^n or -2^n */
    enclosure range; /* of the possible values */
    int bits;        /* binary digits after the point */
    bool used;
} fixed_op;

typedef struct fixed_list {
    fixed_op *op;
    int count;
    int *result;
    int results;
    int angles;
} fixed_list;

/* Copies the image's list, with result i times scale[i]. Returns NULL (reported) if an operation has no fixed form. */
fixed_list *fixed_list_make(const image *im, const double *scale, diags *errors);
void fixed_list_free(fixed_list *list);
bool fixed_is_result(const fixed_list *list, int operation);

typedef struct fixed_leaves {
    const enclosure *linear;
    const enclosure *rate;
    const enclosure *input;
} fixed_leaves;

/* Limit of a value's size. Products of two such values are finite, and so are all intervals. */
#define FIXED_SIZE_MOST 0x1p80

/* Sets op[].range to the range of each value over all cells of the turn angles. If `bits_known`, the range includes the
 * rounding to op[].bits. Returns the number of cells per turn, or a code. FIXED_HULL_ZERO: a denominator may be zero
 * (reported). FIXED_HULL_UNBOUNDED: a value exceeds FIXED_SIZE_MOST. FIXED_HULL_STOPPED: the user interrupted. */
enum { FIXED_HULL_ZERO = 0, FIXED_HULL_UNBOUNDED = -1, FIXED_HULL_STOPPED = -2 };
int fixed_hull(fixed_list *list, const image *im, const fixed_leaves *leaves, bool bits_known,
               diags *errors);

/* Chooses all shifts, the integers of constants, and op[].bits. The caller must have set the bits of leaves. Returns
 * false, and reports it, if a value does not fit. */
bool fixed_bits(fixed_list *list, const image *im, diags *errors);

/* Do all values fit? For use after fixed_hull() with bits_known. */
bool fixed_fits(const fixed_list *list);

/* Returns the digits after the point: the largest `bits` with size 2^bits <= 2^digits, or `digits` if `size` is 0. */
int fixed_point_of(double size, int digits);
/* Returns the digits after the point of a constant factor: the largest `bits` with round(|value| 2^bits) < 2^31. */
int fixed_factor_bits(double value);

#endif
