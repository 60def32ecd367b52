/* verdict.h: can a run be relied on? The one place where what is known of a run while it goes on is put together and
 * judged: its books (books.h, belief.h), how it went (watch.h, advice.h) and what its contacts did (busy.h, retrial.h).
 * `whirl run` says it in words, `whirl sweep` counts points: both ask here, so that they never disagree. Nothing of it
 * touches the run. */
#ifndef RUN_VERDICT_H
#define RUN_VERDICT_H

#include "advice.h"
#include "retrial.h"

/* What may be said against a run. */
typedef enum verdict_kind {
    VERDICT_MASS,     /* rounding leaves little of its mass matrix */
    VERDICT_FOLDED,   /* a constant of it was lost beside a larger one */
    VERDICT_ENERGY,   /* its energies do not balance */
    VERDICT_SINGULAR, /* it passed a singular position that its steps do not resolve */
    VERDICT_JUMPED,   /* a step jumped over a pole of an expression, or through a contact */
    VERDICT_BETWEEN,  /* what it is driven by goes on between the stages of its steps */
    VERDICT_SWING,    /* a system given by its equations lost or gained a swing */
    VERDICT_CONTACTS, /* its contacts were too busy for its steps */
    VERDICT_KINDS
} verdict_kind;

#define VERDICT_BIT(kind) (1U << (kind))

typedef struct verdict {
    const image *image;
    const engine_kind *kind;
    books *books; /* NULL of a system given by its equations */
    watch *watch;
    busy *busy;     /* NULL without contacts */
    belief balance; /* behind verdict_end() */
    retrial retrial;
    advice about;
    unsigned against; /* as bits */
} verdict;

verdict *verdict_open(const image *im, const engine_kind *kind);
void verdict_close(verdict *v); /* NULL is fine */
/* Enter the state after each step, the start included. */
void verdict_enter(verdict *v, const void *run);
/* The run is over, `failed` if it left all bounds: what balances is known, and of a run that did not fail what is to be
 * said against it. Finer runs are made where contacts were busy; `stop` ends them, or is NULL. */
void verdict_end(verdict *v, const void *run, bool failed, const volatile sig_atomic_t *stop);
/* Everything of that in words, with causes and cures; `fails`: the balance as an error, for --strict. */
void verdict_say(FILE *out, verdict *v, bool fails);

#endif
