/* method.h: the integration methods, one row each. A row has every property of its method, for the steps, the ledger,
 * the evaluation counts, the command line and the tests. To add a method, add its row and its line in
 * docs/dev/numerics.md (a test compares the two). */
#ifndef WH_METHOD_H
#define WH_METHOD_H

#include "real.h"

/* X(name in C, word of command lines, title, order, systems that it takes, stages, its tableau). Enumerators count from
 * 0 in this order; generated code uses their names.
 *
 * Each stage is one evaluation of the right-hand side. Stage i is evaluated at
 *
 *     begin + h/parts * sum_j share[j] * (rate of stage j),        .stage[i] = {parts, {share...}}
 *
 * with j < i: a row of Butcher's A, with a common denominator. A share of zero costs nothing in generated code. The end
 * of the step needs the sums S(w) = h/parts * sum_i w[i] * (derivative at stage i):
 *
 *     x' = f(x):        x + S(.rates)                                 (Butcher's b)
 *     q'' = f(q, q'):   q' + S(.rates),   q + h (q' + S(.positions))
 *
 * So a method may have separate weights for positions (Nystroem's, semi-implicit Euler). A Runge-Kutta method has
 * .positions = b A; only such a method takes systems of first order. .positions and .rates share .parts, because the
 * sum for rates is the sum for positions plus a rest. The ledger (ledger_step.h) weighs the stages by .rates, too.
 *
 * In Nystroem's methods, .places gives the position of stage i:
 *
 *     begin + c h q' + h^2/parts * sum_j share[j] a_j,     .places->reach[i] = {parts, {share...}}, c = .places->node[i],
 *
 * where a_j are the accelerations of the earlier stages; a Runge-Kutta method's reach is A A. The rates of stage i
 * follow from .stage[i]. Two stages with the same node and reach have the same position. If the list is inlined, the
 * compiler computes their common terms (sines, mass matrix, divisions) once. First-order systems use .stage alone.
 *
 * Compositions of kicks and drifts have kicks b_i at nodes c_i: .positions = b (1 - c), .rates = b, and .reach[i] has
 * the shares b_j (c_i - c_j). Their .stage is zero, so the stages have no rates: systems whose accelerations depend on
 * rates cannot use them (WH_NO_RATES). Their first stage need not be at the step's begin.
 *
 * A row with .turns may rotate the sines of the step's begin (stage_turn.h). .turns[i] is the time from the begin to
 * stage i, divided by the time from the begin to stage 1 (tests/core/test_stage_turn.c). Without .turns, the sines of
 * each stage come from the sine table. */
/* clang-format off */
#define WH_SHORT_METHOD_ROWS(X) \
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
    X(WH_RK4_PLAIN, "rk4-plain", "Runge-Kutta 4, plain", 4, WH_ANY_SYSTEM, 4, \
      .stage = {{1, {0}}, {2, {1}}, {2, {0, 1}}, {1, {0, 0, 1}}}, \
      .parts = 6, .positions = {1, 1, 1, 0}, .rates = {1, 2, 2, 1}) \
    X(WH_RK38, "rk38", "Kutta's 3/8 rule", 4, WH_ANY_SYSTEM, 4, \
      .stage = {{1, {0}}, {3, {1}}, {3, {-1, 3}}, {1, {1, -1, 1}}}, \
      .parts = 8, .positions = {1, 2, 1, 0}, .rates = {1, 3, 3, 1}, .turns = {0, 1, 2, 3}) \
    X(WH_NYSTROEM3, "nystroem3", "Nystroem 3", 3, WH_ANY_SYSTEM, 3, \
      .stage = {{1, {0}}, {3, {2}}, {3, {0, 2}}}, \
      .places = &(const wh_places){.node = {0, WH_R(0x1.5555555555555p-1), WH_R(0x1.5555555555555p-1)}, \
                                   .reach = {{1, {0}}, {9, {2}}, {9, {2}}}}, \
      .parts = 8, .positions = {2, 2, 0}, .rates = {2, 3, 3}, .turns = {0, 1, 1}) \
    X(WH_NYSTROEM4, "nystroem4", "Nystroem 4", 4, WH_ANY_SYSTEM, 4, \
      .stage = {{1, {0}}, {2, {1}}, {2, {0, 1}}, {1, {0, 0, 1}}}, \
      .places = &(const wh_places){.node = {0, WH_R(0.5), WH_R(0.5), 1}, \
                                   .reach = {{1, {0}}, {8, {1}}, {8, {1}}, {2, {0, 1}}}}, \
      .parts = 6, .positions = {1, 1, 1, 0}, .rates = {1, 2, 2, 1}, .turns = {0, 1, 1, 2}) \
    X(WH_LEAPFROG, "leapfrog", "leapfrog", 2, WH_NO_RATES, 1, \
      .stage = {{1, {0}}}, \
      .places = &(const wh_places){.node = {WH_R(0.5)}, .reach = {{1, {0}}}}, \
      .parts = 2, .positions = {1}, .rates = {2})
