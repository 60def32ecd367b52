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
/* Of the start, which no step and no number cures. */
#define FINDING_OF_SCENE FINDING_BIT(FINDING_APART)

/* A warning: the run is not believed, and `whirl run` and `whirl sweep` end with exit status 1. A note keeps 0. A small value
 * may make a note of a warning (run_checks.c). */
typedef enum finding_severity { FINDING_NOTE, FINDING_WARNING } finding_severity;

/* --strict: STRICT_OFF keeps exit status 0, STRICT_FINDINGS depends on the findings. A positive value is a
 * limit of the energy residual, in place of FINDING_ENERGY. */
#define STRICT_OFF (-1.0)
#define STRICT_FINDINGS 0.0

/* The one place of thresholds: a finding is reported if its value exceeds the limit. */
typedef struct finding_row {
    const char *word;
    finding_severity severity;
    double limit;
    const char *unit;   /* of the limit */
    const char *reason; /* of the limit */
    const char *points; /* of a sweep: "3 of 9 points ..." */
} finding_row;

extern const finding_row finding_rows[FINDINGS];

/* Other thresholds of findings, besides their rows' limits. */
/* accuracy: parts of a range. The first is reported. If it needs less than GROWS times as long as the second took, and that
 * took longer than BEGIN of the run, the motion is chaotic, and no step helps. */
#define RUN_CHECKS_TOLERANCE 1e-2
#define RUN_CHECKS_EARLY_TOLERANCE 1e-4
#define RUN_CHECKS_GROWS 8.0
#define RUN_CHECKS_BEGIN 0.02
/* accuracy: an error of a position that grows by this factor to HORIZON_TOLERANCE in so many steps, after twice as many,
 * is reported at any time */
#define RUN_CHECKS_SUDDEN 30.0
#define RUN_CHECKS_SUDDEN_STEPS 8.0
/* energy: part of the largest entry that was missing on the way and came back; no plot shows it */
#define RUN_CHECKS_ON_THE_WAY 3e-3
/* events: the last bounces before a rest are not reported: parts of the largest entry, and of the steps */
#define RUN_CHECKS_RESTS 1e-3
#define RUN_CHECKS_RESTS_STEPS 0.01

/* "[pole] [missed]": the names of these findings. */
void finding_say_names(FILE *out, unsigned ids);
/* The last line of a command that ends with exit status 1 because of these findings, as bits. */
void finding_say_status(FILE *out, const char *command, unsigned fails);

#endif
