/* turned.c: which form of the step a scene gets. */
#include "turned.h"

#include <math.h>

#include "core/stage_turn.h"

const char *const image_angles_words[IMAGE_ANGLES] = {
    [ANGLES_TURNED] = "turned", [ANGLES_LOOKUP] = "lookup"};

_Static_assert(TURNED_WAVES_MAX == WH_WAVES, "the core's room is what an image may have");

/* A start may turn by this share of what turning is good for: there is room to become faster. */
#define START_SHARE 0.5

/* rad/s at the start; of a state that has no rate of its own it is not known: 0. */
static double start_rate(const image *im, int angle) {
    const image_unknown *u = &im->unknown[im->angle[angle].unknown];
    return u->order > 1 && u->starts > 1 ? u->start[1] : 0.0;
}

/* What a step at the start turns by up to its second stage, rad, summed as wh_turning_begin() does. */
static double start_turn(const image *im) {
    const tape *t = im->list[IMAGE_STEP];
    const wh_shares *of = &wh_tableaus[im->settings.method].stage[1];
    double share = 0.0;
    double all = 0.0;
    for (size_t j = 0; j < WH_STAGES_MAX; j++) {
        share += (double)of->share[j] / (double)of->parts;
    }
    for (int i = 0; i < t->count; i++) {
        double rate = 0.0;
        for (int k = 0; k < im->angles && tape_is_wave(&t->ops[i]); k++) {
            rate += t->ops[i].turns[k] * start_rate(im, k);
        }
        all += fabs(share * im->step_s * rate);
    }
    return all;
}

bool image_turns(const image *im) {
    const tape *t = im->list[IMAGE_STEP];
    return im->settings.angles == ANGLES_TURNED && im->contacts == 0 && im->angles > 0 &&
           wh_method_turns(im->settings.method) && tape_takes_waves(t) &&
           tape_waves(t) <= TURNED_WAVES_MAX &&
           (wh_methods[im->settings.method].stages == 1 ||
            start_turn(im) <= START_SHARE * (double)WH_TURN_MOST);
}

uint64_t image_turned_angles(const image *im) {
    const tape *t = im->list[IMAGE_STEP];
    uint64_t angles = 0;
    for (int i = 0; i < t->count; i++) {
        for (int k = 0; k < im->angles && tape_is_wave(&t->ops[i]); k++) {
            angles |= t->ops[i].turns[k] != 0 ? UINT64_C(1) << k : 0U;
        }
    }
    return angles;
}
