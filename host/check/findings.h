/* findings.h: the findings of a run in words, each with its cause and its remedy. */
#ifndef CHECK_FINDINGS_H
#define CHECK_FINDINGS_H

#include <stdio.h>

#include "host/base/diag.h"
#include "run_checks.h"

/* Prints the findings of a run, with hints. If `fails`, FINDING_ENERGY is an error, not a warning. */
void findings_say(FILE *out, const run_checks *v, bool fails);
enum { FINDINGS_NAME = STATEMENT_SIZE };
/* Prints the text of a reported finding. */
void findings_message(FILE *out, const run_checks *v, finding_id id);
double findings_limit(const run_checks *v, finding_id id); /* the limit that the value exceeds */
/* Writes the finding's column, contact or coordinate to name[]. Returns false if the finding has none of them. */
bool findings_where(const run_checks *v, finding_id id, char name[FINDINGS_NAME]);
/* For a run that failed, or whose energies became undefined: prints options that prevent this, if Whirl finds any. */
void findings_say_failed(FILE *out, const run_checks *v);
/* After a step with `status`: reports the expression that was not finite, or the coordinate that diverged. */
void failure_say(FILE *out, wh_status status, const run_checks *v);

/* Is a run of this image without findings? */
bool remedy_not_needed(const image *im, const engine_kind *kind);

#endif
