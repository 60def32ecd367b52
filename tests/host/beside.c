#include "beside.h"

#include "derived.h"

typedef struct seeing {
    beside *beside;
    int states;
} seeing;

static void see(void *told, uint64_t step, const enclosure *exact, const double *run) {
    (void)run;
    const seeing *s = told;
    beside *b = s->beside;
    if (step > 0) {
        quad_follow(b->slopes, b->of, s->states, b->step_s, b->state);
        b->records++;
    }
    TEST_ASSERT_EQUAL_UINT64(b->records, step);
    for (int i = 0; i < s->states && b->outside == 0; i++) {
        const quad x = b->state[i];
        const double wide = exact[i].high - exact[i].low;
        if (!((quad)exact[i].low <= x && x <= (quad)exact[i].high)) {
            b->outside = step > 0 ? step : 1;
            return;
        }
        b->widest = fmax(b->widest, wide);
        if (wide > 0.0) {
            const double below = (double)((x - (quad)exact[i].low) / (quad)wide);
            b->nearest = fmin(b->nearest, fmin(below, 1.0 - below));
        }
    }
}

containment_found beside_hold(const char *text, const char *name, const engine_kind *kind,
                              beside *b) {
    derived d = derived_scene(text, name);
    derived_expect(&d, text);
    diags *errors = diags_new();
    exact_motion *m = exact_motion_make(d.instance, errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(m, text);
    TEST_ASSERT_TRUE(m->states <= QUAD_STATES);
    double *within = calloc((size_t)m->states, sizeof *within);
    seeing s = {b, m->states};
    b->nearest = 1.0;
    const containment_wish wish = {.motion = m,
                                   .image = d.image,
                                   .kind = kind,
                                   .tolerance = CONTAINMENT_TOLERANCE,
                                   .within = within,
                                   .see = see,
                                   .told = &s};
    containment_found h = containment_run(&wish);
    free(within);
    exact_motion_free(m);
    diags_free(errors);
    derived_free(&d);
    return h;
}
