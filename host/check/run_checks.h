/* run_checks.h: findings against a run, made while it goes on and at its end.
 *
 * Two checks judge every run: a finer run in double (step_doubling.h), and the energy residual (energy_residual.h). The others find
 * faults that both may miss. These are a singular matrix, a pole or contact that a step jumped over, and too few digits.
 * Forcing that aliases with the step and steps with too many events are two more. `whirl run` and `whirl sweep` share these checks, so that
 * both report the same for the same point. The checks never change the run. docs/warnings.md has the cures. */
#ifndef CHECK_RUN_CHECKS_H
#define CHECK_RUN_CHECKS_H

#include "energy_residual.h"
#include "finding.h"
#include "host/check/horizon.h"

/* Of a run: finding `id` is reported, */
typedef struct finding {
    bool told;
    double value;  /* by this value, in the row's unit, */
    double at_s;   /* at or from this time on; below 0: all the time */
    int component; /* and of this component or contact, or -1 */
} finding;

typedef struct run_checks {
    const image *image;
    const engine_kind *kind;
    void *run;
    const image *plain; /* of the finer run */
    budget own;
    budget *budget;        /* shared by all checks: its own, or another's */
    double part;           /* of the limits of energy and accuracy: 1; a remedy is judged by less */
    books *books;          /* NULL of a system given by its equations */
    pole_crossing *jumped; /* NULL: no pole */
    step_doubling *twins;  /* NULL: it would take too long */
    uint64_t overruns;
    double overran_s;                        /* begin of the first such step */
    uint64_t in_overruns[WH_CONTACTS_LIMIT]; /* events of each contact in them */
    double taken_J;                          /* by how much the energy changed in them */
    double energy_J;                         /* after the last step */
    energy_residual balance;                 /* after run_checks_end(), as are: */
    finding found[FINDINGS];
    unsigned against; /* the warnings of the run among them, as bits */
} run_checks;

/* `plain`: the finer run's image (step_doubling_plain()); NULL: the image itself. `of`: the budget; NULL: the verdict has its own,
 * which the loop of the run fills. All must outlive the verdict. */
run_checks *run_checks_open(const image *im, const image *plain, const engine_kind *kind, void *run,
                            budget *of);
void run_checks_close(run_checks *v); /* NULL is fine */
/* Enter the state after each step, the start included. */
void run_checks_enter(run_checks *v);
/* The run is over; `status`: its last step's. A run that failed has no findings, but its balance is known. */
void run_checks_end(run_checks *v, wh_status status);
/* The findings, as bits, for which the exit status is 1. */
unsigned run_checks_fails(const run_checks *v, double strict);
/* The findings, as bits, that some step was not checked for: the budget was too small. */
unsigned run_checks_unlooked(const run_checks *v);

#endif