/* Rows of more than four stages. */
#define WH_LONG_METHOD_ROWS(X) \
    X(WH_NYSTROEM5, "nystroem5", "Nystroem 5", 5, WH_ANY_SYSTEM, 6, \
      .stage = {{1, {0}}, {4, {1}}, {8, {1, 1}}, {2, {0, -1, 2}}, {16, {3, 0, 0, 9}}, {7, {-3, 2, 12, -12, 8}}}, \
      .places = &(const wh_places){.node = {0, WH_R(0.25), WH_R(0.25), WH_R(0.5), WH_R(0.75), 1}, \
                                   .reach = {{1, {0}}, {32, {1}}, {32, {1}}, {8, {0, 0, 1}}, {32, {3, 0, 3, 3}}, {14, {0, 0, 6, 0, 1}}}}, \
      .parts = 90, .positions = {7, 0, 24, 6, 8, 0}, .rates = {7, 0, 32, 12, 32, 7}, \
      .turns = {0, 1, 1, 2, 3, 4})
#define WH_METHOD_ROWS(X) WH_SHORT_METHOD_ROWS(X) WH_LONG_METHOD_ROWS(X)
/* clang-format on */

#define WH_METHOD_DEFAULT WH_RK4

#define WH_METHOD_NAME(id, word, title, order, takes, stages, ...) id,
typedef enum wh_method { WH_METHOD_ROWS(WH_METHOD_NAME) } wh_method;
#undef WH_METHOD_NAME

#define WH_METHOD_ONE(id, word, title, order, takes, stages, ...) +1
enum { WH_METHODS = WH_METHOD_ROWS(WH_METHOD_ONE) };
#undef WH_METHOD_ONE

/* The systems that a method can step, one bit for each wh_form. Bit 2 forbids accelerations that depend on rates. */
enum { WH_SECOND_ORDER_ONLY = 1, WH_ANY_SYSTEM = 3, WH_NO_RATES = 5 };

WH_C_BEGIN

typedef struct wh_method_row {
    const char *word;  /* name on command lines and in file names */
    const char *name;  /* name in C */
    const char *title; /* name in sentences */
    uint8_t order;
    uint8_t takes;  /* the systems that the method can step, such as WH_ANY_SYSTEM */
    uint8_t stages; /* evaluations of the right-hand side per step */
} wh_method_row;

#define wh_methods WH_NAME(wh_methods)
extern const wh_method_row wh_methods[WH_METHODS];

WH_C_END

#ifndef __cplusplus

/* The available rows. A generated scene defines WH_STAGES, its method's number of stages. If it is at most four, the
 * rows with more stages are omitted, because they can cost an 8-bit chip 200 bytes of RAM. */
#if defined(WH_STAGES) && WH_STAGES <= 4
#define WH_TABLEAUS(X) WH_SHORT_METHOD_ROWS(X)
#define WH_NO_TABLEAUS(X) WH_LONG_METHOD_ROWS(X)
#else
#define WH_TABLEAUS(X) WH_METHOD_ROWS(X)
#define WH_NO_TABLEAUS(X)
#endif

#define WH_METHOD_STAGES(id, word, title, order, takes, stages, ...) char id##_has[stages];
union wh_method_stages {
    WH_TABLEAUS(WH_METHOD_STAGES)
};
#undef WH_METHOD_STAGES
/* The largest number of stages in WH_TABLEAUS. */
#define WH_STAGES_MAX sizeof(union wh_method_stages)

/* Stage j has the weight share[j] / parts. */
typedef struct wh_shares {
    wh_real parts;
    wh_real share[WH_STAGES_MAX];
} wh_shares;

typedef struct wh_places {
    wh_real node[WH_STAGES_MAX];
    wh_shares reach[WH_STAGES_MAX];
} wh_places;

typedef struct wh_tableau {
    unsigned stages;
    wh_shares stage[WH_STAGES_MAX];
    const wh_places *places; /* NULL if .stage gives the positions, too */
    wh_real parts;
    wh_real positions[WH_STAGES_MAX];
    wh_real rates[WH_STAGES_MAX];
    uint8_t turns[WH_STAGES_MAX];
} wh_tableau;

#define WH_METHOD_TABLEAU(id, word, title, order, takes, stages, ...) \
    static const wh_tableau wh_tableau_##id = {stages, __VA_ARGS__};
WH_TABLEAUS(WH_METHOD_TABLEAU)
#undef WH_METHOD_TABLEAU

/* Each row is an object of its own, not an array element. If the method is constant, generated code contains only that
 * method's row, or none if all loops over the row are unrolled. */
WH_INLINE const wh_tableau *wh_tableau_of(wh_method method) {
#define WH_METHOD_NONE(id, ...) case id:
#define WH_METHOD_TABLEAU(id, ...) \
    case id: return &wh_tableau_##id;
    switch (method) {
        WH_TABLEAUS(WH_METHOD_TABLEAU)
        WH_NO_TABLEAUS(WH_METHOD_NONE)
        break;
    }
#undef WH_METHOD_NONE
#undef WH_METHOD_TABLEAU
    return &wh_tableau_WH_RK4; /* every method has a case above */
}

#endif

#endif
