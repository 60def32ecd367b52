/* finding.h: the findings that a run may have, their severity and their limits, as rows for all outputs. */
#ifndef CHECK_FINDING_H
#define CHECK_FINDING_H

#include <stdio.h>

typedef enum finding_id {
    FINDING_MASS,
    FINDING_CONSTANTS,
    FINDING_ENERGY,
    FINDING_ACCURACY,
    FINDING_POLE,
    FINDING_MISSED,
    FINDING_ALIASED,
    FINDING_EVENTS,
    FINDING_APART,
    FINDING_DIGITS,
    FINDINGS
} finding_id;

#define FINDING_BIT(id) (1U << (id))
/* Findings about the scene's start. A different step or number type cannot remove them. */
#define FINDING_OF_SCENE FINDING_BIT(FINDING_APART)

/* A warning means that the run cannot be trusted: `whirl run` and `whirl sweep` end with exit status 1. After
 * notes alone they end with 0. run_checks.c reports FINDING_MASS as a note if its value is small. */
typedef enum finding_severity { FINDING_NOTE, FINDING_WARNING } finding_severity;

/* Values of --strict. STRICT_OFF: findings keep the exit status 0. STRICT_FINDINGS: a warning makes it 1. A positive
 * value is like STRICT_FINDINGS, but replaces the limit of FINDING_ENERGY. */
#define STRICT_OFF (-1.0)
#define STRICT_FINDINGS 0.0

/* A finding is reported if its value exceeds the limit of its row. */
typedef struct finding_row {
    const char *word;
    finding_severity severity;
    double limit;
    const char *unit;   /* unit of the limit */
    const char *reason; /* reason for the limit */
    const char *points; /* predicate of a sweep's message "3 of 9 points ..." */
} finding_row;

extern const finding_row finding_rows[FINDINGS];

/* FINDING_ACCURACY: let |error| / (range of the coordinate or rate) exceed RUN_CHECKS_EARLY_TOLERANCE at the time
 * early_s, and RUN_CHECKS_TOLERANCE at until_s. The finding is reported if until_s is in the run's first half. Chaotic
 * motions are exempt, because no smaller step helps. A motion counts as chaotic if early_s > RUN_CHECKS_BEGIN * (end of
 * the run), and until_s < RUN_CHECKS_GROWS * early_s. */
#define RUN_CHECKS_TOLERANCE 1e-2
#define RUN_CHECKS_EARLY_TOLERANCE 1e-4
#define RUN_CHECKS_GROWS 8.0
#define RUN_CHECKS_BEGIN 0.02
/* FINDING_ACCURACY also reports a sudden error of a position: it grows from HORIZON_TOLERANCE / RUN_CHECKS_SUDDEN to
 * HORIZON_TOLERANCE within RUN_CHECKS_SUDDEN_STEPS steps. */
#define RUN_CHECKS_SUDDEN 30.0
#define RUN_CHECKS_SUDDEN_STEPS 8.0
/* FINDING_ENERGY: limit of |residual| / largest_J before the run's end. A smaller ratio is invisible in a plot. */
#define RUN_CHECKS_ON_THE_WAY 3e-3
/* FINDING_EVENTS is not reported if at most 1 + RUN_CHECKS_RESTS_STEPS * (steps of the run) steps have too many events,
 * and the sum of |energy changes| in these steps is at most RUN_CHECKS_RESTS * largest_J. */
#define RUN_CHECKS_RESTS 1e-3
#define RUN_CHECKS_RESTS_STEPS 0.01

/* Prints the names of these findings: "[pole] [missed]". */
void finding_say_names(FILE *out, unsigned ids);
/* Prints the last line of a command that ends with exit status 1 because of these findings (bits). */
void finding_say_status(FILE *out, const char *command, unsigned fails);

#endif
