/* books.h: the energy and momentum balance of a run, integrated in double during the run.
 *
 * The balanced energy is T + V, or the energy integral if that differs (host/derive/equations.h). The input and loss
 * powers are sums of powers in the ledger (core/ledger.h). The run integrates the ledger with the stages of its method.
 * The balance integrates the same powers by Simpson's rule, which has order 4 like RK4. It uses the states at the ends
 * of steps, and the start values of inputs. The residual contains the run's error and the error of Simpson's rule. */
#ifndef CHECK_BOOKS_H
#define CHECK_BOOKS_H

#include "host/engine/engine.h"

/* Mean and variance of a series, by Welford's recurrence. */
typedef struct spread {
    double first;   /* first value */
    double mean;    /* mean of (value - first) */
    double squares; /* sum of the squared deviations from the mean */
    bool pushed;    /* for a rate: its acceleration was nonzero at some step */
} spread;

typedef struct books {
    const image *image;
    state_list list;      /* IMAGE_BOOKS */
    double *value;        /* list.result */
    double *momentum;     /* [count] at the start of the run */
    double *momentum_now; /* [count] */
    double *drift;        /* [count] largest change of a momentum since the start */
    double *terms;        /* [count] largest sampled sum of |term| of a momentum */
    double state[3 * IMAGE_COMPONENTS_MAX]; /* now: angles, then reals */
    double kinetic_J[2];                    /* start, now */
    double moving_J[2];                     /* kinetic_J without terms of odd order in the rates */
    double stored_J[2];
    double energy_J[2];   /* T + V, or the energy integral if that differs */
    double input_J;       /* work of the inputs since the start */
    double loss_J;        /* losses since the start */
    double power_W[2][2]; /* [0][] after even, [1][] after odd steps; [][0] input, [][1] loss */
    spread kinetic;       /* series of moving_J[1] */
    spread stored;
    spread *rate;       /* [count] */
    spread *push;       /* [count] momenta without rateless[] */
    bool *frame;        /* [count] the mean of the momentum depends on the reference frame */
    double *rateless;   /* [count] the part of each momentum that is even in the rates */
    bool has_rateless;  /* a rateless[] is nonzero, as in a magnetic field */
    double *off;        /* bounds on the round-off of value[], divided by the unit round-off */
    double size_J;      /* largest |T| + |V| */
    double rounding_J;  /* largest sampled energy change that round-off causes in one step */
    double computing_J; /* largest sampled round-off of the evaluation of the energy */
    double lost_J;      /* largest sampled energy that the ledger loses to underflow in one step */
    double rule_J;      /* error bound of the integration rule, over the whole run */
    double pair_J;      /* largest error bound of one pair of steps */
    double kept_J;      /* residual at the last even step */
    double most_J;      /* largest |residual| at an even step */
    double jump_J;      /* largest change of the residual in one pair of steps, signed */
    double jump_s;      /* end of the pair of steps with jump_J, s */
    bool negative;      /* the kinetic energy was negative, which no masses allow */
    double negative_s;  /* first time with a negative kinetic energy, s */
    bool undefined;     /* an energy, a power or a momentum was not a finite number */
    double undefined_s; /* first time with such a number, s */
    uint64_t entries;
    double time_s; /* time of the last entry, s */
    double step_s;
} books;

/* NULL for a system without energies. */
books *books_open(const image *im);
void books_close(books *b);
/* Call it at the start and after each step. */
void books_enter(books *b, const engine_kind *kind, const void *run);
/* Returns the energy now, minus the energy at the start, minus input_J, plus loss_J; J. */
double books_left_J(const books *b);
/* RMS over the run of (momentum - rateless[]); if frame[] is set, the standard deviation of this difference. */
double books_momentum(const books *b, int unknown);
/* Returns the largest swing of `kinetic`, of `stored`, or of 0.5 * books_momentum() * rate[] of a coordinate. A swing
 * is sqrt(8) standard deviations. */
double books_swing_J(const books *b);
/* Samples rounding_J, computing_J and lost_J at the present state. Returns rounding_J plus the round-off of size_J. */
double books_rounding_J(books *b, const engine_kind *kind, const void *run);
/* Error bound of the work since the start, from Simpson's rule; J. It is infinite after only one step. */
double books_rule_J(const books *b);

#endif
