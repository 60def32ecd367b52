/* naive_main.c: main program for a mechanism stepped by hand-written code. It counts steps as boards/programs/bench.c does, then
 * checks the motion. */
#include <math.h>
#include <stdio.h>

#include "naive.h"

/* Starts in the middle of the motion: libm's sine takes longer for angles beyond a few radians. */
#define WARM_STEPS 3000U
#define COUNTED_STEPS 100U
#define STEP_S 1e-3

void wh_count_begin(void);
void wh_count_end(void);

__attribute__((noinline)) void wh_count_begin(void) { __asm__ volatile("" : : "i"(1) : "memory"); }
__attribute__((noinline)) void wh_count_end(void) { __asm__ volatile("" : : "i"(2) : "memory"); }

static void run(double state[], unsigned long steps) {
    naive_start(state);
    for (unsigned long i = 0; i < steps; i++) {
        naive_step(state, STEP_S);
    }
}

static int wrong(void) {
    double state[NAIVE_STATES_MAX];
    double worst = 0.0;
    run(state, (unsigned long)floor(naive.end_s / STEP_S + 0.5));
    for (int i = 0; i < naive.states; i++) {
        worst = fmax(worst, fabs(state[i] - naive.end[i]));
    }
    if (worst > 0.0 && worst <= naive.most) {
        return 0;
    }
    fprintf(stderr, "%s is off by %.3g at %g s\n", naive.name, worst, naive.end_s);
    return 1;
}

int main(void) {
    double state[NAIVE_STATES_MAX];
    wh_count_begin();
    wh_count_end();
    run(state, WARM_STEPS);
    for (unsigned i = 0; i < COUNTED_STEPS; i++) {
        wh_count_begin();
        naive_step(state, STEP_S);
        wh_count_end();
    }
    printf("count %s rk4 double 1 %u\n", naive.name, COUNTED_STEPS);
    return wrong();
}
