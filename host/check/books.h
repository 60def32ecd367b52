/* books.h: the energy and momentum balance of a run, kept in double beside it.
 *
 * What balances is kinetic + stored energy, or the energy integral where that is not their sum (host/derive/equations.h);
 * book_account says how. The powers are those that the ledger (core/ledger.h) keeps by statement, summed; the integration
 * is not the ledger's, on purpose. A ledger is part of the scene: it flies on the board, in the run's numbers, with the
 * method's own stages. These books judge the run, ledger included, and share neither: double, and Simpson's rule on the
 * steps' ends, which is of the same order as Runge-Kutta's. The inputs keep the values that they start with. What is
 * left over is the numerical error of the run (and of that rule). */
#ifndef CHECK_BOOKS_H
#define CHECK_BOOKS_H

#include "host/engine/engine.h"

/* An account of the energy or of a momentum: what is left over is the level now, less that at the start and the entries. An
 * entry is positive where it gives (the work of a motor, a push along a coordinate), negative where it takes (a damper, an
 * impact). An exact solution leaves nothing over. */
typedef struct book_account {
    double level[2]; /* at the start, now */
    double left;     /* left over, with what was entered so far */
    double largest;  /* size of the largest entry */
} book_account;

book_account account_of(const double level[2]);
void account_enter(book_account *a, double given);

/* Mean and spread of a series, by Welford's recurrence, from its first value on. */
typedef struct spread {
    double first;
    double mean;    /* less `first` */
    double squares; /* sum of (value - mean)^2 */
    bool pushed;    /* of a rate: its acceleration was not zero throughout */
} spread;

typedef struct books {
    const image *image;
    double *input; /* [image->inputs] */
    evaluator *evaluator;
    double *value;        /* results of the image's books list */
    double *momentum;     /* [count] at the start */
    double *momentum_now; /* [count] */
    double *drift;        /* [count] largest change since */
    double *terms;        /* [count] sum of the terms' magnitudes, largest of those looked at */
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    double kinetic_J[2]; /* start, now */
    double moving_J[2];  /* the same without what is odd in the rates */
    double stored_J[2];
    double energy_J[2];   /* what balances: kinetic + stored, or the energy integral */
    double input_J;       /* work of the inputs so far */
    double loss_J;        /* losses so far */
    double power_W[2][2]; /* input and loss power at the last two even steps' ends */
    spread kinetic;       /* over the steps */
    spread stored;
    spread *rate; /* [count] */
    spread *push; /* [count] momenta without what is even in the rates: */
    bool *
        frame; /* [count] takes part in a momentum that every motion keeps: a common speed adds nothing but its mean */
    double *lean; /* [count] what is even, and */
    bool
        leans; /* whether there is any: a magnetic field's, say, which depends on where the origin is */
    double *off;   /* how far off each of value[] may be, in units of rounding */
    double size_J; /* largest |T| + |V| */
    double
        rounding_J; /* what rounding a step once changes the energy by, at most of those looked at */
    double
        computing_J; /* what rounding may leave of the energy's computation, at most of those looked at */
    double lost_J;      /* what a step may lose of entries too small for float, likewise */
    double rule_J;      /* by how much the rule may be off, in all */
    double kept_J;      /* error at the last even step */
    double most_J;      /* the largest size that it had at an even step */
    double jump_J;      /* its largest change between two even steps, */
    double jump_s;      /* which ended here */
    bool negative;      /* the kinetic energy was: no masses are so, */
    double negative_s;  /* there first */
    bool undefined;     /* an energy, a power or a momentum was not a finite number */
    double undefined_s; /* there first */
    uint64_t entries;
    double time_s; /* of the last */
    double step_s;
} books;

/* A run of a system given outright has no books: NULL. */
books *books_open(const image *im);
void books_close(books *b);
/* Enter the state after each step, the start included. */
void books_enter(books *b, const engine_kind *kind, const void *run);
/* The energy's account, with what the inputs gave and the losses took. */
book_account books_account(const books *b);
/* Root mean square of a momentum, without the mean where a common speed may have added it. */
double books_momentum(const books *b, int unknown);
/* How far energy went to and fro: see energy_residual.h. */
double books_swing_J(const books *b);
/* What a step's roundings to numbers of this kind change the energy by: of the state, of the accelerations and of the
 * powers that the books add up. *computing_J: what those of the energy itself, in double, leave at one time. */
double books_rounding_J(books *b, const engine_kind *kind, const void *run, double *computing_J);
/* What the run's own books, of a scene with contacts, may have lost of entries that are too small for float, in all
 * steps; after books_rounding_J(). */
double books_lost_J(const books *b);

#endif
