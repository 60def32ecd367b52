/* A run of the firmware with a plant, and the rules that the firmware must keep. */
#ifndef TESTS_OUTSIDE_BENCH_RUN_H
#define TESTS_OUTSIDE_BENCH_RUN_H
#include "tests/outside/bench_plant.h"

/* Indices of the floats in the rig's orders: two outputs and nine notes. */
enum { DUTY, ENABLE, STATE, TRIP, QUALITY, AMPLITUDE, AMPLITUDE_HALF, PHASE, PHASE_HALF, MEASURED };
enum { FLOATS = 11 };

typedef struct {
    int index, kind, second, status, state, state_before, trip, quality, turns, trip_state;
    bool wrong, on, shown, tripped, ended; /* shown: a turn showed that the stage drives */
    /* note: the firmware's notes with its result; amplitude, phase, rpm: the true values */
    double note[FLOATS], amplitude, phase, rpm;
    double energy_off, seconds, on_s, peak_high, peak_low, fastest;
    char why[160];
} outcome;

void run(const char *firmware, bench *b, outcome *o, bool verbose);

#endif
