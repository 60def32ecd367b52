/* The rig as a plant: rotor, motor and drive stage, slot sensors, load cell, supply. */
#ifndef TESTS_OUTSIDE_BENCH_PLANT_H
#define TESTS_OUTSIDE_BENCH_PLANT_H
#include "tests/outside/bench_draw.h"

enum { ANGLE, SPEED, WORK, BENT, BENDING, STATES };
enum { KEPT = 128, QUEUE = 64, STEP_US = 50 };

typedef struct
{ /* first Fourier coefficients: [0] of the force, [1] of the force that the load train passes on */
    double cosine[2], sine[2], seconds;
} turn;

typedef struct {
    double seconds;
    uint32_t channel;
} pulse;

typedef struct {
    const bench *b;
    dice d;
    double t, y[STATES], inertia, duty, enable, turn_began;
    /* held: dry friction holds the rotor at rest */
    bool stuck, cut, pressed, stopped, stop_told, held, whole;
    uint32_t watchdog_us;
    uint64_t now_us, kicked_us;
    int queued;
    double play_at, jitter[2], lead[2]; /* jitter (s), lead (rad): of each sensor's next pulse */
    double force[2], energy_0, energy_off, peak_high, peak_low;
    long turns;
    turn now, past[KEPT];
    pulse queue[QUEUE];
} plant;

void plant_start(plant *p, const bench *b);
void plant_step(plant *p, double h);
double plant_sample(plant *p, int channel, bool recording); /* channel in the rig's hello */

#endif
