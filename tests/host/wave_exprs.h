/* wave_exprs.h: random expressions of turn angles and a length, as texts and as values. The values are computed in
 * long double by libm, with a bound on the round-off of the program. */
#ifndef TESTS_HOST_WAVE_EXPRS_H
#define TESTS_HOST_WAVE_EXPRS_H

#include "test.h"

/* The texts name the angles a, b and c and the number u. */
enum { WAVE_ANGLES = 3, WAVE_SYMBOLS = WAVE_ANGLES + 1 };

enum { WAVE_PIECES = 3, WAVE_FACTORS = 2, WAVE_TERMS = 3, WAVE_TEXT = 1600 };

/* A term number * symbol. */
typedef struct wave_piece {
    int symbol;
    int form; /* format of the number */
    long double number;
} wave_piece;

typedef struct wave_argument {
    wave_piece piece[WAVE_PIECES];
    int pieces;
    double offset_rad;
} wave_argument;

/* The sine, cosine or tangent of: the argument + 0.3 sin(inner) + u * (a symbol)/100. */
typedef struct wave_factor {
    enum { WAVE_SIN, WAVE_COS, WAVE_TAN } function;
    wave_argument argument;
    bool has_inner;
    wave_argument inner;
    int product; /* number of the symbol after u, or -1 */
} wave_factor;

/* size * factors / (2 + cos(below)) * (the symbol `outside`, not reduced to one turn) */
typedef struct wave_term {
    double size;
    wave_factor factor[WAVE_FACTORS];
    int factors;
    bool divided;
    wave_argument below;
    int outside; /* number of a symbol, or -1 */
} wave_term;

typedef struct wave_expr {
    wave_term term[WAVE_TERMS];
    int terms;
    char text[WAVE_TEXT];
} wave_expr;

typedef struct wave_value {
    long double value;
    long double bound; /* bound on the program's round-off */
    long double scale; /* sum of the terms' sizes */
} wave_value;

wave_expr wave_expr_make(uint64_t *seed);
/* A sine or cosine of one multiple of one angle. */
wave_expr wave_expr_plain(uint64_t *seed);
/* The value at the exact `state` [WAVE_SYMBOLS], and a bound on the round-off in double or, if `is_float`, in float
 * with 64-bit angles. */
wave_value wave_expr_value(const wave_expr *e, const long double *state, bool is_float);

#endif
