/* naive_main.c: main program for a mechanism stepped by hand-written code or by another library (mk/peers). It first checks the
 * motion. Its commands are those of boards/programs/bench.c:
 *
 *     PROGRAM            the steps that mk/count/count_rows.sh counts
 *     PROGRAM steps N    N steps only
 *     PROGRAM time N     N steps; prints the nanoseconds per step */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

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
    naive_read(state);
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

static double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int count(void) {
    double state[NAIVE_STATES_MAX];
    wh_count_begin();
    wh_count_end();
    run(state, WARM_STEPS);
    /* The counter counts while a function named to it runs, and is read in between. */
    for (unsigned i = 0; i < COUNTED_STEPS; i++) {
        wh_count_begin();
        naive_step(state, STEP_S);
        wh_count_end();
    }
    printf("count %s rk4 double 1 %u\n", naive.name, COUNTED_STEPS);
    return wrong();
}

int main(int argc, char **argv) {
    double state[NAIVE_STATES_MAX];
    const unsigned long steps = argc == 3 ? strtoul(argv[2], NULL, 10) : 0;
    if (argc == 1) {
        return count();
    }
    if (steps == 0 || (strcmp(argv[1], "steps") != 0 && strcmp(argv[1], "time") != 0)) {
        fprintf(stderr, "usage: %s [steps|time N]\n", argv[0]);
        return 2;
    }
    const double begin_s = now_s();
    run(state, steps);
    if (strcmp(argv[1], "time") == 0) {
        printf("%.6g\n", (now_s() - begin_s) * 1e9 / (double)steps);
    }
    return 0;
}
