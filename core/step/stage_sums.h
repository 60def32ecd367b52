/* stage_sums.h: weighted sums of a step's stages, with the weights of method.h. Part of step.h. */
#ifndef WH_STAGE_SUMS_H
#define WH_STAGE_SUMS_H

#include <stddef.h>

#include "../method.h"
#include "unroll.h"

/* Maximum number of stages. A generated scene defines its own, because a larger one would spill more registers. */
#ifndef WH_STAGES
#define WH_STAGES WH_STAGES_MAX
#define WH_HAS_LONG_ROWS 1
#elif WH_STAGES > 4
#define WH_HAS_LONG_ROWS 1
#endif

/* Does the statement `stage(s);` for all stages except stage 0, unrolled: the shares are then constants. */
#ifdef WH_UNROLLS
#define WH_LATER_STAGES(by, stage) \
    do { \
        WH_UNROLL \
        for (unsigned s = 1; s < WH_STAGES; s++) { /* the bound (by)->stages spills registers */ \
            if (s >= (by)->stages) { \
                break; \
            } \
            stage(s); \
        } \
    } while (false)
#else
_Static_assert(WH_STAGES_MAX <= 6, "a stage each below");
#ifdef WH_HAS_LONG_ROWS
#define WH_LAST_STAGES(stage) \
    stage(4U); \
    stage(5U)
#else
#define WH_LAST_STAGES(stage) (void)0
#endif
#define WH_LATER_STAGES(by, stage) \
    do { \
        stage(1U); \
        stage(2U); \
        stage(3U); \
        WH_LAST_STAGES(stage); \
    } while (false)
#endif

WH_INLINE void wh_copy(const wh_real *from, unsigned n, wh_real *to) {
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        to[i] = from[i];
    }
}

typedef struct wh_given {
    const wh_real *first;
    wh_real (*next)[WH_COORDS];
} wh_given;

/* Returns the sum of share[j] * (component i of stage j) over j < stage, in the order of j. */
WH_INLINE wh_real wh_stage_sum(const wh_real *share, unsigned stage, wh_given given, unsigned i) {
    wh_real sum = WH_R(0.0);
    bool any = false;
    WH_UNROLL
    for (unsigned j = 0; j < WH_STAGES; j++) {
        if (j < stage && share[j] != WH_R(0.0)) {
            const wh_real one = share[j] * (j == 0 ? given.first[i] : given.next[j - 1][i]);
            sum = any ? sum + one : one;
            any = true;
        }
    }
    return sum;
}

WH_INLINE bool wh_stage_reaches(const wh_tableau *by) { return by->places != NULL; }

/* True if the method's first stage is not at the step's begin. */
WH_INLINE bool wh_begins_away(const wh_tableau *by) {
    return by->places != NULL && by->places->node[0] != WH_R(0.0);
}

/* True if all stages of the method are at the step's begin. */
WH_INLINE bool wh_all_begin(const wh_tableau *by) { return by->stages == 1 && !wh_begins_away(by); }

/* Returns the change of position i from the begin to a stage, by .places. `rate` is the rate of i at the begin. */
WH_INLINE wh_real wh_stage_reach(const wh_tableau *by, unsigned stage, wh_real rate,
                                 wh_given accels, wh_real h, unsigned i) {
    const wh_shares *of = &by->places->reach[stage];
    return h * by->places->node[stage] * rate +
           h * h / of->parts * wh_stage_sum(of->share, stage, accels, i);
}

/* True if a stage and the stage before it have equal weights in .rates and, if has_positions, in .positions. */
WH_INLINE bool wh_stages_alike(const wh_tableau *by, unsigned stage, bool has_positions) {
    return stage < WH_STAGES && stage < by->stages && by->rates[stage] == by->rates[stage - 1] &&
           (!has_positions || by->positions[stage] == by->positions[stage - 1]);
}

/* Stores a stage's result now[] in given[]. Sums results of consecutive stages with equal weights in alike[]. */
WH_INLINE void wh_stage_given(const wh_tableau *by, unsigned stage, bool has_positions, unsigned n,
                              const wh_real *first, const wh_real *now, wh_real (*given)[WH_COORDS],
                              wh_real (*alike)[WH_COORDS]) {
    WH_UNROLL
    for (unsigned i = 0; i < n; i++) {
        given[stage - 1][i] = now[i];
        alike[stage - 1][i] = !wh_stages_alike(by, stage, has_positions)
                                  ? now[i]
                                  : (stage == 1 ? first[i] : alike[stage - 2][i]) + now[i];
    }
}

/* Adds share * more to *sum. The first time, when *any is false, sets *sum to the product. */
WH_INLINE void wh_total_add(wh_real *sum, bool *any, wh_real share, wh_real more) {
    if (share != WH_R(0.0)) {
        *sum = *any ? *sum + share * more : share * more;
        *any = true;
    }
}

#endif
