/* made_run.h: a synthetic run: any sequence of states of two bodies on springs with coupled inertia, a push, a damper
 * and perhaps a magnetic field. Energies, momenta and slopes come from formulas. One run at a time. */
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
    double state[STEPS_MOST + 1][N]; /* in the order of this file */
    uint64_t at;                     /* current step */
    const image *image;
} made_up_run;

extern made_up_run made_run;
extern const engine_kind made_run_kind;

/* Draws its numbers, its scene (for made_run.image) and its states, a random walk. */
void made_run_draw(dice *d, bool powers, bool magnetic);
derived made_run_derive(void);
void made_run_states(dice *d, uint64_t steps);

double made_run_kinetic(const double *s); /* without the terms odd in the rates, */
double made_run_odd(const double *s);     /* which are these */
double made_run_stored(const double *s);
double made_run_energy(const double *s);
/* Power in W: number 0 is that of the push, 1 the loss of the damper. */
double made_run_power(const double *s, int which);
/* `whole`: with the field's part. */
double made_run_momentum(const double *s, int i, bool whole);
void made_run_slope(const double *s, double *slope);
/* One step in so many substeps of Runge-Kutta 4. */
void made_run_go(double *s, int parts);
/* Index of component i of these states in the image. */
int made_run_place(int i);

#endif
