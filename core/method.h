/* method.h: the integration methods, a row each. All that is known of a method stands in its row: whatever steps,
 * keeps books, counts evaluations, reads command lines, prints or tests methods reads it here. Adding a method
 * is adding a row (and its line in docs/numerics.md, which a test holds to these).
 */
#ifndef WH_METHOD_H
#define WH_METHOD_H

#include "real.h"

/* X(name in C, word of command lines, title, order, systems that it takes, stages, its tableau). Enumerators count from
 * 0 in this order; generated code says them by name.
 *
 * A step evaluates the right-hand side once a stage. Stage i looks at where
 *
 *     begin + h/parts * sum_j share[j] * (rate of stage j),        .stage[i] = {parts, {share...}}
 *
 * stands, j before i: a row of Butcher's A, with a common denominator. A share of zero leaves nothing behind in
 * generated code. At the end of the step, with h/parts * sum_i share[i] * (derivative of stage i),
 *
 *     x' = f(x):        x moves by .rates                             (Butcher's b)
 *     q'' = f(q, q'):   q' moves by .rates, and q by h times q' moved by .positions
 *
 * so that a method may have weights of its own for positions (Nystroem's, semi-implicit Euler). Those of a
 * Runge-Kutta method are .positions = b A; only such a method takes systems of first order. Both have the same
 * .parts: the sum for positions is part of that for rates. The books (ledger_step.h) weigh the stages by .rates, too.
 *
 * Methods of other kinds are rows as well, with columns that those here leave empty, and a loop of their own in
 * step.h where they need one, chosen by the column and never by the method's name:
 *
 *     Nystroem       .reach[i], as .stage[i]: the position of stage i is q + c h q' + h^2/parts * sum share[j] a_j,
 *                    c = .node[i]; .positions and .rates are there already. Systems: second order only.
 *     compositions   the same columns: a kick, a drift, a kick is a Nystroem row (semi-implicit Euler is one of one
 *                    stage); done in place as pairs, .kick[i] and .drift[i], they take no sums of stages at all.
 *     multistep      .history = how many earlier derivatives it keeps, .rates their weights, .start = WH_RK4;
 *                    WH_MEMORY_BYTES of scene.h grows by .history reals a component.
 *
 * A row of several stages whose sines can be those of the step's begin, turned on (stage_turn.h), says with .turns how many
 * times as far as stage 1 stage i is, as the rates at the begin lead. That follows from the shares
 * (tests/core/test_stage_turn.c). A row without it is stepped by looking up.
 */
/* clang-format off */
#define WH_METHOD_ROWS(X) \
    X(WH_EULER, "euler", "explicit Euler", 1, WH_ANY_SYSTEM, 1, \
      .stage = {{1, {0}}}, \
      .parts = 1, .positions = {0}, .rates = {1}) \
    X(WH_SEMI_IMPLICIT_EULER, "semi-implicit-euler", "semi-implicit Euler", 1, WH_SECOND_ORDER_ONLY, 1, \
      .stage = {{1, {0}}}, \
      .parts = 1, .positions = {1}, .rates = {1}) \
    X(WH_HEUN, "heun", "Heun", 2, WH_ANY_SYSTEM, 2, \
      .stage = {{1, {0}}, {1, {1}}}, \
      .parts = 2, .positions = {1, 0}, .rates = {1, 1}, .turns = {0, 1}) \
    X(WH_RK4, "rk4", "Runge-Kutta 4", 4, WH_ANY_SYSTEM, 4, \
      .stage = {{1, {0}}, {2, {1}}, {2, {0, 1}}, {1, {0, 0, 1}}}, \
      .parts = 6, .positions = {1, 1, 1, 0}, .rates = {1, 2, 2, 1}, .turns = {0, 1, 1, 2}) \
    X(WH_RK38, "rk38", "Kutta's 3/8 rule", 4, WH_ANY_SYSTEM, 4, \
      .stage = {{1, {0}}, {3, {1}}, {3, {-1, 3}}, {1, {1, -1, 1}}}, \
      .parts = 8, .positions = {1, 2, 1, 0}, .rates = {1, 3, 3, 1}, .turns = {0, 1, 2, 3})
/* clang-format on */

/* The method of whoever names none. */
#define WH_METHOD_DEFAULT WH_RK4

#define WH_METHOD_NAME(id, word, title, order, takes, stages, ...) id,
typedef enum wh_method { WH_METHOD_ROWS(WH_METHOD_NAME) } wh_method;
#undef WH_METHOD_NAME

#define WH_METHOD_ONE(id, word, title, order, takes, stages, ...) +1
enum { WH_METHODS = WH_METHOD_ROWS(WH_METHOD_ONE) };
#undef WH_METHOD_ONE

/* Systems that a method takes: a bit for each wh_form (scene.h). */
enum { WH_SECOND_ORDER_ONLY = 1, WH_ANY_SYSTEM = 3 };

#ifdef __cplusplus
extern "C" {
#endif

/* What users are told of a method. */
typedef struct wh_method_row {
    const char *word;  /* on command lines, in file names */
    const char *name;  /* in C */
    const char *title; /* in sentences */
    uint8_t order;     /* of convergence */
    uint8_t takes;     /* systems */
    uint8_t stages;    /* evaluations of the right-hand side a step */
} wh_method_row;

#define wh_methods WH_NAME(wh_methods)
extern const wh_method_row wh_methods[WH_METHODS];

#ifdef __cplusplus
}
#else

#define WH_METHOD_STAGES(id, word, title, order, takes, stages, ...) char id##_has[stages];
union wh_method_stages {
    WH_METHOD_ROWS(WH_METHOD_STAGES)
};
#undef WH_METHOD_STAGES
/* Most stages of a row. */
#define WH_STAGES_MAX sizeof(union wh_method_stages)

/* share[j] parts of `parts`: what stage j's derivative counts for. Numbers, not integers: rows of higher order
 * have shares that are no ratios of small ones. */
typedef struct wh_shares {
    wh_real parts;
    wh_real share[WH_STAGES_MAX];
} wh_shares;

typedef struct wh_tableau {
    unsigned stages;
    wh_shares stage[WH_STAGES_MAX];
    wh_real parts;
    wh_real positions[WH_STAGES_MAX];
    wh_real rates[WH_STAGES_MAX];
    uint8_t turns[WH_STAGES_MAX];
} wh_tableau;

#define WH_METHOD_TABLEAU(id, word, title, order, takes, stages, ...) \
    static const wh_tableau wh_tableau_##id = {stages, __VA_ARGS__};
WH_METHOD_ROWS(WH_METHOD_TABLEAU)
#undef WH_METHOD_TABLEAU

/* An object each, and not an array: where the method is a constant, nothing is left in generated code of the others,
 * and nothing of its own where the loops over it are unrolled. */
WH_INLINE const wh_tableau *wh_tableau_of(wh_method method) {
#define WH_METHOD_TABLEAU(id, ...) \
    case id: \
        return &wh_tableau_##id;
    switch (method) { WH_METHOD_ROWS(WH_METHOD_TABLEAU) }
#undef WH_METHOD_TABLEAU
    return &wh_tableau_WH_RK4; /* none: a method is one of these */
}

#endif

#endif
