/* books.h: the energy and momentum balance of a run, integrated in double during the run.
 *
 * The balanced energy is kinetic + stored energy, or the energy integral if that differs from the sum
 * (host/derive/equations.h). The powers are sums of those in the ledger (core/ledger.h). The ledger is part of the
 * scene: the board computes it, in the run's number type, with the method's own stages. This balance checks the run and
 * its ledger, so it is integrated differently: in double, with Simpson's rule on the ends of the steps. That rule has
 * the same order as RK4. The inputs keep their start values. The residual is the numerical error of the run and of
 * Simpson's rule. */
#ifndef CHECK_BOOKS_H
#define CHECK_BOOKS_H

#include "host/engine/engine.h"

/* An account of the energy or of a momentum. Its residual is the present level, minus the level at the start, minus the
 * entries. An entry is positive if it adds (a motor's work, a push along a coordinate), negative if it removes (a damper, an
 * impact). An exact solution has a zero residual. */
typedef struct book_account {
    double level[2]; /* level at the start, and the present one */
    double left;     /* residual after the entries so far */
    double largest;  /* size of the largest entry */
} book_account;

book_account account_of(const double level[2]);
void account_enter(book_account *a, double given);

/* Mean and spread of a series, by Welford's recurrence. `first` is its first value. */
typedef struct spread {
    double first;
    double mean;    /* mean of (value - first) */
    double squares; /* sum of the squared deviations from the mean */
    bool pushed;    /* for a rate: its acceleration was nonzero at some step */
} spread;

typedef struct books {
    const image *image;
    double *input; /* [image->inputs] */
    evaluator *evaluator;
    double *value;        /* results of the image's books list */
    double *momentum;     /* [count] at the start of the run */
    double *momentum_now; /* [count] */
    double *drift;        /* [count] largest change of a momentum since the start */
    double *terms;        /* [count] largest sampled sum of the sizes of a momentum's terms */
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    double kinetic_J[2]; /* start, now */
    double moving_J[2];  /* kinetic_J without terms of odd order in the rates */
    double stored_J[2];
    double energy_J[2];   /* balanced: kinetic + stored, or the energy integral */
    double input_J;       /* work of the inputs so far */
    double loss_J;        /* losses since the start */
    double power_W[2][2]; /* input and loss power: [0] after 0, 2, 4, ... steps, [1] a step later */
    spread kinetic;       /* spread over the steps */
    spread stored;
    spread *rate; /* [count] */
    spread *push; /* [count] momenta without rateless[] */
    /* [count] does this momentum belong to a conserved sum? A common speed of its bodies then only changes the mean */
    bool *frame;
    /* [count] the part of each momentum that stays the same if all rates are reversed; it depends on the origin */
    double *rateless;
    bool has_rateless;  /* a rateless[] is nonzero, as in a magnetic field */
    double *off;        /* bounds on the round-off of value[], in units of the unit round-off */
    double size_J;      /* largest |T| + |V| */
    double rounding_J;  /* largest sampled energy change by the round-off of one step */
    double computing_J; /* largest sampled round-off of the evaluation of the energy */
    double lost_J;      /* largest sampled underflow of a step's entries in float */
    double rule_J;      /* error bound of the integration rule, over the whole run */
    double pair_J;      /* the largest part of rule_J that two steps have */
    double kept_J;      /* residual at the last even step */
    double most_J;      /* largest size of the residual at an even step */
    double jump_J;      /* largest change of the residual between two even steps */
    double jump_s;      /* end of the two steps with the change jump_J, s */
    bool negative;      /* the kinetic energy was negative, which no masses allow */
    double negative_s;  /* when the kinetic energy was first negative, s */
    bool undefined;     /* an energy, a power or a momentum was not a finite number */
    double undefined_s; /* time of the first energy, power or momentum that was not finite, s */
    uint64_t entries;
    double time_s; /* time of the last entry, s */
    double step_s;
} books;

/* NULL for a system without energies. */
books *books_open(const image *im);
void books_close(books *b);
/* Enter the state after each step, the start included. */
void books_enter(books *b, const engine_kind *kind, const void *run);
book_account books_account(const books *b);
/* Root mean square of a momentum over the run. If the momentum is part of a conserved sum (frame[]), its mean is subtracted. */
double books_momentum(const books *b, int unknown);
/* The largest swing of an energy (energy_residual.h). */
double books_swing_J(const books *b);
/* Energy change by the round-off of one step in numbers of this kind. Counts the round-off of the state, of the accelerations
 * and of the integrated powers. *computing_J: the round-off of one evaluation of the energy in double. */
double books_rounding_J(books *b, const engine_kind *kind, const void *run, double *computing_J);
/* Error bound of the integration rule, with that of a single last step, which is a trapezoid; infinite after one step. */
double books_rule_J(const books *b);
/* Energy lost to underflow over all steps, in the ledger of a float run with contacts. Call books_rounding_J() first. */
double books_lost_J(const books *b);

#endif
