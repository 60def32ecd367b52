/* forms.c: symbols and random expressions in normal form. */
#include "forms.h"

#include "derived.h"

/* Two symbols have the same kind and number but belong to different mechanisms. */
const symbol form_symbols[FORM_SYMBOLS] = {
    {.kind = SYM_COORDINATE, .name = "q", .text = "", .unit = "", .index = 0},
    {.kind = SYM_COORDINATE, .name = "r", .text = "", .unit = "", .index = 1},
    {.kind = SYM_COORDINATE, .name = "s", .text = "", .unit = "", .index = 2},
    {.kind = SYM_PARAMETER, .name = "m", .text = "", .unit = "", .index = 0},
    {.kind = SYM_PARAMETER, .name = "n", .text = "", .unit = "", .index = 1},
    {.kind = SYM_INPUT, .name = "u", .text = "", .unit = "", .index = 0},
    {.kind = SYM_PARAMETER, .name = "a", .text = "", .unit = "", .index = 1},
};

int form_place(const symbol *sym) { return (int)(sym - form_symbols); }

int form_order(double x, double y) { return x < y ? -1 : x > y ? 1 : 0; }

static bool is_tame(const poly *p) {
    return poly_is_finite(p) && p->count <= 12 && p->size < 200.0;
}

static const poly *random_leaf(algebra *a, uint64_t *seed) {
    if (random_bits(seed) % 4 == 0) {
        return poly_number(a, (double)(random_bits(seed) % 13) / 4.0 - 1.5);
    }
    return poly_symbol(a, &form_symbols[random_bits(seed) % FORM_SYMBOLS],
                       (int)(random_bits(seed) % FORM_PRIMES));
}

const poly *form_random(algebra *a, uint64_t *seed, int depth) {
    static const double exponents[] = {-3.0, -2.0, -1.0, -0.5, 0.5, 1.5, 2.0, 3.0, 3.0, 4.0, 17.0};
    static const function_id functions[] = {FN_TAN,  FN_ATAN, FN_EXP, FN_ABS,
                                            FN_SIGN, FN_MIN,  FN_MAX, FN_ATAN2};
    if (depth == 0) {
        return random_leaf(a, seed);
    }
    const poly *x = form_random(a, seed, depth - 1);
    const poly *y = form_random(a, seed, depth - 1);
    const uint64_t draw = random_bits(seed);
    const function_id f = functions[(draw >> 16) % 8];
    const bool two = f == FN_MIN || f == FN_MAX || f == FN_ATAN2;
    const poly *p = x;
    switch (draw % 10) {
    case 0:
    case 1: p = poly_add(a, x, y); break;
    case 2: p = poly_sub(a, x, y); break;
    case 3:
    case 4: p = poly_mul(a, x, y); break;
    case 5: p = poly_pow(a, x, exponents[(draw >> 8) % 11]); break;
    case 6: p = poly_pow_poly(a, x, y); break;
    case 7: p = poly_sin(a, x); break;
    case 8: p = poly_cos(a, x); break;
    case 9: p = poly_call(a, f, x, two ? y : NULL); break;
    }
    return is_tame(p) ? p : random_leaf(a, seed);
}
