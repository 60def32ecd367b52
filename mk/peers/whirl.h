/* whirl.h: steps of a generated scene, in double, to be raced against the others. */
#include "core/scene.h"

extern const wh_scene peer_scene;

static wh_state peer_state;

void naive_start(double y[]) {
    static uint64_t memory[256];
    (void)y;
    (void)slope;
    (void)wh_scene_start(&peer_scene, &peer_state, memory, sizeof memory);
}

void naive_step(double y[], double h) { /* the step is the scene's own */
    (void)y;
    (void)h;
    (void)wh_scene_step(&peer_scene, &peer_state);
}

void naive_read(double y[]) {
    const wh_real *rate = wh_scene_rates(&peer_scene, &peer_state);
    for (unsigned i = 0; i < STATES / 2; i++) {
        const unsigned angles = peer_scene.angles;
        y[i] = i < angles ? peer_state.angle[i] : peer_state.real[i - angles];
        y[STATES / 2 + i] = rate[i];
    }
}
