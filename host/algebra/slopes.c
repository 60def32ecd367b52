/* slopes.c: the derivative of each of the language's functions, in symbols: one function for each row of
 * host/number/function_rows.h, slope_of_<word>(). The first argument is x, the second, where there is one, y. */
#include "algebra.h"
#include "poly.h"

typedef struct call {
    const poly *x;
    const poly *y;    /* NULL */
    const poly *self; /* the function of them */
} call;

/* The derivative by x (which = 0) or y (1). */
typedef const poly *slope(algebra *a, const call *of, int which);

#define DECLARE(id, word, ...) static slope slope_of_##word;
FUNCTION_ROWS(DECLARE)
#undef DECLARE

const poly *function_slope(algebra *a, function_id function, int which, const poly *x,
                           const poly *y) {
    static slope *const slopes[] = {
#define ROW(id, word, ...) [FN_##id] = slope_of_##word,
        FUNCTION_ROWS(ROW)
#undef ROW
    };
    const call of = {x, y, poly_call(a, function, x, y)};
    return slopes[function](a, &of, which);
}

static const poly *negative(algebra *a, const poly *p) { return poly_scale(a, p, -1.0); }
static const poly *square(algebra *a, const poly *p) { return poly_mul(a, p, p); }

static const poly *slope_of_sin(algebra *a, const call *of, int which) {
    (void)which;
    return poly_cos(a, of->x);
}

static const poly *slope_of_cos(algebra *a, const call *of, int which) {
    (void)which;
    return negative(a, poly_sin(a, of->x));
}

static const poly *slope_of_tan(algebra *a, const call *of, int which) {
    (void)which;
    return poly_add(a, a->one, square(a, of->self));
}

static const poly *slope_of_asin(algebra *a, const call *of, int which) {
    (void)which;
    return poly_pow(a, poly_sub(a, a->one, square(a, of->x)), -0.5);
}

static const poly *slope_of_acos(algebra *a, const call *of, int which) {
    return negative(a, slope_of_asin(a, of, which));
}

static const poly *slope_of_atan(algebra *a, const call *of, int which) {
    (void)which;
    return poly_pow(a, poly_add(a, a->one, square(a, of->x)), -1.0);
}

/* x is the numerator. */
static const poly *slope_of_atan2(algebra *a, const call *of, int which) {
    const poly *top = which == 0 ? of->y : negative(a, of->x);
    return poly_mul(a, top, poly_pow(a, poly_add(a, square(a, of->x), square(a, of->y)), -1.0));
}

static const poly *slope_of_sqrt(algebra *a, const call *of, int which) {
    (void)which;
    return poly_scale(a, poly_pow(a, of->x, -0.5), 0.5);
}

static const poly *slope_of_exp(algebra *a, const call *of, int which) {
    (void)a;
    (void)which;
    return of->self;
}

static const poly *slope_of_log(algebra *a, const call *of, int which) {
    (void)which;
    return poly_pow(a, of->x, -1.0);
}

static const poly *slope_of_abs(algebra *a, const call *of, int which) {
    (void)which;
    return poly_call(a, FN_SIGN, of->x, NULL);
}

static const poly *slope_of_sinh(algebra *a, const call *of, int which) {
    (void)which;
    return poly_call(a, FN_COSH, of->x, NULL);
}

static const poly *slope_of_cosh(algebra *a, const call *of, int which) {
    (void)which;
    return poly_call(a, FN_SINH, of->x, NULL);
}

/* cosh(x)^-2, which keeps its digits where the tangent is near one. */
static const poly *slope_of_tanh(algebra *a, const call *of, int which) {
    (void)which;
    return poly_pow(a, poly_call(a, FN_COSH, of->x, NULL), -2.0);
}

/* But for where it jumps. */
static const poly *slope_of_sign(algebra *a, const call *of, int which) {
    (void)of;
    (void)which;
    return a->zero;
}

/* 1 for the one that is taken, 1/2 for each where they meet: by how the first is ahead of the second. */
static const poly *share(algebra *a, const call *of, double side) {
    const poly *lead = poly_call(a, FN_SIGN, poly_sub(a, of->x, of->y), NULL);
    return poly_add(a, poly_number(a, 0.5), poly_scale(a, lead, side));
}

static const poly *slope_of_min(algebra *a, const call *of, int which) {
    return share(a, of, which == 0 ? -0.5 : 0.5);
}

static const poly *slope_of_max(algebra *a, const call *of, int which) {
    return share(a, of, which == 0 ? 0.5 : -0.5);
}
