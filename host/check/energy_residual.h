/* energy_residual.h: the energy residual of a run: its definition, its limit and its words.
 *
 * The residual is the change of the energy (T + V, or the energy integral if that differs) less the work of inputs, losses
 * and contacts. It is zero for an exact solution. The ratio is the residual divided by the largest entry of the balance;
 * docs/dev/events.md#the-energy-residual lists the entries, and the allowance for round-off. All entries are changes, sums or
 * means over time, so that the moment of passing a singular position does not set the measure.
 *
 * With --matrix exact a step of any length is the motion itself, but the integration of the powers is not exact: the
 * difference of two integration rules then counts as round-off. With --stabilized the residual is the larger of two: with
 * the energy that the steps gave back, or without it. A zero residual has the ratio 0. */
#ifndef CHECK_ENERGY_RESIDUAL_H
#define CHECK_ENERGY_RESIDUAL_H

#include <stdio.h>

#include "books.h"

/* Above this ratio a run is not trusted. */
#define ENERGY_RESIDUAL_LIMIT 1e-3

#define ENERGY_RESIDUAL_COLUMN "energy_residual"

typedef struct energy_residual {
    bool known; /* false: no energies, energies that are not finite, or contacts without a ledger */
    book_account energy; /* the energy's account */
    double inputs_J;     /* work on the energy, by source; negative: taken from it */
    double losses_J;
    double contacts_J;
    double left_J;     /* residual, signed: energy.left */
    double largest_J;  /* the largest entry, or the least value that round-off allows for it */
    bool rounded;      /* largest_J is the least value that round-off allows */
    double rounding_J; /* round-off of all steps, and of the evaluation of the energy */
    double ratio;      /* |left| / largest, >= 0; infinite for a residual without entries */
    bool stabilized;   /* the steps gave energy back (--stabilized) */
    double lost_J;     /* size of the residual without the energy that the steps gave back */
    bool saturated;    /* values were clamped to their range */
    bool exact;        /* the steps are exact (--matrix exact) */
    double jump_s;     /* time of a sudden change of the residual; below 0: it changed gradually */
} energy_residual;

energy_residual energy_residual_of(books *b, const engine_kind *kind, const void *run);
/* Is the residual larger than its round-off, and the ratio above the limit? False if the residual is unknown. */
bool energy_residual_lost(const energy_residual *b, double limit);
/* The line of the summary; empty if unknown. */
void energy_residual_print(FILE *out, const energy_residual *b);

/* === the run's own ledger (core/ledger.h), read by account ===================================== */

/* The source of an entry. */
typedef enum giver {
    GIVER_ENERGIES, /* the term dL/dq in a momentum's account */
    GIVER_FORCE,    /* a statement Q */
    GIVER_DAMPER,   /* a statement F */
    GIVER_CONTACT,
    GIVER_INPUT, /* changes of an input that occurs in the energies */
    GIVER_STEPS  /* corrections of the drift (--stabilized) */
} giver;

typedef struct kept_entry {
    giver by;
    place at;     /* the statement; unused for GIVER_ENERGIES and GIVER_STEPS */
    double given; /* energy or momentum given to the account since the start, SI */
} kept_entry;

typedef struct kept_account {
    kept_entry *entry; /* [entries] statements, inputs, contacts, then steps; each in file order */
    int entries;
    double left; /* residual, as reported by the core in the run's numbers */
} kept_account;

/* Account 0 is the energy's, the others are the momenta of im->ledger.unknown[]. The scene must keep a ledger.
 * All zero before the first step. Free with kept_account_free(). */
kept_account kept_account_read(const image *im, const engine_kind *kind, const void *run,
                               int account);
void kept_account_free(kept_account *k);

/* === the books in words ========================================================================== */

/* Prints the entries of the energy balance by source, and the conserved momenta. */
void books_print(FILE *out, const books *b, const energy_residual *balance);

/* The energy's and the momenta's accounts by statement, from the run's own ledger (`with ledger`). `b` provides the levels. */
void books_print_kept(FILE *out, const image *im, const engine_kind *kind, const void *run,
                      const books *b);

#endif
