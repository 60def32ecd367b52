/* energy_residual.h: can a run be believed? The one place of the limit, the measure and the words.
 *
 * Left over is what the books do not account for at the end of a run: the change of the energy (T + V, or the
 * energy integral where that is not the same) less the work of the inputs, the losses and what contacts took. An
 * exact solution leaves nothing. It is measured by the largest entry of the books:
 *
 *   - the net change of the kinetic and of the stored energy, the work of the inputs, the losses, and what
 *     each contact took;
 *   - how far kinetic and stored energy swung: sqrt(8) times their standard deviation over the steps, which of a
 *     sine is its range;
 *   - for each coordinate, half the root mean square of its momentum times the swing of its rate: the energy that
 *     its changes of speed passed on, where kinetic energy only moves from one coordinate to another.
 *
 * Of a kinetic energy that has terms linear in the rates, as of a magnetic field, neither these count nor the momentum that
 * they make: both depend on where the origin is.
 *
 * All of them are changes: neither a constant in V nor a heavy clock that turns evenly counts. They are means over
 * time where they are no sums, so that the moment at which a singular position is passed does not set the measure.
 * What rounding explains (below) is no fault of the step: an entry counts as at least 1/ENERGY_RESIDUAL_LIMIT times that.
 * It is the rounding of the state and of the accelerations to the run's numbers at each step, and that of the
 * energy's own computation at the start and at the end: of the terms in which it is computed, which are large where
 * a sum such as V = k (x - b)^2/2 is multiplied out and x is far from the origin.
 * With --matrix exact a step is the motion itself, however long it is, but what the books integrate between is not: by how
 * much two rules of integration differ counts as rounding does. What --stabilized gave back counts as left over, for steps had
 * lost it; or what it gave too much, where that is more. With nothing left over, the ratio is 0. */
#ifndef CHECK_ENERGY_RESIDUAL_H
#define CHECK_ENERGY_RESIDUAL_H

#include <stdio.h>

#include "books.h"

/* Beyond this ratio a run is not believed. */
#define ENERGY_RESIDUAL_LIMIT 1e-3

/* The name of the ratio where it is a column. */
#define ENERGY_RESIDUAL_COLUMN "energy_left_over"

typedef struct energy_residual {
    bool known; /* false: no energies, no finite ones, or books of contacts that cannot be kept */
    book_account energy; /* what balances, and the largest entry */
    double inputs_J;     /* entries of the energy, by what gave them: negative where it took */
    double losses_J;
    double contacts_J;
    double left_J;    /* left over, signed: energy.left */
    double largest_J; /* the largest entry, or what rounding makes of it */
    double entry_J;   /* the largest entry as it is */
    double size_J;    /* largest |T| + |V| */
    bool rounded;     /* it is rounding that sets it */
    double
        rounding_J; /* what rounding explains of it: of a step, by the root of the steps, and of the energy itself */
    double computing_J; /* of that, what the energy's own computation may leave */
    double ratio;       /* |left| / largest, >= 0; infinite with something left over of nothing */
    bool stabilized;    /* steps gave back (--stabilized) */
    double lost_J;      /* of these: what would be missing without that, in size */
    bool saturated;     /* values were held at an end of their range */
    bool slow;          /* rounding took a share of what steps were to add (slow.h) */
    bool exact;         /* the steps are exact (--matrix exact) */
    double jump_s;      /* where the balance was lost at one go; below 0: nowhere */
} energy_residual;

energy_residual energy_residual_of(books *b, const engine_kind *kind, const void *run);
/* Is it beyond the limit? What is not known is not. */
bool energy_residual_lost(const energy_residual *b, double limit);
/* The line of the summary; nothing when it is not known. */
void energy_residual_print(FILE *out, const energy_residual *b);

/* === what the run itself kept (core/ledger.h), read by account ================================= */

/* Who gave an entry, or took it. */
typedef enum giver {
    GIVER_ENERGIES, /* dL/dq, of a momentum */
    GIVER_FORCE,    /* a statement Q */
    GIVER_DAMPER,   /* a statement F */
    GIVER_CONTACT,
    GIVER_INPUT, /* changes of an input that the energies name */
    GIVER_STEPS  /* what was given back of the drift (--stabilized) */
} giver;

typedef struct kept_entry {
    giver by;
    place at;     /* the statement; none for GIVER_ENERGIES and GIVER_STEPS */
    double given; /* since the start, SI */
} kept_entry;

typedef struct kept_account {
    kept_entry *entry; /* [entries] in the order of the file: statements, inputs, contacts, steps */
    int entries;
    double left; /* left over, as the core tells it in the run's numbers */
} kept_account;

/* Account 0 is the energy's, the others are the momenta of im->ledger.unknown[]. The books must be kept. All zero
 * before the first step. Free with kept_account_free(). */
kept_account kept_account_read(const image *im, const engine_kind *kind, const void *run,
                               int account);
void kept_account_free(kept_account *k);

#endif
