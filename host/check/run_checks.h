/* run_checks.h: findings against a run, made while it goes on and at its end.
 *
 * Two checks judge every run: a finer run in double (step_doubling.h), and the energy residual (energy_residual.h). The others find
 * faults that both may miss: a singular matrix, a pole or contact that a step jumped over, too few digits, forcing that aliases
 * with the step, and steps with too many events. `whirl run` and `whirl sweep` share these checks, so that both report the same for
 * the same point. The checks never change the run. docs/warnings.md has the remedies. */
#ifndef CHECK_RUN_CHECKS_H
#define CHECK_RUN_CHECKS_H

#include "energy_residual.h"
#include "finding.h"
#include "host/check/horizon.h"

typedef struct finding {
    bool reported; /* the finding is reported */
    double value;  /* measured, in the row's unit */
    /* time from which on the finding is true, or the time of one event; below 0: the whole run */
    double at_s;
    int component; /* the component or contact concerned, or -1 */
} finding;

typedef struct run_checks {
    const image *image;
    const engine_kind *kind;
    void *run;
    bool whole;       /* made by run_checks_whole() */
    bool interrupted; /* set by run_checks_whole() */
    budget own;
    budget *budget; /* shared by all checks: &own, or the caller's */
    double part;    /* factor of the limits of energy and accuracy: 1, and less for a remedy */
    books *books;   /* NULL for a system given by its equations */
    pole_crossing *jumped; /* search for poles; NULL: the scene needs none */
    /* the comparison with a finer run; NULL: it would take too long */
    step_doubling *doubling;
    uint64_t overruns;                       /* steps with too many events */
    double overran_s;                        /* begin of the first step with too many events */
    uint64_t in_overruns[WH_CONTACTS_LIMIT]; /* events of each contact in the overruns */
    double taken_J;  /* sum of the sizes of the energy changes in steps with too many events */
    double energy_J; /* the energy after the last step */
    energy_residual balance; /* set by run_checks_end(), like `found` and `warned` */
    finding found[FINDINGS];
    unsigned warned; /* the warnings, as bits */
} run_checks;

/* If the budget is NULL, the checks have one of their own, and the run's loop fills it. All arguments must outlive the result. */
run_checks *run_checks_open(const image *im, const engine_kind *kind, void *run, budget *of);
/* Makes a run to its end, or to an interrupt (host/os/system.h), with all checks whatever they cost. `progress` is called from
 * time to time with the share of completed steps; or NULL. run_checks_close() ends the run. */
run_checks *run_checks_whole(const image *im, const engine_kind *kind,
                             void (*progress)(double share, void *context), void *context);
void run_checks_close(run_checks *v); /* NULL is fine */
/* Enter the state after each step, the start included. */
void run_checks_enter(run_checks *v);
/* The run is over; `status` is that of its last step. A failed run has no findings, but its balance is known. */
void run_checks_end(run_checks *v, wh_status status);
/* The findings, as bits, for which the exit status is 1. */
unsigned run_checks_fails(const run_checks *v, double strict);
/* The findings, as bits, for which some steps were not checked because the budget was too small. */
unsigned run_checks_unlooked(const run_checks *v);

#endif
