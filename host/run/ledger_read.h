/* ledger_read.h: what the run itself kept (core/ledger.h), read by account. */
#ifndef RUN_LEDGER_READ_H
#define RUN_LEDGER_READ_H

#include "engine.h"

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
