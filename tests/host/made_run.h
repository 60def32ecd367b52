/* made_run.h: a run that is made up: any sequence of states of two bodies on springs, coupled by their inertia too, one pushed and
 * one damped, perhaps in a magnetic field; and their energies, momenta and slopes by formulas. Of one at a time. */
#ifndef TESTS_HOST_MADE_RUN_H
#define TESTS_HOST_MADE_RUN_H

#include "command.h"
#include "derived.h"
#include "host/engine/engine.h"

enum { STEPS_MOST = 70, X = 0, Y = 1, VX = 2, VY = 3, N = 4 };

typedef struct made_up_run {
    double mx, my, coupled; /* kg */
    double k, h;            /* N/m */
    double damping;
    double push;
    double magnetic; /* kg/s */
    double step_s;
    double state[STEPS_MOST + 1][N]; /* as this file counts them */
    uint64_t at;                     /* the step that it is at */
    const image *image;
} made_up_run;

extern made_up_run made_run;
extern const engine_kind made_run_kind;

/* Its numbers; its scene, of which made_run.image is to be made; its states, which walk about. */
void made_run_draw(dice *d, bool powers, bool magnetic);
derived made_run_derive(void);
void made_run_states(dice *d, uint64_t steps);

double made_run_kinetic(const double *s); /* without what is odd in the rates, */
double made_run_odd(const double *s);     /* which is this */
double made_run_stored(const double *s);
double made_run_energy(const double *s);
/* 0: what the push gives; 1: what the damper takes. W. */
double made_run_power(const double *s, int which);
/* `whole`: with the field's. */
double made_run_momentum(const double *s, int i, bool whole);
void made_run_slope(const double *s, double *slope);
/* A step on, in so many of Runge-Kutta 4. */
void made_run_go(double *s, int parts);
/* Where the image keeps component i of these states. */
int made_run_place(int i);

#endif
