/* energy_residual.h: the energy residual of a run.
 *
 * The residual is the change of the energy (T + V, or the energy integral if that differs) minus the work of inputs,
 * losses and contacts; zero for an exact solution. The ratio is |residual| divided by the largest entry of the balance.
 * docs/dev/events.md#the-energy-residual lists the entries, and the allowance for round-off.
 *
 * With --matrix exact, only the integration of the powers has an error. rounding_J includes the bound on this error.
 * With --stabilized the residual is the larger of two values: with and without the energy corrections. */
#ifndef CHECK_ENERGY_RESIDUAL_H
#define CHECK_ENERGY_RESIDUAL_H

#include <stdio.h>

#include "books.h"

/* A run is not trusted if |residual| / (largest entry of the balance) exceeds this. */
#define ENERGY_RESIDUAL_LIMIT 1e-3

#define ENERGY_RESIDUAL_COLUMN "energy_residual"

typedef struct energy_residual {
    bool known; /* false: no energies, energies that are not finite, or contacts without a ledger */
    double inputs_J;   /* work of inputs since the start; below 0 if it removes energy */
    double losses_J;   /* work of losses, with the same sign rule */
    double contacts_J; /* work of contacts, with the same sign rule */
    double left_J;     /* residual, signed */
    double largest_J;  /* largest |entry|, at least rounding_J / ENERGY_RESIDUAL_LIMIT */
    bool rounded;      /* every entry is below rounding_J / ENERGY_RESIDUAL_LIMIT */
    double rounding_J; /* allowance for the round-off of all steps and of evaluating the energy */
    double ratio;      /* |left_J| / largest_J; 0 for a zero residual */
    bool stabilized;   /* the steps corrected the energy (--stabilized) */
    double lost_J;     /* |residual| without the energy corrections */
    bool saturated;    /* values were clamped to their range */
    bool exact;        /* the steps are exact (--matrix exact) */
    double jump_s;     /* time of a sudden change of the residual; below 0: it changed gradually */
} energy_residual;

energy_residual energy_residual_of(books *b, const engine_kind *kind, const void *run);
/* Returns whether |left_J| > rounding_J and ratio > limit. Returns false if the residual is unknown. */
bool energy_residual_lost(const energy_residual *b, double limit);
/* Prints the line of a run's summary about the residual. Prints nothing if the residual is unknown. */
void energy_residual_print(FILE *out, const energy_residual *b);

/* === the books in words ========================================================================== */

/* Prints the energy balance with one entry each for inputs, losses and contacts. Also prints the conserved momenta. */
void books_print(FILE *out, const books *b, const energy_residual *balance);

/* Prints the energy and momentum balances by statement: entries from the ledger, start and end values from `b`. */
void books_print_kept(FILE *out, const image *im, const engine_kind *kind, const void *run,
                      const books *b);

#endif
