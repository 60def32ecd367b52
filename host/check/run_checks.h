/* run_checks.h: the checks that make findings, during a run and at its end.
 *
 * Two checks judge every run: a finer run in double (step_doubling.h), and the energy residual (energy_residual.h). The
 * others find errors that both may miss: a singular matrix, a pole or contact that a step jumped over, too few digits,
 * aliasing, and steps with too many events. `whirl run` and `whirl sweep` share the checks. They never change the run.
 * docs/warnings.md has the remedies. */
#ifndef CHECK_RUN_CHECKS_H
#define CHECK_RUN_CHECKS_H

#include "energy_residual.h"
#include "finding.h"
#include "host/check/horizon.h"

typedef struct finding {
    bool reported;
    double value; /* measured, in the unit of its finding_row */
    double at_s;  /* when the problem occurs or begins, s; below 0: in the whole run */
    int component; /* column (FINDING_ACCURACY, FINDING_ALIASED), missed_found.what (FINDING_MISSED), or -1 */
} finding;

typedef struct run_checks {
    const image *image;
    const engine_kind *kind;
    void *run;
    bool whole;       /* made by run_checks_whole() */
    bool interrupted; /* set by run_checks_whole() */
    budget own;
    budget *budget; /* shared by all checks: &own, or the caller's */
    double part;  /* factor on the limits of energy and accuracy; below 1 for trials of a remedy */
    books *books; /* NULL for a system given by its equations */
    pole_crossing *jumped;                   /* search for poles; NULL: the scene needs none */
    step_doubling *doubling;                 /* NULL: the finer run would take too long */
    uint64_t overruns;                       /* steps with too many events */
    double overran_s;                        /* begin of the first step with too many events */
    uint64_t in_overruns[WH_CONTACTS_LIMIT]; /* events of each contact in the overruns */
    double taken_J;          /* sum of the |energy changes| in steps with too many events */
    double energy_J;         /* the energy after the last step */
    energy_residual balance; /* set by run_checks_end(), like `found` and `warned` */
    finding found[FINDINGS];
    unsigned warned; /* the warnings, as bits */
} run_checks;

/* All arguments must outlive the result. If `of` is NULL, the budget is the result's `own`. The loop that steps `run`
 * (host/engine/loop.h) must count the run's operations in that budget. */
run_checks *run_checks_open(const image *im, const engine_kind *kind, void *run, budget *of);
/* Makes a run to its end, or to an interrupt (host/os/system.h), with all checks at any cost. `progress` may be NULL;
 * it is called with the share of completed steps. run_checks_close() ends the run. */
run_checks *run_checks_whole(const image *im, const engine_kind *kind,
                             void (*progress)(double share, void *context), void *context);
void run_checks_close(run_checks *v); /* NULL is fine */
/* Call it at the start and after each step. */
void run_checks_enter(run_checks *v);
/* The run is over; `status` is that of its last step. A failed run has no findings, but its balance is known. */
void run_checks_end(run_checks *v, wh_status status);
/* The findings, as bits, for which the exit status is 1. */
unsigned run_checks_fails(const run_checks *v, double strict);
/* The findings, as bits, for which some steps were not checked because the budget was too small. */
unsigned run_checks_unlooked(const run_checks *v);

#endif
